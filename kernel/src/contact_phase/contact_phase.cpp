// The contact phase, four contacts at a time. Built once per instruction set.
//
// An evaluation of the right-hand side gathers the motions of the balls of four contacts and computes their
// forces in lanes. Then it adds the forces to the balls, one contact after another in the order of their
// numbers. A lane computes the same as a scalar program, and every sum has a fixed order. Only contacts that
// overlap at that stage take part. Memory is laid out for whole registers: the velocity and the horizontal
// spin of a ball are one row of four numbers.
#include <cstdint>

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

// Whether a contact may close within a time.
CAROM_INLINE bool is_near(const Work& w, int c, double time) {
    return -w.d[c] < time * (largest(w.rate[0][c], 0.0) + time);
}

// Moves overlapping contacts to the front, followed by the near ones. At a stage the distant ones stay
// distant.
template <bool kStage>
void reorder(Work& w, const double* d) {
    int* place = w.places;
    for (int c = 0; c < w.contacts; ++c) place[w.id[c]] = c;
    int overlapping = 0, near = 0, far = w.contacts;
    for (int n = 0; n < w.contacts; ++n) {
        const int c = place[n];
        if (d[c] > 0.0 && (!kStage || c < w.near))
            w.order[overlapping++] = c;
        else if (kStage ? c < w.near : is_near(w, c, w.horizon))
            w.spare[near++] = c;
        else
            w.spare[--far] = c;
    }
    w.count = overlapping;
    w.near = overlapping + near;
    for (int n = 0; n < near; ++n) w.order[overlapping + n] = w.spare[n];
    for (int n = w.near; n < w.contacts; ++n) w.order[n] = w.spare[w.contacts - 1 - (n - w.near)];
    int begin = 0, end = w.contacts;  // range of contacts to be moved
    while (begin < end && w.order[begin] == begin) ++begin;
    while (begin < end && w.order[end - 1] == end - 1) --end;
    const auto move = [&w, begin, end](auto* numbers, auto* moved) {
        for (int n = begin; n < end; ++n) moved[n] = numbers[w.order[n]];
        for (int n = begin; n < end; ++n) numbers[n] = moved[n];
    };
    double* const arrays[] = {w.d,  w.d_stage, w.rate[0], w.rate[1], w.rate[2], w.rate[3], w.inverse,
                              w.nx, w.ny,      w.turn,    w.bend,    w.share,   w.watched};
    for (double* array : arrays) move(array, w.reordered);
    int* const places[] = {w.i, w.j, w.id};
    for (int* array : places) move(array, w.spare);
}

// Whether an overlapping one of the first `lanes` contacts is not at the front.
CAROM_INLINE bool out_of_order(const Work& w, const double* d, int lanes) {
    int first = w.count / 4 * 4, change = -1 << (w.count - first);
    change &= bits_less(broadcast<4>(0.0), load<4>(d + first));
    for (int c = first + 4; c < lanes; c += 4) change |= bits_less(broadcast<4>(0.0), load<4>(d + c));
    return change != 0;
}

// Whether reordering would save a whole register: opening contacts stay at the front without a force.
CAROM_INLINE bool gaps_add_up(const Work& w) {
    Four open = broadcast<4>(0.0);
    for (int c = 0; c < w.count; c += 4)
        open = open + select(broadcast<4>(0.0) < load<4>(w.d + c), broadcast<4>(0.0), broadcast<4>(1.0));
    return sum(open) >= 4.0 + padded(w.count) - w.count;
}

// The forces of four contacts, into w.force. At a stage the normals have turned for `time`, and `rate`
// receives the rates of the overlaps. Separate from add_forces(), so that a processor that looks a few
// hundred instructions ahead computes the roots and divisions of all contacts in parallel.
template <bool kFalls, bool kStage>
CAROM_INLINE void find_forces(const Work& w, const Law<kFalls>& law, const double* y, const double* d,
                              double time, int first, double* rate) {
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
    // The last four may include contacts that do not overlap.
    const Four F =
        select(none < overlap, normal_force(law.a, law.b, law.p, overlap, load<4>(w.inverse + first)), none);
    // t = n x z = (n_y, -n_x); s_x = (v_i - v_j) . t - R (w_iz + w_jz), s_z = R (w_i + w_j) . t.
    const Four s_x = motion[0] * ny - motion[2] * nx - turning;
    const Four s_z = motion[1] * ny - motion[3] * nx;
    const Four slip2 = s_x * s_x + s_z * s_z + law.epsilon2, slip = square_root(slip2);
    Four minus_mu_b = law.minus_mu_b;
    if (kFalls) minus_mu_b = minus_mu_b + law.minus_mu_b_more * falling_exponential(law.fall * slip);
    const Four k = minus_mu_b * F / slip2 * slip;  // the root and the quotient in parallel
    double* force = w.force + kForce * first;
    store(force, nx);
    store(force + 4, ny);
    store(force + 8, F);
    store(force + 12, k * s_x);
    store(force + 16, k * s_z);
    store(force + 20, k);
}

// Adds the forces of four contacts to the slopes of their balls.
CAROM_INLINE void add_forces(const Work& w, int first, double* dy) {
    const int *i = w.i + first, *j = w.j + first;
    const double* force = w.force + kForce * first;
    const Four nx = load<4>(force), ny = load<4>(force + 4), F = load<4>(force + 8),
               f_x = load<4>(force + 12), f_z = load<4>(force + 16), k = load<4>(force + 20);
    const Four twist = 2.5 * f_z;
    Four rows[4] = {f_x * ny - F * nx, twist * ny, -F * ny - f_x * nx, -twist * nx};
    Four ends[4] = {f_z, -2.5 * f_x, f_z, k};
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

// The friction of the cloth between two steps, on the balls that are pressed down. Leapfrog: apply half of
// the last step's load and half of the load predicted at its end for a next step of equal length, so that the
// error is of second order. The part applied in advance (kAhead) is subtracted the next time. The slip u
// decays at the rate 3.5 mu_s N / |u|, by the implicit midpoint rule, which is stable for any step and exact
// while the ball slides. |u| at the midpoint comes from half an implicit step.
template <bool kFalls>
CAROM_INLINE void drag(const Work& w, const Law<kFalls>& law, double* y) {
    const Four zero = broadcast<4>(0.0);
    const auto below_zero = [&zero](const Four& v) { return select(v < zero, v, zero); };
    // The last four may include the additional ball.
    for (int n = 0; n < 3; ++n) w.active[w.actives + n] = kRow * w.balls;
    for (int n = 0; n < w.actives; n += 4) {
        const int* const rows_of = w.active + n;
        Four lift[4];
        for (int lane = 0; lane < 4; ++lane) lift[lane] = load<4>(y + rows_of[lane] + kLift);
        transpose(lift[0], lift[1], lift[2], lift[3]);
        const Four past = below_zero(lift[0]), next = below_zero(lift[2]), ahead = lift[3];
        const Four wanted = (past - ahead) + next;
        if (bits_less((past + next) + ahead, zero) == 0) continue;
        Four motion[4];
        for (int lane = 0; lane < 4; ++lane) motion[lane] = load<4>(y + rows_of[lane]);
        transpose(motion[0], motion[1], motion[2], motion[3]);
        const Four ux = motion[0] + law.cloth_sign * motion[3], uy = motion[2] - law.cloth_sign * motion[1];
        const Four pressed = law.mu_s * below_zero(wanted);
        const Four slip2 = ux * ux + uy * uy, slip = square_root(slip2 + law.epsilon2);
        const Four half = slip / (slip - 1.75 * pressed);
        const Four k = pressed / (square_root(half * half * slip2 + law.epsilon2) - 1.75 * pressed);
        double left[4];
        store(left, select(wanted < zero, next, ahead - past));
        Four rows[4] = {k * ux, 2.5 * k * uy, k * uy, -2.5 * k * ux};
        transpose(rows[0], rows[1], rows[2], rows[3]);
        for (int lane = 0; lane < 4; ++lane) {
            double* row = y + rows_of[lane];
            store(row, load<4>(row) + rows[lane]);
            row[kAhead] = left[lane];
        }
    }
}

// Adds the right-hand side to dy, in units of V and L: forces are d^1.5, masses 1. At a stage `rate` receives
// the rates of the overlaps.
template <bool kStage, bool kFalls>
CAROM_INLINE void forces(Work& w, const Law<kFalls>& law, const double* y, const double* d, double time,
                         double* dy, double* rate) {
    if (out_of_order(w, d, kStage ? w.near : w.lanes) || (!kStage && gaps_add_up(w))) {
        reorder<kStage>(w, d);
        if (kStage) activate(w);
    }
    if (!kStage) find_active(w);
    int c = 0;
    for (; c < w.count; c += 4) find_forces<kFalls, kStage>(w, law, y, d, time, c, rate);
    for (int n = 0; n < w.count; n += 4) add_forces(w, n, dy);
    if (kStage) rates(w, y, time, c, rate);
}

// y_stage = y + share * slope
CAROM_INLINE void shift(const Work& w, const double* slope, double share) {
    for (int k = 0; k < w.actives; ++k) {
        const int n = w.active[k];
        for (int half = n; half < n + kRow; half += 4)
            store(w.y_stage + half, load<4>(w.y + half) + share * load<4>(slope + half));
    }
}

// The same for the overlaps. A contact that is not watched stays open.
CAROM_INLINE void shift_overlaps(const Work& w, const double* rate, double share) {
    const Four none = broadcast<4>(0.0);
    for (int c = 0; c < w.near; c += 4) {
        const Four d = load<4>(w.d + c), watched = load<4>(w.watched + c);
        store(w.d_stage + c, select(none < watched, d + share * load<4>(rate + c), d));
    }
}

CAROM_INLINE void clear(const Work& w, double* slope) {
    for (int k = 0; k < w.actives; ++k) {
        store(slope + w.active[k], broadcast<4>(0.0));
        store(slope + w.active[k] + 4, broadcast<4>(0.0));
    }
}

CAROM_INLINE double largest_lane(const Four& v) {
    double each[4];
    store(each, v);
    return largest(largest(each[0], each[1]), largest(each[2], each[3]));
}

// Computes the state after a step of length h, into y_stage. If kWatched, returns its largest difference from
// the midpoint rule in a velocity or spin. Clears the slopes of the later stages, to which forces() adds.
template <bool kWatched>
CAROM_INLINE double finish(const Work& w, const RungeKutta& method, double h) {
    double *k0 = w.dy[0], *k1 = w.dy[1], *k2 = w.dy[2], *k3 = w.dy[3];
    const double w0 = h * method.weight[0], w1 = h * method.weight[1], w2 = h * method.weight[2],
                 w3 = h * method.weight[3];
    const Four zero = broadcast<4>(0.0), turn_only = pack(0.0, 1.0, 0.0, 0.0),
               kept = pack(0.0, 1.0, 0.0, 1.0);
    // For the second half of a row (Work).
    const Four two = pack(1.0, 1.0, 0.0, 0.0);
    const Four v0 = w0 * two, v1 = w1 * two, v2 = w2 * two, v3 = w3 * two + h * pack(0.0, 0.0, 0.5, 0.0);
    Four most = zero;
    const auto take = [&most](const Four& difference) { most = larger(absolute(difference), most); };
    for (int k = 0; k < w.actives; ++k) {
        const int n = w.active[k];
        const Four a0 = load<4>(k0 + n), a2 = load<4>(k2 + n), a3 = load<4>(k3 + n);
        const Four b0 = load<4>(k0 + n + 4), b2 = load<4>(k2 + n + 4), b3 = load<4>(k3 + n + 4);
        Four first = w0 * a0, second = v0 * b0;
        if (kWatched) {
            take((a0 + a3) - 2.0 * a2);
            take(turn_only * ((b0 + b3) - 2.0 * b2));
        } else {
            first = first + w1 * load<4>(k1 + n);
            second = second + v1 * load<4>(k1 + n + 4);
        }
        store(w.y_stage + n, load<4>(w.y + n) + (first + (w2 * a2 + w3 * a3)));
        store(w.y_stage + n + 4, kept * load<4>(w.y + n + 4) + (second + (v2 * b2 + v3 * b3)));
        for (int half = n; half < n + kRow; half += 4) {
            store(k1 + half, zero);
            store(k2 + half, zero);
            store(k3 + half, zero);
        }
    }
    return h / 6.0 * largest_lane(most);
}

// The largest sum of friction divided by slip, over both balls of a contact that overlaps.
CAROM_INLINE double stiffest(const Work& w, const double* dy) {
    const double* stiffness = dy + kStiffness;
    const Four none = broadcast<4>(0.0);
    Four most = none;
    for (int c = 0; c < w.count; c += 4) {
        const int *i = w.i + c, *j = w.j + c;
        const Four both = pack(stiffness[i[0]] + stiffness[j[0]], stiffness[i[1]] + stiffness[j[1]],
                               stiffness[i[2]] + stiffness[j[2]], stiffness[i[3]] + stiffness[j[3]]);
        most = larger(select(none < load<4>(w.d + c), -both, none), most);
    }
    return largest_lane(most);
}

// The square of the fastest contact's speed (slowness()). Opening contacts count only if they overlap.
template <bool kFalls>
CAROM_INLINE double fastest_squared(const Work& w, const Law<kFalls>& law) {
    const Four none = broadcast<4>(0.0), first = broadcast<4>(kNoMemory);
    Four most = none;
    for (int c = 0; c < w.lanes; c += 4) {
        const Four d = load<4>(w.d + c), rate = load<4>(w.rate[0] + c), overlap = larger(d, none);
        const Four memory = select(none < rate, first, load<4>(w.inverse + c));
        const Four speed = select(none < d, rate, larger(rate, none));
        most = larger(most, speed * speed + overlap * normal_force(law.a, law.b, law.p, overlap, memory));
    }
    return largest_lane(most);
}

// Marks the contacts that may close within a step of length h. The others need no rates at its stages.
CAROM_INLINE void watch(Work& w, double h) {
    const Four zero = broadcast<4>(0.0), one = broadcast<4>(1.0);
    int beyond = 0;
    for (int c = 0; c < w.lanes; c += 4) {
        const Four most = h * (larger(load<4>(w.rate[0] + c), zero) + broadcast<4>(h));
        const Four watched = select(zero - load<4>(w.d + c) < most, one, zero);
        store(w.watched + c, watched);
        const int bits = bits_less(zero, watched);
        if (c + 4 > w.near && (bits >> (w.near > c ? w.near - c : 0)) != 0) beyond = 1;
    }
    if (beyond == 0) return;
    // A margin, so that they need not move again soon.
    w.horizon = 2.0 * h;
    reorder<false>(w, w.d);
}

// The slopes of the stages of a step of length h, except the first.
template <bool kFalls>
CAROM_INLINE void stages(Work& w, const Law<kFalls>& law, const RungeKutta& method, double h) {
    for (int n = 0; n < method.stages(); ++n) {
        const int from = method.slope(n), to = method.slope(n + 1);
        const double time = h * method.node[n];
        shift(w, w.dy[from], time);
        shift_overlaps(w, w.rate[from], time);
        if (from == to) clear(w, w.dy[to]);
        forces<true>(w, law, w.y_stage, w.d_stage, time, w.dy[to], w.rate[to]);
    }
}

// One Runge-Kutta step; returns its length. On entry rate[0] belongs to the state. `longest` limits the step.
// With friction the error sets the limit of the next step, in `next`; without friction `next` is ignored.
template <bool kFalls>
CAROM_INLINE double step(Work& w, const Law<kFalls>& law, double shortest, double longest, double& next) {
    forces<false>(w, law, w.y, w.d, 0.0, w.dy[0], nullptr);
    const double most = law.friction ? stiffest(w, w.dy[0]) : 0.0;
    Plan plan = law.friction ? plan_step(most, smallest(longest, next)) : Plan{&kClassical, longest};
    watch(w, plan.h);
    for (;;) {
        stages(w, law, *plan.method, plan.h);
        if (!law.friction) {
            finish<false>(w, *plan.method, plan.h);
            break;
        }
        const double error = finish<true>(w, *plan.method, plan.h);
        next = step_after(next, plan.h, error);
        if (!(error > kStepError && plan.h > shortest)) break;
        plan = plan_step(most, 0.5 * plan.h);
    }
    const double h = plan.h;
    clear(w, w.dy[0]);
    double* const before = w.y;
    w.y = w.y_stage;
    w.y_stage = before;
    // The trapezoidal rule: forces begin and end at 0, so the errors of the steps cancel.
    for (int n = 0; n < kRow * w.rows; n += kRow)
        add_displacement(w, n, 0.5 * h * (load<4>(before + n) + load<4>(w.y + n)));
    if (law.cloth) drag(w, law, w.y);
    advance(w, *plan.method, h);
    return h;
}

template <bool kFalls>
std::int64_t integrate(const ContactPhase& phase, const HertzLaw& law, double longest_step, double look_ahead,
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
                            law.mu_s > 0.0 && has_friction(law),
                            has_friction(law)};
    update_rates(w);
    std::int64_t steps = 0;
    double next = longest_step;
    double time = 0.0, braked = 0.0;
    const auto brake_all = [&w, &law, &time, &braked] {
        for (int n = 0; n < kRow * w.balls && law.slide > 0.0; n += kRow) {
            brake(law.slide * (time - braked), w.y[n], w.y[n + 2], w.y[n + 1], w.y[n + 3]);
            copy_row(w.y_stage + n, w.y + n);
        }
        braked = time;
    };
    for (;;) {
        if (!(time < time_limit)) return -1;
        const double most = longest_step * slowness(fastest_squared(w, lanes));
        const double longest = w.shares ? update_turning(phase, w, most) : most;
        const double h = step(w, lanes, kShortest * longest_step, longest, next);
        ++steps;
        time += h;
        if (time - braked > kBrakes) brake_all();
        if (any_pressed(w, law, time_limit - time)) continue;
        const double flight = next_touch(w);
        if (!(flight < look_ahead)) break;
        // Contacts that overlap without force continue to open.
        if (any_overlap(w)) continue;
        if (time > kLongPhase) break;
        fly(phase, w, flight, look_ahead);
        time += flight;
        brake_all();
        update_rates(w);
    }
    brake_all();
    for (int b = 0; b < w.balls; ++b) {
        for (int k = 0; k < kPerBall; ++k) phase.motion[kPerBall * b + k] = w.y[kRow * b + kPlace[k]];
        if (phase.moved == nullptr) continue;
        for (int k = 0; k < 2; ++k) phase.moved[2 * b + k] = w.moved[kRow / 2 * b + kPlace[k]];
    }
    if (phase.time != nullptr) *phase.time = time;
    return steps;
}

}  // namespace

namespace CAROM_ISA_NAMESPACE {

std::int64_t contact_phase(const ContactPhase& phase, const HertzLaw& law, double longest_step,
                           double look_ahead, double time_limit) noexcept {
    return law.mu_b_more > 0.0 ? integrate<true>(phase, law, longest_step, look_ahead, time_limit)
                               : integrate<false>(phase, law, longest_step, look_ahead, time_limit);
}

}  // namespace CAROM_ISA_NAMESPACE

}  // namespace carom::kernel
