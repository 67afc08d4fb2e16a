// The choice of the instruction set at run time. All instruction
// sets give the same bits; they differ in speed only.
#pragma once

namespace carom::kernel {

enum class Isa : unsigned char {
    kScalar,   ///< what every processor has: of x86-64 SSE2 and no FMA
    kV3,       ///< x86-64-v3: AVX2 and FMA, what Zen 3 has
    kV4,       ///< x86-64-v4: AVX-512
    kFastest,  ///< for each kernel the one that is fastest on this processor (fastest_isa)
};

/// "scalar", "v3" or "v4", as in CAROM_ISA, or "fastest".
const char* name(Isa isa) noexcept;

/// Parses one of the three. Returns false, and leaves `isa` as it is, if `text` is none.
bool parse_isa(const char* text, Isa& isa) noexcept;

/// Whether this processor and operating system can run the instruction set.
bool available(Isa isa) noexcept;

/// The widest available one.
Isa best_isa() noexcept;

/// The kernels of a simulation, for which the choice may differ.
enum class KernelKind : unsigned char { kMarch, kSummedMarch, kTolerance, kToleranceBatch, kContactPhase };
inline constexpr int kKernelKinds = 5;

/// What Isa::kFastest stands for here: the available one that was measured
/// to be fastest on this kind of processor (lab/notes/2026-11-ladder.md),
/// and the widest one on processors that were not measured. Never kFastest.
Isa fastest_isa(KernelKind kind) noexcept;
/// The row of measurements that holds for this processor: "AMD Zen 5"; null where it was not measured.
const char* measured_processor() noexcept;

/// The available ones as text: "scalar, v3".
const char* available_isas() noexcept;

/// An instruction set, or in words why there is none.
struct IsaChoice {
    Isa isa;
    /// "" where `isa` is valid; else what is wrong with CAROM_ISA and which sets are available here
    char problem[160];
};

/// The instruction set that CAROM_ISA in the environment names; where it is unset or empty, Isa::kFastest. An
/// unknown or unavailable name is a problem and never replaced by another.
IsaChoice isa_from_environment() noexcept;

}  // namespace carom::kernel
