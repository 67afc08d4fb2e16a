#include "page/event_sentence.h"

#include <fmt/format.h>

#include <cmath>

#include "carom/engine/event_details.h"
#include "carom/engine/math.h"

namespace carom::tools {
namespace {

/// ", cut 31 deg, 2.1 m/s"
std::string contact(const EventDetails& d, Units units) {
    if (std::isnan(d.closing)) return "";
    const double cut = d.cut * kDegrees;
    if (cut < 0.5) return fmt::format(", full, {}", speed_text(d.closing, units));
    return fmt::format(", cut {:.0f} deg, {}", cut, speed_text(d.closing / std::cos(d.cut), units));
}

}  // namespace

std::string event_sentence(const Record& record, std::size_t index, Units units) {
    const Event& event = record.events[index];
    const std::string& ball = record.tracks.at(event.a).id;
    const std::string met = met_name(record, event);
    const EventDetails d = details_of(record, index);
    const BallAtEvent& a = d.balls.front();
    const auto speed = [&](const BallState& state) { return speed_text(state.velocity.norm(), units); };
    switch (event.type) {
        case EventType::kCueStrike:
            return fmt::format("{} is struck: {}", ball, speed(a.after));
        case EventType::kBallBall: {
            // The ball that moves meets the other one.
            const bool other_moves = a.before.velocity.norm() < d.balls[1].before.velocity.norm();
            return fmt::format("{} meets {}{}", other_moves ? met : ball, other_moves ? ball : met,
                               contact(d, units));
        }
        case EventType::kBallCluster:
            return fmt::format("{} meets {}: {} balls at once{}", ball, met, d.balls.size(),
                               contact(d, units));
        case EventType::kBallCushion: {
            const std::string place = std::isnan(d.diamond) ? "" : fmt::format(", diamond {:.1f}", d.diamond);
            return fmt::format("{} meets the {}{}, {}", ball, met, place, speed(a.before));
        }
        case EventType::kBallJaw:
            return fmt::format("{} meets the {}, {}", ball, met, speed(a.before));
        case EventType::kBallPocket:
            return fmt::format("{} falls into the {}", ball, met);
        case EventType::kBallOut:
            return fmt::format("{} leaves the table, {}", ball, speed(a.after));
        case EventType::kBallCloth:
            return fmt::format("{} lands", ball);
        case EventType::kSlideRoll:
            return fmt::format("{} rolls, {}", ball, speed(a.after));
        case EventType::kRollStop:
        case EventType::kSpinStop:
            return fmt::format("{} comes to rest", ball);
        case EventType::kRollSpin:
            return fmt::format("{} stops and spins on the spot", ball);
        case EventType::kBallEdge:
            return fmt::format("{} passes the edge of the {}", ball, met);
        case EventType::kBallBallHold:
            return fmt::format("{} stays in contact with {}", ball, met);
        case EventType::kBallCushionHold:
        case EventType::kBallJawHold:
            return fmt::format("{} stays in contact with the {}", ball, met);
        case EventType::kBallBallRelease:
            return fmt::format("{} and {} part", ball, met);
        case EventType::kBallCushionRelease:
        case EventType::kBallJawRelease:
            return fmt::format("{} leaves the {}", ball, met);
    }
    return "";
}

}  // namespace carom::tools
