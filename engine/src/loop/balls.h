// The present motion of every ball. All parts of the loop read it, but only the Log changes a motion.
#pragma once

#include <algorithm>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "contact/roots.h"
#include "contact/touch.h"
#include "loop/memory.h"
#include "physics/motion.h"

namespace carom {

struct BallsMemory {
    std::vector<Segment> segments_;
    /// [s] When the ball began to fall into a pocket, and when its last flight ended.
    struct Turns {
        double fell, flew;
    };
    std::vector<Turns> turns_;
};

class Balls : private Borrowed<BallsMemory> {
  public:
    Balls(const Plan& plan, BallsMemory& memory) : Borrowed(memory), plan_(plan) {
        segments_.assign(plan.sizes.size(), Segment());
        turns_.assign(plan.sizes.size(), {0.0, -kNever});
    }

    int count() const { return static_cast<int>(segments_.size()); }
    /// The present motion of the ball.
    const Segment& segment(int ball) const { return segments_[ball]; }
    void set(int ball, const Segment& segment) {
        const MotionState before = segments_[ball].state;
        if (flies(before)) turns_[ball].flew = segment.start;
        if (segment.state == MotionState::kFalling && before != MotionState::kFalling)
            turns_[ball].fell = segment.start;
        segments_[ball] = segment;
    }
    bool sinks(int ball) const { return segments_[ball].state == MotionState::kFalling; }
    /// Whether these two meet in space rather than in the plane: one of them flies, or has flown since the
    /// other began to fall into a pocket. That lasts until one of them is gone or the falling ball is back on
    /// the cloth, because until then they may overlap in the plane.
    bool in_space(int a, int b) const {
        return flies(segments_[a].state) || flies(segments_[b].state) ||
               (sinks(a) && turns_[b].flew >= turns_[a].fell) ||
               (sinks(b) && turns_[a].flew >= turns_[b].fell);
    }

    /// [s] since the start of the shot
    double now() const { return now_; }
    void advance_to(double time) { now_ = std::max(now_, time); }

    // The state at now(): [m], [m/s], [rad/s].
    Vec3 position(int ball) const { return position_at(segments_[ball], now_ - segments_[ball].start); }
    Vec3 velocity(int ball) const { return velocity_at(segments_[ball], now_ - segments_[ball].start); }
    Vec3 spin(int ball) const { return spin_at(segments_[ball], now_ - segments_[ball].start, radius(ball)); }

    /// Includes the height of a ball that flies or falls.
    Placed placed(int ball) const {
        return placed_at(segments_[ball], now_ - segments_[ball].start, plan_.gravity);
    }

    /// The ball in the plane of the cloth, for what it touches there.
    BallAt<Vec3> at(int ball) const { return {position(ball), velocity(ball), radius(ball)}; }
    double radius(int ball) const { return plan_.sizes[ball].R; }
    const MotionParams& motion(int ball) const { return plan_.motion[ball]; }

  private:
    const Plan& plan_;
    double now_ = 0.0;
};

}  // namespace carom
