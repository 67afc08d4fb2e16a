// Scenes in which one ball differs from the others; equal balls may still rest on each other.
#include <gtest/gtest.h>

#include <cstdint>
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

// A ball with topspin pushes the one before it, a metre from a heavier ball. It was once the error "there are
// balls of different size".
TEST(UnlikeBalls, EqualOnesRestOnEachOther) {
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
TEST(UnlikeBalls, AGroupUsesTheSizeOfItsBalls) {
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

// A sliding ball pushes another, and both move with one acceleration: masses and inertia add up. (Different
// sizes were once an error.)
TEST(UnlikeBalls, OfDifferentMassRestOnEachOther) {
    for (const double ratio : {0.5, 1.0, 2.0}) {
        Scene scene = two_that_rest(empty_scene().balls.size());
        scene.balls.mu_b = scene.balls.mu_r = 0.0;
        scene.balls.mu_r = 1e-6;
        if (ratio != 1.0) scene.ball[1].own = BallSize{scene.balls.R, ratio * scene.balls.m};
        scene.stop.time = 0.01;
        const Record record = run_verified(scene);
        ASSERT_EQ(count(record, EventType::kBallBallHold), 1);
        // m a = mu_s m g - N for the first, 7/5 m2 a = N for the second, which rolls.
        const double a = scene.balls.mu_s * 9.81 / (1.0 + 1.4 * ratio);
        for (int ball = 0; ball < 2; ++ball)
            EXPECT_NEAR(record.state_at(ball, 0.01).velocity.x(), a * 0.01, 1e-5) << ratio;
    }
}

// Two radii: the tilt slightly loads the cloth under the smaller ball, and both roll on together.
TEST(UnlikeBalls, OfDifferentRadiusRestOnEachOther) {
    for (const double R : {0.8, 0.95, 1.05, 1.25}) {
        Scene scene = two_that_rest(empty_scene().balls.size());
        const double own = R * scene.balls.R;
        scene.ball[1].own = BallSize{own, scene.balls.m};
        scene.ball[1].position = {contact_distance(own, scene.balls.R, false), 0.0, own};
        scene.balls.mu_b = 0.0;
        const Record record = run_verified(scene);
        EXPECT_EQ(record.stopped, StopReason::kAtRest);
        EXPECT_EQ(count(record, EventType::kBallBallHold), 1);
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
    if (seed % 2 == 0) {
        scene.physics.clusters = ClusterModel::kSequential;
        scene.physics.ball_ball = ball_ball_model(large ? "elastic" : "inelastic");
    }
    return scene;
}

// 97 of 500 breaks with the heavy cue ball and 483 of 500 with the large one once ended with that error.
TEST(UnlikeBalls, BreaksWithAnOddCueBallEndAtRest) {
    for (const bool large : {false, true}) {
        for (std::uint64_t seed = 1; seed <= 500; ++seed) {
            const Plan plan = plan_of(odd_break(seed, large));
            const Record record = simulate(plan);
            EXPECT_EQ(record.stopped, StopReason::kAtRest);
            EXPECT_FALSE(seed % 10 == 0 && verify(record, plan)) << "seed " << seed;
        }
    }
}

// Break shots into pressed racks of balls that all differ keep the laws.
TEST(UnlikeBalls, TemplateBreaks) {
    constexpr int kBreaks = 500;
    constexpr const char* kGames[] = {"nine_ball", "ten_ball", "eight_ball"};
    for (int i = 0; i < kBreaks; ++i) {
        const std::string text =
            "[balls]\nradius_sd = 2e-5\n[[ball]]\nposition = [" + std::to_string(0.2 + 0.87 * i / kBreaks) +
            ", 0.5]\n[rack]\nmethod = \"template\"\ngame = \"" + kGames[i % 3] +
            "\"\nseed = " + std::to_string(i) + "\n[cue]\naim_at = \"1\"\nball_speed = 10\n";
        const Record record = run_verified(parse_scene(text, "break.toml"));
        EXPECT_EQ(record.stopped, StopReason::kAtRest) << text;
    }
}

}  // namespace
}  // namespace carom::test
