// From a verdict to the next shot.
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/printable.h"
#include "carom/games/rules.h"
#include "carom/games/shot.h"
#include "facts.h"

namespace carom::games {
namespace {

/// The ball of an option, or -1 for one that is racked anew. @throws std::invalid_argument if the record has
/// none: the option belongs to another record
int ball_of(const Record& record, const Option& option, const std::string& id) {
    const int index = index_of(record, id);
    const bool anew = option.decision == Decision::kRackFourteen && detail::is_in(id, option.respots);
    if (index < 0 && !anew)
        throw std::invalid_argument("the record has no ball " + in_quotes(id) +
                                    "; give the record that was judged");
    return index;
}

double radius_of(const Record& record, const Option& option, const std::string& id) {
    const int index = ball_of(record, option, id);
    return index < 0 ? record.balls.R : record.size(index).R;
}

/// Puts a ball of the previous shot back on the cloth.
BallStart placed(const BallStart& before, double R, const Vec2& place) {
    BallStart ball = before;
    ball.position = {place.x(), place.y(), R};
    ball.velocity = ball.spin = Vec3::Zero();
    ball.height = 0.0;
    ball.where = {};
    return ball;
}

/// Whether the cue ball must move: it is gone, or another ball is spotted in its place.
bool must_place(const Record& record, const Option& option, const std::string& cue) {
    if (detail::is_in(cue, option.respots)) return false;
    const bool any = option.state.game->struck == GameRules::Struck::kAny;
    const int index =
        any && option.state.in_hand == InHand::kNo ? index_of(record, cue) : ball_of(record, option, cue);
    const BallState end = index < 0 ? BallState{} : record.state_at(index, record.duration);
    if (index < 0 || is_gone(end.state)) return !any || option.state.in_hand != InHand::kNo;
    return std::any_of(option.respots.begin(), option.respots.end(), [&](const Respot& back) {
        const Lying there = {back.place, radius_of(record, option, back.ball), 0.0};
        return option.state.in_hand != InHand::kNo &&
               !is_free(planar(end.position), record.size(index).R, std::span(&there, 1));
    });
}

void check_record(const Record& record, const Option& option) {
    if (!option.record.empty() && option.record != record.hash())
        throw std::invalid_argument("the verdict belongs to another record; give the record that was judged");
}

/// may_place() without the check of the record.
bool is_allowed(const Record& record, const Option& option, const Vec2& place) {
    const std::string cue = cue_ball(option.state);
    const int index = ball_of(record, option, cue);
    for (const Respot& back : option.respots) ball_of(record, option, back.ball);
    if (!in_area(record.table, option.state.in_hand, place)) return false;
    const double R = record.size(index).R;
    const Vec2 from = place - record.table.corner;
    if (from.x() < R || from.y() < R || from.x() > record.table.width - R ||
        from.y() > record.table.length - R)
        return false;
    std::vector<Lying> others;
    for (int ball = 0; ball < static_cast<int>(record.tracks.size()); ++ball) {
        const std::string& id = record.tracks[static_cast<std::size_t>(ball)].id;
        const BallState end = record.state_at(ball, record.duration);
        if (ball != index && !is_gone(end.state) && !detail::is_in(id, option.respots))
            others.push_back({planar(end.position), record.size(ball).R, 0.0});
    }
    for (const Respot& back : option.respots)
        others.push_back({back.place, radius_of(record, option, back.ball), 0.0});
    return is_free(place, R, others);
}

}  // namespace

const char* cue_ball(const State& state) {
    const bool own = state.game->struck == GameRules::Struck::kOwn;
    return own ? detail::own_ball(state.turn) : "cue";
}

std::string struck_next(const State& state, std::span<const std::string> balls) {
    const std::vector<std::string> may = legal(state, balls).cue_balls;
    return detail::is_in(cue_ball(state), may) ? cue_ball(state) : may.front();
}

bool may_place(const Record& record, const Option& option, const Vec2& place) {
    check_record(record, option);
    return is_allowed(record, option, place);
}

Vec2 free_place(const Record& record, const Option& option, const std::optional<Vec2>& wanted) {
    check_record(record, option);
    const Vec2 from = wanted.value_or(head_spot(record.table));
    const double step = radius_of(record, option, cue_ball(option.state)) / 4.0;
    // Rings of a lattice: whole numbers, whose distances have the same order on every processor.
    for (int ring = 0; ring * step <= record.table.width + record.table.length; ++ring) {
        std::vector<std::array<int, 3>> places;  // square of the distance, x, y
        for (int x = -ring; x <= ring; ++x)
            for (int y = -ring; y <= ring; ++y)
                if (const int far = x * x + y * y;
                    far <= ring * ring && (ring == 0 || far > (ring - 1) * (ring - 1)))
                    places.push_back({far, x, y});
        std::sort(places.begin(), places.end());
        for (const auto& [far, x, y] : places)
            if (Vec2 place = from + step * Vec2(x, y); is_allowed(record, option, place)) return place;
    }
    throw std::invalid_argument("there is no free place for the cue ball");
}

Scene table_after(const Scene& scene, const Record& record, const Option& option,
                  const std::optional<Vec2>& place) {
    check_record(record, option);
    if (option.rerack())
        throw std::invalid_argument("the balls are racked again; use the scene of a new break");
    if (option.state.over) throw std::invalid_argument("the game is over; there is no next shot");
    const std::string cue = cue_ball(option.state);
    for (const Respot& back : option.respots) ball_of(record, option, back.ball);
    if (!place && must_place(record, option, cue))
        throw std::invalid_argument("the cue ball is in hand; give its place");
    if (place && !is_allowed(record, option, *place))
        throw std::invalid_argument(std::string("the cue ball may not be placed there (in hand: ") +
                                    name(option.state.in_hand) + "), or the place is not free");
    const Scene rest = scene_after(scene, record);
    Scene next = rest;
    next.ball.clear();
    // In the order of the record.
    for (const BallStart& start : scene.ball) {
        const double R = scene.size_of(start).R;
        const auto back = std::find_if(option.respots.begin(), option.respots.end(),
                                       [&](const Respot& r) { return r.ball == start.id; });
        const int there = index_of(rest.ball, start.id);
        if (place && start.id == cue)
            next.ball.push_back(placed(start, R, *place));
        else if (back != option.respots.end())
            next.ball.push_back(placed(start, R, back->place));
        else if (there >= 0)
            next.ball.push_back(rest.ball[there]);
    }
    for (const Respot& back : option.respots) {
        if (option.decision != Decision::kRackFourteen || index_of(scene.ball, back.ball) >= 0) continue;
        BallStart ball;
        ball.id = back.ball;
        next.ball.push_back(placed(ball, scene.balls.R, back.place));
    }
    return next;
}

Scene next_scene(const Scene& scene, const Record& record, const Option& option, const Cue& cue,
                 const std::optional<Vec2>& place) {
    Scene next = table_after(scene, record, option, place);
    next.cue = cue;
    validate(next);
    return next;
}

}  // namespace carom::games
