#include "base/hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/as_number.h"
#include "base/console.h"
#include "carom/engine/printable.h"

namespace carom::tools {
namespace {

struct Deviation {
    const char *name, *unit;
    double* value;
    double factor = 1.0;  ///< from the unit of the option
    bool percent() const { return *unit == 'P'; }
};

void read_deviations(const char* option, const std::string& text, const std::vector<Deviation>& known) {
    std::vector<std::string> forms, names;
    for (const Deviation& d : known) {
        forms.push_back(fmt::format("{}={}", d.name, d.unit));
        names.emplace_back(d.name);
    }
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        const std::size_t equals = std::min(part.find('='), part.size());
        const std::string name = part.substr(0, equals);
        std::string value = part.substr(std::min(equals + 1, part.size()));
        const bool percent = value.ends_with('%');
        if (percent) value.pop_back();
        const auto read = as_number<double>(value);
        const auto found =
            std::find_if(known.begin(), known.end(), [&](const Deviation& d) { return d.name == name; });
        const bool is_percent = found != known.end() && found->percent();
        if (!read || *read < 0.0 || *read > 100.0 || percent != is_percent)
            throw UsageError(fmt::format("{} {}: expected {}, each a standard deviation of at least 0",
                                         option, harmless(text), fmt::join(forms, ",")));
        if (found == known.end()) {
            const std::string last = names.back();
            names.pop_back();
            throw UsageError(fmt::format("{} {}: there is no {}; expected {} or {}", option, harmless(text),
                                         in_quotes(name), fmt::join(names, ", "), last));
        }
        *found->value = *read * found->factor;
        begin = end + 1;
    }
}

std::vector<Deviation> deviations_of(games::Unknown& unknown) {
    return {{"cloth", "PERCENT%", &unknown.cloth, 0.01},
            {"rails", "PERCENT%", &unknown.rails, 0.01},
            {"places", "MILLIMETRES", &unknown.places, 1e-3},
            {"gaps", "MICROMETRES", &unknown.gaps, 1e-6}};
}

}  // namespace

games::Hand read_hand(const std::string& text, games::Unknown* unknown) {
    games::Hand hand;
    std::vector<Deviation> known = {{"aim", "DEGREES", &hand.aim_deg},
                                    {"speed", "PERCENT%", &hand.speed, 0.01},
                                    {"tip", "RADII", &hand.tip},
                                    {"elevation", "DEGREES", &hand.elevation_deg}};
    if (unknown != nullptr)
        for (const Deviation& d : deviations_of(*unknown)) known.push_back(d);
    read_deviations("--hand", text, known);
    return hand;
}

games::Unknown read_unknown(const std::string& text) {
    if (text == "none") return games::kExactTable;
    games::Unknown unknown;
    read_deviations("--unknown", text, deviations_of(unknown));
    return unknown;
}

std::string hand_words(const games::Hand& hand) {
    std::string words =
        fmt::format("aim {:g} deg, speed {:g} %, tip {:g} R", hand.aim_deg, 100.0 * hand.speed, hand.tip);
    return hand.elevation_deg > 0.0 ? words + fmt::format(", elevation {:g} deg", hand.elevation_deg) : words;
}

}  // namespace carom::tools
