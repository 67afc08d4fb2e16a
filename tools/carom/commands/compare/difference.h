// What differs between two shots: events, and where their balls are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/vec.h"

namespace carom::tools {

/// How a shot leaves a ball.
struct BallEnd {
    MotionState state = MotionState::kStationary;
    std::string pocket;  ///< that holds it, or ""
    /// [m]; of a ball that is gone (in a pocket, off the table) the last one before
    Vec3 position = Vec3::Zero();
    bool operator==(const BallEnd&) const = default;

    bool gone() const { return is_gone(state); }
    /// Whether both are in one pocket, or both off the table: where they were last is nobody's concern then.
    bool gone_like(const BallEnd& other) const {
        return gone() && state == other.state && pocket == other.pocket;
    }
};

/// One ball in two shots.
struct BallDifference {
    std::string id;
    BallEnd a, b;
    double end = 0.0;         ///< [m] between the last places; 0 for a ball that is gone alike
    double largest = 0.0;     ///< [m] between the places at one time, from 0 to ShotDifference::until
    double largest_at = 0.0;  ///< [s] the first time of that distance

    /// Whether it is gone in both shots alike, or in none.
    bool gone_alike() const { return a.gone_like(b) || (!a.gone() && !b.gone()); }
    /// That, and its places are never farther apart than `length` [m].
    bool within(double length) const { return gone_alike() && end <= length && largest <= length; }
};

/// An event by names. Two are alike that have the same type and the same names, in any order.
struct NamedEvent {
    double time = 0.0;  ///< [s]
    std::string type;
    std::vector<std::string> who;  ///< the ball, and what it meets, if anything; of a cluster all its balls

    bool alike(const NamedEvent& other) const {
        return type == other.type &&
               std::is_permutation(who.begin(), who.end(), other.who.begin(), other.who.end());
    }
};

/// The events of both shots, one after the other.
struct EventDifference {
    std::size_t alike = 0;  ///< so many from the first on are alike
    /// of these the first, from 0, whose times are not the same bit for bit
    std::optional<std::size_t> first_apart;
    double farthest_apart = 0.0;  ///< [s] between the times of one of these
    std::vector<NamedEvent> a, b;

    /// Whether no shot has more than those that are alike.
    bool ends_alike() const { return alike == a.size() && alike == b.size(); }
};

struct ShotDifference {
    bool same_bits = false;                   ///< the hashes are the same
    std::vector<std::string> only_a, only_b;  ///< balls that the other shot does not have
    EventDifference events;                   ///< of the balls that both have
    /// [s] So long places are compared: to the end of the longer
    /// shot, or to that of one which was stopped while balls moved.
    double until = 0.0;
    std::vector<BallDifference> balls;  ///< those that both have, in the order of a

    bool same_balls() const { return only_a.empty() && only_b.empty(); }
    /// Whether both have the same balls, and each of them is within().
    bool within(double length) const;
};

/// Distances are exact to rounding: between two events of a ball, the difference of its places is a parabola.
ShotDifference difference(const Record& a, const Record& b);

}  // namespace carom::tools
