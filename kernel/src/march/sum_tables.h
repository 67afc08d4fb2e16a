// Exact sums of polynomials over consecutive steps. A block has K steps, t = 0 .. K. A rate F is represented
// by its values at eight Gauss-Legendre nodes, that is, by the polynomial of degree 7 through them. The sum
// over m < t of F(m) is then a polynomial of degree 8 in t, and the sum of these sums one of degree 9: the
// only error is that of the interpolation.
#pragma once

namespace carom::kernel {
namespace {

constexpr int kNodes = 8;
constexpr double kGaussNodes[kNodes] = {
    -0.9602898564975362317, -0.7966664774136267396, -0.5255324099163289858, -0.1834346424956498049,
    0.1834346424956498049,  0.5255324099163289858,  0.7966664774136267396,  0.9602898564975362317};

struct alignas(64) SumTable {
    double at[kNodes];            // t of the nodes
    double sums[kNodes][kNodes];  // [l][i]: weight of F(node l) in the sum at node i
    double total[kNodes];         // [l]: weight of F(node l) in the sum over the block
    double double_total[kNodes];  // [l]: its weight in the sum over m < K of the sums at m
    // Coefficients in theta of the sum (degree 8) and of the sum of sums (degree 9): degrees 0 .. 7 by node,
    // [l][k], and higher degrees by degree, [k - 8][l].
    double once_low[kNodes][kNodes], once_high[1][kNodes];
    double twice_low[kNodes][kNodes], twice_high[2][kNodes];
    double steps;               // K
    double theta0, theta_step;  // theta = theta0 + theta_step t
    // The two highest Chebyshev modes of F, which indicate the interpolation error.
    double mode6[kNodes], mode7[kNodes];
};

constexpr double evaluate(const double* a, int degree, double x) {
    double sum = 0.0;
    for (int k = degree; k >= 0; --k) sum = sum * x + a[k];
    return sum;
}

// The same with even and odd powers separate: two chains of half the length.
template <int kDegree>
double value(const double* a, double x) {
    constexpr int kEven = kDegree - kDegree % 2, kOdd = kDegree - 1 + kDegree % 2;
    const double x2 = x * x;
    double even = a[kEven], odd = a[kOdd];
    for (int k = kEven - 2; k >= 0; k -= 2) even = even * x2 + a[k];
    for (int k = kOdd - 2; k >= 0; k -= 2) odd = odd * x2 + a[k];
    return even + x * odd;
}

// The polynomial g with g(x + d) - g(x) = f(x) and g(start) = 0. f has degree `degree`, g one more.
constexpr void sum_polynomial(const double* f, int degree, double d, double start, double* g) {
    for (int i = degree; i >= 0; --i) {
        double rest = f[i], binomial = i + 1.0, power = d;
        for (int j = i + 2; j <= degree + 1; ++j) {
            binomial *= static_cast<double>(j) / (j - i);
            power *= d;
            rest -= g[j] * binomial * power;
        }
        g[i + 1] = rest / ((i + 1.0) * d);
    }
    g[0] = 0.0;
    g[0] = -evaluate(g, degree + 1, start);
}

constexpr SumTable sum_table(int K) {
    SumTable t{};
    t.steps = K;
    t.theta_step = 2.0 / K;
    // The nodes span the K steps evenly: theta = -1 is half a step before the first.
    t.theta0 = -(K - 1.0) / K;
    for (int i = 0; i < kNodes; ++i) t.at[i] = (kGaussNodes[i] - t.theta0) / t.theta_step;
    const double end = t.theta0 + K * t.theta_step;
    for (int l = 0; l < kNodes; ++l) {
        double lagrange[kNodes] = {1.0};
        double scale = 1.0;
        int degree = 0;
        for (int i = 0; i < kNodes; ++i) {
            if (i == l) continue;
            for (int k = ++degree; k >= 0; --k)
                lagrange[k] =
                    (k > 0 ? lagrange[k - 1] : 0.0) - kGaussNodes[i] * (k < degree ? lagrange[k] : 0.0);
            scale *= kGaussNodes[l] - kGaussNodes[i];
        }
        for (double& a : lagrange) a /= scale;
        double once[kNodes + 1] = {}, twice[kNodes + 2] = {};
        sum_polynomial(lagrange, kNodes - 1, t.theta_step, t.theta0, once);
        sum_polynomial(once, kNodes, t.theta_step, t.theta0, twice);
        for (int i = 0; i < kNodes; ++i) t.sums[l][i] = evaluate(once, kNodes, kGaussNodes[i]);
        t.total[l] = evaluate(once, kNodes, end);
        t.double_total[l] = evaluate(twice, kNodes + 1, end);
        for (int k = 0; k < kNodes; ++k) {
            t.once_low[l][k] = once[k];
            t.twice_low[l][k] = twice[k];
        }
        t.once_high[0][l] = once[kNodes];
        t.twice_high[0][l] = twice[kNodes];
        t.twice_high[1][l] = twice[kNodes + 1];
        t.mode6[l] = lagrange[6] / 32.0;
        t.mode7[l] = lagrange[7] / 64.0;
    }
    return t;
}

constexpr int kSmallestBlock = 16, kBlockSizes = 7, kLargestBlock = kSmallestBlock << (kBlockSizes - 1);
constexpr SumTable kSumTables[kBlockSizes] = {sum_table(16),  sum_table(32),  sum_table(64),  sum_table(128),
                                              sum_table(256), sum_table(512), sum_table(1024)};

}  // namespace
}  // namespace carom::kernel
