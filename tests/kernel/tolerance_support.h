// Shared by the tests of the tolerance kernel: calls, batches, energy, and impacts built to be hard.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <numbers>
#include <vector>

#include "carom/kernel/tolerance.h"
#include "reference/random_impacts.h"
#include "support/impact_numbers.h"

namespace carom::test {
using reference::Generator;
using reference::Impact;

inline std::vector<kernel::Isa> isas() {
    std::vector<kernel::Isa> list;
    for (kernel::Isa isa : {kernel::Isa::kScalar, kernel::Isa::kV3, kernel::Isa::kV4}) {
        if (kernel::available(isa)) list.push_back(isa);
    }
    return list;
}

inline kernel::ImpactResult solve(const Impact& impact, double tolerance,
                                  kernel::Isa isa = kernel::best_isa()) {
    kernel::ImpactResult result{};
    kernel::tolerance_function(isa)(impact.ball1, impact.ball2, impact.params, tolerance, result);
    return result;
}

/// Whether two results agree bit for bit in their velocities.
inline bool same_velocities(const kernel::ImpactResult& a, const kernel::ImpactResult& b) {
    return std::memcmp(a.v1, b.v1, sizeof a.v1) == 0 && std::memcmp(a.w1, b.w1, sizeof a.w1) == 0 &&
           std::memcmp(a.v2, b.v2, sizeof a.v2) == 0 && std::memcmp(a.w2, b.w2, sizeof a.w2) == 0;
}

inline double energy_before(const Impact& i) {
    return energy(i.ball1.v, i.ball1.w, i.ball2.v, i.ball2.w, i.params.R);
}

inline double energy_after(const Impact& i, const kernel::ImpactResult& r) {
    return energy(r.v1, r.w1, r.v2, r.w2, i.params.R);
}

/// Largest input speed; rounding is relative to it.
inline double speed_scale(const Impact& i) {
    double most = 0.0;
    for (int k = 0; k < 3; ++k) {
        for (double x : {i.ball1.v[k], i.ball2.v[k], i.params.R * i.ball1.w[k], i.params.R * i.ball2.w[k]}) {
            most = std::fmax(most, std::fabs(x));
        }
    }
    return most;
}

inline double approach_speed(const Impact& i) {
    const double dx = i.ball2.r[0] - i.ball1.r[0], dy = i.ball2.r[1] - i.ball1.r[1], d = std::hypot(dx, dy);
    return ((i.ball1.v[0] - i.ball2.v[0]) * dx + (i.ball1.v[1] - i.ball2.v[1]) * dy) / d;
}

/// Impacts around all singularities, over many decades: slip that ends, cloth slip that passes or starts next
/// to zero, both; e_b and the frictions up to `mu_b` and `mu_s` inclusive. Approach speed 1.
inline Impact hard_random_impact(Generator& rng, double mu_b, double mu_s, kernel::ClothSlip slip,
                                 double mass_ratio = 1.0) {
    const auto decades = [&rng](double lo, double hi) { return lo * std::pow(hi / lo, rng.uniform()); };
    const auto sign = [&rng] { return rng.next() % 2 == 0 ? 1.0 : -1.0; };
    Impact i{};
    i.params = {0.028575, 0.17, rng.uniform(0.0, mu_s), rng.uniform(0.0, mu_s), 0.0, rng.uniform(), slip};
    i.params.mass_ratio = mass_ratio;
    i.params.mu_b = rng.next() % 2 == 0 ? decades(0.01 * mu_b, mu_b) : rng.uniform(0.0, mu_b);
    if (rng.next() % 8 == 0) i.params.e_b = rng.next() % 2 == 0 ? 0.0 : 1.0;
    if (rng.next() % 8 == 0) i.params.mu_s1 = i.params.mu_s2 = 0.0;
    const double R = i.params.R, side = slip == kernel::ClothSlip::kAsPublished ? R : -R;
    const double s = decades(1e-9, 10.0);
    double angle = rng.uniform(0.0, 2.0 * std::numbers::pi);
    if (rng.next() % 4 == 0) angle = sign() * (0.5 * std::numbers::pi + sign() * decades(1e-9, 1.0));
    const double x = s * std::cos(angle), z = s * std::sin(angle);
    double a = sign() * decades(1e-12, 3.0), b = -rng.uniform(0.0, 1.2);
    if (rng.next() % 3 == 0) b = sign() * decades(1e-12, 3.0);
    if (rng.next() % 8 == 0) a = 0.0;
    if (rng.next() % 16 == 0) a = b = 0.0;
    // The forces change the slip of the pressed ball by this factor.
    const double f = 2.0 / (1.0 + (z < 0.0 ? mass_ratio : 1.0 / mass_ratio));
    a *= f;
    b *= f;
    i.ball2.r[1] = 2.0 * R;
    i.ball1.v[1] = 1.0;
    i.ball1.v[0] = x;
    if (z < 0.0) {  // ball 2 is pressed down: its cloth slip is (a, b)
        i.ball2.w[1] = a / side;
        i.ball2.w[0] = -b / side;
        i.ball1.w[0] = z / R - i.ball2.w[0];
    } else {
        i.ball1.w[1] = (-a - x) / side;
        i.ball1.w[0] = (1.0 + b) / side;
        i.ball2.w[0] = z / R - i.ball1.w[0];
    }
    return i;
}

/// Random impacts, and as many hard ones, of balls with mass ratios of 1/10 to 10 inclusive.
inline std::vector<Impact> impacts_of_masses_that_differ(std::uint64_t seed, int count,
                                                         kernel::ClothSlip slip) {
    Generator rng(seed);
    std::vector<Impact> impacts;
    for (int n = 0; n < count; ++n) {
        double ratio = std::pow(10.0, rng.uniform(-1.0, 1.0));
        // The tolerance is promised up to this ratio; the kernel accepts larger ones (impact_kernel.md).
        constexpr double kPromisedRatio = 10.0;
        if (n % 16 == 0) ratio = n % 32 == 0 ? kPromisedRatio : 1.0 / kPromisedRatio;
        impacts.push_back(reference::random_impact(rng));
        impacts.back().params.cloth_slip = slip;
        impacts.back().params.mass_ratio = ratio;
        impacts.push_back(hard_random_impact(rng, 0.12, 0.4, slip, ratio));
    }
    return impacts;
}

/// Structure of arrays around impacts (all with one sign of the cloth slip), with room for the results.
class Lanes {
  public:
    explicit Lanes(const std::vector<Impact>& impacts) : count_(impacts.size()) {
        for (auto& array : in_) array.resize(count_);
        for (auto& array : out_) array.resize(count_);
        status_.resize(count_);
        steps_.resize(count_);
        method_.resize(count_);
        for (std::size_t i = 0; i < count_; ++i) {
            const Impact& from = impacts[i];
            for (std::size_t k = 0; k < 3; ++k) {
                in_[k][i] = from.ball1.r[k];
                in_[3 + k][i] = from.ball1.v[k];
                in_[6 + k][i] = from.ball1.w[k];
                in_[9 + k][i] = from.ball2.r[k];
                in_[12 + k][i] = from.ball2.v[k];
                in_[15 + k][i] = from.ball2.w[k];
            }
            const kernel::ImpactParams& p = from.params;
            const double values[6] = {p.R, p.m, p.mu_s1, p.mu_s2, p.mu_b, p.e_b};
            for (std::size_t k = 0; k < 6; ++k) in_[18 + k][i] = values[k];
        }
        if (!impacts.empty()) slip_ = impacts[0].params.cloth_slip;
    }

    /// Lanes [first, first + count) as a batch.
    kernel::ImpactBatch batch(std::size_t first, std::size_t count) const {
        kernel::ImpactBatch b{};
        b.count = static_cast<long>(count);
        const auto at = [&](std::size_t k) { return in_[k].data() + first; };
        for (std::size_t k = 0; k < 3; ++k) {
            b.ball1.r[k] = at(k);
            b.ball1.v[k] = at(3 + k);
            b.ball1.w[k] = at(6 + k);
            b.ball2.r[k] = at(9 + k);
            b.ball2.v[k] = at(12 + k);
            b.ball2.w[k] = at(15 + k);
        }
        b.params = {at(18), at(19), at(20), at(21), at(22), at(23), slip_};
        return b;
    }
    kernel::ImpactBatch batch() const { return batch(0, count_); }

    kernel::ImpactBatchResult results(std::size_t first = 0) {
        kernel::ImpactBatchResult r{};
        for (std::size_t k = 0; k < 3; ++k) {
            r.ball1.v[k] = out_[k].data() + first;
            r.ball1.w[k] = out_[3 + k].data() + first;
            r.ball2.v[k] = out_[6 + k].data() + first;
            r.ball2.w[k] = out_[9 + k].data() + first;
        }
        r.status = status_.data() + first;
        r.steps = steps_.data() + first;
        r.method = method_.data() + first;
        return r;
    }

    kernel::ImpactResult result(std::size_t i) const {
        kernel::ImpactResult r{};
        for (std::size_t k = 0; k < 3; ++k) {
            r.v1[k] = out_[k][i];
            r.w1[k] = out_[3 + k][i];
            r.v2[k] = out_[6 + k][i];
            r.w2[k] = out_[9 + k][i];
        }
        r.status = status_[i];
        r.steps = steps_[i];
        r.method = method_[i];
        return r;
    }

  private:
    std::size_t count_;
    std::vector<double> in_[24], out_[12];
    std::vector<kernel::ImpactStatus> status_;
    std::vector<long> steps_;
    std::vector<kernel::ToleranceMethod> method_;
    kernel::ClothSlip slip_ = kernel::ClothSlip::kConsistent;
};

}  // namespace carom::test
