// Resting contacts with turning normals: closed forms, and an independent reference with small time steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/cushion.h"
#include "reference/random_impacts.h"
#include "support/hard_scenes.h"
#include "support/resting_steps.h"

namespace carom::test {
namespace {

using reference::kDegree;

/// Plastic contacts without friction and without duration, as in the reference: only resting contacts act
/// between balls and at walls.
Scene plastic() {
    Scene scene = empty_scene();
    scene.physics.cushion = &kSmooth;
    scene.balls.mu_b = scene.balls.e_b = scene.balls.e_c = scene.balls.f_c = 0.0;
    scene.physics.clusters = ClusterModel::kRigid;
    scene.stop.time = 8.0;
    return scene;
}

/// A ball at rest whose spin is that of rolling at `s`.
void add_spinning(Scene& scene, const Vec2& r, const Vec2& s = Vec2::Zero()) {
    add_ball(scene, std::to_string(scene.ball.size()), r.x(), r.y(), 0.0, 0.0,
             Vec3(-s.y() / scene.balls.R, s.x() / scene.balls.R, 0.0));
}

Vec2 direction(double degrees) {
    return {std::cos(degrees * kDegree), std::sin(degrees * kDegree)};
}

/// [m] The largest distance between a ball of the run and of the reference once all rest.
double error_of(const Scene& scene, double step, double frequency) {
    const Record record = run_verified(scene);
    const std::vector<SteppedBall> reference = RestingSteps(scene, step, frequency).run();
    double worst = 0.0;
    for (std::size_t i = 0; i < reference.size(); ++i)
        worst = std::max(
            worst,
            length(planar(record.state_at(static_cast<int>(i), record.duration).position) - reference[i].r));
    return worst;
}

// A smooth round wall does no work, so a ball that rolls along it stops after v / (mu_r g). It once stopped
// up to a tenth late, because every re-contact skipped an interval's rolling resistance.
TEST(RestingContacts, AWallRunnerStopsWhereRollingResistanceStopsIt) {
    for (const double v : {0.2, 0.5, 1.0}) {
        for (const double mu_r : {0.008, 0.02, 0.05}) {
            Scene scene = plastic();
            scene.balls.mu_r = mu_r;
            scene.stop.time.reset();
            const double R = scene.balls.R, orbit = 0.5 - R, pull = mu_r * 9.81;
            scene.table.jaws.push_back({"wall", {0.0, 0.0}, 0.5, R, "", "inside", 0.0, 360.0});
            add_ball(scene, "runner", orbit, 0.0, 0.0, v, rolling_spin(0.0, v, R));
            const Record record = run_verified(scene);
            const std::string label = std::to_string(v) + " m/s, mu_r " + std::to_string(mu_r);
            EXPECT_NEAR(record.duration, v / pull, 1e-3) << label;
            const double angle = v * v / (2.0 * pull) / orbit;
            const Vec2 stop(orbit * std::cos(angle), orbit * std::sin(angle));
            const double off = length(planar(record.state_at(0, record.duration).position) - stop);
            EXPECT_LE(off, 2e-5) << label;
            EXPECT_LE(record.events.size(), 4u) << label;
            report(("wall runner, m: " + label).c_str(), off);
            report(("wall runner, s: " + label).c_str(), record.duration - v / pull);
        }
    }
}

// Topspin that pushes a ball obliquely; places were once wrong by 5 to 26 mm.
TEST(RestingContacts, TopspinPushesObliquely) {
    for (const double degrees : {5.0, 20.0, 45.0}) {
        Scene scene = plastic();
        add_spinning(scene, Vec2::Zero(), {2.0, 0.0});
        add_spinning(scene, 2.0 * scene.balls.R * direction(degrees));
        const double off = error_of(scene, 2e-6, 2e4);
        EXPECT_LE(off, 1e-4) << degrees;
        report(("push at degrees " + std::to_string(degrees) + ", m").c_str(), off);
    }
}

TEST(RestingContacts, TopspinPushesAVOfTwo) {
    for (const double degrees : {31.0, 40.0}) {
        Scene scene = plastic();
        add_spinning(scene, Vec2::Zero(), {2.0, 0.0});
        for (const double side : {1.0, -1.0})
            add_spinning(scene, 2.0 * scene.balls.R * direction(side * degrees));
        const double off = error_of(scene, 2e-6, 2e4);
        EXPECT_LE(off, 1e-4) << degrees;
        report(("V of two at degrees " + std::to_string(degrees) + ", m").c_str(), off);
    }
}

// The ends of a push converge with physics.tolerance.
TEST(RestingContacts, FollowTheTolerance) {
    double coarse = 0.0, fine = 0.0;
    for (const double degrees : {31.0, 36.0, 40.0}) {
        Scene scene = plastic();
        add_spinning(scene, Vec2::Zero(), {2.0, 0.0});
        for (const double side : {1.0, -1.0})
            add_spinning(scene, 2.0 * scene.balls.R * direction(side * degrees));
        const auto end = [&](double tolerance) {
            scene.physics.tolerance = tolerance;
            return planar(run_verified(scene).tracks[0].segments.back().r);
        };
        const Vec2 truth = end(1e-10);
        coarse = std::max(coarse, length(end(1e-6) - truth));
        fine = std::max(fine, length(end(1e-8) - truth));
    }
    report("resting push at 1e-6, m", coarse);
    report("resting push at 1e-8, m", fine);
    EXPECT_LT(fine, 0.5 * coarse);
}

TEST(RestingContacts, TopspinPushesABallAlongARail) {
    Scene scene = plastic();
    const double R = scene.balls.R;
    scene.table.cushions.push_back({"rail", {-2.0, 0.0}, {2.0, 0.0}, R});
    add_spinning(scene, {0.0, R + 2.0 * R * std::sin(1.0)}, {-std::cos(1.0), -2.0 * std::sin(1.0)});
    add_spinning(scene, {-2.0 * R * std::cos(1.0), R});
    const double off = error_of(scene, 2e-6, 2e4);
    EXPECT_LE(off, 1e-4);
    report("rail and ball, m", off);
}

/// Two to five balls in a tray of 0.6 m, touching each other or a rail; the spin of one pushes.
Scene small_tray(reference::Generator& rng) {
    Scene scene = plastic();
    const double R = scene.balls.R;
    scene.table = box(0.6, 0.6, R);
    scene.stop.time = 6.0;
    const auto some = [&rng](std::size_t count) {
        return static_cast<std::size_t>(rng.uniform() * static_cast<double>(count));
    };
    std::vector<Vec2> places;
    const std::size_t wanted = 2 + some(4);
    for (int tries = 0; places.size() < wanted && tries < 1000; ++tries) {
        Vec2 r(rng.uniform(0.1, 0.5), rng.uniform(0.1, 0.5));
        if (!places.empty()) {
            const double angle = rng.uniform(0.0, 360.0);
            r = places[some(places.size())] + (2.0 * R + 1e-12) * direction(angle);
        }
        if (rng.uniform() < 0.3) r.y() = R;
        const bool inside = std::min(r.x(), r.y()) >= R && std::max(r.x(), r.y()) <= 0.6 - R;
        if (inside && std::all_of(places.begin(), places.end(),
                                  [&](const Vec2& other) { return length(r - other) >= 2.0 * R; }))
            places.push_back(r);
    }
    const std::size_t pusher = some(places.size());
    const auto far = [&](std::size_t k) { return k == pusher ? 1e9 : length(places[k] - places[pusher]); };
    std::size_t near = pusher == 0 ? 1 : 0;
    for (std::size_t k = 0; k < places.size(); ++k)
        if (far(k) < far(near)) near = k;
    const Vec2 to = places[near] - places[pusher];
    const double angle = rng.uniform(-0.8, 0.8), speed = rng.uniform() < 0.5 ? 0.5 : 1.5;
    const Vec2 turned(to.x() * std::cos(angle) - to.y() * std::sin(angle),
                      to.x() * std::sin(angle) + to.y() * std::cos(angle));
    for (std::size_t k = 0; k < places.size(); ++k)
        add_spinning(scene, places[k],
                     k == pusher ? Vec2(turned * (speed / length(to))) : Vec2(Vec2::Zero()));
    return scene;
}

// The median error was once 1 mm, and one ball in ten ended 11 mm away.
TEST(RestingContacts, SmallTraysEndWhereSmallStepsEnd) {
    reference::Generator rng(64);
    std::vector<double> errors;
    for (int k = 0; k < 25; ++k) errors.push_back(error_of(small_tray(rng), 2e-6, 2e4));
    std::sort(errors.begin(), errors.end());
    EXPECT_LE(errors[12], 2e-5);
    EXPECT_LE(errors[22], 2e-4);
    report("small trays, m: median", errors[12]);
    report("small trays, m: nine of ten", errors[22]);
    report("small trays, m: largest", errors[24]);
}

}  // namespace
}  // namespace carom::test
