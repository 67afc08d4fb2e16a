// The edge of a pocket: a ball whose centre is beyond it falls, and may
// come back over it. Source: docs/reference/physics.md, "Pockets".
#pragma once

#include <optional>

#include "carom/engine/geometry.h"
#include "carom/engine/vec.h"
#include "contact/detect.h"

namespace carom {

/// The pocket in whose circle a falling ball is: the one whose edge is farthest outside of this place.
int pocket_under(const Geometry& geometry, const Vec2& here);

/// [s] Time until a ball that moves on straight leaves the circle from inside; kNever if it does not move.
double time_to_edge(const Vec2& r, const Vec2& v, const Vec2& center, double radius);

/// Whether there is cloth behind the edge of the pocket at this place, and not the pocket's
/// back or what is behind the rails: the cloth lies on the table's side of the pocket, and
/// between two jaws a ball of radius R comes at most R over the line of the rails.
bool is_bed(const Table& table, const Pocket& pocket, const Vec2& here, double R);

/// [m/s] Speed away from the edge of a ball that comes to it at the speed v_n with its centre `sunk` ball
/// radii below that of a ball on the cloth; nothing where it does not come up. It meets the edge at an angle
/// whose cosine is 1 - sunk, keeps what is tangential to it (no restitution, no friction), and rises by sunk
/// R: v^2 = ((1 - sunk) v_n)^2 - 2 g R sunk.
std::optional<double> climbs(double v_n, double sunk, double R, double gravity);

}  // namespace carom
