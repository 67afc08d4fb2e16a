// The forces of a contact, of one or of four in lanes, and the step that they allow. Part of contact_phase.cpp and in_space.cpp.
#pragma once

#include "carom/kernel/contact_phase.h"
#include "numbers.h"
#include "simd.h"

namespace carom::kernel {
namespace {

using Four = Pack<4>;

// Stability of the step. The regularised friction is stiff: with k = mu_b F / |s|, friction over slip, the friction
// of one contact makes its slip decay at the rate 7 k, and by the theorem of Gershgorin no rate of all contacts
// together exceeds 7 times the largest sum of k over a ball (the cloth under the ball counts half). Runge-Kutta steps
// are stable up to 2.78 over that rate; a step takes at most 2.5 over it.
constexpr double kStableShare = 2.5 / 7.0;
// Where a slip is still above epsilon, steps of that length would jump over the transition into stick. There k counts
// kResolve times, but no more than its value in stick, mu_b F / epsilon.
constexpr double kResolve = 4.0;

// A number in every lane; T is Four or double.
template <class T>
CAROM_INLINE T fill(double x) {
    if constexpr (sizeof(T) == sizeof(double))
        return x;
    else
        return broadcast<4>(x);
}

// e^-x for x >= 0, as the 64th power of a Taylor series: within 4e-8 of it (relative) up to x = 10. From 64 on it stays at e^-64.
template <class T>
CAROM_INLINE T falling_exponential(T x) {
    const T part = (1.0 / 64.0) * x, one = fill<T>(1.0), t = select(part < one, part, one);
    constexpr double kFactors[] = {-1.0 / 120.0, 1.0 / 24.0, -1.0 / 6.0, 0.5, -1.0, 1.0};
    T power = fill<T>(1.0 / 720.0);
    for (const double factor : kFactors) power = power * t + fill<T>(factor);
    for (int doubling = 0; doubling < 6; ++doubling) power = power * power;
    return power;
}

// The normal force at the overlap d > 0, `memory` its largest since the contact opened; a, b and p are those of HertzLaw.
template <class T>
CAROM_INLINE T normal_force(T a, T b, int p, T d, T memory) {
    const T loading = d * square_root(d);
    T share = d / memory;  // a lane whose memory is 0 does not use it
    for (; p > 1; p /= 2) share = share * share;
    return select(d < memory, loading * (a + b * share), loading);
}

// The largest overlap inside a step in which the overlap stopped growing, from the cubic Hermite interpolant. Without
// it the energy of each contact has an error of order h^2.
CAROM_INLINE double peak(double before, double after, double m0, double m1) {
    // d(s) = d0 + m0 s + (3 rise - 2 m0 - m1) s^2 + (m0 + m1 - 2 rise) s^3; its slope falls from m0 > 0 to m1 < 0.
    const double rise = after - before, q2 = 3.0 * rise - 2.0 * m0 - m1, q3 = m0 + m1 - 2.0 * rise;
    const double s = m0 / (square_root(largest(0.0, q2 * q2 - 3.0 * q3 * m0)) - q2);
    return s > 0.0 && s < 1.0 ? before + s * (m0 + s * (q2 + s * q3)) : 0.0;
}

}  // namespace
}  // namespace carom::kernel
