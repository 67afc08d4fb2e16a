#include "commands/simulate/story.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "base/console.h"
#include "carom/engine/event_details.h"
#include "carom/engine/math.h"

namespace carom::tools {
namespace {

// [lines] A shot with more contacts is summarised by its landmarks.
constexpr std::size_t kMostLines = 24;
// [-] Contacts of the struck ball that the summary of a long shot includes.
constexpr int kStruckContacts = 3;
constexpr double kShown = 0.05;  // [m/s] Slower contacts of balls are only counted.

/// ", cut 31 deg, 2.1 m/s"
std::string contact(const EventDetails& d, Units units) {
    if (std::isnan(d.closing)) return "";
    const double cut = d.cut * kDegrees;
    if (cut < 0.5) return fmt::format(", full, {}", speed_text(d.closing, units));
    return fmt::format(", cut {:.0f} deg, {}", cut, speed_text(d.closing / std::cos(d.cut), units));
}

/// "cue meets 1, cut 31 deg, 2.1 m/s"
std::string sentence(const Record& record, std::size_t index, Units units) {
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
            return fmt::format("{} meets {}: {} at once{}", ball, met, counted(d.balls.size(), "ball"),
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

std::string line(const Record& record, std::size_t index, Units units) {
    return fmt::format("{:>9.3f} s  {}\n", record.events[index].time, sentence(record, index, units));
}

bool of_ball(const Event& event, int ball) {
    return event.a == ball || (kind(event.type).partner == Partner::kBall && event.b == ball);
}

bool is_end(const Event& event) {
    return event.type == EventType::kCueStrike || event.type == EventType::kBallPocket ||
           event.type == EventType::kBallOut;
}

/// Contacts since the last landmark, in one line.
class Crowd {
  public:
    void add(const Event& event) {
        if (balls_ + walls_ + landings_ == 0) from_ = event.time;
        const Partner met = kind(event.type).partner;
        ++(met == Partner::kBall ? balls_ : met == Partner::kNone ? landings_ : walls_);
    }
    std::string told() {
        std::vector<std::string> parts;
        if (balls_ > 0) parts.push_back(counted(balls_, "contact") + " between balls");
        if (walls_ > 0) parts.push_back(counted(walls_, "contact") + " with cushions and jaws");
        if (landings_ > 0) parts.push_back(counted(landings_, "landing"));
        if (parts.empty()) return "";
        std::string text = fmt::format("{:>9.3f} s  then {}\n", from_, fmt::join(parts, ", "));
        *this = {};
        return text;
    }

  private:
    std::size_t balls_ = 0, walls_ = 0, landings_ = 0;
    double from_ = 0.0;
};

}  // namespace

std::string story(const Record& record, Units units) {
    std::vector<std::size_t> told;
    for (std::size_t i = 0; i < record.events.size(); ++i)
        if (kind(record.events[i].type).phase == EventPhase::kImpact || is_end(record.events[i]))
            told.push_back(i);
    const bool whole = told.size() <= kMostLines;
    const int struck =
        record.events.empty() || record.events[0].type != EventType::kCueStrike ? -1 : record.events[0].a;
    std::string text;
    int contacts = 0;
    Crowd crowd;
    for (const std::size_t i : told) {
        const Event& event = record.events[i];
        const bool landmark =
            is_end(event) || (of_ball(event, struck) && kind(event.type).partner != Partner::kNone &&
                              contacts++ < kStruckContacts);
        const bool gentle = event.type == EventType::kBallBall &&
                            details_of(record, i).closing < kShown * std::cos(details_of(record, i).cut);
        if (landmark || (whole && !gentle))
            text += crowd.told() + line(record, i, units);
        else
            crowd.add(event);
    }
    return text + crowd.told();
}

std::string all_events(const Record& record, Units units) {
    fmt::memory_buffer out;
    for (std::size_t i = 0; i < record.events.size(); ++i)
        fmt::format_to(std::back_inserter(out), "{}", line(record, i, units));
    return fmt::to_string(out);
}

}  // namespace carom::tools
