#include "carom/engine/strike.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "physics/cue.h"

namespace carom {
namespace {

/// The smallest and the largest value that the row of one of the cue's numbers allows.
std::pair<double, double> ends_of(std::string_view key) {
    const Interval range = std::find_if(std::begin(kCueFields), std::end(kCueFields), [key](const auto& f) {
                               return f.key == key;
                           })->range;
    return {range.low_open ? std::nextafter(range.low, range.high) : range.low,
            range.high_open ? std::nextafter(range.high, range.low) : range.high};
}

}  // namespace

Cue legal_strike(Cue cue) {
    const struct {
        const char* key;
        double Cue::*number;
    } kNumbers[] = {
        {"speed", &Cue::speed}, {"aim_deg", &Cue::aim_deg}, {"elevation_deg", &Cue::elevation_deg}};
    if (!std::isfinite(cue.side) || !std::isfinite(cue.height))
        throw std::invalid_argument("the offset of the cue is not finite");
    for (const auto& [key, number] : kNumbers) {
        if (!std::isfinite(cue.*number))
            throw std::invalid_argument(std::string(key) + " of the cue is not finite");
        const auto [least, most] = ends_of(key);
        cue.*number = std::clamp(cue.*number, least, most);
    }
    const auto beyond = [&cue] {
        return cue.side * cue.side + cue.height * cue.height > kMiscueOffset * kMiscueOffset;
    };
    // Divided first, so that no square overflows. Rounding may leave it slightly outside, so repeat.
    if (const double most = std::max(std::abs(cue.side), std::abs(cue.height)); most > 1.0) {
        cue.side /= most;
        cue.height /= most;
    }
    while (beyond()) {
        const double scale = std::min(kMiscueOffset / std::hypot(cue.side, cue.height), 1.0 - 0x1p-52);
        cue.side *= scale;
        cue.height *= scale;
    }
    return cue;
}

double ball_speed_gain(Cue cue, const BallSize& ball) {
    cue.speed = 1.0;
    return strike(cue, ball).v.norm();
}

}  // namespace carom
