// Racked balls: which ball stands where.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/engine/vec.h"

namespace carom {

enum class RackGame : std::uint8_t { kEightBall, kNineBall, kLine };

struct Rack {
    RackGame game = RackGame::kEightBall;
    double gap = 1e-4;    ///< between neighbours [m]
    double jitter = 0.0;  ///< each coordinate moves by a uniform draw from [-jitter, jitter] [m]
    std::uint64_t seed = 1;
    int count = 5;  ///< balls of a line
};

struct RackedBall {
    int number;  ///< 1 .. 15, 1 .. 9, or 1 .. count
    Vec2 position;
};

/// Places a rack with its apex at `apex`, rows towards +y, ordered by number.
///
/// @param R  ball radius [m]
///
/// Without jitter the rack is the exact mirror image of itself about x = apex.x, bit for bit, and neighbours
/// are 2R + gap apart to within rounding.
///
/// Jitter never makes balls overlap: in each of a hundred rounds every ball in turn, row by row from left to
/// right, draws a place (x, then y) in the box of half-width `jitter` about its slot, and keeps its old one
/// if the new one would overlap. Wide apart, that is a uniform draw; close together, a uniform draw among the
/// racks that are possible. The seed's draws go to the numbers first, then to the jitter.
std::vector<RackedBall> make_rack(const Rack& rack, const Vec2& apex, double R);

}  // namespace carom
