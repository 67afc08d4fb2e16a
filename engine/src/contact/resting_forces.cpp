// Contact forces and accelerations of a held group.
#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/complementarity.h"
#include "contact/resting_solver.h"

namespace carom {

namespace {

// [of what drives a group] Forces beyond this have no answer: what asks for them is left out. A wedge of
// slope s multiplies the drive by 1/s, and slopes down to 1e-8 are solved; contacts that contradict each
// other, by 1/kContactSoftness. The second: a wedge that has no room for margins.
constexpr double kLargestHold = 1e9;
constexpr double kLargestLeadOut = 1e4;
// [-] Mobility of balls at rest while it is decided which of them stay, against 1 of a ball that slips.
constexpr double kRestGives = 1e-4;
// [of the coefficient] To which the friction that ends a slip is solved.
constexpr double kStickAccuracy = 1e-3;
// [of kHoldShortest] A held ball that its own rolling friction would stop within this time takes the
// direction of its friction from where its forces lead it; an explicit step would be unstable.
constexpr double kHoldSlow = 4.0;

}  // namespace

void HeldSolver::make_directions() {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const HeldBall& ball = group_.balls[k];
        Body& b = bodies_[k];
        if (b.mode == Mode::kSliding) b.mode = mode_of(ball);  // the capture may have ended its slip
        const Vec2 along = b.mode == Mode::kSliding ? cloth_slip(ball.v, ball.w, motion_.R) : planar(ball.v);
        const double size = length(along);
        b.starts = !(size > 0.0);  // then the direction is that of the forces
        b.due = Vec2::Zero();
        if (b.starts) continue;
        b.direction = along / size;
        if (b.mode == Mode::kRolling && size < kHoldSlow * motion_.roll * kHoldShortest) {
            b.starts = true;
            b.due = along / kHoldShortest;
        }
    }
    for (Link& link : links_) {
        if (link.j < 0) continue;
        const HeldBall &bi = group_.balls[link.i], &bj = group_.balls[link.j];
        const Vec2 t(link.n.y(), -link.n.x());
        const double s_x = dot(planar(bi.v) - planar(bj.v), t) - motion_.R * (bi.w.z() + bj.w.z());
        const double s_z = motion_.R * (dot(planar(bi.w), t) + dot(planar(bj.w), t));
        const double slip = length(Vec2(s_x, s_z));
        link.slip_z = s_z;
        link.slip_x = s_x;
        link.friction = slip > 0.0 ? ball_friction(around_.balls, slip) : 0.0;
        link.friction_z = slip > 0.0 ? -link.friction * s_z / slip : 0.0;
        link.stuck = false;
    }
}

// Share of the weight that the cloth carries.
double HeldSolver::load(const Body& b) const {
    return b.lifted ? 0.0 : std::max(0.0, 1.0 - b.lift / around_.gravity);
}

void HeldSolver::accelerate() {
    for (Body& b : bodies_) {
        switch (b.mode) {
            case Mode::kSliding:
                b.a = b.push - motion_.slide * load(b) * b.direction;
                break;
            case Mode::kRolling:
                b.a = (5.0 / 7.0) * (b.push + b.couple) - motion_.roll * b.direction;
                break;
            case Mode::kResting:
                b.a = give_ * (b.push + b.couple) - b.due;
                break;
        }
    }
}

void HeldSolver::sum_forces() {
    for (Body& b : bodies_) {
        b.push = b.couple = Vec2::Zero();
        b.lift = 0.0;
    }
    for (const Link& link : links_) {
        Body& bi = body(link.i);
        bi.push -= link.N * link.n;
        bi.couple -= link.friction_z * link.N * link.n;
        bi.lift += link.friction_z * link.N;
        if (link.j < 0) continue;
        Body& bj = body(link.j);
        bj.push += link.N * link.n;
        bj.couple -= link.friction_z * link.N * link.n;
        bj.lift -= link.friction_z * link.N;
    }
}

// Acceleration of the gap with the present forces.
double HeldSolver::gap_acceleration(const Link& link) const {
    const Vec2 other = link.j >= 0 ? body(link.j).a : Vec2::Zero();
    return dot(link.n, other - body(link.i).a) + link.curving + link.returning;
}

// Acceleration of a body by a force of 1 in the contact.
Vec2 HeldSolver::response(const Link& link, int index, bool friction) const {
    const Body& b = body(index);
    const double f = friction ? link.friction_z : 0.0, sign = index == link.i ? -1.0 : 1.0;
    switch (b.mode) {
        case Mode::kSliding: {
            const double lift = b.lifted ? 0.0 : -sign * f / around_.gravity;
            return sign * link.n + motion_.slide * lift * b.direction;
        }
        case Mode::kRolling:
            return (5.0 / 7.0) * (sign - f) * link.n;
        case Mode::kResting:
            return give_ * (sign - f) * link.n;
    }
    return Vec2::Zero();
}

// N >= 0, gap acceleration >= margin, complementary; for the present modes and directions.
bool HeldSolver::solve_contacts_once(Share share) {
    const auto [friction, margins] = share;
    margins_ = margins;
    solved_ = false;
    for (Link& link : links_) link.N = 0.0;
    sum_forces();
    accelerate();
    std::vector<std::size_t> active;
    for (std::size_t c = 0; c < links_.size(); ++c) {
        Link& link = links_[c];
        const auto mobility = [this](const Body& b) { return std::max(give_, b.mobility()); };
        link.diagonal = mobility(body(link.i)) + (link.j >= 0 ? mobility(body(link.j)) : 0.0);
        if (!link.open && link.diagonal > 0.0) active.push_back(c);
    }
    Complementarity problem(active.size());
    double drive = 0.0;
    for (std::size_t k = 0; k < active.size(); ++k) {
        const Link& column = links_[active[k]];
        const Vec2 on_i = response(column, column.i, friction),
                   on_j = column.j >= 0 ? response(column, column.j, friction) : Vec2::Zero();
        problem.q[k] = gap_acceleration(column) - (margins ? column.margin : 0.0);
        drive = std::max(drive, std::abs(problem.q[k]));
        for (std::size_t r = 0; r < active.size(); ++r) {
            const Link& row = links_[active[r]];
            double sum = 0.0;
            if (row.i == column.i) sum -= dot(row.n, on_i);
            if (row.i == column.j) sum -= dot(row.n, on_j);
            if (row.j >= 0 && row.j == column.i) sum += dot(row.n, on_i);
            if (row.j >= 0 && row.j == column.j) sum += dot(row.n, on_j);
            problem.at(r, k) = sum;
        }
    }
    if (!problem.solve()) return false;
    drive += motion_.slide + motion_.roll;
    bool possible = true;
    for (std::size_t k = 0; k < active.size(); ++k) {
        Link& link = links_[active[k]];
        link.N = problem.z[k];
        const bool leads_out = margins && !link.walled;
        if (link.N <= (leads_out ? kLargestLeadOut : kLargestHold) * drive) continue;
        possible = false;
        if (!leads_out) continue;
        link.walled = true;
        link.margin = 0.0;
    }
    if (!possible) {
        for (Link& link : links_) link.N = 0.0;
        return false;
    }
    sum_forces();
    accelerate();
    solved_ = !margins || !drop_margins(active);
    return solved_;
}

// Two walls leave no room for margins; the softness answers with great forces that mean nothing. Contacts
// that come out so lose theirs.
bool HeldSolver::drop_margins(const std::vector<std::size_t>& active) {
    bool any = false;
    for (const std::size_t c : active) {
        Link& link = links_[c];
        const double off = gap_acceleration(link) - link.margin;
        if ((link.N > 0.0 ? std::abs(off) : -off) <= kHoldRounding * (motion_.slide + link.N)) continue;
        any = any || link.margin != 0.0;
        link.margin = 0.0;
        link.walled = true;
    }
    return any;
}

// Margins can ask for what a wedge cannot give, and friction can leave no answer at all (Painleve): then without.
bool HeldSolver::solve_contacts() {
    const bool margins =
        std::any_of(links_.begin(), links_.end(), [](const Link& l) { return l.margin != 0.0; });
    const bool friction =
        std::any_of(links_.begin(), links_.end(), [](const Link& l) { return l.friction_z != 0.0; });
    // Once more without the margins that were dropped; then without any.
    for (int tries = 0; tries < (margins ? 2 : 1); ++tries)
        if (solve_contacts_once({.friction = friction, .margins = margins})) return true;
    if (margins && solve_contacts_once({.friction = friction, .margins = false})) return true;
    if (!friction) return false;
    for (Link& link : links_) {
        link.friction_z = 0.0;
        link.stuck = false;
    }
    return solve_contacts_once({.friction = false, .margins = false});
}

// The rate of v_t^2 / |r|, 3 v_t a_t / |r|, must not close the gap within the interval.
double HeldSolver::margin_for(const Link& link, const Vec2& t, double distance, double interval) {
    const double a = std::abs(t.y()), h = std::max(interval, kHoldLeadOut);
    const double turning =
        distance > 0.0 ? interval * a * (1.5 * std::abs(t.x()) + interval * a) / distance : 0.0;
    return turning + (link.depth > kHoldDepth ? 2.0 * link.depth / (h * h) : 0.0);
}

// Whether the accelerations have come out so that the gap needs more than the margin that they were made for.
bool HeldSolver::margin_falls_short(double interval) const {
    for (std::size_t c = 0; c < links_.size(); ++c) {
        if (links_[c].open || links_[c].walled) continue;
        Vec2 t;
        const double distance = across(c, t);
        if (margin_for(links_[c], t, distance, interval) > 1.2 * links_[c].margin) return true;
    }
    return false;
}

// The contacts' share of the gap's acceleration that does not come from accelerations: |r|'' has v_t^2 / |r|
// from the turning normal.
void HeldSolver::curve(double interval) {
    for (std::size_t c = 0; c < links_.size(); ++c) {
        Link& link = links_[c];
        Vec2 t;
        const double distance = across(c, t);
        link.curving = distance > 0.0 ? t.x() * t.x() / distance : 0.0;
        link.margin = interval > 0.0 && !link.walled ? margin_for(link, t, distance, interval) : 0.0;
    }
}

// A contact that opens, but is pressed together so that it would be closed again within the shortest
// interval, does not end: its rate goes within that interval instead.
bool HeldSolver::hold_returning() {
    bool any = false;
    for (Link& link : links_) {
        if (!link.open) continue;
        const double rate = gap_rate(link);
        if (!(rate < -gap_acceleration(link) * kHoldShortest)) continue;
        link.open = false;
        link.returning = rate / kHoldShortest;
        any = true;
    }
    return any;
}

void HeldSolver::solve_forces(double interval) {
    constexpr int kPasses = 4;
    for (int pass = 0; pass < kPasses; ++pass) {
        solve_forces_once(interval);
        const bool slips = stick(interval);
        if (!slips && (!(interval > 0.0) || !margin_falls_short(interval))) break;
    }
}

// Rate of the slip that the vertical friction between two balls acts on.
double HeldSolver::slip_rate(const Link& link) const {
    const Vec2 t(link.n.y(), -link.n.x());
    return motion_.R *
           dot(spin_rate(static_cast<std::size_t>(link.i)) + spin_rate(static_cast<std::size_t>(link.j)), t);
}

// Friction that would turn the slip over within the interval ends it there instead: taken at the slip of the
// end, s + h (rate without friction) + h k N f, with k what a force of 1 makes of it. Taken at that of the
// start it would drive the slip to and fro, and with great forces gain energy.
// @return whether a friction has changed, so that the forces have to be found anew
bool HeldSolver::stick(double interval) {
    const double h = std::max(interval, kHoldShortest);
    const auto ease = [](const Body& b) {
        return b.mode == Mode::kSliding ? 2.5 : (b.mode == Mode::kRolling ? 5.0 / 7.0 : 0.0);
    };
    bool changed = false;
    for (Link& link : links_) {
        if (link.j < 0 || link.open || !(link.N > 0.0) || (link.friction_z == 0.0 && !link.stuck)) continue;
        const double end = link.slip_z + h * slip_rate(link);
        if (!link.stuck && !(end * link.slip_z < 0.0)) continue;
        const double effect = h * (ease(body(link.i)) + ease(body(link.j))) * link.N;
        if (!(effect > 0.0)) continue;
        const double share = link.friction * effect / (link.friction * effect + std::abs(link.slip_x));
        const double f = std::clamp(share * (link.friction_z - end / effect), -link.friction, link.friction);
        changed = changed || std::abs(f - link.friction_z) > kStickAccuracy * link.friction;
        link.friction_z = f;
        link.stuck = true;
    }
    return changed;
}

bool HeldSolver::any_stuck() const {
    return std::any_of(links_.begin(), links_.end(), [](const Link& l) { return l.stuck; });
}

void HeldSolver::solve_forces_once(double interval) {
    curve(interval);
    for (Body& b : bodies_) {
        b.changes = 0;
        b.lifted = false;
    }
    // First balls at rest give way a little, which shows what they need of the forces between them and of
    // cushions to stay; then not at all.
    give_ = kRestGives;
    const std::size_t most = static_cast<std::size_t>(kModeChanges + 2) * bodies_.size() + 2;
    for (std::size_t tries = 0; tries < most; ++tries) {
        solve_contacts();
        if (modes_hold()) break;
    }
    give_ = 0.0;
    const bool any_rests =
        std::any_of(bodies_.begin(), bodies_.end(), [](const Body& b) { return b.mode == Mode::kResting; });
    if (any_rests) solve_contacts();
}

}  // namespace carom
