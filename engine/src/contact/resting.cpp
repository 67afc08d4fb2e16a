#include "contact/resting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "contact/resting_group.h"
#include "contact/roots.h"

namespace carom {

namespace {

// [-] Least restitution in the rule of holds(): with 0 the bounce would have no duration at any speed.
constexpr double kLeastRestitution = 0.1;
// [s] A speed that rolling friction would stop within this time counts as zero.
constexpr double kStopNoise = 1e-12;
// [s] The same without rolling friction, with sliding friction instead: such a speed moves a ball by no more than
// 1e-12 m in an hour.
constexpr double kSlideNoise = 1e-16;

}  // namespace

namespace resting {

namespace {

void make_bodies(Group& g) {
    for (RestingBall& ball : g.group.balls) {
        const Segment s = start_segment(g.now, ball.r, ball.v, ball.w, g.motion);
        ball.v = s.v;
        ball.w = s.w;  // the spin of a rolling ball is exactly that of rolling
        Body body;
        body.mode = mode_of(g, ball);
        g.bodies.push_back(body);
        g.noise = std::max(g.noise, resting_noise(ball.v, ball.w, g.motion));
    }
    stop_slow_rolling(g);
}

Link link_of(const Group& g, const RestingContact& c) {
    const auto body_of = [&](int ball) {
        const auto is_it = [ball](const RestingBall& b) { return b.ball == ball; };
        return static_cast<int>(std::find_if(g.group.balls.begin(), g.group.balls.end(), is_it) -
                                g.group.balls.begin());
    };
    const double R = g.motion.R;
    Link link{.i = body_of(c.contact.ball), .j = -1, .n = c.n, .distance = 0.0};
    const Vec2 here = planar(g.group.balls[link.i].r);
    double depth;
    if (c.contact.with == With::kCushion) {
        link.line = &g.around.geometry.cushions[c.contact.other];
        depth = R - link.line->inset - std::abs(cross(link.line->direction, here - link.line->from));
    } else {
        Vec2 center;
        if (c.contact.with == With::kBall) {
            link.j = body_of(c.contact.other);
            link.distance = 2.0 * R;
            center = planar(g.group.balls[link.j].r);
        } else {
            const Nose& nose = g.around.geometry.noses[c.contact.other];
            link.distance = R + nose.radius - nose.inset;
            center = nose.center;
        }
        depth = link.distance - length(center - here);
    }
    link.depth = std::max(0.0, depth);
    return link;
}

bool any_deep(const Group& g) {
    return std::any_of(g.links.begin(), g.links.end(),
                       [](const Link& l) { return !l.open && l.depth > kOverlapDepth; });
}

// A contact ends once its gap opens by more than rounding, and never at the instant at which it began, so that no
// contact can begin and end forever. A contact without force that does not open (balls at rest, equal rolling) stays.
void mark_released(Group& g) {
    for (std::size_t c = 0; c < g.links.size(); ++c) {
        g.group.contacts[c].force = g.links[c].N;
        g.group.contacts[c].released = g.links[c].open;
    }
}

void solve(Group& g) {
    make_bodies(g);
    for (const RestingContact& c : g.group.contacts) g.links.push_back(link_of(g, c));
    make_directions(g);
    // First solution: which resting balls start to move. The others are fixed obstacles in the projection below.
    solve_forces(g, 0.0, SlowBalls::kMayStop);
    project_velocities(g);
    make_directions(g);
    Solution solution = solve_forces(g, 0.0);
    if (keep_returning(g)) solution = solve_forces(g, 0.0);
    for (Link& link : g.links) link.pressed = link.N > 0.0;
    // Normals turn while the balls move across each other; the stabilisation prevents overlaps from third-order terms.
    const double turning = normal_interval(g);
    if (turning < kNever) solution = solve_forces(g, turning);
    double longest = kNever;
    const double interval = write_segments(g, solution, longest, Opening::kIgnored);
    // Directions that turn are evaluated at the middle of the interval, for second order. The interval may become
    // longer by that, but not longer than the stabilisation allows. Overlaps that rounding has caused are removed.
    const bool turned = use_midpoint_directions(g);
    const bool deep = interval < kNever && any_deep(g);
    if (turned || deep || any_stuck(g) || (turning < kNever && interval < 0.5 * turning)) {
        longest = std::min(1.25 * interval, normal_interval(g));
        solution = solve_forces(g, longest < kNever ? longest : 0.0);
    }
    // The forces of the interval decide whether a contact ends: forces at its start could open the contact and forces
    // of the interval close it again at once, repeatedly.
    while (keep_returning(g)) solution = solve_forces(g, longest < kNever ? longest : 0.0);
    write_segments(g, solution, longest, Opening::kEnds);
    mark_released(g);
}

}  // namespace

Vec2 velocity(const Group& g, int index) {
    return planar(g.group.balls[index].v);
}

double gap_rate(const Group& g, const Link& link) {
    const Vec2 other = link.j >= 0 ? velocity(g, link.j) : Vec2::Zero();
    return dot(link.n, other - velocity(g, link.i));
}

Mode mode_of(const Group& g, const RestingBall& ball) {
    const MotionState state = start_segment(g.now, ball.r, ball.v, ball.w, g.motion).state;
    return state == MotionState::kSliding   ? Mode::kSliding
           : state == MotionState::kRolling ? Mode::kRolling
                                            : Mode::kResting;
}

// Stops rolling balls that friction would stop at once: the direction of such a velocity is often only the rounding of
// the group's velocities, and rolling friction along it would drive the ball. @return whether one had a velocity
bool stop_slow_rolling(Group& g) {
    const double slowest = std::max(g.noise, kRestTime * g.motion.roll);
    bool any = false;
    for (std::size_t k = 0; k < g.bodies.size(); ++k) {
        RestingBall& ball = g.group.balls[k];
        if (g.bodies[k].mode != Mode::kRolling || length(planar(ball.v)) > slowest) continue;
        any = any || length(planar(ball.v)) > 0.0;
        g.bodies[k].mode = Mode::kResting;
        ball.v = Vec3::Zero();
        ball.w.x() = ball.w.y() = 0.0;
    }
    return any;
}

}  // namespace resting

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

bool holds(double v_n, double a_c, double restitution) {
    if (!(a_c > 0.0)) return false;
    const double x = 2.0 * std::max(restitution, kLeastRestitution) * v_n / a_c;  // duration of the rebound
    const double x2 = x * x, f2 = kContactTimeFactor * kContactTimeFactor;
    return x2 * x2 * x * v_n <= f2 * f2 * kContactTimeFactor / (kContactStiffness * kContactStiffness);
}

double resting_noise(const Vec3& v, const Vec3& w, const MotionParams& motion) {
    const double speed = length(planar(v)), spin = length(Vec2(length(planar(w)), w.z()));
    // Without rolling friction nothing stops such a ball: the sliding friction then sets the scale.
    return std::max(motion.roll > 0.0 ? kStopNoise * motion.roll : kSlideNoise * motion.slide,
                    8.0 * kClosingUlp * std::numeric_limits<double>::epsilon() * (speed + motion.R * spin));
}

void solve_resting(RestingGroup& group, const RestingSurroundings& around, const MotionParams& motion,
                   double now) {
    resting::Group g{group, around, motion, now, {}, {}};
    resting::solve(g);
}

void end_transition(RestingBall& member, MotionState state, double R) {
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
        case MotionState::kFalling:
            break;
    }
}

}  // namespace carom
