#include "kernel_set.h"

namespace carom::kernel::CAROM_ISA_NAMESPACE {

// carom.wasm solves no batches of impacts, and their solver is an eighth of the file.
#ifdef CAROM_NO_IMPACT_BATCHES
constexpr ToleranceBatchFunction kToleranceBatch = nullptr;
#else
constexpr ToleranceBatchFunction kToleranceBatch = tolerance_batch;
#endif

const KernelSet kKernels = {march, summed_march, tolerance_single, kToleranceBatch, contact_phase};

}  // namespace carom::kernel::CAROM_ISA_NAMESPACE
