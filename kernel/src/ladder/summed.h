// Past the march: its result without its steps. The Euler march is the sequence y(m+1) = y(m) + h f(y(m)); over a block of
// K steps the rates are a smooth function of m, so a polynomial through eight nodes holds them all, and their sums over
// consecutive m are exact (sum_tables.h). The nodes are found by fixed-point sweeps, eight lanes at once. It is the Euler
// sequence that is summed, not the continuous impact: step count, last step and discretisation error are the march's own.
// Where rates are not smooth (a side that flips, a slip near zero, a ball that starts rolling) exact steps are taken.
#pragma once

#include "reduced.h"
#include "sum_tables.h"
#include "vector8.h"

namespace carom::kernel {
namespace {

constexpr int kMostSweeps = 24;
// Change of a node per sweep, and highest modes of the rates, both relative to the approach speed.
constexpr double kSweepTolerance = 4e-15, kModeTolerance = 2e-13;

template <int kSign>
class SummedMarch {
  public:
    SummedMarch(const Reduced& start, const ReducedConstants& constants)
        : r(start), k(constants), scale(absolute(start.v_n)) {}

    long run() {
        int level = kBlockSizes - 1;
        while (stop.goes_on(r.v_n)) {
            if (steps > k.limit) return -1;
            level = level < widest() ? level : widest();
            while (level >= 0 && !block(kSumTables[level])) --level;
            if (level < 0) reduced_steps<kSign>(r, stop, steps, kSmallestBlock, k);
            ++level;
            if (level > kBlockSizes - 1) level = kBlockSizes - 1;
        }
        return steps;
    }

    Reduced r;

  private:
    ReducedConstants k;
    double scale;
    StopTest stop;
    long steps = 0;

    // The widest block in which neither slip can change by more than about half.
    int widest() const {
        const int pressed = r.z < 0.0;
        const double c = square_root(r.x * r.x + r.z * r.z);
        const double U = square_root(r.Ux[pressed] * r.Ux[pressed] + r.Uy[pressed] * r.Uy[pressed]);
        double most = 2048.0;
        if (most * k.mu_h * 7.0 > 1.4 * c) most = 1.4 * c / (7.0 * k.mu_h);
        if (k.mu_s[pressed] > 0.0 && r.Uy[pressed] < 0.0 && most * k.h > 2.0 * U) most = 2.0 * U / k.h;
        if (5.0 * k.mu_h * most > 2.0 * absolute(r.z) && r.z != 0.0) {
            // |z| keeps its sign while |z| / c does not vanish; a sixteenth of c is far from any flip
            if (absolute(r.z) < 0.02 * c) return -1;
        }
        int level = -1;
        while (level < kBlockSizes - 1 && (kSmallestBlock << (level + 1)) <= most) ++level;
        return level;
    }

    struct Rates {
        Vector8 xi, t, q_x, q_y;
    };

    Rates rates(Vector8 x, Vector8 z, Vector8 a, Vector8 b, double mu_s) const {
        const Vector8 c = square_root8(x * x + z * z), u = square_root8(a * a + b * b);
        const Vector8 A = k.mu_h / c;
        const Vector8 t = A * z;
        const Vector8 B = mu_s * t / u;
        return {A * x, t, B * a, B * b};
    }

    static Vector8 summed(const SumTable& table, Vector8 start, Vector8 F) {
        Vector8 even = start, odd = F[1] * load8(table.sums[1]);
        for (int l = 0; l < kNodes; l += 2) even += F[l] * load8(table.sums[l]);
        for (int l = 3; l < kNodes; l += 2) odd += F[l] * load8(table.sums[l]);
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
            f = rates(x, z, a, b, mu_s);
            const Vector8 next_x = summed(table, all8(r.x), f.q_x - 7.0 * f.xi);
            const Vector8 next_z = summed(table, all8(z0), 2.5 * f.q_y - 5.0 * f.t);
            const Vector8 next_a = summed(table, all8(a0), f.xi - kKappa * f.q_x);
            const Vector8 next_b = summed(table, b0 + push, (-2.5 * kSign) * f.t - kKappa * f.q_y);
            const double change = sum8(absolute8(next_x - x) + absolute8(next_z - z) + absolute8(next_a - a) + absolute8(next_b - b));
            x = next_x;
            z = next_z;
            a = next_a;
            b = next_b;
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
        const auto missing = [&](Vector8 F) {
            return absolute(total(table.mode7, F)) + 0.1 * absolute(total(table.mode6, F));
        };
        return (missing(f.xi) + missing(f.t) + missing(f.q_x) + missing(f.q_y)) * table.steps <=
               slack * kModeTolerance * scale;
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
        for (int i = 0; i <= kNodes; ++i) once[i] = total(table.polynomial[i], f.q_y);
        for (int i = 0; i <= kNodes + 1; ++i) twice[i] = total(table.double_polynomial[i], f.q_y);
        const auto theta = [&](double t) { return table.theta0 + table.theta_step * t; };
        const auto v_at = [&](double t) { return v0 + 2.0 * h * t - evaluate(once, kNodes, theta(t)); };
        const auto V_at = [&](double t) {
            return t * v0 + h * t * (t - 1.0) - evaluate(twice, kNodes + 1, theta(t)) + 0.5 * (v_at(t) - v0);
        };
        double from = 0.0, V_from = 0.0;
        if (stop.compressing) {
            // The first step after which v_n > 0: v grows by about 2 h a step, so Newton with that slope lands beside it.
            double t = -v0 / (2.0 * h);
            for (int i = 0; i < 6; ++i) t -= v_at(t) / (2.0 * h);
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
        Vector8 weights = load8(table.polynomial[kNodes]);
        for (int i = kNodes - 1; i >= 0; --i) weights = weights * theta(last) + load8(table.polynomial[i]);
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
