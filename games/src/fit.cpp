#include "carom/games/fit.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/derivatives.h"
#include "carom/engine/plan.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"
#include "fit_doubts.h"

namespace carom::games {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// [noise] Larger residuals count linearly: 95 % as efficient as least squares if there are no outliers
// (Huber, 1964).
constexpr double kHuber = 1.345;
// [m] Better than any camera; keeps the loss defined if the model fits exactly.
constexpr double kLeastNoise = 1e-9;
// [m] A number that moves the balls by less over its whole size affects only rounding.
constexpr double kUnmoved = 1e-9;
// Damping: its start, and its factors after a step that helps and one that does not.
constexpr double kDamping = 1e-4, kLess = 0.1, kMoreDamped = 10.0, kMostDamping = 1e12;
// [-] The fit ends with a step that lowers the loss by less than this fraction, or moves every number by less
// than this many standard deviations.
constexpr double kDone = 1e-9, kStill = 1e-4;
// [-] Correlation from which two numbers are reported as inseparable; fraction of the largest eigenvalue
// below which a direction is undetermined.
constexpr double kAlike = 0.99, kNothing = 1e-12;
// A number outside the scene, and its largest absolute value [s].
constexpr const char* kClock = "clock";
constexpr double kClockRange = 60.0;

/// A shot, and its differences from the tracks.
struct Trial {
    std::vector<double> values;
    Scene scene;
    Plan plan;
    Record record;
    VectorXd residuals;         ///< two per point; 0 if the point does not count
    std::vector<bool> counted;  ///< per point
    double clock = 0.0;         ///< [s] of the stroke in the tracks
};

class Fitter {
  public:
    Fitter(const Scene& scene, const std::vector<TrackPoint>& points, const FitOptions& options,
           kernel::Isa isa)
        : scene_(scene), points_(points), options_(options), isa_(isa) {
        if (points.empty()) throw std::invalid_argument("there are no tracked positions");
        if (options.vary.empty()) throw std::invalid_argument("there is nothing to vary; name a number");
        if (2 * points.size() < options.vary.size())
            throw std::invalid_argument("there are more numbers to vary than tracked coordinates");
        for (std::size_t k = 0; k < options.vary.size(); ++k) {
            if (options.vary[k] == kClock) {
                clock_ = k;
                continue;
            }
            keys_.push_back(options.vary[k]);
            numbers_.push_back(check_varies(scene, keys_.back()));
        }
        for (const TrackPoint& point : points) last_ = std::max(last_, point.time);
    }

    Fit run() {
        Fit result;
        std::vector<double> values;
        for (std::size_t k = 0; k < count(); ++k) values.push_back(value_at_start(k));
        result.start = values;
        Trial now = *simulate_at(values, true);
        MatrixXd slopes = slopes_of(now);
        result.message = doubt_of_scale(scale_of(coordinates_of(now)));
        const bool refused = !result.message.empty();
        double damping = kDamping;
        while (shots_ < options_.most_shots && !result.converged && !refused) {
            const double noise = noise_of(now, slopes);
            const VectorXd weights = weights_of(now, noise);
            const MatrixXd normal = slopes.transpose() * weights.asDiagonal() * slopes;
            const VectorXd pull = slopes.transpose() * weights.asDiagonal() * now.residuals;
            const VectorXd step = damped_step(normal, pull, damping);
            std::vector<double> moved = now.values;
            for (std::size_t k = 0; k < moved.size(); ++k) moved[k] += step[static_cast<Eigen::Index>(k)];
            const double loss = loss_of(now, noise);
            std::optional<Trial> trial = simulate_at(moved, false);
            const double after = trial ? loss_of(*trial, noise) : kInfinity;
            const bool still = std::sqrt(step.dot(normal * step)) < kStill * noise;
            bool helps = after <= loss;
            if (helps) {
                try {
                    slopes = slopes_of(*trial);
                } catch (const DerivativeError& error) {
                    // Such as at the end of a range: a shorter step may do.
                    result.message = error.what();
                    helps = false;
                }
            }
            if (helps) {
                result.message.clear();
                result.converged = still || loss - after <= kDone * loss || after < kDone;
                now = std::move(*trial);
                damping *= kLess;
            } else {
                // No shorter step helps: rounding, or a change in the order of events, decides.
                if (still && result.message.empty()) result.converged = true;
                if (still || damping > kMostDamping) break;
                damping *= kMoreDamped;
            }
        }
        if (!result.converged && result.message.empty())
            result.message = shots_ >= options_.most_shots
                                 ? fmt::format("no convergence after {} shots", shots_)
                                 : "no step reduces the error; the tracks may have another order of events";
        finish(now, slopes, result);
        const auto [moved, columns] = moved_of(now, slopes);
        if (const std::string far = refused
                                        ? ""
                                        : doubt_of_distance(moved, result.noise,
                                                            simulate_at(result.start, true)->record, points_);
            !far.empty())
            result.message = far;
        else if (result.converged)
            result.message = doubt_of(moved, columns, result.noise, clock_.has_value());
        result.converged = result.converged && result.message.empty();
        if (result.converged)
            result.message = "converged";
        else
            for (std::vector<double>& row : result.covariance) row.assign(count(), kInfinity);
        return result;
    }

  private:
    /// Number of varied numbers, with the clock.
    std::size_t count() const { return options_.vary.size(); }
    /// The index of a scene's number among all varied numbers.
    std::size_t place_of(std::size_t number) const { return number + (clock_ && number >= *clock_ ? 1 : 0); }
    double value_at_start(std::size_t k) const {
        if (k == clock_) return 0.0;
        return numbers_[k - (clock_ && k > *clock_ ? 1 : 0)].value(scene_);
    }

    /// Nothing if the values are out of their ranges or make no valid scene, unless they must.
    std::optional<Trial> simulate_at(const std::vector<double>& values, bool must) {
        Scene scene = scene_;
        const double clock = clock_ ? values[*clock_] : 0.0;
        if (!(std::abs(clock) <= kClockRange)) return std::nullopt;
        for (std::size_t k = 0; k < numbers_.size(); ++k) {
            const double value = values[place_of(k)];
            if (!must && !contains(numbers_[k].row().range, value)) return std::nullopt;
            numbers_[k].put(scene, value);
        }
        try {
            validate(scene);
            ++shots_;
            Plan plan = make_plan(scene, isa_);
            SimulateOptions options;
            options.until = std::max(0.0, last_ - clock) + 1e-6;
            Record record = simulate(plan, options);
            Trial trial{values, scene, std::move(plan), std::move(record), {}, {}, clock};
            compare(trial);
            return trial;
        } catch (const SceneError&) {
            if (must) throw;
            return std::nullopt;
        }
    }

    void compare(Trial& trial) const {
        trial.residuals = VectorXd::Zero(static_cast<Eigen::Index>(2 * points_.size()));
        trial.counted.assign(points_.size(), false);
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const BallState state = trial.record.state_at(points_[i].ball, time_of(trial, i));
            trial.counted[i] = !is_gone(state.state);
            if (trial.counted[i])
                trial.residuals.segment<2>(static_cast<Eigen::Index>(2 * i)) =
                    planar(state.position) - points_[i].place;
        }
    }

    /// Of a point, since the stroke. Before it, all is as at the start.
    double time_of(const Trial& trial, std::size_t point) const {
        return std::max(0.0, points_[point].time - trial.clock);
    }
    Vec2 velocity_of(const Trial& trial, std::size_t point) const {
        if (points_[point].time < trial.clock) return Vec2::Zero();
        return planar(trial.record.state_at(points_[point].ball, time_of(trial, point)).velocity);
    }

    MatrixXd slopes_of(const Trial& trial) const {
        std::vector<double> times;
        for (std::size_t i = 0; i < points_.size(); ++i)
            if (trial.counted[i]) times.push_back(time_of(trial, i));
        std::sort(times.begin(), times.end());
        times.erase(std::unique(times.begin(), times.end()), times.end());
        const Derivatives by(trial.plan, trial.record, keys_, times);
        by.check(kRoughDerivativeError);
        MatrixXd slopes = MatrixXd::Zero(trial.residuals.size(), static_cast<Eigen::Index>(count()));
        const auto at = [&slopes](std::size_t point, std::size_t k) {
            return slopes.block<2, 1>(static_cast<Eigen::Index>(2 * point), static_cast<Eigen::Index>(k));
        };
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (!trial.counted[i]) continue;
            const auto time = static_cast<std::size_t>(
                std::lower_bound(times.begin(), times.end(), time_of(trial, i)) - times.begin());
            for (std::size_t k = 0; k < numbers_.size(); ++k)
                at(i, place_of(k)) = planar(by.state(time, points_[i].ball, k).position);
            if (clock_) at(i, *clock_) = -velocity_of(trial, i);
        }
        return slopes;
    }

    /// All coordinates that count, and their rows among the residuals.
    std::vector<Coordinate> coordinates_of(const Trial& trial,
                                           std::vector<Eigen::Index>* rows = nullptr) const {
        std::vector<Coordinate> list;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (!trial.counted[i]) continue;
            const Vec2 velocity = velocity_of(trial, i);
            for (const int axis : {0, 1}) {
                const auto row = static_cast<Eigen::Index>(2 * i) + axis;
                const double seen = points_[i].place[axis];
                list.push_back({points_[i].ball, axis, points_[i].time, trial.residuals[row], velocity[axis],
                                seen + trial.residuals[row], seen});
                if (rows != nullptr) rows->push_back(row);
            }
        }
        return list;
    }

    /// The coordinates that the numbers move, with their slopes; all of them if they move none. The others,
    /// such as of balls still at rest, say nothing about the fit, and may be exact.
    std::pair<std::vector<Coordinate>, MatrixXd> moved_of(const Trial& trial, const MatrixXd& slopes) const {
        std::vector<Eigen::Index> rows, moving;
        const std::vector<Coordinate> all = coordinates_of(trial, &rows);
        std::vector<Coordinate> moved;
        for (std::size_t i = 0; i < all.size(); ++i) {
            bool moves = false;
            for (std::size_t k = 0; k < count(); ++k) {
                const double value = std::abs(value_at_start(k)), size = value > 0.0 ? value : 1.0;
                moves = moves || std::abs(slopes(rows[i], static_cast<Eigen::Index>(k))) * size > kUnmoved;
            }
            if (moves) moved.push_back(all[i]), moving.push_back(rows[i]);
        }
        if (moved.empty()) moved = all, moving = rows;
        MatrixXd columns(static_cast<Eigen::Index>(moving.size()), slopes.cols());
        for (std::size_t i = 0; i < moving.size(); ++i)
            columns.row(static_cast<Eigen::Index>(i)) = slopes.row(moving[i]);
        return {std::move(moved), std::move(columns)};
    }

    double noise_of(const Trial& trial, const MatrixXd& slopes) const {
        std::vector<double> sizes;
        for (const Coordinate& c : moved_of(trial, slopes).first) sizes.push_back(std::abs(c.residual));
        return std::max(kLeastNoise, kMedian * median(std::move(sizes)));
    }

    static VectorXd weights_of(const Trial& trial, double noise) {
        return trial.residuals.unaryExpr([noise](double r) {
            const double size = std::abs(r);
            return size <= kHuber * noise ? 1.0 : kHuber * noise / size;
        });
    }

    /// Mean over the points that count, so that a ball in a pocket does not fit better than a visible one.
    static double loss_of(const Trial& trial, double noise) {
        double sum = 0.0;
        std::size_t count = 0;
        for (Eigen::Index i = 0; i < trial.residuals.size(); ++i) {
            if (!trial.counted[static_cast<std::size_t>(i / 2)]) continue;
            const double r = std::abs(trial.residuals[i]) / noise;
            sum += r <= kHuber ? 0.5 * r * r : kHuber * (r - 0.5 * kHuber);
            ++count;
        }
        return count > 0 ? sum / static_cast<double>(count) : kInfinity;
    }

    /// Units of the numbers that make the diagonal of the normal matrix 1, or 0 if nothing depends on one.
    VectorXd units_of(const MatrixXd& normal) const {
        VectorXd units = VectorXd::Zero(normal.rows());
        for (std::size_t k = 0; k < count(); ++k) {
            const double value = std::abs(value_at_start(k)), size = value > 0.0 ? value : 1.0;
            const auto i = static_cast<Eigen::Index>(k);
            const double slope = std::sqrt(normal(i, i));
            if (slope * size > kUnmoved) units[i] = 1.0 / slope;
        }
        return units;
    }

    VectorXd damped_step(const MatrixXd& normal, const VectorXd& pull, double damping) const {
        const VectorXd units = units_of(normal);
        MatrixXd scaled = units.asDiagonal() * normal * units.asDiagonal();
        scaled.diagonal().array() += damping + (units.array() == 0.0).cast<double>();
        return -(units.asDiagonal() * scaled.ldlt().solve(units.asDiagonal() * pull));
    }

    void finish(const Trial& now, const MatrixXd& slopes, Fit& result) const {
        result.values = now.values;
        result.scene = now.scene;
        result.shots = shots_;
        result.noise = noise_of(now, slopes);
        std::size_t coordinates = 0;
        double squares = 0.0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const Vec2 r = now.residuals.segment<2>(static_cast<Eigen::Index>(2 * i));
            result.residuals.push_back(r);
            if (!now.counted[i]) continue;
            ++result.points;
            for (const double x : r) {
                ++coordinates;
                squares += x * x;
                result.outliers += std::abs(x) > kOutlier * result.noise ? 1 : 0;
            }
        }
        result.rms = coordinates > 0 ? std::sqrt(squares / static_cast<double>(coordinates)) : 0.0;
        // Huber's covariance: (sum of squared pulls / (n - k)) / (share within)^2 times the inverse.
        std::vector<Coordinate> moved = moved_of(now, slopes).first;
        double within = 0.0, pulls = 0.0;
        for (Coordinate& c : moved) {
            const double pull = std::clamp(c.residual, -kHuber * result.noise, kHuber * result.noise);
            within += pull == c.residual ? 1.0 : 0.0;
            pulls += pull * pull;
            c.residual = pull;
        }
        const double n = static_cast<double>(moved.size()), k = static_cast<double>(count());
        const double share = within / std::max(1.0, n);
        const double variance = pulls / std::max(1.0, n - k) / (share * share) * correlation_factor(moved);
        covariance_of(slopes, variance, result);
    }

    void covariance_of(const MatrixXd& slopes, double variance, Fit& result) const {
        const MatrixXd normal = slopes.transpose() * slopes;
        const VectorXd units = units_of(normal);
        const MatrixXd scaled = units.asDiagonal() * normal * units.asDiagonal();
        const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(scaled);
        const Eigen::Index count = normal.rows();
        MatrixXd inverse = MatrixXd::Zero(count, count);
        Eigen::ArrayXd lost = (units.array() == 0.0).cast<double>();
        for (Eigen::Index m = 0; m < count; ++m) {
            const VectorXd mode = modes.eigenvectors().col(m);
            if (modes.eigenvalues()[m] > kNothing * static_cast<double>(count))
                inverse += mode * mode.transpose() / modes.eigenvalues()[m];
            else
                lost += mode.array().square();
        }
        const MatrixXd covariance = variance * (units.asDiagonal() * inverse * units.asDiagonal());
        const std::vector<std::string>& keys = options_.vary;
        for (Eigen::Index i = 0; i < count; ++i) {
            if (units[i] == 0.0)
                result.warnings.push_back(fmt::format("{} has no effect on the tracked positions", keys[i]));
            for (Eigen::Index j = 0; j < i; ++j) {
                const double correlation =
                    inverse(i, j) / std::sqrt(std::max(1e-300, inverse(i, i) * inverse(j, j)));
                const bool both_lost = lost[i] > 1e-6 && lost[j] > 1e-6 && units[i] > 0.0 && units[j] > 0.0;
                if (std::abs(correlation) > kAlike || both_lost)
                    result.warnings.push_back(fmt::format(
                        "the tracks hardly distinguish {} from {} (correlation {:.4f}); vary only one of "
                        "them, or track another shot",
                        keys[j], keys[i], both_lost ? 1.0 : correlation));
            }
        }
        for (Eigen::Index i = 0; i < count; ++i) {
            std::vector<double>& row = result.covariance.emplace_back();
            for (Eigen::Index j = 0; j < count; ++j)
                row.push_back(lost[i] > 1e-6 || lost[j] > 1e-6 ? kInfinity : covariance(i, j));
        }
    }

    const Scene& scene_;
    const std::vector<TrackPoint>& points_;
    const FitOptions& options_;
    kernel::Isa isa_;
    std::vector<std::string> keys_;  // of the numbers of the scene
    std::vector<SceneNumber> numbers_;
    std::optional<std::size_t> clock_;  // its index among all varied numbers
    double last_ = 0.0;
    int shots_ = 0;
};

}  // namespace

std::vector<double> Fit::deviations() const {
    std::vector<double> all;
    for (std::size_t k = 0; k < covariance.size(); ++k) all.push_back(std::sqrt(covariance[k][k]));
    return all;
}

Fit fit(const Scene& scene, const std::vector<TrackPoint>& points, const FitOptions& options,
        kernel::Isa isa) {
    return Fitter(scene, points, options, isa).run();
}

}  // namespace carom::games
