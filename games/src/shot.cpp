#include "carom/games/shot.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/frozen.h"
#include "carom/engine/tolerances.h"

namespace carom::games {
namespace {

/// The balls that `ball` hits in an event of balls: those nearest to it.
std::vector<int> met_in(const Record& record, const Event& event, int ball) {
    if (event.a == ball) return {event.b};
    if (event.b == ball) return {event.a};
    if (event.type != EventType::kBallCluster) return {};
    const std::vector<int>& members = record.clusters[static_cast<std::size_t>(event.detail)];
    if (std::find(members.begin(), members.end(), ball) == members.end()) return {};
    const Vec3 here = record.state_at(ball, event.time).position;
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const int other : members) {
        const double gap = (record.state_at(other, event.time).position - here).norm();
        if (other == ball || gap >= least) continue;
        least = gap;
        best = other;
    }
    return {best};
}

/// The members of a cluster that `ball` touches at its start, except the first one.
void add_simultaneous(const Record& record, const Event& event, int ball, std::vector<int>& met) {
    if (event.type != EventType::kBallCluster || met.empty()) return;
    const Vec3 here = record.state_at(ball, event.time).position;
    for (const int other : record.clusters[static_cast<std::size_t>(event.detail)]) {
        if (other == ball || std::find(met.begin(), met.end(), other) != met.end()) continue;
        const double gap = (record.state_at(other, event.time).position - here).norm() - record.size(ball).R -
                           record.size(other).R;
        if (gap <= kTouchTolerance) met.push_back(other);
    }
}

}  // namespace

bool Shot::fell(int ball) const {
    return std::any_of(pocketed.begin(), pocketed.end(), [ball](const Fallen& f) { return f.ball == ball; });
}

bool Shot::left(int ball) const {
    return std::find(out.begin(), out.end(), ball) != out.end();
}

std::vector<int> Shot::driven_after(double time) const {
    std::vector<int> balls = out;
    for (const Fallen& f : pocketed) balls.push_back(f.ball);
    for (const Touch& t : touches)
        if (t.cushion() && t.driven && t.time >= time) balls.push_back(t.ball);
    std::sort(balls.begin(), balls.end());
    balls.erase(std::unique(balls.begin(), balls.end()), balls.end());
    return balls;
}

double farthest(const Record& record, int ball, const Vec2& along, double time) {
    return carom::farthest(record.tracks[static_cast<std::size_t>(ball)].segments, along,
                           std::min(time, record.duration));
}

Shot shot_of(const Record& record) {
    if (record.stopped != StopReason::kAtRest)
        throw std::invalid_argument(std::string("the shot ended by its ") + name(record.stopped) +
                                    ", before its balls were at rest; rules judge whole shots");
    Shot shot;
    for (const Event& event : record.events) {
        const EventKind& of = kind(event.type);
        if (of.phase == EventPhase::kStrike) shot.struck = event.a;
        if (event.type == EventType::kBallPocket) shot.pocketed.push_back({event.a, event.b});
        if (event.type == EventType::kBallOut) shot.out.push_back(event.a);
        if (of.phase != EventPhase::kImpact && of.phase != EventPhase::kHold) continue;
        if (of.partner == Partner::kCushion || of.partner == Partner::kJaw)
            shot.touches.push_back(
                {event.time, event.a, -1,
                 !still_frozen(record.table, event, record.tracks[static_cast<std::size_t>(event.a)].segments,
                               record.size(event.a).R)});
        if (of.partner != Partner::kBall || shot.struck < 0) continue;
        std::vector<int> met = met_in(record, event, shot.struck);
        add_simultaneous(record, event, shot.struck, met);
        for (const int other : met) {
            if (shot.first_hits.empty()) shot.first_time = event.time;
            const bool again =
                std::find(shot.first_hits.begin(), shot.first_hits.end(), other) != shot.first_hits.end();
            if (event.time == shot.first_time && !again) shot.first_hits.push_back(other);
            shot.touches.push_back({event.time, shot.struck, other});
        }
    }
    if (shot.struck < 0)
        throw std::invalid_argument("no cue strikes a ball in this record; rules judge strokes");
    return shot;
}

}  // namespace carom::games
