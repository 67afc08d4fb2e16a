// Pixels in memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "carom/engine/frame_size.h"

namespace carom::render {

/// Columns x0..x1-1 and rows y0..y1-1 of an image.
struct PixelBox {
    int x0, y0, x1, y1;

    bool operator==(const PixelBox&) const = default;
    bool meets(const PixelBox& other) const {
        return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
    }
};

/// The box around two boxes, either of which may be empty.
inline PixelBox joined(const PixelBox& a, const PixelBox& b) {
    if (a.x1 <= a.x0 || a.y1 <= a.y0) return b;
    if (b.x1 <= b.x0 || b.y1 <= b.y0) return a;
    return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

/// Four channels of eight bits (the fourth is unused), sRGB, row 0 at the top.
struct Image {
    FrameSize size{0, 0};
    std::vector<std::uint8_t> rgbx;

    void resize(FrameSize wanted) {
        size = wanted;
        rgbx.resize(static_cast<std::size_t>(wanted.width) * static_cast<std::size_t>(wanted.height) * 4);
    }
    const std::uint8_t* pixel(int x, int y) const {
        return rgbx.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                                  static_cast<std::size_t>(x));
    }
};

}  // namespace carom::render
