// Off-centre breaks against an integration in which the balls move (support/moving_contacts.h), 5 ms after
// the hit, when most contacts are over.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "carom/engine/tolerances.h"
#include "physics/cluster.h"
#include "reference/random_impacts.h"
#include "support/drawn_breaks.h"
#include "support/engine_cases.h"
#include "support/hard_scenes.h"
#include "support/moving_contacts.h"

namespace carom {
namespace {

using namespace test;

constexpr double kAfter = 5e-3;  // [s]
constexpr double kSlow = 0.05;   // [V] directions of slower balls are not compared
constexpr int kBreaks = 40;

MovingBall moving(const BallState& s) {
    return {{s.position.x(), s.position.y(), s.position.z()},
            {s.velocity.x(), s.velocity.y(), s.velocity.z()},
            {s.spin.x(), s.spin.y(), s.spin.z()}};
}

/// The hit of a break: its time, and the balls just before it.
struct FirstHit {
    double time = 0.0, speed = 0.0;
    std::vector<MovingBall> balls;
};

FirstHit hit_of(const Record& record) {
    FirstHit hit;
    for (const Event& e : record.events)
        if (balls_collide(e.type) && hit.time == 0.0) hit.time = e.time;
    for (int ball = 0; ball < static_cast<int>(record.tracks.size()); ++ball)
        hit.balls.push_back(moving(record.state_at(ball, std::nextafter(hit.time, 0.0))));
    for (const MovingBall& ball : hit.balls)
        hit.speed = std::max(hit.speed, std::hypot(ball.v[0], ball.v[1]));
    return hit;
}

// Friction is regularised as in the model; cluster_moving_test.cpp measures the cost.
MovingContacts contacts_of(const FirstHit& hit, const Scene& scene) {
    MovingLaw law;
    law.R = scene.balls.R;
    law.stiffness = kContactStiffness;
    law.mu_b = scene.balls.mu_b;
    law.mu_b_more = scene.balls.mu_b_more;
    law.mu_b_fall = scene.balls.mu_b_fall;
    law.mu_s = scene.balls.mu_s;
    law.e_b = scene.balls.e_b;
    law.slip = kClusterEpsilon;
    law.step = 2e-3;
    law.weight = scene.physics.gravity;
    law.reach = 1e9;
    return {hit.balls, law, hit.speed};
}

bool collides(const Record& record, double time) {
    for (int ball = 0; ball < static_cast<int>(record.tracks.size()); ++ball)
        if (record.state_at(ball, time).state == MotionState::kColliding) return true;
    return false;
}

/// Over many breaks: largest error of a ball's velocity [V] and direction [degrees], and median error of a
/// place [m].
struct Errors {
    std::vector<double> velocity, direction, place;
    int same_balls_potted = 0;  ///< in how many breaks
};

/// The balls in pockets after a shot from these states, or nothing if two balls still overlap.
std::optional<std::set<std::string>> potted_from(Scene scene, const std::vector<MovingBall>& balls) {
    scene.cue.reset();
    for (std::size_t b = 0; b < balls.size(); ++b) {
        const MovingBall& ball = balls[b];
        scene.ball[b].position = {ball.x[0], ball.x[1], scene.ball[b].position.z()};
        scene.ball[b].velocity = {ball.v[0], ball.v[1], 0.0};
        scene.ball[b].spin = {ball.w[0], ball.w[1], ball.w[2]};
    }
    try {
        validate(scene);
    } catch (const SceneError&) {
        return std::nullopt;
    }
    return potted(simulate(plan_of(scene)));
}

Errors errors_of(const std::string& game) {
    reference::Generator rng(63);
    Errors errors;
    while (errors.velocity.size() < kBreaks) {
        Scene scene = drawn_break(game, rng);
        const Record record = run_verified(scene);
        const FirstHit hit = hit_of(record);
        MovingContacts contacts = contacts_of(hit, scene);
        double time = hit.time + contacts.run_for(kAfter);
        while (collides(record, time)) time += contacts.run_for(0.1 * kAfter);
        const std::vector<MovingBall>& truth = contacts.balls();
        double velocity = 0.0, direction = 0.0, place = 0.0;
        for (std::size_t b = 0; b < truth.size(); ++b) {
            const MovingBall ball = moving(record.state_at(static_cast<int>(b), time)), &want = truth[b];
            velocity =
                std::max(velocity, std::hypot(ball.v[0] - want.v[0], ball.v[1] - want.v[1]) / hit.speed);
            place = std::max(place, std::hypot(ball.x[0] - want.x[0], ball.x[1] - want.x[1]));
            if (std::hypot(want.v[0], want.v[1]) < kSlow * hit.speed) continue;
            const double turn = std::atan2(ball.v[1], ball.v[0]) - std::atan2(want.v[1], want.v[0]);
            direction = std::max(direction, std::abs(std::remainder(turn, 2.0 * M_PI)) * 180.0 / M_PI);
        }
        std::optional<std::set<std::string>> want;
        while (!(want = potted_from(scene, contacts.balls()))) contacts.run_for(0.1 * kAfter);
        if (*want == potted(record)) ++errors.same_balls_potted;
        errors.velocity.push_back(velocity);
        errors.direction.push_back(direction);
        errors.place.push_back(place);
    }
    for (const double share : {0.5, 0.9, 1.0}) {
        report(fmt::format("{}, velocity [V], share {}", game, share).c_str(),
               share_of(errors.velocity, share));
        report(fmt::format("{}, direction [deg], share {}", game, share).c_str(),
               share_of(errors.direction, share));
        report(fmt::format("{}, place [m], share {}", game, share).c_str(), share_of(errors.place, share));
    }
    report(fmt::format("{}, same balls potted", game).c_str(), errors.same_balls_potted / double{kBreaks});
    return errors;
}

TEST(MovingBreaks, EightBall) {
    const Errors errors = errors_of("eight_ball");
    EXPECT_LT(share_of(errors.velocity, 0.5), 1e-4);
    EXPECT_LT(share_of(errors.velocity, 0.9), 5e-4);
    EXPECT_LT(share_of(errors.velocity, 1.0), 0.02);
    EXPECT_LT(share_of(errors.direction, 0.9), 1.0);
    EXPECT_LT(share_of(errors.place, 0.5), 1e-4);
    EXPECT_GE(errors.same_balls_potted, 0.9 * kBreaks);
}

TEST(MovingBreaks, NineBall) {
    const Errors errors = errors_of("nine_ball");
    EXPECT_LT(share_of(errors.velocity, 0.5), 1e-4);
    EXPECT_LT(share_of(errors.velocity, 0.9), 5e-4);
    EXPECT_LT(share_of(errors.velocity, 1.0), 0.02);
    EXPECT_LT(share_of(errors.direction, 0.9), 1.0);
    EXPECT_LT(share_of(errors.place, 0.5), 1e-4);
    EXPECT_GE(errors.same_balls_potted, 0.9 * kBreaks);
}

}  // namespace
}  // namespace carom
