#include "frames/png_pieces.h"

#include <zlib.h>

#include <algorithm>

#include "carom/render/error.h"
#include "frames/png_code.h"

namespace carom::render {

namespace {

constexpr std::uint64_t kAdlerBase = 65521;  // RFC 1950
constexpr std::size_t kRowStartBits = png_code::kLongestCode;

void put_big(std::uint8_t*& at, std::uint32_t value) {
    for (unsigned shift = 32; shift > 0; shift -= 8) *at++ = static_cast<std::uint8_t>(value >> (shift - 8));
}

// A chunk consists of the length of its data, its type, the data, and a checksum of the last two.
std::uint8_t* begin_chunk(std::uint8_t*& at, const char* type) {
    std::uint8_t* const begin = at;
    at = std::copy_n(type, 4, at + 4);
    return begin;
}

void end_chunk(std::uint8_t*& at, std::uint8_t* begin) {
    const auto length = static_cast<std::size_t>(at - begin) - 8;
    put_big(begin, static_cast<std::uint32_t>(length));
    put_big(at, static_cast<std::uint32_t>(crc32_z(0, begin, length + 4)));
}

}  // namespace

void PngPieces::encode(const Image& image, const std::vector<PixelBox>& changed,
                       std::vector<std::uint8_t>& bytes) {
    if (image.size.width < 1 || image.size.height < 1) throw RenderError("an image needs at least one pixel");
    if (!(size_ == image.size)) resize(image.size);
    for (const PixelBox& box : changed) mark(box);
    encoded_ = 0;
    for (std::size_t y = 0; y < rows_.size(); ++y)
        if (row_marks_[y] != 0) update_row(image, y);
    assemble(bytes);
}

double PngPieces::share() const {
    return pieces_.empty() ? 0.0 : static_cast<double>(encoded_) / static_cast<double>(pieces_.size());
}

void PngPieces::resize(FrameSize wanted) {
    size_ = wanted;
    segments_ = static_cast<std::size_t>((size_.width + kSegment - 1) / kSegment);
    const auto height = static_cast<std::size_t>(size_.height);
    pieces_.assign(segments_ * height, {});
    marks_.assign(segments_ * height, 0);
    row_marks_.assign(height, 0);
    rows_.assign(height, {});
    joined_.resize((kRowStartBits + segments_ * kSegmentBits) / 8 + 2 * kBitsSlack);
}

// A pixel also affects the row below it, and the pixels to its right.
void PngPieces::mark(const PixelBox& box) {
    if (box.x0 >= box.x1 || box.y0 >= box.y1) return;
    const auto first = static_cast<std::size_t>(box.x0 / kSegment);
    const auto last = static_cast<std::size_t>(std::min(box.x1 - 1 + kReachLeft, size_.width - 1) / kSegment);
    for (int y = box.y0; y < std::min(box.y1 + 1, size_.height); ++y) {
        const auto row = static_cast<std::size_t>(y);
        std::fill_n(marks_.begin() + static_cast<std::ptrdiff_t>(row * segments_ + first), last - first + 1,
                    std::uint8_t{1});
        row_marks_[row] = 1;
    }
}

void PngPieces::update_row(const Image& image, std::size_t y) {
    Row& row = rows_[y];
    BitWriter out(joined_.data());
    out.put(png_code::kCodes.byte[kRowFilter].bits());
    std::size_t old = out.count(), kept = 0;  // position in the old row; bits before it that stay
    std::uint64_t left = row_bytes();         // bytes from here to the end
    row.plain = kRowFilter;
    row.weighted = kRowFilter * left--;
    for (std::size_t s = 0; s < segments_; ++s) {
        Piece& piece = pieces_[y * segments_ + s];
        std::uint8_t& marked = marks_[y * segments_ + s];
        if (marked != 0) {
            out.copy(row.bytes.data(), old, kept);
            old += kept + piece.bits;
            kept = 0;
            const std::size_t before = out.count();
            piece.sums = write_segment(image, static_cast<int>(s) * kSegment, static_cast<int>(y), out);
            piece.bits = static_cast<std::uint32_t>(out.count() - before);
            marked = 0;
            ++encoded_;
        } else {
            kept += piece.bits;
        }
        left -= std::min<std::uint64_t>(left, std::uint64_t{3} * kSegment);
        row.plain += piece.sums.plain;
        row.weighted += piece.sums.weighted + left * piece.sums.plain;
    }
    out.copy(row.bytes.data(), old, kept);
    row.bits = out.count();
    row.bytes.assign(joined_.begin(),
                     joined_.begin() + static_cast<std::ptrdiff_t>(row.bits / 8 + 1 + kBitsSlack));
    row_marks_[y] = 0;
}

// Adler-32 of all rows, from their sums: the second of its two sums weights a byte by the number of bytes
// from it to the end.
std::uint32_t PngPieces::adler() const {
    std::uint64_t below = row_bytes() * rows_.size();
    std::uint64_t a = 1, b = below % kAdlerBase;
    for (const Row& row : rows_) {
        below -= row_bytes();
        a += row.plain;
        b += row.weighted % kAdlerBase + (below % kAdlerBase) * (row.plain % kAdlerBase) % kAdlerBase;
    }
    return static_cast<std::uint32_t>((b % kAdlerBase) << 16U | a % kAdlerBase);
}

// The data of the one IDAT chunk, a zlib stream.
std::uint8_t* PngPieces::write_data(std::uint8_t* at) const {
    *at++ = 0x78;  // deflate with a window of 32 kB, fast compression
    *at++ = 0x01;
    BitWriter out(at);
    png_code::write_head(out);
    for (const Row& row : rows_) out.copy(row.bytes.data(), 0, row.bits);
    out.put(png_code::kCodes.end.bits());
    at += (out.count() + 7) / 8;
    put_big(at, adler());
    return at;
}

void PngPieces::assemble(std::vector<std::uint8_t>& bytes) const {
    std::size_t most = png_code::kHeadBits;
    for (const Row& row : rows_) most += row.bits;
    constexpr std::size_t kAround = 100;  // signature, header, and the frames of the chunks
    bytes.resize(most / 8 + kAround + kBitsSlack);
    std::uint8_t* at = bytes.data();
    for (const unsigned byte : {0x89U, 0x50U, 0x4EU, 0x47U, 0x0DU, 0x0AU, 0x1AU, 0x0AU})
        *at++ = static_cast<std::uint8_t>(byte);
    std::uint8_t* chunk = begin_chunk(at, "IHDR");
    put_big(at, static_cast<std::uint32_t>(size_.width));
    put_big(at, static_cast<std::uint32_t>(size_.height));
    // 8 bits per channel, RGB, the only methods of compression and of filtering, not interlaced.
    for (const unsigned byte : {8U, 2U, 0U, 0U, 0U}) *at++ = static_cast<std::uint8_t>(byte);
    end_chunk(at, chunk);
    chunk = begin_chunk(at, "IDAT");
    at = write_data(at);
    end_chunk(at, chunk);
    chunk = begin_chunk(at, "IEND");
    end_chunk(at, chunk);
    bytes.resize(static_cast<std::size_t>(at - bytes.data()));
}

}  // namespace carom::render
