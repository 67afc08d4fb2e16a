// Whether a ball in resting contacts slips, rolls or rests: what its mode claims against the forces that come of it.
#include <cmath>

#include "contact/resting_group.h"

namespace carom::resting {

namespace {

// [-] Changes after which a slow ball is no longer tried at rest.
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

// A ball at rest stays while (5/7) |F| <= mu_r g, with the forces of what it leans on.
bool resting_holds(const Group& g, Body& b) {
    const Vec2 drive = b.due + (5.0 / 7.0) * (b.push + b.couple);
    const double size = length(drive), rounding = kForceRounding * (g.motion.slide + length(b.push));
    if (size <= g.motion.roll + rounding) return true;
    if (!change_mode(b, Mode::kRolling)) return true;
    b.starts = true;
    b.direction = drive / size;
    return false;
}

// A ball rolls while the cloth can give what that takes. One that has no velocity yet rolls along the force
// on it, or stays after all.
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
    // Of a slow ball friction takes the direction at the end of the shortest interval, v + h a: at its start
    // it would turn the ball over within less, now this way, now that.
    const Vec2 drive = b.due + (5.0 / 7.0) * (b.push + b.couple);
    const double size = length(drive);
    const bool moves = b.due.x() != 0.0 || b.due.y() != 0.0;
    if (size <= g.motion.roll && moves) {
        // It stops within that interval, if the forces that come of stopping it so soon leave it there too.
        if (slow == SlowBalls::kMayStop && b.changes < kStopTries && change_mode(b, Mode::kResting))
            return false;
        return turn_to(b, b.due, length(b.due));
    }
    if (!moves && (size <= g.motion.roll || b.changes >= kModeChanges)) {
        b.mode = Mode::kResting;
        b.changes = kModeChanges;  // for good
        return false;
    }
    return turn_to(b, drive, size);
}

// A ball that starts to slip slips along what drives the slip.
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

// Whether every ball can do what its mode says; where not, the mode or the direction changes, a bounded
// number of times: a ball that finds no consistent mode rests, or keeps its direction.
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
