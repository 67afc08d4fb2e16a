// Shared by the two halves of the aiming aid.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "carom/games/aim.h"
#include "carom/games/shot.h"

namespace carom::games::detail {

/// [-] Cosine of the largest angle between a path and the axis of a pocket's mouth at which a ball that rubs
/// a facing is expected to fall: 50 degrees. Along a rail into the corner it is 45.
inline constexpr double kSteepest = 0.643;

/// The two jaws nearest to a pocket, between which its mouth is; empty if there are none.
std::optional<std::pair<const Jaw*, const Jaw*>> jaws_of(const Table& table, const Pocket& pocket);

/// @throws std::invalid_argument if there is none
const BallStart& ball_of(const Scene& scene, std::string_view id);
const Pocket& pocket_of(const Scene& scene, std::string_view id);

/// The paths of a ball of radius R from a place into a pocket of the table; other balls are ignored.
PocketLine line_from(const Table& table, const Pocket& pocket, const Vec2& from, double R);

/// The aim at a ball at the vector `way` from the cue ball [degrees]. @param both  the sum of the two radii
/// [m]
/// @param hit  0 is full, 1 and -1 pass its left and right edge, without allowance for squirt
double hit_aim_deg(const Vec2& way, double both, double hit);

/// The first thing after `time` that ends a ball's straight run: a cushion, a ball, a pocket, or rest (null).
const Event* next_stop(const Record& record, int ball, double time);
/// Deviation of a ball from the direction `towards` between a time and a stop: the sine of the angle,
/// positive to the left; empty if it does not move.
std::optional<double> off_line(const Record& record, int ball, double from, const Event* stop,
                               const Vec2& towards);
/// Why the cue ball does not hit this ball first without a cushion, or "".
std::string missed(const Record& record, const Shot& shot, int ball);

}  // namespace carom::games::detail
