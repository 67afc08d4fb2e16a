// The contact phase, four contacts at a time. Built once per instruction set.
//
// An evaluation of the right-hand side gathers the motions of the balls of four contacts, computes their forces in
// lanes, and adds the forces to the balls, one contact after the other in the order of the list. A lane computes what
// a scalar program would compute, and every sum has one written order. Only contacts that overlap at that stage take
// part. Memory is laid out for whole registers: the velocity and the horizontal spin of a ball are one row of four
// numbers.
#include "carom/kernel/contact_phase.h"
#include "contact_phase/flight.h"
#include "contact_phase/law.h"
#include "contact_phase/state.h"
#include "kernel_set.h"
#include "numbers.h"
#include "simd.h"

namespace carom::kernel {
namespace {

// HertzLaw in lanes. kFalls: the friction between balls depends on the slip.
template <bool kFalls>
struct Law {
    Four a, b, minus_mu_b, mu_s, epsilon2, cloth_sign;
    Four minus_mu_b_more, fall;
    int p;
    bool cloth, friction;
};

// Brings the list of contacts up to date.
CAROM_INLINE void list_overlaps(Work& w, const double* d) {
    int change = 0;
    for (int block = 0; block < w.lanes / 4; ++block) {
        const int bits = bits_less(broadcast<4>(0.0), load<4>(d + 4 * block));
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
    }
}

// Adds the forces of four contacts of the list to the slopes of their balls.
template <bool kFalls>
CAROM_INLINE void add_forces(const Work& w, const Law<kFalls>& law, const double* y, const double* d,
                             const double* n_x, const double* n_y, int first, double* dy) {
    const int *c = w.active + first, *i = w.active_i + first, *j = w.active_j + first;
    const Four nx = pack(n_x[c[0]], n_x[c[1]], n_x[c[2]], n_x[c[3]]);
    const Four ny = pack(n_y[c[0]], n_y[c[1]], n_y[c[2]], n_y[c[3]]);
    Four motion[4];
    for (int lane = 0; lane < 4; ++lane)
        motion[lane] = subtract_add(load<4>(y + i[lane]), load<4>(y + j[lane]));
    transpose(motion[0], motion[1], motion[2], motion[3]);
    const double* turn = y + kTurn;
    const Four turning = pack(turn[i[0]] + turn[j[0]], turn[i[1]] + turn[j[1]], turn[i[2]] + turn[j[2]],
                              turn[i[3]] + turn[j[3]]);
    const Four overlap = pack(d[c[0]], d[c[1]], d[c[2]], d[c[3]]);
    const Four memory = pack(w.memory[c[0]], w.memory[c[1]], w.memory[c[2]], w.memory[c[3]]);
    const Four F = normal_force(law.a, law.b, law.p, overlap, memory);
    // t = n x z = (n_y, -n_x); s_x = (v_i - v_j) . t - R (w_iz + w_jz), s_z = R (w_i + w_j) . t.
    const Four s_x = motion[0] * ny - motion[2] * nx - turning;
    const Four s_z = motion[1] * ny - motion[3] * nx;
    const Four slip = square_root(s_x * s_x + s_z * s_z + law.epsilon2);
    Four minus_mu_b = law.minus_mu_b;
    if (kFalls) minus_mu_b = minus_mu_b + law.minus_mu_b_more * falling_exponential(law.fall * slip);
    const Four k = minus_mu_b * F / slip;
    const Four f_x = k * s_x, f_z = k * s_z;
    const Four twist = 2.5 * f_z;
    Four rows[4] = {f_x * ny - F * nx, twist * ny, -F * ny - f_x * nx, -twist * nx};
    Four ends[4] = {f_z, -2.5 * f_x, broadcast<4>(0.0), k};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    transpose(ends[0], ends[1], ends[2], ends[3]);
    for (int lane = 0; lane < 4; ++lane) {
        double *dy_i = dy + i[lane], *dy_j = dy + j[lane];
        store(dy_i, load<4>(dy_i) + rows[lane]);
        store(dy_i + 4, load<4>(dy_i + 4) + ends[lane]);
        store(dy_j, subtract_add(load<4>(dy_j), rows[lane]));
        store(dy_j + 4, subtract_add(load<4>(dy_j + 4), ends[lane]));
    }
}

// Adds the friction of the cloth under the balls that are pressed down.
template <bool kFalls>
CAROM_INLINE void add_cloth(const Work& w, const Law<kFalls>& law, const double* y, double* dy) {
    const Four zero = broadcast<4>(0.0);
    for (int b = 0; b < kRow * w.rows; b += 4 * kRow) {
        const double* vertical = dy + b + kLift;
        const Four lift = pack(vertical[0], vertical[kRow], vertical[2 * kRow], vertical[3 * kRow]);
        if (bits_less(lift, zero) == 0) continue;
        Four motion[4];
        for (int lane = 0; lane < 4; ++lane) motion[lane] = load<4>(y + b + kRow * lane);
        transpose(motion[0], motion[1], motion[2], motion[3]);
        const Four ux = motion[0] + law.cloth_sign * motion[3], uy = motion[2] - law.cloth_sign * motion[1];
        const Four pressed = law.mu_s * select(lift < zero, lift, zero);
        const Four k = pressed / square_root(ux * ux + uy * uy + law.epsilon2);
        double stiffness[4];
        store(stiffness, k);
        Four rows[4] = {k * ux, 2.5 * k * uy, k * uy, -2.5 * k * ux};
        transpose(rows[0], rows[1], rows[2], rows[3]);
        for (int lane = 0; lane < 4; ++lane) {
            double* row = dy + b + kRow * lane;
            store(row, load<4>(row) + rows[lane]);
            row[kStiffness] += stiffness[lane];
        }
    }
}

// Adds the right-hand side to dy, in units of V and L: forces are d^1.5, masses 1.
template <bool kFalls>
CAROM_INLINE void forces(Work& w, const Law<kFalls>& law, const double* y, const double* d, const double* nx,
                         const double* ny, double* dy) {
    list_overlaps(w, d);
    for (int n = 0; n < w.count; n += 4) add_forces(w, law, y, d, nx, ny, n, dy);
    if (law.cloth) add_cloth(w, law, y, dy);
}

// to = from + share * slope; `count` is a multiple of kRow.
CAROM_INLINE void shift(double* to, const double* from, const double* slope, double share, int count) {
    for (int n = 0; n < count; n += kRow) {
        for (int half = n; half < n + kRow; half += 4)
            store(to + half, load<4>(from + half) + share * load<4>(slope + half));
    }
}

// The largest difference of a velocity or spin from the midpoint rule.
CAROM_INLINE double difference(double* const* slope, double h, int count) {
    const Four turn_only = pack(0.0, 1.0, 0.0, 0.0);
    Four most = broadcast<4>(0.0);
    const auto take = [&](const Four& difference) {
        const Four size = absolute(difference);
        most = select(most < size, size, most);
    };
    const auto at = [&](int n) {
        return (load<4>(slope[0] + n) + load<4>(slope[3] + n)) - 2.0 * load<4>(slope[2] + n);
    };
    for (int n = 0; n < count; n += kRow) {
        take(at(n));
        take(turn_only * at(n + 4));
    }
    double each[4];
    store(each, most);
    return h / 6.0 * largest(largest(each[0], each[1]), largest(each[2], each[3]));
}

// The end of a step. kClear sets the slopes to zero, because forces() adds to them.
template <bool kClear>
CAROM_INLINE void combine(double* y, double* const* slope, const double (&share)[kStages], int count) {
    double *k0 = slope[0], *k1 = slope[1], *k2 = slope[2], *k3 = slope[3];
    for (int n = 0; n < count; n += kRow) {
        for (int half = n; half < n + kRow; half += 4) {
            const Four first = share[0] * load<4>(k0 + half) + share[1] * load<4>(k1 + half),
                       last = share[2] * load<4>(k2 + half) + share[3] * load<4>(k3 + half);
            store(y + half, load<4>(y + half) + (first + last));
            if (!kClear) continue;
            store(k0 + half, broadcast<4>(0.0));
            store(k1 + half, broadcast<4>(0.0));
            store(k2 + half, broadcast<4>(0.0));
            store(k3 + half, broadcast<4>(0.0));
        }
    }
}

// The longest stable step, at most `longest`.
CAROM_INLINE double stable_step(const Work& w, const double* dy, double longest) {
    double least = 0.0;
    for (int n = 0; n < w.count; ++n)
        least = smallest(least, dy[w.active_i[n] + kStiffness] + dy[w.active_j[n] + kStiffness]);
    return kStableShare < longest * -least ? kStableShare / -least : longest;
}

// One Runge-Kutta step; returns its length. At entry rate[0] belongs to the state; at exit d_stage is the overlap
// before the step. `longest` is its limit; the error, which friction makes, sets that of the next step into `next`.
template <bool kFalls>
CAROM_INLINE double step(Work& w, const Law<kFalls>& law, double shortest, double longest, double& next) {
    const RungeKutta& method = law.friction ? kStabilised : kClassical;
    const int count = kRow * w.rows;
    forces(w, law, w.y, w.d, w.nx, w.ny, w.dy[0]);
    double h = stable_step(w, w.dy[0], smallest(longest, next));
    for (;;) {
        for (int k = 1; k < kStages; ++k) {
            const double time = h * method.node[k];
            shift(w.y_stage, w.y, w.dy[k - 1], time, count);
            shift(w.d_stage, w.d, w.rate[k - 1], time, w.lanes);
            rates(w, w.y_stage, time, w.rate[k]);
            forces(w, law, w.y_stage, w.d_stage, w.nx_stage, w.ny_stage, w.dy[k]);
        }
        if (!law.friction) break;
        const double error = difference(w.dy, h, count);
        next = step_after(next, h, error);
        if (!(error > kStepError && h > shortest)) break;
        h *= 0.5;
        for (int k = 1; k < kStages; ++k) {
            for (int n = 0; n < count; n += 4) store(w.dy[k] + n, broadcast<4>(0.0));
        }
    }
    double weight[kStages];
    for (int k = 0; k < kStages; ++k) weight[k] = h * method.weight[k];
    for (int c = 0; c < w.lanes; c += 4) store(w.d_stage + c, load<4>(w.d + c));
    combine<true>(w.y, w.dy, weight, count);
    combine<false>(w.d, w.rate, weight, w.lanes);
    return h;
}

// Updates the largest overlap of each contact. `before` holds the rates before the step, `now` those after it.
CAROM_INLINE void remember(const Work& w, const double* before, const double* now, double h) {
    const Four zero = broadcast<4>(0.0);
    for (int c = 0; c < w.lanes; c += 4) {
        const Four d = load<4>(w.d + c), memory = load<4>(w.memory + c);
        const Four most = select(zero < d, select(memory < d, d, memory), zero);
        store(w.memory + c, most);
        const int turned =
            bits_less(zero, load<4>(before + c)) & bits_less(load<4>(now + c), zero) & bits_less(zero, d);
        if (turned == 0) continue;
        for (int k = c; k < c + 4; ++k) {
            if ((turned >> (k - c) & 1) != 0)
                w.memory[k] = largest(w.memory[k], peak(w.d_stage[k], w.d[k], h * before[k], h * now[k]));
        }
    }
}

template <bool kFalls>
long integrate(const ContactPhase& phase, const HertzLaw& law, double longest_step, double look_ahead,
               double time_limit) {
    Work w = lay_out(phase);
    const Law<kFalls> lanes{broadcast<4>(law.a),
                            broadcast<4>(law.b),
                            broadcast<4>(-law.mu_b),
                            broadcast<4>(law.mu_s),
                            broadcast<4>(law.epsilon * law.epsilon),
                            broadcast<4>(law.published_slip_sign ? 1.0 : -1.0),
                            broadcast<4>(-law.mu_b_more),
                            broadcast<4>(law.mu_b_fall),
                            law.p,
                            law.mu_s > 0.0,
                            has_friction(law)};
    look(w);
    long steps = 0;
    double next = longest_step;
    double time = 0.0;
    for (;;) {
        if (!(time < time_limit)) return -1;
        const double longest = w.shares ? settle(phase, w, longest_step) : longest_step;
        const double h = step(w, lanes, kShortest * longest_step, longest, next);
        ++steps;
        time += h;
        turn_normals(w, h, w.rate[1], w.rate[2]);
        remember(w, w.rate[0], w.rate[1], h);
        for (int c = 0; c < w.lanes; c += 4) store(w.rate[0] + c, load<4>(w.rate[2] + c));
        if (any_overlap(w)) continue;
        const double flight = next_touch(w);
        if (!(flight < look_ahead)) break;
        fly(phase, w, flight, look_ahead);
        time += flight;
    }
    for (int b = 0; b < w.balls; ++b) {
        for (int k = 0; k < kPerBall; ++k) phase.motion[kPerBall * b + k] = w.y[kRow * b + kPlace[k]];
    }
    return steps;
}

}  // namespace

namespace CAROM_ISA_NAMESPACE {

long contact_phase(const ContactPhase& phase, const HertzLaw& law, double longest_step, double look_ahead,
                   double time_limit) noexcept {
    return law.mu_b_more > 0.0 ? integrate<true>(phase, law, longest_step, look_ahead, time_limit)
                               : integrate<false>(phase, law, longest_step, look_ahead, time_limit);
}

}  // namespace CAROM_ISA_NAMESPACE

}  // namespace carom::kernel
