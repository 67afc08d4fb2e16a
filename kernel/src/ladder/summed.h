// Past the march: its result without its steps. The Euler march is the sequence y(m+1) = y(m) + h f(y(m));
// over a block of K steps the rates are a smooth function of m, so a polynomial through eight nodes holds
// them all, and their sums over consecutive m are exact (sum_tables.h). The nodes are found by fixed-point
// sweeps, eight lanes at once. It is the Euler sequence that is summed, not the continuous impact: step
// count, last step and discretisation error are the march's own. Where rates are not smooth (a side that
// flips, a slip near zero, a ball that starts rolling) exact steps are taken.
#pragma once

#include "loop_marks.h"
#include "reduced.h"
#include "sum_tables.h"
#include "vector8.h"

namespace carom::kernel {
namespace {

constexpr int kMostSweeps = 24;
// Change of a node per sweep, and highest modes of the rates, both relative to the approach speed.
constexpr double kSweepTolerance = 3e-11, kModeTolerance = 1e-9;

// How far the poles are kept, relative to the estimate.
constexpr double kPoleMargin = 0.5;

template <int kSign>
class SummedMarch {
  public:
    SummedMarch(const Reduced& start, const ReducedConstants& constants)
        : r(start), k(constants), scale(absolute(start.v_n)) {}

    long run() {
        long patience = 1;
        while (stop.goes_on(r.v_n)) {
            if (steps > k.limit) return -1;
            int level = widest();
            while (level >= 0 && !block(kSumTables[level])) --level;
            // Exact steps, more of them the longer nothing smooth comes.
            if (level >= 0)
                patience = 1;
            else
                reduced_steps<kSign>(r, stop, steps, patience < kSmallestBlock ? patience *= 2 : patience, k);
        }
        return steps;
    }

    Reduced r;

  private:
    ReducedConstants k;
    double scale;
    StopTest stop;
    long steps = 0;

    // A pressed ball that rolls: its slip gets a direction with the next step.
    bool rolls() const {
        const int pressed = r.z < 0.0;
        const double a = r.Ux[pressed], b = r.Uy[pressed];
        return k.mu_s[pressed] > 0.0 && !(square_root(a * a + b * b) > k.u_floor);
    }

    // How smooth the direction of a vector is along a block of K steps from (a, b) at (da, db) a step: it has
    // poles where the length vanishes, at complex t. With the path taken as straight these lie on the ellipse
    // around the block of which the sum of half axes is rho, and modes fall as rho^-n. `amplitude` is what
    // the direction can do to a result.
    struct Path {
        double a, b, da, db, needed;  // needed: (rho + 1/rho) / 2
    };

    Path path(double a, double b, double da, double db, double amplitude) const {
        const double sine =
            absolute(a * db - b * da) / (square_root((a * a + b * b) * (da * da + db * db)) + 1e-300);
        const double ratio = amplitude * sine / (kModeTolerance * scale);
        const double rho = 1.0 + kPoleMargin * square_root(square_root(square_root(ratio)));
        return {a, b, da, db, 0.5 * (rho + 1.0 / rho)};
    }

    static bool smooth(const Path& p, double K) {
        const double a = p.a + K * p.da, b = p.b + K * p.db;
        return square_root(p.a * p.a + p.b * p.b) + square_root(a * a + b * b) >=
               p.needed * K * square_root(p.da * p.da + p.db * p.db);
    }

    // The widest block that promises to be resolved; -1 if none does.
    int widest() const {
        constexpr double kKappa = 1.0 - 2.5 * kSign;
        if (rolls()) return -1;
        const int pressed = r.z < 0.0;
        const double c = square_root(r.x * r.x + r.z * r.z), size = absolute(r.z), mu_s = k.mu_s[pressed];
        int level = kBlockSizes - 1;
        if (c < kSlipCutoff) return level;
        const double a = r.Ux[pressed], b = r.Uy[pressed], u = square_root(a * a + b * b);
        const double xi = k.mu_h * r.x / c, t = k.mu_h * size / c;
        const double B = u > 0.0 ? mu_s * t / u : 0.0, q_x = B * a, q_y = B * b;
        const Path slip = path(r.x, size, q_x - 7.0 * xi, 2.5 * q_y - 5.0 * t, kLargestBlock * k.mu_h);
        const Path cloth =
            path(a, b, xi - kKappa * q_x, k.h - 2.5 * kSign * t - kKappa * q_y, kLargestBlock * mu_s * t);
        while (level >= 0 &&
               !(smooth(slip, kSmallestBlock << level) && smooth(cloth, kSmallestBlock << level)))
            --level;
        return level;
    }

    struct Rates {
        Vector8 xi, t, q_x, q_y;
    };

    Rates rates(Vector8 x, Vector8 z, Vector8 a, Vector8 b, double mu_s) const {
        const Vector8 c = square_root8(x * x + z * z), u = square_root8(a * a + b * b);
        const Vector8 A = k.mu_h / c;
        const Vector8 t = A * z;
        const Vector8 B = t * (mu_s / u);
        return {A * x, t, B * a, B * b};
    }

    // start + the columns weighted by F.
    static Vector8 combined(const double (&columns)[kNodes][kNodes], Vector8 start, Vector8 F) {
        // Through memory: loads broadcast for nothing, lanes moved in registers do not.
        alignas(64) double at_node[kNodes];
        __builtin_memcpy(at_node, &F, sizeof F);
        Vector8 even = start, odd = at_node[1] * load8(columns[1]);
        for (int l = 0; l < kNodes; l += 2) even += at_node[l] * load8(columns[l]);
        for (int l = 3; l < kNodes; l += 2) odd += at_node[l] * load8(columns[l]);
        return even + odd;
    }

    static double total(const double* weights, Vector8 F) { return sum8(load8(weights) * F); }

    bool block(const SumTable& table) {
        constexpr double kKappa = 1.0 - 2.5 * kSign;
        const int pressed = r.z < 0.0;
        const bool slips = !(square_root(r.x * r.x + r.z * r.z) < kSlipCutoff);
        const bool turns = slips && !(absolute(r.z) < kSlipCutoff), cloth = turns && k.mu_s[pressed] > 0.0;
        Rates f{};
        if (!slips) return advance(table, f, pressed);
        const double mu_s = cloth ? k.mu_s[pressed] : 0.0, z0 = turns ? absolute(r.z) : 0.0;
        // Where the cloth does nothing its slip must only not be zero.
        const double a0 = cloth ? r.Ux[pressed] : 1e3 * scale, b0 = cloth ? r.Uy[pressed] : 0.0;
        const Vector8 at = load8(table.at), push = k.h * at;
        // First guess: the rates of the first step throughout.
        const Rates f0 = rates(all8(r.x), all8(z0), all8(a0), all8(b0), mu_s);
        Vector8 x = r.x + at * (f0.q_x - 7.0 * f0.xi), z = z0 + at * (2.5 * f0.q_y - 5.0 * f0.t);
        Vector8 a = a0 + at * (f0.xi - kKappa * f0.q_x);
        Vector8 b = b0 + push - at * ((2.5 * kSign) * f0.t + kKappa * f0.q_y);
        for (int sweep = 1;; ++sweep) {
            CAROM_LOOP_BEGIN("summed sweep");
            f = rates(x, z, a, b, mu_s);
            const Vector8 next_x = combined(table.sums, all8(r.x), f.q_x - 7.0 * f.xi);
            const Vector8 next_z = combined(table.sums, all8(z0), 2.5 * f.q_y - 5.0 * f.t);
            const Vector8 next_a = combined(table.sums, all8(a0), f.xi - kKappa * f.q_x);
            const Vector8 next_b = combined(table.sums, b0 + push, (-2.5 * kSign) * f.t - kKappa * f.q_y);
            const double change = sum8(absolute8(next_x - x) + absolute8(next_z - z) + absolute8(next_a - a) +
                                       absolute8(next_b - b));
            x = next_x;
            z = next_z;
            a = next_a;
            b = next_b;
            CAROM_LOOP_END("summed sweep");
            if (change <= kSweepTolerance * scale) break;
            if (sweep == 2 && !resolved(table, f, 1e3)) return false;
            if (!(sweep < kMostSweeps)) return false;
        }
        if (!resolved(table, f, 1.0)) return false;
        // A side that flips within the block shows at a node or at its end.
        for (int i = 0; i < kNodes; ++i)
            if (z[i] < 0.0) return false;
        if (z0 + total(table.total, 2.5 * f.q_y - 5.0 * f.t) < 0.0) return false;
        return advance(table, f, pressed);
    }

    bool resolved(const SumTable& table, const Rates& f, double slack) const {
        // One mixture of the four stands for all: uneven weights, so that no symmetry cancels.
        const Vector8 F = (f.xi + 0.7 * f.t) + (1.3 * f.q_x - 0.6 * f.q_y);
        const double missing = absolute(total(table.mode7, F)) + 0.1 * absolute(total(table.mode6, F));
        return missing * table.steps <= slack * kModeTolerance * scale;
    }

    // Takes the block, or as much of it as the march needs.
    bool advance(const SumTable& table, const Rates& f, int pressed) {
        const double K = table.steps, h = k.h, v0 = r.v_n;
        const double Q = total(table.total, f.q_y), v_end = v0 + 2.0 * h * K - Q;
        // The sum of (v(m) + v(m+1)) / 2 over the block.
        const double V = K * v0 + h * K * (K - 1.0) - total(table.double_total, f.q_y) + 0.5 * (v_end - v0);
        const bool crosses = stop.compressing && v_end > 0.0;
        if (!crosses && (stop.compressing || stop.W + h * V < stop.W_f)) {
            stop.W += stop.compressing ? -h * V : h * V;
            take(f, load8(table.total), K, pressed);
            steps += static_cast<long>(K);
            return true;
        }
        double once[kNodes + 1], twice[kNodes + 2];
        const Vector8 once_low = combined(table.once_low, Vector8{}, f.q_y);
        const Vector8 twice_low = combined(table.twice_low, Vector8{}, f.q_y);
        __builtin_memcpy(once, &once_low, sizeof once_low);
        __builtin_memcpy(twice, &twice_low, sizeof twice_low);
        once[kNodes] = total(table.once_high[0], f.q_y);
        twice[kNodes] = total(table.twice_high[0], f.q_y);
        twice[kNodes + 1] = total(table.twice_high[1], f.q_y);
        const auto theta = [&](double t) { return table.theta0 + table.theta_step * t; };
        const auto v_at = [&](double t) { return v0 + 2.0 * h * t - evaluate(once, kNodes, theta(t)); };
        const auto V_at = [&](double t) {
            return t * v0 + h * t * (t - 1.0) - evaluate(twice, kNodes + 1, theta(t)) + 0.5 * (v_at(t) - v0);
        };
        double from = 0.0, V_from = 0.0;
        if (stop.compressing) {
            // The first step after which v_n > 0: v grows by about 2 h a step, so Newton with that slope
            // lands beside it.
            double t = -v0 / (2.0 * h);
            for (int i = 0; i < 3; ++i) t -= v_at(t) / (2.0 * h);
            from = first(t, K, [&](double m) { return v_at(m) > 0.0; });
            if (from < 0.0) return false;
            const double V_before = V_at(from - 1.0);
            V_from = V_at(from);
            stop.W += h * (-V_before + absolute(V_from - V_before));
            stop.W_f = k.work_ratio * stop.W;
            stop.compressing = false;
        }
        double last = K;
        if (stop.W + h * (V_at(K) - V_from) >= stop.W_f) {
            const double missing = (stop.W_f - stop.W) / h;
            double t = K;
            for (int i = 0; i < 12; ++i) {
                const double v = v_at(t);
                if (!(v > 0.0)) break;
                const double move = (V_at(t) - V_from - missing) / v;
                t -= move;
                if (absolute(move) < 0.01) break;
            }
            last = first(t, K, [&](double m) { return m >= from && V_at(m) - V_from >= missing; });
            if (last < 0.0) last = from;
        }
        stop.W += h * (V_at(last) - V_from);
        // What each node's rate adds to the sum at `last`.
        alignas(64) double powers[kNodes], weight[kNodes];
        powers[0] = 1.0;
        for (int i = 1; i < kNodes; ++i) powers[i] = powers[i - 1] * theta(last);
        const double highest = powers[kNodes - 1] * theta(last);
        for (int l = 0; l < kNodes; ++l)
            weight[l] = total(table.once_low[l], load8(powers)) + highest * table.once_high[0][l];
        const Vector8 weights = load8(weight);
        take(f, weights, last, pressed);
        steps += static_cast<long>(last);
        return true;
    }

    // The first whole t in 1 .. K at which `reached` holds, near the guess; -1 if none is.
    template <class Reached>
    static double first(double guess, double K, Reached reached) {
        double t = guess > 1.0 ? (guess < K ? static_cast<double>(static_cast<long>(guess)) : K) : 1.0;
        while (t > 1.0 && reached(t - 1.0)) t -= 1.0;
        while (t < K && !reached(t)) t += 1.0;
        return reached(t) ? t : -1.0;
    }

    void take(const Rates& f, Vector8 weights, double count, int pressed) {
        constexpr double kKappa = 1.0 - 2.5 * kSign;
        const double xi = sum8(weights * f.xi), t = sum8(weights * f.t);
        const double q_x = sum8(weights * f.q_x), q_y = sum8(weights * f.q_y), p = count * k.h;
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
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        const ReducedConstants k = reduced_constants<kSign>(s, p, n);
        const Reduced start = reduce<kSign>(s, p.R);
        SummedMarch<kSign> march(start, k);
        const long steps = march.run();
        if (steps < 0) return -1;
        expand(s, sums_between<kSign>(start, march.r, static_cast<double>(steps) * k.h), p.R);
        return steps;
    }
};

}  // namespace
}  // namespace carom::kernel
