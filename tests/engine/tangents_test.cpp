// Derivatives and margins of shots in closed form, jumps of derivatives, and shots without derivatives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "carom/engine/tangents.h"

#include "support/hard_scenes.h"
#include "support/tangent_shots.h"

namespace carom {
namespace {

using namespace test;

std::string why_not(const Scene& scene, const std::vector<std::string>& inputs) {
    try {
        Shot(scene, inputs);
    } catch (const TangentError& error) {
        return error.what();
    }
    return "";
}

// A ball that slides, then rolls to rest: d = (12/49) v^2 / (mu_s g) + (25/49) v^2 / (2 mu_r g).
TEST(Tangents, SlideAndRoll) {
    Scene scene = empty_scene();
    scene.balls.mu_s = 0.2;
    scene.balls.mu_r = 0.01;
    add_ball(scene, "1", {0.0, 0.0, scene.balls.R}, {1.5, 0.0, 0.0});
    const std::vector<std::string> inputs{"ball.1.velocity.x", "balls.mu_s", "balls.mu_r", "physics.gravity",
                                          "ball.1.position.y"};
    const Shot shot(scene, inputs);
    const double g = scene.physics.gravity, v = 1.5;
    const double slide = 12.0 / 49.0 * v * v / (0.2 * g), roll = 25.0 / 98.0 * v * v / (0.01 * g);
    const double expected[] = {2.0 * (slide + roll) / v, -slide / 0.2, -roll / 0.01, -(slide + roll) / g,
                               0.0};
    for (std::size_t k = 0; k < inputs.size(); ++k)
        EXPECT_NEAR(shot.tangents.at_end(0, k).position.x(), expected[k],
                    1e-12 * (1.0 + std::abs(expected[k])))
            << inputs[k];
    EXPECT_NEAR(shot.tangents.at_end(0, 4).position.y(), 1.0, 1e-15);
    // Sliding ends at 2 v / (7 mu_s g), and rolling 5 v / (7 mu_r g) later.
    EXPECT_NEAR(shot.tangents.event_time(0, 0), 2.0 / (7.0 * 0.2 * g), 1e-13);
    EXPECT_NEAR(shot.tangents.event_time(1, 0), 2.0 / (7.0 * 0.2 * g) + 5.0 / (7.0 * 0.01 * g), 1e-11);
}

/// Nimble's issue 97: ball 1 meets ball 2 at rest, without friction.
Scene nimble(double aside, double e_b) {
    Scene scene = frictionless();
    scene.physics.ball_ball = ball_ball_model("inelastic");
    scene.physics.clusters = ClusterModel::kSequential;
    scene.balls.R = 0.1;
    scene.balls.e_b = e_b;
    add_ball(scene, "1", {0.0, 0.0, 0.1}, {1.0, 0.0, 0.0});
    add_ball(scene, "2", {0.52, aside, 0.1});
    scene.stop.time = 1.0;
    return scene;
}

TEST(Tangents, NimblesImpact) {
    struct Case {
        double aside, e_b;
        double along[4];  ///< of x of ball 1 and of ball 2, each by both positions
        double across;    ///< of y, of any by any
    };
    const Case cases[] = {{0.0, 1.0, {0.0, 1.0, 1.0, 0.0}, 0.0},
                          {0.05, 1.0, {0.0625, 0.9375, 0.9375, 0.0625}, 0.2421},
                          {0.05, 0.8, {0.15625, 0.84375, 0.84375, 0.15625}, 0.2179}};
    for (const Case& c : cases) {
        const Shot shot(nimble(c.aside, c.e_b), {"ball.1.position.x", "ball.2.position.x"});
        for (const int ball : {0, 1})
            for (const std::size_t by : {0u, 1u}) {
                const Vec3 d = shot.tangents.at_end(ball, by).position;
                EXPECT_NEAR(d.x(), c.along[2 * ball + by], 1e-10) << c.aside << " " << c.e_b;
                EXPECT_NEAR(std::abs(d.y()), c.across, 5e-5) << c.aside << " " << c.e_b;
            }
    }
}

// Exact in linear cases: a ball passes another, and stops short of a third.
TEST(Tangents, MarginsInClosedForm) {
    Scene scene = empty_scene();
    scene.balls.mu_s = 0.2;
    scene.balls.mu_r = 0.01;
    const double R = scene.balls.R, g = scene.physics.gravity;
    const double way = (12.0 / 49.0 / 0.2 + 25.0 / 98.0 / 0.01) / g;  // of 1 m/s
    add_ball(scene, "1", {0.0, 0.0, R}, {1.0, 0.0, 0.0});
    add_ball(scene, "2", {1.0, 2.0 * R + 0.01, R});
    add_ball(scene, "3", {way + 2.0 * R + 0.02, 0.0, R});
    const Shot shot(scene, {"ball.1.position.y", "ball.1.velocity.x", "ball.2.position.y"});
    const std::vector<Margin> margins = shot.tangents.margins();
    EXPECT_NEAR(margins[0].up, 0.01, 1e-9);
    EXPECT_EQ(margins[0].up_why, "ball 1 meets ball 2 at " + margins[0].up_why.substr(23));
    EXPECT_EQ(margins[0].down, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(margins[1].up, 0.02 / (2.0 * way), 1e-9);
    EXPECT_NEAR(margins[2].down, 0.01, 1e-9);
}

// Trap 1: rolling or resting balls lie on a corner of the impact's map. Trap 2: a little vertical spin on a
// ball without any ends at once.
TEST(Tangents, CornerAndDeadZone) {
    Scene scene = scene_of("draw");
    scene.cue->speed = 0.9;
    scene.cue->height = 0.0;
    scene.cue->aim_deg = 136.0;
    scene.ball[1].position = {0.1, 2.44, scene.balls.R};
    scene.physics.tolerance = 1e-12;
    const std::vector<std::string> inputs{"cue.offset.side", "cue.aim_deg", "ball.1.position.x"};
    const Shot shot(scene, inputs);
    const auto hit = std::find_if(shot.record.events.begin(), shot.record.events.end(),
                                  [](const Event& e) { return e.type == EventType::kBallBall; });
    ASSERT_NE(hit, shot.record.events.end());
    EXPECT_EQ(shot.record.state_at(0, hit->time - 1e-3).state, MotionState::kRolling);
    EXPECT_EQ(shot.record.state_at(0, hit->time - 1e-3).spin.z(), 0.0);
    for (std::size_t k = 0; k < inputs.size(); ++k) {
        const auto error = error_of(scene, shot, inputs[k], k);
        ASSERT_TRUE(error) << inputs[k];
        EXPECT_LT(*error, 1e-8) << inputs[k];
    }
}

// Trap 3: the thinner a hit, the larger its derivatives; the margin states the distance to a miss. Without
// friction, ball 2 leaves along the line of centres.
TEST(Tangents, Graze) {
    double last = 0.0;
    for (const double thin : {1e-2, 1e-4, 1e-6}) {
        Scene scene = nimble(0.2 - thin, 1.0);
        const Shot shot(scene, {"ball.2.position.y"});
        const double across = std::abs(shot.tangents.at_end(0, 0).velocity.x());
        // After it, v_x of ball 1 is sin^2 of the angle of the line of centres, whose sine is y / 0.2.
        EXPECT_NEAR(across, 2.0 * (0.2 - thin) / 0.04, 1e-6);
        const double angle = std::abs(shot.tangents.at_end(1, 0).velocity.y());
        EXPECT_GT(angle, last);
        last = angle;
        EXPECT_NEAR(shot.tangents.margins()[0].up, thin, 1e-9);
        EXPECT_EQ(shot.tangents.margins()[0].up_why.substr(0, 20), "ball 1 misses ball 2");
    }
}

TEST(Tangents, ShotsWithoutDerivativesSayWhy) {
    const Scene draw = scene_of("draw");
    EXPECT_NE(why_not(scene_of("snooker_break"), {"cue.speed"}).find("it is a resting contact"),
              std::string::npos);
    Scene jump = scene_of("eight_ball_break");
    jump.physics.ball_ball = ball_ball_model("two_step");
    jump.cue->elevation_deg = 5.0;
    EXPECT_NE(why_not(jump, {"cue.speed"}).find("not all of them on the cloth"), std::string::npos)
        << why_not(jump, {"cue.speed"});
    Scene march = draw;
    march.physics.substeps = 1000;
    EXPECT_NE(why_not(march, {"cue.speed"}).find("substeps makes it a step function"), std::string::npos);
    Scene frozen = draw;
    frozen.cue.reset();
    frozen.ball.resize(1);
    frozen.ball[0].position = {frozen.balls.R + 1e-6, 0.5, frozen.balls.R};
    frozen.ball[0].velocity = {-1e-4, 0.1, 0.0};
    frozen.ball[0].spin = {0.0, -40.0, 0.0};  // drives it further into the cushion
    EXPECT_NE(why_not(frozen, {"ball.cue.velocity.y"}).find("resting contact"), std::string::npos);
    Scene fit = draw;
    fit.balls.mu_b = 0.009951, fit.balls.mu_b_more = 0.108, fit.balls.mu_b_fall = 1.088;
    EXPECT_EQ(why_not(fit, {"balls.mu_b"}),
              "balls.mu_b replaces a fit of the scene; name a number of the fit instead: balls.mu_b_fit.0");
    EXPECT_EQ(why_not(fit, {"balls.mu_b_fit.0"}), "");
    Scene elastic = draw;
    elastic.balls.e_b = 1.0;
    EXPECT_EQ(why_not(elastic, {"balls.e_b"}),
              "balls.e_b = 1 is at the end of its range, where it has no derivative; move it inwards");
    EXPECT_THROW(Shot(draw, {"cue.spede"}), std::invalid_argument);
    EXPECT_THROW(Shot(draw, {"table.size.0"}), std::invalid_argument);
    // A record from a file may belong to another scene.
    Scene bare = draw;
    bare.table = Table();
    EXPECT_THROW(Tangents(plan_of(bare), simulate(plan_of(draw)), {"cue.speed"}), std::invalid_argument);
    const Scene three = combination(0.3);
    Record wrong = simulate(plan_of(three));
    std::erase(wrong.clusters[0].balls, 1);
    EXPECT_THROW(Tangents(plan_of(three), wrong, {"cue.speed"}), std::invalid_argument);
    // The time before an event without derivatives still has them.
    const Plan plan = plan_of(scene_of("snooker_break"));
    const Record record = simulate(plan);
    const double first = record.events[1].time;
    const Tangents tangents(plan, record, {"cue.speed"}, 0.5 * first);
    EXPECT_GT(tangents.state_at(0, 0.5 * first, 0).velocity.norm(), 0.5);
}

}  // namespace
}  // namespace carom
