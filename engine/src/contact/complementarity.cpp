#include "contact/complementarity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace carom {

namespace {
// [-] Block exchanges without fewer infeasible rows before single exchanges (Murty's rule) begin.
constexpr int kBlockTries = 8;
// [-] Further refinements after the first two: each multiplies the residual by the compliance divided by the
// smallest eigenvalue, so more of them help only where the matrix is singular to rounding.
constexpr int kMoreRefinements = 20;
constexpr double kSlowRow = 0.25, kSlowestRow = 0.9999;  // [-] extrapolated ratios of successive refinements
constexpr double kSumUlp = 4.0;  // [ulp of a row's terms] a smaller residual is the rounding of their sum
}  // namespace

// LU factorisation with partial pivoting of the basic rows and columns.
bool Complementarity::factor() {
    index_.clear();
    for (std::size_t i = 0; i < size; ++i)
        if (basic_[i]) index_.push_back(i);
    const std::size_t m = index_.size();
    lu_.assign(m * m, 0.0);
    pivot_.resize(m);
    for (std::size_t r = 0; r < m; ++r) {
        for (std::size_t c = 0; c < m; ++c) lu_[r * m + c] = at(index_[r], index_[c]);
        lu_[r * m + r] += kContactSoftness * std::abs(lu_[r * m + r]);
    }
    for (std::size_t k = 0; k < m; ++k) {
        std::size_t best = k;
        for (std::size_t r = k + 1; r < m; ++r)
            if (std::abs(lu_[r * m + k]) > std::abs(lu_[best * m + k])) best = r;
        pivot_[k] = best;
        if (best != k)
            std::swap_ranges(lu_.begin() + static_cast<std::ptrdiff_t>(k * m),
                             lu_.begin() + static_cast<std::ptrdiff_t>((k + 1) * m),
                             lu_.begin() + static_cast<std::ptrdiff_t>(best * m));
        const double head = lu_[k * m + k];
        if (!(std::abs(head) > 0.0)) return false;
        for (std::size_t r = k + 1; r < m; ++r) {
            if (lu_[r * m + k] == 0.0) continue;
            const double factor = lu_[r * m + k] / head;
            lu_[r * m + k] = factor;
            for (std::size_t c = k + 1; c < m; ++c) lu_[r * m + c] -= factor * lu_[k * m + c];
        }
    }
    return true;
}

void Complementarity::back_substitute(std::vector<double>& x) const {
    const std::size_t m = index_.size();
    for (std::size_t k = 0; k < m; ++k)
        if (pivot_[k] != k) std::swap(x[k], x[pivot_[k]]);
    for (std::size_t r = 1; r < m; ++r)
        for (std::size_t c = 0; c < r; ++c) x[r] -= lu_[r * m + c] * x[c];
    for (std::size_t r = m; r-- > 0;) {
        for (std::size_t c = r + 1; c < m; ++c) x[r] -= lu_[r * m + c] * x[c];
        x[r] /= lu_[r * m + r];
    }
}

void Complementarity::residual(std::vector<double>& w) const {
    for (std::size_t i = 0; i < size; ++i) {
        w[i] = q[i];
        for (std::size_t j = 0; j < size; ++j) w[i] += at(i, j) * z[j];
    }
}

// Largest residual of a basic row, relative to the sum of the absolute values of its terms.
double Complementarity::worst_residual(const std::vector<double>& w) const {
    double worst = 0.0;
    for (const std::size_t i : index_) {
        double scale = std::abs(q[i]);
        for (const std::size_t j : index_) scale += std::abs(at(i, j) * z[j]);
        if (scale > 0.0) worst = std::max(worst, std::abs(w[i]) / scale);
    }
    return worst;
}

// Solves for z of the basic rows with the present factors. The refinements remove the effect of the compliance down
// to rounding, as long as each at least halves the residual; where contacts contradict each other it does not. In a
// wedge whose smallest eigenvalue is 1e-11, two refinements left 1e-9 m/s^2: 1e-12 m after some tenths of a second.
void Complementarity::solve_basic(std::vector<double>& w) {
    std::fill(z.begin(), z.end(), 0.0);
    w = q;
    refine(w);
    refine(w);
    refine(w);
    double left = worst_residual(w);
    if (left <= kSumUlp * std::numeric_limits<double>::epsilon()) return;
    for (int more = 0; more < kMoreRefinements && left > std::numeric_limits<double>::epsilon(); ++more) {
        last_ = z;
        before_ = part_;
        refine(w);
        extrapolate(w);
        const double now = worst_residual(w);
        if (!(now < left)) {
            z = last_;
            residual(w);
        }
        if (!(now <= 0.5 * left)) return;
        left = now;
    }
}

// If the smallest eigenvalue is below the compliance, every refinement removes the same small share of the error: the
// corrections form a geometric series, whose sum follows from the last two.
void Complementarity::extrapolate(std::vector<double>& w) {
    double both = 0.0, square = 0.0;
    for (std::size_t k = 0; k < part_.size(); ++k) {
        both += before_[k] * part_[k];
        square += before_[k] * before_[k];
    }
    if (!(both > kSlowRow * square) || !(both < kSlowestRow * square)) return;
    const double more = both / (square - both);
    for (std::size_t k = 0; k < index_.size(); ++k) z[index_[k]] += more * part_[k];
    residual(w);
}

void Complementarity::refine(std::vector<double>& w) {
    part_.clear();
    for (const std::size_t i : index_) part_.push_back(-w[i]);
    back_substitute(part_);
    for (std::size_t k = 0; k < index_.size(); ++k) z[index_[k]] += part_[k];
    residual(w);
}

bool Complementarity::solve() {
    constexpr double kRounding = 1e-12;  // [-] relative; larger violations count as infeasible
    basic_.assign(size, 0);
    for (std::size_t i = 0; i < size; ++i) basic_[i] = q[i] < 0.0;
    std::vector<double> w(size);
    std::vector<std::size_t> wrong;
    std::size_t fewest = size + 1;
    int tries = kBlockTries;
    for (std::size_t pivots = 0; pivots < 200 + 20 * size; ++pivots) {
        if (!factor()) break;
        solve_basic(w);
        double largest = 0.0;
        for (const double x : z) largest = std::max(largest, std::abs(x));
        wrong.clear();
        for (std::size_t i = 0; i < size; ++i) {
            double scale = std::abs(q[i]);
            if (!basic_[i])
                for (std::size_t j = 0; j < size; ++j) scale += std::abs(at(i, j) * z[j]);
            if (basic_[i] ? z[i] < -kRounding * largest : w[i] < -kRounding * scale) wrong.push_back(i);
        }
        if (wrong.empty()) {
            for (std::size_t i = 0; i < size; ++i) z[i] = std::max(0.0, z[i]);
            return std::all_of(z.begin(), z.end(), [](double x) { return std::isfinite(x); });
        }
        if (wrong.size() < fewest) {
            fewest = wrong.size();
            tries = kBlockTries;
        } else {
            --tries;
        }
        if (tries > 0) {
            for (const std::size_t i : wrong) basic_[i] = !basic_[i];
        } else {
            basic_[wrong.back()] = !basic_[wrong.back()];
        }
    }
    std::fill(z.begin(), z.end(), 0.0);
    return false;
}

}  // namespace carom
