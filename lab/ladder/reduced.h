// Beyond the paper: the reduced state of the kernel's summed march, step by step.
#pragma once

#include "march/reduced.h"

namespace carom::kernel {
namespace {

struct ReducedState {
    template <int kSign>
    static long loop(FrameState& s, const ImpactParams& p, int n) {
        const ReducedConstants k = reduced_constants<kSign>(s, p, n);
        const Reduced start = reduce<kSign>(s, p.R);
        Reduced r = start;
        StopTest stop;
        long steps = 0;
        reduced_steps<kSign>(r, stop, steps, k.limit, k);
        if (stop.goes_on(r.v_n)) return -1;
        expand(s, sums_between<kSign>(start, r, static_cast<double>(steps) * k.h), p.R);
        return steps;
    }
};

}  // namespace
}  // namespace carom::kernel
