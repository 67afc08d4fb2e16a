// Beyond the paper: shared by the variants that execute every step of one impact in vectors. The march is
// divided into stretches in which neither the pressed side nor the phase (compression, restitution) can
// change. A stretch marches only the slip between the balls (x, |z|) and the cloth slip (a, b) of the pressed
// ball. The other ball's slip, v_n and the work follow at its end from linear invariants. A variant contains
// only the march of a stretch.
#pragma once

#include <immintrin.h>

#include "loop_marks.h"
#include "march/reduced.h"

namespace carom::kernel {
namespace {

// A stretch of `count` steps, in and out.
struct Stretch {
    double x, a, z, b;    // slips, z >= 0
    double sum_z, sum_b;  // of z and b before each step
};

// The constants of a stretch; mu_s is that of the pressed ball.
struct StretchConstants {
    double h, mu_h, mu_hs, u_floor;
};

template <class March, int kSign>
class StretchMarch {
  public:
    StretchMarch(const Reduced& start, const ReducedConstants& constants) : r(start), k(constants) {}

    long run() {
        while (stop.goes_on(r.v_n)) {
            if (steps > k.limit) return -1;
            const long count = safe_steps();
            if (count < 12)
                reduced_steps<kSign>(r, stop, steps, count > 1 ? count : 1, k);
            else
                stretch(count);
        }
        return steps;
    }

    Reduced r;

  private:
    static constexpr double kKappa = 1.0 - 2.5 * kSign;
    ReducedConstants k;
    StopTest stop;
    long steps = 0;

    // Number of steps within which the phase cannot end and |z| cannot reach zero. In a step v_n grows by at
    // most (2 + mu_s mu_b) h and |z| falls by at most (5 + 5/2 mu_s) mu_b h.
    long safe_steps() const {
        const int pressed = r.z < 0.0;
        const double mu_s = k.mu_s[pressed], growth = 2.0 * k.h + mu_s * k.mu_h, v = r.v_n;
        double count = -v / growth;
        if (!stop.compressing) {
            const double missing = (stop.W_f - stop.W) / k.h;
            count =
                missing > 0.0 && v >= 0.0 ? (square_root(v * v + 2.0 * growth * missing) - v) / growth : 0.0;
        }
        const double fall = (5.0 + 2.5 * mu_s) * k.mu_h, size = absolute(r.z);
        if (size > 0.0 && count * fall > size) count = size / fall;
        if (count > 1e6) count = 1e6;
        return count < 3.0 ? 0 : static_cast<long>(count) - 2;
    }

    void stretch(long count) {
        const int pressed = r.z < 0.0, other = 1 - pressed;
        const double Z0 = absolute(r.z), a0 = r.Ux[pressed], b0 = r.Uy[pressed];
        Stretch s{r.x, a0, Z0, b0, 0.0, 0.0};
        March::template march<kSign>(s, {k.h, k.mu_h, k.mu_h * k.mu_s[pressed], k.u_floor}, count);
        // The sums of q_y, xi and t, from the invariants of a stretch of M steps.
        constexpr double kForQ = 1.0 / (1.0 - 1.25 * kSign);
        const double M = static_cast<double>(count), p = M * k.h;
        const double dx = s.x - r.x, da = s.a - a0, dZ = s.z - Z0, db = s.b - b0;
        const double Q = kForQ * (p + 0.5 * kSign * dZ - db), T = 0.2 * (2.5 * Q - dZ);
        const double Xi = (kKappa * dx + da) / (1.0 - 7.0 * kKappa);
        const double sum_Q =
            kForQ * (0.5 * k.h * M * (M - 1.0) + 0.5 * kSign * (s.sum_z - M * Z0) - (s.sum_b - M * b0));
        const double dv = 2.0 * p - Q, sum_v = M * r.v_n + k.h * M * (M - 1.0) - sum_Q;
        stop.W += k.h * absolute(sum_v + 0.5 * dv);
        r.x = s.x;
        r.z = pressed ? -s.z : s.z;
        r.Ux[pressed] = s.a;
        r.Uy[pressed] = s.b;
        r.Ux[other] += Xi;
        r.Uy[other] += p + 2.5 * kSign * T;
        r.v_n += dv;
        steps += count;
    }
};

// A variant that marches its stretches with March.
template <class March>
struct InStretches {
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        const ReducedConstants k = reduced_constants<kSign>(s, p, n);
        const Reduced start = reduce<kSign>(s, p.R);
        StretchMarch<March, kSign> march(start, k);
        const long steps = march.run();
        if (steps < 0) return -1;
        expand(s, sums_between<kSign>(start, march.r, static_cast<double>(steps) * k.h), p.R);
        return steps;
    }
};

}  // namespace
}  // namespace carom::kernel
