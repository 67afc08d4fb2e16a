// The implicit step of a group of resting contacts over an interval (resting_group.h).
#include <algorithm>

#include "carom/engine/tolerances.h"
#include "contact/resting_group.h"

namespace carom::resting {

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

bool step(Group& g, double h) {
    // Warm start: scale the last solution by the ratio of the interval lengths.
    const double share = g.solved > 0.0 ? h / g.solved : 0.0;
    for (Link& link : g.links) {
        link.J *= share;
        link.Z *= share;
        link.lift *= share;
        if (share == 0.0) {
            link.turning = 0.0;
            link.n = link.first;
        }
    }
    for (Body& b : g.bodies) {
        b.v_end = b.v + share * (b.v_end - b.v);
        b.s_end = b.s + share * (b.s_end - b.s);
    }
    bool solved = solve_newton(g, h, h > 0.0);
    // Two opposing normals that turn may make the problem infeasible: then keep the first normals.
    if (!solved && h > 0.0) {
        for (Link& link : g.links) {
            link.J = link.Z = link.lift = link.turning = 0.0;
            link.n = link.first;
        }
        solved = solve_newton(g, h, false);
    }
    g.solved = solved ? h : 0.0;
    return solved;
}

bool strike(Group& g) {
    g.solved = 0.0;
    const bool solved = step(g, 0.0);
    g.solved = 0.0;
    return solved;
}

}  // namespace carom::resting
