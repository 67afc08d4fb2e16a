// The choice of the instruction set at run time. All instruction sets give the same bits and differ only in
// speed.
#pragma once

namespace carom::kernel {

enum class Isa : unsigned char {
    kScalar,   ///< what every processor has: on x86-64, SSE2 without FMA
    kV3,       ///< x86-64-v3: AVX2 and FMA, as in Zen 3
    kV4,       ///< x86-64-v4: AVX-512
    kFastest,  ///< for each kernel, the set that is fastest on this processor (fastest_isa)
};

/// "scalar", "v3" or "v4", as in CAROM_ISA, or "fastest".
const char* name(Isa isa) noexcept;

/// Parses one of the three. Returns false and leaves `isa` unchanged for any other text.
bool parse_isa(const char* text, Isa& isa) noexcept;

/// Whether this processor and operating system can run the instruction set.
bool available(Isa isa) noexcept;

/// The widest available one.
Isa best_isa() noexcept;

/// The kernels of a simulation; the best choice may differ between them.
enum class KernelKind : unsigned char { kMarch, kSummedMarch, kTolerance, kToleranceBatch, kContactPhase };
inline constexpr int kKernelKinds = 5;

/// The meaning of Isa::kFastest: the available set that was measured to be fastest on this kind of processor
/// (lab/notes/2026-11-ladder.md), or the widest one on processors that were not measured. Never kFastest.
Isa fastest_isa(KernelKind kind) noexcept;
/// The processor whose measurements apply here: "AMD Zen 5"; null if it was not measured.
const char* measured_processor() noexcept;

/// The available sets as text: "scalar, v3".
const char* available_isas() noexcept;

/// An instruction set, or the reason why there is none.
struct IsaChoice {
    Isa isa;
    /// "" if `isa` is valid; otherwise what is wrong with CAROM_ISA and which sets are available here
    char problem[160];
};

/// The instruction set named by CAROM_ISA in the environment, or Isa::kFastest if it is unset or empty. An
/// unknown or unavailable name is a problem, and is never replaced by another.
IsaChoice isa_from_environment() noexcept;

}  // namespace carom::kernel
