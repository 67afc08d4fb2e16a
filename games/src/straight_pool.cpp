// Straight pool (14.1 continuous) by the World Pool-Billiard Association: rule 4, with 1.4 and 6.
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/geometry.h"
#include "facts.h"

namespace carom::games::detail {
namespace {

constexpr int kBalls = 15, kFoulsInARow = 3;
// Points lost by a foul, an illegal break and a third foul in a row (4.9 to 4.11).
constexpr int kFoul = 1, kBreakingFoul = 2, kThird = 15;
// [m] Gap between racked balls, so that rounding lets the fifteenth ball return to the foot spot.
constexpr double kRackGap = 1e-9;

/// Whether a ball is within or overlaps the outline of the rack (4.8).
bool in_rack(const std::vector<Vec2>& slots, double R, const Vec2& place, double own) {
    const std::array<Vec2, 3> corners{slots[0], slots[10], slots[14]};
    bool inside = true;
    double least = R + own;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 &from = corners[i], &to = corners[(i + 1) % 3];
        const Vec2 side = to - from, way = place - from;
        inside = inside && side.x() * way.y() - side.y() * way.x() <= 0.0;
        least = std::min(least, distance_to_segment(place, from, to));
    }
    return inside || least < R + own;
}

/// 4.8: racks the balls that are gone, after fourteen without the apex ball. The cue ball and the fifteenth
/// ball give way.
Option rack_again(const Facts& facts, State next) {
    const Record& record = facts.record;
    const Table& table = record.table;
    const double R = record.balls.R;
    const std::vector<Vec2> slots = rack_slots({.gap = kRackGap}, foot_spot(table), R);
    const Vec2 cue = facts.rest(facts.shot.struck), head = head_spot(table), center = center_spot(table);
    const auto blocks = [&](const Vec2& ball, const Vec2& spot) { return length(ball - spot) < 2.0 * R; };
    const bool cue_in = in_rack(slots, R, cue, R);
    std::string last;
    for (const std::string& ball : facts.ids())
        if (number_of(ball) > 0 && !facts.gone(ball)) last = ball;
    Option option{Decision::kRackFourteen, std::move(next), {}};
    const Vec2 other = last.empty() ? Vec2::Zero() : facts.rest(last);
    bool fifteen = last.empty();
    if (!last.empty() && in_rack(slots, R, other, R)) {
        fifteen = cue_in;
        if (!cue_in) option.respots.push_back({last, blocks(cue, head) ? center : head});
    } else if (cue_in && !last.empty()) {
        if (blocks(other, head))
            option.respots.push_back({"cue", center});
        else if (other.y() < head_string(table))
            option.respots.push_back({"cue", head});
    }
    if (cue_in && !is_in("cue", option.respots)) option.state.in_hand = InHand::kHeadString;
    std::size_t slot = fifteen ? 0 : 1;
    for (int number = 1; number <= kBalls; ++number) {
        const std::string ball = std::to_string(number);
        if (fifteen || ball != last) option.respots.push_back({ball, slots.at(slot++)});
    }
    return option;
}

/// 4.3: without a called ball, the cue ball and two others must be driven to a rail.
bool breaking_foul(const Facts& facts) {
    const std::vector<int> driven = facts.shot.driven_after(facts.shot.first_time);
    const bool cue = std::find(driven.begin(), driven.end(), facts.shot.struck) != driven.end();
    return facts.shot.first_hits.empty() || !cue || facts.objects_driven() < 2;
}

Verdict foul(const Facts& facts, std::vector<Foul> fouls, bool breaking, const std::vector<Respot>& back) {
    const auto me = static_cast<std::size_t>(facts.state.turn);
    State next = facts.state;
    next.opening = false;
    const int cost = breaking ? kBreakingFoul : kFoul;
    next.points[me] -= cost;
    if (!breaking) ++next.fouls[me];
    const bool third = next.fouls[me] >= kFoulsInARow;
    if (third) {
        fouls.push_back(Foul::kThirdFoul);
        next.points[me] -= kThird;
        next.fouls[me] = 0;
    }
    const Option again{Decision::kRerackForOther, broken_by(next, facts.state.turn), {}};
    Verdict verdict = one_way(fouls, again);
    verdict.points = -cost - (third ? kThird : 0);
    if (third) return verdict;
    const bool gone = facts.shot.gone(facts.shot.struck);
    const State other = other_players(next, gone ? InHand::kHeadString : InHand::kNo);
    verdict.options = {{gone ? Decision::kTakeInHand : Decision::kPlayOn, other, back}};
    if (breaking) {
        verdict.options.push_back(again);
        verdict.chooser = other.turn;
    }
    return verdict;
}

Legal legal_straight_pool(const State&, const std::vector<std::string>& balls) {
    Legal legal;
    legal.cue_balls = {"cue"};
    for (const std::string& ball : balls)
        if (number_of(ball) > 0) legal.first.push_back(ball);
    legal.callable = legal.first;
    return legal;
}

Verdict judge_straight_pool(const Facts& facts) {
    const State& state = facts.state;
    const bool called = !facts.call.safety && facts.fell_as_called();
    std::vector<Foul> fouls;
    facts.add_pool_fouls(fouls, facts.ids(), !facts.any_object_fell());
    const bool breaking = state.opening && !called && breaking_foul(facts);
    if (breaking) fouls.push_back(Foul::kFewCushionsOnBreak);
    // 4.6: balls return after a foul or without a called ball, and from off the table.
    std::vector<std::string> down;
    for (const std::string& ball : facts.ids())
        if (number_of(ball) > 0 && facts.gone(ball)) down.push_back(ball);
    if (!fouls.empty()) return foul(facts, std::move(fouls), breaking, on_foot_spot(facts, down));
    State next = state;
    next.opening = false;
    next.in_hand = InHand::kNo;
    next.fouls[static_cast<std::size_t>(state.turn)] = 0;
    if (!called)
        return one_way({}, {Decision::kPlayOn, other_players(next, InHand::kNo), on_foot_spot(facts, down)});
    next = scored(next, state.turn, facts.objects_fallen());
    const std::vector<std::string> balls = facts.ids();
    const auto left = std::count_if(balls.begin(), balls.end(), [&](const std::string& ball) {
        return number_of(ball) > 0 && !facts.gone(ball);
    });
    Verdict verdict =
        one_way({}, left <= 1 && !next.over ? rack_again(facts, next) : Option{Decision::kPlayOn, next, {}});
    verdict.points = facts.objects_fallen();
    return verdict;
}

}  // namespace
}  // namespace carom::games::detail

namespace carom::games {

const GameRules kStraightPool = {
    .info = {.name = "straight_pool",
             .title = "straight pool",
             .book = "World Pool-Billiard Association, The Rules of Play, 15 March 2016: rule 4",
             .calls = "ball and pocket, or a safety",
             .has_safety = true,
             .usual_target = 50,
             .start = detail::start_of("game = \"triangle\"", {{"cue", 0.65, 0.22}}, "cue", 4, 98)},
    .legal = detail::legal_straight_pool,
    .judge = detail::judge_straight_pool,
    .start = InHand::kHeadString,
    .balls = {"cue"},
    .fouls = kPoolFouls,
    .below_zero = true,
    .break_rule = "WPA 4.10"};

}  // namespace carom::games
