// A contact: a ball and the ball or part of the table that it touches or will touch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "carom/engine/geometry.h"
#include "carom/engine/vec.h"

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
    bool is_nose() const { return with == With::kCushion || with == With::kNose; }
    bool is_part() const { return is_nose() || with == With::kPocket; }
    /// Whether both are the same contact; the order of two balls does not matter.
    bool same(const Contact& c) const {
        return *this == c ||
               (with == With::kBall && c.with == With::kBall && ball == c.other && other == c.ball);
    }
};

/// Calls f with the nose of a contact: a CushionLine or a Nose.
template <class F>
auto with_nose(const Geometry& geometry, const Contact& c, const F& f) {
    return c.with == With::kNose ? f(geometry.noses[c.other]) : f(geometry.cushions[c.other]);
}
/// Calls f with the part of the table, which may also be a Pocket. Only these two functions tell the kinds of
/// parts apart; f calls functions that have an overload for each kind (touch.h, detect.h).
template <class F>
auto with_part(const Geometry& geometry, const Contact& c, const F& f) {
    return c.with == With::kPocket ? f(geometry.pockets[c.other]) : with_nose(geometry, c, f);
}
/// Calls f(contact without a ball, part) for all parts.
template <class F>
void each_part(const Geometry& geometry, const F& f) {
    const auto each = [&f](With with, const auto& parts) {
        for (int i = 0; i < static_cast<int>(parts.size()); ++i) f(Contact{-1, with, i}, parts[i]);
    };
    each(With::kCushion, geometry.cushions);
    each(With::kNose, geometry.noses);
    each(With::kPocket, geometry.pockets);
}

inline Partner partner_of(const Contact& c, const Geometry& geometry) {
    if (c.with == With::kBall) return Partner::kBall;
    if (c.with == With::kPocket) return Partner::kPocket;
    return with_nose(geometry, c, [](const auto& nose) { return nose.partner; });
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

/// An order that reflections in the axes and quarter turns preserve, except for the order of mirror images
/// among themselves.
inline bool before_place(const Vec2& p, const Vec2& q) {
    const auto key = [](const Vec2& a) {
        const double x = std::abs(a.x()), y = std::abs(a.y());
        return std::array<double, 4>{std::max(x, y), std::min(x, y), a.y(), a.x()};
    };
    return key(p) < key(q);
}

}  // namespace carom
