// The bound of the summed march on random impacts with both signs of the cloth slip, and on more hard ones.
// CAROM_SLOW_TESTS=1 runs a million of each sign and 400 000 hard ones (two minutes); the default is a tenth
// of that.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>

#include "summed_march_bound.h"

namespace carom::test {
namespace {

using kernel::ClothSlip;

int parts() {
    return std::getenv("CAROM_SLOW_TESTS") != nullptr ? 20 : 2;
}

void follow_random(std::uint64_t seed, ClothSlip slip) {
    for (int part = 0; part < parts(); ++part)
        follow(random_impacts_of(seed + static_cast<std::uint64_t>(part), 50000, slip), 1000);
}

TEST(SummedMarchSlow, RandomConsistent) {
    follow_random(1000, ClothSlip::kConsistent);
}

TEST(SummedMarchSlow, RandomAsPublished) {
    follow_random(2000, ClothSlip::kAsPublished);
}

TEST(SummedMarchSlow, Hard) {
    for (const ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished})
        for (const bool usual : {true, false})
            follow(hard_impacts_of(3000, 5000 * parts(), usual, slip), 1000);
}

}  // namespace
}  // namespace carom::test
