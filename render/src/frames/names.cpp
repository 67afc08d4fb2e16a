#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include "carom/render/sequence.h"

namespace carom::render {

double frame_time(double from, long k, double fps) {
    return from + static_cast<double>(k) / fps;
}

long frame_count(double from, double to, double fps) {
    if (!(fps > 0.0) || !std::isfinite(fps)) throw RenderError("fps must be a number greater than 0");
    if (!std::isfinite(from) || !std::isfinite(to))
        throw RenderError("the first and last time must be finite");
    if (to < from) return 0;
    if (to + 1.0 / fps == to)
        throw RenderError("at that time frames are too close to tell apart; lower --fps, --from or --to");
    const double frames = (to - from) * fps;
    if (frames > 1e9) throw RenderError("more than 1e9 frames; lower --fps or give --to");
    // The product above is rounded; the time that frame_time() gives for each frame decides.
    long last = static_cast<long>(frames);
    while (frame_time(from, last + 1, fps) <= to) ++last;
    while (last > 0 && frame_time(from, last, fps) > to) --last;
    return last + 1;
}

namespace {

struct Conversion {
    std::size_t begin = 0, end = 0;
    int width = 0;  // number of digits, padded with zeros
};

// Parses "%d" or "%0Nd" at position `at`; empty for anything else.
std::optional<Conversion> read_conversion(const std::string& pattern, std::size_t at) {
    std::size_t i = at + 1;
    Conversion found{at, 0, 0};
    if (i < pattern.size() && pattern[i] == '0') {
        std::size_t digits = 0;
        for (++i; i < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[i])) != 0;
             ++i, ++digits) {
            found.width = 10 * found.width + (pattern[i] - '0');
            if (digits == 2) return std::nullopt;
        }
        if (digits == 0) return std::nullopt;
    }
    if (i >= pattern.size() || pattern[i] != 'd') return std::nullopt;
    found.end = i + 1;
    return found;
}

}  // namespace

bool is_numbered(const std::string& pattern) {
    return frame_path(pattern, 0) != frame_path(pattern, 1);
}

std::string frame_path(const std::string& pattern, long k) {
    const auto refuse = [&] {
        throw RenderError("bad frame pattern '" + pattern +
                          "'; give exactly one %d or %0Nd, as in frames/%05d.png");
    };
    std::string path;
    int conversions = 0;
    for (std::size_t i = 0; i < pattern.size();) {
        if (pattern[i] != '%') {
            path += pattern[i++];
        } else if (i + 1 < pattern.size() && pattern[i + 1] == '%') {
            path += '%';
            i += 2;
        } else {
            const std::optional<Conversion> found = read_conversion(pattern, i);
            if (!found || ++conversions > 1) refuse();
            const std::string digits = std::to_string(k);
            const auto width = static_cast<std::size_t>(found->width);
            if (digits.size() < width) path.append(width - digits.size(), '0');
            path += digits;
            i = found->end;
        }
    }
    return path;
}

}  // namespace carom::render
