// Contact forces and accelerations of a group of resting contacts.
#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/complementarity.h"
#include "contact/resting_group.h"

namespace carom::resting {

namespace {

// [of the accelerations that drive a group] Forces above the first limit are no solution: the term that needs them is
// dropped. A wedge of slope s multiplies the drive by 1/s, and slopes down to 1e-8 are solved; contradicting contacts
// multiply it by 1/kContactSoftness. Forces above the second limit show that a wedge cannot be stabilised.
constexpr double kLargestForce = 1e9;
constexpr double kLargestStabilised = 1e4;
// [-] Mobility of balls at rest while it is decided which of them stay at rest; that of a sliding ball is 1.
constexpr double kRestCompliance = 1e-4;
// [of the coefficient] Accuracy of the friction that ends a slip.
constexpr double kStickAccuracy = 1e-3;
// [of kShortestInterval] For a ball that its rolling friction would stop within this time, the direction of friction
// follows from the forces (implicitly); an explicit step would be unstable.
constexpr double kSlowIntervals = 4.0;

void accelerate(Group& g, double compliance) {
    for (Body& b : g.bodies) {
        switch (b.mode) {
            case Mode::kSliding:
                b.a = b.push - g.motion.slide * load(g, b) * b.direction;
                break;
            case Mode::kRolling:
                b.a = (5.0 / 7.0) * (b.push + b.couple) - g.motion.roll * b.direction;
                break;
            case Mode::kResting:
                b.a = compliance * (b.push + b.couple) - b.due;
                break;
        }
    }
}

void sum_forces(Group& g) {
    for (Body& b : g.bodies) {
        b.push = b.couple = Vec2::Zero();
        b.lift = 0.0;
    }
    for (const Link& link : g.links) {
        Body& bi = g.bodies[link.i];
        bi.push -= link.N * link.n;
        bi.couple -= link.friction_z * link.N * link.n;
        bi.lift += link.friction_z * link.N;
        if (link.j < 0) continue;
        Body& bj = g.bodies[link.j];
        bj.push += link.N * link.n;
        bj.couple -= link.friction_z * link.N * link.n;
        bj.lift -= link.friction_z * link.N;
    }
}

// Acceleration of a body by a unit force in the contact.
Vec2 response(const Group& g, const Link& link, int index, const SolveOptions& options) {
    const Body& b = g.bodies[index];
    const double f = options.friction ? link.friction_z : 0.0, sign = index == link.i ? -1.0 : 1.0;
    switch (b.mode) {
        case Mode::kSliding: {
            const double lift = b.lifted ? 0.0 : -sign * f / g.around.gravity;
            return sign * link.n + g.motion.slide * lift * b.direction;
        }
        case Mode::kRolling:
            return (5.0 / 7.0) * (sign - f) * link.n;
        case Mode::kResting:
            return options.compliance * (sign - f) * link.n;
    }
    return Vec2::Zero();
}

// Two opposing fixed normals cannot both be stabilised: the regularised system then returns huge, meaningless forces.
// Drops the stabilisation of those contacts. @return whether there was one to drop
bool drop_stabilisation(Group& g, const std::vector<std::size_t>& active) {
    bool any = false;
    for (const std::size_t c : active) {
        Link& link = g.links[c];
        const double off = gap_acceleration(g, link) - link.stabilisation;
        if ((link.N > 0.0 ? std::abs(off) : -off) <= kForceRounding * (g.motion.slide + link.N)) continue;
        any = any || link.stabilisation != 0.0;
        link.stabilisation = 0.0;
        link.walled = true;
    }
    return any;
}

// Solves N >= 0, gap acceleration >= stabilisation, complementary, for the present modes and directions.
// @return whether there is a solution
bool solve_contacts_once(Group& g, const SolveOptions& options) {
    for (Link& link : g.links) link.N = 0.0;
    sum_forces(g);
    accelerate(g, options.compliance);
    std::vector<std::size_t> active;
    for (std::size_t c = 0; c < g.links.size(); ++c) {
        Link& link = g.links[c];
        const auto mobility = [&](const Body& b) { return std::max(options.compliance, b.mobility()); };
        link.diagonal = mobility(g.bodies[link.i]) + (link.j >= 0 ? mobility(g.bodies[link.j]) : 0.0);
        if (!link.open && link.diagonal > 0.0) active.push_back(c);
    }
    Complementarity problem(active.size());
    double drive = 0.0;
    for (std::size_t k = 0; k < active.size(); ++k) {
        const Link& column = g.links[active[k]];
        const Vec2 on_i = response(g, column, column.i, options),
                   on_j = column.j >= 0 ? response(g, column, column.j, options) : Vec2::Zero();
        problem.q[k] = gap_acceleration(g, column) - (options.stabilise ? column.stabilisation : 0.0);
        drive = std::max(drive, std::abs(problem.q[k]));
        for (std::size_t r = 0; r < active.size(); ++r) {
            const Link& row = g.links[active[r]];
            double sum = 0.0;
            if (row.i == column.i) sum -= dot(row.n, on_i);
            if (row.i == column.j) sum -= dot(row.n, on_j);
            if (row.j >= 0 && row.j == column.i) sum += dot(row.n, on_i);
            if (row.j >= 0 && row.j == column.j) sum += dot(row.n, on_j);
            problem.at(r, k) = sum;
        }
    }
    if (!problem.solve()) return false;
    drive += g.motion.slide + g.motion.roll;
    bool possible = true;
    for (std::size_t k = 0; k < active.size(); ++k) {
        Link& link = g.links[active[k]];
        link.N = problem.z[k];
        const bool stabilised = options.stabilise && !link.walled;
        if (link.N <= (stabilised ? kLargestStabilised : kLargestForce) * drive) continue;
        possible = false;
        if (!stabilised) continue;
        link.walled = true;
        link.stabilisation = 0.0;
    }
    if (!possible) {
        for (Link& link : g.links) link.N = 0.0;
        return false;
    }
    sum_forces(g);
    accelerate(g, options.compliance);
    return !options.stabilise || !drop_stabilisation(g, active);
}

// The stabilisation can be impossible in a wedge, and with friction there may be no solution at all (Painleve): the
// system is then solved without them.
Solution solve_contacts(Group& g, double compliance) {
    const bool stabilise =
        std::any_of(g.links.begin(), g.links.end(), [](const Link& l) { return l.stabilisation != 0.0; });
    const bool friction =
        std::any_of(g.links.begin(), g.links.end(), [](const Link& l) { return l.friction_z != 0.0; });
    const SolveOptions all{.compliance = compliance, .friction = friction, .stabilise = stabilise};
    if (solve_contacts_once(g, all)) return {true, stabilise};
    SolveOptions less = all;
    less.stabilise = false;
    if (stabilise) {
        // First without the stabilisations that have been dropped, then without any.
        if (solve_contacts_once(g, all)) return {true, true};
        if (solve_contacts_once(g, less)) return {true, false};
    }
    if (!friction) return {false, false};
    for (Link& link : g.links) {
        link.friction_z = 0.0;
        link.stuck = false;
    }
    less.friction = false;
    return {solve_contacts_once(g, less), false};
}

// [m/s^2] The rate of v_t^2 / |r|, 3 v_t a_t / |r|, must not close the gap within the interval; overlaps end in it.
double stabilisation_for(const Link& link, const Across& t, double interval) {
    const double a = std::abs(t.a), h = std::max(interval, kRecoveryTime);
    const double turning =
        t.distance > 0.0 ? interval * a * (1.5 * std::abs(t.v) + interval * a) / t.distance : 0.0;
    return turning + (link.depth > kOverlapDepth ? 2.0 * link.depth / (h * h) : 0.0);
}

// Whether the resulting accelerations require more stabilisation of a gap than they were computed with.
bool stabilisation_falls_short(const Group& g, double interval) {
    return std::any_of(g.links.begin(), g.links.end(), [&](const Link& link) {
        return !link.open && !link.walled &&
               stabilisation_for(link, across(g, link), interval) > 1.2 * link.stabilisation;
    });
}

// Terms of the acceleration of a gap besides those of the bodies: |r|'' contains v_t^2 / |r| from the turning normal.
void update_gap_terms(Group& g, double interval) {
    for (Link& link : g.links) {
        const Across t = across(g, link);
        link.curving = t.distance > 0.0 ? t.v * t.v / t.distance : 0.0;
        link.stabilisation = interval > 0.0 && !link.walled ? stabilisation_for(link, t, interval) : 0.0;
    }
}

// Rate of change of the slip on which the vertical friction between two balls acts [m/s^2].
double slip_rate(const Group& g, const Link& link) {
    const Vec2 t(link.n.y(), -link.n.x());
    return g.motion.R * dot(spin_rate(g, link.i) + spin_rate(g, link.j), t);
}

// Stiction: friction that would reverse the slip within the interval ends it instead. It is evaluated at the slip of
// the end, s + h (rate without friction) + h k N f, where k is the response to a unit force. Evaluated at the slip of
// the start it would make the slip oscillate, and with large forces gain energy.
// @return whether a friction has changed, so that the forces must be solved again
bool solve_stiction(Group& g, double interval) {
    const double h = std::max(interval, kShortestInterval);
    const auto ease = [](const Body& b) {
        return b.mode == Mode::kSliding ? 2.5 : (b.mode == Mode::kRolling ? 5.0 / 7.0 : 0.0);
    };
    bool changed = false;
    for (Link& link : g.links) {
        if (link.j < 0 || link.open || !(link.N > 0.0) || (link.friction_z == 0.0 && !link.stuck)) continue;
        const double end = link.slip_z + h * slip_rate(g, link);
        if (!link.stuck && !(end * link.slip_z < 0.0)) continue;
        const double effect = h * (ease(g.bodies[link.i]) + ease(g.bodies[link.j])) * link.N;
        if (!(effect > 0.0)) continue;
        const double share = link.friction * effect / (link.friction * effect + std::abs(link.slip_x));
        const double f = std::clamp(share * (link.friction_z - end / effect), -link.friction, link.friction);
        changed = changed || std::abs(f - link.friction_z) > kStickAccuracy * link.friction;
        link.friction_z = f;
        link.stuck = true;
    }
    return changed;
}

Solution solve_forces_once(Group& g, double interval, SlowBalls slow) {
    update_gap_terms(g, interval);
    for (Body& b : g.bodies) {
        b.changes = 0;
        b.lifted = false;
    }
    // First, balls at rest have a small mobility: this shows which forces between them and from cushions they need to
    // stay at rest. Then they are fixed.
    Solution solution{};
    const std::size_t most = static_cast<std::size_t>(kModeChanges + 2) * g.bodies.size() + 2;
    for (std::size_t tries = 0; tries < most; ++tries) {
        solution = solve_contacts(g, kRestCompliance);
        if (modes_hold(g, slow)) break;
    }
    const bool any_rests =
        std::any_of(g.bodies.begin(), g.bodies.end(), [](const Body& b) { return b.mode == Mode::kResting; });
    return any_rests ? solve_contacts(g, 0.0) : solution;
}

}  // namespace

void make_directions(Group& g) {
    for (std::size_t k = 0; k < g.bodies.size(); ++k) {
        const RestingBall& ball = g.group.balls[k];
        Body& b = g.bodies[k];
        if (b.mode == Mode::kSliding) b.mode = mode_of(g, ball);  // the projection may have ended its slip
        const Vec2 along = b.mode == Mode::kSliding ? cloth_slip(ball.v, ball.w, g.motion.R) : planar(ball.v);
        const double size = length(along);
        b.starts = !(size > 0.0);  // the forces then determine the direction
        b.due = Vec2::Zero();
        if (b.starts) continue;
        b.direction = along / size;
        if (b.mode == Mode::kRolling && size < kSlowIntervals * g.motion.roll * kShortestInterval) {
            b.starts = true;
            b.due = along / kShortestInterval;
        }
    }
    for (Link& link : g.links) {
        if (link.j < 0) continue;
        const RestingBall &bi = g.group.balls[link.i], &bj = g.group.balls[link.j];
        const Vec2 t(link.n.y(), -link.n.x());
        const double s_x = dot(planar(bi.v) - planar(bj.v), t) - g.motion.R * (bi.w.z() + bj.w.z());
        const double s_z = g.motion.R * (dot(planar(bi.w), t) + dot(planar(bj.w), t));
        const double slip = length(Vec2(s_x, s_z));
        link.slip_z = s_z;
        link.slip_x = s_x;
        link.friction = slip > 0.0 ? ball_friction(g.around.balls, slip) : 0.0;
        link.friction_z = slip > 0.0 ? -link.friction * s_z / slip : 0.0;
        link.stuck = false;
    }
}

double load(const Group& g, const Body& b) {
    return b.lifted ? 0.0 : std::max(0.0, 1.0 - b.lift / g.around.gravity);
}

double gap_acceleration(const Group& g, const Link& link) {
    const Vec2 other = link.j >= 0 ? g.bodies[link.j].a : Vec2::Zero();
    return dot(link.n, other - g.bodies[link.i].a) + link.curving + link.returning;
}

// A contact that opens, but is pressed together so that it would close again within the shortest interval, does not
// end; its opening rate is removed within that interval instead.
bool keep_returning(Group& g) {
    bool any = false;
    for (Link& link : g.links) {
        if (!link.open) continue;
        const double rate = gap_rate(g, link);
        if (!(rate < -gap_acceleration(g, link) * kShortestInterval)) continue;
        link.open = false;
        link.returning = rate / kShortestInterval;
        any = true;
    }
    return any;
}

Solution solve_forces(Group& g, double interval, SlowBalls slow) {
    constexpr int kPasses = 4;  // [-] most updates of stiction and stabilisation
    Solution solution{};
    for (int pass = 0; pass < kPasses; ++pass) {
        solution = solve_forces_once(g, interval, slow);
        const bool slips = solve_stiction(g, interval);
        if (!slips && (!(interval > 0.0) || !stabilisation_falls_short(g, interval))) break;
    }
    return solution;
}

bool any_stuck(const Group& g) {
    return std::any_of(g.links.begin(), g.links.end(), [](const Link& l) { return l.stuck; });
}

}  // namespace carom::resting
