// The contact phase, four contacts at a time. Built once per instruction set.
//
// An evaluation of the right-hand side gathers the balls of four closed contacts, computes their forces in
// lanes, then adds them to the balls, one contact after another in the order of their numbers. A lane
// computes the same as a scalar program, and every sum has a fixed order. Only the balls of closed contacts
// belong to a step; the others move on parabolas. After each step all contacts are examined in lanes:
// overlaps, rates, largest overlaps, and the predicted time at which each closes, opens or turns, where the
// next step ends.
#include "carom/kernel/contact_phase.h"

#include <cstdint>

#include "contact_phase/rock4.h"
#include "kernel_set.h"
#include "numbers.h"
#include "simd.h"

namespace carom::kernel {
namespace {

using Four = Pack<4>;

constexpr double kNever = 1e300;
// [V] Smaller changes of the balls' speeds by a contact are rounding and may be ignored. Balls that move
// together would close at such speeds forever.
constexpr double kNothing = 1e-12;
// [L/V] An event that is nearer than this belongs to the present step, and at a tight tolerance one nearer
// than about its 0.4th power: a prediction that misses by t costs 0.4 t^2.5.
constexpr double kEarly = 1e-3;
// [L/V] The first step, that after a flight, and the longest one.
constexpr double kFirstStep = 0.01, kAfterFlight = 0.05, kLongestStep = 1.0, kShortestStep = 1e-9;
// Step after an error: the fourth root aims at this fraction of the tolerance; the factor is within limits.
constexpr double kSafety = 0.8, kGrow = 5.0, kShrink = 0.2, kRetry = 0.9, kRetryLeast = 0.1;

// [L/V] A surface that is nearer than this is hit now.
constexpr double kAtOnce = 1e-7;
// [L/V] Contacts that nothing acts on are examined again when they are as near to closing.
constexpr double kSoon = 0.25;
// [V^2/L] Weaker friction of the weight moves no ball by a tenth of L within kLongPhase.
constexpr double kWeak = 1e-4;

// [-] From this unloading exponent on (e_b below 0.14), the force of a contact ends within a part of a step.
constexpr int kPlastic = 128;

constexpr int kLanes = 4;

// Numbers per ball. Rows of four: (x, y, v_x, v_y), (R w_x, R w_y, R w_z, -), and in space (z, v_z, -, -). In
// a slope, the last number of the second row is the vertical force of the contacts.
constexpr int kPlane = 8, kInSpace = 12;
constexpr int kSlopes = 6;

CAROM_INLINE int padded(int n) {
    return (n + kLanes - 1) / kLanes * kLanes;
}

// e^-x for x >= 0, as the 16th power of a Taylor series: relative error 3e-9 up to x = 10. Constant above x
// = 16. Summed in pairs, because the chain of forces waits for it.
CAROM_INLINE Four falling_exponential(Four x) {
    const auto number = [](double value) { return broadcast<4>(value); };
    const Four t = smaller((1.0 / 16.0) * x, number(1.0)), t2 = t * t, t4 = t2 * t2;
    const Four low = (number(1.0) - t) + t2 * (number(0.5) - (1.0 / 6.0) * t);
    const Four middle =
        (number(1.0 / 24.0) - (1.0 / 120.0) * t) + t2 * (number(1.0 / 720.0) - (1.0 / 5040.0) * t);
    const Four high = (number(1.0 / 40320.0) - (1.0 / 362880.0) * t) + (1.0 / 3628800.0) * t2;
    Four power = (low + t4 * middle) + (t4 * t4) * high;
    for (int doubling = 0; doubling < 4; ++doubling) power = power * power;
    return power;
}

// The largest overlap inside a step in which the overlap stopped growing, from the cubic Hermite interpolant;
// m0 and m1 are the rates at its ends times its length.
CAROM_INLINE double peak(double before, double after, double m0, double m1) {
    const double rise = after - before, q2 = 3.0 * rise - 2.0 * m0 - m1, q3 = m0 + m1 - 2.0 * rise;
    const double s = m0 / (square_root(largest(0.0, q2 * q2 - 3.0 * q3 * m0)) - q2);
    return s > 0.0 && s < 1.0 ? before + s * (m0 + s * (q2 + s * q3)) : 0.0;
}

// Vectors of four contacts.
struct Apart {
    Four x, y, z;
};

template <bool kSpace, bool kFalls>
class Phase {
    static constexpr int kRow = kSpace ? kInSpace : kPlane;

  public:
    Phase(const ContactPhase& phase, const HertzLaw& law, double tolerance)
        : phase_(phase),
          law_(law),
          tolerance_(tolerance),
          early_(smallest(kEarly, root4(tolerance) * root4(square_root(tolerance * root4(tolerance))))),
          weighs_(law.slide > kWeak),
          weight_slip2_(kWeightSlip * law.slide * (kWeightSlip * law.slide)),
          cloth_sign_(law.published_slip_sign ? 1.0 : -1.0),
          nobody_(kRow * phase.balls),
          lanes_(padded(phase.contacts)) {
        double* numbers = phase.numbers;
        const auto take = [&numbers](int count) {
            double* taken = numbers;
            numbers += padded(count);
            for (int n = 0; n < padded(count); ++n) taken[n] = 0.0;
            return taken;
        };
        const int rows = nobody_ + kRow;
        double** const states[] = {&y_, &a_, &b_, &c_, &next_};
        for (double** state : states) *state = take(rows);
        for (double*& slope : slope_) slope = take(rows);
        stiff_ = take(phase.balls + 1);
        double** const of_contacts[] = {&start_[0], &start_[1], &start_[2], &gap2_,   &touch_, &d_,
                                        &rate_,     &pull_,     &most_,     &closes_, &force_, &rises_};
        for (double** numbers_of : of_contacts) *numbers_of = take(lanes_);
        packed_ = take(kPacked * lanes_);
        forces_ = take(kForces * lanes_);
        int* places = phase.places;
        const auto take_places = [&places](int count) {
            int* taken = places;
            places += count;
            return taken;
        };
        i_ = take_places(lanes_);
        j_ = take_places(lanes_);
        closed_ = take_places(lanes_ + kLanes);
        at_i_ = take_places(lanes_ + kLanes);
        at_j_ = take_places(lanes_ + kLanes);
        active_ = take_places(phase.balls + kLanes);
        is_active_ = take_places(phase.balls + 1);
        was_active_ = take_places(phase.balls + 1);
        for (int b = 0; b <= phase.balls; ++b) is_active_[b] = was_active_[b] = 0;
        for (int b = 0; b < phase.balls; ++b) {
            const double* from = phase.motion + 6 * b;
            double* y = y_ + kRow * b;
            for (int k = 0; k < 2; ++k) y[2 + k] = from[k];
            for (int k = 0; k < 3; ++k) y[4 + k] = from[3 + k];
            if constexpr (kSpace) y[9] = phase.held ? 0.0 : from[2];
        }
        for (int c = 0; c < lanes_; ++c) {
            const bool real = c < phase.contacts;
            const HertzContact contact =
                real ? phase.contact[c] : HertzContact{0, 0, {1.0, 0.0, 0.0}, -1.0, 1.0};
            const double gap = -contact.overlap;
            for (int k = 0; k < 3; ++k) start_[k][c] = (contact.touch + gap) * contact.n[k];
            gap2_[c] = gap * (2.0 * contact.touch + gap);
            touch_[c] = contact.touch;
            i_[c] = real ? kRow * contact.i : nobody_;
            j_[c] = real ? kRow * contact.j : nobody_;
            if (real && phase.history != nullptr) phase.history[c] = {-1.0, 0.0};
        }
    }

    std::int64_t run(double look_ahead, double time_limit) {
        double h = kFirstStep, longest = kFirstStep;
        for (int b = 0; b < phase_.balls; ++b) set_glide_slope(b);
        examine(0.0);
        bool known = false;  // the slopes of the active balls
        for (std::int64_t steps = 0; steps < kMostSteps && time_ < time_limit && evaluations_ < phase_.most;
             ++steps) {
            known = gather() && known;
            if (phase_.surfaces != nullptr && hit_surfaces()) {
                examine(0.0);
                continue;
            }
            if (!presses(time_limit - time_)) {
                const double closing = next_closing(), out = until_out();
                const bool ends = !(closing < look_ahead) || (time_ > kLongPhase && actives_ == 0);
                if (ends && !(out > 0.0)) {
                    leave();
                    return evaluations_;
                }
                if (actives_ == 0) {
                    double flight = smallest(smallest(closing, wall_), out > 0.0 ? out : kNever);
                    // Look again after a step: a ball that begins to roll accelerates no longer.
                    if (weighs_) flight = smallest(flight, largest(early_, smallest(event_, kLongestStep)));
                    for (int b = 0; b < phase_.balls; ++b) {
                        glide(b, flight);
                        set_glide_slope(b);
                    }
                    time_ += flight;
                    examine(0.0);
                    h = longest = kAfterFlight;
                    continue;
                }
            }
            if (!known) evaluate(y_, slope_[0]);
            known = true;
            const double stiffest = find_stiffest();
            const double event = smallest(event_, wall_);
            bool again = false;
            double wanted = h;
            for (;;) {
                h = smallest(h, kLongestStep);
                if (stiffest > 0.0) h = smallest(h, kReach / stiffest);
                // Approach an event in equal steps.
                if (!again && event < 4.0 * h) h = event / ceiling(event / h - 0.1);
                const double error = step(h, stiffest);
                const double ratio = error > 0.0 ? kSafety * root4(tolerance_ / error) : kGrow;
                const bool good = error <= tolerance_;
                if (good || !(h > kShortestStep)) {
                    wanted = h * smallest(again ? 1.0 : kGrow, largest(kShrink, ratio));
                    break;
                }
                again = true;
                h *= ratio > kRetryLeast ? smallest(kRetry, ratio) : kRetryLeast;
            }
            accept(h);
            // A step that an event cut short says little about the next one.
            const double before = longest;
            longest = wanted;
            h = h == event ? largest(wanted, before) : wanted;
        }
        return -1;
    }

  private:
    // Numbers per closed contact, in packs of four: from start_, gap2_, touch_, 1 over the largest overlap,
    // the stiffness, friction over slip, and the normal force.
    static constexpr int kGap2 = 3, kTouch = 4, kInverse = 5, kStiffness = 6, kFriction = 7, kNormal = 8,
                         kPacked = 9;
    static constexpr int kForces = 3 * kLanes;
    static constexpr double kReach = 0.353 * kMostStages * kMostStages - 3.0;

    static double root4(double x) { return square_root(square_root(x)); }
    static double ceiling(double x) {
        const double whole = static_cast<double>(static_cast<std::int64_t>(x));
        return largest(1.0, whole < x ? whole + 1.0 : whole);
    }
    double mobility(int ball) const {
        return phase_.inverse_mass == nullptr ? 1.0 : phase_.inverse_mass[ball];
    }

    // The state of a ball for ContactSurfaces.
    struct State {
        double number[9];
    };
    State state_of(int ball) const {
        const double* y = y_ + kRow * ball;
        return {{y[0], y[1], kSpace ? y[kRow - 4] : 0.0, y[2], y[3], kSpace ? y[kRow - 3] : 0.0, y[4], y[5],
                 y[6]}};
    }

    // Hits the surfaces that balls without a closed contact have reached, and finds when the next one is hit.
    // @return whether a ball hit one
    bool hit_surfaces() {
        bool hit = false;
        wall_ = kNever;
        for (int b = 0; b < phase_.balls; ++b) {
            if (is_active_[b] != 0) continue;
            State s = state_of(b);
            const double time = phase_.surfaces->next(phase_.surfaces->owner, b, s.number);
            if (!(time < kAtOnce)) {
                wall_ = smallest(wall_, time);
                continue;
            }
            phase_.surfaces->hit(phase_.surfaces->owner, b, time_, s.number);
            double* y = y_ + kRow * b;
            for (int k = 0; k < 2; ++k) y[2 + k] = s.number[3 + k];
            if constexpr (kSpace) y[9] = phase_.held ? 0.0 : s.number[5];
            for (int k = 0; k < 3; ++k) y[4 + k] = s.number[6 + k];
            set_glide_slope(b);
            hit = true;
        }
        return hit;
    }

    // Time until no ball is inside a surface.
    double until_out() const {
        double longest = 0.0;
        for (int b = 0; phase_.surfaces != nullptr && b < phase_.balls; ++b)
            longest = largest(longest, phase_.surfaces->out(phase_.surfaces->owner, b, state_of(b).number));
        return longest;
    }

    // Whether a free ball is off the cloth: it rises or falls by more than the cloth yields.
    CAROM_INLINE bool is_aloft(int ball) const {
        if constexpr (!kSpace) return false;
        if (phase_.held || phase_.lies == nullptr) return false;
        const double* y = y_ + kRow * ball;
        return y[9] * y[9] + 2.0 * law_.gravity * (y[kRow - 4] - phase_.lies[ball]) > law_.hop;
    }

    // The closed contacts, and those about to close, with their balls.
    // @return whether the same balls were active before
    bool gather() {
        int* const before = was_active_;
        was_active_ = is_active_;
        is_active_ = before;
        for (int b = 0; b <= phase_.balls; ++b) is_active_[b] = 0;
        const int count = count_;
        actives_ = count_ = 0;
        bool same = true;
        for (int c = 0; c < phase_.contacts; ++c) {
            if (!(d_[c] > 0.0)) {
                force_[c] = rises_[c] = 0.0;
                if (!(closes_[c] < early_)) continue;
            }
            same = same && count_ < count && closed_[count_] == c;
            closed_[count_++] = c;
            const int rows[] = {i_[c], j_[c]};
            for (const int row : rows) {
                const int ball = row / kRow;
                if (is_active_[ball] != 0) continue;
                is_active_[ball] = 1;
                active_[actives_++] = row;
                same = same && was_active_[ball] != 0;
            }
            if (phase_.history != nullptr && phase_.history[c].first < 0.0) phase_.history[c].first = time_;
        }
        for (int n = 0; n < kLanes; ++n) active_[actives_ + n] = nobody_;
        for (int b = 0; b < phase_.balls; ++b) {
            if (was_active_[b] == 0 || is_active_[b] != 0) continue;
            set_glide_slope(b);
            same = false;
        }
        for (int n = 0; n < padded(count_); ++n) {
            const bool real = n < count_;
            const int c = real ? closed_[n] : 0;
            at_i_[n] = real ? i_[c] : nobody_;
            at_j_[n] = real ? j_[c] : nobody_;
            double* const to = packed_ + kPacked * (n / kLanes * kLanes) + n % kLanes;
            const double nowhere[] = {2.0, 0.0, 0.0, 3.0, 1.0, kNever, 1.0};
            const double here[] = {start_[0][c],
                                   start_[1][c],
                                   start_[2][c],
                                   gap2_[c],
                                   touch_[c],
                                   most_[c] > 0.0 ? 1.0 / most_[c] : kNever,
                                   real ? phase_.contact[c].stiffness : 1.0};
            for (int k = 0; k <= kStiffness; ++k) to[kLanes * k] = real ? here[k] : nowhere[k];
        }
        return same;
    }

    // Difference j - i of four contacts: places in `apart`, velocities in `v`.
    CAROM_INLINE void differences(const double* y, const int* i, const int* j, Apart& apart, Apart& v) const {
        Four rows[4];
        for (int lane = 0; lane < kLanes; ++lane) rows[lane] = load<4>(y + j[lane]) - load<4>(y + i[lane]);
        transpose(rows[0], rows[1], rows[2], rows[3]);
        apart.x = rows[0];
        apart.y = rows[1];
        v.x = rows[2];
        v.y = rows[3];
        if constexpr (kSpace) {
            for (int lane = 0; lane < kLanes; ++lane)
                rows[lane] = load<4>(y + j[lane] + kPlane) - load<4>(y + i[lane] + kPlane);
            transpose(rows[0], rows[1], rows[2], rows[3]);
            apart.z = rows[0];
            v.z = rows[1];
        }
    }
    CAROM_INLINE static Four dot(const Apart& a, const Apart& b) {
        if constexpr (kSpace)
            return (a.x * b.x + a.y * b.y) + a.z * b.z;
        else
            return a.x * b.x + a.y * b.y;
    }

    // The overlap touch - |start + moved| without subtracting nearly equal numbers, and the normal.
    struct Geometry {
        Four d, inverse;
        Apart n;
    };
    CAROM_INLINE static Geometry geometry(const Apart& start, Four gap2, Four touch, const Apart& moved) {
        Apart z{start.x + moved.x, start.y + moved.y, {}};
        if constexpr (kSpace) z.z = start.z + moved.z;
        const Four distance = square_root(dot(z, z)), sum = touch + distance;
        const Four inverse = broadcast<4>(1.0) / distance;
        Geometry g{-((gap2 + 2.0 * dot(start, moved)) + dot(moved, moved)) / sum, inverse, z};
        g.n.x = z.x * inverse;
        g.n.y = z.y * inverse;
        if constexpr (kSpace) g.n.z = z.z * inverse;
        return g;
    }

    // The forces of four contacts at y, into `forces_`, as rows of slopes.
    CAROM_INLINE void find_forces(const double* y, int first) {
        double* const from = packed_ + kPacked * first;
        const auto packed = [from](int k) { return load<4>(from + kLanes * k); };
        const int *i = at_i_ + first, *j = at_j_ + first;
        Apart moved, v;
        differences(y, i, j, moved, v);
        Four w[4];
        for (int lane = 0; lane < kLanes; ++lane)
            w[lane] = load<4>(y + i[lane] + 4) + load<4>(y + j[lane] + 4);
        transpose(w[0], w[1], w[2], w[3]);
        const Geometry g = geometry({packed(0), packed(1), packed(2)}, packed(kGap2), packed(kTouch), moved);
        const Apart& n = g.n;
        const Four zero = broadcast<4>(0.0), d = larger(g.d, zero);
        const Four loading = d * square_root(d), share = d * packed(kInverse);
        Four power = share;
        for (int p = law_.p; p > 1; p /= 2) power = power * power;
        Four F =
            select(share < broadcast<4>(1.0), loading * (broadcast<4>(law_.a) + law_.b * power), loading);
        if constexpr (kSpace) F = packed(kStiffness) * F;
        Apart s;  // slip of i on j, and in the plane: along (n_y, -n_x), and upwards in z
        Four slip2;
        if constexpr (kSpace) {
            const Four closing = dot(v, n);
            s.x = (closing * n.x - v.x) + (w[1] * n.z - w[2] * n.y);
            s.y = (closing * n.y - v.y) + (w[2] * n.x - w[0] * n.z);
            s.z = (closing * n.z - v.z) + (w[0] * n.y - w[1] * n.x);
            slip2 = dot(s, s) + broadcast<4>(law_.epsilon * law_.epsilon);
        } else {
            s.x = (v.y * n.x - v.x * n.y) - w[2];
            s.z = w[0] * n.y - w[1] * n.x;
            slip2 = (s.x * s.x + s.z * s.z) + broadcast<4>(law_.epsilon * law_.epsilon);
        }
        const Four slip = square_root(slip2);
        Four mu = broadcast<4>(law_.mu_b);
        if constexpr (kFalls) mu = mu + law_.mu_b_more * falling_exponential(law_.mu_b_fall * slip);
        const Four k = mu * (F / slip2 * slip);  // roots, quotient and exponential in parallel
        store(from + kLanes * kFriction, k);
        store(from + kLanes * kNormal, F);
        Four centre[4], spin[4];
        double* const to = forces_ + kForces * first;
        if constexpr (kSpace) {
            const Apart f{-k * s.x, -k * s.y, -k * s.z};
            const Four up = f.z - F * n.z;
            centre[0] = up, centre[1] = zero, centre[2] = f.x - F * n.x, centre[3] = f.y - F * n.y;
            spin[0] = 2.5 * (n.y * f.z - n.z * f.y), spin[1] = 2.5 * (n.z * f.x - n.x * f.z);
            spin[2] = 2.5 * (n.x * f.y - n.y * f.x), spin[3] = up;
        } else {
            const Four f_x = -k * s.x, f_z = -k * s.z, twist = 2.5 * f_z;
            centre[0] = centre[1] = zero, centre[2] = f_x * n.y - F * n.x, centre[3] = -F * n.y - f_x * n.x;
            spin[0] = twist * n.y, spin[1] = -twist * n.x, spin[2] = -2.5 * f_x, spin[3] = f_z;
        }
        transpose(centre[0], centre[1], centre[2], centre[3]);
        transpose(spin[0], spin[1], spin[2], spin[3]);
        for (int lane = 0; lane < kLanes; ++lane) {
            store(to + kForces * lane, centre[lane]);
            store(to + kForces * lane + 4, spin[lane]);
        }
    }

    // Adds the force of the contact in this place to the slopes of its balls.
    CAROM_INLINE void add_force(int place, double* slope) const {
        const double* from = forces_ + kForces * place;
        Four centre = load<4>(from), spin = load<4>(from + 4);
        const Four other = pack(1.0, 1.0, 1.0, -1.0);
        const int rows[] = {at_i_[place], at_j_[place]};
        for (const int row : rows) {
            double* to = slope + row;
            Four light = broadcast<4>(1.0), spin_light = light;
            if constexpr (kSpace) {
                const double m = row == nobody_ ? 0.0 : mobility(row / kRow);
                light = pack(0.0, 0.0, m, m);
                spin_light = pack(m, m, m, 1.0);
                if (!phase_.held) to[9] += (row == at_i_[place] ? m : -m) * from[0];
            }
            store(to, load<4>(to) + (kSpace ? light * centre : centre));
            store(to + 4, load<4>(to + 4) + (kSpace ? spin_light * spin : spin));
            centre = -centre;
            spin = spin * other;
        }
    }

    // The friction of the cloth on four active balls: of those pressed down by contacts, and of their weight.
    CAROM_INLINE void add_cloth(const double* y, int first, double* slope) {
        const int* rows = active_ + first;
        Four s[4], v[4], w[4];
        for (int lane = 0; lane < kLanes; ++lane) s[lane] = load<4>(slope + rows[lane] + 4);
        transpose(s[0], s[1], s[2], s[3]);
        const Four zero = broadcast<4>(0.0);
        const bool pressed = law_.mu_s > 0.0 && bits_less(s[3], zero) != 0;
        if (!pressed && !(law_.slide > 0.0)) return;
        for (int lane = 0; lane < kLanes; ++lane) {
            v[lane] = load<4>(y + rows[lane]);
            w[lane] = load<4>(y + rows[lane] + 4);
        }
        transpose(v[0], v[1], v[2], v[3]);
        transpose(w[0], w[1], w[2], w[3]);
        Four x = zero, z = zero;  // the deceleration
        if (law_.slide > 0.0) {
            const Four ux = v[2] - w[1], uy = v[3] + w[0];
            const Four k = law_.slide / square_root((ux * ux + uy * uy) + broadcast<4>(weight_slip2_));
            x = k * ux;
            z = k * uy;
        }
        if (pressed) {
            const Four ux = v[2] + cloth_sign_ * w[1], uy = v[3] - cloth_sign_ * w[0];
            const Four slip2 = (ux * ux + uy * uy) + broadcast<4>(law_.epsilon * law_.epsilon);
            Four load_on = select(s[3] < zero, -law_.mu_s * s[3], zero);
            if constexpr (kSpace) {
                for (int lane = 0; lane < kLanes; ++lane)
                    if (rows[lane] != nobody_)
                        set_lane(load_on, lane, kernel::lane(load_on, lane) * mobility(rows[lane] / kRow));
            }
            const Four k = load_on / slip2 * square_root(slip2);
            x = x + k * ux;
            z = z + k * uy;
            for (int lane = 0; lane < kLanes; ++lane) stiff_[rows[lane] / kRow] += kernel::lane(k, lane);
        }
        Four to_v[4] = {zero, zero, -x, -z}, to_w[4] = {-2.5 * z, 2.5 * x, zero, zero};
        transpose(to_v[0], to_v[1], to_v[2], to_v[3]);
        transpose(to_w[0], to_w[1], to_w[2], to_w[3]);
        for (int lane = 0; lane < kLanes; ++lane) {
            double* to = slope + rows[lane];
            store(to, load<4>(to) + to_v[lane]);
            store(to + 4, load<4>(to + 4) + to_w[lane]);
        }
    }

    // The slopes of the active balls at y.
    void evaluate(const double* y, double* slope) {
        ++evaluations_;
        const Four zero = broadcast<4>(0.0);
        for (int n = 0; n < actives_; ++n) {
            const double* from = y + active_[n];
            double* to = slope + active_[n];
            store(to, pack(from[2], from[3], 0.0, 0.0));
            store(to + 4, zero);
            if constexpr (kSpace) {
                const double pull = is_aloft(active_[n] / kRow) ? -law_.gravity : 0.0;
                store(to + kPlane, pack(from[9], pull, 0.0, 0.0));
            }
            stiff_[active_[n] / kRow] = 0.0;
        }
        for (int n = 0; n < count_; n += kLanes) find_forces(y, n);
        for (int n = 0; n < count_; ++n) add_force(n, slope);
        if (phase_.held)
            for (int n = 0; n < actives_; n += kLanes) add_cloth(y, n, slope);
    }

    // An upper bound of the rates at which friction makes slips decay, after an evaluation. With k = mu_b F /
    // |s|, the friction of one contact makes its slip decay at the rate 7 k. Each further contact of one of
    // the two balls adds at most 3.5 times its own k, as does the cloth. By Gershgorin's theorem no rate of
    // all contacts together exceeds 3.5 times the largest sum of k over both balls of a contact.
    double find_stiffest() {
        for (int n = 0; n < count_; ++n) {
            const double k = packed(n, kFriction);
            const int rows[] = {at_i_[n], at_j_[n]};
            for (const int row : rows) stiff_[row / kRow] += k * mobility(row / kRow);
        }
        double most = law_.slide > 0.0 ? 1.0 / kWeightSlip : 0.0;
        for (int n = 0; n < count_; ++n)
            most = largest(most, stiff_[at_i_[n] / kRow] + stiff_[at_j_[n] / kRow]);
        return 3.5 * most;
    }
    double packed(int place, int k) const {
        return packed_[kPacked * (place / kLanes * kLanes) + kLanes * k + place % kLanes];
    }

    // to = y + the sum of factors times slopes, for the active balls.
    template <int kCount>
    CAROM_INLINE void combine(double* to, const double* y, const double (&factor)[kCount],
                              double* const* slopes) const {
        for (int n = 0; n < actives_; ++n) {
            for (int k = 0; k < kRow; k += 4) {
                const int at = active_[n] + k;
                Four sum = factor[0] * load<4>(slopes[0] + at);
                for (int m = 1; m < kCount; ++m) sum = sum + factor[m] * load<4>(slopes[m] + at);
                store(to + at, load<4>(y + at) + sum);
            }
        }
    }

    // One step of ROCK4 from y_ and slope_[0] into next_, with the slope there in slope_[5].
    // @return the largest error of a velocity or spin
    double step(double h, double stiffest) {
        const double wanted = square_root((3.0 + h * stiffest) / 0.353) + 1.0;
        const int whole = static_cast<int>(wanted);
        const int stages = whole < kFewestStages ? kFewestStages : whole > kMostStages ? kMostStages : whole;
        const int chain = stages - 4;
        const double* rec = kChain + (chain - 1) * (chain - 1);
        double *const *k = slope_ + 1, *older = a_, *old = b_, *now = c_;
        combine<1>(old, y_, {h * rec[0]}, slope_);
        const double* before = y_;
        for (int n = 2; n <= chain; ++n) {
            evaluate(old, k[0]);
            const double mu = h * rec[2 * n - 3], kappa = rec[2 * n - 2], nu = 1.0 + kappa;
            for (int m = 0; m < actives_; ++m) {
                for (int q = 0; q < kRow; q += 4) {
                    const int at = active_[m] + q;
                    store(now + at,
                          (mu * load<4>(k[0] + at) + nu * load<4>(old + at)) - kappa * load<4>(before + at));
                }
            }
            before = old;
            double* const free = older;
            older = old;
            old = now;
            now = free;
        }
        const double* in = kInner[chain - 1];
        const double* last = kLast[chain - 1];
        const double* embedded = kEmbedded[chain - 1];
        evaluate(old, k[0]);
        combine<1>(now, old, {h * in[0]}, k);
        evaluate(now, k[1]);
        combine<2>(now, old, {h * in[1], h * in[2]}, k);
        evaluate(now, k[2]);
        combine<3>(now, old, {h * in[3], h * in[4], h * in[5]}, k);
        evaluate(now, k[3]);
        combine<4>(next_, old, {h * last[0], h * last[1], h * last[2], h * last[3]}, k);
        evaluate(next_, k[4]);
        Four most = broadcast<4>(0.0);
        const double e[] = {h * (embedded[0] - last[0]), h * (embedded[1] - last[1]),
                            h * (embedded[2] - last[2]), h * (embedded[3] - last[3]), h * embedded[4]};
        const Four velocities[] = {pack(0.0, 0.0, 1.0, 1.0), pack(1.0, 1.0, 1.0, 0.0),
                                   pack(0.0, 1.0, 0.0, 0.0)};
        for (int n = 0; n < actives_; ++n) {
            for (int q = 0; q < kRow; q += 4) {
                const int at = active_[n] + q;
                Four error = e[0] * load<4>(k[0] + at);
                for (int m = 1; m < 5; ++m) error = error + e[m] * load<4>(k[m] + at);
                most = larger(absolute(error) * velocities[q / 4], most);
            }
        }
        double error = 0.0;
        for (int lane = 0; lane < kLanes; ++lane) error = largest(error, kernel::lane(most, lane));
        return error;
    }

    // Takes over the state after a step of length h.
    void accept(double h) {
        for (int b = 0; b < phase_.balls; ++b) {
            if (is_active_[b] == 0)
                glide(b, h);
            else
                for (int k = 0; k < kRow; k += 4) store(y_ + kRow * b + k, load<4>(next_ + kRow * b + k));
        }
        double* const now = slope_[0];
        slope_[0] = slope_[kSlopes - 1];
        slope_[kSlopes - 1] = now;
        for (int b = 0; b < phase_.balls; ++b)
            if (is_active_[b] == 0) set_glide_slope(b);
        time_ += h;
        examine(h);
        if (phase_.history != nullptr) book(h);
    }

    // Adds the impulses of a step: the integral of the cubic Hermite interpolant of the force.
    void book(double h) {
        for (int n = 0; n < count_; ++n) {
            const int c = closed_[n];
            const double F = packed(n, kNormal), d = d_[c], share = most_[c] > 0.0 ? d / most_[c] : 1.0;
            double power = share;
            for (int p = law_.p; p > 1; p /= 2) power *= power;
            const double rise = share < 1.0 ? 1.5 * (law_.a + law_.b * power) + law_.p * law_.b * power : 1.5;
            const double rate =
                d > 0.0 ? square_root(d) * rise * rate_[c] * phase_.contact[c].stiffness : 0.0;
            // A plastic contact lets go at its largest overlap, which is where a step begins.
            const bool lets_go = law_.p >= kPlastic && F < 0.5 * force_[c];
            phase_.history[c].impulse +=
                lets_go ? h * F : 0.5 * h * (force_[c] + F) + (1.0 / 12.0) * h * h * (rises_[c] - rate);
            force_[c] = F;
            rises_[c] = rate;
        }
    }

    // Whether a ball that nothing touches has the friction of its weight.
    CAROM_INLINE bool lies(int ball) const {
        return law_.slide > 0.0 && (phase_.held || (phase_.lies != nullptr && !is_aloft(ball)));
    }

    // The slope of a ball that nothing touches: only its acceleration, for examine().
    CAROM_INLINE void set_glide_slope(int ball) {
        double* slope = slope_[0] + kRow * ball;
        for (int k = 0; k < kRow; ++k) slope[k] = 0.0;
        if (!weighs_ || !lies(ball)) return;
        const double* y = y_ + kRow * ball;
        const double ux = y[2] - y[5], uy = y[3] + y[4], slip = square_root(ux * ux + uy * uy);
        if (!(slip > 0.0)) return;
        slope[2] = -law_.slide / slip * ux;
        slope[3] = -law_.slide / slip * uy;
    }

    // Moves a ball that nothing touches: it slides with constant deceleration until it rolls.
    CAROM_INLINE void glide(int ball, double h) {
        double* y = y_ + kRow * ball;
        const double v[] = {y[2], y[3]};
        const bool aloft = is_aloft(ball);
        if (lies(ball)) {
            const double ux = y[2] - y[5], uy = y[3] + y[4], slip = square_root(ux * ux + uy * uy);
            if (slip > 0.0) {
                const double ends = slip / (3.5 * law_.slide), lasts = smallest(h, ends);
                // Once it rolls, the slip is exactly 0.
                const double dv = ends < h ? 2.0 / 7.0 : law_.slide * lasts / slip,
                             back = dv * (h - 0.5 * lasts);
                y[0] -= back * ux;
                y[1] -= back * uy;
                y[2] -= dv * ux;
                y[3] -= dv * uy;
                y[4] -= 2.5 * dv * uy;
                y[5] += 2.5 * dv * ux;
            }
        }
        y[0] += h * v[0];
        y[1] += h * v[1];
        if constexpr (kSpace) {
            y[8] += h * y[9];
            if (aloft) {
                y[8] -= 0.5 * h * h * law_.gravity;
                y[9] -= h * law_.gravity;
            }
        }
    }

    // The contacts after a step of length h (0: at the start, or after a flight): overlaps, rates, largest
    // overlaps, and the predicted times of events. Contacts that nothing acts on, the weight's friction
    // included, need it only when they are about to close.
    void examine(double h) {
        const Four zero = broadcast<4>(0.0), never = broadcast<4>(kNever);
        const double *y = y_, *slope = slope_[0];
        Four first = never;
        for (int c = 0; c < lanes_; c += kLanes) {
            const int *i = i_ + c, *j = j_ + c;
            if (h > 0.0 && !weighs_) {
                const Four soon = load<4>(closes_ + c) - broadcast<4>(h);
                int acted = bits_less(soon, broadcast<4>(kSoon));
                for (int lane = 0; lane < kLanes; ++lane)
                    acted |= is_active_[i[lane] / kRow] | is_active_[j[lane] / kRow];
                if (acted == 0) {
                    store(closes_ + c, soon);
                    first = smaller(first, soon);
                    continue;
                }
            }
            Apart moved, v, none, pull;
            differences(y, i, j, moved, v);
            differences(slope, i, j, none, pull);
            const Geometry g =
                geometry({load<4>(start_[0] + c), load<4>(start_[1] + c), load<4>(start_[2] + c)},
                         load<4>(gap2_ + c), load<4>(touch_ + c), moved);
            const Four d = g.d, rate = -dot(v, g.n), across2 = larger(dot(v, v) - rate * rate, zero);
            const Four acceleration = -dot(pull, g.n) - across2 * g.inverse;
            const int closed = bits_less(zero, d);
            Four closes = never, turns = never;
            if (closed != 15) {
                const Four root2 = rate * rate - 2.0 * acceleration * d;
                const Four denominator = rate + square_root(larger(root2, zero));
                const Four time = select(zero < denominator, -2.0 * d / denominator, never);
                closes = select(zero < d, never, select(zero < root2, time, never));
            }
            if (closed != 0) {
                const Four d_before = load<4>(d_ + c), rate_before = load<4>(rate_ + c),
                           most = load<4>(most_ + c);
                store(most_ + c, select(zero < d, larger(most, d), zero));
                const int turned =
                    h > 0.0 ? bits_less(zero, rate_before) & bits_less(rate, zero) & closed : 0;
                for (int k = 0; turned >> k != 0; ++k) {
                    if ((turned >> k & 1) == 0) continue;
                    const double top = peak(kernel::lane(d_before, k), kernel::lane(d, k),
                                            h * kernel::lane(rate_before, k), h * kernel::lane(rate, k));
                    most_[c + k] = largest(most_[c + k], top);
                }
                // The third derivative, from the last step. A closed contact turns where the rate is 0, or
                // opens where d is: from there two of Newton's steps.
                const Four third = h > 0.0 ? (acceleration - load<4>(pull_ + c)) / broadcast<4>(h) : zero;
                const auto loads = zero < rate;
                const Four c0 = select(loads, rate, d), c1 = select(loads, acceleration, rate),
                           c2 = select(loads, third, acceleration), c3 = select(loads, zero, third);
                Four t = -c0 / c1;
                for (int round = 0; round < 2; ++round) {
                    const Four fall = c1 + t * (c2 + 0.5 * t * c3);
                    const Four value = c0 + t * (c1 + t * (0.5 * c2 + (1.0 / 6.0) * t * c3));
                    t = select(fall < zero, t - value / fall, t);
                }
                turns = select(c1 < zero, select(zero < d, t, never), never);
            } else {
                store(most_ + c, zero);
            }
            store(d_ + c, d);
            store(rate_ + c, rate);
            store(pull_ + c, acceleration);
            store(closes_ + c, closes);
            const Four event = smaller(closes, turns), early = broadcast<4>(early_);
            // An event that is too near has no step of its own.
            first = smaller(first, select(early < event, event, select(early < closes, closes, never)));
        }
        event_ = kNever;
        for (int lane = 0; lane < kLanes; ++lane) event_ = smallest(event_, kernel::lane(first, lane));
    }

    // Time at which the next contact closes faster than rounding.
    double next_closing() const {
        double first = kNever;
        for (int c = 0; c < phase_.contacts; ++c)
            if (rate_[c] > kNothing) first = smallest(first, closes_[c]);
        return first;
    }

    // Whether a contact still acts: it closes, or its force changes speeds by more than kNothing until it has
    // opened, or in the remaining time.
    bool presses(double time_left) const {
        for (int n = 0; n < count_; ++n) {
            const int c = closed_[n];
            const double d = d_[c], rate = rate_[c];
            if (!(d > 0.0)) {
                if (rate > kNothing) return true;
                continue;
            }
            if (rate > kNothing) return true;
            const double share = most_[c] > 0.0 ? d / most_[c] : 1.0;
            double power = share, F = d * square_root(d);
            for (int p = law_.p; p > 1; p /= 2) power *= power;
            if (share < 1.0) F *= law_.a + law_.b * power;
            if (F * time_left > kNothing && F * d > -rate * kNothing) return true;
        }
        return false;
    }

    void leave() {
        for (int b = 0; b < phase_.balls; ++b) {
            const double* y = y_ + kRow * b;
            double* to = phase_.motion + 6 * b;
            for (int k = 0; k < 2; ++k) to[k] = y[2 + k];
            if constexpr (kSpace) to[2] = phase_.held ? 0.0 : y[9];
            for (int k = 0; k < 3; ++k) to[3 + k] = y[4 + k];
            if (phase_.moved == nullptr) continue;
            for (int k = 0; k < 2; ++k) phase_.moved[3 * b + k] = y[k];
            phase_.moved[3 * b + 2] = kSpace ? y[kRow - 4] : 0.0;
        }
        if (phase_.time != nullptr) *phase_.time = time_;
    }

    const ContactPhase& phase_;
    const HertzLaw& law_;
    const double tolerance_, early_;
    const bool weighs_;  // the weight's friction moves balls while nothing touches them
    const double weight_slip2_, cloth_sign_;
    const int nobody_, lanes_;  // the row of a ball at rest that fills packs; contacts in whole packs
    // Now; time until the next event of a contact, and until a ball hits a surface.
    double time_ = 0.0, event_ = 0.0, wall_ = kNever;
    std::int64_t evaluations_ = 0;
    double *y_, *a_, *b_, *c_, *next_, *slope_[kSlopes];
    double* stiff_;  // per ball: the sum of friction over slip, times its mobility
    // Per contact: the vector from i to j at the start, and |it|^2 - touch^2; overlap, its derivatives, and
    // its maximum since the contact opened; the time until it closes; its last force and the rate of it.
    double *start_[3], *gap2_, *touch_, *d_, *rate_, *pull_, *most_, *closes_, *force_, *rises_;
    double *packed_, *forces_;  // per closed contact
    int *i_, *j_;               // rows of the balls
    int *closed_, *at_i_, *at_j_, *active_, *is_active_, *was_active_;
    int count_ = 0, actives_ = 0;
};

template <bool kSpace>
std::int64_t run(const ContactPhase& phase, const HertzLaw& law, double tolerance, double look_ahead,
                 double time_limit) {
    if (law.mu_b_more > 0.0) return Phase<kSpace, true>(phase, law, tolerance).run(look_ahead, time_limit);
    return Phase<kSpace, false>(phase, law, tolerance).run(look_ahead, time_limit);
}

}  // namespace

namespace CAROM_ISA_NAMESPACE {

std::int64_t contact_phase(const ContactPhase& phase, const HertzLaw& law, double tolerance,
                           double look_ahead, double time_limit) noexcept {
    bool level = phase.held && phase.inverse_mass == nullptr;
    for (int c = 0; c < phase.contacts && level; ++c)
        level = phase.contact[c].n[2] == 0.0 && phase.contact[c].stiffness == 1.0;
    return level ? run<false>(phase, law, tolerance, look_ahead, time_limit)
                 : run<true>(phase, law, tolerance, look_ahead, time_limit);
}

}  // namespace CAROM_ISA_NAMESPACE

}  // namespace carom::kernel
