// Racked balls: which ball stands where.
#pragma once

#include <string>
#include <vector>

#include "carom/engine/scene.h"

namespace carom {

struct RackedBall {
    std::string id;  ///< "1", "2", ..., or a colour
    Vec2 position;
};

/// How many numbered balls a rack has.
int balls_of(const Rack& rack);

/// Places a rack, ordered by number; colours that have a spot of their own come last.
///
/// @param R  ball radius [m]
///
/// The apex, or rack.spot_ball, which has to be in the rack, stands at rack.position, or else on the foot
/// spot (snooker: behind the pink, a diameter and a gap away). Rows run towards +y, turned by rack.angle_deg
/// about that ball. The colours of snooker and the balls of three-cushion stand on their spots, whose
/// distances (rack.cpp) are scaled with the length of the table; they do not jitter.
///
/// Without jitter the rack is the exact mirror image of itself about x = apex.x, bit for bit, and neighbours
/// are 2R + gap apart to within rounding.
///
/// Jitter never makes balls overlap: in each of a hundred rounds every ball in turn, row by row from left to
/// right, draws a place (x, then y) in the box of half-width `jitter` about its slot, and keeps its old one
/// if the new one would overlap. Wide apart, that is a uniform draw; close together, a uniform draw among the
/// racks that are possible. The seed's draws go to the numbers first, then to the jitter.
std::vector<RackedBall> make_rack(const Rack& rack, const Table& table, double R);

}  // namespace carom
