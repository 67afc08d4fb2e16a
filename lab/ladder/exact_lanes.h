// The published march on eight impacts at once, expression by expression: each lane has the baseline's bits.
// For impacts whose result depends on the baseline's rounding.
#pragma once

#include "march/loop.h"
#include "simd.h"

namespace carom::kernel {
namespace {

using Eight = Pack<8>;
using EightMask = Mask<8>;

class ExactLanes {
  public:
    // Marches at most eight states. steps[i] equals that of march_loop(), which finishes a lane far longer
    // than the others.
    template <int kSign>
    static void march(FrameState* const* states, const ImpactParams* params, int count, int n, long* steps) {
        // Idle lanes repeat the last state.
        double rows[kRows][8], start[10][8];
        for (int i = 0; i < 8; ++i) {
            const int j = i < count ? i : count - 1;
            const FrameState& s = *states[j];
            const ImpactParams& p = params[j];
            const double dP = 0.5 * (1.0 + p.e_b) * p.m * absolute(s.v2y - s.v1y) / n;
            const double row[kRows] = {p.R,
                                       p.m,
                                       dP,
                                       0.5 * dP,
                                       -p.mu_b * dP,
                                       -p.mu_s2,
                                       p.mu_s1,
                                       5.0 / (2.0 * p.m * p.R),
                                       cloth_slip_floor(s, p.R, kSign),
                                       1.0 + p.e_b * p.e_b};
            for (int k = 0; k < kRows; ++k) rows[k][i] = row[k];
            const double values[10] = {s.v1x, s.v1y, s.w1x, s.w1y, s.w1z, s.v2x, s.v2y, s.w2x, s.w2y, s.w2z};
            for (int k = 0; k < 10; ++k) start[k][i] = values[k];
        }
        Lanes s{};
        Eight* const values[10] = {&s.v1x, &s.v1y, &s.w1x, &s.w1y, &s.w1z,
                                   &s.v2x, &s.v2y, &s.w2x, &s.w2y, &s.w2z};
        for (int k = 0; k < 10; ++k) *values[k] = load<8>(start[k]);
        s.v_n = s.v2y - s.v1y;
        s.compressing = broadcast<8>(0.0) < broadcast<8>(1.0);
        Constants c;
        for (int k = 0; k < kRows; ++k) c.row[k] = load<8>(rows[k]);
        int waiting = (1 << count) - 1;
        for (int i = 0; i < count; ++i) steps[i] = 0;
        const long patience = static_cast<long>(n) + n / 8 + 64;
        for (long m = 1; m <= patience && waiting != 0; ++m) {
            step<kSign>(s, c);
            const int ended = waiting & ~bits(goes_on(s));
            if (ended == 0) [[likely]]
                continue;
            double end[10][8];
            for (int k = 0; k < 10; ++k) store(end[k], *values[k]);
            for (int i = 0; i < count; ++i) {
                if ((ended >> i & 1) == 0) continue;
                *states[i] = {end[0][i], end[1][i], end[2][i], end[3][i], end[4][i],
                              end[5][i], end[6][i], end[7][i], end[8][i], end[9][i]};
                steps[i] = m;
            }
            waiting &= ~ended;
        }
        for (int i = 0; i < count; ++i)
            if (waiting >> i & 1) steps[i] = march_loop<kSign>(*states[i], params[i], n);
    }

  private:
    enum { kR, kM, kDP, kHalfDP, kFriction, kMu2, kMu1, kC, kFloor, kWorkRatio, kRows };
    struct Constants {
        Eight row[kRows];
    };
    struct Lanes {
        Eight v1x, v1y, w1x, w1y, w1z, v2x, v2y, w2x, w2y, w2z, v_n, W, W_f;
        EightMask compressing;
    };

    static EightMask goes_on(const Lanes& s) {
        return (s.v_n < broadcast<8>(0.0)) | s.compressing | (s.W < s.W_f);
    }

    // The step of march_loop(), with masks for its branches.
    template <int kSign>
    static void step(Lanes& s, const Constants& c) {
        const Eight R = c.row[kR], m = c.row[kM], dP = c.row[kDP], C = c.row[kC], zero = broadcast<8>(0.0);
        const Eight c_x = s.v1x - s.v2x - R * (s.w1z + s.w2z), c_z = R * (s.w1x + s.w2x);
        const Eight slip = square_root(c_x * c_x + c_z * c_z);
        const EightMask slips = ~(slip < broadcast<8>(kSlipCutoff));
        const EightMask turns = slips & ~(absolute(c_z) < broadcast<8>(kSlipCutoff));
        const Eight dP1 = select(slips, c.row[kFriction] * c_x / slip, zero);
        const Eight dP2 = select(turns, c.row[kFriction] * c_z / slip, zero);
        // Equivalent to dP2 > 0, but known before any root.
        const EightMask second = c_z < zero;
        const Eight spin_y = R * select(second, s.w2y, s.w1y), spin_x = R * select(second, s.w2x, s.w1x);
        const Eight v_x = select(second, s.v2x, s.v1x), v_y = select(second, s.v2y, s.v1y);
        const Eight u_x = kSign > 0 ? v_x + spin_y : v_x - spin_y,
                    u_y = kSign > 0 ? v_y - spin_x : v_y + spin_x;
        const Eight u = square_root(u_x * u_x + u_y * u_y);
        const Eight mu = select(second, c.row[kMu2], c.row[kMu1]);
        const EightMask cloth = turns & (c.row[kFloor] < u);
        const Eight dQx = select(cloth, mu * (u_x / u) * dP2, zero),
                    dQy = select(cloth, mu * (u_y / u) * dP2, zero);
        const Eight dPix = select(second, zero, dQx), dPiy = select(second, zero, dQy);
        const Eight dPjx = select(second, dQx, zero), dPjy = select(second, dQy, zero);
        s.v1x = s.v1x + (dP1 + dPix) / m;
        s.v1y = s.v1y + (dPiy - dP) / m;
        s.v2x = s.v2x + (dPjx - dP1) / m;
        s.v2y = s.v2y + (dP + dPjy) / m;
        s.w1x = s.w1x + C * (dP2 + dPiy);
        s.w1y = s.w1y - C * dPix;
        s.w1z = s.w1z - C * dP1;
        s.w2x = s.w2x + C * (dP2 + dPjy);
        s.w2y = s.w2y - C * dPjx;
        s.w2z = s.w2z - C * dP1;
        const Eight before = s.v_n;
        s.v_n = s.v2y - s.v1y;
        s.W = s.W + c.row[kHalfDP] * absolute(before + s.v_n);
        const EightMask crosses = s.compressing & (zero < s.v_n);
        s.W_f = select(crosses, c.row[kWorkRatio] * s.W, s.W_f);
        s.compressing = s.compressing & ~crosses;
    }
};

}  // namespace
}  // namespace carom::kernel
