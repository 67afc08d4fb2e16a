// One kernel of every kind, built for one instruction set.
//
// The sources in march/, tolerance/ and contact_phase/ are compiled once per instruction set. The build
// defines CAROM_ISA_NAMESPACE as scalar, v3 or v4: the namespace of a source's exports.
#pragma once

#include <cstdint>

#include "carom/kernel/contact_phase.h"
#include "carom/kernel/isa.h"
#include "carom/kernel/march.h"
#include "carom/kernel/tolerance.h"

namespace carom::kernel {

struct KernelSet {
    MarchFunction march;
    MarchFunction summed_march;
    ToleranceFunction tolerance;
    ToleranceBatchFunction tolerance_batch;
    ContactPhaseFunction contact_phase;
};

namespace scalar {
constexpr Isa kIsa = Isa::kScalar;
extern const KernelSet kKernels;
}  // namespace scalar
#if defined(__x86_64__)
namespace v3 {
constexpr Isa kIsa = Isa::kV3;
extern const KernelSet kKernels;
}  // namespace v3
namespace v4 {
constexpr Isa kIsa = Isa::kV4;
extern const KernelSet kKernels;
}  // namespace v4
#endif

#ifdef CAROM_ISA_NAMESPACE
namespace CAROM_ISA_NAMESPACE {
void march(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n,
           ImpactResult& result) noexcept;
void summed_march(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n,
                  ImpactResult& result) noexcept;
void tolerance_single(const Ball& ball1, const Ball& ball2, const ImpactParams& params, double tolerance,
                      ImpactResult& result) noexcept;
void tolerance_batch(const ImpactBatch& batch, double tolerance, const ImpactBatchResult& result) noexcept;
std::int64_t contact_phase(const ContactPhase& phase, const HertzLaw& law, double tolerance,
                           double look_ahead, double time_limit) noexcept;
}  // namespace CAROM_ISA_NAMESPACE
#endif

}  // namespace carom::kernel
