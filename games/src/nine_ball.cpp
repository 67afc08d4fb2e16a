// Nine-ball by the World Pool-Billiard Association: rule 2, with 1.4, 1.5 and 6.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "facts.h"

namespace carom::games::detail {
namespace {

const std::string kNine = "9";
/// Consecutive fouls that lose the rack (6.14).
constexpr int kFoulsThatLose = 3;

/// The ball with the lowest number; none on an empty table.
std::vector<std::string> lowest(const std::vector<std::string>& balls) {
    std::vector<std::string> numbered;
    for (const std::string& ball : balls)
        if (number_of(ball) > 0) numbered.push_back(ball);
    const auto least = std::min_element(numbered.begin(), numbered.end(), [](const auto& a, const auto& b) {
        return number_of(a) < number_of(b);
    });
    if (least == numbered.end()) return {};
    return {*least};
}

/// 2.6: the nine is respotted; no other ball is.
std::vector<Respot> nine_back(const Facts& facts) {
    if (!facts.gone(kNine)) return {};
    const double R = facts.radius(kNine);
    return {{kNine, spot_on_long_string(facts.record.table, foot_spot(facts.record.table), R,
                                        facts.lying(kSpotGap, 0.0))}};
}

Verdict foul(const Facts& facts, std::vector<Foul> fouls, State next) {
    int& in_a_row = next.fouls[static_cast<std::size_t>(next.turn)];
    if (++in_a_row >= kFoulsThatLose) {
        fouls.push_back(Foul::kThirdFoul);
        return one_way(std::move(fouls), {Decision::kPlayOn, won_by(next, 1 - next.turn), {}});
    }
    return one_way(std::move(fouls),
                   {Decision::kTakeInHand, other_players(next, InHand::kAnywhere), nine_back(facts)});
}

}  // namespace

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
    std::vector<Foul> fouls;
    // 2.4: a push out may hit any ball first, and needs no cushion.
    facts.add_pool_fouls(fouls, push ? facts.ids() : lowest(facts.ids()), !push && !facts.any_object_fell());
    if (state.opening && !facts.any_object_fell() && facts.objects_driven() < kDrivenOnBreak)
        fouls.push_back(Foul::kFewCushionsOnBreak);
    State next = state;
    next.opening = next.may_push_out = false;
    next.in_hand = InHand::kNo;
    if (!fouls.empty()) return foul(facts, std::move(fouls), next);
    next.fouls[static_cast<std::size_t>(state.turn)] = 0;
    next.may_push_out = state.opening;
    if (push) {
        Verdict verdict;
        const State other = other_players(next, InHand::kNo);
        verdict.options = {{Decision::kPlayOn, other, nine_back(facts)},
                           {Decision::kPassBack, next, nine_back(facts)}};
        verdict.chooser = other.turn;
        return verdict;
    }
    Verdict verdict;
    verdict.points = facts.any_object_fell() ? 1 : 0;
    if (facts.fell(kNine)) next = won_by(next, state.turn);
    if (!facts.any_object_fell()) next = other_players(next, InHand::kNo);
    verdict.options = {{Decision::kPlayOn, next, {}}};
    return verdict;
}

}  // namespace carom::games::detail
