// Where an event happened, how fast and how hard. Everything here follows from the record.
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

/// A ball just before and just after an event. The record does not tell apart some events of one instant,
/// such as a blow from above and the cloth below: then a state is that before, or after, all of them.
struct BallAtEvent {
    int ball = -1;
    BallState before, after;
    bool before_known = true, after_known = true;  ///< whether it is that of this event alone
};

/// NaN marks what an event of this kind does not have, or what the record does not contain.
struct EventDetails {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    /// Event::a, then Event::b if it is a ball; for a cluster all its balls, with a and b first.
    std::vector<BallAtEvent> balls;
    /// Where ball a touches what it meets, at the height of the nose for a cushion or a jaw [m].
    Vec3 point = Vec3::Constant(kNone);
    /// Unit vector along which ball a is pushed: from the other ball's centre, out of the cushion, up.
    Vec3 normal = Vec3::Constant(kNone);
    /// Angle between the velocity of a relative to what it meets and the line of the impact [rad]: the cut
    /// angle of two balls; 0 for a full hit and for a cushion met head-on.
    double cut = kNone;
    double closing = kNone;  ///< speed at which the two approach along the normal [m/s]
    double impulse = kNone;  ///< that ball a received [N s]
    double lost = kNone;     ///< energy that the balls of this event lost [J]
    /// Position along the rail: 0 to 4 on short rails and 0 to 8 on long ones, from the table's corner of
    /// smallest x and y. Only for cushions of a table with a width and a length.
    double diamond = kNone;
};

/// @param event  index into Record::events
EventDetails details_of(const Record& record, std::size_t event);

/// The partner of ball a, for people: "left rail, head half", "corner pocket, foot left"; its id if it has no
/// name, and "" for nothing.
std::string met_name(const Record& record, const Event& event);

/// The place on the nose line of a rail (head, foot, left or right) at this diamond, counted as in
/// EventDetails::diamond; nothing for another rail or an endless cloth.
std::optional<Vec2> diamond_place(const Table& table, std::string_view rail, double number);

/// [-] Diamonds of a long and of a short rail.
inline constexpr double kLongRail = 8.0, kShortRail = 4.0;

/// The point of the cushion, or the centre of the jaw, of this event that is nearest to a position.
Vec2 nearest_point(const Table& table, const Event& event, const Vec2& place);

/// The table with short straight cushions in place of its arcs, for drawing.
Table without_arcs(const Table& table);

/// A number of an event in tables: `carom simulate --events`, Python's Record.event_details.
struct EventColumn {
    const char* name;
    const char* unit;  ///< "" for none
    const char* what;
};
std::span<const EventColumn> event_columns();

/// The numbers of event_columns() for one event. @param row  one element for each; NaN if there is no value
void event_row(const Record& record, std::size_t event, std::span<double> row);

}  // namespace carom
