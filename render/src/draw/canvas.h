// Where the painters paint: a picture of the table, with what hides and lights the things in front of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "carom/render/image.h"
#include "draw/lanes.h"
#include "draw/table_picture.h"
#include "draw/view.h"

namespace carom::render {

struct Canvas {
    Image& image;
    const TablePicture& table;  ///< of the same size
    const View& view;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size.width) +
               static_cast<std::size_t>(x);
    }

    /// Calls paint(x, y, count) for the pixels of a box, up to four neighbours at a time.
    template <class Paint>
    static void each(const PixelBox& box, const Paint& paint) {
        for (int y = box.y0; y < box.y1; ++y) {
            for (int x = box.x0; x < box.x1; x += lanes::kLanes)
                paint(x, y, std::min(lanes::kLanes, box.x1 - x));
        }
    }

    /// The direction from the eye through the centres of four pixels, 1 along the view.
    lanes::Vec ray(int x, int y) const {
        using namespace lanes;
        const Floats right =
            (Floats{0.5F, 1.5F, 2.5F, 3.5F} + static_cast<float>(x)) * (2.0F / view.size[0]) - 1.0F;
        const float down = (static_cast<float>(y) + 0.5F) * (2.0F / view.size[1]) - 1.0F;
        return vec(view.forward) + vec(view.right_scaled) * right - vec(view.up_scaled) * all(down);
    }

    /// Distances of the table along the view direction at one of the positions in the pixel.
    lanes::Floats table_distance(const std::vector<float>& depths, std::size_t first, int count) const {
        lanes::Floats z{};
        std::memcpy(&z, depths.data() + first, static_cast<std::size_t>(count) * sizeof(float));
        const float near = view.planes[0], far = view.planes[1];
        return near * far / (far - z * (far - near));
    }

    /// The same, the mean of all positions.
    lanes::Floats table_distance(std::size_t first, int count) const {
        lanes::Floats sum{};
        for (int i = 0; i < table.depth_count; ++i)
            sum += table_distance(table.depths[static_cast<std::size_t>(i)], first, count);
        return sum * (1.0F / static_cast<float>(table.depth_count));
    }

    /// Share of each pixel at which nothing of the table is nearer than `depth` along the view direction.
    lanes::Floats seen(std::size_t first, int count, lanes::Floats depth) const {
        lanes::Floats sum{};
        for (int i = 0; i < table.depth_count; ++i)
            sum += lanes::choose(
                depth <= table_distance(table.depths[static_cast<std::size_t>(i)], first, count),
                lanes::all(1.0F), lanes::all(0.0F));
        return sum * (1.0F / static_cast<float>(table.depth_count));
    }

    /// Share of each pixel that is cloth.
    lanes::Floats cloth(std::size_t first, int count) const {
        std::uint8_t four[4 * lanes::kLanes] = {};
        std::memcpy(four, table.rgba.data() + 4 * first, static_cast<std::size_t>(count) * 4);
        const lanes::Floats alpha = lanes::Pixels(four, lanes::kLanes).channel(24);
        // The mark of a face is no share: either the pixel has that of the cloth, 255, or not.
        if (table.depth_count == 1) return lanes::choose(alpha > 254.5F, lanes::all(1.0F), lanes::all(0.0F));
        return alpha * (1.0F / 255.0F);
    }

    /// Paints screen values 0..1 over four pixels; `cover` is the share that they cover. Alpha falls to 0 under paint: no edge of the table is
    /// seen there.
    void blend(int x, int y, int count, const lanes::Vec& color, lanes::Floats cover) const {
        using namespace lanes;
        Pixels pixels(image.rgbx.data() + 4 * index(x, y), count);
        const Floats c = cover * 255.0F, keep = 1.0F - cover;
        pixels.put(pixels.channel(0) * keep + color.x * c, pixels.channel(8) * keep + color.y * c,
                   pixels.channel(16) * keep + color.z * c, pixels.channel(24) * keep);
    }

    /// Darkens four pixels by a share.
    void darken(int x, int y, int count, lanes::Floats dark) const {
        using namespace lanes;
        if (!any(dark > 0.5F / 255.0F)) return;  // no byte would change
        Pixels pixels(image.rgbx.data() + 4 * index(x, y), count);
        const Floats keep = 1.0F - dark;
        pixels.put(pixels.channel(0) * keep, pixels.channel(8) * keep, pixels.channel(16) * keep,
                   pixels.channel(24));
    }
};

}  // namespace carom::render
