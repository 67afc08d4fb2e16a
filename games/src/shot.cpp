#include "carom/games/shot.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/frozen.h"

namespace carom::games {

bool Shot::fell(int ball) const {
    return std::any_of(pocketed.begin(), pocketed.end(), [ball](const Fallen& f) { return f.ball == ball; });
}

bool Shot::left(int ball) const {
    return std::find(out.begin(), out.end(), ball) != out.end();
}

std::vector<int> Shot::driven_after(double time) const {
    std::vector<int> balls = out;
    for (const Fallen& f : pocketed) balls.push_back(f.ball);
    for (const BallContact& t : touches)
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
        each_hit(event, record.hits(event), [&](const Hit& hit) {
            if (hit.partner == Partner::kCushion || hit.partner == Partner::kJaw) {
                const std::vector<Segment>& segments =
                    record.tracks[static_cast<std::size_t>(hit.a)].segments;
                shot.touches.push_back(
                    {hit.time, hit.a, -1, !still_frozen(record.table, hit, segments, record.size(hit.a).R)});
            }
            if (hit.partner != Partner::kBall || shot.struck < 0) return;
            if (hit.a != shot.struck && hit.b != shot.struck) return;
            const int other = hit.a == shot.struck ? hit.b : hit.a;
            if (shot.first_hits.empty()) shot.first_time = hit.time;
            const bool again =
                std::find(shot.first_hits.begin(), shot.first_hits.end(), other) != shot.first_hits.end();
            if (hit.time == shot.first_time && !again) shot.first_hits.push_back(other);
            shot.touches.push_back({hit.time, shot.struck, other});
        });
    }
    if (shot.struck < 0)
        throw std::invalid_argument("no cue strikes a ball in this record; rules judge strokes");
    return shot;
}

}  // namespace carom::games
