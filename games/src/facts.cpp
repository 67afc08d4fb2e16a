#include "facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/as_number.h"
#include "carom/engine/tolerances.h"

namespace carom::games::detail {

bool is_in(std::string_view ball, const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), ball) != list.end();
}

bool is_in(std::string_view ball, const std::vector<Respot>& respots) {
    return std::any_of(respots.begin(), respots.end(), [&](const Respot& r) { return r.ball == ball; });
}

bool is_bank(const Record& record, const Shot& shot, const Shot::Fallen& fallen) {
    // [-] Of the table's width.
    constexpr double kFar = 0.25;
    const Vec2 pocket = record.table.pockets[static_cast<std::size_t>(fallen.pocket)].center;
    return std::any_of(shot.touches.begin(), shot.touches.end(), [&](const BallContact& touch) {
        if (!touch.cushion() || !touch.driven || touch.ball != fallen.ball) return false;
        return length(planar(record.state_at(touch.ball, touch.time).position) - pocket) >
               kFar * record.table.width;
    });
}

int number_of(std::string_view ball) {
    return std::max(0, as_number<int>(ball).value_or(0));
}

State other_players(const State& state, InHand in_hand) {
    State next = state;
    next.turn = 1 - state.turn;
    next.in_hand = in_hand;
    return next;
}

State won_by(State state, int winner) {
    state.over = true;
    state.winner = winner;
    state.in_hand = InHand::kNo;
    return state;
}

State scored(State state, int player, int points) {
    int& sum = state.points[static_cast<std::size_t>(player)];
    sum += points;
    return state.target > 0 && sum >= state.target ? won_by(state, player) : state;
}

State broken_by(const State& state, int breaker) {
    State next = new_game(state.game, breaker, state.target);
    next.rules = state.rules;
    next.points = state.points;
    next.fouls = state.fouls;
    return next;
}

std::vector<Respot> on_foot_spot(const Facts& facts, const std::vector<std::string>& balls) {
    std::vector<Respot> respots;
    std::vector<Lying> others = facts.lying(kSpotGap, 0.0, balls);
    for (const std::string& ball : balls) {
        const double R = facts.radius(ball);
        const Table& table = facts.record.table;
        respots.push_back({ball, spot_on_long_string(table, foot_spot(table), R, others)});
        others.push_back({respots.back().place, R, 0.0});
    }
    return respots;
}

std::string start_of(std::string_view rack, const std::vector<Placed>& balls, std::string_view struck,
                     double speed, double aim_deg) {
    std::string text;
    if (!rack.empty()) text = fmt::format("[rack]\n{}\ngap = 1e-4\nseed = SEED\n", rack);
    for (const Placed& ball : balls)
        text += fmt::format("[[ball]]\nid = \"{}\"\nposition = [{}w, {}l]\n", ball.id, ball.x, ball.y);
    return text + fmt::format("[cue]\nball = \"{}\"\nspeed = {}\naim_deg = {}\n", struck, speed, aim_deg);
}

std::vector<CalledFoul> called(const std::vector<Foul>& fouls) {
    std::vector<CalledFoul> list;
    list.reserve(fouls.size());
    for (const Foul foul : fouls) list.push_back({foul});
    return list;
}

Verdict one_way(const std::vector<Foul>& fouls, const Option& option) {
    Verdict verdict;
    verdict.fouls = called(fouls);
    verdict.options = {option};
    return verdict;
}

Facts::Facts(const State& of, const Record& in, const Call& said)
    : state(of), record(in), call(said), shot(shot_of(in)) {}

bool Facts::fell(std::string_view ball) const {
    const int index = index_of(record, ball);
    return index >= 0 && shot.fell(index);
}

bool Facts::left(std::string_view ball) const {
    const int index = index_of(record, ball);
    return index >= 0 && shot.left(index);
}

int Facts::objects_fallen() const {
    return static_cast<int>(shot.pocketed.size()) - (shot.fell(shot.struck) ? 1 : 0);
}

bool Facts::any_object_fell() const {
    return objects_fallen() > 0;
}

int Facts::objects_off() const {
    return static_cast<int>(shot.out.size()) - (shot.left(shot.struck) ? 1 : 0);
}

bool Facts::fell_as_called() const {
    return std::any_of(shot.pocketed.begin(), shot.pocketed.end(), [this](const Shot::Fallen& f) {
        return f.ball != shot.struck && id(f.ball) == call.ball &&
               record.table.pockets[static_cast<std::size_t>(f.pocket)].id == call.pocket;
    });
}

bool Facts::first_is_one_of(const std::vector<std::string>& ids) const {
    return std::any_of(shot.first_hits.begin(), shot.first_hits.end(),
                       [&](int ball) { return is_in(id(ball), ids); });
}

std::vector<std::string> Facts::touching(int ball, double time) const {
    const auto place = [&](int of) { return planar(record.state_at(of, time).position); };
    std::vector<std::string> list;
    for (int i = 0; i < static_cast<int>(record.tracks.size()); ++i) {
        const double gap = length(place(i) - place(ball)) - record.size(i).R - record.size(ball).R;
        if (i != ball && gap <= kTouchTolerance) list.push_back(id(i));
    }
    return list;
}

bool Facts::jumps() const {
    const std::vector<Segment>& segments = record.tracks[static_cast<std::size_t>(shot.struck)].segments;
    const double first = shot.first_hits.empty() ? record.duration : shot.first_time;
    const auto apart = [&](int ball, double time) {
        return Vec2(
            planar(record.state_at(shot.struck, time).position - record.state_at(ball, time).position));
    };
    for (std::size_t k = 0; k < segments.size() && segments[k].start < first; ++k) {
        if (segments[k].state != MotionState::kAirborne) continue;
        // In the air, the path over the table is straight.
        const double start = segments[k].start,
                     next = k + 1 < segments.size() ? segments[k + 1].start : record.duration,
                     end = std::min(next, first);
        for (int ball = 0; ball < static_cast<int>(record.tracks.size()); ++ball) {
            if (ball == shot.struck || !(end > start)) continue;
            const Vec2 from = apart(ball, start), way = apart(ball, end) - from;
            const double reach = record.size(shot.struck).R + record.size(ball).R;
            const double share = -dot(from, way) / std::max(dot(way, way), 1e-300);
            if (share > 0.0 && share < 1.0 && length(from + share * way) < reach) return true;
            const bool hit =
                std::find(shot.first_hits.begin(), shot.first_hits.end(), ball) != shot.first_hits.end();
            if (!hit || next < first) continue;
            // It hits this ball from the air: find where it comes down.
            std::size_t down = k;
            while (down + 1 < segments.size() && segments[down].state == MotionState::kAirborne) ++down;
            if (dot(apart(ball, segments[down].start), way) > 0.0) return true;
        }
    }
    return false;
}

std::vector<Lying> Facts::lying(double cue_gap, double gap, const std::vector<std::string>& left_out) const {
    std::vector<Lying> balls;
    for (int i = 0; i < static_cast<int>(record.tracks.size()); ++i) {
        if (shot.gone(i) || is_in(id(i), left_out)) continue;
        balls.push_back({rest(i), record.size(i).R, i == shot.struck ? cue_gap : gap});
    }
    return balls;
}

int Facts::objects_driven() const {
    const std::vector<int> driven = shot.driven_after(shot.first_time);
    return static_cast<int>(
        std::count_if(driven.begin(), driven.end(), [this](int b) { return b != shot.struck; }));
}

void Facts::add_placement_fouls(std::vector<Foul>& fouls) const {
    if (state.in_hand != InHand::kHeadString && state.in_hand != InHand::kD) return;
    if (!in_area(record.table, state.in_hand, planar(record.state_at(shot.struck, 0.0).position))) {
        fouls.push_back(Foul::kPlacedOutside);
        return;
    }
    if (shot.first_hits.empty()) return;
    const double string = head_string(record.table);
    const double first = record.state_at(shot.first_hits.front(), 0.0).position.y();
    if (is_behind_string(state, string, first) &&
        farthest(record, shot.struck, Vec2(0.0, 1.0), shot.first_time) <= string)
        fouls.push_back(Foul::kBehindHeadString);
}

void Facts::add_pool_fouls(std::vector<Foul>& fouls, const std::vector<std::string>& first,
                           bool need_cushion) const {
    if (shot.fell(shot.struck)) fouls.push_back(Foul::kCueBallPocketed);
    if (shot.left(shot.struck)) fouls.push_back(Foul::kCueBallOff);
    if (need_cushion && shot.first_hits.empty())
        fouls.push_back(Foul::kNoBallHit);
    else if (!shot.first_hits.empty() && !first_is_one_of(first))
        fouls.push_back(Foul::kWrongBallFirst);
    if (need_cushion && !shot.first_hits.empty() && shot.driven_after(shot.first_time).empty())
        fouls.push_back(Foul::kNoCushion);
    if (objects_off() > 0) fouls.push_back(Foul::kBallOff);
    add_placement_fouls(fouls);
}

}  // namespace carom::games::detail

namespace carom::games {
namespace {

constexpr FoulRule kOfPool[] = {{Foul::kCueBallPocketed, "WPA 6.1"}, {Foul::kCueBallOff, "WPA 6.1"},
                                {Foul::kNoBallHit, "WPA 6.3"},       {Foul::kWrongBallFirst, "WPA 6.2"},
                                {Foul::kNoCushion, "WPA 6.3"},       {Foul::kBallOff, "WPA 6.5"},
                                {Foul::kPlacedOutside, "WPA 6.10"},  {Foul::kBehindHeadString, "WPA 6.11"},
                                {Foul::kThirdFoul, "WPA 6.14"},      {Foul::kJumpShot, "option jump"}};

}  // namespace

const std::span<const FoulRule> kPoolFouls = kOfPool;

}  // namespace carom::games
