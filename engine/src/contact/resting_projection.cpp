// The plastic projection, which removes the closing speeds of a group of resting contacts.
#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/complementarity.h"
#include "contact/resting_group.h"

namespace carom::resting {

namespace {

// [-] A contact that opens at some rate is closed only if no velocity changes by more than this many times the rate.
constexpr double kStickyShare = 10.0;

void add_velocity(Group& g, int index, const Vec2& dv) {
    if (dv.x() == 0.0 && dv.y() == 0.0) return;
    RestingBall& ball = g.group.balls[index];
    ball.v.x() += dv.x();
    ball.v.y() += dv.y();
    if (g.bodies[index].mode == Mode::kRolling) {
        ball.w.x() = -ball.v.y() / g.motion.R;
        ball.w.y() = ball.v.x() / g.motion.R;
    }
}

std::vector<char> sticky_contacts(const Group& g) {
    std::vector<char> sticky(g.links.size(), 0);
    for (std::size_t c = 0; c < g.links.size(); ++c) {
        const Link& link = g.links[c];
        const double rate = gap_rate(g, link);
        if (!(link.N > 0.0)) continue;
        const double restitution = link.j >= 0 ? g.around.balls.e_b : g.around.balls.e_c;
        sticky[c] = rate <= 0.0 || holds(rate, link.N * link.diagonal, restitution);
    }
    return sticky;
}

// Projects: afterwards the sticky contacts have the rate 0, and the others do not close.
// @return false if the sticky contacts cannot be closed without a change far greater than their rates (normals that
// nearly agree, as from a jaw onto the cushion, would stop the ball); nothing is changed then
bool project(Group& g, const std::vector<char>& sticky) {
    std::vector<std::size_t> active;
    for (std::size_t c = 0; c < g.links.size(); ++c) {
        const Link& link = g.links[c];
        if (g.bodies[link.i].mobility() + (link.j >= 0 ? g.bodies[link.j].mobility() : 0.0) > 0.0)
            active.push_back(c);
    }
    Complementarity problem(active.size());
    for (std::size_t r = 0; r < active.size(); ++r) {
        const Link& row = g.links[active[r]];
        problem.free[r] = sticky[active[r]];
        for (std::size_t k = 0; k < active.size(); ++k) {
            const Link& column = g.links[active[k]];
            // A unit impulse in `column` changes the velocity of its ball i by -mobility n, of j by +mobility n.
            double sum = 0.0;
            const double along = dot(row.n, column.n);
            if (row.i == column.i) sum += g.bodies[row.i].mobility() * along;
            if (row.j >= 0 && row.j == column.j) sum += g.bodies[row.j].mobility() * along;
            if (column.j >= 0 && row.i == column.j) sum -= g.bodies[row.i].mobility() * along;
            if (row.j >= 0 && row.j == column.i) sum -= g.bodies[row.j].mobility() * along;
            problem.at(r, k) = sum;
        }
    }
    // The second and third solution remove what the first one leaves by rounding.
    for (int pass = 0; pass < 3; ++pass) {
        double worst = 0.0, rates = 0.0;
        for (std::size_t r = 0; r < active.size(); ++r) {
            problem.q[r] = gap_rate(g, g.links[active[r]]);
            const double wrong = problem.free[r] ? std::abs(problem.q[r]) : -problem.q[r];
            worst = std::max(worst, wrong);
            if (wrong > 0.0) rates += wrong;
        }
        if (worst <= (pass == 0 ? 0.0 : 0.125 * g.noise)) break;
        if (!problem.solve()) return false;
        std::vector<Vec2> change(g.bodies.size(), Vec2::Zero());
        for (std::size_t r = 0; r < active.size(); ++r) {
            const Link& link = g.links[active[r]];
            change[link.i] -= problem.z[r] * g.bodies[link.i].mobility() * link.n;
            if (link.j >= 0) change[link.j] += problem.z[r] * g.bodies[link.j].mobility() * link.n;
        }
        if (pass == 0) {
            const bool any = std::any_of(sticky.begin(), sticky.end(), [](char s) { return s != 0; });
            double largest = 0.0;
            for (const Vec2& dv : change) largest = std::max(largest, length(dv));
            if (any && largest > kStickyShare * rates) return false;
        }
        for (std::size_t k = 0; k < change.size(); ++k) add_velocity(g, static_cast<int>(k), change[k]);
    }
    return true;
}

// Stops the balls that friction stops within the shortest interval, unless that would stop others: in a narrow wedge,
// an obstacle that stops in front of a ball that has almost passed it would jam that ball.
void stop_within_interval(Group& g) {
    double fastest = 0.0;
    std::vector<std::size_t> stopped;
    const std::vector<RestingBall> before = g.group.balls;
    for (std::size_t k = 0; k < g.bodies.size(); ++k) {
        RestingBall& ball = g.group.balls[k];
        const double speed = length(planar(ball.v));
        if (g.bodies[k].mode != Mode::kResting || speed == 0.0) continue;
        fastest = std::max(fastest, speed);
        stopped.push_back(k);
        ball.v = Vec3::Zero();
        ball.w.x() = ball.w.y() = 0.0;
    }
    if (stopped.empty()) return;
    project(g, std::vector<char>(g.links.size(), 0));
    double largest = 0.0;
    for (std::size_t k = 0; k < g.bodies.size(); ++k)
        largest = std::max(largest, length(planar(g.group.balls[k].v) - planar(before[k].v)));
    if (largest <= kStickyShare * fastest) return;
    g.group.balls = before;
    for (const std::size_t k : stopped) g.bodies[k].mode = Mode::kRolling;
}

}  // namespace

// The velocities nearest to the present ones, in the metric of the masses, that close no contact (docs/reference/physics.md,
// "Resting contacts"). A pressed contact that opens so slowly that it would close again at once is closed now.
void project_velocities(Group& g) {
    stop_within_interval(g);
    const std::vector<char> sticky = sticky_contacts(g);
    const bool any = std::any_of(sticky.begin(), sticky.end(), [](char s) { return s != 0; });
    if (!any || !project(g, sticky)) project(g, std::vector<char>(g.links.size(), 0));
    // Balls that stop now are fixed obstacles to the others.
    if (stop_slow_rolling(g)) project(g, std::vector<char>(g.links.size(), 0));
    for (Link& link : g.links) {
        link.open = gap_rate(g, link) > g.noise;
        link.returning = 0.0;
        link.N = 0.0;
    }
}

}  // namespace carom::resting
