#include "draw/mean_picture.h"

#include <cstring>

#include "draw/screen_values.h"

namespace carom::render {

void MeanPicture::add(const std::vector<std::uint8_t>& rgba, const std::vector<PixelBox>& boxes) {
    const auto& linear = radiance_of_screen();
    ++count_;
    for (const PixelBox& box : boxes) {
        for (int y = box.y0; y < box.y1; ++y) {
            const std::size_t row = static_cast<std::size_t>(y) * row_,
                              end = row + static_cast<std::size_t>(box.x1) * 4;
            for (std::size_t i = row + static_cast<std::size_t>(box.x0) * 4; i < end; i += 4) {
                if (std::memcmp(&rgba_[i], &rgba[i], 4) == 0) continue;
                for (std::size_t k = i; k < i + 3; ++k) beyond_[k] += linear[rgba[k]] - linear[rgba_[k]];
                beyond_[i + 3] += static_cast<float>(rgba[i + 3]) - static_cast<float>(rgba_[i + 3]);
            }
        }
    }
}

void MeanPicture::finish() {
    const auto& linear = radiance_of_screen();
    const float share = 1.0F / static_cast<float>(count_);
    for (std::size_t i = 0; i < rgba_.size(); ++i) {
        if (beyond_[i] == 0.0F) continue;
        if (i % 4 == 3)
            rgba_[i] = static_cast<std::uint8_t>(static_cast<float>(rgba_[i]) + share * beyond_[i] + 0.5F);
        else
            rgba_[i] = screen_of_radiance(linear[rgba_[i]] + share * beyond_[i]);
    }
}

}  // namespace carom::render
