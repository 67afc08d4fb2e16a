// The choice of the instruction set at run time, and texts for the results of kernels.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include "kernel_set.h"

namespace carom::kernel {
namespace {

struct Entry {
    const char* name;
    const KernelSet* kernels;  // null: not built for this kind of processor
};
// In the order of Isa, without kFastest.
#if defined(__x86_64__)
const Entry kEntries[] = {{"scalar", &scalar::kKernels}, {"v3", &v3::kKernels}, {"v4", &v4::kKernels}};
#else
const Entry kEntries[] = {{"scalar", &scalar::kKernels}, {"v3", nullptr}, {"v4", nullptr}};
#endif

#if defined(__x86_64__)
// Tested by feature, because clang 14 lacks the names of the levels. Every processor with these features also
// has the others.
bool has_v3() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2");
}

bool has_v4() {
    return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}

// Vendor and family of this processor.
bool is_zen5() {
    unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
    if (__get_cpuid(1, &eax, &ebx, &ecx, &edx) == 0) return false;
    const unsigned family = (eax >> 8 & 0xf) + (eax >> 20 & 0xff);
    return __builtin_cpu_is("amd") && family == 0x1a;
}

bool is_intel_with_avx512() {
    return __builtin_cpu_is("intel") && has_v4();
}
#else
bool has_v3() {
    return false;
}

bool has_v4() {
    return false;
}
#endif

// Measurements (lab/notes/2026-11-ladder.md): the fastest instruction set for each kernel on this kind of
// processor, in the order of KernelKind.
struct Measured {
    const char* processor;
    bool (*is_this)();
    Isa fastest[kKernelKinds];
};
#if defined(__x86_64__)
constexpr Measured kMeasured[] = {
    {"AMD Zen 5", is_zen5, {Isa::kV4, Isa::kV4, Isa::kV4, Isa::kV4, Isa::kV3}},
    {"Intel with AVX-512", is_intel_with_avx512, {Isa::kV4, Isa::kV3, Isa::kV3, Isa::kV4, Isa::kV4}},
};
#endif

const Measured* this_processor() {
#if defined(__x86_64__)
    static const Measured* const found = [] {
        const Measured* row = nullptr;
        for (const Measured& candidate : kMeasured)
            if (row == nullptr && has_v4() && candidate.is_this()) row = &candidate;
        return row;
    }();
    return found;
#else
    return nullptr;
#endif
}

const KernelSet& kernels_of(KernelKind kind, Isa isa) {
    return *kEntries[static_cast<int>(isa == Isa::kFastest ? fastest_isa(kind) : isa)].kernels;
}

}  // namespace

const char* name(Isa isa) noexcept {
    return isa == Isa::kFastest ? "fastest" : kEntries[static_cast<int>(isa)].name;
}

bool parse_isa(const char* text, Isa& isa) noexcept {
    for (const Isa known : {Isa::kScalar, Isa::kV3, Isa::kV4}) {
        if (std::strcmp(text, name(known)) != 0) continue;
        isa = known;
        return true;
    }
    return false;
}

bool available(Isa isa) noexcept {
    return isa == Isa::kScalar || isa == Isa::kFastest || (isa == Isa::kV3 ? has_v3() : has_v4());
}

Isa best_isa() noexcept {
    return has_v4() ? Isa::kV4 : has_v3() ? Isa::kV3 : Isa::kScalar;
}

Isa fastest_isa(KernelKind kind) noexcept {
    const Measured* known = this_processor();
    return known != nullptr ? known->fastest[static_cast<int>(kind)] : best_isa();
}

const char* measured_processor() noexcept {
    const Measured* known = this_processor();
    return known != nullptr ? known->processor : nullptr;
}

const char* available_isas() noexcept {
    return has_v4() ? "scalar, v3, v4" : has_v3() ? "scalar, v3" : "scalar";
}

IsaChoice isa_from_environment() noexcept {
    IsaChoice choice{Isa::kFastest, ""};
    const char* text = std::getenv("CAROM_ISA");
    if (text == nullptr || *text == '\0') return choice;
    const bool known = parse_isa(text, choice.isa);
    if (known && available(choice.isa)) return choice;
    std::snprintf(choice.problem, sizeof choice.problem, "CAROM_ISA=%.40s: %s; available here: %s", text,
                  known ? "this processor cannot run it" : "no such instruction set", available_isas());
    return choice;
}

MarchFunction march_function(Isa isa) noexcept {
    return kernels_of(KernelKind::kMarch, isa).march;
}

MarchFunction summed_march_function(Isa isa) noexcept {
    return kernels_of(KernelKind::kSummedMarch, isa).summed_march;
}

ToleranceFunction tolerance_function(Isa isa) noexcept {
    return kernels_of(KernelKind::kTolerance, isa).tolerance;
}

ToleranceBatchFunction tolerance_batch_function(Isa isa) noexcept {
    return kernels_of(KernelKind::kToleranceBatch, isa).tolerance_batch;
}

ContactPhaseFunction contact_phase_function(Isa isa) noexcept {
    return kernels_of(KernelKind::kContactPhase, isa).contact_phase;
}

const char* describe(ImpactStatus status) noexcept {
    constexpr const char* kTexts[] = {
        "", "", "a state is not finite, or the centres coincide or differ in height",
        "a parameter is out of range: R, m > 0, frictions >= 0, 0 <= e_b <= 1, substeps >= 1",
        "the integration reached its limit of steps"};
    return kTexts[static_cast<int>(status)];
}

const char* name(ToleranceMethod method) noexcept {
    constexpr const char* kNames[] = {
        "",        "closed_frictionless", "closed_gearing", "closed_stick", "collocation_4", "collocation_8",
        "adaptive"};
    return kNames[static_cast<int>(method)];
}

}  // namespace carom::kernel
