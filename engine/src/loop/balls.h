// The present motion of every ball. All parts of the loop read it, but only the Log changes a motion.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "contact/roots.h"
#include "contact/touch.h"
#include "physics/motion.h"

namespace carom {

/// Takes memory over for its own lifetime, then returns it for the next run. A derived class has the members
/// of `Memory` as its own.
template <class Memory>
class Borrowed : protected Memory {
  public:
    explicit Borrowed(Memory& owner) : Memory(std::move(owner)), owner_(owner) {}
    ~Borrowed() { owner_ = std::move(static_cast<Memory&>(*this)); }
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;

  private:
    Memory& owner_;
};

struct BallsMemory {
    std::vector<Segment> segments_;
    /// [s] When the ball began to fall into a pocket, and when its last flight ended.
    struct Turns {
        double fell, flew;
    };
    std::vector<Turns> turns_;
    /// For a colliding ball: its motion after the cluster, and another ball of the cluster. These form a
    /// ring.
    struct Afterwards {
        Segment segment;
        int next;
    };
    std::vector<Afterwards> afterwards_;
};

class Balls : private Borrowed<BallsMemory> {
  public:
    Balls(const Plan& plan, BallsMemory& memory) : Borrowed(memory), plan_(plan) {
        segments_.assign(plan.sizes.size(), Segment());
        turns_.assign(plan.sizes.size(), {0.0, -kNever});
        afterwards_.resize(plan.sizes.size());
        for (int i = 0; i < count(); ++i) afterwards_[i].next = i;
    }

    int count() const { return static_cast<int>(segments_.size()); }
    const Segment& segment(int ball) const { return segments_[ball]; }
    void set(int ball, const Segment& segment) {
        const MotionState before = segments_[ball].state;
        if (is_aloft(segments_[ball], radius(ball))) turns_[ball].flew = segment.start;
        if (segment.state == MotionState::kFalling && before != MotionState::kFalling)
            turns_[ball].fell = segment.start;
        if (before == MotionState::kColliding) leave_cluster(ball);
        segments_[ball] = segment;
    }
    /// Sets a colliding ball's motion after its cluster, to which `other` belongs as well.
    void set_afterwards(int ball, const Segment& segment, int other) {
        afterwards_[ball].segment = segment;
        if (other == ball) return;
        afterwards_[ball].next = afterwards_[other].next;
        afterwards_[other].next = ball;
    }
    bool collides(int ball) const { return segments_[ball].state == MotionState::kColliding; }
    /// For a colliding ball: its motion afterwards, and another ball of its cluster, if any.
    const Segment& afterwards(int ball) const { return afterwards_[ball].segment; }
    int next_in_cluster(int ball) const { return afterwards_[ball].next; }
    bool sinks(int ball) const { return segments_[ball].state == MotionState::kFalling; }
    /// Whether these two collide in space rather than in the plane: one of them flies, or has flown since the
    /// other began to fall into a pocket. Until one of them is gone or the falling ball is back on the cloth,
    /// they may overlap in the plane.
    bool in_space(int a, int b) const {
        return is_aloft(segments_[a], radius(a)) || is_aloft(segments_[b], radius(b)) ||
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

    /// Includes the height of a flying or falling ball.
    Placed placed(int ball) const {
        return placed_at(segments_[ball], now_ - segments_[ball].start, plan_.gravity);
    }

    /// In space if the ball flies, otherwise in the plane of the cloth.
    BallAt at(int ball) const {
        if (!flies(segments_[ball].state)) return {position(ball), velocity(ball), radius(ball)};
        const Placed there = placed(ball);
        return {there.position, there.velocity, radius(ball), true};
    }
    /// A contact with a part of the table, or of two balls in the plane of the cloth.
    Meeting meet(const Contact& contact) const {
        Meeting met{contact, at(contact.ball), {}, {}, 0.0};
        Vec2 a = segments_[contact.ball].a;
        if (contact.with == With::kBall) {
            met.other = at(contact.other);
            met.touch = touch_level(met.ball, met.other, plan_.balls.discs());
            a -= segments_[contact.other].a;
        } else {
            met.touch = touch_part(plan_.geometry, contact, met.ball);
        }
        met.pressing = met.touch.pressing(a);
        return met;
    }
    /// The motion of a ball after an impact, from `later` seconds after now(). A falling ball continues to
    /// fall.
    Segment after_impact(int ball, const Vec3& r, const Velocities& after, double later = 0.0) const {
        const Segment& before = segments_[ball];
        const double time = now_ + later;
        if (before.state == MotionState::kFalling) {
            const double falls = fall_speed(before, time - before.start, motion(ball).gravity);
            return falling_segment(time, r, after.v, after.w, falls, motion(ball));
        }
        const auto begin = plan_.in_force(Effect::kAirborne) ? free_segment : start_segment;
        return begin(time, r, after.v, after.w, motion(ball));
    }
    double radius(int ball) const { return plan_.sizes[ball].R; }
    const MotionParams& motion(int ball) const { return plan_.motion[ball]; }

  private:
    void leave_cluster(int ball) {
        int last = ball;
        while (afterwards_[last].next != ball) last = afterwards_[last].next;
        afterwards_[last].next = std::exchange(afterwards_[ball].next, ball);
    }

    const Plan& plan_;
    double now_ = 0.0;
};

}  // namespace carom
