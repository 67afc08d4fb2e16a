// Intervals of a group: the time for which its forces remain valid, and the segments of its members.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "contact/resting_group.h"
#include "contact/roots.h"

namespace carom::resting {

namespace {

// [s] Longest interval over which the forces of a resting contact keep their directions if these turn.
constexpr double kLongestInterval = 5e-2;
// [m] Position error of a ball in one such interval: 1e-6 m after the hundred or so intervals of a long push.
constexpr double kPlaceError = 2e-8;
// [rad] and [m] Largest rotation of a normal within an interval, and the largest gap that it may cause.
constexpr double kNormalTurn = 0.03;
constexpr double kGapLeft = 1e-8;
// [m/s] Largest mean speed of a gap from the rounding of large forces (a narrow wedge). Intervals are shortened for it,
// but not below kRecoveryTime (above 1e5 m/s^2 the speed may be larger). Forces below some 2000 m/s^2 are not affected.
constexpr double kGapDrift = 1e-13;
// [of the sliding acceleration] Smaller opening accelerations are the rounding of the forces.
constexpr double kOpening = 1e-10;
// [ulp of the time] Shortest interval, so that the clock advances.
constexpr double kClockTicks = 8.0;
// [-] A slip or velocity that turns ends at its minimum if this is at most this share of its present value; otherwise
// it only turns.
constexpr double kSlipEnds = 0.5;
// [-] Directions that differ by less (sine of the angle) count as constant: the closed form of a straight line applies.
constexpr double kStraight = 1e-9;

// Longest time up to kLongestInterval at which `error` is at most `allowed`, in steps of a fifth.
template <class Error>
double longest(double allowed, const Error& error) {
    double h = kLongestInterval;
    while (h > kShortestInterval && error(h) > allowed) h *= 0.8;
    return h;
}

// The vector that gives a member's friction its direction, and its rate of change.
Vec2 slip_or_velocity(const Group& g, std::size_t k, Vec2& rate) {
    const RestingBall& ball = g.group.balls[k];
    const Segment& s = ball.segment;
    if (g.bodies[k].mode == Mode::kSliding) {
        rate = Vec2(s.a.x() - g.motion.R * s.dw.y(), s.a.y() + g.motion.R * s.dw.x());
        return cloth_slip(ball.v, ball.w, g.motion.R);
    }
    rate = s.a;
    return planar(ball.v);
}

// Time until a member's slip or velocity becomes zero (then `gone`) or turns too far. Friction of strength S along a
// direction that turns at the rate w, evaluated at the middle of h, causes a position error of S w h^3 / 12.
double direction_interval(const Group& g, std::size_t k, bool& gone) {
    gone = false;
    Vec2 dx;
    const Vec2 x = slip_or_velocity(g, k, dx);
    const double size = length(x), rate = length(dx);
    if (size == 0.0 || rate == 0.0) return kNever;
    const double toward = -dot(x, dx) / rate, turning = std::abs(cross(x, dx));
    if (turning <= kStraight * size * rate) {
        gone = toward > 0.0;
        return gone ? size / rate : kNever;
    }
    const double strength = g.bodies[k].mode == Mode::kSliding ? g.motion.slide : g.motion.roll;
    const double w = turning / (size * size);
    const double accurate = longest(kPlaceError, [&](double h) { return strength * w * h * h * h / 12.0; });
    const double limit = std::max(kShortestInterval, std::min(accurate, 0.25 * size / rate));
    const double nearest = toward / rate;
    gone = nearest > 0.0 && nearest <= limit && turning <= kSlipEnds * size * rate;
    return gone ? nearest : limit;
}

// The vertical friction keeps its direction until the slip s_z changes sign.
double friction_flip(const Group& g, const Link& link) {
    if (link.friction_z == 0.0 || link.N == 0.0 || link.stuck) return kNever;
    const Segment &si = g.group.balls[link.i].segment, &sj = g.group.balls[link.j].segment;
    const Vec2 t(link.n.y(), -link.n.x());
    const double s_z = dot(planar(si.w) + planar(sj.w), t), rate = dot(si.dw + sj.dw, t);
    if (!(s_z * rate < 0.0)) return kNever;
    return std::max(kShortestInterval, -s_z / rate);
}

// A contact that starts to open is released when its rate can be distinguished from rounding.
double opening_interval(const Group& g, const Link& link) {
    if (link.open || link.pressed || link.N > 0.0) return kNever;
    const double opening = gap_acceleration(g, link);
    if (!(opening > kOpening * g.motion.slide)) return kNever;
    // A ball that starts must become faster than the limit of stop_slow_rolling().
    const double clear = 4.0 * std::max(g.noise, kRestTime * g.motion.roll);
    const double told = (clear + std::max(0.0, -gap_rate(g, link))) / opening;
    // So must every other ball that the group starts: if it were stopped again, it would be an obstacle that stops this
    // one in a narrow wedge, and everything would start again (random scene 3800). The gap meanwhile stays below
    // kGapLeft.
    double started = 0.0;
    for (const Body& b : g.bodies) {
        const double size = length(b.a);
        if (b.mode == Mode::kRolling && b.starts && size > 0.0) started = std::max(started, clear / size);
    }
    return std::max(told, std::min(started, std::sqrt(2.0 * kGapLeft / opening)));
}

// A normal that turns without stabilisation (where it was impossible) closes the gap with the third power of the time.
double unstabilised_interval(const Group& g, const Link& link, double interval, bool stabilised) {
    if (link.open || !(link.N > 0.0) || link.distance == 0.0) return kNever;
    if (stabilised && link.stabilisation > 0.0) return kNever;
    const Across t = across(g, link);
    const double v = std::abs(t.v), a = std::abs(t.a);
    const auto closed = [&](double h) { return 0.5 * h * h * (h * a * (1.5 * v + h * a) / t.distance); };
    if (closed(std::min(interval, kLongestInterval)) <= kOverlapDepth) return kNever;
    return longest(kOverlapDepth, closed);
}

// A closing speed that the projection could not remove in a narrow wedge (its solution is limited by rounding) may
// close the gap for a short time only.
double closing_interval(const Group& g, const Link& link) {
    const double rate = gap_rate(g, link);
    return !link.open && rate < -g.noise ? std::max(kShortestInterval, -kOverlapDepth / rate) : kNever;
}

// Forces N that cancel leave an acceleration a of some ulp of N. In the time h it moves the gap by a h^2 / 2 before the
// next projection removes the speed; the mean speed is a h / 2.
double rounding_interval(const Link& link) {
    const double a = 8.0 * std::numeric_limits<double>::epsilon() * link.N;
    return a * kLongestInterval > 2.0 * kGapDrift ? std::max(kRecoveryTime, 2.0 * kGapDrift / a) : kNever;
}

}  // namespace

Across across(const Group& g, const Link& link) {
    const Vec2 t(link.n.y(), -link.n.x());
    const Vec2 other = link.j >= 0 ? velocity(g, link.j) : Vec2::Zero();
    const Vec2 other_a = link.j >= 0 ? g.bodies[link.j].a : Vec2::Zero();
    return {dot(other - velocity(g, link.i), t), dot(other_a - g.bodies[link.i].a, t), link.distance};
}

double normal_interval(const Group& g) {
    double interval = kNever;
    for (const Link& link : g.links) {
        if (link.open || link.distance == 0.0) continue;
        const Across t = across(g, link);
        const double v = std::abs(t.v), a = std::abs(t.a), distance = t.distance;
        const double speeds = length(velocity(g, link.i)) + (link.j >= 0 ? length(velocity(g, link.j)) : 0.0);
        const double pulls = length(g.bodies[link.i].a) + (link.j >= 0 ? length(g.bodies[link.j].a) : 0.0);
        if (v <= kStraight * speeds && a <= kStraight * pulls) continue;
        interval = std::min(interval,
                            longest(kNormalTurn, [&](double h) { return h * (v + 0.5 * h * a) / distance; }));
        interval = std::min(interval, longest(kGapLeft, [&](double h) {
                                return 0.5 * h * h * h * a * (v + h * a) / distance;
                            }));
    }
    return interval;
}

bool use_midpoint_directions(Group& g) {
    bool turned = false;
    for (std::size_t k = 0; k < g.bodies.size(); ++k) {
        Body& b = g.bodies[k];
        const double duration = g.group.balls[k].segment.duration;
        if (b.mode == Mode::kResting || !(duration < kNever)) continue;
        Vec2 dx;
        const Vec2 x = slip_or_velocity(g, k, dx);
        if (std::abs(cross(x, dx)) <= kStraight * length(x) * length(dx)) continue;
        const Vec2 middle = x + 0.5 * duration * dx;
        const double size = length(middle);
        // Near its end the direction may reverse: the direction at the start is then kept.
        if (!(size > 0.0) || dot(middle, x) <= 0.0) continue;
        b.direction = middle / size;
        turned = true;
    }
    return turned;
}

Vec2 spin_rate(const Group& g, int k) {
    const Body& b = g.bodies[k];
    const double R = g.motion.R;
    if (b.mode == Mode::kRolling) return {-b.a.y() / R, b.a.x() / R};
    if (b.mode == Mode::kResting) return Vec2::Zero();
    const double turn = 2.5 * g.motion.slide * load(g, b) / R;
    // T / I with (T x z) / R = couple: T = R z x couple.
    return {-turn * b.direction.y() - 2.5 * b.couple.y() / R,
            turn * b.direction.x() + 2.5 * b.couple.x() / R};
}

double write_segments(Group& g, const Solution& solution, double longest, Opening opening) {
    double interval = std::min(longest, normal_interval(g));
    std::vector<double> ends(g.bodies.size(), kNever);
    for (std::size_t k = 0; k < g.bodies.size(); ++k) {
        const Body& b = g.bodies[k];
        RestingBall& ball = g.group.balls[k];
        Segment& s = ball.segment;
        s = start_segment(g.now, ball.r, ball.v, ball.w, g.motion);
        s.held = true;
        s.a = b.a;
        s.dw = spin_rate(g, static_cast<int>(k));
        bool gone = false;
        double time = kNever;
        if (b.mode == Mode::kSliding || b.mode == Mode::kRolling) {
            s.state = b.mode == Mode::kSliding ? MotionState::kSliding : MotionState::kRolling;
            time = direction_interval(g, k, gone);
        } else if (s.state == MotionState::kSpinning) {
            time = s.duration;
            gone = true;
        }
        interval = std::min(interval, time);
        if (gone) ends[k] = time;
    }
    for (const Link& link : g.links) {
        if (link.line != nullptr)
            interval = std::min(interval, time_to_line_end(*link.line, g.group.balls[link.i].segment));
        if (link.j >= 0) interval = std::min(interval, friction_flip(g, link));
        if (opening == Opening::kEnds)
            interval = std::min({interval, opening_interval(g, link),
                                 unstabilised_interval(g, link, interval, solution.stabilised)});
        interval = std::min({interval, rounding_interval(link), closing_interval(g, link)});
        if (link.returning > 0.0) interval = std::min(interval, kShortestInterval);
    }
    if (!solution.solved) interval = std::min(interval, kShortestInterval);
    interval = std::max(interval, kClockTicks * std::numeric_limits<double>::epsilon() * g.now);
    for (std::size_t k = 0; k < g.bodies.size(); ++k) {
        g.group.balls[k].segment.duration = interval;
        g.group.balls[k].segment.ends = ends[k] <= interval;
    }
    return interval;
}

}  // namespace carom::resting
