// A batch, impact by impact with the kernel's summed march. If that gives up, the published march's
// arithmetic continues on eight lanes at once with the same bits: every impact has the bits of the kernel's
// summed march.
#pragma once

#include "ladder/batch_arrays.h"
#include "ladder/exact_lanes.h"
#include "march/summed.h"

namespace carom::kernel {
namespace {

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
        const long steps = Summed::loop<kSign>(in.state, in.params, n);
        if (steps >= 0) {
            leave_impact(in, steps, result);
            return;
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
        // A single lane is slower than scalar code.
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
