// Clusters whose balls move during the contact: against an independent integration
// (support/moving_contacts.h), and continuous in a third ball's position, also where an impact stops being a
// cluster.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "carom/engine/tolerances.h"
#include "support/engine_cases.h"
#include "support/hard_scenes.h"
#include "support/moving_contacts.h"

namespace carom {
namespace {

using namespace test;

constexpr double kBallR = 0.028575;  // [m] of pool balls

/// The state in which a ball enters an event at `time`, or leaves it (for a cluster with a duration: at its
/// end).
MovingBall state(const Record& record, int ball, double time, bool after) {
    const std::vector<Segment>& list = record.tracks[ball].segments;
    std::size_t k = 0;
    while (k + 1 < list.size() && (after ? list[k + 1].start <= time : list[k + 1].start < time)) ++k;
    if (after && list[k].state == MotionState::kColliding) time = list[++k].start;
    const double t = time - list[k].start;
    const Vec3 r = position_at(list[k], t), v = velocity_at(list[k], t), w = spin_at(list[k], t, kBallR);
    return {{r.x(), r.y(), r.z()}, {v.x(), v.y(), v.z()}, {w.x(), w.y(), w.z()}};
}

MovingLaw law_of(const BallParams& p) {
    MovingLaw law;
    law.R = p.R;
    law.stiffness = kContactStiffness;
    law.mu_b = p.mu_b;
    law.mu_s = p.mu_s;
    law.e_b = p.e_b;
    law.mu_b_more = p.mu_b_more;
    law.mu_b_fall = p.mu_b_fall;
    return law;
}

double difference(const MovingBall& a, const MovingBall& b) {
    return std::hypot(a.v[0] - b.v[0], a.v[1] - b.v[1]);
}

/// Largest velocity difference after the first cluster of a break [cue-ball speed]. Whether a slow contact
/// some 4 L/V after the others belongs to the cluster is ambiguous, so the integration is read at the
/// contact-free instant of best agreement.
double first_cluster_error(double gap, double speed, double aim_deg) {
    const Scene scene =
        parse_scene("[rack]\ngame = \"eight_ball\"\ngap = " + std::to_string(gap) +
                        "\n[cue]\nball = \"cue\"\nspeed = " + std::to_string(speed) +
                        "\naim_deg = " + std::to_string(aim_deg) +
                        "\n[[ball]]\nid = \"cue\"\nposition = [0.635, 0.6]\n[stop]\nevents = 6\n",
                    "s.toml");
    const Record record = run_verified(scene);
    const auto event = std::find_if(record.events.begin(), record.events.end(),
                                    [](const Event& e) { return e.type == EventType::kBallCluster; });
    if (event == record.events.end()) return 1.0;
    const std::vector<int>& members = record.clusters[event->detail].balls;
    EXPECT_EQ(members.size(), 16u);
    std::vector<MovingBall> before, after;
    double V = 0.0;
    for (const int ball : members) {
        before.push_back(state(record, ball, event->time, false));
        after.push_back(state(record, ball, event->time, true));
        V = std::max(V, std::hypot(before.back().v[0], before.back().v[1]));
    }
    MovingLaw law = law_of(scene.balls);
    law.look_ahead = 8.0;
    MovingContacts truth(before, law, V);
    EXPECT_GT(truth.run(), 0.0);
    double least = 1.0;
    for (const std::vector<MovingBall>& end : truth.ends()) {
        double worst = 0.0;
        for (std::size_t b = 0; b < end.size(); ++b)
            worst = std::max(worst, difference(after[b], end[b]) / V);
        least = std::min(least, worst);
    }
    return least;
}

// The gaps below compare with the compression of the balls. They were chosen for softer balls, which compress
// more by this ratio.
const double kCompression = std::pow(3.094e9 / 4.736e9, 0.4);

// [V] Largest error of a break's first cluster, and largest jump of a velocity, as stated in
// docs/design/hard_cases.md.
constexpr double kClusterError = 3e-3, kClusterJump = 6e-3;

TEST(MovingCluster, BreaksFollowAnIndependentIntegration) {
    for (const double gap : {0.0, 1e-4, 3e-4}) {
        std::vector<double> errors;
        for (int k = 0; k < 16; ++k)
            errors.push_back(first_cluster_error(kCompression * gap, 6.5 + 0.25 * k, 89.7 + 0.04 * k));

        report(("break, gap " + std::to_string(gap) + ", error in V").c_str(),
               *std::max_element(errors.begin(), errors.end()));
        EXPECT_LT(*std::max_element(errors.begin(), errors.end()), kClusterError) << gap;
        EXPECT_GT(*std::min_element(errors.begin(), errors.end()), 0.0);
    }
}

struct Three {
    double gap, angle;  // of the third ball: gap to the second [m], angle of their line off the shot [rad]
    double cut = 0.1;   // sine of the angle at which the cue ball meets the second one
    double mu_b = 0.05, mu_s = 0.0, e_b = 0.95;
};

constexpr double kSpeed = 5.0, kTime = 0.03;  // [m/s], [s]

Record play(const Three& three) {
    Scene scene = empty_scene();
    scene.balls.mu_b = three.mu_b;
    scene.balls.mu_s = three.mu_s;
    scene.balls.e_b = three.e_b;
    const double R = scene.balls.R, apart = 2.0 * R + three.gap;
    add_ball(scene, "cue", 2.0 * R * three.cut, -3.0 * R, 0.0, kSpeed);
    add_ball(scene, "one", 0.0, 0.0);
    add_ball(scene, "two", apart * std::sin(three.angle), apart * std::cos(three.angle));
    scene.stop.time = kTime;
    return simulate(plan_of(scene));
}

/// The state after all impacts, in units of the speed.
struct Outcome3 {
    std::array<double, 9> motion;
    std::vector<EventType> impacts;
    bool whole;  // no impact near the end of the run, where it might or might not happen
};

Outcome3 outcome(const Three& three) {
    const Record record = play(three);
    Outcome3 out;
    double last = 0.0;
    for (const Event& e : record.events) {
        if (!balls_collide(e.type)) continue;
        out.impacts.push_back(e.type);
        last = e.time;
    }
    out.whole = last < 0.8 * kTime;
    for (int ball = 0; ball < 3; ++ball) {
        const MovingBall b = state(record, ball, last, true);
        const double motion[] = {b.v[0], b.v[1], kBallR * b.w[2]};
        for (std::size_t k = 0; k < 3; ++k)
            out.motion[3 * static_cast<std::size_t>(ball) + k] = motion[k] / kSpeed;
    }
    return out;
}

double difference(const Outcome3& a, const Outcome3& b) {
    double most = 0.0;
    for (std::size_t k = 0; k < a.motion.size(); ++k)
        most = std::max(most, std::abs(a.motion[k] - b.motion[k]));
    return most;
}

// A third ball, from touching to a gap at which the impacts are successive.
TEST(MovingCluster, AThirdBallFollowsAnIndependentIntegration) {
    struct Case {
        double angle, gap, error;
    };
    // Far balls are met in zero time, as the pair kernel does; this causes the errors of the last rows.
    for (const Case& c :
         {Case{0.4, 0.0, 1e-3}, Case{0.4, 5e-4, 5e-4}, Case{0.9, 1e-4, 1e-3}, Case{0.9, 5e-4, 1.1e-4},
          Case{1.4, 1e-4, 5e-4}, Case{1.4, 0.16235795638398e-3, 0.0170}, Case{0.9, 1.0264e-3, 0.0120},
          Case{0.4, 1.4976e-3, 0.0065}}) {
        const Record record = play({.gap = kCompression * c.gap, .angle = c.angle, .mu_s = 0.2});
        const auto first = std::find_if(record.events.begin(), record.events.end(),
                                        [](const Event& e) { return balls_collide(e.type); });
        ASSERT_NE(first, record.events.end());
        std::vector<MovingBall> balls;
        for (int ball = 0; ball < 3; ++ball) balls.push_back(state(record, ball, first->time, false));
        MovingLaw law = law_of(pool_balls());
        law.weight = 9.81;
        MovingContacts truth(balls, law, kSpeed);
        double last = 0.0, worst = 0.0;
        for (const Event& e : record.events)
            if (balls_collide(e.type)) last = e.time;
        for (const Segment& s : record.tracks[0].segments)
            if (s.state == MotionState::kColliding) last = std::max(last, s.start + s.duration);
        last = first->time + truth.run_for(last - first->time);
        for (std::size_t ball = 0; ball < 3; ++ball)
            worst = std::max(
                worst, difference(state(record, static_cast<int>(ball), last, true), truth.balls()[ball]));
        report(("third ball, " + std::to_string(c.angle) + " rad, " + std::to_string(1e3 * c.gap) + " mm")
                   .c_str(),
               worst / kSpeed);
        EXPECT_LT(worst / kSpeed, c.error) << c.angle << " " << c.gap;
    }
}

/// Change of the outcome between neighbouring doubles, found by bisecting the half that changes more.
double jump(const Three& from, const Three& to) {
    Three a = from, b = to;
    Outcome3 at_a = outcome(a), at_b = outcome(b);
    if (!at_a.whole || !at_b.whole) return 0.0;
    for (;;) {
        Three middle = a;
        middle.gap = 0.5 * (a.gap + b.gap);
        middle.angle = 0.5 * (a.angle + b.angle);
        const bool end = (middle.gap == a.gap || middle.gap == b.gap) &&
                         (middle.angle == a.angle || middle.angle == b.angle);
        if (end || difference(at_a, at_b) < 1e-13) return difference(at_a, at_b);
        const Outcome3 at = outcome(middle);
        const bool first = difference(at_a, at) >= difference(at, at_b);
        (first ? b : a) = middle;
        (first ? at_b : at_a) = at;
    }
}

/// Largest jump on a line of shots: bisects where the kinds of impacts change, and the three steepest parts.
double largest_jump(Three from, const Three& to, int parts) {
    struct Part {
        double steep;
        Three a, b;
    };
    std::vector<Part> list;
    Outcome3 before = outcome(from);
    const double gap = (to.gap - from.gap) / parts, angle = (to.angle - from.angle) / parts;
    for (int k = 0; k < parts; ++k) {
        Three next = from;
        next.gap += gap;
        next.angle += angle;
        const Outcome3 after = outcome(next);
        list.push_back(
            {difference(before, after) + (before.impacts == after.impacts ? 0.0 : 1.0), from, next});
        from = next;
        before = after;
    }
    std::sort(list.begin(), list.end(), [](const Part& p, const Part& q) { return p.steep > q.steep; });
    double most = 0.0;
    for (std::size_t k = 0; k < list.size() && (k < 3 || list[k].steep >= 1.0); ++k)
        most = std::max(most, jump(list[k].a, list[k].b));
    return most;
}

// A cluster becomes impacts of two balls where a third ball gets out of reach. These act along the right
// line, but their balls do not move during the contact, and so meet the third ball up to 0.4 mm beside their
// true places.
TEST(MovingCluster, ResultsAreContinuousInGapAndAngle) {
    for (const double mu_b : {0.0, 0.05}) {
        double worst = 0.0;
        for (const double cut : {0.1, 0.6}) {
            for (double angle = 0.15; angle < 1.5; angle += 0.25)
                worst = std::max(worst,
                                 largest_jump({.gap = 0.0, .angle = angle, .cut = cut, .mu_b = mu_b},
                                              {.gap = 2e-3, .angle = angle, .cut = cut, .mu_b = mu_b}, 100));
            for (const double gap : {0.0, 1e-4, 4e-4, 1e-3})
                worst =
                    std::max(worst, largest_jump({.gap = gap, .angle = 0.1, .cut = cut, .mu_b = mu_b},
                                                 {.gap = gap, .angle = 1.5, .cut = cut, .mu_b = mu_b}, 100));
        }
        report(("largest jump in V, mu_b " + std::to_string(mu_b)).c_str(), worst);
        EXPECT_LT(worst, kClusterJump);
    }
}

}  // namespace
}  // namespace carom
