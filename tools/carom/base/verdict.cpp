#include "base/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/game_state.h"
#include "carom/engine/math.h"

namespace carom::tools {

using Json = nlohmann::ordered_json;
using games::InHand;
using games::State;
using games::Verdict;

std::string foul_text(games::Game game, games::Foul foul) {
    const std::string rule = games::rule_of(game, foul);
    return carom::name(foul) + (rule.empty() ? "" : " (" + rule + ")");
}

std::string next_text(const State& state) {
    if (state.over)
        return state.winner < 0 ? "the game is over, nobody wins"
                                : fmt::format("the game is over, player {} wins", state.winner + 1);
    std::string text = fmt::format("player {} shoots", state.turn + 1);
    if (state.in_hand == InHand::kAnywhere) text += ", cue ball in hand anywhere";
    if (state.in_hand == InHand::kHeadString) text += ", cue ball in hand behind the head string";
    if (state.in_hand == InHand::kD) text += ", cue ball in hand in the D";
    return text;
}

Json verdict_json(const Verdict& verdict, games::Game game) {
    Json fouls = Json::array(), options = Json::array();
    for (const games::Foul foul : verdict.fouls)
        fouls.push_back({{"foul", carom::name(foul)}, {"rule", games::rule_of(game, foul)}});
    for (const games::Option& option : verdict.options) {
        Json respots = Json::array();
        for (const games::Respot& back : option.respots)
            respots.push_back({{"ball", back.ball}, {"place", {back.place.x(), back.place.y()}}});
        options.push_back({{"decision", carom::name(option.decision)},
                           {"state", state_json(option.state)},
                           {"respots", respots}});
    }
    return {{"fouls", fouls},
            {"points", verdict.points},
            {"penalty", verdict.penalty},
            {"chooser", verdict.chooser},
            {"options", options}};
}

Vec2 free_place(const Record& record, const games::Option& option) {
    const Table& table = record.table;
    const Vec2 from = games::head_spot(table);
    // Rings about the head spot, one ball radius apart.
    const double step = record.balls.R;
    const int rings = static_cast<int>(std::ceil((table.width + table.length) / step));
    for (int ring = 0; ring <= rings; ++ring) {
        const int places = std::max(1, 6 * ring);
        for (int k = 0; k < places; ++k) {
            const auto [sin, cos] = sin_cos_deg(360.0 * k / places - 90.0);
            Vec2 place = from + step * ring * Vec2(cos, sin);
            if (games::may_place(record, option, place)) return place;
        }
    }
    throw std::invalid_argument("there is no free place for the cue ball");
}

Cue next_cue(const Scene& table, const Cue& before, const std::string& ball,
             const std::vector<std::string>& first) {
    Cue cue = before;
    cue.ball = ball;
    cue.side = 0.0;
    const auto struck =
        std::find_if(table.ball.begin(), table.ball.end(), [&](const BallStart& b) { return b.id == ball; });
    double least = HUGE_VAL;
    for (const BallStart& other : table.ball) {
        if (struck == table.ball.end() || other.id == ball) continue;
        if (!first.empty() && std::find(first.begin(), first.end(), other.id) == first.end()) continue;
        const Vec2 way = planar(other.position - struck->position);
        if (way.norm() >= least) continue;
        least = way.norm();
        cue.aim_deg = direction_deg(way.x(), way.y());
    }
    return cue;
}

}  // namespace carom::tools
