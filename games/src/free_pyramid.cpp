// Free pyramid, the Russian game in which any ball may be struck: the rules at duplet.news
// ("Free Pyramid", 1 to 7) and the general rules of pyramid.
#include <string>
#include <vector>

#include "facts.h"

namespace carom::games::detail {
namespace {

Legal legal_free_pyramid(const State& state, const std::vector<std::string>& balls) {
    Legal legal;
    // 2: the break is played with the coloured ball, every other shot with any ball.
    for (const std::string& ball : balls) {
        if (!state.opening || ball == "cue") legal.cue_balls.push_back(ball);
        if (!state.opening || ball != "cue") legal.first.push_back(ball);
    }
    // A shot needs two balls.
    if (balls.size() < 2) legal.first.clear();
    return legal;
}

Verdict judge_free_pyramid(const Facts& facts) {
    const State& state = facts.state;
    std::vector<Foul> fouls;
    if (state.opening && facts.struck("cue"))
        facts.add_placement_fouls(fouls);
    else if (state.opening)
        fouls.push_back(Foul::kWrongCueBall);
    if (facts.shot.first_hits.empty())
        fouls.push_back(Foul::kNoBallHit);
    else if (facts.shot.driven_after(facts.shot.first_time).empty())
        fouls.push_back(Foul::kNoCushion);
    if (!facts.shot.out.empty()) fouls.push_back(Foul::kBallOff);
    State next = state;
    next.opening = false;
    next.in_hand = InHand::kNo;
    if (fouls.empty()) {
        // 5.2 to 5.5: every ball that falls counts, including the struck one.
        const auto fallen = static_cast<int>(facts.shot.pocketed.size());
        next = fallen > 0 ? scored(next, state.turn, fallen) : other_players(next, InHand::kNo);
        Verdict verdict = one_way({}, {Decision::kPlayOn, next, {}});
        verdict.points = fallen;
        return verdict;
    }
    // 6 and 7: the other player gets a point; balls that fell or left the table return.
    std::vector<std::string> down;
    for (const std::string& ball : facts.ids())
        if (facts.gone(ball)) down.push_back(ball);
    next = scored(other_players(next, InHand::kNo), 1 - state.turn, 1);
    Verdict verdict = one_way(
        fouls, {Decision::kPlayOn, next, next.over ? std::vector<Respot>() : on_foot_spot(facts, down)});
    verdict.penalty = 1;
    return verdict;
}

}  // namespace
}  // namespace carom::games::detail

namespace carom::games {

namespace {

constexpr FoulRule kPyramidFouls[] = {
    {Foul::kNoBallHit, "pyramid, fouls"},        {Foul::kNoCushion, "pyramid, fouls"},
    {Foul::kBallOff, "pyramid, fouls"},          {Foul::kPlacedOutside, "pyramid, break"},
    {Foul::kBehindHeadString, "pyramid, break"}, {Foul::kWrongCueBall, "pyramid, break"}};

}  // namespace

const GameRules kFreePyramid = {
    .info = {.name = "free_pyramid",
             .title = "free pyramid",
             .book = "Free Pyramid and Pyramid general rules, duplet.news, read in November 2026",
             .target = 8,
             .table = "pyramid",
             .start = detail::start_of("game = \"pyramid\"", {{"cue", 0.45, 0.22}}, "cue", 8, 90)},
    .legal = detail::legal_free_pyramid,
    .judge = detail::judge_free_pyramid,
    .start = InHand::kHeadString,
    .fouls = kPyramidFouls,
    .struck = GameRules::Struck::kAny};

}  // namespace carom::games
