// The contact phase, four contacts at a time. Built once per instruction set.
//
// An evaluation of the right-hand side gathers the motions of the balls of four contacts, computes their forces in
// lanes, and adds the forces to the balls, one contact after the other in the order of their numbers. A lane computes what
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

// Puts the contacts that overlap in front of the others.
void reorder(Work& w, const double* d) {
    int open = w.count, closed = 0, overlapping = 0, others = 0;
    while (closed < w.count || open < w.contacts) {
        const bool first = open == w.contacts || (closed < w.count && w.id[closed] < w.id[open]);
        const int c = first ? closed++ : open++;
        if (d[c] > 0.0)
            w.order[overlapping++] = c;
        else
            w.spare[others++] = c;
    }
    w.count = overlapping;
    for (int n = 0; n < others; ++n) w.order[overlapping + n] = w.spare[n];
    const auto move = [&w](auto* numbers, auto* moved) {
        for (int n = 0; n < w.contacts; ++n) moved[n] = numbers[w.order[n]];
        for (int n = 0; n < w.contacts; ++n) numbers[n] = moved[n];
    };
    double* const arrays[] = {w.d,      w.d_stage, w.rate[0], w.rate[1], w.rate[2], w.rate[3],
                              w.memory, w.nx,      w.ny,      w.turn,    w.bend,    w.share};
    for (double* array : arrays) move(array, w.moved);
    int* const places[] = {w.i, w.j, w.id};
    for (int* array : places) move(array, w.spare);
}

// Whether other contacts overlap than those that come first.
CAROM_INLINE bool out_of_order(const Work& w, const double* d) {
    int change = 0;
    for (int c = 0; c < w.lanes; c += 4) {
        const int overlapping = w.count - c < 0 ? 0 : w.count - c > 3 ? 15 : (1 << (w.count - c)) - 1;
        change |= overlapping ^ bits_less(broadcast<4>(0.0), load<4>(d + c));
    }
    return change != 0;
}

// Adds the forces of four contacts to the slopes of their balls. At a stage the normals have turned for `time`, and
// `rate` gets the rates of the overlaps.
template <bool kFalls, bool kStage>
CAROM_INLINE void add_forces(const Work& w, const Law<kFalls>& law, const double* y, const double* d,
                             double time, int first, double* dy, double* rate) {
    const int *i = w.i + first, *j = w.j + first;
    Four nx = load<4>(w.nx + first), ny = load<4>(w.ny + first);
    Four motion[4];
    for (int lane = 0; lane < 4; ++lane)
        motion[lane] = subtract_add(load<4>(y + i[lane]), load<4>(y + j[lane]));
    transpose(motion[0], motion[1], motion[2], motion[3]);
    if (kStage) {
        const Four angle = time * load<4>(w.turn + first), x = nx - angle * ny;
        ny = ny + angle * nx;
        nx = x;
        store(rate + first, motion[0] * nx + motion[2] * ny);
    }
    const double* turn = y + kTurn;
    const Four turning = pack(turn[i[0]] + turn[j[0]], turn[i[1]] + turn[j[1]], turn[i[2]] + turn[j[2]],
                              turn[i[3]] + turn[j[3]]);
    const Four overlap = load<4>(d + first), none = broadcast<4>(0.0);
    // The last four may hold some that do not overlap.
    const Four F =
        select(none < overlap, normal_force(law.a, law.b, law.p, overlap, load<4>(w.memory + first)), none);
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
    Four ends[4] = {f_z, -2.5 * f_x, none, k};
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

// Adds the right-hand side to dy, in units of V and L: forces are d^1.5, masses 1. At a stage `rate` gets the rates of the overlaps.
template <bool kStage, bool kFalls>
CAROM_INLINE void forces(Work& w, const Law<kFalls>& law, const double* y, const double* d, double time,
                         double* dy, double* rate) {
    if (out_of_order(w, d)) reorder(w, d);
    int c = 0;
    for (; c < w.count; c += 4) add_forces<kFalls, kStage>(w, law, y, d, time, c, dy, rate);
    if (kStage) rates(w, y, time, c, rate);
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
    for (int c = 0; c < w.count; ++c)
        least = smallest(least, dy[w.i[c] + kStiffness] + dy[w.j[c] + kStiffness]);
    return kStableShare < longest * -least ? kStableShare / -least : longest;
}

// One Runge-Kutta step; returns its length. At entry rate[0] belongs to the state; at exit d_stage is the overlap
// before the step. `longest` is its limit; the error, which friction makes, sets that of the next step into `next`.
template <bool kFalls>
CAROM_INLINE double step(Work& w, const Law<kFalls>& law, double shortest, double longest, double& next) {
    const RungeKutta& method = law.friction ? kStabilised : kClassical;
    const int count = kRow * w.rows;
    forces<false>(w, law, w.y, w.d, 0.0, w.dy[0], nullptr);
    double h = stable_step(w, w.dy[0], smallest(longest, next));
    for (;;) {
        for (int k = 1; k < kStages; ++k) {
            const double time = h * method.node[k];
            shift(w.y_stage, w.y, w.dy[k - 1], time, count);
            shift(w.d_stage, w.d, w.rate[k - 1], time, w.lanes);
            forces<true>(w, law, w.y_stage, w.d_stage, time, w.dy[k], w.rate[k]);
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
