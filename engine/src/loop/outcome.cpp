// The outcome of a run without a record.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/record_hash.h"
#include "carom/engine/frozen.h"
#include "loop/log.h"
#include "physics/motion.h"

namespace carom {

int struck_ball(const Scene& scene) {
    for (std::size_t i = 0; i < scene.ball.size(); ++i) {
        const BallStart& ball = scene.ball[i];
        const bool moves =
            scene.cue ? ball.id == scene.cue->ball : !ball.velocity.isZero(0.0) || !ball.spin.isZero(0.0);
        if (moves) return static_cast<int>(i);
    }
    return -1;
}

/// Whether the struck ball was driven to the cushion or jaw that it hits.
bool Log::is_driven(const Hit& hit) {
    if (of_struck_.empty())
        for (const BallSegment& s : segments_)
            if (s.ball == struck_) of_struck_.push_back(s.segment);
    return !still_frozen(plan_.scene.table, hit, of_struck_, balls_.radius(struck_));
}

std::span<const Hit> Log::hits(const Event& event) const {
    if (event.type != EventType::kBallCluster) return {};
    const auto index = static_cast<std::size_t>(event.detail);
    const std::size_t begin = index == 0 ? 0 : cluster_end_[index - 1].hit;
    return std::span(hits_).subspan(begin, cluster_end_[index].hit - begin);
}

std::uint64_t Log::hash() const {
    RecordHash hash;
    for (int ball = 0; ball < balls_.count(); ++ball) {
        const auto segments = std::count_if(segments_.begin(), segments_.end(),
                                            [ball](const BallSegment& s) { return s.ball == ball; });
        hash.ball(static_cast<std::size_t>(segments) + balls_.collides(ball));
        for (const BallSegment& s : segments_)
            if (s.ball == ball) hash.segment(s.segment);
        if (balls_.collides(ball)) hash.segment(balls_.afterwards(ball));
    }
    for (const Event& e : events_) hash.event(e);
    hash.duration(balls_.now());
    return hash.value();
}

void Log::outcome(StopReason why, Outcome& out) {
    of_struck_.clear();
    out.stopped = why;
    out.duration = balls_.now();
    out.events = static_cast<std::int64_t>(events_.size());
    out.clusters = static_cast<int>(cluster_end_.size());
    out.struck = struck_;
    out.first_hit = -1;
    out.contacts = out.approach_cushions = 0;
    out.hash = keep_ != Keep::kOutcome && options_.hash ? hash() : 0;
    out.balls.assign(static_cast<std::size_t>(balls_.count()), {});
    for (int i = 0; i < balls_.count(); ++i) {
        const Segment& s = balls_.segment(i);
        out.balls[i].position =
            placed_at(s, std::min(balls_.now() - s.start, s.duration), plan_.gravity, balls_.radius(i))
                .position;
    }
    int fallen = 0;
    for (const Event& e : events_) {
        each_hit(e, hits(e), [&](const Hit& hit) {
            if (hit.partner == Partner::kCushion || hit.partner == Partner::kJaw) {
                ++out.balls[hit.a].cushions;
                if (hit.a == struck_ && out.contacts < 2 && is_driven(hit)) ++out.approach_cushions;
            }
            if (hit.partner != Partner::kBall || struck_ < 0 || (hit.a != struck_ && hit.b != struck_))
                return;
            const int met = hit.a == struck_ ? hit.b : hit.a;
            if (out.balls[met].met) return;
            out.balls[met].met = true;
            if (out.contacts++ == 0) out.first_hit = met;
        });
        BallOutcome& ball = out.balls[e.a];
        if (e.type == EventType::kBallOut) ball.pocket = kOffTable;
        if (e.type != EventType::kBallPocket) continue;
        ball.pocket = e.b;
        ball.fell = fallen++;
    }
}

}  // namespace carom
