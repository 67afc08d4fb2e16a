// The hard-disc code that carom-lab bench discs compares with carom.
#include "bench/discs.h"

#include <gtest/gtest.h>

#include "bench/shot_cases.h"
#include "carom/engine/simulate.h"

namespace carom::tools {
namespace {

// Two discs that collide at a centre distance of 0.2 in a box of 2 x 1 meet in the middle after (1 - 0.2) / 2
// s, exchange their velocities, and reach the borders 0.4 + 0.5 s later.
TEST(HardDiscs, MeetAndReturn) {
    HardDiscs discs({{0.5, 0.5}, {1.5, 0.5}}, {{1.0, 0.0}, {-1.0, 0.0}}, 0.2, {2.0, 1.0});
    EXPECT_NEAR(discs.run(1), 0.4, 1e-15);
    EXPECT_NEAR(discs.run(3), 0.4 + 0.9, 1e-15);
    EXPECT_NEAR(discs.run(4), 0.4 + 2 * 0.9, 1e-15);
    EXPECT_EQ(discs.collisions(), 4);
}

// Cell borders change nothing, and the events have the same order as in carom.
TEST(HardDiscs, PlayTheSameGasAsCarom) {
    for (const int n : {16, 100}) {
        const Plan plan = make_plan(gas_scene(n, 4L * n, 1), kernel::Isa::kFastest);
        EXPECT_NEAR(hard_discs(plan).run(4L * n), simulate(plan).events.back().time, 1e-8) << n;
    }
}

}  // namespace
}  // namespace carom::tools
