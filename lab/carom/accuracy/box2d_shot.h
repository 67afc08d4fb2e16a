// The same shot in a Box2D world that is stepped as in a game: the result of an engine with fixed time steps.
#pragma once

#include <string>
#include <vector>

#include "carom/engine/record.h"

namespace carom::tools {

struct Box2dOutcome {
    /// At the end, in the order of Record::tracks [m]; of a pocketed ball, the pocket
    std::vector<Vec2> positions;
    std::vector<int> pockets;   ///< per ball, -1: on the table
    std::string first_contact;  ///< the ball that the first moving ball hits first, or ""
    double duration = 0.0;      ///< s
};

/// Plays the start of a record (table, balls, velocities after the cue) in steps of 1/hz.
///
/// Discs without depth: restitution and friction between discs and against cushions and jaws as in the
/// record; rolling resistance as linear damping, set anew in every step to mu_r g / speed, which is the
/// deceleration of rolling. There is no sliding, no top or back spin, no swerve, no height of the cushion;
/// all numbers are float. Ends when all balls rest, or when twice the record's duration and a second have
/// passed.
Box2dOutcome run_box2d(const Record& record, double hz);

}  // namespace carom::tools
