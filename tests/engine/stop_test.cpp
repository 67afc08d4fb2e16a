// A run ends at rest, at its time limit, at its event limit, or when no event can follow.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/tolerances.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

constexpr double kStop = 0.75;

struct Endless {
    const char* name;
    MotionState state;  // of ball "a" at the end
    Scene scene;
};

/// Endless motion without further events from some time before kStop.
std::vector<Endless> endless_scenes() {
    std::vector<Endless> all;
    const auto add = [&all](const char* name, MotionState state, const std::function<void(Scene&)>& build) {
        Scene scene = empty_scene();
        scene.stop.time = kStop;
        build(scene);
        all.push_back({name, state, scene});
    };
    add("no gravity, cushions out of reach", MotionState::kSliding, [](Scene& s) {
        s.table = box(10.0, 10.0, 0.0365);
        s.physics.gravity = 0.0;
        add_ball(s, "a", 5.0, 5.0, 1.0, 0.5);
    });
    add("no gravity, endless cloth", MotionState::kSliding, [](Scene& s) {
        s.physics.gravity = 0.0;
        add_ball(s, "a", 0.5, 0.5, 1.0, 0.5, {1.0, 2.0, 3.0});
    });
    add("mu_s = 0", MotionState::kSliding, [](Scene& s) {
        s.balls.mu_s = 0.0;
        add_ball(s, "a", 0.5, 0.5, 1.0, 0.5);
    });
    add("mu_r = 0, after slipping", MotionState::kRolling, [](Scene& s) {
        s.balls.mu_r = 0.0;
        add_ball(s, "a", 0.5, 0.5, 1.0, 0.5);
    });
    add("mu_sp = 0, in place", MotionState::kSpinning, [](Scene& s) {
        s.balls.mu_sp = 0.0;
        add_ball(s, "a", 0.5, 0.5, 0.0, 0.0, {0.0, 0.0, 5.0});
    });
    add("mu_sp = 0, one spins and one has stopped", MotionState::kSpinning, [](Scene& s) {
        s.balls.mu_sp = 0.0;
        add_ball(s, "a", 0.5, 0.5, 0.0, 0.0, {0.0, 0.0, 5.0});
        add_ball(s, "b", 0.7, 0.5, 0.01, 0.0);
    });
    add("two balls after their impact", MotionState::kSliding, [](Scene& s) {
        s.physics.gravity = 0.0;
        add_ball(s, "a", 0.5, 0.5, 1.0, 0.3);
        add_ball(s, "b", 0.8, 0.5);
    });
    add("a ball behind a falling one", MotionState::kSliding, [](Scene& s) {
        s.physics.gravity = 0.0;
        s.table.pockets = {{"p1", {0.5, 0.8}, 0.06, 0.1}};
        add_ball(s, "a", 0.5, 0.2, 0.3, 0.0);
        add_ball(s, "b", 0.5, 0.5, 0.0, 1.0);
    });
    add("forty balls that fly apart", MotionState::kSliding, [](Scene& s) {
        s.physics.gravity = 0.0;
        add_ball(s, "a", 1.0, 0.0, 1.0, 0.0);
        for (int i = 1; i < 40; ++i) {
            const double angle = 2.0 * M_PI * i / 40.0, x = std::cos(angle), y = std::sin(angle);
            add_ball(s, "b" + std::to_string(i), x, y, x, y);
        }
    });
    return all;
}

TEST(Stop, EndlessMotionContinuesToTheStopTime) {
    for (const Endless& c : endless_scenes()) {
        const Record record = run_verified(c.scene);
        EXPECT_EQ(record.duration, kStop) << c.name;
        EXPECT_EQ(record.stopped, StopReason::kTime) << c.name;
        ASSERT_TRUE(record.events.empty() || record.events.back().time < kStop) << c.name;
        const BallState end = record.state_at(0, kStop), before = record.state_at(0, 0.5 * kStop);
        EXPECT_EQ(end.state, c.state) << c.name;
        if (c.state == MotionState::kSpinning)
            EXPECT_EQ(end.spin.z(), 5.0) << c.name;
        else
            EXPECT_GT((end.position - before.position).norm(), 0.1) << c.name;
    }
}

TEST(Stop, TheCallsTimeLimitAlsoStopsARun) {
    for (Endless& c : endless_scenes()) {
        c.scene.stop.time = 100.0;
        const Plan plan = plan_of(c.scene);
        SimulateOptions options;
        options.until = kStop;
        const Record record = simulate(plan, options);
        EXPECT_EQ(record.duration, kStop) << c.name;
        EXPECT_EQ(record.stopped, StopReason::kTime) << c.name;
        EXPECT_EQ(verify(record, plan), std::nullopt) << c.name;
    }
}

// If the events never come, the run ends without claiming to be at rest.
TEST(Stop, AnUnreachedEventLimitEndsTheRunAtTheLastEvent) {
    for (Endless& c : endless_scenes()) {
        if (!c.scene.table.cushions.empty()) continue;
        c.scene.stop.time.reset();
        c.scene.stop.events = 1000;
        for (const double until : {-1.0, std::numeric_limits<double>::infinity()}) {
            const Plan plan = plan_of(c.scene);
            SimulateOptions options;
            if (until > 0.0) options.until = until;
            const Record record = simulate(plan, options);
            EXPECT_EQ(verify(record, plan), std::nullopt) << c.name;
            EXPECT_EQ(record.stopped, StopReason::kEndless) << c.name;
            EXPECT_EQ(record.duration, record.events.empty() ? 0.0 : record.events.back().time) << c.name;
        }
    }
}

TEST(Stop, AReachedEventLimitEndsTheRun) {
    Scene scene = empty_scene();
    scene.table = box(10.0, 10.0, 0.0365);
    scene.physics.gravity = 0.0;
    add_ball(scene, "a", 5.0, 5.0, 1.0, 0.5);
    scene.stop.events = 3;
    const Record record = run_verified(scene);
    EXPECT_EQ(record.stopped, StopReason::kEvents);
    EXPECT_EQ(record.events.size(), 3u);
}

// A ball that almost never stops bouncing. A run's size is limited even if the scene sets no limit or a
// larger one.
TEST(Stop, ARunWithoutEndHasALimitOfEvents) {
    Scene scene = empty_scene();
    scene.balls.e_t = 0.9999999;
    add_ball(scene, "a", 0.5, 0.5);
    scene.ball[0].height = 0.1;
    scene.ball[0].position.z() += 0.1;
    RunBuffers buffers;
    Outcome outcome;
    const struct {
        std::optional<std::int64_t> events;
        const char *at, *why;
    } kCases[] = {
        {std::nullopt, " s after 1000000 events: ",
         "too many events; allow more with [stop] events, or end the run earlier with [stop] time"},
        {INT64_MAX, " s after 10000000 events: ", "a run cannot have more events"},
    };
    for (const auto& c : kCases) {
        scene.stop.events = c.events;
        try {
            simulate(plan_of(scene), buffers, outcome);
            ADD_FAILURE() << "no limit";
        } catch (const SimulationError& error) {
            const std::string text = error.what();
            EXPECT_NE(text.find(c.at), std::string::npos) << text;
            EXPECT_NE(text.find(c.why), std::string::npos) << text;
            EXPECT_NE(text.find("last events:\n"), std::string::npos) << text;
            EXPECT_NE(text.find("\n  a airborne 0.5 0.5 "), std::string::npos) << text;
        }
    }
    scene.stop.events = kUsualEvents + 1;
    simulate(plan_of(scene), buffers, outcome);
    EXPECT_EQ(outcome.stopped, StopReason::kEvents);
    EXPECT_EQ(outcome.events, kUsualEvents + 1);
}

TEST(Stop, RestEndsARunBeforeItsTimeLimit) {
    Scene scene = empty_scene();
    scene.table.pockets = {{"p1", {0.5, 0.8}, 0.06, 0.1}};
    scene.stop.time = 1000.0;
    add_ball(scene, "a", 0.2, 0.5, 0.5, 0.0);
    add_ball(scene, "b", 0.5, 0.5, 0.0, 1.0);
    const Record record = run_verified(scene);
    EXPECT_EQ(record.stopped, StopReason::kAtRest);
    EXPECT_EQ(count(record, EventType::kBallPocket), 1);
    EXPECT_EQ(record.duration, record.events.back().time);
}

TEST(Stop, EndlessMotionIsNotRest) {
    const Plan plan = plan_of(endless_scenes().front().scene);
    Record record = simulate(plan);
    record.stopped = StopReason::kAtRest;
    const auto violation = verify(record, plan);
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->law, "U8");
}

}  // namespace
}  // namespace carom::test
