#include <stdexcept>
#include <string>

#include "carom/engine/table.h"

namespace carom {
namespace {

// From the rules of the WPBSA, section 1, for a playing area of 3.569 m, scaled for other tables: the baulk
// line from the bottom cushion, the radius of the D, the black spot from the top cushion.
constexpr double kFullLength = 3.569, kBaulk = 0.737, kRadiusOfD = 0.292, kBlackFromTop = 0.324;

}  // namespace

Vec2 spot_on_axis(const Table& table, double y, double aside) {
    return {table.corner.x() + (table.width / 2.0 + aside), table.corner.y() + y};
}

Vec2 head_spot(const Table& table) {
    return spot_on_axis(table, table.length / 4.0);
}

Vec2 center_spot(const Table& table) {
    return spot_on_axis(table, table.length / 2.0);
}

Vec2 foot_spot(const Table& table) {
    return spot_on_axis(table, 3.0 * table.length / 4.0);
}

Vec2 opening_spot(const Table& table) {
    // 182.5 mm to the left of the head spot (rules of the UMB; measured in the first shot of a match:
    // 178.5 +- 2 mm).
    return spot_on_axis(table, table.length / 4.0, -0.1825 * (table.length / 2.84));
}

Vec2 snooker_spot(const Table& table, std::string_view colour) {
    const double scale = table.length / kFullLength, baulk = kBaulk * scale, d = kRadiusOfD * scale;
    if (colour == "yellow") return spot_on_axis(table, baulk, d);
    if (colour == "green") return spot_on_axis(table, baulk, -d);
    if (colour == "brown") return spot_on_axis(table, baulk);
    if (colour == "blue") return center_spot(table);
    if (colour == "pink") return foot_spot(table);
    if (colour == "black") return spot_on_axis(table, table.length - kBlackFromTop * scale);
    throw std::invalid_argument("\"" + std::string(colour) + "\" is not a snooker colour");
}

double radius_of_d(const Table& table) {
    return kRadiusOfD * table.length / kFullLength;
}

}  // namespace carom
