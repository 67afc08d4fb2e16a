// The tables that come with the program.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/nearest.h"
#include "carom/engine/math.h"
#include "carom/engine/printable.h"
#include "carom/engine/scene.h"
#include "carom/engine/tolerances.h"
#include "scene/sections.h"

namespace carom {
namespace {

/// Dimensions of a table with six pockets. Lengths in m, angles in degrees.
struct PocketTable {
    double length, width;  ///< between nose lines
    double cushion_width;  ///< how far the jaw facings extend behind the nose line
    double nose_height;
    double corner_mouth;   ///< between the points where the facings' lines meet the nose lines
    double corner_angle;   ///< facing against the direction into the pocket (45 degrees to the rails)
    double corner_depth;   ///< pocket centre behind the corner of the nose lines
    double corner_radius;  ///< of the pocket circle
    double corner_jaw_radius;
    double side_mouth;
    double side_angle;  ///< facing against the normal of the rail
    double side_depth;
    double side_radius;
    double side_jaw_radius;
    /// how far the side facing closes in, per length of depth: tan(side_angle) if straight
    double side_run;
};

/// Seven-foot table. The numbers are those of pooltool 0.6.0 for a Showood table. Its side facings end at
/// sin(angle) instead of tan(angle) times the depth, 5e-5 m off the tangent; that is kept, so that the two
/// tables are equal.
PocketTable seven_foot() {
    constexpr double kSideAngle = 7.14;
    return {.length = 1.9812,
            .width = 0.9906,
            .cushion_width = 0.0508,
            .nose_height = 0.64 * 2.0 * 0.028575,
            .corner_mouth = 0.118,
            .corner_angle = 5.3,
            .corner_depth = 0.0417,
            .corner_radius = 0.062,
            .corner_jaw_radius = 0.02095,
            .side_mouth = 0.137,
            .side_angle = kSideAngle,
            .side_depth = 0.0685,
            .side_radius = 0.0645,
            .side_jaw_radius = 0.00795,
            .side_run = sin_cos_deg(kSideAngle).sin};
}

/// [m] Shelf of a corner pocket, from the middle of the mouth to the edge where the ball falls: 1 3/4 in, the
/// middle of the BCA's 1 5/8 to 1 7/8 in and within the WPA's 1 to 2 1/4 in.
constexpr double kCornerShelf = 1.75 * 0.0254;
/// [m] Radius of the point between a nose and a facing: on a pool table only the rubber rounds it.
constexpr double kPointRadius = 0.003;

/// The depth of the pocket's centre that gives this shelf.
double depth_of_shelf(const PocketTable& t, double shelf) {
    return shelf + t.corner_radius - t.corner_mouth / 2.0;
}

/// Nine-foot table. The playing surface is 100 x 50 in. The mouths are the middle of the range in the WPA
/// equipment specifications (corner 4.5 to 4.625 in, side 5 to 5.125 in), and so are the angles between rail
/// and facing (corner 142, side 104 degrees; here they count from 135 and from 90). The nose, at 64 % of the
/// ball's diameter, is within the specified 62.5 to 64.5 %. Cushion width, pocket radii and the depth at the
/// sides are those of the seven-foot table; the shelf there is then 4 mm (specified: 0 to 9.5 mm).
PocketTable nine_foot() {
    PocketTable t = seven_foot();
    t.length = 2.54;
    t.width = 1.27;
    t.corner_mouth = 4.5625 * 0.0254;
    t.corner_angle = 142.0 - 135.0;
    t.corner_depth = depth_of_shelf(t, kCornerShelf);
    t.corner_jaw_radius = t.side_jaw_radius = kPointRadius;
    t.side_mouth = 5.0625 * 0.0254;
    t.side_angle = 104.0 - 90.0;
    t.side_run = tan_deg(t.side_angle);
    return t;
}

/// Eight-foot table: playing surface 92 x 46 in, the eight-foot size of the WPA equipment specifications
/// (tables of 88 x 44 in are sold as eight-foot too). Pockets as on the nine-foot table, because the
/// specification has one set for both.
PocketTable eight_foot() {
    PocketTable t = nine_foot();
    t.length = 92.0 * 0.0254;
    t.width = 46.0 * 0.0254;
    return t;
}

/// Coin-operated bar table, called seven-foot in America: playing surface 80 x 40 in (Valley, Diamond),
/// mouths of Valley's (corner 4 7/8, side 4 3/4 in), angles of the BCA (corner 142, side 103 degrees). The
/// rest is as for the nine-foot table.
PocketTable bar_table() {
    PocketTable t = nine_foot();
    t.length = 80.0 * 0.0254;
    t.width = 40.0 * 0.0254;
    t.corner_mouth = 4.875 * 0.0254;
    t.corner_depth = depth_of_shelf(t, kCornerShelf);
    t.side_mouth = 4.75 * 0.0254;
    t.side_angle = 103.0 - 90.0;
    t.side_run = tan_deg(t.side_angle);
    return t;
}

/// Twelve-foot snooker table. Playing surface 3.569 x 1.778 m (11 ft 8 1/2 in x 5 ft 10 in, rules of the
/// WPBSA, section 1). Nose height 7/5 of the ball's radius (Mathavan, Jackson, Parkin 2010). The pocket
/// templates of the WPBSA are not published: mouths of 89 and 105 mm are commonly quoted (from memory). Jaw
/// radii, depths and pocket radii are chosen to suit them: the jaws are large and round, and a ball falls
/// when its centre passes the corner, or the rail line at the side.
PocketTable snooker_table() {
    constexpr double kSideAngle = 10.0;
    return {.length = 3.569,
            .width = 1.778,
            .cushion_width = 0.0508,
            .nose_height = 1.4 * 0.02625,
            .corner_mouth = 0.089,
            .corner_angle = 0.0,
            .corner_depth = 0.055,
            .corner_radius = 0.050,
            .corner_jaw_radius = 0.100,
            .side_mouth = 0.105,
            .side_angle = kSideAngle,
            .side_depth = 0.055,
            .side_radius = 0.050,
            .side_jaw_radius = 0.040,
            .side_run = tan_deg(kSideAngle)};
}

/// Seven-foot table for English pool: playing surface 6 x 3 ft. Round jaws as on a snooker table, and all of
/// them smaller as the balls are.
PocketTable english_pool_table() {
    constexpr double kBalls = 0.0254 / 0.02625;
    PocketTable t = snooker_table();
    t.length = 1.8288;  // 6 ft
    t.width = 0.9144;
    for (double* length :
         {&t.nose_height, &t.corner_mouth, &t.corner_depth, &t.corner_radius, &t.corner_jaw_radius,
          &t.side_mouth, &t.side_depth, &t.side_radius, &t.side_jaw_radius})
        *length *= kBalls;
    return t;
}

/// A jaw and the straight facing beside it, in the frame
/// of the corner: x and y from the corner into the table.
struct JawAndFacing {
    Vec2 jaw;        ///< centre of the circle
    Vec2 tip, back;  ///< ends of the facing, at the nose and behind it
    /// The same on the other rail of the corner.
    JawAndFacing swapped() const { return {{jaw.y(), jaw.x()}, {tip.y(), tip.x()}, {back.y(), back.x()}}; }
};

/// At the corner pocket, on the short rail. The jaw's circle touches the nose line and the facing.
JawAndFacing corner_jaw(const PocketTable& t) {
    const double angle = 45.0 + t.corner_angle, r = t.corner_jaw_radius;
    const double mouth = t.corner_mouth * sin_cos_deg(45.0).cos;
    const double start = mouth + r / tan_deg((90.0 + angle) / 2.0);
    const SinCos c = sin_cos_deg(angle);
    return {{start, -r},
            {start - r * c.cos, -r + r * c.sin},
            {mouth - t.cushion_width * tan_deg(angle), -t.cushion_width}};
}

/// At the side pocket, on the long rail.
JawAndFacing side_jaw(const PocketTable& t) {
    const double end = (t.length - t.side_mouth) / 2.0, r = t.side_jaw_radius;
    const double y = end - r / tan_deg((90.0 + t.side_angle) / 2.0);
    const SinCos s = sin_cos_deg(t.side_angle);
    return {{-r, y}, {-r + r * s.sin, y + r * s.cos}, {-t.cushion_width, end + t.cushion_width * t.side_run}};
}

/// Clockwise from the corner at the origin: head-left corner, left rail, foot rail, right rail, head rail.
/// Each quarter of the table is the mirror image of the one before it.
Table build(const char* preset, const PocketTable& t) {
    const JawAndFacing short_rail = corner_jaw(t), long_rail = short_rail.swapped(), side = side_jaw(t);
    const double w = t.width, l = t.length, h = t.nose_height;
    const double start = long_rail.jaw.y(), end = side.jaw.y();  // of the straight nose on the long rail
    const double diagonal = t.corner_depth * sin_cos_deg(45.0).cos;
    Table table;
    table.preset = preset;
    table.width = w;
    table.length = l;
    for (int quarter = 0; quarter < 4; ++quarter) {
        const bool foot = quarter == 1 || quarter == 2, right = quarter >= 2, to_corner = quarter % 2 == 1;
        const auto at = [&](const Vec2& p) {
            return Vec2(right ? w - p.x() : p.x(), foot ? l - p.y() : p.y());
        };
        const std::string across = foot ? "foot" : "head", along = right ? "right" : "left";
        const std::string corner = fmt::format("{}-{} corner", across, along),
                          middle = along + " side pocket";
        std::vector<Cushion> cushions;
        std::vector<Jaw> jaws;
        const auto add = [&](const std::string& place, const std::string& of, const JawAndFacing& part,
                             double r) {
            cushions.push_back(
                {"", at(part.back), at(part.tip), h, fmt::format("{}, facing of the {}", place, of)});
            jaws.push_back({"", at(part.jaw), r, h, fmt::format("{}, jaw of the {}", place, of)});
        };
        add(corner, across + " rail", short_rail, t.corner_jaw_radius);
        add(corner, along + " rail", long_rail, t.corner_jaw_radius);
        const Vec2 from = at({0.0, to_corner ? end : start}), to = at({0.0, to_corner ? start : end});
        cushions.push_back({"", from, to, h, fmt::format("{} rail, {} half", along, across)});
        add(middle, across + " half", side, t.side_jaw_radius);
        table.pockets.push_back(
            {"", at({-diagonal, -diagonal}), t.corner_radius, kPocketDepth, corner + " pocket"});
        if (to_corner) {
            std::reverse(cushions.begin(), cushions.end());
            std::reverse(jaws.begin(), jaws.end());
            const double y = foot ? l : 0.0, x = right ? w - start : start;
            cushions.push_back({"", {x, y}, {right ? start : w - start, y}, h, across + " rail"});
        } else {
            table.pockets.push_back({"", at({-t.side_depth, l / 2.0}), t.side_radius, kPocketDepth, middle});
        }
        table.cushions.insert(table.cushions.end(), cushions.begin(), cushions.end());
        table.jaws.insert(table.jaws.end(), jaws.begin(), jaws.end());
    }
    detail::number_parts(table);
    return table;
}

/// Carom table, 2.84 x 1.42 m between nose lines, nose 37 mm above the cloth (UMB rules), no pockets.
Table carom_table() {
    const double w = 1.42, l = 2.84, h = 0.037;
    Table table;
    table.preset = "carom";
    table.width = w;
    table.length = l;
    table.cushions = {{"", {0.0, 0.0}, {0.0, l}, h, "left rail"},
                      {"", {0.0, l}, {w, l}, h, "foot rail"},
                      {"", {w, l}, {w, 0.0}, h, "right rail"},
                      {"", {w, 0.0}, {0.0, 0.0}, h, "head rail"}};
    detail::number_parts(table);
    return table;
}

}  // namespace

Vec2 foot_spot(const Table& table) {
    return {table.corner.x() + table.width / 2.0, table.corner.y() + 3.0 * table.length / 4.0};
}

Table make_table(std::string_view preset) {
    if (preset == "seven_foot") return build("seven_foot", seven_foot());
    if (preset == "seven_foot_bar") return build("seven_foot_bar", bar_table());
    if (preset == "nine_foot") return build("nine_foot", nine_foot());
    if (preset == "eight_foot") return build("eight_foot", eight_foot());
    if (preset == "snooker") return build("snooker", snooker_table());
    if (preset == "english_pool") return build("english_pool", english_pool_table());
    if (preset == "carom" || preset == "carom_ten_foot") return carom_table();
    throw std::invalid_argument(
        fmt::format("unknown table preset {}{}", in_quotes(preset),
                    did_you_mean(preset, {std::begin(kTablePresets), std::end(kTablePresets)})));
}

}  // namespace carom
