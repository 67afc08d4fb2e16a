// The choice of the instruction set at run time, and the texts of what a kernel reports.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "kernel_set.h"

namespace carom::kernel {
namespace {

struct Entry {
    Isa isa;
    const char* name;
    const KernelSet& kernels;
};
// In the order of Isa.
const Entry kEntries[] = {{Isa::kScalar, "scalar", scalar::kKernels},
                          {Isa::kV3, "v3", v3::kKernels},
                          {Isa::kV4, "v4", v4::kKernels}};

const Entry& entry(Isa isa) {
    return kEntries[static_cast<int>(isa)];
}

// By feature, because clang 14 does not know the names of the levels. What is not asked for here comes with these on
// every processor.
bool has_v3() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2");
}

bool has_v4() {
    return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}

}  // namespace

const char* name(Isa isa) noexcept {
    return entry(isa).name;
}

bool parse_isa(const char* text, Isa& isa) noexcept {
    for (const Entry& e : kEntries) {
        if (std::strcmp(text, e.name) != 0) continue;
        isa = e.isa;
        return true;
    }
    return false;
}

bool available(Isa isa) noexcept {
    return isa == Isa::kScalar || (isa == Isa::kV3 ? has_v3() : has_v4());
}

Isa best_isa() noexcept {
    return has_v4() ? Isa::kV4 : has_v3() ? Isa::kV3 : Isa::kScalar;
}

const char* available_isas() noexcept {
    return has_v4() ? "scalar, v3, v4" : has_v3() ? "scalar, v3" : "scalar";
}

IsaChoice isa_from_environment() noexcept {
    IsaChoice choice{best_isa(), ""};
    const char* text = std::getenv("CAROM_ISA");
    if (text == nullptr || *text == '\0') return choice;
    const bool known = parse_isa(text, choice.isa);
    if (known && available(choice.isa)) return choice;
    std::snprintf(choice.problem, sizeof choice.problem, "CAROM_ISA=%.40s: %s; available here: %s", text,
                  known ? "this processor cannot run it" : "no such instruction set", available_isas());
    return choice;
}

MarchFunction march_function(Isa isa) noexcept {
    return entry(isa).kernels.march;
}

MarchFunction summed_march_function(Isa isa) noexcept {
    return entry(isa).kernels.summed_march;
}

ToleranceFunction tolerance_function(Isa isa) noexcept {
    return entry(isa).kernels.tolerance;
}

ToleranceBatchFunction tolerance_batch_function(Isa isa) noexcept {
    return entry(isa).kernels.tolerance_batch;
}

ContactPhaseFunction contact_phase_function(Isa isa) noexcept {
    return entry(isa).kernels.contact_phase;
}

const char* describe(ImpactStatus status) noexcept {
    constexpr const char* kTexts[] = {
        "", "", "a state is not finite, or the centres coincide or are not at one height",
        "a parameter is out of range: R, m > 0, frictions >= 0, 0 <= e_b <= 1, substeps >= 1",
        "the march did not end within its bound on steps"};
    return kTexts[static_cast<int>(status)];
}

const char* name(ToleranceMethod method) noexcept {
    constexpr const char* kNames[] = {
        "",        "closed_frictionless", "closed_gearing", "closed_stick", "collocation_4", "collocation_8",
        "adaptive"};
    return kNames[static_cast<int>(method)];
}

}  // namespace carom::kernel
