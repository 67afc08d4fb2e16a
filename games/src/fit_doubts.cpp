#include "fit_doubts.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <tuple>

namespace carom::games {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

// [m] Residuals below this are rounding.
constexpr double kExact = 1e-6;
// [-] From this share on, there are too many outliers.
constexpr double kFew = 0.2;
// [-] Report a wrong clock or scale if it explains this share of the squared residuals. It explains 1/n of
// noise.
constexpr double kExplained = 0.5;
constexpr std::size_t kEnough = 10;
// [-] Scales outside this range are reported at the start.
constexpr double kSmallest = 1.0 / 3.0, kLargest = 3.0;

struct Unit {
    const char* name;
    double per_metre;
};
constexpr std::array<Unit, 4> kUnits = {
    {{"mm", 1000.0}, {"cm", 100.0}, {"inches", 39.3701}, {"feet", 3.28084}}};

/// The residuals that these columns cannot explain.
VectorXd rest_of(const MatrixXd& columns, const VectorXd& residuals) {
    return residuals - columns * columns.completeOrthogonalDecomposition().solve(residuals);
}

}  // namespace

double scale_of(const std::vector<Coordinate>& coordinates) {
    const auto middle = [&coordinates](double Coordinate::*of) {
        std::vector<double> sizes;
        sizes.reserve(coordinates.size());
        for (const Coordinate& c : coordinates) sizes.push_back(std::abs(c.*of));
        if (sizes.empty()) return 0.0;
        const auto half = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
        std::nth_element(sizes.begin(), half, sizes.end());
        return *half;
    };
    const double simulated = middle(&Coordinate::place);
    return simulated > 0.0 ? middle(&Coordinate::seen) / simulated : 1.0;
}

std::string doubt_of_scale(double scale) {
    if (scale >= kSmallest && scale <= kLargest) return "";
    for (const Unit& unit : kUnits)
        if (std::abs(scale / unit.per_metre - 1.0) < 0.2)
            return fmt::format("the positions look like {}; write them in metres", unit.name);
    return fmt::format(
        "the positions are {:.3g} times the simulated ones; write them in metres, with the origin of the "
        "scene",
        scale);
}

std::string doubt_of(const std::vector<Coordinate>& moved, const MatrixXd& slopes, double noise, bool clock) {
    const auto n = static_cast<Eigen::Index>(moved.size());
    VectorXd residuals(n), velocities(n), places(n);
    std::size_t outliers = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
        const Coordinate& c = moved[static_cast<std::size_t>(i)];
        residuals[i] = c.residual, velocities[i] = c.velocity, places[i] = c.seen;
        outliers += std::abs(c.residual) > kOutlier * noise ? 1 : 0;
    }
    if (moved.size() < kEnough || residuals.norm() < kExact * std::sqrt(static_cast<double>(n))) return "";
    const auto explained = [&](const VectorXd& column) {
        MatrixXd more(n, slopes.cols() + 1);
        more << slopes, column;
        return 1.0 - rest_of(more, residuals).squaredNorm() / rest_of(slopes, residuals).squaredNorm();
    };
    const auto factor = [&](const VectorXd& column) {
        MatrixXd more(n, slopes.cols() + 1);
        more << slopes, column;
        return VectorXd(more.completeOrthogonalDecomposition().solve(residuals))[slopes.cols()];
    };
    if (!clock && explained(velocities) > kExplained)
        return fmt::format("the clock of the tracks seems to be off by about {:.2g} s; vary clock too",
                           factor(velocities));
    if (explained(places) > kExplained)
        return fmt::format("the scale of the positions seems to be off by about {:.2g} %; measure it again",
                           -100.0 * factor(places) / (1.0 + factor(places)));
    if (static_cast<double>(outliers) > kFew * static_cast<double>(n))
        return fmt::format(
            "{} of the {} coordinates that these numbers move are outliers; check that the tracks are of "
            "this shot, or vary other numbers",
            outliers, n);
    return "";
}

double correlation_factor(std::vector<Coordinate> moved) {
    std::sort(moved.begin(), moved.end(), [](const Coordinate& a, const Coordinate& b) {
        return std::tie(a.ball, a.axis, a.time) < std::tie(b.ball, b.axis, b.time);
    });
    double squares = 0.0, products = 0.0;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        squares += moved[i].residual * moved[i].residual;
        if (i > 0 && moved[i].ball == moved[i - 1].ball && moved[i].axis == moved[i - 1].axis)
            products += moved[i].residual * moved[i - 1].residual;
    }
    const auto n = static_cast<double>(moved.size());
    if (moved.size() < kEnough || squares < n * kExact * kExact) return 1.0;
    // Noise alone has a correlation of 1 / sqrt(n).
    const double correlation = std::min(0.99, products / squares);
    return correlation > 3.0 / std::sqrt(n) ? (1.0 + correlation) / (1.0 - correlation) : 1.0;
}

}  // namespace carom::games
