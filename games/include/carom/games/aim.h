// Aiming aid: by geometry if that is exact, otherwise by playing the shot.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/row.h"
#include "carom/engine/scene.h"

namespace carom::games {

/// Angle of a direction from +x towards +y [degrees], from -180 to 180; 0 for a zero vector, NaN if a
/// component is NaN.
double direction_deg(const Vec2& direction);

/// Position of the cue ball's centre when it hits a ball and sends it straight along `towards` (a unit
/// vector), ignoring throw.
/// @param both the sum of the two radii [m]
Vec2 ghost_ball(const Vec2& object, const Vec2& towards, double both);

/// Angle between the cue ball's path to the ghost ball and the object ball's path [degrees]: 0 is straight;
/// from 90 on there is no such cut.
double cut_angle_deg(const Vec2& cue, const Vec2& ghost, const Vec2& towards);

/// The ball may rub the facings behind the noses.
struct PocketLine {
    std::string pocket;
    Vec2 towards = Vec2::Zero(), ghost = Vec2::Zero();
    double width_deg = 0.0, distance = 0.0;
    std::string in_the_way;
    bool open() const { return width_deg > 0.0 && in_the_way.empty(); }
    bool operator==(const PocketLine&) const = default;
};
constexpr auto rows_of(const PocketLine*) {
    return described(
        "PocketLine", "The straight paths of a ball into a pocket that touch neither cushion noses nor jaws.",
        row<&PocketLine::pocket>("pocket", "Its id."),
        row<&PocketLine::towards>("towards", "Unit vector in the middle of these paths."),
        row<&PocketLine::ghost>("ghost",
                                "Centre of the cue ball that sends the ball there, without throw [m]."),
        row<&PocketLine::width_deg>("width_deg", "Angle between the outermost paths; 0 if there is none."),
        row<&PocketLine::distance>("distance", "From the ball to the point where it begins to fall [m]."),
        row<&PocketLine::in_the_way>("in_the_way", "The nearest ball on the middle path, or \"\"."),
        row<&PocketLine::open>("open", "There is such a path, and no ball blocks the middle one."));
}

/// One line per pocket of the table. @param cue_ball a ball that blocks no path, because it will have moved
/// @throws std::invalid_argument if the scene has no such ball
std::vector<PocketLine> pocket_lines(const Scene& scene, std::string_view ball,
                                     std::string_view cue_ball = "cue");

struct Aim {
    std::optional<double> aim_deg;
    double geometric_deg = 0.0, cut_deg = 0.0;
    std::string cushion;
    int shots = 0;
    std::string why;
    bool operator==(const Aim&) const = default;
};
constexpr auto rows_of(const Aim*) {
    return described(
        "Aim", "The result of a search for an aim.",
        row<&Aim::aim_deg>("aim_deg", "Of a strike that was played and pots the ball; null: see `why`."),
        row<&Aim::geometric_deg>("geometric_deg",
                                 "Of a pot: at the ghost ball, without throw, squirt and swerve."),
        row<&Aim::cut_deg>("cut_deg", "Of a pot: the cut angle of that aim."),
        row<&Aim::cushion>("cushion", "Of a bank: the cushion that the ball hits."),
        row<&Aim::shots>("shots", "Played in the search."),
        row<&Aim::why>("why", "Why there is no aim; \"\" if there is one."));
}

/// The aim that pots a ball into a pocket: it starts at the ghost ball, and is corrected by playing the shot
/// until the ball runs down the middle of its paths.
/// @param how the strike; its aim is ignored
/// @throws std::invalid_argument for a ball or a pocket that does not exist, and if a shot does not end at
/// rest; SceneError and SimulationError as the shots do
Aim aim_pot(const Scene& scene, const Cue& how, std::string_view ball, std::string_view pocket);

/// Aims that pot a ball off one cushion, found by playing aims from one edge of the ball to the other. At
/// most one per straight cushion, in the order of the aims from right to left; empty if there is none.
/// Contacts on the return path are taken into account.
/// @throws as aim_pot
std::vector<Aim> bank_routes(const Scene& scene, const Cue& how, std::string_view ball,
                             std::string_view pocket);

}  // namespace carom::games
