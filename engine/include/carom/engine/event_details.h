// Where an event happened and how fast and hard it was, derived from the record.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/record.h"

namespace carom {

/// A ball just before and just after an event. The record does not separate some simultaneous events, such as
/// a blow from above and the cloth below it; the states are then those before, or after, all of them.
struct BallAtEvent {
    int ball = -1;
    BallState before, after;
    bool before_known = true, after_known = true;  ///< whether the state belongs to this event alone
};

/// NaN: an event of this kind has no such value, or the record does not contain it.
struct EventDetails {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    /// Event::a, then Event::b if it is a ball; for a cluster, all its balls, a and b first.
    std::vector<BallAtEvent> balls;
    /// Contact point of ball a [m]; at the height of the nose for a cushion or a jaw.
    Vec3 point = Vec3::Constant(kNone);
    /// Unit vector along which ball a is pushed: away from the other ball's centre, out of the cushion, or
    /// up.
    Vec3 normal = Vec3::Constant(kNone);
    /// Angle between the line of the impact and the velocity of a relative to its partner [rad]: the cut
    /// angle of two balls; 0 for a full hit and for a head-on cushion hit.
    double cut = kNone;
    double closing = kNone;  ///< approach speed along the normal [m/s]
    double impulse = kNone;  ///< received by ball a [N s]
    double lost = kNone;     ///< energy lost by the balls of this event [J]
    /// Position along the rail: 0 to 4 on short rails and 0 to 8 on long ones, from the table's corner of
    /// smallest x and y. Only for cushions of a table with a width and a length.
    double diamond = kNone;
};

/// @param event  index into Record::events
EventDetails details_of(const Record& record, std::size_t event);

/// The partner of ball a, for people: "left rail, head half", "corner pocket, foot left"; its id if it has no
/// name; "" without a partner.
std::string met_name(const Record& record, const Event& event);

/// The point on a rail's nose line (head, foot, left or right) at this diamond, counted as in
/// EventDetails::diamond; nothing for another rail or an endless cloth.
std::optional<Vec2> diamond_place(const Table& table, std::string_view rail, double number);

/// Where a ball at `center` touches a cushion or a jaw.
struct CushionPoint {
    Vec3 point;                            ///< [m] at the height of the nose
    Vec2 normal;                           ///< unit, out of the cushion
    double diamond = EventDetails::kNone;  ///< as EventDetails::diamond
};
CushionPoint cushion_point(const Table& table, Partner partner, int part, const Vec2& center);

/// [-] Diamonds along a long and a short rail.
inline constexpr double kLongRail = 8.0, kShortRail = 4.0;

/// The point of this cushion, or the centre of this jaw, that is nearest to a position.
Vec2 nearest_point(const Table& table, Partner partner, int part, const Vec2& place);

/// The table with short straight cushions in place of its arcs, for drawing.
Table without_arcs(const Table& table);

/// A number of an event in tables: `carom simulate --events`, Python's Record.event_details.
struct EventColumn {
    const char* name;
    const char* unit;  ///< "" for none
    const char* what;
};
std::span<const EventColumn> event_columns();

/// The values of event_columns() for one event. @param row  one element per column; NaN without a value
void event_row(const Record& record, std::size_t event, std::span<double> row);

}  // namespace carom
