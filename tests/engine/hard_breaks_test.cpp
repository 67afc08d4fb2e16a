// H38 of tests/README.md: seeded eight-ball breaks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "reference/random_impacts.h"
#include "support/hard_scenes.h"

namespace carom {
namespace {

using namespace test;

// In four tests that can run side by side.
class Breaks : public testing::TestWithParam<double> {};

TEST_P(Breaks, NoneExplodes) {
    reference::Generator rng(38);
    std::size_t most = 0;
    for (int i = 0; i < 250; ++i) {
        char text[400];
        const double x = 0.635 + rng.uniform(-0.012, 0.012), speed = rng.uniform(5.0, 12.0);
        std::snprintf(text, sizeof text,
                      "[rack]\ngame = \"eight_ball\"\ngap = %.17g\nseed = %d\n[[ball]]\nid = "
                      "\"cue\"\nposition = [%.17g, 0.5]\n"
                      "velocity = [0, %.17g]\n",
                      GetParam(), i + 1, x, speed);
        SCOPED_TRACE(text);
        const Record record = run_verified(parse_scene(text, "break.toml"));
        EXPECT_EQ(record.stopped, StopReason::kAtRest);
        EXPECT_LE(record.events.size(), 400u);
        most = std::max(most, record.events.size());
    }
    report("H38 most events", static_cast<double>(most));
}

INSTANTIATE_TEST_SUITE_P(Gap, Breaks, testing::Values(0.0, 1e-12, 1e-6, 1e-4));

}  // namespace
}  // namespace carom
