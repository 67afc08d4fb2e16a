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

/// Places a rack, ordered by number; colours that have a spot of their own come last.
///
/// @param R  ball radius [m]
///
/// The apex stands on the foot spot (snooker: behind the pink, a diameter and a gap away), rows towards +y.
/// Snooker's colours stand on their spots (WPBSA rules, section 1: baulk line 737 mm from the bottom cushion, D
/// of radius 292 mm, blue in the middle, pink at three quarters, black 324 mm from the top cushion), scaled with
/// the length where the table is not a snooker table. Three-cushion: red on the foot spot, yellow on the head
/// spot, white 182.5 mm to the left of it (opening position of the UMB rules, recalled). Colours do not jitter.
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
