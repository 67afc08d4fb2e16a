// The response of a group's balls to the impulses of their contacts over an interval (resting_group.h).
#include <algorithm>
#include <cmath>

#include "contact/resting_group.h"

namespace carom::resting {

namespace {

Matrix identity(double c) {
    return {c, 0.0, c};
}

// c (1 - d d^T)
Matrix across_of(double c, const Vec2& d) {
    // Products first, so that turned directions give the same bits.
    return {c * (d.y() * d.y()), -c * (d.x() * d.y()), c * (d.x() * d.x())};
}

Matrix minus(const Matrix& a, const Matrix& b) {
    return {a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
}

Matrix times(double c, const Matrix& a) {
    return {c * a.xx, c * a.xy, c * a.yy};
}

void slide(Body& b, const Vec2& friction) {
    b.mode = Mode::kSliding;
    b.v_end = b.v + b.push + friction;
    b.s_end = b.s + 2.5 * (b.couple - friction);
}

// A puck cannot turn: its slip is its velocity.
void respond_puck(const Group& g, Body& b, double h) {
    const double grip = g.motion.slide * b.load * h;
    const Vec2 v = b.v + b.push;
    const double speed = length(v);
    b.s_end = Vec2::Zero();
    if (h == 0.0 || grip == 0.0 || speed > grip) {
        const Vec2 d = h == 0.0 || grip == 0.0 ? Vec2(Vec2::Zero()) : b.guided ? b.guide : Vec2(v / speed);
        b.mode = Mode::kSliding;
        b.v_end = v - grip * d;
        b.by_push = identity(1.0);
        if (!b.guided && speed > 0.0) b.by_push = minus(b.by_push, across_of(grip / speed, d));
        return;
    }
    b.mode = Mode::kResting;
    b.v_end = Vec2::Zero();
    b.by_push = identity(kRestCompliance);
}

// The motion of a ball under the impulses on it, and its derivatives.
void respond(const Group& g, Body& b, double h) {
    const double grip = g.motion.slide * b.load * h;
    const bool slips = moves(b.u);
    // A ball that slips at the start rolls from the end of its slip on.
    const double drag = (slips ? 1.0 - b.slid : 1.0) * std::min(g.motion.roll * h, grip);
    if (h == 0.0) {
        slide(b, Vec2::Zero());
        b.by_push = identity(1.0);
        return;
    }
    if (b.guided && slips) {
        slide(b, -grip * b.guide);
        b.by_push = identity(1.0);
        return;
    }
    const Vec2 slip = b.u + b.push - 2.5 * b.couple;
    const double size = length(slip);
    if (size > 3.5 * grip) {
        const Vec2 d = slip / size;
        slide(b, -grip * d);
        const Matrix turn = across_of(grip / size, d);
        b.by_push = minus(identity(1.0), turn);
        return;
    }
    const Vec2 rolls = b.v + b.push - slip * (2.0 / 7.0);
    const double speed = length(rolls);
    if (drag == 0.0) {
        b.mode = Mode::kRolling;
        b.v_end = rolls;
        b.by_push = identity(5.0 / 7.0);
    } else if (b.guided) {
        b.mode = Mode::kRolling;
        b.v_end = rolls - drag * b.guide;
        b.by_push = identity(5.0 / 7.0);
    } else if (speed > drag) {
        const Vec2 d = rolls / speed;
        b.mode = Mode::kRolling;
        b.v_end = rolls - drag * d;
        b.by_push = minus(identity(5.0 / 7.0), across_of((5.0 / 7.0) * drag / speed, d));
    } else {
        b.mode = Mode::kResting;
        b.v_end = Vec2::Zero();
        b.by_push = identity(kRestCompliance);
    }
    if (!moves(b.v_end)) b.mode = Mode::kResting;
    b.s_end = b.v_end;
}

}  // namespace

void respond(Group& g, double h) {
    for (Body& b : g.bodies) {
        b.push = b.couple = Vec2::Zero();
        b.lift = b.impulses = 0.0;
    }
    for (const Link& link : g.links) {
        Body& bi = g.bodies[link.i];
        const double Ji = bi.ease * link.J;
        bi.push -= Ji * link.n;
        bi.couple -= bi.ease * link.Z * link.n;
        bi.lift += bi.ease * link.lift;
        bi.impulses += std::abs(Ji);
        if (link.j < 0) continue;
        Body& bj = g.bodies[link.j];
        const double Jj = bj.ease * link.J;
        bj.push += Jj * link.n;
        bj.couple -= bj.ease * link.Z * link.n;
        bj.lift -= bj.ease * link.lift;
        bj.impulses += std::abs(Jj);
    }
    const double weight = g.around.gravity * h;
    for (Body& b : g.bodies) {
        b.load = weight > 0.0 ? std::max(0.0, 1.0 - b.lift / weight) : 1.0;
        if (g.motion.rolls)
            respond(g, b, h);
        else
            respond_puck(g, b, h);
        if (b.ease != 1.0) b.by_push = times(b.ease, b.by_push);
    }
}

}  // namespace carom::resting
