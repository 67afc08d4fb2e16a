// Trigonometry from + - * / and sqrt only: every machine, compiler and C library gives the same bits (C
// libraries pick variants by CPU).
#pragma once

#include <numbers>

namespace carom {

/// [degrees] One radian.
inline constexpr double kDegrees = 180.0 / std::numbers::pi;

struct SinCos {
    double sin;
    double cos;
};

/// Sine and cosine of an angle in radians.
///
/// Both are within 1 ulp for |radians| <= 1e6 (reduction by a four-part pi/2 after Cody and Waite, then the
/// Taylor series). Beyond that the absolute error is at most about |radians| 2^-51, the spacing of the
/// argument itself. NaN for both when |radians| >= 2^50 or not finite.
SinCos sin_cos(double radians);

/// Sine and cosine of an angle in degrees, within 1 ulp. The reduction is exact for any size: 90 gives
/// exactly (1, 0), 180 gives (0, -1), 30 gives sine 0.5. NaN for both when not finite.
SinCos sin_cos_deg(double degrees);

/// Tangent of an angle in degrees, within 2 ulp; infinite at 90 and its odd multiples.
double tan_deg(double degrees);

/// Arc cosine in [0, pi], within 2 ulp of pi/2; NaN outside [-1, 1].
double arc_cos(double x);

/// Direction of (x, y) in degrees, -180 to 180, from +x towards +y; 0 for (0, 0), NaN for NaN.
double direction_deg(double x, double y);

/// e^x, within 2 ulp where the result is a normal number; 0 below -745.2, infinite above 709.8, NaN for NaN.
double exponential(double x);

}  // namespace carom
