// Capture: what takes the closing speeds out of a held group.
#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/complementarity.h"
#include "contact/resting_solver.h"

namespace carom {

namespace {

// [-] A held contact that opens at some rate is closed only if no ball changes by more than this many times the rate.
constexpr double kStickyShare = 10.0;

}  // namespace

// The velocities nearest to the present ones, in the metric of the masses, that close no contact
// (clusters.md, equation 7): plastic. A pressed contact that opens so slowly that it would be closed again at
// once is closed now.
void HeldSolver::capture() {
    stop_slow();
    const std::vector<char> sticky = sticky_contacts();
    const bool any = std::any_of(sticky.begin(), sticky.end(), [](char s) { return s != 0; });
    if (!any || !project(sticky)) project(std::vector<char>(links_.size(), 0));
    // What stops now is a wall to the others.
    if (settle()) project(std::vector<char>(links_.size(), 0));
    for (Link& link : links_) {
        link.open = gap_rate(link) > noise_;
        link.returning = 0.0;
        link.N = 0.0;
    }
}

// What friction stops within the shortest interval has stopped. Not where that would stop others: a wall that
// comes to rest in front of a ball that has all but passed it, in a narrow wedge, jams that ball.
void HeldSolver::stop_slow() {
    double fastest = 0.0;
    std::vector<std::size_t> stopped;
    const std::vector<HeldBall> before = group_.balls;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        HeldBall& ball = group_.balls[k];
        const double speed = length(planar(ball.v));
        if (bodies_[k].mode != Mode::kResting || speed == 0.0) continue;
        fastest = std::max(fastest, speed);
        stopped.push_back(k);
        ball.v = Vec3::Zero();
        ball.w.x() = ball.w.y() = 0.0;
    }
    if (stopped.empty()) return;
    project(std::vector<char>(links_.size(), 0));
    double largest = 0.0;
    for (std::size_t k = 0; k < bodies_.size(); ++k)
        largest = std::max(largest, length(planar(group_.balls[k].v) - planar(before[k].v)));
    if (largest <= kStickyShare * fastest) return;
    group_.balls = before;
    for (const std::size_t k : stopped) bodies_[k].mode = Mode::kRolling;
}

std::vector<char> HeldSolver::sticky_contacts() const {
    std::vector<char> sticky(links_.size(), 0);
    for (std::size_t c = 0; c < links_.size(); ++c) {
        const Link& link = links_[c];
        const double rate = gap_rate(link);
        if (!(link.N > 0.0)) continue;
        const double restitution = link.j >= 0 ? around_.balls.e_b : around_.balls.e_c;
        sticky[c] = rate <= 0.0 || holds(rate, link.N * link.diagonal, restitution);
    }
    return sticky;
}

// @return false if the sticky contacts cannot be closed without a change far greater than their rates
// (normals that nearly agree, as from a jaw onto the cushion, would stop the ball): then nothing is changed.
bool HeldSolver::project(const std::vector<char>& sticky) {
    std::vector<std::size_t> active;
    for (std::size_t c = 0; c < links_.size(); ++c) {
        const Link& link = links_[c];
        if (body(link.i).mobility() + (link.j >= 0 ? body(link.j).mobility() : 0.0) > 0.0)
            active.push_back(c);
    }
    Complementarity problem(active.size());
    for (std::size_t r = 0; r < active.size(); ++r) {
        const Link& row = links_[active[r]];
        problem.free[r] = sticky[active[r]];
        for (std::size_t k = 0; k < active.size(); ++k) {
            const Link& column = links_[active[k]];
            // Impulse 1 in `column` gives its ball i the velocity -mobility n, its ball j +mobility n.
            double sum = 0.0;
            const double along = dot(row.n, column.n);
            if (row.i == column.i) sum += body(row.i).mobility() * along;
            if (row.j >= 0 && row.j == column.j) sum += body(row.j).mobility() * along;
            if (column.j >= 0 && row.i == column.j) sum -= body(row.i).mobility() * along;
            if (row.j >= 0 && row.j == column.i) sum -= body(row.j).mobility() * along;
            problem.at(r, k) = sum;
        }
    }
    // What the first solution leaves by rounding, the next ones take.
    for (int pass = 0; pass < 3; ++pass) {
        double worst = 0.0, rates = 0.0;
        for (std::size_t r = 0; r < active.size(); ++r) {
            problem.q[r] = gap_rate(links_[active[r]]);
            const double wrong = problem.free[r] ? std::abs(problem.q[r]) : -problem.q[r];
            worst = std::max(worst, wrong);
            if (wrong > 0.0) rates += wrong;
        }
        if (worst <= (pass == 0 ? 0.0 : 0.125 * noise_)) break;
        if (!problem.solve()) return false;
        std::vector<Vec2> change(bodies_.size(), Vec2::Zero());
        for (std::size_t r = 0; r < active.size(); ++r) {
            const Link& link = links_[active[r]];
            change[link.i] -= problem.z[r] * body(link.i).mobility() * link.n;
            if (link.j >= 0) change[link.j] += problem.z[r] * body(link.j).mobility() * link.n;
        }
        if (pass == 0) {
            const bool any = std::any_of(sticky.begin(), sticky.end(), [](char s) { return s != 0; });
            double largest = 0.0;
            for (const Vec2& dv : change) largest = std::max(largest, length(dv));
            if (any && largest > kStickyShare * rates) return false;
        }
        for (std::size_t k = 0; k < change.size(); ++k) kick(static_cast<int>(k), change[k]);
    }
    return true;
}

void HeldSolver::kick(int index, const Vec2& dv) {
    if (dv.x() == 0.0 && dv.y() == 0.0) return;
    HeldBall& ball = group_.balls[index];
    ball.v.x() += dv.x();
    ball.v.y() += dv.y();
    if (body(index).mode == Mode::kRolling) {
        ball.w.x() = -ball.v.y() / motion_.R;
        ball.w.y() = ball.v.x() / motion_.R;
    }
}

}  // namespace carom
