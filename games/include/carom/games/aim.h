// Aim help: by geometry where that is exact, and by playing the shot where it is not.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/scene.h"

namespace carom::games {

/// Angle of a direction from +x towards +y [degrees], from -180
/// to 180; 0 for no direction, NaN where a number is none.
double direction_deg(const Vec2& direction);

/// Where the cue ball's centre is when it meets a ball and sends it straight along `towards` (a unit vector):
/// without throw.
/// @param both  the sum of the two radii [m]
Vec2 ghost_ball(const Vec2& object, const Vec2& towards, double both);

/// Angle between the cue ball's way to the ghost ball and the object
/// ball's way [degrees]: 0 is straight; from 90 on there is no such cut.
double cut_angle_deg(const Vec2& cue, const Vec2& ghost, const Vec2& towards);

/// The straight ways of a ball into a pocket that touch neither the
/// noses of cushions nor jaws; facings behind them may be rubbed.
struct PocketLine {
    int pocket = -1;              ///< index of Table::pockets
    Vec2 towards = Vec2::Zero();  ///< unit vector in the middle of these ways
    double width_deg = 0.0;       ///< how far apart the outermost of them are; 0: there is none
    double distance = 0.0;        ///< [m] from the ball to where it begins to fall
    std::string in_the_way;       ///< the nearest ball on the middle way, or ""
    bool open() const { return width_deg > 0.0 && in_the_way.empty(); }
    bool operator==(const PocketLine&) const = default;
};

/// A line for every pocket of the table. @param cue_ball  a ball that is in nobody's way, as it will have
/// moved
/// @throws std::invalid_argument where the scene has no such ball
std::vector<PocketLine> pocket_lines(const Scene& scene, std::string_view ball,
                                     std::string_view cue_ball = "cue");

/// An aim that was looked for.
struct Aim {
    std::optional<Cue> cue;      ///< the strike, which was played and does what was asked; nothing: see `why`
    double geometric_deg = 0.0;  ///< aim_pot: the aim at the ghost ball, without throw, squirt and swerve
    double cut_deg = 0.0;        ///< aim_pot: of that aim
    std::string cushion;         ///< bank_routes: the cushion that the ball meets
    int shots = 0;               ///< that were played to find it
    std::string why;             ///< why there is none; "" where there is one
};

/// The aim that pots a ball into a pocket: from the ghost ball, corrected by playing the shot until the ball
/// runs down the middle of its ways.
/// @param how  the strike; its aim is not read
/// @throws std::invalid_argument for a ball or a pocket that is not there, and where a shot does not end at
/// rest; SceneError and SimulationError as the shots do
Aim aim_pot(const Scene& scene, const Cue& how, std::string_view ball, std::string_view pocket);

/// Aims that pot a ball by way of one cushion, found by playing aims from one edge of the ball to the other:
/// at most one for every straight cushion, in the order of the aims from right to left. Empty where there is
/// none. What it may meet on its way back counts.
/// @throws as aim_pot
std::vector<Aim> bank_routes(const Scene& scene, const Cue& how, std::string_view ball,
                             std::string_view pocket);

}  // namespace carom::games
