#include "base/hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "base/as_number.h"
#include "base/console.h"
#include "carom/engine/printable.h"

namespace carom::tools {

games::Hand read_hand(const std::string& text) {
    games::Hand hand;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        const std::size_t equals = std::min(part.find('='), part.size());
        const std::string name = part.substr(0, equals);
        std::string value = part.substr(std::min(equals + 1, part.size()));
        const bool percent = value.ends_with('%');
        if (percent) value.pop_back();
        const auto read = as_number<double>(value);
        if (!read || *read < 0.0 || *read > 100.0 || percent != (name == "speed"))
            throw UsageError(
                fmt::format("--hand {}: expected aim=DEGREES,speed=PERCENT%,tip=RADII,elevation=DEGREES, "
                            "each a standard deviation of at least 0",
                            harmless(text)));
        if (name == "aim")
            hand.aim_deg = *read;
        else if (name == "speed")
            hand.speed = *read / 100.0;
        else if (name == "tip")
            hand.tip = *read;
        else if (name == "elevation")
            hand.elevation_deg = *read;
        else
            throw UsageError(fmt::format("--hand {}: there is no {}; expected aim, speed, tip or elevation",
                                         harmless(text), in_quotes(name)));
        begin = end + 1;
    }
    return hand;
}

std::string hand_words(const games::Hand& hand) {
    std::string words =
        fmt::format("aim {:g} deg, speed {:g} %, tip {:g} R", hand.aim_deg, 100.0 * hand.speed, hand.tip);
    return hand.elevation_deg > 0.0 ? words + fmt::format(", elevation {:g} deg", hand.elevation_deg) : words;
}

}  // namespace carom::tools
