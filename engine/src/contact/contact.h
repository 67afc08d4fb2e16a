// A contact: a ball and the ball or part of the table that it touches or will touch.
#pragma once

#include <cstdint>

#include "carom/engine/geometry.h"

namespace carom {

/// Kinds of partners, in the order of simultaneous events. A nose (a jaw or a cushion's end) counts as a
/// cushion. kOut: the border of the table that a ball flies over.
enum class With : std::uint8_t { kPocket, kNothing, kBall, kCushion, kNose, kOut };

struct Contact {
    int ball = -1;
    With with = With::kNothing;
    int other = -1;  ///< index into the balls, or into Geometry::pockets, cushions or noses
    bool operator==(const Contact&) const = default;

    /// The contact of another ball with the same part of the table.
    Contact of(int another) const { return {another, with, other}; }
    int partner() const { return with == With::kBall ? other : -1; }
    /// Whether both are the same contact; the order of two balls does not matter.
    bool same(const Contact& c) const {
        return *this == c ||
               (with == With::kBall && c.with == With::kBall && ball == c.other && other == c.ball);
    }
};

/// Whether the part of the table is a jaw, not a cushion or its end.
inline bool is_jaw(const Contact& c, const Geometry& geometry) {
    return c.with == With::kNose && geometry.noses[c.other].type == EventType::kBallJaw;
}

/// The fields b and detail of an event of this contact (Event). @param place  of the ball
inline int event_partner(const Contact& c, const Geometry& geometry, const Vec2& place) {
    if (c.with != With::kNose) return c.other;
    const Nose& nose = geometry.noses[c.other];
    for (const Nose& arc : geometry.joined)
        if (continues(arc, nose) && arc.span.holds(place - arc.center)) return arc.index;
    return nose.index;
}
inline int event_detail(const Contact& c) {
    return c.with == With::kNose ? c.other : -1;
}

/// The contact of an event: the inverse of event_partner() and event_detail().
inline Contact contact_of(const Event& event) {
    switch (kind(event.type).partner) {
        case Partner::kBall:
            return {event.a, With::kBall, event.b};
        case Partner::kCushion:
        case Partner::kJaw:
            return event.detail >= 0 ? Contact{event.a, With::kNose, event.detail}
                                     : Contact{event.a, With::kCushion, event.b};
        case Partner::kPocket:
            return {event.a, With::kPocket, event.b};
        case Partner::kNone:
            break;
    }
    return {event.a};
}

}  // namespace carom
