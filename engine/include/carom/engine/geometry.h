// The table as the event loop uses it: lines, round noses and pockets.
#pragma once

#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/table.h"
#include "carom/engine/vec.h"

namespace carom {

/// A straight cushion; index as in scene.table.cushions.
struct CushionLine {
    Vec2 from;
    Vec2 direction;  ///< unit
    double length;
    double height;
    double inset = 0.0;  ///< [m] a ball touches it with its centre at R - inset (cushion_touch)
    static constexpr Partner partner = Partner::kCushion;
    bool operator==(const CushionLine&) const = default;
};

CushionLine line_of(const Cushion& cushion, double inset);

/// The part of a circle that an arc covers, counter-clockwise from one direction to another.
struct ArcSpan {
    Vec2 from = Vec2::Zero(), to = Vec2::Zero();  ///< unit vectors
    bool whole = true;                            ///< the full circle
    bool wide = false;                            ///< more than half of it
    /// Whether the arc is in this direction from its centre.
    bool holds(const Vec2& out, double slack = 0.0) const {
        if (whole) return true;
        const bool after = cross(from, out) >= -slack, before = cross(out, to) >= -slack;
        return wide ? after || before : after && before;
    }
    bool operator==(const ArcSpan&) const = default;
};
ArcSpan span_of(const Jaw& jaw);

/// A round nose: a jaw, an arc, or an unrounded end of a cushion or an arc (radius 0).
struct Nose {
    Vec2 center;
    double radius;  ///< negative for a wall around the balls: all distances from it are then negative, too
    double height;
    Partner partner;     ///< kJaw or kCushion
    int index;           ///< of the jaw or cushion in scene.table
    double inset = 0.0;  ///< [m] a ball touches it with its centre at R + radius - inset
    ArcSpan span{};
    double sign() const { return radius < 0.0 ? -1.0 : 1.0; }
    bool is_arc() const { return radius < 0.0 || !span.whole; }
    bool operator==(const Nose&) const = default;
};
/// Whether two noses are on one circle, with the balls on the same side.
inline bool continues(const Nose& one, const Nose& other) {
    return one.center == other.center && one.radius == other.radius && one.is_arc() && other.is_arc();
}
/// @param index  of the jaw in scene.table
Nose nose_of(const Jaw& jaw, int index, double inset);

/// [m] Reduction, at this height of the nose, of the horizontal distance at which a ball touches it.
double nose_inset(CushionTouch touch, double R, double height);

/// All parts of a table that can touch a ball.
struct Geometry {
    std::vector<CushionLine> cushions;
    std::vector<Nose> noses;
    std::vector<Pocket> pockets;
    std::vector<Nose> joined{};  ///< arcs that continue another one: all on a circle are one nose
    bool operator==(const Geometry&) const = default;
};

}  // namespace carom
