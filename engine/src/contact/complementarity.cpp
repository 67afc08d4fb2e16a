#include "contact/complementarity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "carom/engine/tolerances.h"
#include "contact/resting_constants.h"

namespace carom {

void Complementarity::multiply_add(double factor, const std::vector<double>& x,
                                   std::vector<double>& result) const {
    for (std::size_t j = 0; j < size; ++j) {
        const double by = factor * x[j];
        if (by == 0.0) continue;
        for (const Entry& e : column(j)) result[e.row] += e.value * by;
    }
}

// LU factorisation with partial pivoting of the basic rows and columns. Contacts ordered by position form a
// band; everything outside it stays zero.
bool Complementarity::factor() {
    index_.clear();
    place_.assign(size, size);
    for (std::size_t i = 0; i < size; ++i) {
        if (!basic_[i]) continue;
        place_[i] = index_.size();
        index_.push_back(i);
    }
    const std::size_t m = index_.size();
    lu_.assign(m * m, 0.0);
    pivot_.resize(m);
    top_.resize(m);
    bottom_.resize(m);
    for (std::size_t c = 0; c < m; ++c) {
        top_[c] = bottom_[c] = c;
        for (const Entry& e : column(index_[c])) {
            const std::size_t r = place_[e.row];
            if (r == size) continue;
            lu_[c * m + r] = e.value;
            top_[c] = std::min(top_[c], r);
            bottom_[c] = std::max(bottom_[c], r);
        }
        lu_[c * m + c] += resting::kContactSoftness * std::abs(lu_[c * m + c]);
    }
    for (std::size_t k = 0; k < m; ++k) {
        double* const column = &lu_[k * m];
        std::size_t best = k;
        for (std::size_t r = k + 1; r <= bottom_[k]; ++r)
            if (std::abs(column[r]) > std::abs(column[best])) best = r;
        pivot_[k] = best;
        if (best != k) {
            for (std::size_t c = 0; c < m; ++c) {
                std::swap(lu_[c * m + k], lu_[c * m + best]);
                if (lu_[c * m + k] != 0.0) top_[c] = std::min(top_[c], k);
                if (lu_[c * m + best] != 0.0) bottom_[c] = std::max(bottom_[c], best);
            }
        }
        if (!(std::abs(column[k]) > 0.0)) return false;
        const std::size_t end = bottom_[k] + 1;
        for (std::size_t r = k + 1; r < end; ++r) column[r] /= column[k];
        for (std::size_t c = k + 1; c < m; ++c) {
            double* const other = &lu_[c * m];
            const double head = other[k];
            if (head == 0.0) continue;
            bottom_[c] = std::max(bottom_[c], bottom_[k]);
            for (std::size_t r = k + 1; r < end; ++r) other[r] -= head * column[r];
        }
    }
    return true;
}

void Complementarity::back_substitute(std::vector<double>& x) const {
    const std::size_t m = index_.size();
    for (std::size_t k = 0; k < m; ++k)
        if (pivot_[k] != k) std::swap(x[k], x[pivot_[k]]);
    for (std::size_t c = 0; c < m; ++c)
        for (std::size_t r = c + 1; r <= bottom_[c]; ++r) x[r] -= lu_[c * m + r] * x[c];
    for (std::size_t c = m; c-- > 0;) {
        x[c] /= lu_[c * m + c];
        for (std::size_t r = top_[c]; r < c; ++r) x[r] -= lu_[c * m + r] * x[c];
    }
}

void Complementarity::residual(std::vector<double>& w) const {
    w = q;
    multiply_add(1.0, z, w);
}

// size_of_: for each row, the sum of the absolute values of its terms.
void Complementarity::add_sizes() {
    size_of_.resize(size);
    for (std::size_t i = 0; i < size; ++i) size_of_[i] = std::abs(q[i]);
    for (std::size_t j = 0; j < size; ++j) {
        if (z[j] == 0.0) continue;
        for (const Entry& e : column(j)) size_of_[e.row] += std::abs(e.value * z[j]);
    }
}

// Largest residual of a basic row, relative to the sum of the absolute values of its terms.
double Complementarity::worst_residual(const std::vector<double>& w) {
    add_sizes();
    double worst = 0.0;
    for (const std::size_t i : index_)
        if (size_of_[i] > 0.0) worst = std::max(worst, std::abs(w[i]) / size_of_[i]);
    return worst;
}

// Refinements remove the effect of the compliance down to rounding, as long as each at least halves the
// residual, which it does unless contacts contradict each other. In a wedge whose smallest eigenvalue is
// 1e-11, two refinements left 1e-9 m/s^2: 1e-12 m after some tenths of a second.
void Complementarity::polish(std::vector<double>& w) {
    refine(w);
    refine(w);
    double left = worst_residual(w);
    if (left <= resting::kSumUlp * kEpsilon) return;
    for (int more = 0; more < resting::kMoreRefinements && left > kEpsilon; ++more) {
        last_ = z;
        refine(w);
        const double now = worst_residual(w);
        if (!(now < left)) {
            z = last_;
            residual(w);
        }
        if (!(now <= 0.5 * left)) return;
        left = now;
    }
}

void Complementarity::refine(std::vector<double>& w) {
    part_.clear();
    for (const std::size_t i : index_) part_.push_back(-w[i]);
    back_substitute(part_);
    for (std::size_t k = 0; k < index_.size(); ++k) z[index_[k]] += part_[k];
    residual(w);
}

// Rows that violate a solution: a pull, or a negative w.
void Complementarity::find_wrong(const std::vector<double>& w) {
    double largest = 0.0;
    for (const double x : z) largest = std::max(largest, std::abs(x));
    wrong_.clear();
    add_sizes();
    for (std::size_t i = 0; i < size; ++i) {
        const bool wrong =
            basic_[i] ? z[i] < -resting::kInfeasible * largest : w[i] < -resting::kInfeasible * size_of_[i];
        if (wrong) wrong_.push_back(i);
    }
}

bool Complementarity::solve() {
    if (exchange(resting::kFewExchanges) || approach()) return true;
    std::fill(z.begin(), z.end(), 0.0);
    return false;
}

// Pivoting can cycle if only the regularisation separates two contacts. A stronger one prevents that. Its
// effect decays if each solution is the centre of the next one (the proximal point method of Martinet and
// Rockafellar), and faster the weaker it is, so each round uses a tenth of it while the pivoting ends.
bool Complementarity::approach() {
    const std::vector<double> wanted = q;
    std::vector<double> own(size, 0.0), before;
    std::vector<std::size_t> diagonal(size);
    for (std::size_t c = 0; c < size; ++c) {
        for (std::size_t k = first[c]; k < end_of(c); ++k)
            if (entries[k].row == c) diagonal[c] = k;
        own[c] = entries[diagonal[c]].value;
    }
    std::fill(z.begin(), z.end(), 0.0);
    bool found = false, least = false;
    double softness = resting::kApproachSoftness;
    for (int round = 0; round < resting::kMostRounds; ++round) {
        before = z;
        for (std::size_t c = 0; c < size; ++c) {
            const double soft = softness * std::abs(own[c]);
            entries[diagonal[c]].value = own[c] + soft;
            q[c] = wanted[c] - soft * before[c];
        }
        if (!exchange(found ? resting::kFewExchanges : 200 + 20 * size)) {
            z = before;  // as close as rounding allows
            if (least || !found) break;
            least = true;
            softness *= 10.0;
            continue;
        }
        found = true;
        double moved = 0.0, largest = 0.0;
        for (std::size_t c = 0; c < size; ++c) {
            moved = std::max(moved, std::abs(z[c] - before[c]));
            largest = std::max(largest, z[c]);
        }
        if (!(softness * moved > kEpsilon * largest)) break;
        if (!least) softness = std::max(resting::kLeastSoftness, 0.1 * softness);
    }
    for (std::size_t c = 0; c < size; ++c) entries[diagonal[c]].value = own[c];
    q = wanted;
    return found;
}

bool Complementarity::exchange(std::size_t most) {
    std::vector<double>& w = w_;
    residual(w);
    basic_.resize(size);
    for (std::size_t i = 0; i < size; ++i) basic_[i] = z[i] > 0.0 || w[i] < 0.0;
    std::size_t fewest = size + 1;
    int tries = resting::kBlockTries;
    for (std::size_t pivots = 0; pivots < most; ++pivots) {
        if (!factor()) return false;
        std::fill(z.begin(), z.end(), 0.0);
        w = q;
        refine(w);
        find_wrong(w);
        if (wrong_.empty()) {
            polish(w);
            find_wrong(w);
        }
        if (wrong_.empty()) {
            for (std::size_t i = 0; i < size; ++i) z[i] = std::max(0.0, z[i]);
            return std::all_of(z.begin(), z.end(), [](double x) { return std::isfinite(x); });
        }
        if (wrong_.size() < fewest) {
            fewest = wrong_.size();
            tries = resting::kBlockTries;
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
