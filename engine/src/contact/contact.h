// A ball and what it touches, or is about to touch.
#pragma once

#include <cstdint>

#include "carom/engine/geometry.h"

namespace carom {

/// What a ball touches. The order is that of events at one and the same instant; a nose is a part of a cushion.
enum class With : std::uint8_t { kPocket, kNothing, kBall, kCushion, kNose };

struct Contact {
    int ball = -1;
    With with = With::kNothing;
    int other = -1;  ///< index into the balls, or into Geometry::pockets, cushions or noses
    bool operator==(const Contact&) const = default;

    /// The same part of the table, with another ball.
    Contact of(int another) const { return {another, with, other}; }
    /// The other ball, or -1.
    int partner() const { return with == With::kBall ? other : -1; }
    /// Whether both are the same contact; of two balls either one may stand first.
    bool same(const Contact& c) const {
        return *this == c ||
               (with == With::kBall && c.with == With::kBall && ball == c.other && other == c.ball);
    }
};

/// Whether the part of the table is a jaw, and not a cushion or its end.
inline bool is_jaw(const Contact& c, const Geometry& geometry) {
    return c.with == With::kNose && geometry.noses[c.other].type == EventType::kBallJaw;
}

/// What an event of this contact calls b and detail: see Event.
inline int event_partner(const Contact& c, const Geometry& geometry) {
    return c.with == With::kNose ? geometry.noses[c.other].index : c.other;
}
inline int event_detail(const Contact& c) {
    return c.with == With::kNose ? c.other : -1;
}

}  // namespace carom
