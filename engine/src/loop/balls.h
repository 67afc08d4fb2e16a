// The present motion of every ball. All parts of the loop read it; a motion is changed only through the Log.
#pragma once

#include <algorithm>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "loop/memory.h"
#include "physics/motion.h"

namespace carom {

struct BallsMemory {
    std::vector<Segment> segments_;
};

class Balls : private Borrowed<BallsMemory> {
  public:
    Balls(const Plan& plan, BallsMemory& memory) : Borrowed(memory), plan_(plan) {
        segments_.assign(plan.sizes.size(), Segment());
    }

    int count() const { return static_cast<int>(segments_.size()); }
    /// The present motion of the ball.
    const Segment& segment(int ball) const { return segments_[ball]; }
    void set(int ball, const Segment& segment) { segments_[ball] = segment; }

    /// [s] since the start of the shot
    double now() const { return now_; }
    void advance_to(double time) { now_ = std::max(now_, time); }

    // The state at now(): [m], [m/s], [rad/s].
    Vec3 position(int ball) const { return position_at(segments_[ball], now_ - segments_[ball].start); }
    Vec3 velocity(int ball) const { return velocity_at(segments_[ball], now_ - segments_[ball].start); }
    Vec3 spin(int ball) const { return spin_at(segments_[ball], now_ - segments_[ball].start, radius(ball)); }

    /// With the height of a ball that flies or falls.
    Placed placed(int ball) const {
        return placed_at(segments_[ball], now_ - segments_[ball].start, plan_.gravity);
    }

    double radius(int ball) const { return plan_.sizes[ball].R; }
    const MotionParams& motion(int ball) const { return plan_.motion[ball]; }

  private:
    const Plan& plan_;
    double now_ = 0.0;
};

}  // namespace carom
