#include "frames/packed.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace carom::render {

namespace {

std::size_t index(int value) {
    return static_cast<std::size_t>(value);
}

// The boxes may overlap, so the sum may exceed the picture.
double share_of(const std::vector<PixelBox>& boxes, FrameSize size) {
    double pixels = 0.0;
    for (const PixelBox& box : boxes) pixels += double(box.x1 - box.x0) * (box.y1 - box.y0);
    return std::min(1.0, pixels / (double(size.width) * size.height));
}

// Weights of red, green and blue in 65536ths: Y = 16 + 219 (0.2126 R + 0.7152 G + 0.0722 B) / 255, and for
// the differences 128 + 224 (B - Y') / 1.8556 / 255 and 128 + 224 (R - Y') / 1.5748 / 255, with Y' before it
// is scaled. They are rounded so that the weights of a difference add up to 0: grey stays grey.
struct Weights {
    int red, green, blue;
};
constexpr Weights kY{11966, 40254, 4064}, kCb{-6596, -22189, 28785}, kCr{28785, -26145, -2640};
constexpr int kOne = 1 << 16;

std::uint8_t luma(const std::uint8_t* p) {
    return static_cast<std::uint8_t>(
        (kY.red * p[0] + kY.green * p[1] + kY.blue * p[2] + 16 * kOne + kOne / 2) >> 16);
}

// r, g, b: sums over four pixels
std::uint8_t chroma(const Weights& w, int r, int g, int b) {
    return static_cast<std::uint8_t>((w.red * r + w.green * g + w.blue * b + 4 * (128 * kOne + kOne / 2)) >>
                                     18);
}

}  // namespace

const std::vector<std::uint8_t>& PackedRgb::pack(const KeptImage& image) {
    const Image& from = image.image();
    const std::vector<PixelBox> boxes = changed_.next(image);
    share_ = share_of(boxes, from.size);
    bytes_.resize(from.rgbx.size() / 4 * 3);
    for (const PixelBox& box : boxes) {
        for (int y = box.y0; y < box.y1; ++y) {
            const std::uint8_t* in = from.pixel(box.x0, y);
            std::uint8_t* out = bytes_.data() + (in - from.rgbx.data()) / 4 * 3;
            for (int x = box.x0; x < box.x1; ++x, in += 4, out += 3) {
                out[0] = in[0];
                out[1] = in[1];
                out[2] = in[2];
            }
        }
    }
    return bytes_;
}

const std::vector<std::uint8_t>& PackedYuv::pack(const KeptImage& image) {
    constexpr std::string_view kLine = "FRAME\n";
    const Image& from = image.image();
    const int width = from.size.width, height = from.size.height;
    const std::size_t pixels = index(width) * index(height), columns = index((width + 1) / 2),
                      squares = columns * index((height + 1) / 2);
    const std::vector<PixelBox> boxes = changed_.next(image);
    share_ = share_of(boxes, from.size);
    bytes_.resize(kLine.size() + pixels + 2 * squares);
    std::copy(kLine.begin(), kLine.end(), bytes_.begin());
    std::uint8_t* const y_plane = bytes_.data() + kLine.size();
    for (const PixelBox& box : boxes) {
        for (int y = box.y0; y < box.y1; ++y) {
            const std::uint8_t* in = from.pixel(box.x0, y);
            std::uint8_t* out = y_plane + (in - from.rgbx.data()) / 4;
            for (int x = box.x0; x < box.x1; ++x, in += 4) *out++ = luma(in);
        }
        // Every square with a pixel in the box; at odd ends the last column or row counts twice.
        for (int y = box.y0 & ~1; y < box.y1; y += 2) {
            const std::uint8_t* const row = from.pixel(0, y);
            const std::uint8_t* const next = from.pixel(0, std::min(y + 1, height - 1));
            std::uint8_t* const cb = y_plane + pixels + index(y / 2) * columns;
            std::uint8_t* const cr = cb + squares;
            for (int x = box.x0 & ~1; x < box.x1; x += 2) {
                const std::size_t left = 4 * index(x), right = 4 * index(std::min(x + 1, width - 1));
                const auto sum = [&](std::size_t c) {
                    return row[left + c] + row[right + c] + next[left + c] + next[right + c];
                };
                cb[x / 2] = chroma(kCb, sum(0), sum(1), sum(2));
                cr[x / 2] = chroma(kCr, sum(0), sum(1), sum(2));
            }
        }
    }
    return bytes_;
}

}  // namespace carom::render
