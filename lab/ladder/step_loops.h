// Shared by the ladder's variants: constants, and loops with the published stop test. A variant contains only
// its differences: a step, or its own loop.
#pragma once

#include "carom/kernel/march.h"
#include "march/drive.h"
#include "march/loop.h"

namespace carom::kernel {
namespace {

// Named as in march/loop.h.
struct Constants {
    double R, m, mu_s1, mu_s2, mu_b, dP, C, e_b, u_floor;
    long limit;
};

template <int kSign>
Constants constants(const FrameState& s, const ImpactParams& p, int n) {
    return {p.R,
            p.m,
            p.mu_s1,
            p.mu_s2,
            p.mu_b,
            0.5 * (1.0 + p.e_b) * p.m * absolute(s.v2y - s.v1y) / n,
            5.0 / (2.0 * p.m * p.R),
            p.e_b,
            cloth_slip_floor(s, p.R, kSign),
            kMarchStepLimit * static_cast<long>(n)};
}

// The friction impulses of one step, in the frame of the contact.
struct Impulses {
    double dP1 = 0.0, dP2 = 0.0, dPix = 0.0, dPiy = 0.0, dPjx = 0.0, dPjy = 0.0;
};

// Applies the impulses with the expressions of the baseline.
inline void apply(FrameState& s, const Constants& k, const Impulses& d) {
    s.v1x += (d.dP1 + d.dPix) / k.m;
    s.v1y += (-k.dP + d.dPiy) / k.m;
    s.v2x += (-d.dP1 + d.dPjx) / k.m;
    s.v2y += (k.dP + d.dPjy) / k.m;
    s.w1x += k.C * (d.dP2 + d.dPiy);
    s.w1y += k.C * -d.dPix;
    s.w1z += k.C * -d.dP1;
    s.w2x += k.C * (d.dP2 + d.dPjy);
    s.w2y += k.C * -d.dPjx;
    s.w2z += k.C * -d.dP1;
}

// The loop of the published march around Step::step<kSign>(state, constants).
template <class Step, int kSign>
long single_loop(FrameState& s, const ImpactParams& p, int n) {
    const Constants k = constants<kSign>(s, p, n);
    double W = 0.0, W_f = 0.0, v_n = s.v2y - s.v1y;
    bool compressing = true;
    long steps = 0;
    while (v_n < 0.0 || compressing || W < W_f) {
        if (++steps > k.limit) return -1;
        Step::template step<kSign>(s, k);
        const double v_n_before = v_n;
        v_n = s.v2y - s.v1y;
        W += 0.5 * k.dP * absolute(v_n_before + v_n);
        if (compressing && v_n > 0.0) {
            compressing = false;
            W_f = (1.0 + k.e_b * k.e_b) * W;
        }
    }
    return steps;
}

// Section 3.3: the same as two loops, for compression and restitution, so that neither tests the phase.
template <class Step, int kSign>
long two_stage_loop(FrameState& s, const ImpactParams& p, int n) {
    const Constants k = constants<kSign>(s, p, n);
    double W = 0.0, v_n = s.v2y - s.v1y;
    long steps = 0;
    const auto advance = [&] {
        Step::template step<kSign>(s, k);
        const double v_n_before = v_n;
        v_n = s.v2y - s.v1y;
        W += 0.5 * k.dP * absolute(v_n_before + v_n);
    };
    while (!(v_n > 0.0)) {
        if (++steps > k.limit) return -1;
        advance();
    }
    const double W_f = (1.0 + k.e_b * k.e_b) * W;
    while (v_n < 0.0 || W < W_f) {
        if (++steps > k.limit) return -1;
        advance();
    }
    return steps;
}

// Variants that differ only in the step.
template <class Step>
struct WithStep {
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        return single_loop<Step, kSign>(s, p, n);
    }
};
template <class Step>
struct InTwoStages {
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        return two_stage_loop<Step, kSign>(s, p, n);
    }
};

}  // namespace
}  // namespace carom::kernel
