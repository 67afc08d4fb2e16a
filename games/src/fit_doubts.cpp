#include "fit_doubts.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

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

// [R] A fit that is no better than straight lines is reported only if it is farther off than this: on a short
// or straight path, noise alone is as good.
constexpr double kVisible = 0.25;

// [1/s] Units of time that tracks may have by mistake: frames, and milliseconds.
constexpr double kMilliseconds = 1000.0;
constexpr double kUnitsOfTime[] = {24.0, 25.0, 30.0, 50.0, 60.0, 120.0, 240.0, kMilliseconds};
// [-] A mistake is named if undoing it leaves at most this share of the distance.
constexpr double kUndone = 0.5;

/// The residuals that these columns cannot explain.
VectorXd rest_of(const MatrixXd& columns, const VectorXd& residuals) {
    return residuals - columns * columns.completeOrthogonalDecomposition().solve(residuals);
}

/// [m] Median distance of the tracks from the record, over the balls that move.
/// @param right  the place on the table for a place in the tracks
template <class Right>
double distance(const Record& record, const std::vector<TrackPoint>& points, double per_second, Right right) {
    std::vector<double> distances;
    for (const TrackPoint& point : points)
        if (record.tracks[static_cast<std::size_t>(point.ball)].segments.size() > 1)
            distances.push_back(length(planar(record.state_at(point.ball, point.time / per_second).position) -
                                       right(point.place)));
    return median(std::move(distances));
}

/// [m] Median residual of straight lines through the tracks of each ball.
double distance_from_lines(const std::vector<Coordinate>& moved) {
    std::map<std::pair<int, int>, std::vector<const Coordinate*>> groups;
    for (const Coordinate& c : moved) groups[{c.ball, c.axis}].push_back(&c);
    std::vector<double> sizes;
    for (const auto& [key, list] : groups) {
        MatrixXd columns(static_cast<Eigen::Index>(list.size()), 2);
        VectorXd seen(columns.rows());
        for (Eigen::Index i = 0; i < seen.size(); ++i) {
            const Coordinate& c = *list[static_cast<std::size_t>(i)];
            columns.row(i) << 1.0, c.time;
            seen[i] = c.seen;
        }
        for (const double size : rest_of(columns, seen)) sizes.push_back(std::abs(size));
    }
    return median(std::move(sizes));
}

}  // namespace

double median(std::vector<double> list) {
    if (list.empty()) return 0.0;
    const auto half = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
    std::nth_element(list.begin(), half, list.end());
    return *half;
}

double scale_of(const std::vector<Coordinate>& coordinates) {
    const auto middle = [&coordinates](double Coordinate::*of) {
        std::vector<double> sizes;
        sizes.reserve(coordinates.size());
        for (const Coordinate& c : coordinates) sizes.push_back(std::abs(c.*of));
        return median(std::move(sizes));
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

std::string doubt_of_distance(const std::vector<Coordinate>& moved, double noise, const Record& record,
                              const std::vector<TrackPoint>& points) {
    const double R = record.balls.R;
    const bool far = noise > R;
    if (!far && !(noise > kVisible * R && noise >= kMedian * distance_from_lines(moved))) return "";
    const std::string typical =
        fmt::format("the positions are typically {:.3g} mm off, {}; ", 1e3 * noise,
                    far ? "more than a ball's radius" : "no better than straight lines through the tracks");
    const auto same = [](const Vec2& place) { return place; };
    double best = kUndone * distance(record, points, 1.0, same);
    std::string reason =
        "check that they are of this shot, on this table, in seconds and metres from the corner of the noses";
    const auto consider = [&](double without, std::string mistake) {
        if (without < best) best = without, reason = std::move(mistake);
    };
    for (const double unit : kUnitsOfTime)
        consider(
            distance(record, points, unit, same),
            fmt::format("the times look like {}; write seconds",
                        unit == kMilliseconds ? "milliseconds" : fmt::format("frames at {} a second", unit)));
    const double w = record.table.width, l = record.table.length;
    const auto turned = [&](auto right, const char* mistake) {
        consider(distance(record, points, 1.0, right), mistake);
    };
    turned([](const Vec2& p) { return Vec2(p.y(), p.x()); },
           "x and y look swapped; x is across the table, y along it");
    turned([w](const Vec2& p) { return Vec2(w - p.x(), p.y()); },
           "x looks measured from the right; measure it from the left rail");
    turned([l](const Vec2& p) { return Vec2(p.x(), l - p.y()); },
           "y looks measured from the foot; measure it from the head rail");
    return typical + reason;
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
