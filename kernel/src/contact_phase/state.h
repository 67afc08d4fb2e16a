// The state of a contact phase, and the turning of its normals. Part of contact_phase.cpp.
#pragma once

#include "carom/kernel/contact_phase.h"
#include "contact_phase/law.h"
#include "numbers.h"
#include "simd.h"

namespace carom::kernel {
namespace {

constexpr int kPerBall = 5;  // numbers per ball in ContactPhase::motion

// Numbers per ball here. A row has velocities at even positions and spins at odd ones: a contact needs the
// difference of its balls' velocities and the sum of their spins, which is one subtract_add().
constexpr int kRow = 8;
constexpr int kForce = 6;                          // numbers per contact in Work::force
constexpr int kPlace[kPerBall] = {0, 2, 1, 3, 5};  // of v_x, v_y, R w_x, R w_y, R w_z in a row
constexpr int kLift = 4, kTurn = 5, kNext = 6, kAhead = 7,
              kStiffness = 7;  // of other numbers in a row (Work)

CAROM_INLINE int padded(int n) {
    return (n + 3) / 4 * 4;
}

struct Work {
    int balls, contacts;
    int rows, lanes;  // sizes of the arrays per ball and per contact
    // The state, its stages and their slopes. A row per ball: (v_x, R w_x, v_y, R w_y | lift, R w_z, next,
    // ahead). In a slope, `lift` and `next` are the sum of the vertical forces, and the last number
    // (kStiffness) is minus the sum of friction divided by slip. After a step, `lift` is the vertical impulse
    // of the step, and `next` that of half a step with the force at its end; `ahead` belongs to drag().
    double *y, *y_stage, *dy[kStages];
    double* moved;  // per ball the displacement so far, x in [0] and y in [2]
    // Per contact: overlap, its stages and their slopes, and 1 over the largest overlap since the contact
    // opened.
    double *d, *d_stage, *rate[kStages], *inverse;
    // Normal at the start of the step, its angular speed, and its curvature: 1/(2 R), or less if it turns
    // less than the balls (update_turning()).
    double *nx, *ny, *turn, *bend;
    double* share;    // of the turning, while the contact is closed
    double* watched;  // 1: it may close within the step; 0: its rates are not computed at stages
    // Per overlapping contact: n_x, n_y, F, the friction along t and upwards, and minus friction divided by
    // slip; four of each adjacent.
    double* force;
    double curvature;
    bool shares;  // whether some share is below 1
    // The rows of the two balls, and the contact's number in ContactPhase. Overlapping contacts come first,
    // then the others, each in the order of their numbers. So four of them are adjacent, and the sums of a
    // ball have one order.
    int *i, *j, *id;
    // contacts at the front: overlapping ones, and fewer than four that have opened since the last reordering
    int count;
    // Contacts at the front that may close within `horizon` [L/V], and the others in their registers.
    int near;
    double horizon;
    // The rows of balls on which a contact acts in this step. The other rows are equal in y and y_stage, and
    // their slopes are 0.
    int *active, *is_active, actives;
    // Workspace for reordering contacts.
    double* reordered;
    int *order, *spare, *places;
};

// The next `count` numbers of the scratch memory, set to zero.
CAROM_INLINE double* take(double*& from, int count) {
    double* taken = from;
    from += count;
    for (int n = 0; n < count; ++n) taken[n] = 0.0;
    return taken;
}

CAROM_INLINE void copy_row(double* to, const double* from) {
    store(to, load<4>(from));
    store(to + 4, load<4>(from + 4));
}

// Contacts that pad the last register connect an additional distant ball, at rest, with itself.
CAROM_INLINE Work lay_out(const ContactPhase& phase) {
    Work w;
    w.balls = phase.balls;
    w.contacts = phase.contacts;
    w.rows = phase.balls + 1;
    w.lanes = (phase.contacts + kRow) / kRow * kRow;
    double* next = phase.numbers;
    w.y = take(next, kRow * padded(w.rows));
    w.y_stage = take(next, kRow * padded(w.rows));
    for (double*& dy : w.dy) dy = take(next, kRow * padded(w.rows));
    w.moved = take(next, kRow / 2 * padded(w.rows));
    w.d = take(next, w.lanes);
    w.d_stage = take(next, w.lanes);
    for (double*& rate : w.rate) rate = take(next, w.lanes);
    w.inverse = take(next, w.lanes);
    w.nx = take(next, w.lanes);
    w.ny = take(next, w.lanes);
    w.turn = take(next, w.lanes);
    w.bend = take(next, w.lanes);
    w.share = take(next, w.lanes);
    w.watched = take(next, w.lanes);
    w.reordered = take(next, w.lanes);
    w.force = take(next, kForce * w.lanes);
    w.curvature = phase.curvature;
    w.shares = false;
    w.i = phase.places;
    w.j = w.i + w.lanes;
    w.id = w.j + w.lanes;
    w.order = w.id + w.lanes;
    w.spare = w.order + w.lanes;
    w.places = w.spare + w.lanes;
    w.active = w.places + w.lanes;
    w.is_active = w.active + padded(w.rows) + 4;
    w.count = w.near = w.actives = 0;
    w.horizon = 0.0;
    for (int b = 0; b < w.rows; ++b) {
        w.is_active[b] = 0;
        if (b == w.balls) break;
        for (int k = 0; k < kPerBall; ++k) w.y[kRow * b + kPlace[k]] = phase.motion[kPerBall * b + k];
        copy_row(w.y_stage + kRow * b, w.y + kRow * b);
    }
    for (int c = 0; c < w.lanes; ++c) {
        const bool real = c < w.contacts;
        w.id[c] = c;
        w.inverse[c] = kNoMemory;
        w.i[c] = kRow * (real ? phase.contact[c].i : w.balls);
        w.j[c] = kRow * (real ? phase.contact[c].j : w.balls);
        w.d[c] = real ? phase.contact[c].overlap : -kNoMemory;
        if (!real) continue;
        w.nx[c] = phase.contact[c].nx;
        w.ny[c] = phase.contact[c].ny;
        w.share[c] = phase.contact[c].turn;
        w.bend[c] = phase.curvature;
        w.shares |= w.share[c] < 1.0 && w.curvature > 0.0;
    }
    return w;
}

// The balls of overlapping contacts become active.
CAROM_INLINE void activate(Work& w) {
    for (int c = 0; c < w.count; ++c) {
        const int rows[] = {w.i[c], w.j[c]};
        for (const int row : rows) {
            if (w.is_active[row / kRow] != 0) continue;
            w.is_active[row / kRow] = 1;
            w.active[w.actives++] = row;
        }
    }
}

// The active balls at the beginning of a step.
CAROM_INLINE void find_active(Work& w) {
    for (int k = 0; k < w.actives; ++k) {
        const int row = w.active[k];
        w.is_active[row / kRow] = 0;
        w.y[row + kLift] = w.y[row + kNext] = 0.0;
        copy_row(w.y_stage + row, w.y + row);
    }
    w.actives = 0;
    activate(w);
}

// Moves the ball of row n, an index into Work::y, by its v_x and v_y times a duration.
CAROM_INLINE void add_displacement(const Work& w, int n, const Four& distance) {
    store(w.moved + n / 2, load<4>(w.moved + n / 2) + distance);
}

// The difference of the velocities of the balls of four contacts, x in [0] and y in [2].
CAROM_INLINE void closing(const Work& w, const double* y, int c, Four (&dv)[4]) {
    for (int lane = 0; lane < 4; ++lane) dv[lane] = load<4>(y + w.i[c + lane]) - load<4>(y + w.j[c + lane]);
    transpose(dv[0], dv[1], dv[2], dv[3]);
}

// d' = (v_i - v_j) . n of the near contacts from `first`, with normals that have turned for `time`.
CAROM_INLINE void rates(const Work& w, const double* y, double time, int first, double* rate) {
    for (int c = first; c < w.near; c += 4) {
        Four dv[4];
        closing(w, y, c, dv);
        const Four angle = time * load<4>(w.turn + c), nx = load<4>(w.nx + c), ny = load<4>(w.ny + c);
        store(rate + c, dv[0] * (nx - angle * ny) + dv[2] * (ny + angle * nx));
    }
}

// The speed at which the normal n of a contact turns. z = x_j - x_i = (2 R - d) n moves by -(v_i - v_j):
// n' = -(v_i - v_j) . t / (2 R - d) t, t = (-n_y, n_x).
CAROM_INLINE Four turning(const Work& w, int c, const Four (&dv)[4], const Four& nx, const Four& ny,
                          const Four& d) {
    return load<4>(w.bend + c) * (dv[0] * ny - dv[2] * nx) / (broadcast<4>(1.0) - w.curvature * d);
}

// Rates and turning of a state that is not the result of a step.
CAROM_INLINE void update_rates(Work& w) {
    for (int c = 0; c < w.lanes; c += 4) {
        Four dv[4];
        closing(w, w.y, c, dv);
        const Four nx = load<4>(w.nx + c), ny = load<4>(w.ny + c);
        store(w.turn + c, turning(w, c, dv, nx, ny, load<4>(w.d + c)));
        store(w.rate[0] + c, dv[0] * nx + dv[2] * ny);
    }
}

// Updates the contacts after a step of length h, whose state is already computed: overlaps and their maxima,
// normals, their turning, and the rates into rate[0]. The normals, and the gaps of contacts that are not
// watched, move by the mean of the speeds at both ends.
CAROM_INLINE void advance(Work& w, const RungeKutta& method, double h) {
    const Four zero = broadcast<4>(0.0), one = broadcast<4>(1.0), none = broadcast<4>(kNoMemory);
    const double w0 = h * method.weight[0], w1 = h * method.weight[1], w2 = h * method.weight[2],
                 w3 = h * method.weight[3];
    for (int c = 0; c < w.lanes; c += 4) {
        const Four rate = load<4>(w.rate[0] + c), before = load<4>(w.d + c);
        const Four first = w0 * rate + w1 * load<4>(w.rate[1] + c),
                   last = w2 * load<4>(w.rate[2] + c) + w3 * load<4>(w.rate[3] + c);
        Four dv[4];
        closing(w, w.y, c, dv);
        const Four nx = load<4>(w.nx + c), ny = load<4>(w.ny + c), turn_before = load<4>(w.turn + c);
        const Four straight = h * turn_before, x = nx - straight * ny, y = ny + straight * nx;
        // The rate at the end, for the normal that the stages used.
        const Four now = dv[0] * x + dv[2] * y;
        const Four change = select(zero < load<4>(w.watched + c), first + last, (0.5 * h) * (rate + now));
        const Four d = before + change;
        const Four turn = turning(w, c, dv, x, y, d);
        const Four angle = (0.5 * h) * (turn_before + turn);
        const Four half = 0.5 * (angle * angle), shrink = one - half * (one - 1.5 * half);
        const Four nx_now = (nx - angle * ny) * shrink, ny_now = (ny + angle * nx) * shrink;
        const Four inverse = load<4>(w.inverse + c), one_over_d = one / d;
        store(w.d + c, d);
        store(w.turn + c, turn);
        store(w.nx + c, nx_now);
        store(w.ny + c, ny_now);
        store(w.rate[0] + c, dv[0] * nx_now + dv[2] * ny_now);
        store(w.inverse + c, select(zero < d, smaller(one_over_d, inverse), none));
        // The overlap may have been larger within the step.
        const int turned = bits_less(zero, rate) & bits_less(now, zero) & bits_less(zero, d);
        if (turned == 0) continue;
        double ends[4][4];
        store(ends[0], before);
        store(ends[1], d);
        store(ends[2], h * rate);
        store(ends[3], h * now);
        for (int k = 0; k < 4; ++k) {
            if ((turned >> k & 1) == 0) continue;
            const double most = peak(ends[0][k], ends[1][k], ends[2][k], ends[3][k]);
            if (most > 0.0) w.inverse[c + k] = smallest(w.inverse[c + k], 1.0 / most);
        }
    }
}

}  // namespace
}  // namespace carom::kernel
