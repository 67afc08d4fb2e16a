// The strokes that a scene accepts.
#pragma once

#include <optional>
#include <string>

#include "carom/engine/scene.h"

namespace carom {

/// [ball radii] The largest cue offset from the centre: with chalk, a tip slips off at about half a radius
/// (static friction of about 0.6 between tip and ball gives sin(atan 0.6) = 0.51), and miscues are not
/// simulated.
inline constexpr double kMiscueOffset = 0.5;

/// The nearest stroke that a scene accepts; a valid one is returned unchanged. Speed, elevation and aim are
/// clamped to their ranges. An offset outside the disc of radius kMiscueOffset moves straight towards the
/// centre, to the rim. The cue's own mass, end mass and restitution stay as they are.
/// @throws std::invalid_argument for a number that is not finite
Cue legal_strike(Cue cue);

/// [-] The speed of a ball on the cloth for each m/s of the cue.
double ball_speed_gain(Cue cue, const BallSize& ball);

/// Whether the cue itself has room: one of 1.47 m, 13 mm thick at the tip and 29 mm at the butt.
struct CueRoom {
    std::string in;  ///< what it would be in: "cushion c3", "ball 7"; "" if nothing
    /// [degrees] The least elevation from its own on that clears all of it, up to 89; nothing if none does.
    std::optional<double> clears_deg;
};
CueRoom room_for(const Scene& scene, const Cue& cue);

/// A sentence for people if the scene's cue has no room where it is; "" if it has, or nearly.
std::string room_note(const Scene& scene);

}  // namespace carom
