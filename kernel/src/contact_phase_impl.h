// The contact phase, four contacts at a time. Built once per instruction set; CAROM_CONTACT_PHASE_NAME is the
// name of the function.
//
// An evaluation of the right-hand side gathers the motions of the balls of four contacts, computes their forces
// in lanes, and adds these to the balls one contact after the other in the order of the list: a lane computes
// what a scalar program would, and every sum has one written order. Only contacts that overlap at that stage
// take part. Memory is laid out for whole registers: the velocity and the horizontal spin of a ball are one row
// of four, the vertical spins stand behind the rows.
#pragma once

#include "carom/kernel/contact_phase.h"
#include "tolerance_lanes.h"

namespace carom::kernel {
namespace {

typedef double V2 __attribute__((vector_size(16)));

constexpr int kPerBall = 5;  // of ContactPhase::motion
constexpr int kStages = 4;

CAROM_INLINE int padded(int n) {
    return (n + 3) / 4 * 4;
}

CAROM_INLINE V2 load2(const double* from) {
    V2 v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

CAROM_INLINE void store2(double* to, V2 v) {
    __builtin_memcpy(to, &v, sizeof v);
}

CAROM_INLINE bool any_below_zero(V4 x) {
#if defined(__AVX__)
    return _mm256_movemask_pd((__m256d)(x < 0.0)) != 0;
#else
    return x[0] < 0.0 || x[1] < 0.0 || x[2] < 0.0 || x[3] < 0.0;
#endif
}

// Rows to columns; its own inverse.
CAROM_INLINE void transpose(V4& a, V4& b, V4& c, V4& d) {
    const V4 ab_lo = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_hi = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const V4 cd_lo = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_hi = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    a = __builtin_shufflevector(ab_lo, cd_lo, 0, 1, 4, 5);
    b = __builtin_shufflevector(ab_hi, cd_hi, 0, 1, 4, 5);
    c = __builtin_shufflevector(ab_lo, cd_lo, 2, 3, 6, 7);
    d = __builtin_shufflevector(ab_hi, cd_hi, 2, 3, 6, 7);
}

// (a0 - b0, a1 + b1, a2 - b2, a3 + b3): in a contact the velocities of the second ball count against those of the
// first, and its spins with them. Rows have velocities in the even places and spins in the odd ones.
CAROM_INLINE V4 subtract_add(V4 a, V4 b) {
#if defined(__AVX__)
    return (V4)_mm256_addsub_pd((__m256d)a, (__m256d)b);
#else
    return V4{a[0] - b[0], a[1] + b[1], a[2] - b[2], a[3] + b[3]};
#endif
}

constexpr int kRow = 8;
constexpr int kPlace[kPerBall] = {0, 2, 1, 3, 5};  // of v_x, v_y, R w_x, R w_y, R w_z in a row
constexpr int kLift = 4, kTurn = 5, kStiffness = 7;

struct Work {
    int balls, contacts;
    int rows, lanes;  // sizes of the arrays per ball and per contact
    // Per ball a row (v_x, R w_x, v_y, R w_y | -, R w_z, -, -): the state, its stages and their slopes. In a slope
    // the fifth number is the sum of the vertical forces, the eighth minus the sum of friction over slip.
    double *y, *y_stage, *dy[kStages];
    // Per contact.
    double *d, *d_stage, *rate[kStages], *nx, *ny, *memory;
    int *i, *j;  // places of the rows of the two balls
    // The contacts that overlap, in their order: place, rows, normal.
    int *active, *active_i, *active_j;
    double *active_nx, *active_ny;
    int* overlaps;  // per four contacts, a bit each: the state that the list is for
    int count;      // of the list, padded
};

// HertzLaw, ready for use in lanes.
struct Law {
    V4 a, b, minus_mu_b, mu_s, epsilon2, cloth_sign;
    int p;
    bool cloth;
};

CAROM_INLINE double* take(double*& from, int count) {
    double* taken = from;
    from += count;
    for (int n = 0; n < count; ++n) taken[n] = 0.0;
    return taken;
}

// One ball more than there are, at rest, stands for both balls of the lanes that fill up the last register.
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
    w.d = take(next, w.lanes);
    w.d_stage = take(next, w.lanes);
    for (double*& rate : w.rate) rate = take(next, w.lanes);
    w.nx = take(next, w.lanes);
    w.ny = take(next, w.lanes);
    w.memory = take(next, w.lanes);
    w.active_nx = take(next, w.lanes);
    w.active_ny = take(next, w.lanes);
    w.i = phase.places;
    w.j = w.i + w.lanes;
    w.active = w.j + w.lanes;
    w.active_i = w.active + w.lanes;
    w.active_j = w.active_i + w.lanes;
    w.overlaps = w.active_j + w.lanes;
    for (int block = 0; block < w.lanes / 4; ++block) w.overlaps[block] = 0;
    w.count = 0;
    for (int b = 0; b < w.balls; ++b) {
        for (int k = 0; k < kPerBall; ++k) w.y[kRow * b + kPlace[k]] = phase.motion[kPerBall * b + k];
    }
    for (int c = 0; c < w.lanes; ++c) {
        const bool real = c < w.contacts;
        w.i[c] = kRow * (real ? phase.contact[c].i : w.balls);
        w.j[c] = kRow * (real ? phase.contact[c].j : w.balls);
        if (!real) continue;
        w.nx[c] = phase.contact[c].nx;
        w.ny[c] = phase.contact[c].ny;
        w.d[c] = phase.contact[c].overlap;
    }
    return w;
}

// d' = (v_i - v_j) . n of all contacts.
CAROM_INLINE void rates(const Work& w, const double* y, double* rate) {
    for (int c = 0; c < w.lanes; c += 4) {
        V4 dv[4];
        for (int lane = 0; lane < 4; ++lane) dv[lane] = load4(y + w.i[c + lane]) - load4(y + w.j[c + lane]);
        transpose(dv[0], dv[1], dv[2], dv[3]);
        store4(rate + c, dv[0] * load4(w.nx + c) + dv[2] * load4(w.ny + c));
    }
}

CAROM_INLINE V4 normal_force(const Law& law, V4 d, V4 memory) {
    const V4 loading = d * square_root(d);
    V4 share = d / memory;  // not used where memory is 0
    for (int p = law.p; p > 1; p /= 2) share = share * share;
    return d < memory ? loading * (law.a + law.b * share) : loading;
}

// Bits of the lanes that are above 0.
CAROM_INLINE int above_zero(V4 x) {
#if defined(__AVX__)
    return _mm256_movemask_pd(_mm256_cmp_pd((__m256d)x, _mm256_setzero_pd(), _CMP_GT_OQ));
#else
    return (x[0] > 0.0 ? 1 : 0) | (x[1] > 0.0 ? 2 : 0) | (x[2] > 0.0 ? 4 : 0) | (x[3] > 0.0 ? 8 : 0);
#endif
}

CAROM_INLINE void list_overlaps(Work& w, const double* d) {
    int change = 0;
    for (int block = 0; block < w.lanes / 4; ++block) {
        const int bits = above_zero(load4(d + 4 * block));
        change |= bits ^ w.overlaps[block];
        w.overlaps[block] = bits;
    }
    if (change == 0) return;
    int count = 0;
    for (int c = 0; c < w.contacts; ++c) {
        if ((w.overlaps[c / 4] >> (c % 4) & 1) != 0) w.active[count++] = c;
    }
    for (; count % 4 != 0; ++count) w.active[count] = w.contacts;
    w.count = count;
    for (int n = 0; n < count; ++n) {
        const int c = w.active[n];
        w.active_i[n] = w.i[c];
        w.active_j[n] = w.j[c];
        w.active_nx[n] = w.nx[c];
        w.active_ny[n] = w.ny[c];
    }
}

// Adds the forces of four contacts of the list to the slopes of their balls.
CAROM_INLINE void add_forces(const Work& w, const Law& law, const double* y, const double* d, int first,
                             double* dy) {
    const int *c = w.active + first, *i = w.active_i + first, *j = w.active_j + first;
    const V4 nx = load4(w.active_nx + first), ny = load4(w.active_ny + first);
    V4 motion[4];
    for (int lane = 0; lane < 4; ++lane) motion[lane] = subtract_add(load4(y + i[lane]), load4(y + j[lane]));
    transpose(motion[0], motion[1], motion[2], motion[3]);
    const double* turn = y + kTurn;
    const V4 turning{turn[i[0]] + turn[j[0]], turn[i[1]] + turn[j[1]], turn[i[2]] + turn[j[2]],
                     turn[i[3]] + turn[j[3]]};
    const V4 overlap{d[c[0]], d[c[1]], d[c[2]], d[c[3]]};
    const V4 memory{w.memory[c[0]], w.memory[c[1]], w.memory[c[2]], w.memory[c[3]]};
    const V4 F = normal_force(law, overlap, memory);
    // t = n x z = (n_y, -n_x); s_x = (v_i - v_j) . t - R (w_iz + w_jz), s_z = R (w_i + w_j) . t.
    const V4 s_x = motion[0] * ny - motion[2] * nx - turning;
    const V4 s_z = motion[1] * ny - motion[3] * nx;
    const V4 k = law.minus_mu_b * F / square_root(s_x * s_x + s_z * s_z + law.epsilon2);
    const V4 f_x = k * s_x, f_z = k * s_z;
    const V4 twist = 2.5 * f_z;
    V4 rows[4] = {f_x * ny - F * nx, twist * ny, -F * ny - f_x * nx, -twist * nx};
    V4 ends[4] = {f_z, -2.5 * f_x, all(0.0), k};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    transpose(ends[0], ends[1], ends[2], ends[3]);
    for (int lane = 0; lane < 4; ++lane) {
        double *dy_i = dy + i[lane], *dy_j = dy + j[lane];
        store4(dy_i, load4(dy_i) + rows[lane]);
        store4(dy_i + 4, load4(dy_i + 4) + ends[lane]);
        store4(dy_j, subtract_add(load4(dy_j), rows[lane]));
        store4(dy_j + 4, subtract_add(load4(dy_j + 4), ends[lane]));
    }
}

// The cloth under the balls that are pressed down.
CAROM_INLINE void add_cloth(const Work& w, const Law& law, const double* y, double* dy) {
    const V4 zero = all(0.0);
    for (int b = 0; b < kRow * w.rows; b += 4 * kRow) {
        const double* vertical = dy + b + kLift;
        const V4 lift{vertical[0], vertical[kRow], vertical[2 * kRow], vertical[3 * kRow]};
        if (!any_below_zero(lift)) continue;
        V4 motion[4];
        for (int lane = 0; lane < 4; ++lane) motion[lane] = load4(y + b + kRow * lane);
        transpose(motion[0], motion[1], motion[2], motion[3]);
        const V4 ux = motion[0] + law.cloth_sign * motion[3], uy = motion[2] - law.cloth_sign * motion[1];
        const V4 pressed = lift < 0.0 ? law.mu_s * lift : zero;
        const V4 k = pressed / square_root(ux * ux + uy * uy + law.epsilon2);
        V4 rows[4] = {k * ux, 2.5 * k * uy, k * uy, -2.5 * k * ux};
        transpose(rows[0], rows[1], rows[2], rows[3]);
        for (int lane = 0; lane < 4; ++lane) {
            double* row = dy + b + kRow * lane;
            store4(row, load4(row) + rows[lane]);
            row[kStiffness] += 0.5 * k[lane];
        }
    }
}

// The right-hand side, in units of V and L: forces d^1.5, mass 1. Added to dy.
CAROM_INLINE void forces(Work& w, const Law& law, const double* y, const double* d, double* dy) {
    list_overlaps(w, d);
    for (int n = 0; n < w.count; n += 4) add_forces(w, law, y, d, n, dy);
    if (law.cloth) add_cloth(w, law, y, dy);
}

// Rows of eight, a number of a multiple of eight.
CAROM_INLINE void shift(double* to, const double* from, const double* slope, double share, int count) {
    for (int n = 0; n < count; n += kRow) {
        for (int half = n; half < n + kRow; half += 4)
            store4(to + half, load4(from + half) + share * load4(slope + half));
    }
}

// The end of a step. The slopes that forces are added to are left at 0 for the next.
template <bool kClear>
CAROM_INLINE void combine(double* y, double* const* slope, double sixth, int count) {
    double *k0 = slope[0], *k1 = slope[1], *k2 = slope[2], *k3 = slope[3];
    for (int n = 0; n < count; n += kRow) {
        for (int half = n; half < n + kRow; half += 4) {
            const V4 outer = load4(k0 + half) + load4(k3 + half), inner = load4(k1 + half) + load4(k2 + half);
            store4(y + half, load4(y + half) + sixth * (outer + 2.0 * inner));
            if (!kClear) continue;
            store4(k0 + half, all(0.0));
            store4(k1 + half, all(0.0));
            store4(k2 + half, all(0.0));
            store4(k3 + half, all(0.0));
        }
    }
}

// The regularised friction is stiff: friction over slip, k, of one contact makes its slip decay at the rate 7 k,
// and by Gershgorin no rate of all contacts together exceeds 7 times the largest sum of k over a ball (the cloth
// under it counts half). Runge-Kutta steps are stable up to 2.78 over that.
constexpr double kStableShare = 2.0 / 7.0;

CAROM_INLINE double stable_step(const Work& w, const double* dy, double longest) {
    double least = 0.0;
    for (int b = 0; b < w.balls; ++b) least = smallest(least, dy[kRow * b + kStiffness]);
    return kStableShare < longest * -least ? kStableShare / -least : longest;
}

// rate[0] belongs to the state at entry; d_stage is the overlap before the step at exit. Returns its length.
CAROM_INLINE double step(Work& w, const Law& law, double longest) {
    forces(w, law, w.y, w.d, w.dy[0]);
    const double h = stable_step(w, w.dy[0], longest);
    const double share[kStages] = {0.0, 0.5 * h, 0.5 * h, h};
    for (int k = 1; k < kStages; ++k) {
        shift(w.y_stage, w.y, w.dy[k - 1], share[k], kRow * w.rows);
        shift(w.d_stage, w.d, w.rate[k - 1], share[k], w.lanes);
        rates(w, w.y_stage, w.rate[k]);
        forces(w, law, w.y_stage, w.d_stage, w.dy[k]);
    }
    for (int c = 0; c < w.lanes; c += 4) store4(w.d_stage + c, load4(w.d + c));
    combine<true>(w.y, w.dy, h / 6.0, kRow * w.rows);
    combine<false>(w.d, w.rate, h / 6.0, w.lanes);
    return h;
}

// The largest overlap inside a step in which a contact turned back, from the cubic Hermite interpolant: without
// it the energy of each contact carries an error of order h^2.
CAROM_INLINE V4 peak(V4 before, V4 after, V4 m0, V4 m1, V4 most) {
    // d(s) = d0 + m0 s + (3 rise - 2 m0 - m1) s^2 + (m0 + m1 - 2 rise) s^3; its slope falls from m0 > 0 to m1 < 0.
    const V4 rise = after - before, q2 = 3.0 * rise - 2.0 * m0 - m1, q3 = m0 + m1 - 2.0 * rise;
    const V4 inside = q2 * q2 - 3.0 * q3 * m0, zero = all(0.0);
    const V4 s = m0 / (square_root(inside > 0.0 ? inside : zero) - q2);
    const V4 at = before + s * (m0 + s * (q2 + s * q3));
    return (s > 0.0) & (s < 1.0) & (at > most) ? at : most;
}

// Largest overlap since a contact opened. `before` holds the rates before the step, `now` those after it.
CAROM_INLINE void remember(const Work& w, const double* before, const double* now, double h) {
    const V4 zero = all(0.0);
    for (int c = 0; c < w.lanes; c += 4) {
        const V4 d = load4(w.d + c), memory = load4(w.memory + c), m0 = load4(before + c), m1 = load4(now + c);
        V4 most = memory < d ? d : memory;
        const V4 turned = (m0 > 0.0) & (m1 < 0.0) & (d > 0.0) ? all(-1.0) : zero;
        if (any_below_zero(turned)) most = turned < 0.0 ? peak(load4(w.d_stage + c), d, h * m0, h * m1, most) : most;
        most = d > 0.0 ? most : zero;
        store4(w.memory + c, most);
    }
}

CAROM_INLINE bool finished(const Work& w, const double* rate, double look_ahead) {
    for (int c = 0; c < w.contacts; ++c) {
        if (w.d[c] > 0.0) return false;
        if (rate[c] > 0.0 && -w.d[c] < look_ahead * rate[c]) return false;
    }
    return true;
}

}  // namespace

long CAROM_CONTACT_PHASE_NAME(const ContactPhase& phase, const HertzLaw& law, double longest_step,
                              double look_ahead, double time_limit) noexcept {
    Work w = lay_out(phase);
    const Law lanes{all(law.a), all(law.b), all(-law.mu_b), all(law.mu_s), all(law.epsilon * law.epsilon),
                    all(law.published_slip_sign ? 1.0 : -1.0), law.p, law.mu_s > 0.0};
    rates(w, w.y, w.rate[0]);
    long steps = 0;
    double time = 0.0;
    for (bool open = false; !open;) {
        if (!(time < time_limit)) return -1;
        const double h = step(w, lanes, longest_step);
        ++steps;
        time += h;
        rates(w, w.y, w.rate[1]);
        remember(w, w.rate[0], w.rate[1], h);
        for (int c = 0; c < w.lanes; c += 4) store4(w.rate[0] + c, load4(w.rate[1] + c));
        open = finished(w, w.rate[0], look_ahead);
    }
    for (int b = 0; b < w.balls; ++b) {
        for (int k = 0; k < kPerBall; ++k) phase.motion[kPerBall * b + k] = w.y[kRow * b + kPlace[k]];
    }
    return steps;
}

}  // namespace carom::kernel
