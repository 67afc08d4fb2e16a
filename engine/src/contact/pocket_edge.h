// The edge of a pocket: a ball whose centre is beyond it falls, and may come back. Source:
// docs/reference/physics.md, "Pockets".
#pragma once

#include <optional>

#include "carom/engine/geometry.h"
#include "carom/engine/vec.h"
#include "contact/detect.h"

namespace carom {

inline bool is_inside(const Pocket& pocket, const Vec2& here) {
    return length(here - pocket.center) < pocket.radius;
}

/// The pocket into which a ball at this position falls: the circle that contains it most deeply.
int pocket_under(const Geometry& geometry, const Vec2& here);

/// [s] Time until a ball on a straight path leaves the circle from inside; kNever if it does not move.
double time_to_edge(const Vec2& r, const Vec2& v, const Vec2& center, double radius);

/// Whether cloth lies beyond the edge of the pocket at this position, rather than the pocket's back or the
/// area behind the rails. The cloth lies on the table's side of the pocket, and between two jaws a ball of
/// radius R gets at most R beyond the line of the rails.
bool is_bed(const Table& table, const Pocket& pocket, const Vec2& here, double R);

/// [m/s] Speed away from the edge of a ball that reaches it at the speed v_n with its centre `sunk` ball
/// radii below the height of a ball on the cloth; nothing if it does not come up. It hits the edge at an
/// angle whose cosine is 1 - sunk, keeps its tangential speed (no restitution, no friction), and rises by
/// sunk R: v^2 = ((1 - sunk) v_n)^2 - 2 g R sunk.
std::optional<double> climbs(double v_n, double sunk, double R, double gravity);

}  // namespace carom
