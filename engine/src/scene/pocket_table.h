// A table with six pockets by its dimensions, and their changes by the measures of a scene.
#pragma once

#include <optional>
#include <string>

#include "carom/engine/table.h"

namespace carom {

/// One kind of pocket, at the corners or at the sides. Lengths in m, angles in degrees.
struct PocketShape {
    double mouth;       ///< between the points where the facings' lines meet the nose lines
    double angle;       ///< facing against the axis of the pocket: 0 for parallel facings
    double depth;       ///< of the centre behind the corner of the nose lines, or behind the nose line
    double radius;      ///< of the circle that balls fall into
    double jaw_radius;  ///< of the point between nose and facing
};

struct PocketTable {
    double length, width;  ///< between nose lines
    double rail_width;     ///< how far the facings extend behind the nose line
    double nose_height;
    PocketShape corner, side;
    /// convergence of the side facing per length of depth: tan(side.angle) if straight
    double side_run;
};

/// Replaces the dimensions that the measures set. A measure within rounding of the table's own changes no
/// bit.
PocketTable with_measures(PocketTable table, const Measures& changed);

Measures measures_of(const PocketTable& table);

struct Misfit {
    const char* section;  ///< "corner_pockets", or "" for [table] itself
    const char* key;
    std::string message;
};

/// The first misfit of a table for balls between two radii [m]; nothing if the table is playable.
std::optional<Misfit> misfit(const PocketTable& table, double smallest_ball, double largest_ball);

/// The dimensions of a preset with pockets; nothing for other presets.
std::optional<PocketTable> pocket_table(std::string_view preset);

}  // namespace carom
