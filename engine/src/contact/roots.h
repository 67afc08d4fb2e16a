// First time at which a distance decreases to zero. Uses bracketing only: no complex roots, no tolerance for
// imaginary parts. Derivative cascade after Yuksel (HPG 2022); stable rule after Bannerman et al. (2014).
#pragma once

#include <limits>

namespace carom {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// f(t) = c[0] + c[1] t + ... + c[4] t^4 on [0, T], T finite. Returns the first t > 0 at which f reaches 0
/// from above (f(t) >= 0 there up to rounding), or kNever. If f starts at <= 0 (touching and not closing), a
/// later maximum with f <= 0 counts too.
double first_descent(const double (&c)[5], double T);

/// The extrema of such a polynomial within (0, T), in order. @return how many
int extrema(const double (&c)[5], double T, double (&times)[3]);

/// As first_descent() for h0 + h1 t + h2 t^2 / 2 (T may be infinite): the root at which it decreases through
/// 0, by the formula without cancellation; kNever if there is none.
double first_descent_quadratic(double h0, double h1, double h2, double T);

}  // namespace carom
