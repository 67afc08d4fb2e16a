// Ten-ball by the World Pool-Billiard Association: rule 9, with 1.4, 1.5 and 6.
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "facts.h"

namespace carom::games::detail {
namespace {

const std::string kTen = "10";

/// Whether the ten is the only object ball that was on the table before the shot, or falls last.
bool ten_is_last(const Facts& facts) {
    const std::vector<std::string> ids = facts.ids();
    return std::none_of(ids.begin(), ids.end(), [&](const std::string& ball) {
        return number_of(ball) > 0 && ball != kTen && !facts.gone(ball);
    });
}

Legal legal_ten_ball(const State& state, const std::vector<std::string>& balls) {
    Legal legal;
    legal.cue_balls = {"cue"};
    legal.first = lowest(balls);
    legal.may_push_out = state.may_push_out;
    for (const std::string& ball : balls)
        if (number_of(ball) > 0 && !state.opening) legal.callable.push_back(ball);
    return legal;
}

Verdict judge_ten_ball(const Facts& facts) {
    const State& state = facts.state;
    const bool push = facts.call.push_out && state.may_push_out;
    std::vector<Foul> fouls = rotation_fouls(facts, push);
    State next = after_break(state);
    if (!fouls.empty()) return rotation_foul(facts, std::move(fouls), next, kTen);
    next.fouls[static_cast<std::size_t>(state.turn)] = 0;
    // 9.9: the ten is spotted unless it wins; no other ball is.
    const std::vector<Respot> back = last_ball_back(facts, kTen);
    if (push) return shoot_or_pass_back(next, back);
    const bool called = !facts.call.safety && number_of(facts.call.ball) > 0 && facts.fell_as_called();
    // 9.3 and 9.8: any ball that falls on the break, later the called one, lets the player continue.
    if (state.opening ? facts.any_object_fell() : called) {
        const bool wins = !state.opening && facts.call.ball == kTen &&
                          (ten_is_last(facts) || rule(state, "early_ten") == "wins");
        if (wins) next = won_by(next, state.turn);
        Verdict verdict = one_way({}, {Decision::kPlayOn, next, wins ? std::vector<Respot>() : back});
        verdict.points = 1;
        return verdict;
    }
    // 9.6 and 9.7: after another ball, or a ball on a safety, the other player shoots or passes back.
    if (facts.any_object_fell()) return shoot_or_pass_back(next, back);
    return one_way({}, {Decision::kPlayOn, other_players(next, InHand::kNo), back});
}

}  // namespace
}  // namespace carom::games::detail

namespace carom::games {

const GameRules kTenBall = {
    .info = {.name = "ten_ball",
             .title = "ten-ball",
             .book = "World Pool-Billiard Association, The Rules of Play, 15 March 2016: rule 9",
             .calls = "ball and pocket, a safety, or a push out",
             .is_scored = false,
             .has_safety = true,
             .has_push_out = true,
             .balls = 10,
             .start = detail::start_of("game = \"ten_ball\"", {{"cue", 0.4, 0.22}}, "cue", 8, 84),
             .options =
                 {{&kTenBall, "push_out", {"true", "false"}, "The shot after the break may be a push out."},
                  {&kTenBall, "three_fouls", {"true", "false"}, "Three fouls in a row lose the rack."},
                  {&kTenBall,
                   "early_ten",
                   {"respot", "wins"},
                   "Effect of a called ten that falls while other balls are left."}}},
    .legal = detail::legal_ten_ball,
    .judge = detail::judge_ten_ball,
    .start = InHand::kHeadString,
    .balls = {"cue", "10"},
    .fouls = kPoolFouls,
    .break_rule = "WPA 9.3"};

}  // namespace carom::games
