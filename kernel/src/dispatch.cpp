// Run-time choice of the instruction set, and the texts of the statuses.
#include <cstdlib>
#include <cstring>
#include <initializer_list>

#include "carom/kernel/contact_phase.h"
#include "carom/kernel/isa.h"
#include "carom/kernel/march.h"

namespace carom::kernel {

void march_scalar(const Ball&, const Ball&, const ImpactParams&, int, ImpactResult&) noexcept;
void march_v3(const Ball&, const Ball&, const ImpactParams&, int, ImpactResult&) noexcept;
void march_v4(const Ball&, const Ball&, const ImpactParams&, int, ImpactResult&) noexcept;

long contact_phase_scalar(const ContactPhase&, const HertzLaw&, double, double, double) noexcept;
long contact_phase_v3(const ContactPhase&, const HertzLaw&, double, double, double) noexcept;
long contact_phase_v4(const ContactPhase&, const HertzLaw&, double, double, double) noexcept;

const char* describe(ImpactStatus status) noexcept {
    switch (status) {
        case ImpactStatus::kOk:
        case ImpactStatus::kNotApproaching:
            return "";
        case ImpactStatus::kBadState:
            return "a state is not finite, or the centres coincide or are not at one height";
        case ImpactStatus::kBadParameter:
            return "a parameter is out of range: R, m > 0, frictions >= 0, 0 <= e_b <= 1, substeps >= 1";
        case ImpactStatus::kStepLimit:
            return "the march did not end within its bound on steps";
    }
    return "unknown status";
}

const char* name(Isa isa) noexcept {
    switch (isa) {
        case Isa::kScalar:
            return "scalar";
        case Isa::kV3:
            return "v3";
        case Isa::kV4:
            return "v4";
    }
    return "unknown";
}

bool parse_isa(const char* text, Isa& isa) noexcept {
    for (Isa candidate : {Isa::kScalar, Isa::kV3, Isa::kV4}) {
        if (std::strcmp(text, name(candidate)) == 0) {
            isa = candidate;
            return true;
        }
    }
    return false;
}

// By feature, because clang 14 does not know the names of the
// levels; what they leave out comes with these on every CPU.
static bool has_v3() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2");
}

bool available(Isa isa) noexcept {
    switch (isa) {
        case Isa::kScalar:
            return true;
        case Isa::kV3:
            return has_v3();
        case Isa::kV4:
            return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                   __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl");
    }
    return false;
}

Isa best_isa() noexcept {
    for (Isa isa : {Isa::kV4, Isa::kV3}) {
        if (available(isa)) return isa;
    }
    return Isa::kScalar;
}

IsaChoice isa_from_environment(Isa& isa) noexcept {
    const char* text = std::getenv("CAROM_ISA");
    if (text == nullptr || *text == '\0') {
        isa = best_isa();
        return IsaChoice::kOk;
    }
    if (!parse_isa(text, isa)) return IsaChoice::kUnknownName;
    return available(isa) ? IsaChoice::kOk : IsaChoice::kUnavailable;
}

MarchFunction march_function(Isa isa) noexcept {
    switch (isa) {
        case Isa::kScalar:
            return march_scalar;
        case Isa::kV3:
            return march_v3;
        case Isa::kV4:
            return march_v4;
    }
    return march_scalar;
}

ContactPhaseFunction contact_phase_function(Isa isa) noexcept {
    switch (isa) {
        case Isa::kScalar:
            return contact_phase_scalar;
        case Isa::kV3:
            return contact_phase_v3;
        case Isa::kV4:
            return contact_phase_v4;
    }
    return contact_phase_scalar;
}

}  // namespace carom::kernel
