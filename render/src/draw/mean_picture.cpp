#include "draw/mean_picture.h"

#include <cmath>
#include <cstring>
#include <utility>

namespace carom::render {

MeanPicture::MeanPicture(std::vector<std::uint8_t>& rgba, int width, std::vector<PixelBox> boxes)
    : rgba_(rgba), row_(static_cast<std::size_t>(width) * 4), boxes_(std::move(boxes)) {
    std::size_t count = 0;
    for (const PixelBox& box : boxes_)
        count += static_cast<std::size_t>(box.x1 - box.x0) * static_cast<std::size_t>(box.y1 - box.y0);
    beyond_.resize(4 * count);
}

template <class At>
void MeanPicture::each_pixel(const At& at) const {
    std::size_t sum = 0;
    for (const PixelBox& box : boxes_) {
        for (int y = box.y0; y < box.y1; ++y) {
            const std::size_t row = static_cast<std::size_t>(y) * row_,
                              end = row + static_cast<std::size_t>(box.x1) * 4;
            for (std::size_t i = row + static_cast<std::size_t>(box.x0) * 4; i < end; i += 4, sum += 4)
                at(i, sum);
        }
    }
}

void MeanPicture::add(const std::vector<std::uint8_t>& rgba) {
    const auto& linear = radiance_of_screen();
    ++count_;
    each_pixel([&](std::size_t i, std::size_t sum) {
        if (std::memcmp(&rgba_[i], &rgba[i], 4) == 0) return;
        for (std::size_t k = 0; k < 3; ++k) beyond_[sum + k] += linear[rgba[i + k]] - linear[rgba_[i + k]];
        beyond_[sum + 3] += static_cast<float>(rgba[i + 3]) - static_cast<float>(rgba_[i + 3]);
    });
}

void MeanPicture::finish() {
    const auto& linear = radiance_of_screen();
    const float share = 1.0F / static_cast<float>(count_);
    each_pixel([&](std::size_t i, std::size_t sum) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (beyond_[sum + k] != 0.0F)
                rgba_[i + k] = screen_of_radiance(linear[rgba_[i + k]] + share * beyond_[sum + k]);
        }
        const float alpha = static_cast<float>(rgba_[i + 3]) + share * beyond_[sum + 3];
        rgba_[i + 3] = static_cast<std::uint8_t>(std::lround(alpha));
    });
}

}  // namespace carom::render
