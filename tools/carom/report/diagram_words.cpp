#include "report/diagram_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "base/console.h"
#include "carom/engine/event_details.h"
#include "carom/engine/printable.h"
#include "carom/games/shot.h"

namespace carom::tools {
namespace {

/// On a table without pockets: the path of the struck ball, in the words of carom games.
std::string carom_words(const Record& record) {
    constexpr int kThree = 3;
    if (record.tracks.size() != 3 || record.stopped != StopReason::kAtRest || record.events.empty() ||
        record.events[0].type != EventType::kCueStrike)
        return "";
    int cushions = 0;
    std::vector<int> met;
    for (const games::Touch& touch : games::shot_of(record).touches) {
        if (touch.ball != record.events[0].a || met.size() == 2) continue;
        if (touch.cushion())
            cushions += touch.driven ? 1 : 0;
        else if (std::find(met.begin(), met.end(), touch.other) == met.end())
            met.push_back(touch.other);
    }
    if (met.size() < 2) return "no point";
    return fmt::format("{} before the second ball: a point{}",
                       counted(static_cast<std::size_t>(cushions), "cushion"),
                       cushions < kThree ? ", but not of three cushions" : " of three cushions");
}

}  // namespace

std::string stroke_words(const Cue& cue, Units units) {
    std::string words = fmt::format("cue {}, aim {:.2f} deg, ", speed_text(cue.speed, units), cue.aim_deg);
    if (cue.elevation_deg > 0.0) words += fmt::format("elevation {:.0f} deg, ", cue.elevation_deg);
    std::string tip;
    const auto add = [&tip](double part, const char* less, const char* more) {
        if (std::abs(part) < 0.005) return;
        tip +=
            fmt::format("{}{:.2g} R {}", tip.empty() ? "" : ", ", std::abs(part), part < 0.0 ? less : more);
    };
    add(cue.side, "right", "left");
    add(cue.height, "low", "high");
    words += tip.empty() ? "tip in the middle" : "tip " + tip;
    return words;
}

/// Initial positions of a few balls, from the corner of the table, and their radius.
std::string places_words(const Record& record, Units units) {
    constexpr std::size_t kMost = 4;
    if (record.tracks.size() > kMost) return "";
    const Unit unit = length_unit(units);
    const bool inch = units == Units::kInch;
    std::string words = inch ? "inches: " : "metres: ";
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const Vec2 p = unit.factor * planar(record.state_at(static_cast<int>(i), 0.0).position);
        words += fmt::format("{} at {:.{}f}, {:.{}f}; ", harmless(record.tracks[i].id), p.x(), inch ? 2 : 3,
                             p.y(), inch ? 2 : 3);
    }
    return words + fmt::format("radius {:.{}f}", unit.factor * record.balls.R, inch ? 3 : 4);
}

std::string outcome_words(const Record& record) {
    std::string words;
    for (const Event& event : record.events) {
        if (event.type != EventType::kBallPocket && event.type != EventType::kBallOut) continue;
        if (!words.empty()) words += ", ";
        words +=
            event.type == EventType::kBallOut
                ? fmt::format("{} leaves the table", record.tracks[event.a].id)
                : fmt::format("{} falls into the {}", record.tracks[event.a].id, met_name(record, event));
    }
    if (words.empty()) words = record.table.pockets.empty() ? carom_words(record) : "nothing falls";
    return words + fmt::format("{}{:.1f} s", words.empty() ? "" : "; ", record.duration);
}

}  // namespace carom::tools
