// The plain march against numbers from other software, and against itself on every instruction set.
#include <gtest/gtest.h>

#include "carom/kernel/march.h"
#include "reference/random_impacts.h"
#include "support/impact_cases.h"

namespace carom::test {
using reference::Impact;
using reference::random_impacts;

namespace {

using namespace kernel;

TEST(MarchReference, ReproducesThePapersFiveStates) {
    const long steps[5] = {1001, 1001, 1001, 1004, 1002};
    for (const ReferenceImpact& impact : reference_impacts("paper_states.json")) {
        ImpactResult result;
        march_function(Isa::kScalar)(impact.ball1, impact.ball2, impact.params, 1000, result);
        ASSERT_EQ(result.status, ImpactStatus::kOk);
        EXPECT_LE(difference(result, impact.outputs.at("frictional_mathavan_N1000"), impact.params.R), 1e-11)
            << "state " << impact.id;
        EXPECT_EQ(result.steps, steps[impact.id]) << "state " << impact.id;
    }
}

// The loop ends at the first step past its target. If the work at that step equals the target to a few ulp,
// two correct roundings may stop one step apart; this file has no such tie.
struct Column {
    const char* name;
    int n, cases;
};

TEST(MarchReference, AgreesWithPooltool) {
    for (const Column& column :
         {Column{"frictional_mathavan_N100", 100, 9}, Column{"frictional_mathavan_N1000", 1000, 60},
          Column{"frictional_mathavan_N10000", 10000, 9}}) {
        int compared = 0;
        for (const ReferenceImpact& impact : reference_impacts("ball_ball.json")) {
            const auto expected = impact.outputs.find(column.name);
            if (expected == impact.outputs.end()) continue;
            ImpactResult result;
            march_function(Isa::kScalar)(impact.ball1, impact.ball2, impact.params, column.n, result);
            ASSERT_EQ(result.status, ImpactStatus::kOk) << "id " << impact.id;
            EXPECT_LE(difference(result, expected->second, impact.params.R), 1e-9)
                << "id " << impact.id << ", N = " << column.n;
            ++compared;
        }
        EXPECT_EQ(compared, column.cases);
    }
}

TEST(MarchIsa, EveryInstructionSetGivesTheSameBits) {
    for (Isa isa : {Isa::kV3, Isa::kV4}) {
        if (!available(isa)) continue;
        for (ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
            for (Impact impact : random_impacts(7, 400)) {
                impact.params.cloth_slip = slip;
                for (int n : {1, 10, 100, 1000}) {
                    ImpactResult scalar, wide;
                    march_function(Isa::kScalar)(impact.ball1, impact.ball2, impact.params, n, scalar);
                    march_function(isa)(impact.ball1, impact.ball2, impact.params, n, wide);
                    ASSERT_EQ(scalar.status, ImpactStatus::kOk);
                    ASSERT_TRUE(same_bits(scalar, wide)) << name(isa) << ", N = " << n;
                }
            }
        }
    }
}

TEST(MarchConvergence, ApproachesTheConvergedResultAsOneOverN) {
    for (const ReferenceImpact& impact : reference_impacts("ball_ball.json")) {
        const ImpactResult& fine = impact.outputs.at("frictional_mathavan_N1000000");
        const double v_n = approach_speed(impact.ball1, impact.ball2);
        ImpactResult result;
        march_function(Isa::kScalar)(impact.ball1, impact.ball2, impact.params, 1000, result);
        // One step of normal velocity, both balls, plus the stick chatter: 7 mu_b of it.
        EXPECT_LE(difference(result, fine, impact.params.R),
                  (2.0 + 14.0 * impact.params.mu_b) * v_n / 1000 + 1e-4)
            << "id " << impact.id;
    }
}

}  // namespace
}  // namespace carom::test
