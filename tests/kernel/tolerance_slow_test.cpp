// The bound on the 40 000 impacts named in the project's claims, with both signs of the cloth slip, and more
// hard ones.
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "reference/random_impacts.h"
#include "tolerance_bound.h"

namespace carom::test {
namespace {

using kernel::ClothSlip;

TEST(ToleranceSlow, FortyThousandConsistent) {
    expect_bound(reference::random_impacts(2026, 40000), {1e-3, 1e-6, 1e-10, 1e-12});
}

TEST(ToleranceSlow, FortyThousandAsPublished) {
    std::vector<Impact> impacts = reference::random_impacts(2027, 40000);
    for (Impact& i : impacts) i.params.cloth_slip = ClothSlip::kAsPublished;
    expect_bound(impacts, {1e-3, 1e-6, 1e-10});
}

TEST(ToleranceSlow, WithoutRestitution) {
    std::vector<Impact> impacts = reference::random_impacts(2031, 20000);
    for (std::size_t n = 0; n < impacts.size(); ++n) impacts[n].params.e_b = n % 2 == 0 ? 0.0 : 1e-7;
    expect_bound(impacts, {1e-3, 1e-6, 1e-10, 1e-12});
}

TEST(ToleranceSlow, HardConsistent) {
    Generator rng(2028);
    std::vector<Impact> impacts;
    for (int n = 0; n < 40000; ++n) {
        const bool usual = n % 2 == 0;
        impacts.push_back(
            hard_random_impact(rng, usual ? 0.12 : 1.0, usual ? 0.4 : 1.0, ClothSlip::kConsistent));
    }
    expect_bound(impacts, {1e-3, 1e-6, 1e-10, 1e-12});
}

TEST(ToleranceSlow, HardAsPublished) {
    Generator rng(2030);
    std::vector<Impact> impacts;
    for (int n = 0; n < 40000; ++n)
        impacts.push_back(hard_random_impact(rng, 0.12, 0.4, ClothSlip::kAsPublished));
    expect_bound(impacts, {1e-3, 1e-6, 1e-10, 1e-12});
}

TEST(ToleranceSlow, UnequalMasses) {
    expect_bound(impacts_of_masses_that_differ(2029, 40000, ClothSlip::kConsistent), {1e-3, 1e-6, 1e-10});
}

}  // namespace
}  // namespace carom::test
