// The summed march against the published one: the bound stated in march.h, steps, bits.
#include <gtest/gtest.h>

#include <vector>

#include "carom/kernel/march.h"
#include "summed_march_bound.h"
#include "support/hard_impacts.h"
#include "tolerance_support.h"

namespace carom::test {
namespace {

using namespace kernel;

constexpr ClothSlip kSlips[] = {ClothSlip::kConsistent, ClothSlip::kAsPublished};

TEST(SummedMarch, FollowsThePublishedOne) {
    for (const ClothSlip slip : kSlips) {
        const Followed followed = follow(random_impacts_of(41, 10000, slip), 1000);
        EXPECT_EQ(followed.left_to_published + followed.summed, 10000);
        // Sticking impacts, which are few, are left to the published march.
        EXPECT_GT(followed.left_to_published, 100);
        EXPECT_LT(followed.left_to_published, 500);
    }
}

TEST(SummedMarch, FollowsWithAnyNumberOfSteps) {
    for (const ClothSlip slip : kSlips)
        for (const int n : {100, 101, 128, 333, 3000, 10000})
            EXPECT_GT(follow(random_impacts_of(42, 1000, slip), n).summed, 900) << "N = " << n;
}

TEST(SummedMarch, FollowsImpactsBuiltToBeHard) {
    for (const ClothSlip slip : kSlips)
        for (const bool usual : {true, false}) follow(hard_impacts_of(43, 4000, usual, slip), 1000);
}

TEST(SummedMarch, FollowsTheHardList) {
    for (HardImpact hard : hard_impacts()) {
        for (const ClothSlip slip : kSlips) {
            hard.params.cloth_slip = slip;
            SCOPED_TRACE(hard.name);
            follow({{hard.ball1, hard.ball2, hard.params}}, hard.n);
        }
    }
}

TEST(SummedMarch, FewSubstepsUseThePublishedMarch) {
    for (const int n : {-1, 0, 1, 2, 10, 99})
        EXPECT_EQ(follow(random_impacts_of(44, 300, ClothSlip::kConsistent), n).summed, 0) << "N = " << n;
}

// Without losses v_n is 0 after N/2 steps and the work complete after N, to rounding.
TEST(SummedMarch, TiesUseThePublishedMarch) {
    std::vector<Impact> impacts;
    for (const double speed : {0.3, 0.7, 1.0, 2.3, 5.1}) {
        HardImpact hard = plain_hard_impact("", 0.2, speed);
        hard.params.e_b = 1.0;
        hard.params.mu_b = 0.0;
        impacts.push_back({hard.ball1, hard.ball2, hard.params});
    }
    for (const int n : {100, 1000, 1001, 1234}) EXPECT_EQ(follow(impacts, n).summed, 0) << "N = " << n;
}

// e_b = 0 ends with compression and is not a tie.
TEST(SummedMarch, WithoutRestitutionItIsSummed) {
    std::vector<Impact> impacts = random_impacts_of(45, 300, ClothSlip::kConsistent);
    for (Impact& impact : impacts) impact.params.e_b = 0.0;
    EXPECT_GT(follow(impacts, 1000).summed, 270);
}

// The engine skips effects that change nothing, and its records keep their bits.
TEST(SummedMarch, WithoutFrictionBetweenTheBallsTheClothChangesNoBit) {
    for (Impact& rough : random_impacts_of(48, 1000, ClothSlip::kConsistent)) {
        rough.params.mu_b = 0.0;
        Impact smooth = rough;
        smooth.params.mu_s1 = smooth.params.mu_s2 = 0.0;
        ImpactResult on, off;
        summed_march_function(best_isa())(rough.ball1, rough.ball2, rough.params, 1000, on);
        summed_march_function(best_isa())(smooth.ball1, smooth.ball2, smooth.params, 1000, off);
        EXPECT_TRUE(same_velocities(on, off));
    }
}

TEST(SummedMarch, EveryInstructionSetHasTheBitsOfScalar) {
    for (const ClothSlip slip : kSlips) {
        std::vector<Impact> impacts = random_impacts_of(46, 2000, slip);
        const std::vector<Impact> hard = hard_impacts_of(47, 1000, true, slip);
        impacts.insert(impacts.end(), hard.begin(), hard.end());
        for (const Impact& i : impacts) {
            ImpactResult scalar;
            summed_march_function(Isa::kScalar)(i.ball1, i.ball2, i.params, 1000, scalar);
            for (const Isa isa : isas()) {
                ImpactResult got;
                summed_march_function(isa)(i.ball1, i.ball2, i.params, 1000, got);
                ASSERT_TRUE(same_velocities(got, scalar)) << name(isa);
                ASSERT_EQ(got.steps, scalar.steps) << name(isa);
                ASSERT_EQ(got.status, scalar.status) << name(isa);
            }
        }
    }
}

}  // namespace
}  // namespace carom::test
