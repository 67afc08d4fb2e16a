// Measures of a shot by its route, and by the points that it scores.
#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carom/engine/frozen.h"
#include "carom/games/judge_many.h"
#include "facts.h"
#include "measure_rows.h"

namespace carom::games::detail {
namespace {

/// The struck ball's first contact with each ball that it hits, in order.
std::vector<BallContact> meetings(const PlayedShot& played) {
    std::vector<BallContact> met;
    for (const BallContact& touch : played.shot().touches) {
        const bool again = std::any_of(
            met.begin(), met.end(), [&](const BallContact& before) { return before.other == touch.other; });
        if (!touch.cushion() && !again) met.push_back(touch);
    }
    return met;
}

/// The cushions that the struck ball is driven to before a contact; all if there is none.
std::vector<Hit> cushions_before(const PlayedShot& played, const std::optional<BallContact>& meeting) {
    std::vector<Hit> hits = driven(played, played.struck());
    if (meeting) std::erase_if(hits, [&](const Hit& hit) { return hit.time >= meeting->time; });
    return hits;
}

/// The K-th ball that the struck ball hits, from 0.
std::optional<BallContact> meeting(const PlayedShot& played, std::size_t number) {
    const std::vector<BallContact> met = meetings(played);
    return number < met.size() ? std::optional(met[number]) : std::nullopt;
}

/// Number of cushions before a contact; NaN if there is none.
double count_before(const PlayedShot& played, const std::optional<BallContact>& meeting) {
    return meeting ? double(cushions_before(played, meeting).size()) : kNone;
}

std::string rail(const Cushion& cushion) {
    const std::size_t end = cushion.name.find(" rail");
    return end == std::string::npos ? cushion.id : cushion.name.substr(0, end);
}

Texts route(const PlayedShot& played) {
    Texts rails;
    const Record& record = played.record;
    const std::optional<BallContact> second = meeting(played, 1);
    for (const Hit& hit : cushions_before(played, second ? second : meeting(played, 0)))
        rails.push_back(hit.partner == Partner::kCushion
                            ? rail(record.table.cushions[static_cast<std::size_t>(hit.b)])
                            : record.partner_id(hit.partner, hit.b));
    return rails;
}

/// Whether a ball other than the struck one fell and passes the test.
template <class Test>
double any_fell(const PlayedShot& played, Test&& test) {
    const Shot& shot = played.shot();
    return double(std::any_of(shot.pocketed.begin(), shot.pocketed.end(), [&](const Shot::Fallen& fallen) {
        return fallen.ball != shot.struck && test(fallen);
    }));
}

using P = const PlayedShot&;
using A = const Arguments&;
using V = MeasureValue;

const MeasureRow kRouteRows[] = {
    {{"cushions_before", "BALL", "", "cushions before the struck ball hits this ball; empty if it does not"},
     [](P p, A of) -> V {
         for (const BallContact& touch : meetings(p))
             if (touch.other == of.ball) return count_before(p, touch);
         return kNone;
     }},
    {{"cushions_before_first", "", "", "cushions before the struck ball hits its first ball"},
     [](P p, A) -> V { return count_before(p, meeting(p, 0)); }},
    {{"cushions_between", "", "", "cushions between its first and its second ball"},
     [](P p, A) -> V { return count_before(p, meeting(p, 1)) - count_before(p, meeting(p, 0)); }},
    {{"route", "", "list", "rails before its second ball, or its only one, in order; all if it hits none"},
     [](P p, A) -> V { return route(p); }},
    {{"kick", "", "truth", "whether the struck ball is driven to a cushion before it hits a ball"},
     [](P p, A) -> V { return double(count_before(p, meeting(p, 0)) > 0.0); }},
    {{"bank", "", "truth", "whether a ball fell after it was driven to a rail far from the pocket"},
     [](P p, A) -> V {
         return any_fell(p, [&p](const Shot::Fallen& fallen) { return is_bank(p.record, p.shot(), fallen); });
     }},
    {{"combination", "", "truth", "whether a ball fell that the struck ball did not hit"},
     [](P p, A) -> V {
         const std::vector<BallContact> met = meetings(p);
         return any_fell(p, [&met](const Shot::Fallen& fallen) {
             return std::none_of(met.begin(), met.end(),
                                 [&](const BallContact& t) { return t.other == fallen.ball; });
         });
     }},
    {{"carom", "", "truth", "whether the struck ball hits two balls"},
     [](P p, A) -> V { return double(meeting(p, 1).has_value()); }},
    {{"point", "GAME", "truth",
      "whether the shot scores in the middle of a game, with every ball that falls called"},
     [](P p, A of) -> V { return double(judged(p, *of.game, false).points > 0); }},
    {{"points", "GAME", "", "points of the shot, negative if it loses some"},
     [](P p, A of) -> V { return double(judged(p, *of.game, false).points); }},
};

}  // namespace

std::span<const MeasureRow> route_rows() {
    return kRouteRows;
}

std::vector<Hit> driven(const PlayedShot& played, int ball) {
    std::vector<Hit> hits;
    if (ball < 0) return hits;
    const Record& record = played.record;
    const auto& segments = record.tracks[static_cast<std::size_t>(ball)].segments;
    for (const Event& event : record.events)
        each_hit(event, record.hits(event), [&](const Hit& hit) {
            const bool wall = hit.partner == Partner::kCushion || hit.partner == Partner::kJaw;
            if (wall && hit.a == ball && !still_frozen(record.table, hit, segments, record.size(ball).R))
                hits.push_back(hit);
        });
    return hits;
}

Verdict judged(const PlayedShot& played, Game game, bool opening) {
    State state = opening ? new_game(game) : state_of_turn(game, Group::kOpen);
    // In a carom game, the player whose ball is struck.
    if (game->struck == GameRules::Struck::kOwn && played.struck() >= 0 &&
        played.id(played.struck()) == own_ball(1))
        state.turn = 1;
    return judge(state, played.record, opening ? Call() : lucky_call(state, played.record));
}

Texts rails_of(const Table& table) {
    Texts rails;
    for (const Cushion& cushion : table.cushions) rails.push_back(rail(cushion));
    return rails;
}

}  // namespace carom::games::detail
