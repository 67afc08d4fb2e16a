// The parts of the table that a ball touches at one instant.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "carom/engine/plan.h"
#include "carom/engine/vec.h"
#include "contact/contact.h"
#include "loop/balls.h"
#include "loop/detector.h"
#include "loop/resting_contacts.h"
#include "physics/cushion/bounce.h"

namespace carom {

struct TableTouch : NoseTouch {
    ContactKinematics approach;  ///< a_c is the acceleration before the impact
    double bend = 0.0;           ///< [m/s^2] Touch::bend

    /// [m/s^2] Closing acceleration of a ball with the acceleration `pull`.
    double pressing(const Vec2& pull) const {
        return -(normal.x() * pull.x() + normal.y() * pull.y()) - bend;
    }
};

class TableTouches {
  public:
    explicit TableTouches(const TableTouch& first) : count_(1) { list_[0] = first; }
    /// At most four. A further part is dropped: the ball hits it next, at the same instant.
    void add(const TableTouch& touch) {
        if (count_ < list_.size()) list_[count_++] = touch;
    }
    std::size_t size() const { return count_; }
    TableTouch* begin() { return list_.data(); }
    TableTouch* end() { return list_.data() + count_; }
    const TableTouch* begin() const { return list_.data(); }
    const TableTouch* end() const { return list_.data() + count_; }
    const TableTouch& operator[](std::size_t k) const { return list_[k]; }
    /// The part of the list that the cushion models need; valid until the next call.
    std::span<const NoseTouch> noses() {
        std::copy_n(list_.begin(), count_, noses_.begin());
        return {noses_.data(), count_};
    }

  private:
    std::array<TableTouch, 4> list_;
    std::array<NoseTouch, 4> noses_;
    std::size_t count_;
};

/// A contact with a cushion or nose, in the ball's present state.
TableTouch table_touch(const Plan& plan, const Balls& balls, const Contact& contact);

/// This contact and all simultaneous ones of its ball: those within kTouchTolerance that close by more than
/// rounding and are not resting contacts. Parts that join smoothly count as one.
TableTouches table_touches(const Plan& plan, const Balls& balls, const Detector& detector,
                           const RestingContacts& resting, const Contact& contact);

}  // namespace carom
