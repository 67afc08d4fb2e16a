// The table: what balls bounce off and fall into. Lengths in m, heights above the cloth.
//
// Frame: right-handed, z up, x along the short side, y along the long side, origin where two nose lines meet.
#pragma once

#include <string>
#include <vector>

#include "carom/engine/vec.h"

namespace carom {

/// A straight cushion nose from one point to the other. It acts on both sides, and its ends are round with
/// radius 0: neighbouring cushions leave no gap.
struct Cushion {
    std::string id;
    Vec2 from, to;
    double height;
    std::string name{};  ///< for people: "left rail, head half"
    bool operator==(const Cushion&) const = default;
};

/// A rounded jaw: a full circle. A ball touches it at centre distance R + radius.
struct Jaw {
    std::string id;
    Vec2 center;
    double radius;
    double height;
    std::string name{};
    bool operator==(const Jaw&) const = default;
};

/// A ball is pocketed when its centre crosses the circle.
struct Pocket {
    std::string id;
    Vec2 center;
    double radius;
    double depth;  ///< a pocketed ball rests at (center, -depth)
    std::string name{};
    bool operator==(const Pocket&) const = default;
};

/// Cushions are "c1", "c2", ..., jaws "j1", ..., pockets "p1", ..., in the order in which they are listed.
/// The presets list them clockwise as seen from above, starting at the pocket (or corner) at the origin.
struct Table {
    std::string preset;  ///< "seven_foot", ..., or "" for a custom outline
    double width = 0.0,
           length = 0.0;         ///< playing surface between nose lines; the bounding box of a custom outline
    Vec2 corner = Vec2::Zero();  ///< its corner of smallest x and y: the origin, except for a custom outline
    std::vector<Cushion> cushions;
    std::vector<Jaw> jaws;
    std::vector<Pocket> pockets;
    bool operator==(const Table&) const = default;
};

/// Foot spot, where racks stand: (w/2, 3l/4) from the table's corner.
Vec2 foot_spot(const Table& table);

}  // namespace carom
