#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "carom/render/error.h"
#include "carom/render/sequence.h"

namespace carom::render {

std::string y4m_header(FrameSize size, double fps) {
    // Continued fractions: the first ratio that is close enough has the smallest numbers.
    constexpr double kNear = 1e-9, kMost = std::numeric_limits<std::int32_t>::max();
    double rest = fps, p = 1.0, q = 0.0, p_before = 0.0, q_before = 1.0;
    while (std::isfinite(rest)) {
        const double whole = std::floor(rest);
        const double p_next = whole * p + p_before, q_next = whole * q + q_before;
        if (!(p_next <= kMost && q_next <= kMost)) break;
        p_before = p;
        q_before = q;
        p = p_next;
        q = q_next;
        if (p > 0.0 && std::abs(p / q - fps) <= kNear * fps) {
            return fmt::format(
                "YUV4MPEG2 W{} H{} F{:.0f}:{:.0f} Ip A1:1 C420jpeg XYSCSS=420JPEG XCOLORRANGE=LIMITED\n",
                size.width, size.height, p, q);
        }
        rest = 1.0 / (rest - whole);
    }
    throw RenderError(fmt::format(
        "Y4M cannot express {} frames per second as a ratio of two whole numbers; choose another --fps",
        fps));
}

}  // namespace carom::render
