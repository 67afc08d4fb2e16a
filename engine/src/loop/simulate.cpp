// The event loop: next event -> advance its balls -> resolve -> record -> re-detect for those balls only.
#include "carom/engine/simulate.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "loop/shot.h"
#include "physics/cue.h"

namespace carom {

Shot::Shot(const Plan& plan, const SimulateOptions& options) : plan_(plan), options_(options) {}

void Shot::set_up(bool profile) {
    const Scene& scene = plan_.scene;
    record_.table = scene.table;
    record_.balls = plan_.balls;
    record_.gravity = plan_.gravity;
    record_.render = scene.render;
    balls_ = static_cast<int>(scene.ball.size());
    record_.tracks.reserve(scene.ball.size());
    current_.reserve(scene.ball.size());
    touched_.reserve(scene.ball.size() + 1);
    reserve_log();
    for (const BallStart& ball : scene.ball) {
        BallTrack track;
        track.id = ball.id;
        track.own = ball.own;
        record_.tracks.push_back(std::move(track));
        current_.emplace_back();
        const int index = static_cast<int>(current_.size()) - 1;
        begin(index, start_segment(0.0, ball.position, ball.velocity, ball.spin, motion_of(index)));
    }
    if (scene.cue) {
        for (int i = 0; i < balls_; ++i) {
            if (scene.ball[i].id != scene.cue->ball) continue;
            const StruckBall struck = strike(*scene.cue, plan_.sizes[i], plan_.in_force(Effect::kSquirt));
            begin(i, start_segment(0.0, now_of(i).r, struck.v, struck.w, motion_of(i)));
            record_.events.push_back({0.0, EventType::kCueStrike, i, -1, -1});
            if (profile) record_.costs.push_back({0.0, 0.0, 0.0, 0, "point"});
        }
    }
    first_candidates();
}

// The log starts with room for what a break takes, and doubles.
void Shot::reserve_log() {
    constexpr std::size_t kRoom = 256;
    const std::size_t segments = static_cast<std::size_t>(balls_) + kRoom;
    log_.reserve(segments);
    log_ball_.reserve(segments);
    log_member_.reserve(kRoom);
    log_cluster_.reserve(kRoom);
    record_.events.reserve(record_.events.size() + kRoom);
}

// All other memory of the loop is taken here.
void Shot::first_candidates() {
    const auto count = static_cast<std::size_t>(balls_);
    key_.assign(count, kNever);
    mover_.resize(count);
    changed_.reserve(count);
    touched_.reserve(count);
    queue_.set_up(balls_);
    ball_boxes_.set_up(plan_.pairs ? balls_ : 0, plan_.ball_search);
    set_up_table();
    touched_.clear();
    for (int i = 0; i < balls_; ++i) touched_.push_back(i);
    redetect();
    requeue();
}

void Shot::take_up(const Record& record) {
    record_ = record;
    record_.costs.clear();
    balls_ = static_cast<int>(record_.tracks.size());
    for (const BallTrack& track : record_.tracks) current_.push_back(track.segments.back());
    now_ = record_.duration;
    reserve_log();
    restore_held();
    first_candidates();
}

void Shot::finish() {
    std::vector<std::size_t> count(record_.tracks.size());
    for (std::size_t i = 0; i < count.size(); ++i) count[i] = record_.tracks[i].segments.size();
    for (const int ball : log_ball_) ++count[ball];
    for (std::size_t i = 0; i < count.size(); ++i) record_.tracks[i].segments.reserve(count[i]);
    for (std::size_t k = 0; k < log_.size(); ++k) record_.tracks[log_ball_[k]].segments.push_back(log_[k]);
    std::size_t begin = 0;
    for (const std::size_t end : log_cluster_) {
        record_.clusters.emplace_back(log_member_.begin() + static_cast<std::ptrdiff_t>(begin),
                                      log_member_.begin() + static_cast<std::ptrdiff_t>(end));
        begin = end;
    }
    record_.duration = now_;
}

// The next event comes after the stop, or never.
void Shot::end(double next, double stop) {
    const bool moves = std::any_of(current_.begin(), current_.end(), [](const Segment& s) {
        return s.state != MotionState::kStationary && s.state != MotionState::kPocketed;
    });
    if (next == kNever && !moves) {
        record_.stopped = StopReason::kAtRest;
    } else if (stop == kNever) {
        record_.stopped = StopReason::kEndless;
    } else {
        record_.stopped = StopReason::kTime;
        now_ = stop;
    }
}

void Shot::tell_progress() {
    if (++rounds_untold_ < options_.progress_rounds && !long_round_) return;
    rounds_untold_ = 0;
    long_round_ = false;
    options_.progress(record_.events.size(), now_);
}

// Kept a function of its own, so that tools/measure/profile_cost finds it by name.
template <bool kProfile>
[[gnu::noinline]] Record Shot::run(const Record* so_far) {
    const auto set_up_start = kProfile ? Clock::now() : Clock::time_point{};
    if (so_far != nullptr)
        take_up(*so_far);
    else
        set_up(kProfile);
    if constexpr (kProfile) record_.costs.resize(record_.events.size());
    record_.start_time = options_.start_time;
    if constexpr (kProfile) record_.setup_detect_ns = nanoseconds(set_up_start, Clock::now());
    double stop = plan_.scene.stop.time.value_or(kNever);
    if (options_.until) stop = std::min(stop, *options_.until);
    const std::int64_t most = plan_.scene.stop.events.value_or(-1);
    [[maybe_unused]] EventCost quiet;  // of rounds that brought no event
    for (;;) {
        if (most >= 0 && static_cast<std::int64_t>(record_.events.size()) >= most) {
            record_.stopped = StopReason::kEvents;
            break;
        }
        const auto start = kProfile ? Clock::now() : Clock::time_point{};
        search_ns_ = 0.0;
        const Candidate c = next<kProfile>();
        if (c.time > stop || c.time == kNever) {
            end(c.time, stop);
            break;
        }
        now_ = std::max(now_, c.time);
        const std::size_t events_before = record_.events.size();
        const auto found = kProfile ? Clock::now() : Clock::time_point{};
        if constexpr (kProfile) cost_ = {};
        apply<kProfile>(c);
        const auto resolved = kProfile ? Clock::now() : Clock::time_point{};
        redetect();
        const auto detected = kProfile ? Clock::now() : Clock::time_point{};
        requeue();
        if constexpr (kProfile) {
            const auto end = Clock::now();
            cost_.resolve_ns = quiet.resolve_ns + nanoseconds(found, resolved);
            cost_.detect_ns = quiet.detect_ns + nanoseconds(start, found) + nanoseconds(resolved, end);
            cost_.queue_ns =
                quiet.queue_ns + nanoseconds(start, found) - search_ns_ + nanoseconds(detected, end);
            cost_.kernel_ns += quiet.kernel_ns;
            record_.costs.resize(record_.events.size());
            // A sustained contact can bring several events at once: the first one carries the cost. Or none:
            // then the next event does.
            const bool event = record_.events.size() > events_before;
            if (event) record_.costs[events_before] = cost_;
            quiet = event ? EventCost{} : cost_;
        }
        if (options_.progress) tell_progress();
    }
    finish();
    return std::move(record_);
}

template Record Shot::run<false>(const Record*);

namespace {

/// CAROM_WITHOUT_PROFILE leaves the profiled loop out of the build: tools/measure/profile_cost compares with that.
Record run_shot(const Plan& plan, const SimulateOptions& options, const Record* so_far) {
    Shot shot(plan, options);
#ifndef CAROM_WITHOUT_PROFILE
    if (options.profile) return shot.run<true>(so_far);
#endif
    return shot.run<false>(so_far);
}

}  // namespace

Record simulate(const Plan& plan, const SimulateOptions& options) {
    return run_shot(plan, options, nullptr);
}

Record resume(const Plan& plan, const Record& so_far, const SimulateOptions& options) {
    return run_shot(plan, options, &so_far);
}

}  // namespace carom
