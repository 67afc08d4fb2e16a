// Three-cushion by the Union Mondiale de Billard, and sum to three.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/tolerances.h"
#include "facts.h"

namespace carom::games::detail {
namespace {

constexpr int kCushions = 3;
const std::string kRed = "red";

/// Where a ball of three-cushion is respotted for the next player: the red on the foot spot, the cue ball on
/// the head spot, the other one in the centre.
Vec2 own_spot(const Table& table, const std::string& ball, int shooter) {
    if (ball == kRed) return foot_spot(table);
    return ball == own_ball(shooter) ? head_spot(table) : center_spot(table);
}

/// A ball whose spot is taken goes to the spot of the ball in the way.
std::vector<Respot> spotted(const Facts& facts, const std::vector<std::string>& balls, int shooter) {
    if (balls.empty()) return {};
    std::vector<Respot> respots;
    const auto lies = [&](const std::string& other) {
        for (const Respot& done : respots)
            if (done.ball == other) return done.place;
        return facts.rest(other);
    };
    std::vector<std::string> on_table;
    for (const std::string& ball : facts.ids())
        if (!is_in(ball, balls)) on_table.push_back(ball);
    for (const std::string& ball : balls) {
        const double R = facts.radius(ball);
        Vec2 place = own_spot(facts.record.table, ball, shooter);
        for (int tries = 0; tries < 3; ++tries) {
            const auto masked = std::find_if(on_table.begin(), on_table.end(), [&](const std::string& other) {
                const Lying there = {lies(other), facts.radius(other), 0.0};
                return !is_free(place, R, std::span(&there, 1));
            });
            if (masked == on_table.end()) break;
            place = own_spot(facts.record.table, *masked, shooter);
        }
        respots.push_back({ball, place});
        on_table.push_back(ball);
    }
    return respots;
}

/// A player's cue ball and the balls touching it; empty if none does.
std::vector<std::string> touching(const Facts& facts, int shooter) {
    const int own = index_of(facts.record, own_ball(shooter));
    std::vector<std::string> list;
    for (int i = 0; i < static_cast<int>(facts.record.tracks.size()); ++i) {
        const double gap =
            length(facts.rest(i) - facts.rest(own)) - facts.record.size(i).R - facts.record.size(own).R;
        if (i != own && gap <= kTouchTolerance) list.push_back(facts.id(i));
    }
    if (!list.empty()) list.insert(list.begin(), facts.id(own));
    return list;
}

/// Whether the cue ball hit both others, the second one after three cushions.
bool made_three_cushions(const Facts& facts) {
    int cushions = 0;
    std::vector<int> met;
    for (const Touch& touch : facts.shot.touches) {
        if (touch.ball != facts.shot.struck) continue;
        if (touch.cushion()) {
            cushions += touch.driven ? 1 : 0;
        } else if (std::find(met.begin(), met.end(), touch.other) == met.end()) {
            met.push_back(touch.other);
            if (met.size() == 2) return cushions >= kCushions;
        }
    }
    return false;
}

/// After a point, or without one.
State after(const State& before, bool point) {
    State next = before;
    next.opening = false;
    next.in_hand = InHand::kNo;
    if (!point) return other_players(next, InHand::kNo);
    int& points = next.points[static_cast<std::size_t>(before.turn)];
    ++points;
    return before.target > 0 && points >= before.target ? won_by(next, before.turn) : next;
}

}  // namespace

Legal legal_three_cushion(const State& state, const std::vector<std::string>& balls) {
    Legal legal;
    legal.cue_balls = {own_ball(state.turn)};
    for (const std::string& ball : balls)
        if (ball != legal.cue_balls[0] && (!state.opening || ball == kRed)) legal.first.push_back(ball);
    return legal;
}

Verdict judge_three_cushion(const Facts& facts) {
    const State& state = facts.state;
    std::vector<Foul> fouls;
    if (!facts.struck(own_ball(state.turn))) fouls.push_back(Foul::kWrongCueBall);
    if (!facts.shot.out.empty()) fouls.push_back(Foul::kBallOff);
    const bool first_is_red = facts.first_is_one_of({kRed});
    if (state.opening && !facts.shot.first_hits.empty() && !first_is_red)
        fouls.push_back(Foul::kOpeningNotRed);
    const bool point = fouls.empty() && made_three_cushions(facts);
    const State next = after(state, point);
    std::vector<std::string> off;
    for (const int ball : facts.shot.out) off.push_back(facts.id(ball));
    Verdict verdict = one_way(std::move(fouls), {Decision::kPlayOn, next, spotted(facts, off, next.turn)});
    verdict.points = point ? 1 : 0;
    const std::vector<std::string> against =
        off.empty() && !next.over ? touching(facts, next.turn) : std::vector<std::string>();
    if (!against.empty()) {
        verdict.options.push_back({Decision::kSpotTouching, next, spotted(facts, against, next.turn)});
        verdict.chooser = next.turn;
    }
    return verdict;
}

Legal legal_sum_to_three(const State&, const std::vector<std::string>& balls) {
    Legal legal;
    legal.cue_balls = {"cue"};
    for (const std::string& ball : balls)
        if (ball != "cue") legal.first.push_back(ball);
    return legal;
}

Verdict judge_sum_to_three(const Facts& facts) {
    const auto cushions = std::count_if(facts.shot.touches.begin(), facts.shot.touches.end(),
                                        [](const Touch& touch) { return touch.cushion(); });
    std::vector<Foul> fouls;
    if (!facts.shot.out.empty()) fouls.push_back(Foul::kBallOff);
    const bool point = fouls.empty() && !facts.shot.first_hits.empty() && cushions == kCushions;
    // The game has no rule for lost balls: the cue ball returns behind the head spot, the other one behind
    // the foot spot.
    Option next = {Decision::kPlayOn, after(facts.state, point), {}};
    for (int ball = 0; ball < static_cast<int>(facts.record.tracks.size()); ++ball) {
        if (!facts.shot.gone(ball)) continue;
        std::vector<Lying> others = facts.lying(0.0, 0.0);
        for (const Respot& done : next.respots) others.push_back({done.place, facts.radius(done.ball), 0.0});
        const Table& table = facts.record.table;
        const Vec2 spot = facts.id(ball) == "cue" ? head_spot(table) : foot_spot(table);
        next.respots.push_back(
            {facts.id(ball), spot_on_long_string(table, spot, facts.record.size(ball).R, others)});
    }
    Verdict verdict = one_way(std::move(fouls), next);
    verdict.points = point ? 1 : 0;
    return verdict;
}

}  // namespace carom::games::detail
