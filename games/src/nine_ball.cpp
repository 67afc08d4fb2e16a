// Nine-ball by the World Pool-Billiard Association: rule 2, with 1.4, 1.5 and 6.
#include <string>
#include <utility>
#include <vector>

#include "facts.h"

namespace carom::games::detail {
namespace {

const std::string kNine = "9";

Legal legal_nine_ball(const State& state, const std::vector<std::string>& balls) {
    Legal legal;
    legal.cue_balls = {"cue"};
    legal.first = lowest(balls);
    legal.may_push_out = state.may_push_out;
    return legal;
}

Verdict judge_nine_ball(const Facts& facts) {
    const State& state = facts.state;
    const bool push = facts.call.push_out && state.may_push_out;
    std::vector<Foul> fouls = rotation_fouls(facts, push);
    State next = after_break(state);
    // 2.6: the nine is respotted; no other ball is.
    if (!fouls.empty()) return rotation_foul(facts, std::move(fouls), next, kNine);
    next.fouls[static_cast<std::size_t>(state.turn)] = 0;
    if (push) return shoot_or_pass_back(next, last_ball_back(facts, kNine));
    const bool respot = state.opening && rule(state, "nine_on_break") == "respot";
    if (facts.fell(kNine) && !respot) next = won_by(next, state.turn);
    if (!facts.any_object_fell()) next = other_players(next, InHand::kNo);
    Verdict verdict = one_way({}, {Decision::kPlayOn, next, {}});
    if (respot) verdict.options[0].respots = last_ball_back(facts, kNine);
    verdict.points = facts.any_object_fell() ? 1 : 0;
    return verdict;
}

}  // namespace
}  // namespace carom::games::detail

namespace carom::games {

const GameRules kNineBall = {
    .info = {.name = "nine_ball",
             .title = "nine-ball",
             .book = "World Pool-Billiard Association, The Rules of Play, 15 March 2016: rule 2",
             .calls = "a push out",
             .is_scored = false,
             .has_push_out = true,
             .balls = 9,
             .start =
                 detail::start_of("game = \"nine_ball\"\nspot_ball = 9", {{"cue", 0.4, 0.22}}, "cue", 8, 84),
             .options =
                 {{&kNineBall, "push_out", {"true", "false"}, "The shot after the break may be a push out."},
                  {&kNineBall, "three_fouls", {"true", "false"}, "Three fouls in a row lose the rack."},
                  {&kNineBall,
                   "nine_on_break",
                   {"wins", "respot"},
                   "Effect of a nine that falls on a fair break."}}},
    .legal = detail::legal_nine_ball,
    .judge = detail::judge_nine_ball,
    .start = InHand::kHeadString,
    .balls = {"cue", "9"},
    .fouls = kPoolFouls,
    .break_rule = "WPA 2.3"};

}  // namespace carom::games
