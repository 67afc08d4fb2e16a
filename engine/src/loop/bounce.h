// Impacts of a ball with the table: what touches it, and
// its motion after it has met all of that at one instant.
#pragma once

#include <array>
#include <cstddef>

#include "carom/engine/cushion.h"
#include "carom/engine/plan.h"
#include "carom/engine/vec.h"
#include "contact/contact.h"
#include "loop/approach.h"
#include "loop/balls.h"
#include "loop/detector.h"
#include "loop/resting_contacts.h"

namespace carom {

/// A cushion or a nose at a ball.
struct TableTouch {
    Approach approach;     ///< its a_c is that of the motion before the impact
    Vec2 normal;           ///< unit, from the part into the table
    double height = 0.0;   ///< [m] of the nose above the cloth
    double curving = 0.0;  ///< [m/s^2] opening acceleration of a ball that moves round the nose
    const CushionModelInfo* model = nullptr;

    /// [m/s^2] Closing acceleration of a ball that is accelerated by `pull`.
    double pressing(const Vec2& pull) const {
        return -(normal.x() * pull.x() + normal.y() * pull.y()) - curving;
    }
};

/// What a ball touches at one instant.
class TableTouches {
  public:
    explicit TableTouches(const TableTouch& first) : count_(1) { list_[0] = first; }
    /// Beyond the room for four the touch is left out: it is met next, at the same instant.
    void add(const TableTouch& touch) {
        if (count_ < list_.size()) list_[count_++] = touch;
    }
    std::size_t size() const { return count_; }
    TableTouch* begin() { return list_.data(); }
    TableTouch* end() { return list_.data() + count_; }
    const TableTouch* begin() const { return list_.data(); }
    const TableTouch* end() const { return list_.data() + count_; }
    const TableTouch& operator[](std::size_t k) const { return list_[k]; }

  private:
    std::array<TableTouch, 4> list_;
    std::size_t count_;
};

/// The touch of this contact with a cushion or nose, in the present state of its ball.
TableTouch table_touch(const Plan& plan, const Balls& balls, const Contact& contact);

/// The touch of this contact and all others that its ball meets at the same instant: they touch within
/// kTouchTolerance, close by more than rounding and do not rest. Parts that join smoothly are one.
TableTouches table_touches(const Plan& plan, const Balls& balls, const Detector& detector,
                           const RestingContacts& resting, const Contact& contact);

/// Replaces velocity and spin of a ball by those after it has met all touches at once. One touch: its model.
/// Two: the sum of their impulses, each from the incoming state, scaled so that the ball leaves either with
/// the speed with which it would leave that one alone. Where this would add energy, and for more than two:
/// the mean of the states after each, until none closes (docs/reference/physics.md, "Cushion impact").
/// @return false where a model has no solution
bool bounce(const Plan& plan, const TableTouches& touches, Vec3& v, Vec3& w);

}  // namespace carom
