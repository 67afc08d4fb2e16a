// The loop of the published integration: explicit Euler in the normal impulse, equation by equation in
// double.
//
// The names are those of the 2014 paper: P is the normal impulse and dP its step; dP1 and dP2 are the
// horizontal and the vertical friction impulse between the balls; dPix, dPiy, dPjx and dPjy are the impulses
// of the cloth on ball i (1) and ball j (2); C = 5/(2 m R); W is the work of the normal impulse.
#pragma once

#include <cstdint>

#include "carom/kernel/march.h"
#include "frame.h"
#include "loop_marks.h"

namespace carom::kernel {
namespace {

// [m/s] A smaller slip causes no friction, as in the published code. As an absolute speed, it breaks the
// homogeneity of the model at extremely low speed (hard case H26), but this file must agree with the
// published code.
constexpr double kSlipCutoff = 1e-16;

// kSign is +1 for the cloth slip u = (v_x + R w_y, v_y - R w_x), as published, and -1 for the consistent
// sign. Returns the number of steps, or -1 at the limit of steps.
template <int kSign>
std::int64_t march_loop(FrameState& s, const ImpactParams& p, int n) {
    const double R = p.R, m = p.m;
    const double dP = 0.5 * (1.0 + p.e_b) * m * absolute(s.v2y - s.v1y) / n;
    const double C = 5.0 / (2.0 * m * R);
    const double u_floor = cloth_slip_floor(s, R, kSign);
    const std::int64_t limit = kMarchStepLimit * static_cast<std::int64_t>(n);
    double W = 0.0, W_f = 0.0;
    bool compressing = true;
    double v_n = s.v2y - s.v1y;  // < 0 while approaching
    std::int64_t steps = 0;
    while (v_n < 0.0 || compressing || W < W_f) {
        CAROM_LOOP_BEGIN("baseline");
        if (++steps > limit) return -1;
        // The slip at the contact between the balls; u below is the slip of the pressed ball on the cloth.
        const double c_x = s.v1x - s.v2x - R * (s.w1z + s.w2z);
        const double c_z = R * (s.w1x + s.w2x);
        const double c = square_root(c_x * c_x + c_z * c_z);
        double dP1 = 0.0, dP2 = 0.0, dPix = 0.0, dPiy = 0.0, dPjx = 0.0, dPjy = 0.0;
        if (!(c < kSlipCutoff)) {
            dP1 = -p.mu_b * dP * c_x / c;
            if (!(absolute(c_z) < kSlipCutoff)) {
                dP2 = -p.mu_b * dP * c_z / c;
                if (dP2 > 0.0) {  // ball 2 is pressed on the cloth
                    const double u_x = s.v2x + kSign * R * s.w2y, u_y = s.v2y - kSign * R * s.w2x;
                    const double u = square_root(u_x * u_x + u_y * u_y);
                    if (u > u_floor) {
                        dPjx = -p.mu_s2 * (u_x / u) * dP2;
                        dPjy = -p.mu_s2 * (u_y / u) * dP2;
                    }
                } else {  // ball 1 is pressed on the cloth
                    const double u_x = s.v1x + kSign * R * s.w1y, u_y = s.v1y - kSign * R * s.w1x;
                    const double u = square_root(u_x * u_x + u_y * u_y);
                    if (u > u_floor) {
                        dPix = p.mu_s1 * (u_x / u) * dP2;
                        dPiy = p.mu_s1 * (u_y / u) * dP2;
                    }
                }
            }
        }
        s.v1x += (dP1 + dPix) / m;
        s.v1y += (-dP + dPiy) / m;
        s.v2x += (-dP1 + dPjx) / m;
        s.v2y += (dP + dPjy) / m;
        s.w1x += C * (dP2 + dPiy);
        s.w1y += C * -dPix;
        s.w1z += C * -dP1;
        s.w2x += C * (dP2 + dPjy);
        s.w2y += C * -dPjx;
        s.w2z += C * -dP1;
        // Work by the trapezoidal rule. Compression ends with the first step after which the balls separate.
        const double v_n_before = v_n;
        v_n = s.v2y - s.v1y;
        W += 0.5 * dP * absolute(v_n_before + v_n);
        if (compressing && v_n > 0.0) {
            compressing = false;
            W_f = (1.0 + p.e_b * p.e_b) * W;
        }
        CAROM_LOOP_END("baseline");
    }
    return steps;
}

struct PublishedMarch {
    template <int kSign>
    static std::int64_t loop(FrameState& s, const ImpactParams& p, int n) {
        return march_loop<kSign>(s, p, n);
    }
};

}  // namespace
}  // namespace carom::kernel
