#include "bench/many_shots.h"

#include <algorithm>
#include <cmath>
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
    double off = 0.0;  ///< the largest distance of the cue ball's path from ball 1's centre, over 2 R
};

/// A natural break: from any place behind the line, ball 1 hit between full and a tenth full.
Kind drawn_break(const char* name) {
    return {
        name,
        20,
        {{"ball.cue.position.x", 0.2, 1.07}, {"ball.cue.position.y", 0.1, 0.63}, {"cue.speed", 6.0, 10.0}},
        0.9};
}

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all = {
        {"many two_ball", 400, {{"cue.aim_deg", 0.0, 360.0}, {"cue.speed", 1.0, 6.0}}},
        {"many three_cushion", 400, {{"cue.aim_deg", 0.0, 360.0}, {"cue.speed", 1.0, 6.0}}},
        {"many eight_ball_break",
         20,
         {{"cue.aim_deg", 89.5, 90.5}, {"cue.speed", 8.0, 10.0}, {"ball.cue.position.x", 0.625, 0.645}}},
        drawn_break("many drawn_eight_ball"),
        drawn_break("many drawn_nine_ball")};
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
      shots_a_round_(kind_of(name).shots_a_round),
      off_(kind_of(name).off) {
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
        if (off_ > 0.0) aim_at_rack();
        if (!has_result(simulator_.play(change)))
            throw std::runtime_error(name_ + ": " + simulator_.message());
        const Outcome& outcome = simulator_.outcome();
        events_ += outcome.events;
        clusters_ += outcome.clusters;
        for (const BallOutcome& ball : outcome.balls) pocketed_ += ball.pocket >= 0;
    }
    shots_ += shots;
}

// As cue.aim_hit does: the cue ball's path passes the centre of ball 1 at a distance.
void ManyShots::aim_at_rack() {
    Scene& scene = simulator_.scene();
    const auto place = [&scene](const char* id) {
        const auto ball = std::find_if(scene.ball.begin(), scene.ball.end(),
                                       [id](const BallStart& b) { return b.id == id; });
        return Vec2(ball->position.head<2>());
    };
    const Vec2 way = place("1") - place("cue");
    const double off = random_.uniform(-off_, off_) * 2.0 * scene.balls.R;
    scene.cue->aim_deg = (std::atan2(way.y(), way.x()) + std::asin(off / way.norm())) * 180.0 / M_PI;
}

}  // namespace carom::tools
