// Throw, spin transfer and curved paths in whole shots (tests/README.md: T10, T11, the throw table 7b,
// masse).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carom/engine/ball_ball.h"
#include "carom/engine/math.h"
#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

constexpr double kDegree = 3.14159265358979323846 / 180.0;

// One impact at cut angle phi [degrees] of a ball with speed v and spin (about the left of its path, and
// vertical).
double throw_deg(double phi, double v, bool rolls, double w_z, double fall, double e_b = 1.0) {
    Scene scene = instant_scene();
    scene.balls.mu_b = 9.951e-3;
    scene.balls.mu_b_more = 0.108;
    scene.balls.mu_b_fall = fall;
    scene.balls.e_b = e_b;
    scene.balls.mu_s = 0.0;  // the impact alone: no cloth before it
    scene.physics.ball_ball = ball_ball_model("inelastic");
    scene.stop.events = 1;
    const double R = scene.balls.R;
    const Vec2 n(std::cos(phi * kDegree), std::sin(phi * kDegree));
    add_ball(scene, "a", 0.0, 0.0, v, 0.0, Vec3(0.0, rolls ? v / R : 0.0, w_z));
    add_ball(scene, "b", 2.0 * R * n.x(), 2.0 * R * n.y());
    const Record record = simulate(plan_of(scene));
    EXPECT_EQ(count(record, EventType::kBallBall), 1);
    const Vec3 u = record.tracks[1].segments.back().v;
    return (phi * kDegree - std::atan2(u.y(), u.x())) / kDegree;
}

// T10: Alciatore, TP A.14. Positive towards the side from which the cue ball came.
double formula_deg(double phi, double v, bool rolls, double R_wz) {
    const double s = std::sin(phi * kDegree), c = std::cos(phi * kDegree);
    const double along = v * s - R_wz, up = rolls ? v * c : 0.0;
    const double slip = std::hypot(along, up);
    const double mu = 9.951e-3 + 0.108 * std::exp(-1.088 * slip);
    const double k = std::min(mu * v * c / slip, 1.0 / 7.0);
    return std::atan(k * along / (v * c)) / kDegree;
}

TEST(Throw, FollowsTheFormulaForAnySpeedCutAndSide) {
    for (const double v : {0.1, 0.447, 1.341, 3.129, 8.0})
        for (const double phi : {2.0, 10.0, 20.0, 30.0, 45.0, 60.0, 80.0})
            for (const bool rolls : {false, true})
                for (const double side : {-20.0, 0.0, 7.0, 40.0}) {
                    const double R = 0.028575;
                    EXPECT_NEAR(throw_deg(phi, v, rolls, side, 1.088), formula_deg(phi, v, rolls, R * side),
                                1e-9)
                        << v << " m/s, " << phi << " deg, rolls " << rolls << ", side " << side;
                }
}

// The table of tests/README.md, 7b, as printed.
TEST(Throw, Table7b) {
    const double speeds[] = {0.447, 1.341, 3.129};
    const double table[][7] = {{10, 1.443, .760, 1.443, .349, 1.443, .135},
                               {20, 2.976, 1.496, 2.976, .687, 2.500, .265},
                               {30, 4.715, 2.186, 3.549, 1.004, 1.698, .388},
                               {45, 4.945, 3.091, 2.773, 1.420, 1.127, .549},
                               {60, 4.621, 3.783, 2.318, 1.739, .895, .672}};
    for (const auto& row : table) {
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(throw_deg(row[0], speeds[k], false, 0.0, 1.088), row[1 + 2 * k], 6e-4)
                << row[0] << " stun " << speeds[k];
            EXPECT_NEAR(throw_deg(row[0], speeds[k], true, 0.0, 1.088), row[2 + 2 * k], 6e-4)
                << row[0] << " roll " << speeds[k];
        }
    }
    const double maxima[][3] = {{0.447, 5.3023, 33.01}, {1.341, 3.8754, 25.37}, {3.129, 2.6977, 18.26}};
    for (const auto& m : maxima) {
        EXPECT_NEAR(throw_deg(m[2], m[0], false, 0.0, 1.088), m[1], 1e-4);
        EXPECT_LT(throw_deg(m[2] - 1.0, m[0], false, 0.0, 1.088), m[1]);
        EXPECT_LT(throw_deg(m[2] + 1.0, m[0], false, 0.0, 1.088), m[1]);
    }
}

// T11: without slip at the end, throw = atan(tan(phi) / 7); e_b < 1 reduces the normal speed, so multiply by
// 2 / (1 + e_b).
TEST(Throw, NoSlipLimit) {
    EXPECT_NEAR(throw_deg(10.0, 0.1, false, 0.0, 0.0), 1.44295, 1e-5);
    EXPECT_NEAR(throw_deg(20.0, 0.1, false, 0.0, 0.0), 2.97646, 1e-5);
    EXPECT_NEAR(throw_deg(30.0, 0.1, false, 0.0, 0.0), 4.71500, 1e-5);
    const double tangent = std::tan(throw_deg(20.0, 0.1, false, 0.0, 0.0, 0.9) * kDegree);
    EXPECT_NEAR(tangent, std::tan(20.0 * kDegree) / 7.0 * 2.0 / 1.9, 1e-12);
}

TEST(Throw, FrictionFallsWithTheSlip) {
    BallParams p = pool_balls();
    EXPECT_EQ(p.ball_friction()(0.0), p.mu_b);
    EXPECT_EQ(p.ball_friction()(3.0), p.mu_b);
    p.mu_b = 9.951e-3;
    p.mu_b_more = 0.108;
    p.mu_b_fall = 1.088;
    EXPECT_EQ(p.ball_friction()(0.0), 9.951e-3 + 0.108);
    for (const double u : {0.1, 1.0, 10.0})
        EXPECT_NEAR(p.ball_friction()(u), 9.951e-3 + 0.108 * std::exp(-1.088 * u), 1e-16);
    // Marlow's points, as quoted in TP A.14.
    EXPECT_NEAR(p.ball_friction()(0.07), 0.11, 0.01);
    EXPECT_NEAR(p.ball_friction()(0.71), 0.06, 0.001);
    EXPECT_NEAR(p.ball_friction()(7.1), 0.01, 0.0001);
}

// In the model mathavan the fit sets the friction of the impact.
TEST(Throw, MathavanUsesTheFrictionOfItsSlip) {
    Scene fit = instant_scene();
    fit.stop.events = 1;
    fit.balls.mu_b = 0.01;
    fit.balls.mu_b_more = 0.1;
    fit.balls.mu_b_fall = 1.0;
    const double R = fit.balls.R;
    add_ball(fit, "a", 0.0, 0.0, 1.0, 0.0);
    add_ball(fit, "b", R, R * std::sqrt(3.0));  // cut of 60 degrees: slip sin(60)
    Scene constant = fit;
    constant.balls.mu_b = fit.balls.ball_friction()(std::sqrt(0.75));
    constant.balls.mu_b_more = 0.0;
    const Record a = simulate(plan_of(fit)), b = simulate(plan_of(constant));
    EXPECT_LE((a.tracks[1].segments.back().v - b.tracks[1].segments.back().v).norm(), 1e-14);
    EXPECT_LE((a.tracks[1].segments.back().w - b.tracks[1].segments.back().w).norm(), 1e-12);
}

// Masse (T2, Coriolis): a raised cue with side curves the path; the final direction is v - (2/7) u, from the
// point where the cue's line meets the cloth. Without elevation, a ball struck with side goes straight.
TEST(Masse, ElevationAndSideCurveThePath) {
    const auto shot = [](double elevation, double side) {
        Scene scene = instant_scene();
        add_ball(scene, "cue", 0.0, 0.0);
        Cue cue;
        cue.speed = 3.0;
        cue.aim_deg = 0.0;
        cue.elevation_deg = elevation;
        cue.side = side;
        cue.height = 0.0;
        cue.end_mass = 0.0;
        scene.physics.vertical = Vertical::kDrop;  // no hop in between
        scene.cue = cue;
        return simulate(plan_of(scene));
    };
    for (const double elevation : {20.0, 45.0, 70.0}) {
        for (const double side : {-0.4, 0.2, 0.4}) {
            const Record record = shot(elevation, side);
            const Event* roll = first(record, EventType::kSlideRoll);
            ASSERT_NE(roll, nullptr);
            const Segment& start = record.tracks[0].segments[1];
            const BallState end = record.state_at(0, roll->time);
            const double R = 0.028575;
            const Vec2 u(start.v.x() - R * start.w.y(), start.v.y() + R * start.w.x());
            const Vec2 want = start.v.head<2>() - (2.0 / 7.0) * u;
            EXPECT_LE((end.velocity.head<2>() - want).norm(), 1e-13);
            EXPECT_GT(end.velocity.y() * side, 0.0) << "left side curves to the left";
            // Halfway the ball has bent less than half: a parabola, not a corner.
            const BallState middle = record.state_at(0, 0.5 * roll->time);
            EXPECT_NEAR(middle.position.y(), 0.25 * end.position.y(), 1e-12);
            // The Coriolis construction: w = (5 v / 2R)(-a sin(th) t - a cos(th) z), so the final angle has a
            // closed form.
            const SinCos th = sin_cos_deg(elevation);
            EXPECT_NEAR(end.velocity.y() / end.velocity.x(), side * th.sin / th.cos, 1e-12);
        }
    }
    const Record flat = shot(0.0, 0.4);
    for (double t = 0.0; t < flat.duration; t += 0.1) EXPECT_EQ(flat.state_at(0, t).position.y(), 0.0);
    const Record centre = shot(60.0, 0.0);
    for (double t = 0.0; t < centre.duration; t += 0.1) EXPECT_EQ(centre.state_at(0, t).position.y(), 0.0);
}

}  // namespace
}  // namespace carom
