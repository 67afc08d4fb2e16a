#include "contact/resting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "contact/resting_solver.h"
#include "contact/roots.h"

namespace carom {

namespace {

// [-] Stands for a smaller restitution in the rule of holds(), where no bounce is left at all.
constexpr double kLeastRestitution = 0.1;
// [s] A speed that rolling friction would stop within this time counts as none at all.
constexpr double kHoldNoise = 1e-12;
// [s] The same where there is no rolling friction, against that of sliding: a speed that in an hour makes no
// more than 1e-12 m.
constexpr double kHoldNoRoll = 1e-16;

}  // namespace

HeldSolver::HeldSolver(HeldGroup& group, const HeldSurroundings& around, const MotionParams& motion,
                       double now)
    : group_(group), around_(around), motion_(motion), now_(now) {}

void HeldSolver::run() {
    make_bodies();
    make_links();
    make_directions();
    may_stop_ = true;
    solve_forces(0.0);  // which resting balls give way: the others take the capture like a wall
    may_stop_ = false;
    capture();
    make_directions();
    solve_forces(0.0);
    if (hold_returning()) solve_forces(0.0);
    for (Link& link : links_) link.pressed = link.N > 0.0;
    // The normal turns while the balls move across each other; a margin keeps the third order from penetrating.
    const double turning = turning_interval();
    if (turning < kNever) solve_forces(turning);
    double longest = kNever, interval = write_segments(longest, Opening::kIgnored);
    // Directions that turn are taken at the middle of the interval: second order. The interval may grow by
    // that, but not beyond what the margin is made for. What rounding has pressed into each other is led out.
    const bool turned = take_middle_directions();
    const bool deep = interval < kNever && any_deep();
    if (turned || deep || any_stuck() || (turning < kNever && interval < 0.5 * turning)) {
        longest = std::min(1.25 * interval, turning_interval());
        solve_forces(longest < kNever ? longest : 0.0);
    }
    // A contact is let go by the forces that then move its balls: those of the start could open it and those
    // of the interval close it at once, again and again.
    while (hold_returning()) solve_forces(longest < kNever ? longest : 0.0);
    write_segments(longest, Opening::kEnds);
    mark_released();
}

Vec2 HeldSolver::velocity(int index) const {
    return planar(group_.balls[index].v);
}

double HeldSolver::gap_rate(const Link& link) const {
    const Vec2 other = link.j >= 0 ? velocity(link.j) : Vec2::Zero();
    return dot(link.n, other - velocity(link.i));
}

HeldSolver::Mode HeldSolver::mode_of(const HeldBall& ball) const {
    const MotionState state = start_segment(now_, ball.r, ball.v, ball.w, motion_).state;
    return state == MotionState::kSliding   ? Mode::kSliding
           : state == MotionState::kRolling ? Mode::kRolling
                                            : Mode::kResting;
}

void HeldSolver::make_bodies() {
    for (HeldBall& ball : group_.balls) {
        const Segment s = start_segment(now_, ball.r, ball.v, ball.w, motion_);
        ball.v = s.v;
        ball.w = s.w;  // a rolling ball's spin is exactly the rolling one
        Body body;
        body.mode = mode_of(ball);
        bodies_.push_back(body);
        noise_ = std::max(noise_, held_noise(ball.v, ball.w, motion_));
    }
    settle();
}

// A rolling ball that friction stops at once has stopped: the direction of such a velocity, often the
// rounding of its group's, means nothing, and rolling friction along it would drive the ball.
bool HeldSolver::settle() {
    const double slowest = std::max(noise_, kHoldRest * motion_.roll);
    bool any = false;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        HeldBall& ball = group_.balls[k];
        if (bodies_[k].mode != Mode::kRolling || length(planar(ball.v)) > slowest) continue;
        any = any || length(planar(ball.v)) > 0.0;
        bodies_[k].mode = Mode::kResting;
        ball.v = Vec3::Zero();
        ball.w.x() = ball.w.y() = 0.0;
    }
    return any;
}

void HeldSolver::make_links() {
    const auto body_of = [this](int ball) {
        for (std::size_t k = 0; k < group_.balls.size(); ++k)
            if (group_.balls[k].ball == ball) return static_cast<int>(k);
        return -1;
    };
    for (const HeldContact& c : group_.contacts) {
        Link link{};
        link.i = body_of(c.i);
        link.j = c.j >= 0 ? body_of(c.j) : -1;
        link.n = c.n;
        link.depth = std::max(0.0, overlap(c, link));
        links_.push_back(link);
    }
}

double HeldSolver::overlap(const HeldContact& c, const Link& link) const {
    const Vec2 here = planar(group_.balls[link.i].r);
    if (link.j >= 0) return 2.0 * motion_.R - length(planar(group_.balls[link.j].r) - here);
    if (c.cushion >= 0) {
        const CushionLine& line = around_.geometry.cushions[c.cushion];
        return motion_.R - std::abs(cross(line.direction, here - line.from));
    }
    const Nose& nose = around_.geometry.noses[c.nose];
    return motion_.R + nose.radius - length(nose.center - here);
}

bool HeldSolver::any_deep() const {
    return std::any_of(links_.begin(), links_.end(),
                       [](const Link& l) { return !l.open && l.depth > kHoldDepth; });
}

// A contact ends once its gap opens by more than rounding: never at the same instant as it began, so that no contact
// can come and go without end. One without force that does not open (balls at rest, or that roll alike) stays.
void HeldSolver::mark_released() {
    for (std::size_t c = 0; c < links_.size(); ++c) {
        group_.contacts[c].force = links_[c].N;
        group_.contacts[c].released = links_[c].open;
    }
}

double time_to_line_end(const CushionLine& line, const Segment& s) {
    const double x = dot(line.direction, planar(s.r) - line.from);
    const double v = dot(line.direction, planar(s.v)), a = dot(line.direction, s.a);
    const double rounding = end_rounding(planar(s.r), line.length);
    const auto leaves = [rounding](double left, double rate, double pull) {
        if (past_end(left, rate, pull, rounding)) return 0.0;
        return first_descent_quadratic(left, rate, pull, kNever);
    };
    return std::min(leaves(x, v, a), leaves(line.length - x, -v, -a));
}

EventType HeldContact::hold_type() const {
    return j >= 0             ? EventType::kBallBallHold
           : nose >= 0 && jaw ? EventType::kBallJawHold
                              : EventType::kBallCushionHold;
}
EventType HeldContact::release_type() const {
    return j >= 0             ? EventType::kBallBallRelease
           : nose >= 0 && jaw ? EventType::kBallJawRelease
                              : EventType::kBallCushionRelease;
}

bool holds(double v_n, double a_c, double restitution) {
    if (!(a_c > 0.0)) return false;
    const double x = 2.0 * std::max(restitution, kLeastRestitution) * v_n / a_c;  // duration of the bounce
    const double x2 = x * x, f2 = kContactTimeFactor * kContactTimeFactor;
    return x2 * x2 * x * v_n <= f2 * f2 * kContactTimeFactor / (kContactStiffness * kContactStiffness);
}

double held_noise(const Vec3& v, const Vec3& w, const MotionParams& motion) {
    const double speed = length(planar(v)), spin = length(Vec2(length(planar(w)), w.z()));
    // Without rolling friction nothing stops such a ball: then against that of sliding.
    return std::max(motion.roll > 0.0 ? kHoldNoise * motion.roll : kHoldNoRoll * motion.slide,
                    8.0 * kClosingUlp * std::numeric_limits<double>::epsilon() * (speed + motion.R * spin));
}

void solve_held(HeldGroup& group, const HeldSurroundings& around, const MotionParams& motion, double now) {
    HeldSolver(group, around, motion, now).run();
}

void end_transition(HeldBall& member, MotionState state, double R) {
    switch (state) {
        case MotionState::kSliding: {
            const Vec2 u = cloth_slip(member.v, member.w, R);
            member.v.x() -= u.x() * (2.0 / 7.0);
            member.v.y() -= u.y() * (2.0 / 7.0);
            member.w.x() = -member.v.y() / R;
            member.w.y() = member.v.x() / R;
            break;
        }
        case MotionState::kRolling:
            member.v = Vec3::Zero();
            member.w.x() = member.w.y() = 0.0;
            break;
        case MotionState::kSpinning:
            member.w.z() = 0.0;
            break;
        case MotionState::kStationary:
        case MotionState::kPocketed:
            break;
    }
}

}  // namespace carom
