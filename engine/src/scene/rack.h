// Racked balls and their positions.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/kernel/splitmix64.h"

namespace carom {

struct RackedBall {
    std::string id;  ///< "1", "2", ..., or a colour
    Vec2 position;
    double radius = 0.0;
    /// Puts it on the cloth, with a mass proportional to the cube of the radius.
    void put(BallStart& ball, const BallSize& common) const;
};

int balls_of(const Rack& rack);

/// Places a rack, ordered by number, then colours with spots.
///
/// @param R  ball radius [m]
///
/// With rack.radius_sd, the radii are normal about R, truncated at 2.5 standard deviations, from their own
/// stream of draws. Unlike balls of a rack are pressed together until neighbours are rack.gap apart
/// (press()), then jittered.
///
/// The apex, or rack.spot_ball (which must be in the rack), is at rack.position, by default the foot spot
/// (snooker: behind the pink, a diameter and a gap away). Rows run towards +y, turned by rack.angle_deg about
/// that ball. The colours of snooker and the balls of three-cushion are on their spots, whose distances scale
/// with the table's length; they have no jitter.
///
/// Without jitter the rack is its own exact mirror image about x = apex.x, bit for bit, and neighbours are 2R
/// + gap apart to within rounding.
///
/// Jitter never makes balls overlap. In each of a hundred rounds every ball in turn, row by row from left to
/// right, draws a position (x, then y) in the box of half-width `jitter` around its slot, and keeps its old
/// one if the new one would overlap. For balls far apart, that is a uniform draw; close together, a uniform
/// draw among the possible racks. The seed determines the numbers first, then the jitter.
///
/// A scatter has no rack: each ball in turn is uniform over the bed of the table, except within rack.gap of
/// cushions, jaws and earlier balls, and in the pockets.
///
/// @param others  balls already on the table, for a scatter
/// @throws std::invalid_argument if a scatter finds no room
std::vector<RackedBall> make_rack(const Rack& rack, const Table& table, double R,
                                  std::span<const BallStart> others = {});

/// Moves balls of unlike size from the lattice of balls of radius R until neighbours are `gap` apart. N balls
/// have 2N - 3 relative degrees of freedom, and a rack with a ball in the middle of six others has more
/// contacts than that: each such ball leaves one contact open. Slightly different forces draw neighbours
/// together and decide which contact it is.
///
/// @param fixed   the ball that stays in place; the rack as a whole does not rotate
/// @param random  determines the forces
/// @throws std::invalid_argument if the balls do not come to rest (radii that differ by tens of percent)
void press(std::vector<Vec2>& places, std::span<const double> radii, double R, double gap, std::size_t fixed,
           SplitMix64& random);

}  // namespace carom
