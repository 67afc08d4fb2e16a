// The canvas of the painters: a picture of the table, with its depths and lights.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "carom/render/image.h"
#include "draw/lanes.h"
#include "draw/table_picture.h"
#include "draw/view.h"

namespace carom::render {

// Painters copy what they read for every pixel: a byte written to an image might alias any object, so the
// compiler would otherwise read everything again after every pixel.
class Canvas {
  public:
    /// @param table of the same size as the image
    Canvas(Image& image, const TablePicture& table, const View& view)
        : image_(image.rgbx.data()), width_(image.size.width), table_(table), view_(view) {}

    const View& view() const { return view_; }

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    /// The directions from the eye through the centres of pixels, with length 1 along the view direction.
    class Rays {
      public:
        explicit Rays(const View& view)
            : forward_(lanes::vec(view.forward)),
              right_(lanes::vec(view.right_scaled)),
              up_(lanes::vec(view.up_scaled)),
              per_x_(2.0F / view.size[0]),
              per_y_(2.0F / view.size[1]) {}

        /// At the left border of a row of the image.
        lanes::Vec row(int y) const {
            return forward_ - right_ - up_ * lanes::all((static_cast<float>(y) + 0.5F) * per_y_ - 1.0F);
        }

        /// For four neighbours in that row.
        lanes::Vec at(const lanes::Vec& row, int x) const {
            return row + right_ * ((lanes::Floats{0.5F, 1.5F, 2.5F, 3.5F} + static_cast<float>(x)) * per_x_);
        }

      private:
        lanes::Vec forward_, right_, up_;
        float per_x_, per_y_;
    };

    /// Calls paint(first, count, ray) for the pixels of a box, up to four
    /// neighbours at a time; `first` is the index of the first in the image.
    template <class Paint>
    void each(const PixelBox& box, Paint paint) const {
        const Rays rays(view_);
        for (int y = box.y0; y < box.y1; ++y) {
            const lanes::Vec row = rays.row(y);
            const std::size_t row_start = index(0, y);
            for (int x = box.x0; x < box.x1; x += lanes::kLanes)
                paint(row_start + static_cast<std::size_t>(x), std::min(lanes::kLanes, box.x1 - x),
                      rays.at(row, x));
        }
    }

    /// The table behind the painted things: its depths, and the cloth that takes shadows.
    class Background {
      public:
        Background(const TablePicture& table, const View& view)
            : rgba_(table.rgba.data()),
              count_(table.depth_count),
              near_(view.planes[0]),
              far_(view.planes[1]) {
            for (std::size_t i = 0; i < depths_.size(); ++i) depths_[i] = table.depths[i].data();
        }

        /// Mean distance along the view direction.
        lanes::Floats distance(std::size_t first, int count) const {
            lanes::Floats sum{};
            for (int i = 0; i < count_; ++i) sum += distance(i, first, count);
            return sum * (1.0F / static_cast<float>(count_));
        }

        /// Share of each pixel at which no part of the table is nearer than `depth` along the view direction.
        lanes::Floats seen(std::size_t first, int count, lanes::Floats depth) const {
            lanes::Floats sum{};
            for (int i = 0; i < count_; ++i)
                sum += lanes::choose(depth <= distance(i, first, count), lanes::all(1.0F), lanes::all(0.0F));
            return sum * (1.0F / static_cast<float>(count_));
        }

        /// Share of each pixel that is cloth.
        lanes::Floats cloth(std::size_t first, int count) const {
            const lanes::Floats alpha =
                lanes::channel(lanes::load<lanes::Ints>(rgba_ + 4 * first, count), 24);
            // The mark of a face is not a share: a pixel either has the cloth's mark, 255, or not.
            if (count_ == 1) return lanes::choose(alpha > 254.5F, lanes::all(1.0F), lanes::all(0.0F));
            return alpha * (1.0F / 255.0F);
        }

      private:
        lanes::Floats distance(int i, std::size_t first, int count) const {
            const auto z = lanes::load<lanes::Floats>(depths_[static_cast<std::size_t>(i)] + first, count);
            return near_ * far_ / (far_ - z * (far_ - near_));
        }

        const std::uint8_t* rgba_;
        std::array<const float*, 4> depths_{};
        int count_;
        float near_, far_;
    };
    Background background() const { return {table_, view_}; }

    /// Writes to the image.
    class Brush {
      public:
        explicit Brush(std::uint8_t* image) : image_(image) {}

        /// Paints screen values 0..1 over four pixels; `cover` is the share that they cover. Alpha falls to 0
        /// under paint, because no edge of the table is visible there.
        void blend(std::size_t first, int count, const lanes::Vec& color, lanes::Floats cover) const {
            using namespace lanes;
            const auto there = load<Ints>(image_ + 4 * first, count);
            const Floats c = cover * 255.0F, keep = 1.0F - cover;
            store(image_ + 4 * first,
                  pixels_of(channel(there, 0) * keep + color.x * c, channel(there, 8) * keep + color.y * c,
                            channel(there, 16) * keep + color.z * c, channel(there, 24) * keep),
                  count);
        }

        /// Darkens four pixels by a share; alpha stays.
        void darken(std::size_t first, int count, lanes::Floats dark) const {
            using namespace lanes;
            if (!any(dark > 0.5F / 255.0F)) return;  // no byte would change
            const auto there = load<Ints>(image_ + 4 * first, count);
            const Floats keep = 1.0F - dark;
            store(image_ + 4 * first,
                  pixels_of(channel(there, 0) * keep, channel(there, 8) * keep, channel(there, 16) * keep,
                            channel(there, 24)),
                  count);
        }

      private:
        std::uint8_t* image_;
    };
    Brush brush() const { return Brush(image_); }

  private:
    std::uint8_t* image_;
    int width_;
    const TablePicture& table_;
    const View& view_;
};

}  // namespace carom::render
