// Spots of a table, and where a ball is respotted: exactly, and never overlapping another ball.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "carom/engine/scene.h"

namespace carom::games {

/// A ball that lies on the table.
struct Lying {
    Vec2 place = Vec2::Zero();  ///< [m]
    double R = 0.0;             ///< [m]
    double gap = 0.0;           ///< [m] least distance of others; 0: they may touch it
};

// The spots of a table's balls (carom/engine/table.h).
using carom::center_spot;
using carom::head_spot;
using carom::kColours;
using carom::radius_of_d;
using carom::snooker_spot;

/// Where the cue ball may be placed.
enum class InHand : std::uint8_t { kNo, kAnywhere, kHeadString, kD };
constexpr auto names_of(InHand) {
    return std::array{"no", "anywhere", "head string", "D"};
}
/// y of the head string [m]. The area behind it reaches to the head rail, at the y of the table's corner.
double head_string(const Table& table);
/// Whether a ball with its centre there is in the area: for kHeadString behind the string and not on it, for
/// kD in the D or on its lines.
bool in_area(const Table& table, InHand area, const Vec2& place);

/// Whether a ball of radius R may lie there: it overlaps no ball, and keeps the gap of each.
bool is_free(const Vec2& place, double R, std::span<const Lying> others);

/// Whether a ball of radius R that moves straight from one place to another hits none of them; grazing counts
/// as a hit.
bool is_clear(const Vec2& from, const Vec2& to, double R, std::span<const Lying> others);

/// The free place nearest to `from` along `direction` (a unit vector), at most `reach` away; empty if all of
/// it is blocked. A ball in the way is touched exactly (to rounding, and never overlapped), or at its gap.
std::optional<Vec2> nearest_free(const Vec2& from, const Vec2& direction, double reach, double R,
                                 std::span<const Lying> others);

/// [m] Distance of a spotted ball from the cue ball (WPA 1.4), and of a snooker colour from every ball: half
/// a millimetre, which is visible.
inline constexpr double kSpotGap = 5e-4;

/// The place of a pool ball spotted on the long string: `spot`, or as near to it as possible towards the foot
/// rail; if that is all blocked, towards the head rail (WPA 1.4). @throws std::invalid_argument if the whole
/// string is blocked
Vec2 spot_on_long_string(const Table& table, const Vec2& spot, double R, std::span<const Lying> others);

/// The place of a spotted snooker colour: its own spot; else the free spot of the highest colour; else as
/// near to its own spot as possible, towards the top (foot) cushion, or towards the other one if there is no
/// room. `others` may have any gap; a ball that would be touched occupies the spot.
Vec2 spot_snooker(const Table& table, std::string_view colour, double R, std::span<const Lying> others);

}  // namespace carom::games
