#include "loop/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace carom {

namespace {

// [-] Initial capacity for segments and events: enough for a break. It doubles when it is exceeded.
constexpr std::size_t kRoom = 256;

}  // namespace

Log::Log(const Plan& plan, const SimulateOptions& options, Balls& balls)
    : options_(options),
      balls_(balls),
      geometry_(plan.geometry),
      has_clusters_(plan.clusters != ClusterModel::kSequential) {
    const Scene& scene = plan.scene;
    record_.table = scene.table;
    record_.balls = plan.balls;
    record_.gravity = plan.gravity;
    record_.render = scene.render;
    record_.start_time = options.start_time;
    record_.tracks.reserve(scene.ball.size());
    for (const BallStart& ball : scene.ball) {
        BallTrack track;
        track.id = ball.id;
        track.own = ball.own;
        record_.tracks.push_back(std::move(track));
    }
    if (options.profile) costs_.emplace();
    touched_.reserve(scene.ball.size() + 1);
    reserve();
}

void Log::reserve() {
    segments_.reserve(static_cast<std::size_t>(balls_.count()) + kRoom);
    if (has_clusters_) {
        cluster_ball_.reserve(kRoom);
        cluster_end_.reserve(kRoom);
    }
    record_.events.reserve(record_.events.size() + kRoom);
}

void Log::resume(const Record& so_far) {
    record_ = so_far;
    record_.costs.clear();
    record_.start_time = options_.start_time;
    for (std::size_t i = 0; i < record_.tracks.size(); ++i)
        balls_.set(static_cast<int>(i), record_.tracks[i].segments.back());
    balls_.advance_to(record_.duration);
    reserve();
}

void Log::cluster(int a, int b, const std::vector<ClusterBall>& balls) {
    event(EventType::kBallCluster, a, b, static_cast<int>(record_.clusters.size() + cluster_end_.size()));
    for (const ClusterBall& ball : balls) cluster_ball_.push_back(ball.ball);
    cluster_end_.push_back(cluster_ball_.size());
}

void Log::pocketed(int ball, int pocket) {
    record_.tracks[ball].pocket = pocket;
    event(EventType::kBallPocket, ball, pocket);
}

void Log::end_set_up(double set_up_ns) {
    if (!costs_) return;
    record_.costs.resize(record_.events.size());
    if (!record_.costs.empty() && record_.events.front().type == EventType::kCueStrike)
        record_.costs.front().method = "point";
    record_.setup_detect_ns = set_up_ns;
    *costs_ = {};
}

// An iteration can cause several events: the first one gets the cost. If it causes none, the next event gets it.
void Log::book_costs() {
    record_.costs.resize(record_.events.size());
    EventCost& cost = costs_->event;
    if (record_.events.size() > events_before_) {
        cost.queue_ns = cost.detect_ns - costs_->search_ns;
        record_.costs[events_before_] = cost;
        *costs_ = {};
    } else {
        cost.steps = 0;  // of an impact that caused no event
        cost.method = {};
    }
}

void Log::tell_progress() {
    if (++rounds_untold_ < options_.progress_rounds && !long_round_) return;
    rounds_untold_ = 0;
    long_round_ = false;
    options_.progress(record_.events.size(), balls_.now());
}

void Log::fail_crowded() const {
    if (is_crowded())
        fail(fmt::format("more than {} events within {:g} s of simulated time", kEventCap, kEventCapSpan));
    fail(fmt::format("{} rounds without an event", kQuietCap));
}

void Log::fail(const std::string& why) const {
    std::string text = fmt::format("simulation stopped at t = {:.17g} s after {} events: {}\n", balls_.now(),
                                   record_.events.size(), why);
    const std::size_t count = record_.events.size();
    text += "last events:\n";
    for (std::size_t i = count > 8 ? count - 8 : 0; i < count; ++i) {
        const Event& e = record_.events[i];
        text += fmt::format("  {:.17g} {} {} {}\n", e.time, name(e.type), id(e.a), record_.partner_id(e));
    }
    text += "balls that move (id state x y vx vy wx wy wz):\n";
    for (int i = 0; i < balls_.count(); ++i) {
        const Segment& s = balls_.segment(i);
        if (s.state == MotionState::kStationary || s.state == MotionState::kPocketed) continue;
        const double tau = std::max(0.0, balls_.now() - s.start);
        const Vec3 r = position_at(s, tau), v = velocity_at(s, tau), w = spin_at(s, tau, balls_.radius(i));
        text += fmt::format("  {} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", id(i),
                            name(s.state), r.x(), r.y(), v.x(), v.y(), w.x(), w.y(), w.z());
    }
    text.pop_back();  // a message has no final line break
    throw SimulationError(text);
}

Record Log::finish(StopReason why) {
    std::vector<std::size_t> count(record_.tracks.size());
    for (std::size_t i = 0; i < count.size(); ++i) count[i] = record_.tracks[i].segments.size();
    for (const BallSegment& s : segments_) ++count[s.ball];
    for (std::size_t i = 0; i < count.size(); ++i) record_.tracks[i].segments.reserve(count[i]);
    for (const BallSegment& s : segments_) record_.tracks[s.ball].segments.push_back(s.segment);
    auto begin = cluster_ball_.begin();
    for (const std::size_t end : cluster_end_) {
        const auto to = cluster_ball_.begin() + static_cast<std::ptrdiff_t>(end);
        record_.clusters.emplace_back(begin, to);
        begin = to;
    }
    record_.duration = balls_.now();
    record_.stopped = why;
    return std::move(record_);
}

}  // namespace carom
