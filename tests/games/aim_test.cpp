// Aiming aid: every aim that it finds is played and pots the ball.
#include "carom/games/aim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/math.h"
#include "carom/games/shot.h"
#include "carom/kernel/splitmix64.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

using games::Aim;
using games::PocketLine;

Scene pool_scene(const Vec2& cue, const Vec2& one) {
    Scene scene;
    scene.file = "pool";
    scene.table = make_table("nine_foot");
    use_balls(scene, "pool");
    add_ball(scene, "cue", cue.x(), cue.y());
    add_ball(scene, "1", one.x(), one.y());
    return scene;
}

Cue center_ball(double speed) {
    Cue cue;
    cue.speed = speed;
    cue.height = 0.0;
    return cue;
}

/// Plays the aim: whether the ball falls into the pocket, and the number of cushions before.
struct Fate {
    bool fell = false;
    int cushions = 0;
};
Fate played(Scene scene, Cue how, const Aim& aim, const std::string& ball, const std::string& pocket) {
    how.aim_deg = aim.aim_deg.value();
    scene.cue = how;
    const Record record = simulate(plan_of(scene));
    const games::Shot shot = games::shot_of(record);
    Fate fate;
    const int index = games::index_of(record, ball);
    for (const games::Shot::Fallen& f : shot.pocketed)
        fate.fell = fate.fell || (f.ball == index &&
                                  record.table.pockets[static_cast<std::size_t>(f.pocket)].id == pocket);
    for (const Event& e : record.events) fate.cushions += e.type == EventType::kBallCushion && e.a == index;
    return fate;
}

TEST(Aim, DirectionsAreAccurateToAFewUlp) {
    EXPECT_NEAR(games::direction_deg({2.0, 0.0}), 0.0, 1e-13);
    EXPECT_NEAR(games::direction_deg({0.0, 0.5}), 90.0, 1e-13);
    EXPECT_NEAR(games::direction_deg({-3.0, 0.0}), 180.0, 1e-13);
    EXPECT_NEAR(games::direction_deg({0.0, -1.0}), -90.0, 1e-13);
    EXPECT_EQ(games::direction_deg({0.0, 0.0}), 0.0);
    for (double deg = -179.0; deg < 180.0; deg += 0.7)
        EXPECT_NEAR(games::direction_deg({7.0 * sin_cos_deg(deg).cos, 7.0 * sin_cos_deg(deg).sin}), deg,
                    1e-13);
}

TEST(Aim, TheGhostBallTouchesOnTheFarSideAtTheCutAngle) {
    const Vec2 ghost = games::ghost_ball({1.0, 1.0}, {0.0, 1.0}, 0.06);
    EXPECT_EQ(ghost, Vec2(1.0, 0.94));
    EXPECT_EQ(games::cut_angle_deg({1.0, 0.5}, ghost, {0.0, 1.0}), 0.0);
    EXPECT_NEAR(games::cut_angle_deg({0.5, 0.94}, ghost, {0.0, 1.0}), 90.0, 1e-13);
    EXPECT_NEAR(games::cut_angle_deg({1.0 - 0.44, 0.5}, ghost, {0.0, 1.0}), 45.0, 1e-13);
}

TEST(Aim, LinesIntoPocketsAreUnobstructed) {
    const Scene scene = pool_scene({0.3, 0.3}, {0.635, 1.27});
    const std::vector<PocketLine> lines = games::pocket_lines(scene, "1");
    ASSERT_EQ(lines.size(), 6u);
    for (const PocketLine& line : lines) EXPECT_TRUE(line.open()) << line.pocket;
    // From the middle of the table, opposite pockets are equal.
    for (std::size_t k = 0; k < 3; ++k) {
        const PocketLine &a = lines[k], &b = lines[k + 3];
        EXPECT_NEAR(a.width_deg, b.width_deg, 1e-6);
        EXPECT_NEAR(a.towards.x(), -b.towards.x(), 1e-7);
    }
    // The side pocket straight ahead: its mouth of 5 1/16 in, less a ball, seen from half the width.
    const double mouth = 5.0625 * 0.0254,
                 seen = 2.0 * std::atan((mouth / 2.0 - 0.028575) / 0.635) * 57.29577951308232;
    EXPECT_NEAR(lines[1].width_deg, seen, 0.15 * seen);
    // Close to the long rail, no side pocket is open.
    const std::vector<PocketLine> rail = games::pocket_lines(pool_scene({0.3, 0.3}, {0.03, 0.5}), "1");
    EXPECT_EQ(rail[1].width_deg, 0.0);
    EXPECT_GT(rail[0].width_deg, 0.0);
}

TEST(Aim, ABlockingBallIsNamed) {
    Scene scene = pool_scene({0.3, 0.3}, {0.635, 1.27});
    const Vec2 towards = games::pocket_lines(scene, "1")[2].towards;
    const Vec2 between = Vec2(0.635, 1.27) + 0.5 * towards;
    add_ball(scene, "2", between.x(), between.y());
    EXPECT_EQ(games::pocket_lines(scene, "1")[2].in_the_way, "2");
    EXPECT_FALSE(games::pocket_lines(scene, "1")[2].open());
    EXPECT_TRUE(games::pocket_lines(scene, "1")[3].open());
    const Aim aim = games::aim_pot(scene, center_ball(3.0), "1", "p3");
    EXPECT_FALSE(aim.aim_deg);
    EXPECT_EQ(aim.why, "ball 2 is in the way of ball 1");
    EXPECT_EQ(aim.shots, 0);
}

// If impacts take no time, without friction between the balls and without squirt, the ghost ball is exact.
TEST(Aim, WithoutThrowTheGeometryIsTheAim) {
    Scene scene = pool_scene({0.5, 0.6}, {0.8, 1.2});
    scene.balls.mu_b = scene.balls.mu_b_more = 0.0;
    scene.physics.clusters = ClusterModel::kSequential;
    Cue cue = center_ball(3.0);
    cue.end_mass = 0.0;
    const Aim aim = games::aim_pot(scene, cue, "1", "p4");
    ASSERT_TRUE(aim.aim_deg) << aim.why;
    EXPECT_NEAR(*aim.aim_deg, aim.geometric_deg, 2e-3);
    EXPECT_TRUE(played(scene, cue, aim, "1", "p4").fell);
}

TEST(Aim, ThrowIsCompensated) {
    const Scene scene = pool_scene({0.4, 0.9}, {0.8, 1.6});
    Scene missed = scene;
    const Aim aim = games::aim_pot(scene, center_ball(1.5), "1", "p4");
    ASSERT_TRUE(aim.aim_deg) << aim.why;
    // Throw pushes the ball along with the cue ball, so the aim is thinner by some tenths of a degree at
    // most.
    EXPECT_GT(std::abs(*aim.aim_deg - aim.geometric_deg), 1e-3);
    EXPECT_LT(std::abs(*aim.aim_deg - aim.geometric_deg), 2.0);
    EXPECT_TRUE(played(scene, center_ball(1.5), aim, "1", "p4").fell);
}

// Random places, speeds and offsets, and all pockets open within 70 degrees of cut.
TEST(Aim, PotsAtRandom) {
    SplitMix64 random(21);
    int found = 0, tried = 0, shots = 0, none = 0;
    for (int round = 0; round < 200; ++round) {
        const auto place = [&] {
            return Vec2(0.05 + 1.17 * random.uniform(), 0.05 + 2.44 * random.uniform());
        };
        Scene scene = pool_scene(place(), place());
        if (length(planar(scene.ball[0].position) - planar(scene.ball[1].position)) < 0.15) continue;
        Cue how = center_ball(2.5 + 2.0 * random.uniform());
        how.side = 0.5 * (random.uniform() - 0.5);
        how.height = 0.5 * (random.uniform() - 0.5);
        const std::vector<PocketLine> lines = games::pocket_lines(scene, "1");
        for (const PocketLine& line : lines) {
            const std::string& pocket = line.pocket;
            const Aim aim = games::aim_pot(scene, how, "1", pocket);
            ASSERT_EQ(aim.aim_deg.has_value(), aim.why.empty());
            if (aim.aim_deg) {
                ++found;
                shots += aim.shots;
                ASSERT_TRUE(played(scene, how, aim, "1", pocket).fell) << round << " " << pocket;
                EXPECT_TRUE(line.open());
            }
            if (!line.open() || aim.cut_deg > 70.0 || line.distance > 1.8) continue;
            ++tried;
            none += !aim.aim_deg;
        }
    }
    EXPECT_GT(tried, 200);
    EXPECT_GT(found, 200);
    EXPECT_LT(none, tried / 20) << none << " of " << tried;
    EXPECT_LT(shots, 14 * found) << "shots for an aim";
}

TEST(Aim, ExplainsWhyNoAimExists) {
    Scene scene = pool_scene({0.635, 1.8}, {0.635, 1.27});
    EXPECT_EQ(games::aim_pot(scene, center_ball(3.0), "1", "p3").why, "the cut would be 90 degrees or more");
    const Scene rail = pool_scene({0.3, 0.3}, {0.03, 0.5});
    EXPECT_EQ(games::aim_pot(rail, center_ball(3.0), "1", "p2").why,
              "no straight path of ball 1 into the pocket clears the jaws");
    // Too slow to arrive.
    const Scene far = pool_scene({0.635, 0.4}, {0.635, 0.8});
    EXPECT_EQ(games::aim_pot(far, center_ball(0.3), "1", "p3").why,
              "the ball runs towards the pocket but does not fall");
    // An obstacle between cue ball and ball.
    Scene hidden = pool_scene({0.4, 0.4}, {0.7, 1.4});
    add_ball(hidden, "2", 0.55, 0.9);
    const Aim aim = games::aim_pot(hidden, center_ball(3.0), "1", "p4");
    EXPECT_FALSE(aim.aim_deg);
    EXPECT_EQ(aim.why, "the cue ball meets ball 2 first");
    EXPECT_THROW(games::aim_pot(far, center_ball(3.0), "3", "p3"), std::invalid_argument);
    EXPECT_THROW(games::aim_pot(far, center_ball(3.0), "1", "p7"), std::invalid_argument);
    EXPECT_THROW(games::aim_pot(far, center_ball(3.0), "cue", "p3"), std::invalid_argument);
}

// A millimetre or more from the long rail, the corner's facing guides the ball.
TEST(Aim, ABallOnTheRailRunsAlongIt) {
    for (const double x : {0.03, 0.035, 0.04}) {
        const Scene scene = pool_scene({0.25, 1.0}, {x, 0.6});
        const Aim aim = games::aim_pot(scene, center_ball(2.0), "1", "p1");
        ASSERT_TRUE(aim.aim_deg) << x << ": " << aim.why;
        EXPECT_TRUE(played(scene, center_ball(2.0), aim, "1", "p1").fell);
    }
}

TEST(Aim, BanksUseOneCushion) {
    SplitMix64 random(22);
    int routes = 0, scenes = 0;
    for (int round = 0; round < 12; ++round) {
        const Scene scene = pool_scene({0.3 + 0.6 * random.uniform(), 0.4 + 0.3 * random.uniform()},
                                       {0.3 + 0.6 * random.uniform(), 1.0 + 0.6 * random.uniform()});
        for (const char* pocket : {"p1", "p2", "p5"}) {
            ++scenes;
            std::vector<std::string> cushions;
            for (const Aim& route : games::bank_routes(scene, center_ball(4.0), "1", pocket)) {
                ++routes;
                ASSERT_TRUE(route.aim_deg);
                const Fate fate = played(scene, center_ball(4.0), route, "1", pocket);
                EXPECT_TRUE(fate.fell) << round << " " << pocket;
                EXPECT_GE(fate.cushions, 1);
                EXPECT_EQ(std::count(cushions.begin(), cushions.end(), route.cushion), 0);
                cushions.push_back(route.cushion);
            }
        }
    }
    EXPECT_GT(routes, scenes / 3) << routes << " of " << scenes;
}

}  // namespace
}  // namespace carom::test
