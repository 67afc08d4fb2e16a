// The result of the explicit Euler integration without its steps. The integration is the sequence
// y(m+1) = y(m) + h f(y(m)). Over a block of K steps the rates are smooth functions of m: a polynomial
// through eight nodes represents them, and its sums over consecutive m are exact (sum_tables.h). Fixed-point
// sweeps find the values at the nodes, eight lanes at once. They sum the Euler sequence, not the continuous
// impulse, so step count, last step and discretisation error are those of the published integration. If the
// rates are not smooth (a change of the pressed side, a slip near zero, a ball that starts rolling), exact
// steps are made.
//
// If rounding decides the published integration, no other order of summation can reproduce it, and this one
// gives up: if many exact steps chatter near stick, or if the step that ends compression or the impact is a
// tie within rounding.
#pragma once

#include <cstdint>

#include "loop_marks.h"
#include "march/path.h"
#include "march/reduced.h"
#include "march/sum_tables.h"
#include "simd.h"

namespace carom::kernel {
namespace {

constexpr int kMostBlockSweeps = 24;
// Largest change of a node in the last sweep, and largest size of the highest modes of the rates, both
// relative to the approach speed.
constexpr double kSweepTolerance = 5e-13, kModeTolerance = 5e-11;
// After two sweeps the modes may exceed kModeTolerance by at most this factor; otherwise the block is given
// up.
constexpr double kEarlySlack = 10.0;
// Rounding error of a sweep, summed over the nodes, relative to the slips.
constexpr double kSweepRounding = 4e-15;
// Exact steps, and the growth of a small difference over them, after which an impact is left to the published
// integration: near stick, or if a cloth slip comes close to zero, rounding may decide the sign of a slip.
constexpr std::int64_t kMostExactSteps = 40;
constexpr double kMostGrowth = 10.0;
// Smallest distance of v_n and of the work from the values that end a phase, relative to the approach speed;
// in addition the published integration rounds v_n by up to half an ulp of the fastest speed in each step.
constexpr double kTie = 1e-9, kTieRounding = 0x1p-51;

template <int kSign>
class SummedMarch {
  public:
    // @param close  possible difference of v_n from that of the published integration
    SummedMarch(const Reduced& start, const ReducedConstants& constants, double close)
        : r(start),
          k(constants),
          scale(absolute(start.v_n)),
          tie_v(close),
          tie_W(close * absolute(start.v_n)) {}

    // Returns the number of steps, or -1 if the published integration is needed.
    std::int64_t run() {
        std::int64_t patience = 1, exact = 0;
        while (stop.goes_on(r.v_n)) {
            if (steps > k.limit || tied || enlarged > kMostGrowth || exact > kMostExactSteps) return -1;
            const FirstStep first = first_step();
            int level = widest(first);
            while (level >= 0 && !block(kSumTables[level], first)) --level;
            // Exact steps, more of them the longer no block is smooth.
            if (level >= 0)
                patience = 1;
            else
                exact += exact_steps(patience < kSmallestBlock ? patience *= 2 : patience);
        }
        return tied || enlarged > kMostGrowth ? -1 : steps;
    }

    Reduced r;

  private:
    ReducedConstants k;
    double scale, tie_v, tie_W;
    StopTest stop;
    std::int64_t steps = 0;
    bool tied = false;
    double enlarged = 1.0;

    // Upper bound of the factor by which the next step enlarges a difference of a slip: the step turns with
    // the slip's direction.
    double growth_of_step() const {
        const int pressed = r.z < 0.0;
        const double c = largest(absolute(r.x), absolute(r.z)),
                     u = largest(absolute(r.Ux[pressed]), absolute(r.Uy[pressed]));
        // Without a direction there is no friction.
        const double of_slip = c < kSlipCutoff ? 0.0 : 7.0 / c;
        const double of_cloth = u > k.u_floor ? 3.5 * k.mu_s[pressed] / u : 0.0;
        return 1.0 + k.mu_h * (of_slip + of_cloth);
    }

    // Makes exact steps until the impact ends or `count` are done; returns their number. Checks each for a
    // tie.
    std::int64_t exact_steps(std::int64_t count) {
        const std::int64_t before = steps;
        while (count-- > 0 && stop.goes_on(r.v_n)) {
            const bool compressing = stop.compressing;
            enlarged *= growth_of_step();
            reduced_steps<kSign>(r, stop, steps, 1, k);
            tied = tied || (compressing ? absolute(r.v_n) <= tie_v : absolute(stop.W - stop.W_f) <= tie_W);
        }
        return steps - before;
    }

    // The reciprocal lengths C and U and the rates at the present state. `cloth`: the pressed ball has
    // friction with the cloth.
    struct FirstStep {
        int pressed;
        bool slips, turns, cloth, rolls;
        double size, C, U, xi, t, q_x, q_y;
    };

    FirstStep first_step() const {
        FirstStep f{};
        f.pressed = r.z < 0.0;
        f.size = absolute(r.z);
        const double c = square_root(r.x * r.x + r.z * r.z), mu_s = k.mu_s[f.pressed];
        const double a = r.Ux[f.pressed], b = r.Uy[f.pressed], u = square_root(a * a + b * b);
        // The pressed ball rolls: its slip gets a direction in the next step.
        f.rolls = mu_s > 0.0 && !(u > k.u_floor);
        f.slips = !(c < kSlipCutoff);
        f.turns = f.slips && !(f.size < kSlipCutoff);
        f.cloth = f.turns && mu_s > 0.0 && !f.rolls;
        if (f.slips) {
            f.C = 1.0 / c;
            f.xi = k.mu_h * f.C * r.x;
        }
        if (f.turns) f.t = k.mu_h * f.C * f.size;
        if (f.cloth) {
            f.U = 1.0 / u;
            const double B = f.t * (mu_s * f.U);
            f.q_x = B * a;
            f.q_y = B * b;
        }
        return f;
    }

    // The widest block that eight nodes probably resolve; -1 if there is none.
    int widest(const FirstStep& f) const {
        constexpr double kKappa = 1.0 - 2.5 * kSign;
        if (f.rolls) return -1;
        int level = kBlockSizes - 1;
        if (!f.slips) return level;
        const double a = r.Ux[f.pressed], b = r.Uy[f.pressed], mu_s = k.mu_s[f.pressed];
        const double allowed = kModeTolerance * scale;
        const Path slip =
            path(r.x, f.size, f.q_x - 7.0 * f.xi, 2.5 * f.q_y - 5.0 * f.t, kLargestBlock * k.mu_h / allowed);
        const Path cloth = path(a, b, f.xi - kKappa * f.q_x, k.h - 2.5 * kSign * f.t - kKappa * f.q_y,
                                kLargestBlock * mu_s * f.t / allowed);
        alignas(64) constexpr double kSizes[kNodes] = {16, 32, 64, 128, 256, 512, 1024, 1024};
        alignas(64) double of_slip[kNodes], of_cloth[kNodes];
        const Eight slip_slack = slack(slip, load<8>(kSizes)), cloth_slack = slack(cloth, load<8>(kSizes));
        store(of_slip, slip_slack);
        store(of_cloth, cloth_slack);
        while (level >= 0 && !(of_slip[level] >= 0.0 && of_cloth[level] >= 0.0)) --level;
        return level;
    }

    struct Rates {
        Eight xi, t, q_x, q_y;
    };

    // y is close to 1/sqrt(square), with e = 1 - square y^2; corrected by the series of (1 - e)^(-1/2). The
    // error 35/128 e^4 is left to the next sweep.
    static Eight refined(Eight y, Eight e) { return y + (y * e) * (0.5 + e * (0.375 + e * 0.3125)); }

    // C and U are the reciprocal lengths of the previous sweep on entry, and of this sweep on return.
    Rates rates(Eight x, Eight z, Eight a, Eight b, double mu_s, Eight& C, Eight& U) const {
        const Eight c2 = x * x + z * z, u2 = a * a + b * b;
        const Eight e_c = 1.0 - c2 * (C * C), e_u = 1.0 - u2 * (U * U);
        if (all_below(e_c * e_c + e_u * e_u, 0.01)) [[likely]] {
            C = refined(C, e_c);
            U = refined(U, e_u);
        } else {
            C = 1.0 / square_root(c2);
            U = 1.0 / square_root(u2);
        }
        const Eight A = k.mu_h * C;
        const Eight t = A * z;
        const Eight B = t * (mu_s * U);
        return {A * x, t, B * a, B * b};
    }

    // start plus the columns weighted by F.
    static Eight combined(const double (&columns)[kNodes][kNodes], Eight start, Eight F) {
        // Through memory: a load broadcasts a number for free, unlike a move between register lanes.
        alignas(64) double at_node[kNodes];
        store(at_node, F);
        Eight even = start + at_node[0] * load<8>(columns[0]), odd = at_node[1] * load<8>(columns[1]);
#pragma GCC unroll 8
        for (int l = 2; l < kNodes; l += 2) {
            even = even + at_node[l] * load<8>(columns[l]);
            odd = odd + at_node[l + 1] * load<8>(columns[l + 1]);
        }
        return even + odd;
    }

    static double total(const double* weights, Eight F) {
        return sum(load<8>(weights) * F);
    }

    bool block(const SumTable& table, const FirstStep& first) {
        constexpr double kKappa = 1.0 - 2.5 * kSign;
        const int pressed = first.pressed;
        Rates f{};
        if (!first.slips) return advance(table, f, pressed);
        const double mu_s = first.cloth ? k.mu_s[pressed] : 0.0, z0 = first.turns ? first.size : 0.0;
        // Without cloth friction the cloth slip may be any number except zero.
        const double a0 = first.cloth ? r.Ux[pressed] : 1e3 * scale, b0 = first.cloth ? r.Uy[pressed] : 0.0;
        const Eight at = load<8>(table.at), push = k.h * at;
        // First guess: the rates of the first step at all nodes.
        Eight x = r.x + at * (first.q_x - 7.0 * first.xi);
        Eight z = z0 + at * (2.5 * first.q_y - 5.0 * first.t);
        Eight a = a0 + at * (first.xi - kKappa * first.q_x);
        Eight b = b0 + push - at * ((2.5 * kSign) * first.t + kKappa * first.q_y);
        Eight C = broadcast<8>(first.C), U = broadcast<8>(first.cloth ? first.U : 1.0 / a0);
        // The second term is the rounding error, the limit of any sweep.
        const double settled =
            kSweepTolerance * scale + kSweepRounding * (absolute(r.x) + z0 + absolute(a0) + absolute(b0));
        double change_before = scale;
        for (int sweep = 1;; ++sweep) {
            CAROM_LOOP_BEGIN("summed sweep");
            const Rates now = rates(x, z, a, b, mu_s, C, U);
            const Eight next_x = combined(table.sums, broadcast<8>(r.x), now.q_x - 7.0 * now.xi);
            const Eight next_z = combined(table.sums, broadcast<8>(z0), 2.5 * now.q_y - 5.0 * now.t);
            const Eight next_a = combined(table.sums, broadcast<8>(a0), now.xi - kKappa * now.q_x);
            const Eight next_b = combined(table.sums, b0 + push, (-2.5 * kSign) * now.t - kKappa * now.q_y);
            const double change = sum(absolute(next_x - x) + absolute(next_z - z) + absolute(next_a - a) +
                                      absolute(next_b - b));
            x = next_x;
            z = next_z;
            a = next_a;
            b = next_b;
            CAROM_LOOP_END("summed sweep");
            // Sweeps converge ever faster: the next change would be smaller by at least the same factor.
            const double left =
                sweep > 2 && change < change_before ? change * change / change_before : change;
            if (left <= settled) {
                f = now;
                break;
            }
            change_before = change;
            if (sweep == 2 && !resolved(table, now, kEarlySlack)) return false;
            if (!(sweep < kMostBlockSweeps)) return false;
        }
        if (!resolved(table, f, 1.0)) return false;
        // A change of the pressed side within the block appears at a node or at the end of the block.
        if (!all_below(-1.0 * z, 0x1p-1074)) return false;
        if (z0 + total(table.total, 2.5 * f.q_y - 5.0 * f.t) < 0.0) return false;
        return advance(table, f, pressed);
    }

    bool resolved(const SumTable& table, const Rates& f, double slack) const {
        // One mixture of the four rates represents them all; its weights are uneven, so that no symmetry
        // cancels.
        const Eight F = (f.xi + 0.7 * f.t) + (1.3 * f.q_x - 0.6 * f.q_y);
        const double missing = absolute(total(table.mode7, F)) + 0.1 * absolute(total(table.mode6, F));
        return missing * table.steps <= slack * kModeTolerance * scale;
    }

    // Advances by the block, or by the part of it that the impact needs.
    bool advance(const SumTable& table, const Rates& f, int pressed) {
        const double K = table.steps, h = k.h, v0 = r.v_n;
        const double Q = total(table.total, f.q_y), v_end = v0 + 2.0 * h * K - Q;
        // The sum of (v(m) + v(m+1)) / 2 over the block.
        const double V = K * v0 + h * K * (K - 1.0) - total(table.double_total, f.q_y) + 0.5 * (v_end - v0);
        const bool crosses = stop.compressing && v_end > 0.0;
        tied = tied ||
               (stop.compressing ? absolute(v_end) <= tie_v : absolute(stop.W + h * V - stop.W_f) <= tie_W);
        if (!crosses && (stop.compressing || stop.W + h * V < stop.W_f)) {
            stop.W += stop.compressing ? -h * V : h * V;
            take(f, load<8>(table.total), K, pressed);
            steps += static_cast<std::int64_t>(K);
            return true;
        }
        const Profile at(table, f.q_y, v0, h);
        double from = 0.0, v_from = v0, V_from = 0.0;
        if (stop.compressing) {
            // The first step after which v_n > 0: a secant, because v grows almost linearly, and one
            // correction.
            const double slope = (v_end - v0) / K;
            double t = -v0 / slope;
            t -= at.v(t) / slope;
            from = whole(t + 1.0, K);
            double v_before = at.v(from - 1.0);
            v_from = at.v(from);
            if (!(v_from > 0.0) || (v_before > 0.0 && from > 1.0)) {
                from = first_whole(t, K, [&](double m) { return at.v(m) > 0.0; });
                if (from < 0.0) return false;
                v_before = at.v(from - 1.0);
                v_from = at.v(from);
            }
            tied = tied || absolute(v_before) <= tie_v || absolute(v_from) <= tie_v;
            const double last_step = 0.5 * (v_before + v_from), V_before = at.V(from - 1.0, v_before);
            V_from = V_before + last_step;
            stop.W += h * (absolute(last_step) - V_before);
            stop.W_f = k.work_ratio * stop.W;
            stop.compressing = false;
        }
        double last = K;
        if (stop.W >= stop.W_f) {  // without restitution the impact ends with compression
            last = from;
        } else if (stop.W + h * (V - V_from) >= stop.W_f) {
            // The first step that reaches the work: treats v as linear, then makes one Newton step.
            const double missing = (stop.W_f - stop.W) / h, growth = (v_end - v_from) / (K - from + 1e-300);
            const double root = square_root(v_from * v_from + 2.0 * growth * missing);
            double t = from + 2.0 * missing / (root + v_from);
            const double v_there = at.v(t);
            if (v_there > 0.0) t -= (at.V(t, v_there) - V_from - missing) / v_there;
            last = whole(t + 1.0, K);
            const double v_last = at.v(last), done = at.V(last, v_last) - V_from;
            const double done_before = done - 0.5 * (at.v(last - 1.0) + v_last);
            if (!(done >= missing && (done_before < missing || last - 1.0 < from) && last >= from))
                last = first_whole(
                    t, K, [&](double m) { return m >= from && at.V(m, at.v(m)) - V_from >= missing; });
            if (last < 0.0) last = K;
            const double v_at_last = at.v(last), over = at.V(last, v_at_last) - V_from - missing;
            const double short_of = over - 0.5 * (at.v(last - 1.0) + v_at_last);
            tied = tied || h * absolute(over) <= tie_W || h * absolute(short_of) <= tie_W;
            stop.W = stop.W_f;
        } else {
            stop.W += h * (V - V_from);
        }
        // The weight of each node's rate in the sum at `last`.
        const double theta = table.theta0 + table.theta_step * last;
        alignas(64) double powers[kNodes], weight[kNodes];
        powers[0] = 1.0;
        for (int i = 1; i < kNodes; ++i) powers[i] = powers[i - 1] * theta;
        const double highest = powers[kNodes - 1] * theta;
        for (int l = 0; l < kNodes; ++l)
            weight[l] = total(table.once_low[l], load<8>(powers)) + highest * table.once_high[0][l];
        const Eight weights = load<8>(weight);
        take(f, weights, last, pressed);
        steps += static_cast<std::int64_t>(last);
        return true;
    }

    // v_n and the sum of (v(m) + v(m+1)) / 2 over the steps of a block, at any t.
    class Profile {
      public:
        Profile(const SumTable& t, Eight q_y, double start, double step) : table(t), v0(start), h(step) {
            const Eight once_low = combined(table.once_low, broadcast<8>(0.0), q_y);
            const Eight twice_low = combined(table.twice_low, broadcast<8>(0.0), q_y);
            store(once, once_low);
            store(twice, twice_low);
            once[kNodes] = total(table.once_high[0], q_y);
            twice[kNodes] = total(table.twice_high[0], q_y);
            twice[kNodes + 1] = total(table.twice_high[1], q_y);
        }
        double v(double t) const { return v0 + 2.0 * h * t - value<kNodes>(once, theta(t)); }
        double V(double t, double v_t) const {
            return t * v0 + h * t * (t - 1.0) - value<kNodes + 1>(twice, theta(t)) + 0.5 * (v_t - v0);
        }

      private:
        const SumTable& table;
        double v0, h, once[kNodes + 1], twice[kNodes + 2];
        double theta(double t) const { return table.theta0 + table.theta_step * t; }
    };

    // t rounded down to a whole number in 1 .. K.
    static double whole(double t, double K) {
        return t > 1.0 ? (t < K ? static_cast<double>(static_cast<std::int64_t>(t)) : K) : 1.0;
    }

    // The first whole t in 1 .. K at which `reached` holds, searched from the guess; -1 if there is none.
    template <class Reached>
    static double first_whole(double guess, double K, Reached reached) {
        double t = whole(guess, K);
        while (t > 1.0 && reached(t - 1.0)) t -= 1.0;
        while (t < K && !reached(t)) t += 1.0;
        return reached(t) ? t : -1.0;
    }

    // Adds the weighted sums of the rates over `count` steps to the state.
    void take(const Rates& f, Eight weights, double count, int pressed) {
        constexpr double kKappa = 1.0 - 2.5 * kSign;
        const double xi = sum(weights * f.xi), t = sum(weights * f.t);
        const double q_x = sum(weights * f.q_x), q_y = sum(weights * f.q_y), p = count * k.h;
        const int other = 1 - pressed;
        const double size = absolute(r.z) - 5.0 * t + 2.5 * q_y;
        r.x += q_x - 7.0 * xi;
        r.z = pressed ? -size : size;
        r.v_n += 2.0 * p - q_y;
        r.Ux[pressed] += xi - kKappa * q_x;
        r.Uy[pressed] += p - 2.5 * kSign * t - kKappa * q_y;
        r.Ux[other] += xi;
        r.Uy[other] += p + 2.5 * kSign * t;
    }
};

struct Summed {
    static constexpr int kFewestSubsteps = 100;  // with fewer, the steps cost no more than the sums

    // Larger frictions are left to the published integration. With the published sign the cloth adds to the
    // slip, and beyond these frictions the equations themselves amplify a difference without limit.
    static bool usual(const ImpactParams& p, int sign) {
        const double mu_s = largest(p.mu_s1, p.mu_s2);
        return sign > 0 ? p.mu_b <= 0.2 && mu_s <= 0.5 : p.mu_b <= 1.0 && mu_s <= 1.0;
    }

    // Returns the number of steps, or -1 if the published integration is needed; the state is then unchanged.
    template <int kSign>
    static std::int64_t loop(FrameState& s, const ImpactParams& p, int n) {
        if (n < kFewestSubsteps || !usual(p, kSign)) return -1;
        ReducedConstants k = reduced_constants<kSign>(s, p, n);
        // Without friction between the balls the cloth has no effect, and its slips must not limit the
        // blocks.
        if (p.mu_b == 0.0) k.mu_s[0] = k.mu_s[1] = 0.0;
        const Reduced start = reduce<kSign>(s, p.R);
        SummedMarch<kSign> march(start, k,
                                 kTie * absolute(start.v_n) + kTieRounding * n * sum_of_speeds(s, p.R));
        const std::int64_t steps = march.run();
        if (steps >= 0) expand(s, sums_between<kSign>(start, march.r, static_cast<double>(steps) * k.h), p.R);
        return steps;
    }
};

}  // namespace
}  // namespace carom::kernel
