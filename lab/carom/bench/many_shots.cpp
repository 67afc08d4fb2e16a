#include "bench/many_shots.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "bench/shot_cases.h"

namespace carom::tools {
namespace {

constexpr std::uint64_t kSeed = 20;

struct Drawn {
    const char* key;
    double low, high;
};
struct Kind {
    const char* name;
    std::size_t shots_a_round;
    std::vector<Drawn> drawn;
};

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all = {
        {"many two_ball", 400, {{"cue.aim_deg", 0.0, 360.0}, {"cue.speed", 1.0, 6.0}}},
        {"many three_cushion", 400, {{"cue.aim_deg", 0.0, 360.0}, {"cue.speed", 1.0, 6.0}}},
        {"many eight_ball_break",
         20,
         {{"cue.aim_deg", 89.5, 90.5}, {"cue.speed", 8.0, 10.0}, {"ball.cue.position.x", 0.625, 0.645}}}};
    return all;
}

const Kind& kind_of(const std::string& name) {
    const auto kind =
        std::find_if(kinds().begin(), kinds().end(), [&](const Kind& k) { return k.name == name; });
    if (kind == kinds().end()) throw std::invalid_argument("no batch is called " + name);
    return *kind;
}

}  // namespace

std::vector<std::string> many_names() {
    std::vector<std::string> names;
    for (const Kind& kind : kinds()) names.emplace_back(kind.name);
    return names;
}

ManyShots::ManyShots(const std::string& name, kernel::Isa isa)
    : name_(name),
      simulator_(many_scene(name), isa),
      random_(kSeed),
      shots_a_round_(kind_of(name).shots_a_round) {
    for (const Drawn& drawn : kind_of(name).drawn)
        numbers_.push_back({SceneNumber(simulator_.scene(), drawn.key), drawn.low, drawn.high});
}

void ManyShots::rewind() {
    random_ = reference::Generator(kSeed);
    shots_ = 0;
    events_ = clusters_ = 0;
    pocketed_ = 0;
}

void ManyShots::play(std::size_t shots) {
    for (std::size_t i = 0; i < shots; ++i) {
        Change change = Change::kNumbers;
        for (const Number& n : numbers_)
            change = std::max(change, n.number.put(simulator_.scene(), random_.uniform(n.low, n.high)));
        if (!has_result(simulator_.play(change)))
            throw std::runtime_error(name_ + ": " + simulator_.message());
        const Outcome& outcome = simulator_.outcome();
        events_ += outcome.events;
        clusters_ += outcome.clusters;
        for (const BallOutcome& ball : outcome.balls) pocketed_ += ball.pocket >= 0;
    }
    shots_ += shots;
}

}  // namespace carom::tools
