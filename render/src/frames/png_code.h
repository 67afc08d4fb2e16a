// The Huffman codes of every PNG file that carom writes itself. Since all files use the same codes, the bits
// of a piece of a picture depend on its pixels alone and can be kept from one frame to the next. This costs 1
// to 4 % of the size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "frames/bits.h"

namespace carom::render::png_code {

/// [pixels] The longest run of equal pixels: 192 bytes, and deflate allows 258.
inline constexpr int kLongestRun = 64;
/// [bits] The longest code of a byte: noise grows by a factor of 12/8.
inline constexpr unsigned kLongestCode = 12;

struct Code {
    std::uint32_t value = 0;  ///< the first bit is the lowest one
    std::uint32_t count = 0;  ///< bits

    Bits bits() const { return {value, count}; }
};

struct Codes {
    std::array<Code, 256> byte{};
    Code end;
    /// [n]: n more pixels like the previous one (its code, the bits that complete the length, the distance of
    /// 3 bytes)
    std::array<Code, kLongestRun + 1> run{};
};

extern const Codes kCodes;

/// Begins the only deflate block of a file, which holds the lengths of the codes.
void write_head(BitWriter& out);

/// [bits] At least what write_head() writes.
inline constexpr std::size_t kHeadBits = 2048;

}  // namespace carom::render::png_code
