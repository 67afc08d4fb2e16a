// Scenes in which one ball differs from the others: equal ones may still rest on each other.
#include <gtest/gtest.h>

#include <cstdint>
#include <exception>
#include <string>

#include "carom/engine/ball_ball.h"
#include "scene/rack.h"
#include "support/hard_scenes.h"

namespace carom::test {
namespace {

constexpr BallSize kLarge{0.03015, 0.2};

Scene two_that_rest(const BallSize& size) {
    Scene scene = empty_scene();
    scene.physics.ball_ball = ball_ball_model("inelastic");
    scene.physics.clusters = ClusterModel::kSequential;
    add_ball(scene, "1", {0.0, 0.0, size.R}, Vec3::Zero(), {0.0, 10.0, 0.0});
    add_ball(scene, "2", {2.0 * size.R, 0.0, size.R});
    for (BallStart& ball : scene.ball)
        if (!(size == scene.balls.size())) ball.own = size;
    return scene;
}

// A ball with topspin pushes the one in front of it, a metre from a heavier one: the error was that "there
// are balls of different size".
TEST(UnlikeBalls, AlikeOnesRestOnEachOther) {
    const Scene alone = two_that_rest(empty_scene().balls.size());
    Scene scene = alone;
    add_ball(scene, "cue", 1.0, 0.0);
    scene.ball.back().own = BallSize{scene.balls.R, 0.19};
    const Record record = run_verified(scene), pair = run_verified(alone);
    EXPECT_EQ(record.stopped, StopReason::kAtRest);
    EXPECT_EQ(count(record, EventType::kBallBallHold), 1);
    for (const std::size_t ball : {0u, 1u})
        EXPECT_EQ(record.tracks[ball].segments, pair.tracks[ball].segments);
}

// Two balls with an explicit size rest on each other as if all balls had it.
TEST(UnlikeBalls, AGroupHasTheSizeOfItsBalls) {
    Scene common = two_that_rest(kLarge);
    common.balls.R = kLarge.R;
    common.balls.m = kLarge.m;
    for (BallStart& ball : common.ball) ball.own.reset();
    Scene own = two_that_rest(kLarge);
    add_ball(own, "other", 1.0, 0.0);
    own.balls.mu_b = common.balls.mu_b = 0.0;  // otherwise different radii have no formula
    const Record record = run_verified(own), wanted = run_verified(common);
    EXPECT_EQ(count(record, EventType::kBallBallHold), 1);
    for (const std::size_t ball : {0u, 1u})
        EXPECT_EQ(record.tracks[ball].segments, wanted.tracks[ball].segments);
}

TEST(UnlikeBalls, ThatRestOnEachOtherAreAnErrorByName) {
    Scene scene = two_that_rest(empty_scene().balls.size());
    scene.ball[1].own = BallSize{scene.balls.R, 0.19};
    try {
        simulate(plan_of(scene));
        ADD_FAILURE() << "no error";
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what())
                      .find("balls 1 and 2 differ in size and stay in contact, which "
                            "is not modelled; give them the same size"),
                  std::string::npos)
            << error.what();
    }
}

/// An eight-ball break with a heavier cue ball, as on a coin-operated table.
Scene odd_break(std::uint64_t seed, bool large) {
    Scene scene = empty_scene();
    scene.table = make_table("nine_foot");
    Rack rack;
    rack.game = RackGame::kEightBall;
    rack.seed = seed;
    for (const RackedBall& b : make_rack(rack, scene.table, scene.balls.R))
        add_ball(scene, b.id, b.position.x(), b.position.y());
    add_ball(scene, "cue", 0.635, 0.5, 0.001 * static_cast<double>(seed % 7),
             4.0 + 0.01 * static_cast<double>(seed % 400));
    scene.ball.back().own = large ? kLarge : BallSize{scene.balls.R, 0.19};
    scene.ball.back().position.z() = scene.ball.back().own->R;
    scene.physics.clusters = ClusterModel::kSequential;
    scene.physics.ball_ball = ball_ball_model(large ? "elastic" : "inelastic");
    return scene;
}

// Of 500 breaks each, 97 with the heavy cue ball and 483 with the large one ended with that error. 2 and 42
// remain, in which the cue ball itself stays in contact with another ball.
TEST(UnlikeBalls, BreaksWithAnOddCueBallEndAtRest) {
    for (const bool large : {false, true}) {
        int failed = 0;
        for (std::uint64_t seed = 1; seed <= 500; ++seed) {
            const Plan plan = plan_of(odd_break(seed, large));
            try {
                const Record record = simulate(plan);
                EXPECT_EQ(record.stopped, StopReason::kAtRest);
                EXPECT_FALSE(seed % 10 == 0 && verify(record, plan)) << "seed " << seed;
            } catch (const std::exception& error) {
                const std::string what = error.what();
                const std::size_t names = what.find("balls ");
                ASSERT_NE(names, std::string::npos) << what;
                EXPECT_NE(what.substr(names, 40).find("cue"), std::string::npos) << what;
                ++failed;
            }
        }
        report(large ? "breaks with a large cue ball that ended with an error, of 500"
                     : "breaks with a heavy cue ball that ended with an error, of 500",
               failed);
        EXPECT_LE(failed, large ? 42 : 2);
    }
}

}  // namespace
}  // namespace carom::test
