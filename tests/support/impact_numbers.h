// Numbers of an impact of two balls of radius R and equal mass.
#pragma once

#include <algorithm>
#include <cmath>

#include "carom/kernel/impact.h"

namespace carom::test {

/// Largest difference of any component [m/s]; spins count as R w.
inline double difference(const kernel::ImpactResult& a, const kernel::ImpactResult& b, double R) {
    double most = 0.0;
    const auto take = [&most](double x) { most = std::isnan(x) ? INFINITY : std::max(most, std::fabs(x)); };
    for (int k = 0; k < 3; ++k) {
        take(a.v1[k] - b.v1[k]);
        take(a.v2[k] - b.v2[k]);
        take(R * (a.w1[k] - b.w1[k]));
        take(R * (a.w2[k] - b.w2[k]));
    }
    return most;
}

/// Speed of approach along the line of centres [m/s].
inline double approach_speed(const kernel::Ball& b1, const kernel::Ball& b2) {
    const double dx = b2.r[0] - b1.r[0], dy = b2.r[1] - b1.r[1];
    return ((b1.v[0] - b2.v[0]) * dx + (b1.v[1] - b2.v[1]) * dy) / std::sqrt(dx * dx + dy * dy);
}

/// Kinetic energy of both balls per unit mass, J = 2/5 m R^2.
inline double energy(const double (&v1)[3], const double (&w1)[3], const double (&v2)[3],
                     const double (&w2)[3], double R) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k)
        sum += v1[k] * v1[k] + v2[k] * v2[k] + 0.4 * R * R * (w1[k] * w1[k] + w2[k] * w2[k]);
    return 0.5 * sum;
}

}  // namespace carom::test
