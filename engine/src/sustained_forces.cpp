// Contact forces and accelerations of a held group.
#include <algorithm>
#include <cmath>

#include "carom/engine/tolerances.h"
#include "complementarity.h"
#include "sustained_solver.h"

namespace carom {

void HeldSolver::make_directions() {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const HeldBall& ball = group_.balls[k];
        Body& b = bodies_[k];
        const Vec2 along =
            b.mode == Mode::kSliding ? cloth_slip(ball.v, ball.w, motion_.R) : planar(ball.v);
        const double size = length(along);
        b.starts = !(size > 0.0);  // then the direction is that of the forces
        if (!b.starts) b.direction = along / size;
    }
    for (Link& link : links_) {
        if (link.j < 0) continue;
        const HeldBall &bi = group_.balls[static_cast<std::size_t>(link.i)],
                       &bj = group_.balls[static_cast<std::size_t>(link.j)];
        const Vec2 t(link.n.y(), -link.n.x());
        const double s_x = dot(planar(bi.v) - planar(bj.v), t) - motion_.R * (bi.w.z() + bj.w.z());
        const double s_z = motion_.R * (dot(planar(bi.w), t) + dot(planar(bj.w), t));
        const double slip = length(Vec2(s_x, s_z));
        link.friction_z = slip > 0.0 ? -ball_friction(plan_.balls, slip) * s_z / slip : 0.0;
    }
}

// Share of the weight that the cloth carries.
double HeldSolver::load(const Body& b) const {
    return b.lifted ? 0.0 : std::max(0.0, 1.0 - b.lift / plan_.gravity);
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
                b.a = Vec2::Zero();
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
    return dot(link.n, other - body(link.i).a) + link.curving;
}

// Acceleration of a body by a force of 1 in the contact.
Vec2 HeldSolver::response(const Link& link, int index, bool friction) const {
    const Body& b = body(index);
    const double f = friction ? link.friction_z : 0.0, sign = index == link.i ? -1.0 : 1.0;
    switch (b.mode) {
        case Mode::kSliding: {
            const double lift = b.lifted ? 0.0 : -sign * f / plan_.gravity;
            return sign * link.n + motion_.slide * lift * b.direction;
        }
        case Mode::kRolling:
            return (5.0 / 7.0) * (sign - f) * link.n;
        case Mode::kResting:
            break;
    }
    return Vec2::Zero();
}

// N >= 0, gap acceleration >= margin, complementary; for the present modes and directions.
bool HeldSolver::solve_contacts_once(bool friction, bool margins) {
    for (Link& link : links_) link.N = 0.0;
    sum_forces();
    accelerate();
    std::vector<std::size_t> active;
    for (std::size_t c = 0; c < links_.size(); ++c) {
        Link& link = links_[c];
        link.diagonal = body(link.i).mobility() + (link.j >= 0 ? body(link.j).mobility() : 0.0);
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
    for (std::size_t k = 0; k < active.size(); ++k) {
        if (!(problem.z[k] <= kLargestHold * (drive + motion_.slide + motion_.roll))) return false;
        links_[active[k]].N = problem.z[k];
    }
    sum_forces();
    accelerate();
    return true;
}

// Margins can ask for what a wedge cannot give, and friction can leave no answer at all (Painleve): then
// without.
bool HeldSolver::solve_contacts() {
    const bool margins = std::any_of(links_.begin(), links_.end(), [](const Link& l) { return l.margin != 0.0; });
    const bool friction =
        std::any_of(links_.begin(), links_.end(), [](const Link& l) { return l.friction_z != 0.0; });
    if (solve_contacts_once(friction, margins)) return true;
    if (margins && solve_contacts_once(friction, false)) return true;
    if (!friction) return false;
    for (Link& link : links_) link.friction_z = 0.0;
    return solve_contacts_once(false, false);
}

bool HeldSolver::change_mode(Body& b, Mode mode) {
    if (b.changes >= kModeChanges) return false;
    ++b.changes;
    b.mode = mode;
    return true;
}

// Whether every ball can do what its mode says; where not, the mode or the direction changes. Only what
// starts now may change back, and not for ever: a ball that finds no consistent mode keeps its last one.
bool HeldSolver::modes_hold() {
    bool hold = true;
    for (Body& b : bodies_) {
        const Vec2 roll = b.push + b.couple, slip = b.push - 2.5 * b.couple;
        const double roll_size = length(roll), slip_size = length(slip);
        if (b.mode == Mode::kSliding && !b.lifted && b.lift > plan_.gravity) {
            b.lifted = true;
            hold = false;
        }
        if (b.mode == Mode::kResting) {
            if ((5.0 / 7.0) * roll_size <= motion_.roll + kHoldRounding * (motion_.slide + length(b.push)))
                continue;
            if (!change_mode(b, Mode::kRolling)) continue;
            b.starts = true;
            b.direction = roll / roll_size;
            hold = false;
        } else if (b.mode == Mode::kRolling) {
            const double grip = motion_.slide * load(b) + motion_.roll;
            if (length(b.a - b.push) > grip * (1.0 + kHoldRounding)) {  // it slips
                if (!change_mode(b, Mode::kSliding)) continue;
                b.starts = true;
                b.direction = slip_size > 0.0 ? Vec2(slip / slip_size) : Vec2(-b.direction);
                hold = false;
            } else if (b.starts && (5.0 / 7.0) * roll_size <= motion_.roll) {  // it stays after all
                if (change_mode(b, Mode::kResting)) hold = false;
            } else if (b.starts && std::abs(cross(b.direction, roll)) > kHoldRounding * roll_size) {
                if (b.changes >= kModeChanges) continue;
                ++b.changes;
                b.direction = roll / roll_size;
                hold = false;
            }
        } else if (b.mode == Mode::kSliding && b.starts && slip_size > 0.0) {
            if (std::abs(cross(b.direction, slip)) <= kHoldRounding * slip_size &&
                dot(b.direction, slip) > 0.0)
                continue;
            if (b.changes >= kModeChanges) continue;
            ++b.changes;
            b.direction = slip / slip_size;
            hold = false;
        }
    }
    return hold;
}

// The contacts' share of the gap's acceleration that does not come from accelerations: |r|'' has v_t^2 / |r|
// from the turning normal; its own rate, 3 v_t a_t / |r|, must not close the gap within the interval.
void HeldSolver::curve(double interval) {
    for (std::size_t c = 0; c < links_.size(); ++c) {
        Link& link = links_[c];
        Vec2 t;
        const double distance = across(c, t);
        link.curving = distance > 0.0 ? t.x() * t.x() / distance : 0.0;
        link.margin = distance > 0.0 && interval > 0.0
                          ? 1.5 * interval * std::abs(t.x() * t.y()) / distance +
                                interval * interval * t.y() * t.y() / distance
                          : 0.0;
    }
}

void HeldSolver::solve_forces(double interval) {
    curve(interval);
    for (Body& b : bodies_) {
        b.changes = 0;
        b.lifted = false;
    }
    for (std::size_t tries = 0; tries < static_cast<std::size_t>(kModeChanges) * bodies_.size() + 2; ++tries) {
        solve_contacts();
        if (modes_hold()) break;
    }
}

}  // namespace carom
