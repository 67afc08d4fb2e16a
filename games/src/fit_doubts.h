// Whether the residuals of a fit are noise: if they are not, its standard deviations mean nothing.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/games/fit.h"

namespace carom::games {

/// [of the noise] A residual above this is an outlier.
inline constexpr double kOutlier = 3.0;
/// [-] The noise is this many times the median residual, as for a normal distribution.
inline constexpr double kMedian = 1.4826;

/// 0 for an empty list.
double median(std::vector<double> list);

/// A coordinate that counts.
struct Coordinate {
    int ball, axis;
    double time;      ///< [s]
    double residual;  ///< [m] simulated minus seen
    double velocity;  ///< [m/s] of the ball along it
    double place;     ///< [m] simulated
    double seen;      ///< [m]
};

/// Ratio of the tracked coordinates to the simulated ones: 1000 if they are in mm.
double scale_of(const std::vector<Coordinate>& coordinates);
/// Why the fit rejects positions of this scale, or "".
std::string doubt_of_scale(double scale);

/// Why a converged fit is rejected, or "".
/// @param moved  the coordinates that the varied numbers move
/// @param slopes  their derivatives with respect to these numbers
/// @param noise  [m] typical residual
/// @param clock  whether the clock was varied
std::string doubt_of(const std::vector<Coordinate>& moved, const Eigen::MatrixXd& slopes, double noise,
                     bool clock);

/// Why positions more than a ball's radius off, or no better than straight lines, are no fit, or "".
/// @param moved  as in doubt_of()  @param record  the shot at the start of the fit
std::string doubt_of_distance(const std::vector<Coordinate>& moved, double noise, const Record& record,
                              const std::vector<TrackPoint>& points);

/// The factor by which correlated errors of neighbours in time increase the variance.
double correlation_factor(std::vector<Coordinate> moved);

}  // namespace carom::games
