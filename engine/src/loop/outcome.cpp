// The outcome of a run without a record.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "base/record_hash.h"
#include "carom/engine/frozen.h"
#include "loop/log.h"
#include "physics/motion.h"

namespace carom {

namespace {

/// The member of a cluster nearest to this ball; -1 if the ball is not in it.
int nearest(std::span<const ClusterBall> cluster, int ball) {
    const auto self =
        std::find_if(cluster.begin(), cluster.end(), [ball](const ClusterBall& b) { return b.ball == ball; });
    if (self == cluster.end()) return -1;
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const ClusterBall& other : cluster) {
        const double distance = other.ball == ball ? least : (other.r - self->r).norm();
        if (distance >= least) continue;
        least = distance;
        best = other.ball;
    }
    return best;
}

}  // namespace

int struck_ball(const Scene& scene) {
    for (std::size_t i = 0; i < scene.ball.size(); ++i) {
        const BallStart& ball = scene.ball[i];
        const bool moves =
            scene.cue ? ball.id == scene.cue->ball : !ball.velocity.isZero(0.0) || !ball.spin.isZero(0.0);
        if (moves) return static_cast<int>(i);
    }
    return -1;
}

/// Whether the struck ball was driven to its partner in this event, a cushion or jaw.
bool Log::is_driven(const Event& event) {
    if (of_struck_.empty())
        for (const BallSegment& s : segments_)
            if (s.ball == struck_) of_struck_.push_back(s.segment);
    return !still_frozen(plan_.scene.table, event, of_struck_, balls_.radius(struck_));
}

// The ball that the struck ball touches in this event, or -1.
int Log::met_by(int struck, const Event& e) const {
    const bool cluster = e.type == EventType::kBallCluster;
    if (!cluster && e.type != EventType::kBallBall && e.type != EventType::kBallBallHold) return -1;
    if (e.a == struck || e.b == struck) return e.a == struck ? e.b : e.a;
    if (!cluster) return -1;
    const auto index = static_cast<std::size_t>(e.detail);
    const std::size_t begin = index == 0 ? 0 : cluster_end_[index - 1];
    return nearest(std::span(cluster_ball_).subspan(begin, cluster_end_[index] - begin), struck);
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
        BallOutcome& ball = out.balls[e.a];
        const EventKind& of = kind(e.type);
        const bool table = of.partner == Partner::kCushion || of.partner == Partner::kJaw;
        if (table && of.phase != EventPhase::kRelease) {
            ++ball.cushions;
            if (e.a == struck_ && out.contacts < 2 && is_driven(e)) ++out.approach_cushions;
        }
        const int met = out.struck < 0 || of.partner != Partner::kBall ? -1 : met_by(out.struck, e);
        if (met >= 0 && !out.balls[met].met) {
            out.balls[met].met = true;
            if (out.contacts++ == 0) out.first_hit = met;
        }
        if (e.type == EventType::kBallOut) ball.pocket = kOffTable;
        if (e.type != EventType::kBallPocket) continue;
        ball.pocket = e.b;
        ball.fell = fallen++;
    }
}

}  // namespace carom
