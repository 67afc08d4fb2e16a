// Fits numbers of a scene to tracked positions of its balls: Gauss-Newton with the derivatives of the shot
// (carom/engine/derivatives.h), Levenberg-Marquardt damping, and Huber's loss against outliers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/kernel/isa.h"

namespace carom::games {

/// A tracked position of a ball.
struct TrackPoint {
    double time;  ///< [s] since the stroke
    int ball;
    Vec2 place;  ///< of its centre [m]
};

struct FitOptions {
    /// Keys as SceneNumber accepts them, and clock: the time of the stroke in the tracks [s].
    std::vector<std::string> vary;
    int most_shots = 100;  ///< compared with the tracks before giving up
};

struct Fit {
    std::vector<double> values, start;  ///< in the order of FitOptions::vary
    /// Covariance of the values if the model is right. Rows and columns of values that the tracks do not
    /// determine are infinite, and all are if the fit failed. Correlated errors of neighbours in time enlarge
    /// it.
    Eigen::MatrixXd covariance;
    double deviation(std::size_t k) const;
    double noise = 0.0;        ///< [m] typical residual of a coordinate, without outliers
    double rms = 0.0;          ///< [m] of all residuals
    std::size_t points = 0;    ///< that count: not of a ball in a pocket
    std::size_t outliers = 0;  ///< coordinates farther away than three times the noise
    int shots = 0;             ///< compared with the tracks; derivatives need more
    /// Whether the fit converged and its residuals are noise.
    bool converged = false;
    /// Why not.
    std::string trouble;
    /// Warnings about values that the tracks cannot separate, a sentence each.
    std::vector<std::string> warnings;
    std::vector<Vec2> residuals;  ///< [m] of every point: simulated minus tracked; zero if it does not count
    Scene scene;                  ///< with the values
};

/// @param scene  the start of the fit; its balls should meet the same things in the same order as in the
/// tracks
/// @throws std::invalid_argument for a key that names no number, no points, or more values than coordinates;
/// DerivativeError if the first shot or a number has no derivatives; SimulationError
Fit fit(const Scene& scene, const std::vector<TrackPoint>& points, const FitOptions& options,
        kernel::Isa isa);

}  // namespace carom::games
