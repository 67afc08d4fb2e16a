#include "carom/render/overlay.h"

#include <array>
#include <string>
#include <utility>

#include "base/nearest.h"
#include "carom/engine/printable.h"
#include "carom/render/error.h"

namespace carom::render {

Overlay parse_overlay(std::string_view list) {
    constexpr std::array<std::pair<std::string_view, bool Overlay::*>, 6> kNames{
        {{"trails", &Overlay::trails},
         {"events", &Overlay::events},
         {"spin", &Overlay::spin},
         {"ghost", &Overlay::ghost},
         {"clock", &Overlay::clock},
         {"margin", &Overlay::margin}}};
    Overlay overlay;
    bool more = !list.empty();
    while (more) {
        const std::size_t comma = list.find(',');
        const std::string_view word = list.substr(0, comma);
        more = comma != std::string_view::npos;
        if (more) list.remove_prefix(comma + 1);
        bool known = word == "all" || word == "trails=ball";
        if (word == "diamonds") known = overlay.diamonds = true;
        if (word == "trails=ball") overlay.trails = overlay.ball_trails = true;
        for (const auto& [name, member] : kNames) {
            if (word != name && word != "all") continue;
            overlay.*member = true;
            known = true;
        }
        if (!known) {
            throw RenderError(
                "unknown overlay '" + printable(word) +
                "'; use trails (or trails=ball), events, spin, ghost, clock, margin, diamonds, or all" +
                did_you_mean(word,
                             {"trails", "events", "spin", "ghost", "clock", "margin", "diamonds", "all"}));
        }
    }
    return overlay;
}

}  // namespace carom::render
