// Eight-ball by the World Pool-Billiard Association: rule 3, with 1.4 to 1.6 and 6.
#include <string>
#include <string_view>
#include <vector>

#include "facts.h"

namespace carom::games::detail {
namespace {

const std::string kEight = "8";

Group group_of(std::string_view ball) {
    const int number = number_of(ball);
    if (number >= 1 && number <= 7) return Group::kSolids;
    return number >= 9 && number <= 15 ? Group::kStripes : Group::kOpen;
}

/// A player's targets: their own group, any ball except the eight while the table is open, and the eight when
/// the group is gone.
std::vector<std::string> targets(const State& state, const std::vector<std::string>& balls) {
    const Group own = state.group[static_cast<std::size_t>(state.turn)];
    std::vector<std::string> list;
    for (const std::string& ball : balls) {
        const Group group = group_of(ball);
        if (group != Group::kOpen && (own == Group::kOpen || group == own)) list.push_back(ball);
    }
    if (list.empty() && is_in(kEight, balls)) list.push_back(kEight);
    return list;
}

std::vector<Respot> eight_on_its_spot(const Facts& facts) {
    return on_foot_spot(facts, {kEight});
}

Option rerack(const State& state, Decision decision, int breaker) {
    return {decision, broken_by(state, breaker), {}};
}

/// 3.3 (e) and (f): the eight is respotted, or the chooser breaks again. An option can make it one of these,
/// or decide the game.
void eight_on_the_break(const Facts& facts, const State& next, Verdict& verdict) {
    const std::string_view option = rule(facts.state, "eight_on_break");
    if (option == "wins")
        verdict.options = {{Decision::kPlayOn, won_by(next, next.turn), {}}};
    else if (option == "rerack")
        verdict.options = {rerack(facts.state, Decision::kRerack, next.turn)};
    else
        verdict.options = {{Decision::kSpotEight, next, eight_on_its_spot(facts)},
                           rerack(facts.state, Decision::kRerack, next.turn)};
    verdict.chooser = verdict.options.size() > 1 ? next.turn : -1;
}

/// 3.3 (d), (g) and (h): the other player's options after an illegal or foul break.
void bad_break(const Facts& facts, State next, bool illegal, Verdict& verdict) {
    std::vector<Respot> respots;
    if (facts.left(kEight)) respots = eight_on_its_spot(facts);
    verdict.chooser = next.turn;
    next.in_hand = InHand::kNo;
    if (!facts.shot.gone(facts.shot.struck)) verdict.options.push_back({Decision::kPlayOn, next, respots});
    next.in_hand = InHand::kHeadString;
    if (!verdict.fouls.empty()) verdict.options.push_back({Decision::kTakeInHand, next, respots});
    if (illegal) {
        verdict.options.push_back(rerack(facts.state, Decision::kRerack, next.turn));
        verdict.options.push_back(rerack(facts.state, Decision::kRerackForOther, 1 - next.turn));
    }
    if (verdict.options.size() == 1) verdict.chooser = -1;
}

void add_fouls(const Facts& facts, const std::vector<std::string>& first, bool need_cushion,
               std::vector<Foul>& fouls) {
    facts.add_pool_fouls(fouls, first, need_cushion);
    if (rule(facts.state, "jump") == "foul" && facts.jumps()) fouls.push_back(Foul::kJumpShot);
}

Verdict judge_break(const Facts& facts) {
    std::vector<Foul> fouls;
    // 3.3 (b): any ball may be hit first.
    add_fouls(facts, facts.ids(), true, fouls);
    Verdict verdict;
    verdict.fouls = called(fouls);
    const bool illegal = !facts.any_object_fell() && facts.objects_driven() < kDrivenOnBreak;
    State next = facts.state;
    next.opening = false;
    next.in_hand = InHand::kNo;
    if (!verdict.fouls.empty() || illegal) {
        next = other_players(next, InHand::kHeadString);
        if (facts.fell(kEight))
            eight_on_the_break(facts, next, verdict);
        else
            bad_break(facts, next, illegal, verdict);
        return verdict;
    }
    if (facts.fell(kEight)) {
        eight_on_the_break(facts, next, verdict);
        return verdict;
    }
    if (!facts.any_object_fell()) next = other_players(next, InHand::kNo);
    verdict.options = {{Decision::kPlayOn, next, {}}};
    return verdict;
}

/// Whether the shot that pockets the eight wins: 3.6 and 3.8.
bool wins(const Facts& facts, const std::vector<Foul>& fouls, const std::vector<std::string>& targets) {
    const bool behind_the_group =
        facts.state.group[static_cast<std::size_t>(facts.state.turn)] != Group::kOpen &&
        is_in(kEight, targets);
    const bool as_called = facts.call.ball == kEight && facts.fell_as_called();
    return fouls.empty() && behind_the_group && !facts.call.safety && facts.fell(kEight) &&
           (as_called || rule(facts.state, "call") == "none");
}

/// The ball that lets the player continue, or "": the called one, or the first one of the player's own.
std::string made(const Facts& facts, const std::vector<std::string>& own) {
    if (facts.call.safety) return "";
    if (rule(facts.state, "call") == "all")
        return is_in(facts.call.ball, own) && facts.fell_as_called() ? facts.call.ball : "";
    for (const Shot::Fallen& fallen : facts.shot.pocketed)
        if (is_in(facts.id(fallen.ball), own)) return facts.id(fallen.ball);
    return "";
}

Legal legal_eight_ball(const State& state, const std::vector<std::string>& balls) {
    Legal legal;
    legal.cue_balls = {"cue"};
    if (state.opening) {
        for (const std::string& ball : balls)
            if (number_of(ball) > 0) legal.first.push_back(ball);
        return legal;
    }
    legal.first = targets(state, balls);
    const std::string_view call = rule(state, "call");
    if (call == "all" || (call == "eight" && is_in(kEight, legal.first))) legal.callable = legal.first;
    return legal;
}

Verdict judge_eight_ball(const Facts& facts) {
    if (facts.state.opening) return judge_break(facts);
    const State& state = facts.state;
    const std::vector<std::string> own = targets(state, facts.ids());
    std::vector<Foul> fouls;
    add_fouls(facts, own, !facts.any_object_fell(), fouls);
    State next = state;
    next.in_hand = InHand::kNo;
    if (facts.gone(kEight)) {
        const int winner = wins(facts, fouls, own) ? state.turn : 1 - state.turn;
        return one_way(fouls, {Decision::kPlayOn, won_by(next, winner), {}});
    }
    const InHand where = rule(state, "in_hand") == "anywhere" ? InHand::kAnywhere : InHand::kHeadString;
    if (!fouls.empty()) return one_way(fouls, {Decision::kTakeInHand, other_players(next, where), {}});
    const std::string ball = made(facts, own);
    if (ball.empty()) return one_way({}, {Decision::kPlayOn, other_players(next, InHand::kNo), {}});
    // 3.4: the first ball that counts decides the groups.
    const auto me = static_cast<std::size_t>(state.turn);
    if (state.group[me] == Group::kOpen) {
        next.group[me] = group_of(ball);
        next.group[1 - me] = next.group[me] == Group::kSolids ? Group::kStripes : Group::kSolids;
    }
    Verdict verdict = one_way({}, {Decision::kPlayOn, next, {}});
    verdict.points = 1;
    return verdict;
}

}  // namespace
}  // namespace carom::games::detail

namespace carom::games {

const GameRules kEightBall = {
    .info =
        {.name = "eight_ball",
         .title = "eight-ball",
         .book = "World Pool-Billiard Association, The Rules of Play, 15 March 2016: rule 3",
         .calls = "ball and pocket, or a safety",
         .is_scored = false,
         .has_groups = true,
         .has_safety = true,
         .start = detail::start_of("game = \"eight_ball\"", {{"cue", 0.45, 0.22}}, "cue", 8, 90),
         .options = {{&kEightBall,
                      "call",
                      {"all", "eight", "none"},
                      "Shots to call: all, only the one at the eight, or none."},
                     {&kEightBall,
                      "eight_on_break",
                      {"respot", "wins", "rerack"},
                      "Effect of an eight that falls on the break: a respot or rerack, as the next player "
                      "chooses; a win, or a loss after a foul; or always a rerack."},
                     {&kEightBall,
                      "in_hand",
                      {"anywhere", "behind_line"},
                      "Area of the cue ball in hand after a foul: anywhere, or behind the head string."},
                     {&kEightBall,
                      "jump",
                      {"fair", "foul"},
                      "Whether the cue ball may pass over a ball before it hits one."}}},
    .legal = detail::legal_eight_ball,
    .judge = detail::judge_eight_ball,
    .start = InHand::kHeadString,
    .balls = {"cue", "8"},
    .fouls = kPoolFouls,
    .break_rule = "WPA 3.3"};

}  // namespace carom::games
