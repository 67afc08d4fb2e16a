// Run-time choice of the instruction set. Every level gives the same bits; the choice is about speed alone.
#pragma once

namespace carom::kernel {

enum class Isa : unsigned char {
    kScalar,  ///< plain x86-64 (SSE2, no FMA)
    kV3,      ///< x86-64-v3: AVX2 and FMA, what Zen 3 has
    kV4,      ///< x86-64-v4: AVX-512
};

/// "scalar", "v3" or "v4", as in CAROM_ISA.
const char* name(Isa isa) noexcept;

/// Parses such a name; false if it is none.
bool parse_isa(const char* text, Isa& isa) noexcept;

/// Whether this processor and operating system can run it and this build holds kernels for it.
bool available(Isa isa) noexcept;

/// The widest available one.
Isa best_isa() noexcept;

/// Outcome of reading CAROM_ISA.
enum class IsaChoice : unsigned char { kOk, kUnknownName, kUnavailable };

/// CAROM_ISA if it is set, else best_isa(). An unknown or unavailable name is reported, never replaced.
IsaChoice isa_from_environment(Isa& isa) noexcept;

}  // namespace carom::kernel
