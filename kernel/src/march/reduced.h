// The integration in a reduced state. The ten velocities follow from six numbers and the normal impulse,
// because every change is a sum of five impulses per unit mass: Xi (horizontal friction), T (vertical
// friction), Q (two of the cloth) and p (normal).
//
//   x = v1x - v2x - R (w1z + w2z), z = R (w1x + w2x)     slip between the balls
//   U[1] = u2, U[0] = -u1                                cloth slips; -u1 gives both sides the same equations
//
// With c = |(x, z)|, A = mu_b h / c, xi = A x, t = A |z| and the pressed ball's q = mu_s t U / |U| one step
// is
//
//   x += -7 xi + q_x          |z| += -5 t + 5/2 q_y          v_n += 2 h - q_y
//   U_pressed += (xi - kappa q_x, h - 5/2 sigma t - kappa q_y)
//   U_other   += (xi, h + 5/2 sigma t)                       kappa = 1 - 5/2 sigma
//
// sigma = +1 as published, -1 consistent. Ball 2 (index 1) is pressed if z < 0.
#pragma once

#include <cstdint>

#include "carom/kernel/march.h"
#include "frame.h"
#include "march/loop.h"

namespace carom::kernel {
namespace {

struct Reduced {
    double x, z, v_n;
    double Ux[2], Uy[2];
};

template <int kSign>
Reduced reduce(const FrameState& s, double R) {
    return {s.v1x - s.v2x - R * (s.w1z + s.w2z),
            R * (s.w1x + s.w2x),
            s.v2y - s.v1y,
            {-(s.v1x + kSign * R * s.w1y), s.v2x + kSign * R * s.w2y},
            {-(s.v1y - kSign * R * s.w1x), s.v2y - kSign * R * s.w2x}};
}

// The sums over a whole impact, from which the outputs follow.
struct Sums {
    double Xi, PZ, QX[2], QY[2], p;  // PZ: vertical friction, positive if it presses ball 2
};

// The sums from the first and the last state alone: the invariants are linear.
template <int kSign>
Sums sums_between(const Reduced& a, const Reduced& b, double p) {
    constexpr double kKappa = 1.0 - 2.5 * kSign;
    const double d0x = b.Ux[0] - a.Ux[0], d1x = b.Ux[1] - a.Ux[1], d0y = b.Uy[0] - a.Uy[0],
                 d1y = b.Uy[1] - a.Uy[1];
    Sums s;
    s.p = p;
    s.Xi = (kKappa * (b.x - a.x) + d0x + d1x) / (2.0 - 7.0 * kKappa);
    s.PZ = 0.5 * (0.4 * kKappa * (b.z - a.z) - (d1y - d0y));
    s.QX[0] = (s.Xi - d0x) / kKappa;
    s.QX[1] = (s.Xi - d1x) / kKappa;
    s.QY[0] = (p + 2.5 * kSign * s.PZ - d0y) / kKappa;
    s.QY[1] = (p - 2.5 * kSign * s.PZ - d1y) / kKappa;
    return s;
}

inline void expand(FrameState& f, const Sums& s, double R) {
    const double spin = 2.5 / R;
    f.v1x += s.QX[0] - s.Xi;
    f.v1y += s.QY[0] - s.p;
    f.v2x += s.Xi - s.QX[1];
    f.v2y += s.p - s.QY[1];
    f.w1x += spin * (s.PZ + s.QY[0]);
    f.w2x += spin * (s.PZ - s.QY[1]);
    f.w1y -= spin * s.QX[0];
    f.w2y += spin * s.QX[1];
    f.w1z += spin * s.Xi;
    f.w2z += spin * s.Xi;
}

struct ReducedConstants {
    double h, mu_h, mu_s[2], work_ratio, u_floor;  // step of p, mu_b h, 1 + e_b^2
    std::int64_t limit;
};

template <int kSign>
ReducedConstants reduced_constants(const FrameState& s, const ImpactParams& p, int n) {
    const double h = 0.5 * (1.0 + p.e_b) * absolute(s.v2y - s.v1y) / n;
    return {h,
            p.mu_b * h,
            {p.mu_s1, p.mu_s2},
            1.0 + p.e_b * p.e_b,
            cloth_slip_floor(s, p.R, kSign),
            kMarchStepLimit * static_cast<std::int64_t>(n)};
}

template <int kSign>
void reduced_step(Reduced& r, const ReducedConstants& k) {
    constexpr double kKappa = 1.0 - 2.5 * kSign;
    const int pressed = r.z < 0.0, other = 1 - pressed;
    const double size = absolute(r.z), c = square_root(r.x * r.x + r.z * r.z);
    double xi = 0.0, t = 0.0, q_x = 0.0, q_y = 0.0;
    if (!(c < kSlipCutoff)) {
        const double A = k.mu_h / c;
        xi = A * r.x;
        if (!(size < kSlipCutoff)) {
            t = A * size;
            const double a = r.Ux[pressed], b = r.Uy[pressed], u = square_root(a * a + b * b);
            if (u > k.u_floor) {
                const double B = k.mu_s[pressed] * t / u;
                q_x = B * a;
                q_y = B * b;
            }
        }
    }
    const double moved = size - 5.0 * t + 2.5 * q_y;
    r.z = pressed ? -moved : moved;
    r.x += q_x - 7.0 * xi;
    r.v_n += 2.0 * k.h - q_y;
    r.Ux[pressed] += xi - kKappa * q_x;
    r.Uy[pressed] += k.h - 2.5 * kSign * t - kKappa * q_y;
    r.Ux[other] += xi;
    r.Uy[other] += k.h + 2.5 * kSign * t;
}

// The published stop test on (v_n, W); W per unit mass.
struct StopTest {
    double W = 0.0, W_f = 0.0;
    bool compressing = true;

    bool goes_on(double v_n) const { return v_n < 0.0 || compressing || W < W_f; }
    void take(double before, double after, const ReducedConstants& k) {
        W += 0.5 * k.h * absolute(before + after);
        if (compressing && after > 0.0) {
            compressing = false;
            W_f = k.work_ratio * W;
        }
    }
};

// Makes exact steps until the impact ends or `count` steps are done.
template <int kSign>
void reduced_steps(Reduced& r, StopTest& stop, std::int64_t& steps, std::int64_t count,
                   const ReducedConstants& k) {
    for (; count > 0 && stop.goes_on(r.v_n); --count, ++steps) {
        const double before = r.v_n;
        reduced_step<kSign>(r, k);
        stop.take(before, r.v_n, k);
    }
}

}  // namespace
}  // namespace carom::kernel
