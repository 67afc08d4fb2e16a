// The candidates of the search: direct pots, and trial shots in all directions.
#include "player/search.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/math.h"
#include "carom/engine/strike.h"
#include "carom/games/aim.h"
#include "carom/games/judge_many.h"
#include "carom/games/shot.h"
#include "facts.h"
#include "lines.h"
#include "player/description.h"

namespace carom::games::detail {
namespace {

/// The attempts. Speeds of the cue [m/s], heights and sides in ball radii.
struct Grid {
    std::array<double, 5> speeds;
    int speed_count;
    std::array<double, 3> heights;
    std::array<double, 3> sides;
    int side_count;
    std::size_t pots;  ///< the surest
    int hits, around;  ///< aims at each ball, and in all directions, played once
};
constexpr Grid kWhole = {{0.8, 1.2, 1.8, 2.7, 4.0}, 5, {0.0, -0.4, 0.4}, {0.0, -0.3, 0.3}, 3, 14, 31, 90};
constexpr Grid kQuick = {{1.0, 1.8, 3.2}, 3, {0.0, -0.35, 0.35}, {0.0}, 1, 8, 15, 60};
/// For each place of a cue ball in hand.
constexpr Grid kInHand = {{1.0, 1.6, 2.4, 3.6}, 4, {0.0, -0.35, 0.35}, {0.0}, 1, 1, 0, 0};
constexpr std::array kSweepSpeeds{0.7, 1.2, 2.0, 3.5};
/// [-] The thinnest hits tried, as a fraction of the ball's width.
constexpr double kThinnestHit = 0.97;
/// [-] Numbers of safeties and push outs that are rated.
constexpr std::size_t kSafeties = 24, kPushOuts = 8;
/// [degrees] With a steeper cue, a ball may rebound from the cloth into the tip, which is not simulated.
constexpr double kMostElevation = 30.0;
/// [-] Least estimated chance of a pot to try it.
constexpr double kLeastChance = 0.04;
/// [-] How often an aim is played and corrected.
constexpr int kCorrections = 2;
/// [-] Number of places tried for a cue ball in hand; distances from the ghost ball [m], and angles
/// [degrees].
constexpr std::size_t kPlaces = 40;
constexpr std::array kDistances{0.15, 0.3, 0.55};
constexpr std::array kAngles{0.0, -14.0, 14.0, -30.0, 30.0, -50.0, 50.0};
/// [m] Distance of a cue ball in hand from balls whose places are not known exactly.
constexpr double kClear = 4e-3;
/// [-] A person foresees at most this many contacts until a ball falls: a bank by three rails, or a kick
/// whose ball meets two. Pots by more are flukes.
constexpr std::size_t kMostContacts = 4;
const Call kPush = [] {
    Call call;
    call.push_out = true;
    return call;
}();

Vec2 direction(double deg) {
    const auto [sin, cos] = sin_cos_deg(deg);
    return {cos, sin};
}

/// The turn to the left from one direction to another [degrees].
double turn_deg(const Vec2& from, const Vec2& to) {
    return direction_deg({dot(from, to), cross(from, to)});
}

/// Drops strikes that are too steep. If all are, the cue is lowered.
void level_off(std::vector<Attempt>& candidates) {
    const auto steep = [](const Attempt& candidate) { return candidate.cue.elevation_deg > kMostElevation; };
    if (!std::all_of(candidates.begin(), candidates.end(), steep)) std::erase_if(candidates, steep);
    for (Attempt& candidate : candidates)
        candidate.cue.elevation_deg = std::min(candidate.cue.elevation_deg, kMostElevation);
}

}  // namespace

struct Search::Line {
    Attempt candidate;
    Vec2 ghost, towards;
    double aim_per_turn;  ///< turn of the aim for each degree by which the object ball turns [-]
    bool hits;            ///< whether it hit the ball first when last played
};

void Search::lift(Attempt& candidate) const {
    Scene scene = scene_;
    scene.ball[cue_ball_].position.head<2>() = candidate.place;
    const CueRoom room = room_for(scene, candidate.cue);
    if (room.clears_deg) candidate.cue.elevation_deg = *room.clears_deg;
}

void Search::correct(std::vector<Line>& lines) const {
    for (int k = 0; k < kCorrections; ++k) {
        std::vector<Cue> cues;
        std::vector<Vec2> places;
        for (Line& line : lines) {
            line.hits = false;
            cues.push_back(line.candidate.cue);
            places.push_back(line.candidate.place);
        }
        play(cues, places, [&](std::size_t i, const Record& record) {
            Line& line = lines[i];
            const Shot shot = shot_of(record);
            const int ball = index_of(record, std::to_string(line.candidate.ball));
            if (!missed(record, shot, ball).empty()) {
                // Squirt makes the cue ball miss the ball: the aim moves back by the same amount.
                const Vec2 way = line.ghost - line.candidate.place,
                           went = planar(record.state_at(shot.struck, 0.0).velocity);
                line.candidate.cue.aim_deg -= turn_deg(way, went);
                return;
            }
            const Event* stop = next_stop(record, ball, shot.first_time);
            const auto off = off_line(record, ball, shot.first_time, stop, line.towards);
            line.hits = off.has_value();
            if (off) line.candidate.cue.aim_deg += line.aim_per_turn * *off * kDegrees;
        });
    }
}

std::vector<Attempt> Search::pots(std::span<const Vec2> places) const {
    const Grid& grid = in_hand_ ? kInHand : skill_.look == Look::kWhole ? kWhole : kQuick;
    std::vector<Line> lines;
    for (const Vec2& place : places) {
        Lie lie = lie_;
        lie.cue = place;
        std::vector<Pot> pots = potting_.pots(lie, targets_ & first_, kLeastChance);
        std::stable_sort(pots.begin(), pots.end(),
                         [](const Pot& a, const Pot& b) { return a.chance > b.chance; });
        if (pots.size() > grid.pots) pots.resize(grid.pots);
        for (const Pot& pot : pots) {
            Attempt candidate;
            candidate.place = place;
            candidate.ball = pot.ball;
            candidate.pocket = pot.pocket;
            candidate.cut_deg = turn_deg(pot.ghost - place, pot.towards);
            if (calls_)
                candidate.call = {.ball = std::to_string(pot.ball),
                                  .pocket = scene_.table.pockets[static_cast<std::size_t>(pot.pocket)].id};
            candidate.cue = *scene_.cue;
            candidate.cue.aim_deg = direction_deg(pot.ghost - place);
            const double per = potting_.both() * pot.straight / pot.distance;
            for (const double height : grid.heights) {
                for (int s = 0; s < grid.side_count; ++s) {
                    candidate.cue.height = height;
                    candidate.cue.side = grid.sides[static_cast<std::size_t>(s)];
                    candidate.cue.elevation_deg = 0.0;
                    lift(candidate);
                    for (int v = 0; v < grid.speed_count; ++v) {
                        candidate.cue.speed = grid.speeds[static_cast<std::size_t>(v)];
                        lines.push_back({candidate, pot.ghost, pot.towards, per, false});
                    }
                }
            }
        }
    }
    correct(lines);
    std::vector<Attempt> candidates;
    for (Line& line : lines)
        if (line.hits) candidates.push_back(std::move(line.candidate));
    return candidates;
}

std::vector<Attempt> Search::sweep(const Vec2& place) const {
    const Grid& grid = skill_.look == Look::kWhole ? kWhole : kQuick;
    std::vector<Attempt> tried;
    const auto add = [&](double aim_deg, std::span<const double> speeds) {
        Attempt candidate;
        candidate.cue = *scene_.cue;
        candidate.cue.aim_deg = aim_deg;
        candidate.cue.side = candidate.cue.height = candidate.cue.elevation_deg = 0.0;
        candidate.place = place;
        lift(candidate);
        for (const double speed : speeds) {
            candidate.cue.speed = speed;
            tried.push_back(candidate);
        }
    };
    for (const Lie::Ball& ball : lie_.balls) {
        if ((first_ & only(ball.number)) == 0) continue;
        const Vec2 way = ball.place - place;
        for (int k = 0; k < grid.hits; ++k) {
            const double hit = kThinnestHit * (2.0 * k / (grid.hits - 1) - 1.0);
            add(hit_aim_deg(way, potting_.both(), hit), kSweepSpeeds);
        }
    }
    for (int k = 0; k < grid.around; ++k)
        add(360.0 * k / grid.around + 0.37, std::span(kSweepSpeeds).subspan(1));
    level_off(tried);
    std::vector<Cue> cues;
    cues.reserve(tried.size());
    for (const Attempt& candidate : tried) cues.push_back(candidate.cue);
    std::vector<Result> results(tried.size()), pushed(tried.size());
    play(cues, std::vector<Vec2>(tried.size(), place), [&](std::size_t i, const Record& record) {
        Attempt& candidate = tried[i];
        candidate.call = lucky_call(state_, record);
        candidate.call.safety = calls_ && candidate.call.ball.empty();
        results[i] = result(record, candidate.call);
        candidate.kind = ShotKind::kSafety;
        if (results[i].made) {
            const Shot shot = shot_of(record);
            for (const Shot::Fallen& fallen : shot.pocketed) {
                const std::string& id = record.tracks[static_cast<std::size_t>(fallen.ball)].id;
                if (fallen.ball == shot.struck || (calls_ && id != candidate.call.ball)) continue;
                if (chain_of(record, fallen.ball).size() > kMostContacts) {
                    results[i].made = false;
                    results[i].worth = -1.0;
                    break;
                }
                candidate.kind = kind_of(record, shot, fallen);
                candidate.ball = number_of(id);
                candidate.pocket = fallen.pocket;
                const auto at = [&](int which) {
                    return planar(record.state_at(which, shot.first_time).position);
                };
                candidate.cut_deg = turn_deg(at(shot.struck) - place, at(fallen.ball) - at(shot.struck));
                break;
            }
        }
        if (state_.may_push_out) pushed[i] = result(record, kPush);
    });
    // Every shot that pots a ball is a candidate, and so are the best of the others, rated by the position
    // that they leave. Fouls are among these, so that there is always a candidate.
    std::vector<std::size_t> made, others, pushes;
    for (std::size_t i = 0; i < tried.size(); ++i) (results[i].made ? made : others).push_back(i);
    const auto top = [](std::vector<std::size_t>& list, const std::vector<Result>& by, std::size_t most) {
        std::stable_sort(list.begin(), list.end(),
                         [&](std::size_t a, std::size_t b) { return by[a].worth > by[b].worth; });
        if (list.size() > most) list.resize(most);
    };
    if (state_.may_push_out)
        for (std::size_t i = 0; i < tried.size(); ++i) pushes.push_back(i);
    top(others, results, kSafeties);
    top(pushes, pushed, kPushOuts);
    std::vector<Attempt> candidates;
    for (const auto* list : {&made, &others})
        for (const std::size_t i : *list) candidates.push_back(tried[i]);
    for (const std::size_t i : pushes) {
        Attempt push = tried[i];
        push.call = kPush;
        push.kind = ShotKind::kPushOut;
        push.ball = 0;
        push.pocket = -1;
        candidates.push_back(std::move(push));
    }
    return candidates;
}

bool Search::may_lie(const Vec2& place) const {
    if (!in_area(scene_.table, state_.in_hand, place) || !potting_.inside(place)) return false;
    // No shot is played from a place that touches a ball.
    return std::all_of(lie_.balls.begin(), lie_.balls.end(), [&](const Lie::Ball& ball) {
        return length(ball.place - place) > potting_.both() + kClear;
    });
}

std::vector<Vec2> Search::places() const {
    struct Place {
        Vec2 at;
        double chance;
    };
    std::vector<Place> found;
    for (const Lie::Ball& ball : lie_.balls) {
        if ((targets_ & first_ & only(ball.number)) == 0) continue;
        for (const PocketLine& line : pocket_lines(scene_, std::to_string(ball.number), scene_.cue->ball)) {
            if (!line.open()) continue;
            const Vec2 ghost = ghost_ball(ball.place, line.towards, potting_.both());
            for (const double angle : kAngles) {
                const Vec2 way = direction(direction_deg(line.towards) + angle);
                // As near as the head string allows.
                const double behind = (ghost.y() - head_string(scene_.table) + kClear) / way.y();
                for (double distance : {kDistances[0], kDistances[1], kDistances[2], behind}) {
                    const Vec2 at = ghost - distance * way;
                    if (!may_lie(at)) continue;
                    Lie lie = lie_;
                    lie.cue = at;
                    double best = 0.0;
                    for (const Pot& pot : potting_.pots(lie, targets_ & first_, kLeastChance))
                        best = std::max(best, pot.chance);
                    if (best > 0.0) found.push_back({at, best});
                }
            }
        }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Place& a, const Place& b) { return a.chance > b.chance; });
    // Keep every third of the surest: neighbours are similar.
    const std::size_t step = found.size() > 3 * kPlaces ? 3 : 1;
    std::vector<Vec2> places;
    for (std::size_t i = 0; i < found.size() && places.size() < kPlaces; i += step)
        places.push_back(found[i].at);
    return places;
}

std::vector<Attempt> Search::candidates() const {
    std::vector<Vec2> from = {planar(scene_.ball[cue_ball_].position)};
    if (in_hand_) {
        if (const std::vector<Vec2> good = places(); !good.empty()) from = good;
    }
    std::vector<Attempt> candidates = pots(from);
    if (!in_hand_ || candidates.empty()) {
        for (Attempt& candidate : sweep(from.front())) candidates.push_back(std::move(candidate));
    }
    level_off(candidates);
    return candidates;
}

}  // namespace carom::games::detail
