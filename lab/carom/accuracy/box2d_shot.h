// The same shot in a Box2D world stepped as in a game: the result of an engine with fixed time steps.
#pragma once

#include <string>
#include <vector>

#include "carom/engine/record.h"

namespace carom::tools {

struct Box2dOutcome {
    /// At the end, in the order of Record::tracks [m]; for a pocketed ball, the pocket's place
    std::vector<Vec2> positions;
    std::vector<int> pockets;   ///< per ball, -1: on the table
    std::string first_contact;  ///< the ball that the first moving ball hits first, or ""
    double duration = 0.0;      ///< s
};

/// Plays the start of a record (table, balls, velocities after the cue) in steps of 1/hz.
///
/// Discs without depth. Restitution and friction between discs, and against cushions and jaws, match the
/// record; rolling resistance is linear damping, set in every step to mu_r g / speed, the deceleration of
/// rolling. There is no sliding, top or back spin, swerve or cushion height; all numbers are float. Ends when
/// all balls rest, or after twice the record's duration and a second.
Box2dOutcome run_box2d(const Record& record, double hz);

}  // namespace carom::tools
