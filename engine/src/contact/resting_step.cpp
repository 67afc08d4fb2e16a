// The implicit step of a group of resting contacts over an interval (resting_group.h).
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "carom/engine/tolerances.h"
#include "contact/resting_group.h"
#include "physics/motion.h"

namespace carom::resting {

namespace {

// [of what drives a group] If a contact pushes more than this, balls lock each other.
constexpr double kLocked = 10.0;
// [of the accelerations that drive a group] Larger forces show that a wedge cannot be stabilised.
constexpr double kLargestStabilised = 1e3;
// [-] A wedge's forces are its own if they are as large without stabilisation, up to this factor.
constexpr double kOwnForce = 2.0;
// [of the energy] Less work is rounding.
constexpr double kWorkRounding = 1e-12;
// [ulp of the speeds and impulses] Smaller rates of a gap are zero.
constexpr double kRateUlp = 32.0;

// [m/s^2] The accelerations that drive a group.
double drive_of(const Group& g) {
    double drive = g.motion.slide + g.motion.roll;
    for (const Link& link : g.links) drive = std::max(drive, std::abs(link.turning));
    return drive;
}

// Whether contacts push more than `times` the effect over h of what drives the group.
bool pushes(const Group& g, double h, double times) {
    const double most = times * drive_of(g) * h;
    return std::any_of(g.links.begin(), g.links.end(), [most](const Link& link) { return link.J > most; });
}

// Whether balls that hardly can move are driven by a friction that is only nearly right: it does work at the
// end of the interval, where only turning normals may. Compares twice the energy of the start with what the
// impulses would add at the speeds of the end, per mass.
bool is_driven(const Group& g, double h) {
    if (!pushes(g, h, 1.0)) return false;
    double energy = 0.0, power = 0.0;
    for (const Body& b : g.bodies) {
        energy += (dot(b.v, b.v) + kInertia * dot(b.s, b.s)) / b.ease;
        power += (dot(b.v_end, b.v_end - b.v) + kInertia * dot(b.s_end, b.s_end - b.s)) / b.ease;
    }
    // The wall around a ball turns its normal towards the ball; run_along_walls() takes that work back.
    for (const Link& link : g.links)
        if (link.distance < 0.0) power += link.J * dot(link.n, g.bodies[link.i].v_end);
    return power > kWorkRounding * energy;
}

bool solve_with(Group& g, double h, const StepOptions& options) {
    if (!options.friction) {
        // Do not start from a step with friction: balls between two walls keep any impulse.
        for (Link& link : g.links) link.friction_z = link.J = 0.0;
    }
    return solve_newton(g, h, options) && !(options.friction && is_driven(g, h));
}

// Two opposing fixed normals cannot both be stabilised: the forces are then huge and mean nothing, and in a
// wedge they must not remain. But a flat wedge also has large forces of its own, which stay about as large
// without stabilisation.
void drop_stabilisation(Group& g, double h, const StepOptions& options) {
    const double most = kLargestStabilised * drive_of(g) * h;
    const auto is_huge = [most](const Link& link) { return link.turning != 0.0 && link.J > most; };
    if (std::none_of(g.links.begin(), g.links.end(), is_huge)) return;
    const std::vector<Body> bodies = g.bodies;
    const std::vector<Link> links = g.links;
    for (Link& link : g.links) {
        if (is_huge(link)) {
            link.walled = true;
            link.turning = 0.0;
        }
    }
    for (Link& link : g.links) link.J = 0.0;
    bool better = solve_with(g, h, options);
    if (better) {
        better = false;
        for (std::size_t c = 0; c < links.size(); ++c)
            better = better || (is_huge(links[c]) && links[c].J > kOwnForce * g.links[c].J);
    }
    if (better) return;
    g.bodies = bodies;
    g.links = links;
}

}  // namespace

double rate_rounding(const Group& g) {
    double size = 0.0;
    for (const Body& b : g.bodies) size = std::max(size, length(b.v) + length(b.v_end) + b.impulses);
    return kRateUlp * kEpsilon * size;
}

double friction_at_start(const Group& g, const Link& link) {
    const Vec2 slip = contact_slip(g, link, false);
    const double size = length(slip);
    return size > 0.0 ? -g.around.balls.ball_friction()(size) * slip.x() / size : 0.0;
}

bool locks(const Group& g, double h) {
    return pushes(g, h, kLocked);
}

bool step(Group& g, double h, StepOptions options) {
    // Warm start: scale the last solution by the ratio of the interval lengths, unless balls lock each other.
    const double share = !(g.solved > 0.0) ? 0.0 : locks(g, g.solved) ? 1.0 : h / g.solved;
    for (Link& link : g.links) {
        link.J *= share;
        if (share > 0.0) continue;
        link.turning = 0.0;
        if (link.j >= 0) link.friction_z = options.friction ? friction_at_start(g, link) : 0.0;
    }
    for (Body& b : g.bodies) {
        b.v_end = b.v + share * (b.v_end - b.v);
        b.s_end = b.s + share * (b.s_end - b.s);
    }
    g.solved = 0.0;
    // If the last attempt had no solution with friction, look for one once, not three times.
    const bool again = !std::exchange(g.smooth, false) || !options.friction;
    bool solved = solve_with(g, h, options);
    if (g.cut > 0.0) {
        g.solved = h;
        return false;
    }
    options.may_cut = false;
    if (options.stabilise && solved) drop_stabilisation(g, h, options);
    // Without friction the second try would repeat the first.
    if (options.stabilise && !solved && again && options.friction) solved = solve_with(g, h, options);
    if (solved) {
        g.solved = h;
        return true;
    }
    // With friction there may be no solution at all (Painlevé's paradox).
    StepOptions less = options;
    less.stabilise = false;
    if (options.stabilise && again && solve_with(g, h, less)) return true;
    less.friction = false;
    g.smooth = options.friction && solve_with(g, h, less);
    return g.smooth;
}

bool strike(Group& g) {
    g.solved = 0.0;
    const bool solved = step(g, 0.0, {.friction = false, .stabilise = false});
    g.solved = 0.0;
    return solved;
}

}  // namespace carom::resting
