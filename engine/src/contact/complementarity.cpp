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
    lu_.resize(m * m);
    pivot_.resize(m);
    for (std::size_t c = 0; c < m; ++c) {
        for (std::size_t r = 0; r < m; ++r) lu_[c * m + r] = at(index_[r], index_[c]);
        lu_[c * m + c] += kContactSoftness * std::abs(lu_[c * m + c]);
    }
    for (std::size_t k = 0; k < m; ++k) {
        double* const column = &lu_[k * m];
        std::size_t best = k;
        for (std::size_t r = k + 1; r < m; ++r)
            if (std::abs(column[r]) > std::abs(column[best])) best = r;
        pivot_[k] = best;
        if (best != k)
            for (std::size_t c = 0; c < m; ++c) std::swap(lu_[c * m + k], lu_[c * m + best]);
        if (!(std::abs(column[k]) > 0.0)) return false;
        for (std::size_t r = k + 1; r < m; ++r) column[r] /= column[k];
        for (std::size_t c = k + 1; c < m; ++c) {
            double* const other = &lu_[c * m];
            const double head = other[k];
            if (head == 0.0) continue;
            for (std::size_t r = k + 1; r < m; ++r) other[r] -= head * column[r];
        }
    }
    return true;
}

void Complementarity::back_substitute(std::vector<double>& x) const {
    const std::size_t m = index_.size();
    for (std::size_t k = 0; k < m; ++k)
        if (pivot_[k] != k) std::swap(x[k], x[pivot_[k]]);
    for (std::size_t c = 0; c < m; ++c)
        for (std::size_t r = c + 1; r < m; ++r) x[r] -= lu_[c * m + r] * x[c];
    for (std::size_t c = m; c-- > 0;) {
        x[c] /= lu_[c * m + c];
        for (std::size_t r = 0; r < c; ++r) x[r] -= lu_[c * m + r] * x[c];
    }
}

void Complementarity::residual(std::vector<double>& w) const {
    w = q;
    for (std::size_t j = 0; j < size; ++j) {
        if (z[j] == 0.0) continue;
        for (std::size_t i = 0; i < size; ++i) w[i] += at(i, j) * z[j];
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

// The refinements remove the effect of the compliance down to rounding, as long as each at least halves the residual; where contacts
// contradict each other it does not. In a wedge whose smallest eigenvalue is 1e-11, two refinements left 1e-9 m/s^2: 1e-12 m after some
// tenths of a second.
void Complementarity::polish(std::vector<double>& w) {
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

// Rows that a solution cannot have: a pull, or a negative w.
void Complementarity::find_wrong(const std::vector<double>& w) {
    constexpr double kRounding = 1e-12;  // [-] relative; larger violations count as infeasible
    double largest = 0.0;
    for (const double x : z) largest = std::max(largest, std::abs(x));
    wrong_.clear();
    for (std::size_t i = 0; i < size; ++i) {
        if (basic_[i]) {
            if (z[i] < -kRounding * largest) wrong_.push_back(i);
        } else if (w[i] < 0.0) {
            double scale = std::abs(q[i]);
            for (std::size_t j = 0; j < size; ++j) scale += std::abs(at(i, j) * z[j]);
            if (w[i] < -kRounding * scale) wrong_.push_back(i);
        }
    }
}

bool Complementarity::solve() {
    residual(w_);
    basic_.resize(size);
    for (std::size_t i = 0; i < size; ++i) basic_[i] = z[i] > 0.0 || w_[i] < 0.0;
    if (exchange(20 + 2 * size, false)) return true;
    // Rows that the compliance decides may be exchanged without end: now each answer is refined before it is judged.
    for (std::size_t i = 0; i < size; ++i) basic_[i] = q[i] < 0.0;
    if (exchange(200 + 20 * size, true)) return true;
    std::fill(z.begin(), z.end(), 0.0);
    return false;
}

bool Complementarity::exchange(std::size_t most, bool refined) {
    std::vector<double>& w = w_;
    std::size_t fewest = size + 1;
    int tries = kBlockTries;
    for (std::size_t pivots = 0; pivots < most; ++pivots) {
        if (!factor()) return false;
        std::fill(z.begin(), z.end(), 0.0);
        w = q;
        refine(w);
        if (refined) polish(w);
        find_wrong(w);
        if (wrong_.empty() && !refined) {
            polish(w);
            find_wrong(w);
        }
        if (wrong_.empty()) {
            for (std::size_t i = 0; i < size; ++i) z[i] = std::max(0.0, z[i]);
            return std::all_of(z.begin(), z.end(), [](double x) { return std::isfinite(x); });
        }
        if (wrong_.size() < fewest) {
            fewest = wrong_.size();
            tries = kBlockTries;
        } else {
            --tries;
        }
        if (tries > 0) {
            for (const std::size_t i : wrong_) basic_[i] = !basic_[i];
        } else {
            basic_[wrong_.back()] = !basic_[wrong_.back()];
        }
    }
    return false;
}

}  // namespace carom
