// The forces of one contact, or of four in lanes, and the permitted steps. Part of contact_phase.cpp and
// in_space.cpp.
#pragma once

#include "carom/kernel/contact_phase.h"
#include "numbers.h"
#include "simd.h"

namespace carom::kernel {
namespace {

using Four = Pack<4>;

// Slopes stored by a step: at the state, of the last inner stage, in the middle and at the end.
constexpr int kStages = 4;

// An explicit Runge-Kutta method. Stage n starts at the state and advances by node[n] of the step along the
// slope of the previous stage (the first one along that of the state). First come `more` inner stages, whose
// slopes are not stored, then the last inner one, the middle and the end.
struct RungeKutta {
    double weight[kStages];
    int more;
    double node[kStages + 3];

    CAROM_INLINE int stages() const { return more + kStages - 1; }
    // Index of the stored slope after the first n stages.
    CAROM_INLINE int slope(int n) const { return n == 0 ? 0 : n > more ? n - more : 1; }
};

// The classical method, of order 4. Without friction nothing is stiff.
constexpr RungeKutta kClassical{{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0}, 0, {0.5, 0.5, 1.0}};
// With friction, which is stiff in stick: order 3 with the weights of Simpson's rule. The inner stages
// provide stability. If Y is the amplification of the middle, that of the step is R = 1 + z/3 + z (2/3 + z/6)
// Y, and order 3 requires Y = 1 + z/2 + z^2/8 + ..., so the last inner node is 1/4. For four stages R = 1 + z
// + z^2/2 + z^3/6 + z^4/48 is at most 0.4 from z = -1 to -4.84 along the negative axis, so that stiff
// components decay within a few steps; the classical method amplifies them beyond -2.78. More inner stages
// reach further, for large friction: chains like those of P. J. van der Houwen and B. P. Sommeijer, "On the
// internal stability of explicit, m-stage Runge-Kutta methods for large m-values", ZAMM 60, 1980. The nodes
// are new: a linear program chose the other coefficients of Y to minimise the largest |R| from -1.5 to the
// end: 0.39 down to -12.2 with six stages, and 0.47 down to -24 with eight. No inner stage amplifies by more
// than 1, nor does a step if the contacts also oscillate (z = x + i y, |y| <= 1) or if z changes by a tenth
// within it. The nodes need all their digits, because R is a sum of terms above 1e4 that cancel.
constexpr RungeKutta kFourStages{{1.0 / 6.0, 0.0, 2.0 / 3.0, 1.0 / 6.0}, 0, {0.25, 0.5, 1.0}};
constexpr RungeKutta kSixStages{
    {1.0 / 6.0, 0.0, 2.0 / 3.0, 1.0 / 6.0}, 2, {0.03309011, 0.09856416, 0.25, 0.5, 1.0}};
constexpr RungeKutta kEightStages{{1.0 / 6.0, 0.0, 2.0 / 3.0, 1.0 / 6.0},
                                  4,
                                  {0.01115974, 0.02860386, 0.05848906, 0.1168041, 0.25, 0.5, 1.0}};

CAROM_INLINE bool has_friction(const HertzLaw& law) {
    return law.mu_b > 0.0 || law.mu_b_more > 0.0;
}

// Stability of the step. The regularised friction is stiff: with k = mu_b F / |s|, friction divided by slip,
// the friction of one contact makes its slip decay at the rate 7 k. Each further contact of one of the two
// balls adds at most 3.5 times its own k. By Gershgorin's theorem no rate of all contacts together exceeds
// 3.5 times the largest sum of k over both balls of a contact. A step of four, six and eight stages may be at
// most 4.8, 12.2 and 24 divided by that.
constexpr double kFourReach = 4.8 / 3.5, kSixReach = 12.2 / 3.5, kEightReach = 24.0 / 3.5;
// Above these step lengths, six stages get further per evaluation than four, and eight further than six.
constexpr double kFromFour = 6.0 / 4.0 * kFourReach, kFromSix = 8.0 / 6.0 * kSixReach;

// A method with friction, and the length of its step.
struct Plan {
    const RungeKutta* method;
    double h;
};

// The method for a step of length `wanted`, or of the longest stable length, if `stiffest` is the largest sum
// of k.
CAROM_INLINE Plan plan_step(double stiffest, double wanted) {
    const double stiff = wanted * stiffest;
    const bool six = kFromFour < stiff, eight = kFromSix < stiff;
    const RungeKutta& method = eight ? kEightStages : six ? kSixStages : kFourStages;
    const double reach = eight ? kEightReach : six ? kSixReach : kFourReach;
    return {&method, reach < stiff ? reach / stiffest : wanted};
}

// Accuracy of the step, with friction: its difference from the midpoint rule, which has the same stages, may
// be kStepError [V] in any velocity and spin. If it is larger, as where a slip turns to stick, the step is
// halved, down to kShortest of the longest one.
constexpr double kStepError = 1e-4, kAimedError = 0.5 * kStepError, kShortest = 1.0 / 64.0;

// Limit of the next step after one of length h with this error; `before` is the limit of that step. The error
// grows as h^3. The fourth root follows it with some damping, and causes fewer second tries than the third.
CAROM_INLINE double step_after(double before, double h, double error) {
    if (!(error > kAimedError / 16.0)) return largest(before, 2.0 * h);
    const double ratio = square_root(square_root(kAimedError / error));
    return ratio > 1.0 ? largest(before, ratio * h) : largest(0.5, ratio) * h;
}

// Slow contacts. A contact at the speed v lasts v^(-1/5) times longer, and its errors are proportional to v,
// so steps may be v^(-1/2) times longer if nothing is faster. The square of v is that of the rate plus the
// energy of the overlap, F d; a closing contact is treated as loaded for the first time.
constexpr double kMostSlow = 16.0;
CAROM_INLINE double slowness(double v2) {
    return v2 < 1.0 ? smallest(kMostSlow, 1.0 / square_root(square_root(v2))) : 1.0;
}

// A number in every lane; T is Four or double.
template <class T>
CAROM_INLINE T fill(double x) {
    if constexpr (sizeof(T) == sizeof(double))
        return x;
    else
        return broadcast<4>(x);
}

// e^-x for x >= 0, as the 64th power of a Taylor series: relative error 4e-8 up to x = 10. Constant above
// x = 64.
template <class T>
CAROM_INLINE T falling_exponential(T x) {
    const T part = (1.0 / 64.0) * x, one = fill<T>(1.0), t = select(part < one, part, one);
    constexpr double kFactors[] = {-1.0 / 120.0, 1.0 / 24.0, -1.0 / 6.0, 0.5, -1.0, 1.0};
    T power = fill<T>(1.0 / 720.0);
    for (const double factor : kFactors) power = power * t + fill<T>(factor);
    for (int doubling = 0; doubling < 6; ++doubling) power = power * power;
    return power;
}

// The normal force at the overlap d > 0. `inverse` is 1 over the largest overlap since the contact opened, or
// kNoMemory; a, b and p are those of HertzLaw.
constexpr double kNoMemory = 1e300;
template <class T>
CAROM_INLINE T normal_force(T a, T b, int p, T d, T inverse) {
    const T loading = d * square_root(d), share = d * inverse;
    T power = share;
    for (; p > 1; p /= 2) power = power * power;
    return select(share < fill<T>(1.0), loading * (a + b * power), loading);
}

// The cloth friction caused by a ball's weight in a time in which it could stop a slip of 7/2 `speed`. Slip
// and velocity change: u = (v_x - R w_y, v_y + R w_x), dv = -min(speed, 2/7 |u|) u/|u|. It is small, so it is
// applied only this often [L/V].
constexpr double kBrakes = 0.5;
CAROM_INLINE void brake(double speed, double& v_x, double& v_y, double& Rw_x, double& Rw_y) {
    const double u_x = v_x - Rw_y, u_y = v_y + Rw_x, slip = square_root(u_x * u_x + u_y * u_y);
    if (!(slip > 0.0)) return;
    const double k = smallest(speed / slip, 2.0 / 7.0), x = k * u_x, y = k * u_y;
    v_x -= x;
    v_y -= y;
    Rw_x -= 2.5 * y;
    Rw_y += 2.5 * x;
}

// [L/V] A longer phase ends as soon as no contact is closed, even if one is about to close: the balls have
// moved far.
constexpr double kLongPhase = 40.0;

// [V] Smaller changes of the balls' speeds by a contact are rounding and may be ignored. Balls that move
// together would close at such speeds forever.
constexpr double kNothing = 1e-12;

// Whether a contact with the overlap d no longer acts: it closes at kNothing at most, and its force F changes
// speeds by at most that until it has opened, or in the remaining time.
CAROM_INLINE bool is_over(double F, double d, double rate, double time_left) {
    return rate <= kNothing && (F * time_left <= kNothing || F * d <= -rate * kNothing);
}

// The largest overlap inside a step in which the overlap stopped growing, from the cubic Hermite interpolant.
// Without it the energy of each contact has an error of order h^2.
CAROM_INLINE double peak(double before, double after, double m0, double m1) {
    // d(s) = d0 + m0 s + (3 rise - 2 m0 - m1) s^2 + (m0 + m1 - 2 rise) s^3; its slope falls from m0 > 0 to m1
    // < 0.
    const double rise = after - before, q2 = 3.0 * rise - 2.0 * m0 - m1, q3 = m0 + m1 - 2.0 * rise;
    const double s = m0 / (square_root(largest(0.0, q2 * q2 - 3.0 * q3 * m0)) - q2);
    return s > 0.0 && s < 1.0 ? before + s * (m0 + s * (q2 + s * q3)) : 0.0;
}

}  // namespace
}  // namespace carom::kernel
