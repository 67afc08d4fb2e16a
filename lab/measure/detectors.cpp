// Experiment E5: compares methods that find the time at which two balls meet (a quartic) by time per pair,
// missed and false contacts, and gap between the balls at the returned time. The reference is a derivative
// cascade in __float128. Usage: carom_detectors [pairs of each kind, default 20000]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <unsupported/Eigen/Polynomials>
#include <vector>

#include "base/clock.h"
#include "support/graze_oracle.h"
#include "support/graze_pairs.h"

namespace carom::tools {
namespace {

using namespace test;
constexpr double kReach = 2.0 * 0.028575;  // [m] two radii of pool balls

struct Pair {
    Path one, two;
    double horizon;
    FirstMeeting truth;
};

/// Coefficients of |difference of positions|^2 - reach^2, lowest power first.
std::array<double, 5> quartic(const Pair& pair) {
    const Vec2 r = pair.two.r - pair.one.r, v = pair.two.v - pair.one.v, a = pair.two.a - pair.one.a;
    return {r.dot(r) - kReach * kReach, 2.0 * r.dot(v), v.dot(v) + r.dot(a), v.dot(a), 0.25 * a.dot(a)};
}

/// The first real root in (0, T] of complex roots; as usual, a root with a small imaginary part counts as
/// real.
template <typename Roots>
double first_real(const Roots& roots, int count, double T) {
    double first = kNever;
    for (int i = 0; i < count; ++i) {
        const std::complex<double> z = roots[i];
        if (std::abs(z.imag()) <= 1e-7 * std::max(1.0, std::abs(z.real())) && z.real() > 0.0 && z.real() <= T)
            first = std::min(first, z.real());
    }
    return first;
}

double by_eigenvalues(const Pair& pair) {
    const std::array<double, 5> c = quartic(pair);
    int degree = 4;
    while (degree > 0 && c[degree] == 0.0) --degree;
    if (degree == 0) return kNever;
    Eigen::PolynomialSolver<double, Eigen::Dynamic> solver(
        Eigen::Map<const Eigen::VectorXd>(c.data(), degree + 1));
    return first_real(solver.roots(), degree, pair.horizon);
}

/// Ferrari's formula as printed in textbooks.
double by_ferrari(const Pair& pair) {
    using C = std::complex<double>;
    const std::array<double, 5> k = quartic(pair);
    if (k[4] == 0.0) {
        const C root = std::sqrt(C(k[1] * k[1] - 4.0 * k[2] * k[0]));
        const C z[2] = {(-k[1] + root) / (2.0 * k[2]), (-k[1] - root) / (2.0 * k[2])};
        return first_real(z, 2, pair.horizon);
    }
    const double a = k[3] / k[4], b = k[2] / k[4], c = k[1] / k[4], d = k[0] / k[4];
    const double alpha = b - 0.375 * a * a, beta = a * a * a / 8.0 - 0.5 * a * b + c,
                 gamma = -3.0 / 256.0 * a * a * a * a + a * a * b / 16.0 - 0.25 * a * c + d;
    const double p = -alpha * alpha / 12.0 - gamma,
                 q = -alpha * alpha * alpha / 108.0 + alpha * gamma / 3.0 - beta * beta / 8.0;
    const C u = std::pow(-0.5 * q + std::sqrt(C(0.25 * q * q + p * p * p / 27.0)), 1.0 / 3.0);
    const C y = -5.0 / 6.0 * alpha + (u == 0.0 ? -std::cbrt(q) : u - p / (3.0 * u));
    const C w = std::sqrt(alpha + 2.0 * y);
    C z[4];
    for (int i = 0; i < 4; ++i) {
        const double s = i < 2 ? 1.0 : -1.0, t = i % 2 ? -1.0 : 1.0;
        z[i] = -0.25 * a + 0.5 * (s * w + t * std::sqrt(-(3.0 * alpha + 2.0 * y + s * 2.0 * beta / w)));
    }
    return first_real(z, 4, pair.horizon);
}

double by_bracketing(const Pair& pair) {
    return time_to_ball(pair.one, pair.two, kReach);
}

/// Random pairs, or pairs that pass within 1e-16 m to 1e-4 m of touching.
std::vector<Pair> pairs(int count, bool grazing) {
    Generator rng(grazing ? 10 : 11);
    std::vector<Pair> list;
    while (static_cast<int>(list.size()) < count) {
        constexpr int kKinds[][2] = {{1, 0}, {2, 0}, {1, 1}, {2, 1}, {2, 2}};
        const int* kind = kKinds[list.size() % 5];
        Pair pair{random_path(rng, kind[0], 0.05 * std::pow(160.0, rng.uniform())),
                  random_path(rng, kind[1], 0.05 * std::pow(160.0, rng.uniform())),
                  0.0,
                  {}};
        pair.one.r = Vec2{rng.uniform(0.0, 1.0), rng.uniform(0.0, 2.0)};
        pair.horizon = std::min({pair.one.horizon, pair.two.horizon, 20.0});
        pair.one.horizon = std::min(pair.one.horizon, 20.0);
        const double side = grazing && rng.next() % 2 == 0 ? -1.0 : 1.0;
        const double depth =
            grazing ? side * std::pow(10.0, rng.uniform(-16.0, -4.0)) : rng.uniform(-1.0, kReach);
        set_to_graze(pair.one, pair.two, rng.uniform(0.05, 0.9) * pair.horizon, depth, kReach, rng);
        if (length(pair.two.r - pair.one.r) <= kReach) continue;
        pair.truth = GrazeOracle(pair.one.r, pair.one.v, pair.one.a, pair.two.r, pair.two.v, pair.two.a,
                                 kReach, pair.horizon)
                         .meet();
        list.push_back(pair);
    }
    return list;
}

struct Verdict {
    int missed = 0, missed_deep = 0, made_up = 0, made_up_far = 0;
    double worst_gap = 0.0, worst_time = 0.0;
};

/// [m] An overlap or distance larger than this is not due to rounding.
constexpr double kDeep = 1e-9;

Verdict judge(double (*find)(const Pair&), const std::vector<Pair>& list) {
    Verdict v;
    for (const Pair& pair : list) {
        const double t = find(pair);
        const bool hit = t<kNever, deep = std::abs(pair.truth.depth)> kDeep;
        if (pair.truth.hit && !hit) {
            ++v.missed;
            v.missed_deep += deep ? 1 : 0;
        }
        if (!pair.truth.hit && hit) {
            ++v.made_up;
            v.made_up_far += deep ? 1 : 0;
        }
        if (!pair.truth.hit || !hit) continue;
        const Vec2 r =
            (pair.two.r - pair.one.r) + t * ((pair.two.v - pair.one.v) + 0.5 * t * (pair.two.a - pair.one.a));
        v.worst_gap = std::max(v.worst_gap, std::abs(length(r) - kReach));
        v.worst_time = std::max(v.worst_time, std::abs(t - pair.truth.time));
    }
    return v;
}

int run(int count) {
    const struct {
        const char* name;
        double (*find)(const Pair&);
    } kMethods[] = {{"bracketing (this engine)", &by_bracketing},
                    {"eigenvalues of the companion matrix (Eigen)", &by_eigenvalues},
                    {"Ferrari's formula", &by_ferrari}};
    fmt::print(
        "| pairs | method | ns min, median | missed (deeper than 1 nm) | made up (further than 1 nm) | worst "
        "gap "
        "(m) | worst time (s) |\n|---|---|---|---|---|---|---|\n");
    for (const bool grazing : {false, true}) {
        const std::vector<Pair> list = pairs(count, grazing);
        double keep = 0.0;
        const auto samples = interleaved("detectors:", 3, 7, [&](std::size_t i) {
            const double start = thread_ns();
            for (const Pair& pair : list) keep += kMethods[i].find(pair) < kNever ? 1.0 : 0.0;
            return (thread_ns() - start) / static_cast<double>(list.size());
        });
        if (keep < 0.0) return 1;  // uses the results, so that the compiler keeps the calls
        for (std::size_t i = 0; i < 3; ++i) {
            const Verdict v = judge(kMethods[i].find, list);
            fmt::print("| {} | {} | {:.0f}, {:.0f} | {} ({}) | {} ({}) | {:.0e} | {:.0e} |\n",
                       grazing ? "grazing" : "random", kMethods[i].name, minimum(samples[i]),
                       median(samples[i]), v.missed, v.missed_deep, v.made_up, v.made_up_far, v.worst_gap,
                       v.worst_time);
        }
    }
    return 0;
}

}  // namespace
}  // namespace carom::tools

int main(int argc, char** argv) {
    const int count = argc > 1 ? std::atoi(argv[1]) : 20000;
    if (argc > 2 || count < 1) {
        fmt::print(stderr, "usage: carom_detectors [pairs of each kind, at least 1]\n");
        return 2;
    }
    return carom::tools::run(count);
}
