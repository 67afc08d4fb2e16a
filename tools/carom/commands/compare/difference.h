// The differences between two shots: events, and positions of balls.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/vec.h"

namespace carom::tools {

/// The position of a ball at any time, until it leaves play. A pocketed ball is at the bottom of its pocket
/// at once.
class BallWay {
  public:
    BallWay(const Record& record, int ball) : record_(record), ball_(ball), last_(record.duration) {
        for (const Segment& s : segments())
            if (is_gone(s.state)) last_ = std::min(last_, std::nextafter(s.start, 0.0));
    }

    Vec3 at(double t) const { return record_.state_at(ball_, std::min(t, last_)).position; }
    /// [s] The position no longer changes after this.
    double last() const { return last_; }
    const std::vector<Segment>& segments() const { return record_.tracks[ball_].segments; }

  private:
    const Record& record_;
    int ball_;
    double last_;
};

/// The final state of a ball in a shot.
struct BallEnd {
    MotionState state = MotionState::kStationary;
    std::string pocket;  ///< its pocket, or ""
    /// [m] If the ball is gone (in a pocket, off the table), its last position before that.
    Vec3 position = Vec3::Zero();
    bool operator==(const BallEnd&) const = default;

    bool gone() const { return is_gone(state); }
    /// Whether both are in the same pocket, or both off the table; their last positions no longer matter
    /// then.
    bool gone_like(const BallEnd& other) const {
        return gone() && state == other.state && pocket == other.pocket;
    }
};

/// One ball in two shots.
struct BallDifference {
    std::string id;
    BallEnd a, b;
    double end = 0.0;         ///< [m] between the last positions; 0 if the ball is gone alike
    double largest = 0.0;     ///< [m] between positions at the same time, from 0 to ShotDifference::until
    double largest_at = 0.0;  ///< [s] when that distance first occurs

    /// Whether the ball is gone alike in both shots, or in neither.
    bool gone_alike() const { return a.gone_like(b) || (!a.gone() && !b.gone()); }
    /// The same, and the positions are never farther apart than `length` [m].
    bool within(double length) const { return gone_alike() && end <= length && largest <= length; }
};

/// An event with names. Two events match if they have the same type and the same names, in any order.
struct NamedEvent {
    double time = 0.0;  ///< [s]
    std::string type;
    std::vector<std::string> who;  ///< the ball and what it meets, if anything; for a cluster, all its balls

    bool alike(const NamedEvent& other) const {
        return type == other.type &&
               std::is_permutation(who.begin(), who.end(), other.who.begin(), other.who.end());
    }
};

/// The events of both shots, each in order.
struct EventDifference {
    std::size_t alike = 0;  ///< this many match, from the first on
    /// the first of these, from 0, whose times are not bit-identical
    std::optional<std::size_t> first_apart;
    double farthest_apart = 0.0;  ///< [s] largest difference of their times
    std::vector<NamedEvent> a, b;

    /// Whether neither shot has events beyond the matching ones.
    bool ends_alike() const { return alike == a.size() && alike == b.size(); }
};

struct ShotDifference {
    bool same_bits = false;                   ///< the hashes are the same
    std::vector<std::string> only_a, only_b;  ///< balls missing in the other shot
    EventDifference events;                   ///< of the balls that both have
    /// [s] Positions are compared until here: the end of the longer shot, or of one that was stopped while
    /// balls moved.
    double until = 0.0;
    std::vector<BallDifference> balls;  ///< balls of both, in the order of a

    bool same_balls() const { return only_a.empty() && only_b.empty(); }
    /// Whether both have the same balls, and each ball is within().
    bool within(double length) const;
};

/// Distances are exact to rounding: between two events of a ball, the difference of its positions is a
/// parabola.
ShotDifference difference(const Record& a, const Record& b);

}  // namespace carom::tools
