// Whether a ball in resting contacts slides, rolls or rests: checks each mode against the forces that result from it.
#include <cmath>

#include "contact/resting_group.h"

namespace carom::resting {

namespace {

// [-] Number of mode changes after which rest is no longer tried for a slow ball.
constexpr int kStopTries = 4;

bool change_mode(Body& b, Mode mode) {
    if (b.changes >= kModeChanges) return false;
    ++b.changes;
    b.mode = mode;
    return true;
}

bool turn_to(Body& b, const Vec2& drive, double size) {
    if (dot(b.direction, drive) > 0.0 && std::abs(cross(b.direction, drive)) <= kForceRounding * size)
        return true;
    if (b.changes >= kModeChanges) return true;
    ++b.changes;
    b.direction = drive / size;
    return false;
}

// A ball stays at rest while (5/7) |F| <= mu_r g, where F includes the forces of its contacts.
bool resting_holds(const Group& g, Body& b) {
    const Vec2 drive = b.due + (5.0 / 7.0) * (b.push + b.couple);
    const double size = length(drive), rounding = kForceRounding * (g.motion.slide + length(b.push));
    if (size <= g.motion.roll + rounding) return true;
    if (!change_mode(b, Mode::kRolling)) return true;
    b.starts = true;
    b.direction = drive / size;
    return false;
}

// A ball rolls while the friction of the cloth is large enough for it. A ball without velocity starts to roll along
// the force on it, or stays at rest.
bool rolling_holds(const Group& g, Body& b, SlowBalls slow) {
    const double grip = g.motion.slide * load(g, b) + g.motion.roll;
    if (length(b.a - b.push) > grip * (1.0 + kForceRounding)) {
        const Vec2 slip = b.push - 2.5 * b.couple;
        const double size = length(slip);
        if (!change_mode(b, Mode::kSliding)) return true;
        b.starts = true;
        b.direction = size > 0.0 ? Vec2(slip / size) : Vec2(-b.direction);
        return false;
    }
    if (!b.starts) return true;
    // For a slow ball, friction has the direction at the end of the shortest interval, v + h a: the direction at its
    // start would reverse the velocity within less time, again and again.
    const Vec2 drive = b.due + (5.0 / 7.0) * (b.push + b.couple);
    const double size = length(drive);
    const bool moves = b.due.x() != 0.0 || b.due.y() != 0.0;
    if (size <= g.motion.roll && moves) {
        // It stops within that interval if it also stays at rest under the forces that result from stopping it.
        if (slow == SlowBalls::kMayStop && b.changes < kStopTries && change_mode(b, Mode::kResting))
            return false;
        return turn_to(b, b.due, length(b.due));
    }
    if (!moves && (size <= g.motion.roll || b.changes >= kModeChanges)) {
        b.mode = Mode::kResting;
        b.changes = kModeChanges;  // permanently
        return false;
    }
    return turn_to(b, drive, size);
}

// A ball that starts to slip slips in the direction of the acceleration that drives the slip.
bool sliding_holds(const Group& g, Body& b) {
    bool hold = true;
    if (!b.lifted && b.lift > g.around.gravity) {
        b.lifted = true;
        hold = false;
    }
    const Vec2 slip = b.push - 2.5 * b.couple;
    const double size = length(slip);
    return (!b.starts || size == 0.0 || turn_to(b, slip, size)) && hold;
}

}  // namespace

// Whether the modes of all balls are consistent. Where one is not, its mode or direction changes, a bounded number of
// times: a ball without a consistent mode rests, or keeps its direction.
bool modes_hold(Group& g, SlowBalls slow) {
    bool hold = true;
    for (Body& b : g.bodies) {
        const bool holds = b.mode == Mode::kResting   ? resting_holds(g, b)
                           : b.mode == Mode::kRolling ? rolling_holds(g, b, slow)
                                                      : sliding_holds(g, b);
        hold = hold && holds;
    }
    return hold;
}

}  // namespace carom::resting
