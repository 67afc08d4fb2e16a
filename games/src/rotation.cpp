// The rules that nine-ball and ten-ball share (WPA 2 and 9).
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "facts.h"

namespace carom::games::detail {
namespace {

/// Consecutive fouls that lose the rack (6.14).
constexpr int kFoulsThatLose = 3;

}  // namespace

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

std::vector<Respot> last_ball_back(const Facts& facts, const std::string& last) {
    return facts.gone(last) ? on_foot_spot(facts, {last}) : std::vector<Respot>();
}

State after_break(const State& state) {
    State next = state;
    next.opening = false;
    next.may_push_out = state.opening && rule(state, "push_out") == "true";
    next.in_hand = InHand::kNo;
    return next;
}

std::vector<Foul> rotation_fouls(const Facts& facts, bool push) {
    std::vector<Foul> fouls;
    // 2.4: a push out may hit any ball first, and needs no cushion.
    facts.add_pool_fouls(fouls, push ? facts.ids() : lowest(facts.ids()), !push && !facts.any_object_fell());
    if (facts.state.opening && !facts.any_object_fell() && facts.objects_driven() < kDrivenOnBreak)
        fouls.push_back(Foul::kFewCushionsOnBreak);
    return fouls;
}

Verdict rotation_foul(const Facts& facts, std::vector<Foul> fouls, State next, const std::string& last) {
    next.may_push_out = false;
    int& in_a_row = next.fouls[static_cast<std::size_t>(next.turn)];
    if (++in_a_row >= kFoulsThatLose && rule(next, "three_fouls") == "true") {
        fouls.push_back(Foul::kThirdFoul);
        return one_way(fouls, {Decision::kPlayOn, won_by(next, 1 - next.turn), {}});
    }
    return one_way(
        fouls, {Decision::kTakeInHand, other_players(next, InHand::kAnywhere), last_ball_back(facts, last)});
}

Verdict shoot_or_pass_back(const State& next, const std::vector<Respot>& respots) {
    Verdict verdict;
    const State other = other_players(next, InHand::kNo);
    verdict.options = {{Decision::kPlayOn, other, respots}, {Decision::kPassBack, next, respots}};
    verdict.chooser = other.turn;
    return verdict;
}

}  // namespace carom::games::detail
