#include "commands/simulate/story.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "base/console.h"
#include "carom/engine/event_details.h"
#include "page/event_sentence.h"

namespace carom::tools {
namespace {

// [lines] A shot with more contacts is summarised by its landmarks.
constexpr std::size_t kMostLines = 24;
// [-] Contacts of the struck ball that the summary of a long shot includes.
constexpr int kStruckContacts = 3;
constexpr double kShown = 0.05;  // [m/s] Slower contacts of balls are only counted.

std::string line(const Record& record, std::size_t index, Units units) {
    return fmt::format("{:>9.3f} s  {}\n", record.events[index].time, event_sentence(record, index, units));
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
