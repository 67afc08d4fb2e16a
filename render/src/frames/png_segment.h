// One piece of one row of a picture, as bits of a PNG file.
#pragma once

#include <cstdint>

#include "carom/render/image.h"
#include "frames/bits.h"

namespace carom::render {

/// [pixels] Length of a segment; the last one of a row may be shorter.
inline constexpr int kSegment = 64;
/// [bits] The longest segment: one without runs.
inline constexpr std::size_t kSegmentBits = std::size_t{12} * 3 * kSegment;
/// The bits of a segment depend on this many pixels to its left, and on the same pixels of the row above.
inline constexpr int kReachLeft = 2;
/// The filter of every row: Paeth.
inline constexpr unsigned kRowFilter = 4;

/// Two sums over a segment's bytes d0 to d(n-1), from which the checksum of the file (Adler-32) is made.
struct SegmentSums {
    std::uint32_t plain = 0;     ///< sum of d(i)
    std::uint32_t weighted = 0;  ///< sum of (n - i) d(i)
};

/// Writes the segment of row y that begins at column x.
SegmentSums write_segment(const Image& image, int x, int y, BitWriter& out);

}  // namespace carom::render
