// Which strikes of the cue a scene takes.
#pragma once

#include "carom/engine/scene.h"

namespace carom {

/// [ball radii] Cue offsets beyond this from the centre are refused: with chalk, a tip slips off at about
/// half a radius (static friction of about 0.6 between tip and ball gives sin(atan 0.6) = 0.51), and a miscue
/// is not simulated.
inline constexpr double kMiscueOffset = 0.5;

/// The strike with its numbers brought to what a scene takes; a strike that a scene takes is returned to the
/// bit. The speed, the elevation and the aim go to the nearer end of their ranges. An offset beyond the disc
/// of radius kMiscueOffset goes straight towards the centre, to the rim: its direction stays. The cue's own
/// mass, end mass and restitution are left alone.
/// @throws std::invalid_argument for a number that is not finite
Cue legal_strike(Cue cue);

}  // namespace carom
