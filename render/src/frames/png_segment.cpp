// One piece of one row of a picture, as bits of a PNG file.
#include "frames/png_pieces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "frames/png_code.h"

namespace carom::render {

namespace {

static_assert(kSegment == png_code::kLongestRun && kSegment == 64, "one bit for every pixel");
static_assert(kSegmentBits == std::size_t{png_code::kLongestCode} * 3 * kSegment);

// Loops over these arrays become vector instructions, so they begin with four pixels left of the segment, of
// which one is needed. A row has one more, left of these.
constexpr int kLeft = 4;
constexpr std::size_t kBytes = 4 * std::size_t{kLeft + kSegment};
using Row = std::array<std::uint8_t, kBytes + 4>;
using Rest = std::array<std::uint8_t, kBytes>;

// The bytes of a row from four pixels before the segment and one more: in the image itself or, at an end of a
// row, in `copy`. Outside the picture everything is 0.
const std::uint8_t* row_at(const Image& image, int x, int y, Row& copy) {
    const int begin = x - kLeft - 1, end = x + kSegment;
    const int first = std::max(0, begin), behind = std::min(end, image.size.width);
    if (y >= 0 && first == begin && behind == end) return image.pixel(begin, y);
    copy.fill(0);
    if (y >= 0)
        std::memcpy(copy.data() + std::ptrdiff_t{4} * (first - begin), image.pixel(first, y),
                    std::size_t{4} * static_cast<std::size_t>(behind - first));
    return copy.data();
}

// The fourth channel is unused.
constexpr auto kUsed = [] {
    Rest used{};
    for (std::size_t i = 0; i < used.size(); ++i) used[i] = i % 4 == 3 ? 0 : 255;
    return used;
}();

// Sixteen bytes at once: the register size of every processor (a language extension of gcc and clang).
using Lanes = std::uint8_t __attribute__((vector_size(16)));
using Wide = std::uint16_t __attribute__((vector_size(32)));

Lanes lanes_at(const std::uint8_t* from) {
    Lanes lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

std::uint8_t less(std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::max(a, b) - b);  // a - b, or 0
}

// The filter's residual: the difference from the one of three neighbours (left, above, left above) that is
// nearest to left + above - corner (PNG specification, 9.4). Written with bytes and without branches: the
// lower of left and above is nearest if the corner is nearer to the higher one by a factor of 2, and the
// other way round.
void filter(const std::uint8_t* here, const std::uint8_t* above, Rest& rest) {
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const std::uint8_t left = here[i], up = above[i + 4], corner = above[i];
        const std::uint8_t low = std::min(left, up), high = std::max(left, up);
        const std::uint8_t over = less(corner, low), under = less(high, corner);
        const std::uint8_t high_or_corner = over <= under / 2 ? high : corner;
        const std::uint8_t nearest = under <= over / 2 ? low : high_or_corner;
        rest[i] = static_cast<std::uint8_t>(here[i + 4] - nearest) & kUsed[i];
    }
}

// In a whole segment, byte c of pixel q of block j has the weight 12 (16 - j) - 3 q - c. Adding up the sums
// after each block counts block j 16 - j times. 16 bits are enough: 255 (1 + ... + 16) is less than 2^16.
SegmentSums sums_of(const std::uint8_t* rest, int pixels) {
    Wide sum{}, sum_of_sums{};
    for (std::size_t block = 0; block < std::size_t{4} * kSegment; block += sizeof(Lanes)) {
        sum += __builtin_convertvector(lanes_at(rest + block), Wide);
        sum_of_sums += sum;
    }
    SegmentSums sums;
    for (unsigned i = 0; i < sizeof(Lanes); ++i) {
        sums.plain += sum[i];
        sums.weighted += 12U * sum_of_sums[i] - (3 * (i / 4) + i % 4) * sum[i];
    }
    sums.weighted -= sums.plain * static_cast<std::uint32_t>(3 * (kSegment - pixels));
    return sums;
}

// Bit p is set if pixel p equals the previous one.
std::uint64_t repeated(const std::uint8_t* rest) {
    std::array<std::uint32_t, kSegment + 1> pixels;
    std::memcpy(pixels.data(), rest - 4, sizeof pixels);
    std::array<std::uint8_t, kSegment> same;
    for (std::size_t p = 0; p < same.size(); ++p) same[p] = pixels[p] == pixels[p + 1];
    std::uint64_t bits = 0;
    // The product collects the lowest bits of eight bytes in the highest byte.
    for (std::size_t k = 0; k < same.size(); k += 8)
        bits |= ((load_little(same.data() + k) * 0x0102040810204080U) >> 56U) << k;
    return bits;
}

}  // namespace

SegmentSums write_segment(const Image& image, int x, int y, BitWriter& out) {
    const int count = std::min(kSegment, image.size.width - x);
    Row copy, copy_above;
    Rest all;
    filter(row_at(image, x, y, copy), row_at(image, x, y - 1, copy_above), all);
    std::fill(all.begin() + std::ptrdiff_t{4} * (kLeft + count), all.end(),
              std::uint8_t{0});  // right of the picture
    const std::uint8_t* const rest = all.data() + std::ptrdiff_t{4} * kLeft;
    std::uint64_t same = repeated(rest);
    if (x == 0) same &= ~std::uint64_t{1};  // a row begins with the number of its filter, not with a pixel
    BitWriter local = out;                  // in registers
    for (int p = 0; p < count;) {
        const std::uint8_t* const pixel = rest + std::ptrdiff_t{4} * p;
        const auto& codes = png_code::kCodes.byte;
        const Bits one = codes[pixel[0]].bits() + codes[pixel[1]].bits() + codes[pixel[2]].bits();
        const std::uint64_t ahead = same >> static_cast<unsigned>(p);
        if ((ahead & 1U) == 0) {
            local.put(one);
            ++p;
            continue;
        }
        const int length = std::min(std::countr_one(ahead), count - p);
        const Bits run = png_code::kCodes.run[static_cast<std::size_t>(length)].bits();
        p += length;
        if (run.count <= one.count * static_cast<unsigned>(length)) {
            local.put(run);
        } else {  // short runs of frequent bytes
            for (int i = 0; i < length; ++i) local.put(one);
        }
    }
    out = local;
    return sums_of(rest, count);
}

}  // namespace carom::render
