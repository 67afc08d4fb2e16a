// Balls of a rack pressed together.
#include "scene/rack.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "carom/engine/ball_ball.h"

namespace carom {
namespace {

using Rows = std::vector<std::vector<double>>;

struct RackPair {
    std::size_t i, j;
    double apart;  // [m] smallest possible distance of the centres
    double pull;   // [-] force that draws them together
    Vec2 normal = Vec2::Zero();
    double open = 0.0;  // [m]
};

/// Around each ball in the middle of six others, the gaps of the rim minus those of the spokes do not depend
/// on the positions, to first order: one row for each, with 1 and -1 for its pairs.
Rows wheels(const std::vector<RackPair>& pairs, std::size_t balls) {
    Rows rows;
    for (std::size_t hub = 0; hub < balls; ++hub) {
        std::vector<bool> rim(balls, false);
        for (const RackPair& p : pairs)
            if (p.i == hub || p.j == hub) rim[p.i == hub ? p.j : p.i] = true;
        if (std::count(rim.begin(), rim.end(), true) != 6) continue;
        std::vector<double>& row = rows.emplace_back();
        for (const RackPair& p : pairs)
            row.push_back(p.i == hub || p.j == hub ? -1.0 : rim[p.i] && rim[p.j] ? 1.0 : 0.0);
    }
    return rows;
}

/// The pairs that stay open, one for each wheel: of all gaps >= 0 with these sums, those with the least work
/// against the pulls. The simplex method on the dual problem, "maximise sum . y with wheels^T y <= pull",
/// whose free variables y enter the basis first and stay there.
std::vector<bool> open_pairs(const std::vector<RackPair>& pairs, const Rows& wheel,
                             const std::vector<double>& sum) {
    constexpr std::size_t kFree = std::numeric_limits<std::size_t>::max();
    constexpr double kZero = 1e-12;
    const std::size_t n = pairs.size(), m = wheel.size();
    Rows t(n + 1, std::vector<double>(m + 1, 0.0));
    std::vector<std::size_t> row_of(n), column_of(m, kFree);
    double most = 0.0;
    for (const double s : sum) most = std::max(most, std::abs(s));
    for (std::size_t r = 0; r < n; ++r) {
        row_of[r] = r;
        t[r][m] = pairs[r].pull;
        for (std::size_t c = 0; c < m; ++c) t[r][c] = wheel[c][r];
    }
    for (std::size_t c = 0; c < m; ++c) t[n][c] = most > 0.0 ? -sum[c] / most : 0.0;
    // Each exchange lowers the work; the limit guarantees termination despite rounding.
    for (std::size_t exchanges = 0; exchanges < 100 * (m + 1); ++exchanges) {
        std::size_t s = 0;
        for (std::size_t c = 1; c < m; ++c)
            if (column_of[s] != kFree && (column_of[c] == kFree || t[n][c] < t[n][s])) s = c;
        if (m == 0 || (column_of[s] != kFree && t[n][s] >= -kZero)) break;
        if (column_of[s] == kFree && t[n][s] > 0.0)
            for (std::vector<double>& row : t) row[s] = -row[s];
        std::size_t r = n;
        for (std::size_t k = 0; k < n; ++k)
            if (row_of[k] != kFree && t[k][s] > kZero && (r == n || t[k][m] * t[r][s] < t[r][m] * t[k][s]))
                r = k;
        if (r == n) break;
        const double pivot = t[r][s];
        for (std::size_t c = 0; c <= m; ++c)
            if (c != s) t[r][c] /= pivot;
        for (std::size_t k = 0; k <= n; ++k) {
            if (k == r) continue;
            for (std::size_t c = 0; c <= m; ++c)
                if (c != s) t[k][c] -= t[k][s] * t[r][c];
            t[k][s] /= -pivot;
        }
        t[r][s] = 1.0 / pivot;
        std::swap(row_of[r], column_of[s]);
    }
    std::vector<bool> open(n, false);
    for (const std::size_t pair : column_of)
        if (pair != kFree) open[pair] = true;
    return open;
}

/// Solves a x = b for a symmetric positive definite matrix; b becomes x. Not by Eigen, whose order of
/// summation, and so whose bits, depends on the instruction set.
void solve_positive(Rows& a, std::vector<double>& b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t r = k + 1; r < n; ++r) {
            const double factor = a[r][k] / a[k][k];
            if (factor == 0.0) continue;
            for (std::size_t c = k; c < n; ++c) a[r][c] -= factor * a[k][c];
            b[r] -= factor * b[k];
        }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t c = k + 1; c < n; ++c) b[k] -= a[k][c] * b[c];
        b[k] /= a[k][k];
    }
}

/// One step of Newton's method: the smallest displacements that close these pairs, to first order.
void close_pairs(const std::vector<const RackPair*>& pairs, std::vector<Vec2>& places) {
    const std::size_t n = pairs.size();
    Rows a(n, std::vector<double>(n));
    std::vector<double> push(n);
    for (std::size_t r = 0; r < n; ++r) {
        const RackPair& p = *pairs[r];
        push[r] = -p.open;
        for (std::size_t c = 0; c < n; ++c) {
            const RackPair& q = *pairs[c];
            const int common = (p.i == q.i) + (p.j == q.j) - (p.i == q.j) - (p.j == q.i);
            a[r][c] = common * p.normal.dot(q.normal);
        }
    }
    solve_positive(a, push);
    for (std::size_t r = 0; r < n; ++r) {
        places[pairs[r]->i] -= push[r] * pairs[r]->normal;
        places[pairs[r]->j] += push[r] * pairs[r]->normal;
    }
}

}  // namespace

void press(std::vector<Vec2>& places, std::span<const double> radii, double R, double gap, std::size_t fixed,
           SplitMix64& random) {
    constexpr int kRounds = 30;
    // [m] Steps converge quadratically: after a step of at most this length only rounding remains.
    constexpr double kSmallStep = 1e-10, kRounding = 1e-14;
    std::vector<RackPair> pairs;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if ((places[i] - places[j]).norm() < 1.2 * (2.0 * R + gap))
                pairs.push_back(
                    {i, j, contact_distance(radii[i], radii[j], false) + gap, 0.75 + 0.5 * random.uniform()});
    const Rows wheel = wheels(pairs, places.size());
    const Vec2 anchor = places[fixed];
    double step = 2.0 * kSmallStep;
    for (int round = 0; round < kRounds; ++round) {
        double least = 0.0;
        for (RackPair& p : pairs) {
            const Vec2 d = places[p.j] - places[p.i];
            p.open = d.norm() - p.apart;
            p.normal = d / d.norm();
            least = std::min(least, p.open);
        }
        if (step <= kSmallStep && least >= -kRounding) return;
        std::vector<double> sum(wheel.size(), 0.0);
        for (std::size_t w = 0; w < wheel.size(); ++w)
            for (std::size_t k = 0; k < pairs.size(); ++k) sum[w] += wheel[w][k] * pairs[k].open;
        const std::vector<bool> open = open_pairs(pairs, wheel, sum);
        std::vector<const RackPair*> closing;
        for (std::size_t k = 0; k < pairs.size(); ++k)
            if (!open[k]) closing.push_back(&pairs[k]);
        const std::vector<Vec2> before = places;
        close_pairs(closing, places);
        const Vec2 back = anchor - places[fixed];
        step = 0.0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            places[i] = i == fixed ? anchor : Vec2(places[i] + back);
            step = std::max(step, (places[i] - before[i]).norm());
        }
    }
    throw std::invalid_argument("the balls of this rack cannot be pressed together; lower balls.radius_sd");
}

}  // namespace carom
