// The choice of the instruction set at run time. All sets give the same bits and differ only in speed.
#pragma once

namespace carom::kernel {

enum class Isa : unsigned char {
    kScalar,   ///< the baseline of every processor: on x86-64, SSE2 without FMA
    kV3,       ///< x86-64-v3: AVX2 and FMA, as in Zen 3
    kV4,       ///< x86-64-v4: AVX-512
    kFastest,  ///< for each kernel, the fastest set on this processor (fastest_isa)
};

/// "scalar", "v3" or "v4", as in CAROM_ISA, or "fastest".
const char* name(Isa isa) noexcept;

/// Parses "scalar", "v3" or "v4". Returns false and leaves `isa` unchanged for any other text.
bool parse_isa(const char* text, Isa& isa) noexcept;

/// Whether this processor and operating system can run the instruction set.
bool available(Isa isa) noexcept;

/// The widest available one.
Isa best_isa() noexcept;

/// The kernels of a simulation; the best choice may differ between them.
enum class KernelKind : unsigned char { kMarch, kSummedMarch, kTolerance, kToleranceBatch, kContactPhase };
inline constexpr int kKernelKinds = 5;

/// The meaning of Isa::kFastest: the available set measured to be fastest on this kind of processor
/// (lab/notes/2026-11-ladder.md), or the widest one on other processors. Never kFastest.
Isa fastest_isa(KernelKind kind) noexcept;
/// The processor whose measurements apply here: "AMD Zen 5"; null if there are none.
const char* measured_processor() noexcept;

/// The available sets as text: "scalar, v3".
const char* available_isas() noexcept;

/// An instruction set, or the reason why none was chosen.
struct IsaChoice {
    Isa isa;
    /// "" if `isa` is valid; otherwise what is wrong with CAROM_ISA and which sets are available here
    char problem[160];
};

/// The instruction set named by CAROM_ISA in the environment, or Isa::kFastest if it is unset or empty. An
/// unknown or unavailable name is a problem, and is never replaced.
IsaChoice isa_from_environment() noexcept;

}  // namespace carom::kernel
