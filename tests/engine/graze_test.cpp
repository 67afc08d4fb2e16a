// 1e5 near-grazing pairs against a cascade in __float128 (support/graze_oracle.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carom/engine/math.h"
#include "contact/detect.h"
#include "contact/roots.h"
#include "physics/motion.h"
#include "reference/random_impacts.h"
#include "support/graze_oracle.h"
#include "support/graze_pairs.h"
#include "support/hard_scenes.h"

namespace carom {
namespace {

using namespace test;

constexpr double kReach = 2.0 * 0.028575;

TEST(Graze, OracleSolvesAStraightLine) {
    const GrazeOracle oracle({0, 0}, {0, 0}, {0, 0}, {kReach + 1.0, 0}, {-2.0, 0}, {0, 0}, kReach, 1.0);
    EXPECT_TRUE(oracle.meet().hit);
    EXPECT_NEAR(oracle.meet().time, 0.5, 1e-15);
    EXPECT_FALSE(
        GrazeOracle({0, 0}, {0, 0}, {0, 0}, {kReach + 1.0, kReach + 1e-15}, {-2.0, 0}, {0, 0}, kReach, 1.0)
            .meet()
            .hit);
}

TEST(Graze, HundredThousandPairs) {
    reference::Generator rng(10);
    int hits = 0, misses = 0, decided = 0;
    double worst_gap = 0.0, deepest_wrong = 0.0;
    for (int k = 0; decided < 100000; ++k) {
        const int kinds[][2] = {{1, 0}, {2, 0}, {1, 1}, {2, 1}, {2, 2}};
        const int* kind = kinds[k % 5];
        Path one = random_path(rng, kind[0], 0.05 * std::pow(160.0, rng.uniform()));
        Path two = random_path(rng, kind[1], 0.05 * std::pow(160.0, rng.uniform()));
        one.r = Vec2{rng.uniform(0.0, 1.0), rng.uniform(0.0, 2.0)};
        const double horizon = std::min({one.horizon, two.horizon, 20.0});
        one.horizon = std::min(one.horizon, 20.0);
        const double side = rng.next() % 2 ? 1.0 : -1.0;
        const double depth = side * std::pow(10.0, rng.uniform(-16.0, -4.0));
        set_to_graze(one, two, rng.uniform(0.05, 0.9) * horizon, depth, kReach, rng);
        if (length(two.r - one.r) <= kReach) continue;
        const double got = time_to_ball(one, two, kReach);
        const FirstMeeting want =
            GrazeOracle(one.r, one.v, one.a, two.r, two.v, two.a, kReach, horizon).meet();
        const bool hit = got < kNever;
        ++decided;
        if (hit != want.hit) {
            deepest_wrong = std::max(deepest_wrong, std::abs(want.depth));
            EXPECT_LE(std::abs(want.depth), 1e-12) << (hit ? "false hit " : "miss ") << k;
        }
        if (!hit) {
            ++misses;
            continue;
        }
        ++hits;
        const Vec2 r = (two.r - one.r) + got * ((two.v - one.v) + 0.5 * got * (two.a - one.a));
        const double gap = length(r) - kReach;
        worst_gap = std::max(worst_gap, std::abs(gap));
        EXPECT_LE(std::abs(gap), 1e-13) << k;
        // The time must be the oracle's, not a later root, as precisely as the closing speed defines it.
        if (hit == want.hit && std::abs(depth) > 1e-10) {
            EXPECT_NEAR(got, want.time, 1e-7) << k;
        }
    }
    report("grazing pairs: worst gap", worst_gap);
    report("grazing pairs: deepest wrong decision", deepest_wrong);
    EXPECT_EQ(decided, 100000);
    EXPECT_GE(hits, 40000);
    EXPECT_GE(misses, 40000);
}

}  // namespace
}  // namespace carom
