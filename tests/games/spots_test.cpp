// Balls are respotted exactly, and never onto another ball.
#include "carom/games/spots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "carom/kernel/splitmix64.h"

namespace carom::test {
namespace {

using games::is_free;
using games::Lying;

constexpr double kBallR = 0.028575;

TEST(Spots, FollowTheEquipmentRules) {
    const Table pool = make_table("nine_foot"), snooker = make_table("snooker");
    EXPECT_EQ(games::head_spot(pool), Vec2(0.635, 0.635));
    EXPECT_EQ(games::center_spot(pool), Vec2(0.635, 1.27));
    EXPECT_EQ(games::snooker_spot(snooker, "blue"), Vec2(0.889, 1.7845));
    EXPECT_EQ(games::snooker_spot(snooker, "brown"), Vec2(0.889, 0.737));
    EXPECT_NEAR(games::snooker_spot(snooker, "yellow").x() - 0.889, 0.292, 1e-15);
    EXPECT_NEAR(3.569 - games::snooker_spot(snooker, "black").y(), 0.324, 1e-15);
    EXPECT_ANY_THROW(games::snooker_spot(snooker, "red"));
    EXPECT_FALSE(games::in_area(pool, games::InHand::kHeadString, {0.5, 0.635}));
    EXPECT_TRUE(games::in_area(pool, games::InHand::kHeadString, {0.5, 0.6349}));
}

TEST(Spots, TheSnookerSpotsMatchTheRack) {
    const Scene rack = parse_scene(
        "[table]\npreset = \"snooker\"\n[balls]\npreset = \"snooker\"\n[rack]\ngame = \"snooker\"\n", "rack");
    for (const std::string_view colour : games::kColours) {
        const auto ball = std::find_if(rack.ball.begin(), rack.ball.end(),
                                       [&](const BallStart& b) { return b.id == colour; });
        ASSERT_NE(ball, rack.ball.end());
        EXPECT_EQ(planar(ball->position), games::snooker_spot(rack.table, colour)) << colour;
    }
}

TEST(Spots, Rule14ASpottedBallTouchesABlockingBallButNotTheCueBall) {
    const Table pool = make_table("nine_foot");
    const Vec2 spot = foot_spot(pool);
    const std::vector<Lying> object = {{spot, kBallR, 0.0}}, cue = {{spot, kBallR, games::kSpotGap}};
    const Vec2 touching = games::spot_on_long_string(pool, spot, kBallR, object);
    EXPECT_EQ(touching.x(), spot.x());
    EXPECT_NEAR(touching.y() - spot.y(), 2.0 * kBallR, 1e-15);
    EXPECT_GE((touching - spot).squaredNorm(), 4.0 * kBallR * kBallR);
    EXPECT_NEAR(games::spot_on_long_string(pool, spot, kBallR, cue).y() - spot.y(),
                2.0 * kBallR + games::kSpotGap, 1e-15);
    // The whole string to the foot rail is blocked, so the ball goes towards the middle.
    std::vector<Lying> blocked;
    for (double y = spot.y(); y < pool.length; y += 2.0 * kBallR)
        blocked.push_back({{spot.x() + 0.001, y}, kBallR, 0.0});
    EXPECT_LT(games::spot_on_long_string(pool, spot, kBallR, blocked).y(), spot.y() - 1.9 * kBallR);
}

TEST(Spots, NeverOverlapAndAreTheNearestAtRandom) {
    const Table pool = make_table("nine_foot");
    const Vec2 spot = foot_spot(pool);
    SplitMix64 random(11);
    int moved = 0, back = 0;
    for (int round = 0; round < 4000; ++round) {
        std::vector<Lying> others;
        const int count = 1 + random.below(40);
        for (int tries = 0; tries < 400 && static_cast<int>(others.size()) < count; ++tries) {
            // Crowded around the string.
            const Vec2 place(spot.x() + 0.16 * (random.uniform() - 0.5), 1.5 + 1.0 * random.uniform());
            if (is_free(place, kBallR, others)) others.push_back({place, kBallR, 0.0});
        }
        others.front().gap = games::kSpotGap;
        const Vec2 place = games::spot_on_long_string(pool, spot, kBallR, others);
        ASSERT_TRUE(is_free(place, kBallR, others)) << round;
        ASSERT_EQ(place.x(), spot.x());
        ASSERT_GE(place.y(), kBallR);
        ASSERT_LE(place.y(), pool.length - kBallR);
        moved += place != spot;
        back += place.y() < spot.y();
        // No nearer place on the same side is free; places towards the foot rail are tried first.
        const double step = place.y() < spot.y() ? -1e-4 : 1e-4;
        for (int k = 0; std::abs(k * step) < std::abs(place.y() - spot.y()) - 1e-12; ++k)
            ASSERT_FALSE(is_free(spot + Vec2(0.0, k * step), kBallR, others)) << round << " " << k;
        if (place.y() >= spot.y()) continue;
        for (double y = spot.y(); y < pool.length - kBallR; y += 1e-4)
            ASSERT_FALSE(is_free({spot.x(), y}, kBallR, others));
    }
    EXPECT_GT(moved, 1000);
    EXPECT_GT(back, 5);
}

TEST(Spots, ColoursNeverOverlapAtRandom) {
    const Table table = make_table("snooker");
    constexpr double kSnookerR = 0.02625;
    SplitMix64 random(12);
    int own = 0, other = 0, beside = 0;
    for (int round = 0; round < 4000; ++round) {
        std::vector<Lying> others;
        const auto put = [&](const Vec2& place) {
            if (is_free(place, kSnookerR, others)) others.push_back({place, kSnookerR, games::kSpotGap});
        };
        for (const std::string_view colour : games::kColours)
            if (random.below(10) > 0)
                put(games::snooker_spot(table, colour) +
                    0.06 * Vec2(random.uniform() - 0.5, random.uniform() - 0.5));
        for (int k = 0; k < 20; ++k) put({0.75 + 0.3 * random.uniform(), 2.0 + 1.5 * random.uniform()});
        for (const std::string_view colour : games::kColours) {
            const Vec2 place = games::spot_snooker(table, colour, kSnookerR, others);
            ASSERT_TRUE(is_free(place, kSnookerR, others)) << round << " " << colour;
            const bool a_spot =
                std::any_of(games::kColours.begin(), games::kColours.end(),
                            [&](std::string_view c) { return place == games::snooker_spot(table, c); });
            own += place == games::snooker_spot(table, colour);
            other += a_spot && place != games::snooker_spot(table, colour);
            beside += !a_spot;
        }
    }
    EXPECT_GT(own, 100);
    EXPECT_GT(other, 100);
    EXPECT_GT(beside, 100);
}

}  // namespace
}  // namespace carom::test
