// Racked balls: which ball stands where.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
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

/// No place is left for a jittered ball. what() tells the remedy.
class RackError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Places a rack with its apex at `apex`, rows towards +y, ordered by number.
///
/// @param R  ball radius [m]
///
/// Without jitter the rack is the exact mirror image of itself about x = apex.x, bit for bit, and neighbours
/// are 2R + gap apart to within rounding. With jitter, balls are placed row by row from left to right, and a
/// draw (x, then y) that would overlap a ball already placed is drawn again; the seed's draws go to the
/// numbers first, then to the jitter.
/// @throws RackError when a ball finds no place in 10 000 draws
std::vector<RackedBall> make_rack(const Rack& rack, const Vec2& apex, double R);

}  // namespace carom
