// Hard cases that take long: H32 of tests/README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "reference/random_impacts.h"
#include "support/hard_scenes.h"

namespace carom {
namespace {

using namespace test;

// H32: 1e6 events of 16 elastic discs conserve energy and distances. Run in ten parts, each from the end of
// the last.
TEST(HardLong, AMillionEvents) {
    Scene scene = frictionless();
    scene.table = box(1.0, 2.0, 0.036576);
    scene.physics.clusters = ClusterModel::kSequential;
    reference::Generator rng(32);
    while (scene.ball.size() < 16) {
        const double x = rng.uniform(0.05, 0.95), y = rng.uniform(0.05, 1.95);
        bool free = true;
        for (const BallStart& b : scene.ball)
            free = free && std::hypot(b.position.x() - x, b.position.y() - y) > 0.1;
        if (free)
            add_ball(scene, std::to_string(scene.ball.size()), x, y, rng.uniform(-2.0, 2.0),
                     rng.uniform(-2.0, 2.0));
    }
    const auto energy = [](const Scene& s) {
        double sum = 0.0;
        for (const BallStart& b : s.ball) sum += 0.5 * b.velocity.squaredNorm();
        return sum;
    };
    const double before = energy(scene), R = scene.balls.R;
    double deepest = 0.0;
    long events = 0;
    for (int part = 0; part < 100; ++part) {
        scene.stop.events = 10000;
        const Plan plan = plan_of(scene);
        const Record record = simulate(plan);
        if (part % 25 == 0) {
            const auto violation = verify(record, plan);
            ASSERT_FALSE(violation) << violation->law << ": " << violation->message;
        }
        events += static_cast<long>(record.events.size());
        // Balls that meet are 2 R apart.
        for (const Event& e : record.events) {
            if (e.type != EventType::kBallBall) continue;
            const Vec3 p = record.state_at(e.a, e.time).position, q = record.state_at(e.b, e.time).position;
            deepest = std::max(deepest, 2.0 * R - (p - q).norm());
        }
        for (std::size_t i = 0; i < scene.ball.size(); ++i) {
            const BallState s = record.state_at(static_cast<int>(i), record.duration);
            scene.ball[i].position = s.position;
            scene.ball[i].velocity = s.velocity;
        }
    }
    const double drift = std::abs(energy(scene) / before - 1.0);
    report("H32 energy", drift);
    report("H32 penetration", deepest);
    EXPECT_EQ(events, 1000000);
    EXPECT_LE(drift, 1e-11);
    EXPECT_LE(deepest, 1e-12);
}

}  // namespace
}  // namespace carom
