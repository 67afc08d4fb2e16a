// Fits numbers of a scene to tracked places of its balls: Gauss-Newton with the derivatives of the shot
// (carom/engine/tangents.h), damped after Levenberg and Marquardt, with Huber's loss against outliers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/kernel/isa.h"

namespace carom::games {

/// A ball seen at a place.
struct TrackPoint {
    double time;  ///< [s] since the stroke
    int ball;
    Vec2 place;  ///< of its centre [m]
};

struct FitOptions {
    /// Keys as SceneNumber accepts them; and clock, the time of the stroke on the clock of the tracks [s].
    std::vector<std::string> vary;
    int most_shots = 100;  ///< simulated until it gives up
};

struct Fit {
    std::vector<double> values, start;  ///< in the order of FitOptions::vary
    /// Of the values, if the model is right; its rows and columns are infinite for what the tracks do not
    /// determine, and all of them if the fit is refused. Neighbours in time that err alike enlarge it.
    Eigen::MatrixXd covariance;
    double deviation(std::size_t k) const;
    double noise = 0.0;        ///< [m] typical residual of a coordinate, without outliers
    double rms = 0.0;          ///< [m] of all residuals
    std::size_t points = 0;    ///< that count: not those of a ball in a pocket
    std::size_t outliers = 0;  ///< coordinates farther away than three times the noise
    int shots = 0;             ///< simulated
    /// Whether it came to an end, and its residuals are noise.
    bool converged = false;
    /// Why not.
    std::string trouble;
    /// Values that the tracks cannot separate, a sentence each.
    std::vector<std::string> warnings;
    std::vector<Vec2> residuals;  ///< [m] of every point: simulated minus seen; zero if it does not count
    Scene scene;                  ///< with the values
};

/// @param scene  where the fit starts: its shot should meet the same things in the same order as the tracks
/// @throws std::invalid_argument for a key that names no number, no points, or more values than coordinates;
/// TangentError if the first shot or a number has no derivatives; SimulationError
Fit fit(const Scene& scene, const std::vector<TrackPoint>& points, const FitOptions& options,
        kernel::Isa isa);

}  // namespace carom::games
