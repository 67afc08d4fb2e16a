#include "kernel_set.h"

namespace carom::kernel::CAROM_ISA_NAMESPACE {

const KernelSet kKernels = {march, summed_march, tolerance_single, tolerance_batch, contact_phase};

}  // namespace carom::kernel::CAROM_ISA_NAMESPACE
