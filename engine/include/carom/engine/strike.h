// Limits of the cue's stroke.
#pragma once

#include <optional>
#include <string>

#include "carom/engine/scene.h"

namespace carom {

/// [ball radii] Largest cue offset from the centre: with chalk, a tip slips off at about half a radius
/// (static friction of about 0.6 between tip and ball gives sin(atan 0.6) = 0.51). Miscues are not simulated.
inline constexpr double kMiscueOffset = 0.5;

/// The nearest legal stroke; a legal one is returned unchanged. Speed, elevation and aim are clamped to their
/// ranges. An offset outside the disc of radius kMiscueOffset moves straight towards the centre, to the rim.
/// The cue's mass, end mass and restitution are kept.
/// @throws std::invalid_argument for a number that is not finite
Cue legal_strike(Cue cue);

/// [-] Speed of a ball on the cloth per m/s of cue speed.
double ball_speed_gain(Cue cue, const BallSize& ball);

/// Whether the cue has room: 1.47 m long, 13 mm thick at the tip and 29 mm at the butt.
struct CueRoom {
    std::string in;  ///< the obstacle: "cushion c3", "ball 7"; "" if none
    /// [degrees] The smallest elevation above the present one, up to 89, that clears everything; nothing if
    /// none does.
    std::optional<double> clears_deg;
};
CueRoom room_for(const Scene& scene, const Cue& cue);

/// A sentence for people if the scene's cue has no room; "" if it has, or nearly.
std::string room_note(const Scene& scene);

}  // namespace carom
