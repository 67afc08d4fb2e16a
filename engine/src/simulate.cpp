// The event loop: next event -> advance its balls -> resolve -> record -> re-detect for those balls only.
#include "carom/engine/simulate.h"

#include <algorithm>

#include "cue.h"
#include "shot.h"

namespace carom {

Shot::Shot(const Plan& plan, const SimulateOptions& options)
    : plan_(plan), options_(options), motion_(motion_params(plan)) {}

void Shot::set_up(bool profile) {
    const Scene& scene = plan_.scene;
    record_.table = scene.table;
    record_.balls = plan_.balls;
    record_.gravity = plan_.gravity;
    record_.render = scene.render;
    balls_ = static_cast<int>(scene.ball.size());
    for (const BallStart& ball : scene.ball) {
        BallTrack track;
        track.id = ball.id;
        track.segments.push_back(start_segment(0.0, ball.position, ball.velocity, ball.spin, motion_));
        record_.tracks.push_back(std::move(track));
    }
    if (scene.cue) {
        for (int i = 0; i < balls_; ++i) {
            if (scene.ball[static_cast<std::size_t>(i)].id != scene.cue->ball) continue;
            const StruckBall struck = strike(*scene.cue, plan_.balls, plan_.squirt);
            begin(i, start_segment(0.0, now_of(i).r, struck.v, struck.w, motion_));
            record_.events.push_back({0.0, EventType::kCueStrike, i, -1, -1});
            if (profile) record_.costs.push_back({0.0, 0.0, 0.0, 0, "point"});
        }
    }
    first_candidates();
}

void Shot::first_candidates() {
    for (std::vector<Candidate>* list : {&own_, &feature_, &pair_}) list->resize(record_.tracks.size());
    box_.resize(record_.tracks.size());
    for (const CushionLine& line : plan_.cushions) {
        const Vec2 to = line.from + line.length * line.direction;
        line_boxes_.push_back({std::min(line.from.x(), to.x()), std::min(line.from.y(), to.y()),
                               std::max(line.from.x(), to.x()), std::max(line.from.y(), to.y())});
    }
    for (int i = 0; i < balls_; ++i) touched_.push_back(i);
    redetect();
}

void Shot::take_up(const Record& record) {
    record_ = record;
    record_.costs.clear();
    balls_ = static_cast<int>(record_.tracks.size());
    now_ = record_.duration;
    restore_held();
    first_candidates();
}

// Kept a function of its own, so that tools/profile_cost finds it by name.
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
    for (;;) {
        if (most >= 0 && static_cast<std::int64_t>(record_.events.size()) >= most) {
            record_.stopped = StopReason::kEvents;
            break;
        }
        const auto start = kProfile ? Clock::now() : Clock::time_point{};
        const Candidate c = next();
        if (c.time > stop || c.time == kNever) {
            record_.stopped = c.time == kNever ? StopReason::kAtRest : StopReason::kTime;
            if (c.time != kNever) now_ = stop;
            break;
        }
        now_ = std::max(now_, c.time);
        const std::size_t events_before = record_.events.size();
        if constexpr (kProfile) cost_ = {};
        const auto found = kProfile ? Clock::now() : Clock::time_point{};
        apply<kProfile>(c);
        const auto resolved = kProfile ? Clock::now() : Clock::time_point{};
        redetect();
        if constexpr (kProfile) {
            // A sustained contact can bring several events at once: the first one carries the cost.
            cost_.resolve_ns = nanoseconds(found, resolved);
            cost_.detect_ns = nanoseconds(start, found) + nanoseconds(resolved, Clock::now());
            record_.costs.resize(record_.events.size());
            if (record_.events.size() > events_before) record_.costs[events_before] = cost_;
        }
        if (options_.progress) options_.progress(record_.events.size(), now_);
    }
    record_.duration = now_;
    return std::move(record_);
}

namespace {

/// CAROM_WITHOUT_PROFILE leaves the profiled loop out of the build: tools/profile_cost compares with that.
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
