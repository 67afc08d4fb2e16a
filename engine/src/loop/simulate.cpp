// The event loop: find the next event -> advance -> resolve -> search the contacts of the changed balls.
#include "carom/engine/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "loop/run.h"
#include "physics/cue.h"
#include "physics/motion.h"

namespace carom {

namespace {

// [R] A run fails if the clock's resolution leaves a ball's position uncertain by more than this.
constexpr double kLostShare = 1e-3;
// [s] Before this the clock is fine enough for any legal speed, and is not checked.
constexpr double kDigitsAreMany = 1e3;
// [-] Iterations between two looks at a ball that runs along a wall.
constexpr int kLook = 1000;
// [-] Friction makes a greater difference of speeds between two looks.
constexpr double kSameSpeed = 1e-12;

}  // namespace

Run::Run(const Plan& plan, const SimulateOptions& options, RunBuffers::Memory& memory, Keep keep)
    : plan_(plan),
      stop_(std::min(plan.scene.stop.time.value_or(kNever), options.until.value_or(kNever))),
      most_(std::min<std::int64_t>(plan.scene.stop.events.value_or(kUsualEvents), kMostEvents)),
      balls_(plan, memory.balls),
      log_(plan, options, balls_, memory.log, keep),
      resting_(plan, balls_, log_, memory.resting),
      detector_(plan, balls_, resting_, log_.costs(), memory.detector),
      resolver_(plan, balls_, log_, resting_, detector_, memory.clusters) {}

Record Run::simulate() {
    const StopReason why = run();
    return log_.record(why);
}

void Run::simulate(Outcome& outcome) {
    const StopReason why = run();
    log_.outcome(why, outcome);
}

void Run::simulate(Outcome& outcome, Record& record) {
    const StopReason why = run();
    log_.outcome(why, outcome);
    log_.record(why, record);
}

StopReason Run::run() {
    double set_up_ns = 0.0;
    {
        const Stopwatch watch(log_.costs() != nullptr ? &set_up_ns : nullptr);
        start_balls();
        log_.touched().clear();
        for (int i = 0; i < balls_.count(); ++i) log_.touched().push_back(i);
        detector_.update(log_.touched());
    }
    log_.end_set_up(set_up_ns);
    while (!is_full()) {
        log_.begin_round();
        const PredictedEvent next = detector_.next();
        if (next.time > stop_ || next.time == kNever) return stop(next.time);
        if (next.time > kDigitsAreMany) check_creeping(next.time);
        if (next.time > kDigitsAreMany && next.contact.with != With::kNothing) {
            for (const int ball : {next.contact.ball, next.contact.partner()})
                if (ball >= 0) check_digits(ball, next.time);
        }
        balls_.advance_to(next.time);
        resolver_.resolve(next.contact);
        detector_.update(log_.touched());
        log_.end_round();
        if (stop_ == kNever && log_.quiet_rounds() % kLook == kLook - 1 && goes_round())
            return StopReason::kEndless;
    }
    return StopReason::kEvents;
}

// Whether the only ball that moves has gone twice round every wall since the last event without losing speed:
// it runs along one for ever, without friction.
bool Run::goes_round() {
    int runner = -1;
    for (int ball = 0; ball < balls_.count(); ++ball) {
        const MotionState state = balls_.segment(ball).state;
        if (state == MotionState::kStationary || is_gone(state)) continue;
        if (runner >= 0) return false;
        runner = ball;
    }
    if (runner < 0) return false;
    const double speed = length3(balls_.segment(runner).v), before = std::exchange(lap_speed_, speed);
    double largest = 0.0;
    for (const Nose& nose : plan_.geometry.noses) largest = std::max(largest, std::abs(nose.radius));
    const double since = log_.events().empty() ? 0.0 : log_.events().back().time;
    // A ball that contacts hold in place may have a speed of rounding.
    return largest > 0.0 && std::abs(speed - before) <= kSameSpeed * speed &&
           speed * (balls_.now() - since) > 4.0 * std::numbers::pi * largest;
}

// Without friction a slow ball can move for so long that the clock's resolution no longer suffices: it would
// pass through other bodies.
void Run::check_digits(int ball, double time) {
    const Segment& s = balls_.segment(ball);
    const double R = balls_.radius(ball);
    const double end = kLostShare * R / (kClosingUlp * kEpsilon * (length3(s.v) + R * length3(s.w)));
    if (time > end) lose(ball, end);
}

// Closing speeds below the rounding of a ball's surface speed do not count as an approach. With much spin and
// no friction a ball may creep that slowly, and would pass through other bodies. A faster ball hits something
// first, or is gone.
void Run::check_creeping(double time) {
    const Geometry& g = plan_.geometry;
    if (!plan_.pairs && g.cushions.empty() && g.noses.empty()) return;
    for (int ball = 0; ball < balls_.count(); ++ball) {
        const Segment& s = balls_.segment(ball);
        if (!translates(s.state) || s.held) continue;
        const double R = balls_.radius(ball), v = length3(s.v);
        const double noise = kClosingUlp * kEpsilon * (v + R * length3(s.w)), lost = kLostShare * R / noise;
        const bool creeps = v > 0.0 && kLostShare * v <= noise && length(s.a) == 0.0;
        if (creeps && time - s.start > lost) lose(ball, s.start + lost);
    }
}

void Run::lose(int ball, double when) {
    balls_.advance_to(when);
    log_.fail(fmt::format(
        "after such a long time the position of ball {} is only known to {:.2g} m, too coarse for its next "
        "contact; end the run earlier with [stop] time, or add friction",
        log_.id(ball), kLostShare * balls_.radius(ball)));
}

void Run::start_balls() {
    const Scene& scene = plan_.scene;
    const bool flies = plan_.in_force(Effect::kAirborne);
    for (int i = 0; i < balls_.count(); ++i) {
        const BallStart& ball = scene.ball[i];
        log_.begin(i, balls_.after_impact(i, ball.position, {ball.velocity, ball.spin}));
    }
    for (int i = 0; scene.cue && i < balls_.count(); ++i) {
        if (log_.id(i) != scene.cue->ball) continue;
        const StruckBall struck = strike(*scene.cue, plan_.sizes[i], plan_.in_force(Effect::kSquirt),
                                         flies ? Vertical::kKeep : Vertical::kDrop);
        log_.event(EventType::kCueStrike, i);
        resolver_.strike(i, {struck.v, struck.w});
    }
}

bool Run::is_full() {
    if (static_cast<std::int64_t>(log_.events().size()) < most_) return false;
    if (plan_.scene.stop.events == most_) return true;
    log_.fail(
        plan_.scene.stop.events
            ? "a run cannot have more events"
            : "too many events; allow more with [stop] events, or end the run earlier with [stop] time");
}

// Called if the next event is after the end of the simulated time, or if there is none.
StopReason Run::stop(double next) {
    bool moves = false;
    for (int i = 0; i < balls_.count(); ++i) {
        const MotionState state = balls_.segment(i).state;
        moves = moves || (state != MotionState::kStationary && !is_gone(state));
    }
    if (next == kNever && !moves) return StopReason::kAtRest;
    if (stop_ == kNever) return StopReason::kEndless;
    if (stop_ > kDigitsAreMany) check_creeping(stop_);
    balls_.advance_to(stop_);
    return StopReason::kTime;
}

RunBuffers::RunBuffers() : memory_(std::make_unique<Memory>()) {}
RunBuffers::~RunBuffers() = default;
RunBuffers::RunBuffers(RunBuffers&&) noexcept = default;
RunBuffers& RunBuffers::operator=(RunBuffers&&) noexcept = default;

Record simulate(const Plan& plan, RunBuffers& buffers, const SimulateOptions& options) {
    return Run(plan, options, buffers.memory()).simulate();
}

void simulate(const Plan& plan, RunBuffers& buffers, Outcome& outcome, const SimulateOptions& options) {
    Run(plan, options, buffers.memory(), options.hash ? Keep::kHash : Keep::kOutcome).simulate(outcome);
}

void simulate(const Plan& plan, RunBuffers& buffers, Outcome& outcome, Record& record,
              const SimulateOptions& options) {
    Run(plan, options, buffers.memory()).simulate(outcome, record);
}

Record simulate(const Plan& plan, const SimulateOptions& options) {
    RunBuffers::Memory memory;
    return Run(plan, options, memory).simulate();
}

}  // namespace carom
