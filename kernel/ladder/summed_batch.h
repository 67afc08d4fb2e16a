// A batch, impact by impact by the summed march. Where rounding decides the result (glancing impacts, chatter near
// stick) the arithmetic of the published march takes over, eight lanes at once and with the same bits. A result
// depends on its own impact alone and has the same bits on every instruction set; it has the step count of the
// published march, or one beside it where the last step sits on a rounding tie, and differs from it by at most about
// 1e-10 of the approach speed at N up to 1000 (docs/lab/2026-11-ladder.md).
#pragma once

#include "ladder/batch_arrays.h"
#include "ladder/exact_lanes.h"
#include "ladder/summed.h"

namespace carom::kernel {
namespace {

// Speed of a ball or of its surface, in approach speeds, above which the published arithmetic is kept. The baseline
// rounds each velocity by up to half an ulp a step, often to one side: in all by up to 2^-53 N of the fastest speed,
// which from here on is 1.1e-10 of the approach speed at N = 1000 (measured: 0.76e-10). No other order of the sums
// could follow it more closely. Beyond N = 1000 the difference grows with N.
constexpr double kFastestSurface = 1000.0;
// Exact steps after which an impact counts as chattering (near stick, where rounding may decide the sign of a slip).
constexpr long kChatter = 40;

inline bool rounding_decides(const FrameState& s, double R) {
    const double limit = kFastestSurface * (s.v1y - s.v2y);
    const auto fast = [limit](double a) { return absolute(a) > limit; };
    return fast(s.v1x) || fast(s.v1y) || fast(s.v2x) || fast(s.v2y) || fast(R * s.w1x) || fast(R * s.w1y) ||
           fast(R * s.w1z) || fast(R * s.w2x) || fast(R * s.w2y) || fast(R * s.w2z);
}

template <int kSign>
class SummedBatch {
  public:
    SummedBatch(const ImpactBatch& b, int substeps, const ImpactBatchResult& r)
        : batch(b), n(substeps), result(r) {}

    void run() {
        for (long i = 0; i < batch.count; ++i) take(i);
        march_waiting();
    }

  private:
    const ImpactBatch& batch;
    const int n;
    const ImpactBatchResult& result;
    BatchImpact waiting[8];
    int count = 0;

    void take(long i) {
        BatchImpact& in = waiting[count];
        if (!enter_impact(batch, i, n, in, result)) return;
        if (!rounding_decides(in.state, in.params.R)) {
            bool chatters = false;
            const long steps = Summed::march<kSign>(in.state, in.params, n, kChatter, chatters);
            if (!chatters) {
                leave_impact(in, steps, result);
                return;
            }
        }
        if (++count == 8) march_waiting();
    }

    void march_waiting() {
        long steps[8];
        FrameState* states[8];
        ImpactParams params[8];
        for (int i = 0; i < count; ++i) {
            states[i] = &waiting[i].state;
            params[i] = waiting[i].params;
        }
        // One lane alone is slower than no lanes.
        if (count == 1) steps[0] = march_loop<kSign>(*states[0], params[0], n);
        if (count > 1) ExactLanes::march<kSign>(states, params, count, n, steps);
        for (int i = 0; i < count; ++i) leave_impact(waiting[i], steps[i], result);
        count = 0;
    }
};

inline void summed_batch(const ImpactBatch& batch, int n, const ImpactBatchResult& result) noexcept {
    if (batch.params.cloth_slip == ClothSlip::kAsPublished)
        SummedBatch<+1>(batch, n, result).run();
    else
        SummedBatch<-1>(batch, n, result).run();
}

}  // namespace
}  // namespace carom::kernel
