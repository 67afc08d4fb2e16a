// A PNG file in pieces that are kept from one picture to the next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

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

/// Every row has the same filter and is cut into segments; the whole file is one deflate block with built-in
/// codes. So the bits of a segment depend only on its pixels and their neighbours. They are kept, and joined
/// by shifting.
class PngPieces {
  public:
    /// Writes the file of an image. Outside the boxes it must show the same as the image of the last call,
    /// which must have had the same size; the first call needs a box around everything. @throws RenderError
    /// for an image without pixels
    void encode(const Image& image, const std::vector<PixelBox>& changed, std::vector<std::uint8_t>& bytes);

    /// The share of the segments that the last call encoded, 0..1.
    double share() const;

  private:
    struct Piece {
        std::uint32_t bits = 0;
        SegmentSums sums;
    };
    /// The code of the filter and the bits of the segments, joined.
    struct Row {
        std::vector<std::uint8_t> bytes;
        std::size_t bits = 0;
        std::uint64_t plain = 0, weighted = 0;  // sums as those of a segment, over the whole row
    };

    void resize(FrameSize wanted);
    void mark(const PixelBox& box);
    void update_row(const Image& image, std::size_t y);
    void assemble(std::vector<std::uint8_t>& bytes) const;
    std::uint8_t* write_data(std::uint8_t* at) const;
    std::uint32_t adler() const;
    std::uint64_t row_bytes() const { return 1 + std::uint64_t{3} * static_cast<std::uint64_t>(size_.width); }

    FrameSize size_{0, 0};
    std::size_t segments_ = 0;  // in a row
    std::vector<Piece> pieces_;
    std::vector<std::uint8_t> marks_;      // per piece: 1 if it must be encoded
    std::vector<std::uint8_t> row_marks_;  // per row: 1 if it has a marked piece
    std::vector<Row> rows_;
    std::vector<std::uint8_t> joined_;  // a row while it is built
    std::size_t encoded_ = 0;           // pieces of the last picture
};

}  // namespace carom::render
