// Intervals of a held group: how long its forces stay what they are, and the segments of its members.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "contact/resting_solver.h"
#include "contact/roots.h"

namespace carom {

namespace {

// [s] Longest interval over which a resting contact keeps the directions of its forces where they turn.
constexpr double kHoldLongest = 5e-2;
// [m] Error that one such interval may make in a ball's place: 1e-6 m in the hundred or so of a long push.
constexpr double kHoldError = 2e-8;
// [rad] and [m] How far a normal may turn within one, and what gap its turning may leave.
constexpr double kHoldTurn = 0.03;
constexpr double kHoldGap = 1e-8;
// [m/s] The rounding of great forces (a narrow wedge) may move a gap by so much in the long run: its
// intervals are as much shorter, but not shorter than kHoldLeadOut (beyond 1e5 m/s^2 it may be more). Forces
// below some 2000 m/s^2 are not affected.
constexpr double kHoldDrift = 1e-13;
// [of the sliding acceleration] A gap that opens by less does not open: the rounding of the forces.
constexpr double kHoldOpening = 1e-10;
// [ulp of the time] No interval is shorter: the clock has to go on.
constexpr double kHoldTicks = 8.0;
// [-] A slip or velocity that turns ends where it is nearest to nothing, if it comes as near as this share
// of itself; else it only turns.
constexpr double kHoldEnds = 0.5;
// [-] Directions that differ by less than this (sine of the angle) do not turn: the closed form of the straight line.
constexpr double kHoldStraight = 1e-9;

// Longest time up to kHoldLongest at which `error` is at most `allowed`, in steps of a fifth.
template <class Error>
double longest(double allowed, const Error& error) {
    double h = kHoldLongest;
    while (h > kHoldShortest && error(h) > allowed) h *= 0.8;
    return h;
}

}  // namespace

// Relative motion across the normal, and the distance over which the normal turns (0: a straight cushion).
double HeldSolver::across(std::size_t c, Vec2& velocity_across) const {
    const HeldContact& contact = group_.contacts[c];
    const Link& link = links_[c];
    const Vec2 t(link.n.y(), -link.n.x());
    const Vec2 other = link.j >= 0 ? velocity(link.j) : Vec2::Zero();
    const Vec2 other_a = link.j >= 0 ? body(link.j).a : Vec2::Zero();
    velocity_across = Vec2(dot(other - velocity(link.i), t), dot(other_a - body(link.i).a, t));
    if (contact.cushion >= 0) return 0.0;
    return contact.j >= 0 ? 2.0 * motion_.R : motion_.R + around_.geometry.noses[contact.nose].radius;
}

// How long normals may be taken as they are; kNever if none turns.
double HeldSolver::turning_interval() const {
    double interval = kNever;
    for (std::size_t c = 0; c < links_.size(); ++c) {
        const Link& link = links_[c];
        if (link.open) continue;
        Vec2 t;
        const double distance = across(c, t);
        if (distance == 0.0) continue;
        const double speeds = length(velocity(link.i)) + (link.j >= 0 ? length(velocity(link.j)) : 0.0);
        const double pulls = length(body(link.i).a) + (link.j >= 0 ? length(body(link.j).a) : 0.0);
        if (std::abs(t.x()) <= kHoldStraight * speeds && std::abs(t.y()) <= kHoldStraight * pulls) continue;
        const double v = std::abs(t.x()), a = std::abs(t.y());
        interval = std::min(interval,
                            longest(kHoldTurn, [&](double h) { return h * (v + 0.5 * h * a) / distance; }));
        interval = std::min(interval, longest(kHoldGap, [&](double h) {
                                return 0.5 * h * h * h * a * (v + h * a) / distance;
                            }));
    }
    return interval;
}

// What gives a member's friction its direction, and its rate of change.
Vec2 HeldSolver::slip_or_velocity(std::size_t k, Vec2& rate) const {
    const HeldBall& ball = group_.balls[k];
    const Segment& s = ball.segment;
    if (bodies_[k].mode == Mode::kSliding) {
        rate = Vec2(s.a.x() - motion_.R * s.dw.y(), s.a.y() + motion_.R * s.dw.x());
        return cloth_slip(ball.v, ball.w, motion_.R);
    }
    rate = s.a;
    return planar(ball.v);
}

bool HeldSolver::take_middle_directions() {
    bool turned = false;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        Body& b = bodies_[k];
        const double duration = group_.balls[k].segment.duration;
        if (b.mode == Mode::kResting || !(duration < kNever)) continue;
        Vec2 dx;
        const Vec2 x = slip_or_velocity(k, dx);
        if (std::abs(cross(x, dx)) <= kHoldStraight * length(x) * length(dx)) continue;
        const Vec2 middle = x + 0.5 * duration * dx;
        const double size = length(middle);
        // Near its end the direction may turn over: then the one at the start stays.
        if (!(size > 0.0) || middle.dot(x) <= 0.0) continue;
        b.direction = middle / size;
        turned = true;
    }
    return turned;
}

// Time until a member's slip or velocity is gone or turns too far; `gone` says which. Friction of strength S
// along a direction that turns at the rate w, taken at the middle of h, errs by S w h^3 / 12 in the place.
double HeldSolver::time_of(std::size_t k, bool& gone) const {
    gone = false;
    Vec2 dx;
    const Vec2 x = slip_or_velocity(k, dx);
    const double size = length(x), rate = length(dx);
    if (size == 0.0 || rate == 0.0) return kNever;
    const double toward = -dot(x, dx) / rate, turning = std::abs(cross(x, dx));
    if (turning <= kHoldStraight * size * rate) {
        gone = toward > 0.0;
        return gone ? size / rate : kNever;
    }
    const double strength = bodies_[k].mode == Mode::kSliding ? motion_.slide : motion_.roll;
    const double w = turning / (size * size);
    const double accurate = longest(kHoldError, [&](double h) { return strength * w * h * h * h / 12.0; });
    const double limit = std::max(kHoldShortest, std::min(accurate, 0.25 * size / rate));
    const double nearest = toward / rate;
    gone = nearest > 0.0 && nearest <= limit && turning <= kHoldEnds * size * rate;
    return gone ? nearest : limit;
}

Vec2 HeldSolver::spin_rate(std::size_t k) const {
    const Body& b = bodies_[k];
    const double R = motion_.R;
    if (b.mode == Mode::kRolling) return {-b.a.y() / R, b.a.x() / R};
    if (b.mode == Mode::kResting) return Vec2::Zero();
    const double turn = 2.5 * motion_.slide * load(b) / R;
    // T / I with (T x z) / R = couple: T = R z x couple.
    return {-turn * b.direction.y() - 2.5 * b.couple.y() / R,
            turn * b.direction.x() + 2.5 * b.couple.x() / R};
}

// The vertical friction keeps its direction until the slip s_z changes sign.
double HeldSolver::friction_flip(const Link& link) const {
    if (link.friction_z == 0.0 || link.N == 0.0 || link.stuck) return kNever;
    const Segment &si = group_.balls[link.i].segment, &sj = group_.balls[link.j].segment;
    const Vec2 t(link.n.y(), -link.n.x());
    const double s_z = dot(planar(si.w) + planar(sj.w), t), rate = dot(si.dw + sj.dw, t);
    if (!(s_z * rate < 0.0)) return kNever;
    return std::max(kHoldShortest, -s_z / rate);
}

// A contact that is about to open is let go when its rate can be told from rounding.
double HeldSolver::opening_interval(const Link& link) const {
    if (link.open || link.pressed || link.N > 0.0) return kNever;
    const double opening = gap_acceleration(link);
    if (!(opening > kHoldOpening * motion_.slide)) return kNever;
    // A ball that starts has to get beyond what settle() takes for rest.
    const double clear = 4.0 * std::max(noise_, kHoldRest * motion_.roll);
    const double told = (clear + std::max(0.0, -gap_rate(link))) / opening;
    // So has every other ball that the group starts: taken for rest again, it is a wall that stops this one
    // in a narrow wedge, and all starts anew (random scene 3800). The gap meanwhile stays below what a
    // turning normal may leave.
    double started = 0.0;
    for (const Body& b : bodies_) {
        const double size = length(b.a);
        if (b.mode == Mode::kRolling && b.starts && size > 0.0) started = std::max(started, clear / size);
    }
    return std::max(told, std::min(started, std::sqrt(2.0 * kHoldGap / opening)));
}

// A normal that turns without its margin (there was no room for it) closes the gap with the third power of the time.
double HeldSolver::bare_interval(std::size_t c, double interval) const {
    const Link& link = links_[c];
    Vec2 t;
    const double distance = across(c, t);
    if (link.open || !(link.N > 0.0) || distance == 0.0) return kNever;
    const double v = std::abs(t.x()), a = std::abs(t.y());
    const auto needed = [&](double h) { return h * a * (1.5 * v + h * a) / distance; };
    const double h = std::min(interval, kHoldLongest);
    if (margins_ && link.margin > 0.0) return kNever;
    if (0.5 * h * h * needed(h) <= kHoldDepth) return kNever;
    return longest(kHoldDepth, [&](double x) { return 0.5 * x * x * needed(x); });
}

// What the capture could not take out of a narrow wedge (its answer is beyond rounding) is not left to close
// the gap for long.
double HeldSolver::closing_interval(const Link& link) const {
    const double rate = gap_rate(link);
    return !link.open && rate < -noise_ ? std::max(kHoldShortest, -kHoldDepth / rate) : kNever;
}

// Forces N that cancel leave an acceleration of some ulp of them: over h, that moves the gap by a h^2 / 2,
// before the next capture takes the speed out; a h / 2 in the long run.
double HeldSolver::rounding_interval(const Link& link) const {
    const double a = 8.0 * std::numeric_limits<double>::epsilon() * link.N;
    return a * kHoldLongest > 2.0 * kHoldDrift ? std::max(kHoldLeadOut, 2.0 * kHoldDrift / a) : kNever;
}

// @return how long they last, at most `longest`; with Opening::kEnds, at most until a contact that opens is let go
double HeldSolver::write_segments(double longest, Opening opening) {
    double interval = std::min(longest, turning_interval());
    std::vector<double> ends(bodies_.size(), kNever);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const Body& b = bodies_[k];
        HeldBall& ball = group_.balls[k];
        Segment& s = ball.segment;
        s = start_segment(now_, ball.r, ball.v, ball.w, motion_);
        s.held = true;
        s.a = b.a;
        s.dw = spin_rate(k);
        bool gone = false;
        double time = kNever;
        if (b.mode == Mode::kSliding || b.mode == Mode::kRolling) {
            s.state = b.mode == Mode::kSliding ? MotionState::kSliding : MotionState::kRolling;
            time = time_of(k, gone);
        } else if (s.state == MotionState::kSpinning) {
            time = s.duration;
            gone = true;
        }
        interval = std::min(interval, time);
        if (gone) ends[k] = time;
    }
    for (std::size_t c = 0; c < links_.size(); ++c) {
        const HeldContact& contact = group_.contacts[c];
        const Link& link = links_[c];
        if (contact.cushion >= 0)
            interval = std::min(interval, time_to_line_end(around_.geometry.cushions[contact.cushion],
                                                           group_.balls[link.i].segment));
        if (link.j >= 0) interval = std::min(interval, friction_flip(link));
        if (opening == Opening::kEnds)
            interval = std::min({interval, opening_interval(link), bare_interval(c, interval)});
        interval = std::min({interval, rounding_interval(link), closing_interval(link)});
        if (link.returning > 0.0) interval = std::min(interval, kHoldShortest);
    }
    if (!solved_) interval = std::min(interval, kHoldShortest);
    interval = std::max(interval, kHoldTicks * std::numeric_limits<double>::epsilon() * now_);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        group_.balls[k].segment.duration = interval;
        group_.balls[k].segment.ends = ends[k] <= interval;
    }
    return interval;
}

}  // namespace carom
