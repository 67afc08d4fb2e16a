// The event loop: find the next event -> advance -> resolve -> search the contacts of the balls whose motion changed.
#include "carom/engine/simulate.h"

#include <algorithm>
#include <cstdint>

#include "loop/run.h"
#include "physics/cue.h"
#include "physics/motion.h"

namespace carom {

Run::Run(const Plan& plan, const SimulateOptions& options)
    : plan_(plan),
      stop_(std::min(plan.scene.stop.time.value_or(kNever), options.until.value_or(kNever))),
      balls_(plan),
      log_(plan, options, balls_),
      resting_(plan, balls_, log_),
      detector_(plan, balls_, resting_, log_.costs()),
      resolver_(plan, balls_, log_, resting_, detector_) {}

Record Run::simulate(const Record* so_far) {
    double set_up_ns = 0.0;
    {
        const Stopwatch watch(log_.costs() != nullptr ? &set_up_ns : nullptr);
        if (so_far != nullptr) {
            log_.resume(*so_far);
            resting_.restore(log_.events());
        } else {
            start_balls();
        }
        log_.touched().clear();
        for (int i = 0; i < balls_.count(); ++i) log_.touched().push_back(i);
        detector_.update(log_.touched());
    }
    log_.end_set_up(set_up_ns);
    while (!is_full()) {
        log_.begin_round();
        const Candidate next = detector_.next();
        if (next.time > stop_ || next.time == kNever) return finish(next.time);
        balls_.advance_to(next.time);
        resolver_.resolve(next.contact);
        detector_.update(log_.touched());
        log_.end_round();
    }
    return log_.finish(StopReason::kEvents);
}

void Run::start_balls() {
    const Scene& scene = plan_.scene;
    for (int i = 0; i < balls_.count(); ++i) {
        const BallStart& ball = scene.ball[i];
        log_.begin(i, start_segment(0.0, ball.position, ball.velocity, ball.spin, balls_.motion(i)));
    }
    for (int i = 0; scene.cue && i < balls_.count(); ++i) {
        if (log_.id(i) != scene.cue->ball) continue;
        const StruckBall struck = strike(*scene.cue, plan_.sizes[i], plan_.in_force(Effect::kSquirt));
        log_.begin(i, start_segment(0.0, balls_.segment(i).r, struck.v, struck.w, balls_.motion(i)));
        log_.event(EventType::kCueStrike, i);
    }
}

bool Run::is_full() const {
    const auto most = plan_.scene.stop.events;
    return most && static_cast<std::int64_t>(log_.events().size()) >= *most;
}

// Called if the next event is later than the end of the simulated time, or if there is none.
Record Run::finish(double next) {
    bool moves = false;
    for (int i = 0; i < balls_.count(); ++i) {
        const MotionState state = balls_.segment(i).state;
        moves = moves || (state != MotionState::kStationary && state != MotionState::kPocketed);
    }
    if (next == kNever && !moves) return log_.finish(StopReason::kAtRest);
    if (stop_ == kNever) return log_.finish(StopReason::kEndless);
    balls_.advance_to(stop_);
    return log_.finish(StopReason::kTime);
}

Record simulate(const Plan& plan, const SimulateOptions& options) {
    return Run(plan, options).simulate(nullptr);
}

Record resume(const Plan& plan, const Record& so_far, const SimulateOptions& options) {
    return Run(plan, options).simulate(&so_far);
}

}  // namespace carom
