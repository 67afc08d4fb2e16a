// The judge judged: a record that breaks a law is caught, by the law's name.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "support/engine_cases.h"

namespace carom::test {
namespace {

/// Two balls that roll behind one another on a table; the second is hit, and both come to rest.
Plan roll_and_hit() {
    Scene scene = empty_scene();
    scene.table = make_table("nine_foot");
    scene.balls.mu_s = 0.0;  // no cloth in the impact: U5 and U6 are exact
    scene.stop.time = 2.0;
    add_ball(scene, "a", {0.5, 0.5, scene.balls.R}, {0.0, 0.8, 0.0}, {-0.8 / scene.balls.R, 0.0, 0.0});
    add_ball(scene, "b", {0.52, 0.9, scene.balls.R});
    return plan_of(scene);
}

TEST(Verify, NamesTheLawThatARecordBreaks) {
    const Plan plan = roll_and_hit();
    const Record good = simulate(plan);
    ASSERT_EQ(verify(good, plan), std::nullopt);
    std::size_t hit = 0;
    while (hit < good.events.size() && good.events[hit].type != EventType::kBallBall) ++hit;
    ASSERT_LT(hit, good.events.size());
    const auto after_hit = [&](Record& r) -> Segment& {
        for (Segment& s : r.tracks[1].segments)
            if (s.start == good.events[hit].time) return s;
        throw std::runtime_error("the ball that was hit has no segment there");
    };
    const struct {
        const char *law, *says;
        std::function<void(Record&)> spoil;
    } cases[] = {
        {"U1", "ball b at 0 s holds a number that is not finite",
         [](Record& r) { r.tracks[1].segments[0].v.x() = std::numeric_limits<double>::quiet_NaN(); }},
        {"U2", "time falls from",
         [&](Record& r) {
             r.events.push_back(r.events[hit]);
             r.events.back().time = 0.0;
         }},
        {"U3", "balls a and b overlap by",
         [](Record& r) {
             for (Segment& s : r.tracks[1].segments) s.r.y() -= 1e-3;
         }},
        {"U3", "deep in a cushion",
         [&](Record& r) {
             for (Segment& s : r.tracks[1].segments) s.r.x() = good.size(1).R - 1e-3;
         }},
        {"U3", "deep in a jaw",
         [&](Record& r) {
             // Just beyond the end of a cushion, where its round end is and the cushion is not.
             const CushionLine& line = plan.geometry.cushions.front();
             for (Segment& s : r.tracks[1].segments) s.r.head<2>() = line.from - 0.005 * line.direction;
         }},
        {"U4", "energy rises", [&](Record& r) { after_hit(r).w.z() += 100.0; }},
        {"U5", "changes the pair's momentum", [&](Record& r) { after_hit(r).v *= 0.9; }},
        {"U6", "turns a ball about the line of centres", [&](Record& r) { after_hit(r).w *= 0.5; }},
        {"U7", "rolls and slips",
         [&](Record& r) {
             Segment& s = r.tracks[0].segments.back();  // less energy than there was
             s.state = MotionState::kRolling;
             s.w = Vec3::Zero();
         }},
        {"U8", "too many events",
         [&](Record& r) {
             const Event tick{good.events[hit].time, EventType::kSlideRoll, 0, -1};
             r.events.insert(r.events.begin() + static_cast<std::ptrdiff_t>(hit), 20000, tick);
         }},
        {"U9", "ball a has not come to rest", [](Record& r) { r.stopped = StopReason::kAtRest; }},
    };
    for (const auto& c : cases) {
        Record bad = good;
        c.spoil(bad);
        const std::optional<Violation> violation = verify(bad, plan);
        ASSERT_TRUE(violation) << c.law << " " << c.says;
        EXPECT_EQ(violation->law, c.law) << violation->message;
        EXPECT_NE(violation->message.find(c.says), std::string::npos) << violation->message;
    }
}

}  // namespace
}  // namespace carom::test
