// The published integration, the plain reference for every faster variant. Built once per instruction set.
#include "kernel_set.h"
#include "march/drive.h"
#include "march/loop.h"
#include "unlike/unlike.h"

namespace carom::kernel::CAROM_ISA_NAMESPACE {

void march(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n,
           ImpactResult& result) noexcept {
    if (!alike(params)) {
        march_unlike(ball1, ball2, params, n, result);
        return;
    }
    drive<PublishedMarch>(ball1, ball2, params, n, result);
}

}  // namespace carom::kernel::CAROM_ISA_NAMESPACE
