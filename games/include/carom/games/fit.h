// Fits numbers of a scene to tracked positions of its balls: Gauss-Newton with the derivatives of the shot
// (carom/engine/derivatives.h), Levenberg-Marquardt damping, and Huber's loss against outliers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/engine/row.h"
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
    std::vector<double> values;
    std::vector<std::vector<double>> covariance;
    std::vector<Vec2> residuals;
    bool converged = false;
    std::string message;
    double noise = 0.0;
    std::uint32_t outliers = 0;
    int shots = 0;
    std::vector<std::string> warnings;
    Scene scene;
    std::vector<double> start;
    double rms = 0.0;
    std::uint32_t points = 0;
    std::vector<double> deviations() const;
};
constexpr auto rows_of(const Fit*) {
    return described(
        "FitResult", "A fit, with the names of `scipy.optimize.least_squares` where it has them.",
        row<&Fit::values>("x", "The fitted values, in the order of `vary`."),
        row<&Fit::covariance>(
            "cov",
            "Covariance of `x` if the model is right. Infinite for values that the tracks do not determine, "
            "and for all if the fit failed. Correlated errors of neighbours in time enlarge it.")
            .or_nan(),
        row<&Fit::residuals>("fun", "Of every point: simulated minus tracked [m]; 0 in a pocket."),
        row<&Fit::converged>("success", "The fit converged, and its residuals are noise."),
        row<&Fit::message>("message", "Why it failed, or \"converged\"."),
        row<&Fit::noise>("noise", "Typical residual of a coordinate, without outliers [m]."),
        row<&Fit::outliers>("outliers", "Coordinates farther off than three times the noise."),
        row<&Fit::shots>("nfev", "Shots compared with the tracks; derivatives need more."),
        row<&Fit::warnings>("warnings", "On values that the tracks cannot separate, a sentence each."),
        row<&Fit::scene>("scene", "The scene with the fitted values."),
        row<&Fit::deviations>("std", "Standard deviations of `x`.").or_nan(),
        row<&Fit::start>("start", "The values in the given scene."),
        row<&Fit::rms>("rms", "Of all residuals [m]."),
        row<&Fit::points>("points", "Positions that count: none of a ball in a pocket."));
}

/// @param scene  the start of the fit; its balls should meet the same things in the same order as in the
/// tracks
/// @throws std::invalid_argument for a key that names no number, no points, or more values than coordinates;
/// DerivativeError if the first shot or a number has no derivatives; SimulationError
Fit fit(const Scene& scene, const std::vector<TrackPoint>& points, const FitOptions& options,
        kernel::Isa isa);

}  // namespace carom::games
