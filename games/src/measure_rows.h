// The measures available in expressions.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carom/games/measures.h"
#include "carom/games/shot.h"

namespace carom::games::detail {

using Texts = std::vector<std::string>;
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The arguments of a measure, checked against the scene.
struct Arguments {
    int ball = -1;
    std::vector<double> numbers;
    std::optional<Game> game;
};

/// A record, and facts that several measures read from it.
struct PlayedShot {
    explicit PlayedShot(const Record& played) : record(played) {}
    const Shot& shot() const {
        if (!shot_) shot_ = shot_of(record);
        return *shot_;
    }
    int struck() const {
        for (const Event& event : record.events)
            if (event.type == EventType::kCueStrike) return event.a;
        return -1;
    }
    const std::string& id(int ball) const { return record.tracks[static_cast<std::size_t>(ball)].id; }

    const Record& record;

  private:
    mutable std::optional<Shot> shot_;
};

struct MeasureRow {
    MeasureInfo info;
    MeasureValue (*value)(const PlayedShot&, const Arguments&);
};
std::span<const MeasureRow> measure_rows();
/// Measures of a ball's route, and of the points that it scores (routes.cpp).
std::span<const MeasureRow> route_rows();

/// The hits by which a ball is driven to a cushion or a jaw.
std::vector<Hit> driven(const PlayedShot& played, int ball);
/// The verdict on a shot as a break, or in the middle of a game; in eight-ball with an open table. Every ball
/// that falls counts as called.
Verdict judged(const PlayedShot& played, Game game, bool opening);
/// The rails of a table: "left", "foot", ...; the id of a cushion without a name.
Texts rails_of(const Table& table);

}  // namespace carom::games::detail
