// One impact solved to a tolerance: check, scale, solve, project back.
#pragma once

#include "tolerance/solve.h"
#include "unlike/unlike.h"

namespace carom::kernel {
namespace {

// The cloth slip of a rolling ball is rounding: up to this fraction of the speeds it counts as zero.
constexpr double kSlipNoise = 0x1p-49;

// Loosest tolerance used. A looser one would save nothing, and the iteration could stop so early that energy
// rises.
constexpr double kLoosestSolved = 1e-3;

// Effect of an impulse on a ball, relative to its effect on one of two equal balls with the same reduced
// mass: 2 m_r/m_i, from 0 to 2, with the sum 2. For equal balls it is exactly 1.
struct Shares {
    double one, two;
};

CAROM_INLINE Shares shares(const ImpactParams& p) {
    const double two = impulse_share(p.mass_ratio, 1.0);
    return {two * p.mass_ratio, two};
}

CAROM_INLINE bool tolerance_in_range(const ImpactParams& p, const Shares& share, double tolerance) {
    return tolerance >= kTightestTolerance && tolerance <= kLoosestTolerance && p.radius_ratio == 1.0 &&
           p.mass_ratio >= 1.0 / kFastMassRatio && p.mass_ratio <= kFastMassRatio &&
           p.mu_b <= kLargestFriction && share.one * p.mu_s1 <= kLargestFriction &&
           share.two * p.mu_s2 <= kLargestFriction;
}

// Brings an impact into canonical form. Returns whether ball 2 is pressed on the cloth.
//
// Impulses are divided by twice the reduced mass. With the share f of the pressed ball, cloth friction acts
// on its own slip u as in x' = -7 xi + f g_a and u' = f (..., ... - kappa g). So f mu_s, kappa/f and u/f
// replace mu_s, kappa and u in the equations of equal balls, which use only the direction of u. Their g is
// then the change of the pressed ball's velocity.
CAROM_INLINE bool pose(const FrameState& s, const ImpactParams& p, const Shares& share, double tolerance,
                       Problem& problem) {
    const double R = p.R, n = s.v1y - s.v2y, scale = 1.0 / n;
    const double x = s.v1x - s.v2x - R * (s.w1z + s.w2z), z = R * (s.w1x + s.w2x);
    const bool second = z < 0.0, published = p.cloth_slip == ClothSlip::kAsPublished;
    const double vx = second ? s.v2x : -s.v1x, vy = second ? s.v2y : -s.v1y;
    const double wx = R * (second ? s.w2x : -s.w1x), wy = R * (second ? s.w2y : -s.w1y);
    const double a = published ? vx + wy : vx - wy, b = published ? vy - wx : vy + wx;
    const double noise = kSlipNoise * ((magnitude(vx) + magnitude(wy)) + (magnitude(vy) + magnitude(wx)));
    const double slight = largest(noise, (0.01 * tolerance) * n);
    const double f = second ? share.two : share.one, own = 1.0 / f;
    problem.from_rest = a * a + b * b <= slight * slight;
    problem.start.x = x * scale;
    problem.start.z = magnitude(z) * scale;
    problem.start.a = problem.from_rest ? 0.0 : a * scale * own;
    problem.start.b = problem.from_rest ? 0.0 : b * scale * own;
    problem.start.v = -1.0;
    problem.model.mu_b = p.mu_b;
    problem.model.mu_s = f * (second ? p.mu_s2 : p.mu_s1);
    problem.model.sigma = published ? 2.5 : -2.5;
    problem.model.kappa = own * (published ? -1.5 : 3.5);
    problem.model.e_b = p.e_b;
    problem.tolerance = tolerance;
    return second;
}

// Adds the impulses, which are scaled by the approach speed n, to the velocities.
CAROM_INLINE void apply(const Impulses& t, double n, double R, const Shares& share, bool second,
                        FrameState& s) {
    const double p = n * t.p, xi = n * t.xi, zeta = second ? n * t.zeta : -(n * t.zeta);
    const double g_a = n * t.g_a, g_b = n * t.g_b, spin = 2.5 / R;
    const double a1 = second ? 0.0 : g_a, b1 = second ? 0.0 : g_b, a2 = second ? -g_a : 0.0,
                 b2 = second ? -g_b : 0.0;
    s.v1x += a1 - share.one * xi;
    s.v1y += b1 - share.one * p;
    s.v2x += a2 + share.two * xi;
    s.v2y += b2 + share.two * p;
    s.w1x += spin * (share.one * zeta + b1);
    s.w1y -= spin * a1;
    s.w1z += spin * (share.one * xi);
    s.w2x += spin * (share.two * zeta + b2);
    s.w2y -= spin * a2;
    s.w2z += spin * (share.two * xi);
}

CAROM_INLINE void solve_impact(const Ball& ball1, const Ball& ball2, const ImpactParams& params,
                               double tolerance, ImpactResult& result) {
    const Shares share = shares(params);
    if (!tolerance_in_range(params, share, tolerance)) {
        if (alike(params))
            copy_input(ball1, ball2, ImpactStatus::kBadParameter, result);
        else
            solve_unlike(ball1, ball2, params, tolerance, result);
        return;
    }
    Frame frame;
    FrameState state;
    if (enter_frame<true>(ball1, ball2, params, frame, state, result) != ImpactStatus::kOk) return;
    Problem problem;
    Solution solution;
    const double n = state.v1y - state.v2y;
    // The lighter ball gets up to twice the error of the impulse.
    const double solved = smallest(tolerance, kLoosestSolved) / largest(share.one, share.two);
    const bool second = pose(state, params, share, solved, problem);
    solve(problem, solution);
    apply(solution.total, n, params.R, share, second, state);
    leave_frame(ball1, ball2, frame, state, solution.sweeps, result);
    result.method = solution.method;
    // With a radius close to zero the spins overflow.
    if (!(finite(result.w1) && finite(result.w2))) copy_input(ball1, ball2, ImpactStatus::kBadState, result);
}

}  // namespace

}  // namespace carom::kernel
