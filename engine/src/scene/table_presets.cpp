// The built-in tables.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/nearest.h"
#include "carom/engine/math.h"
#include "carom/engine/printable.h"
#include "carom/engine/scene.h"
#include "carom/engine/tolerances.h"
#include "scene/pocket_table.h"
#include "scene/sections.h"

namespace carom {
namespace {

/// Seven-foot table, with pooltool 0.6.0's numbers for a Showood table. Its side facings end at sin(angle)
/// instead of tan(angle) times the depth, 5e-5 m off the tangent; this is kept, so that the two tables are
/// equal.
PocketTable seven_foot() {
    constexpr double kSideAngle = 7.14;
    return {.length = 1.9812,
            .width = 0.9906,
            .rail_width = 0.0508,
            .nose_height = 0.64 * 2.0 * 0.028575,
            .corner = {.mouth = 0.118, .angle = 5.3, .depth = 0.0417, .radius = 0.062, .jaw_radius = 0.02095},
            .side = {.mouth = 0.137,
                     .angle = kSideAngle,
                     .depth = 0.0685,
                     .radius = 0.0645,
                     .jaw_radius = 0.00795},
            .side_run = sin_cos_deg(kSideAngle).sin};
}

/// [m] Shelf of a corner pocket, from the middle of the mouth to the edge of the hole: 1 3/4 in, the middle
/// of the BCA's 1 5/8 to 1 7/8 in and within the WPA's 1 to 2 1/4 in.
constexpr double kCornerShelf = 1.75 * 0.0254;
/// [m] Radius of the point between a nose and a facing: on a pool table only the rubber rounds it.
constexpr double kPointRadius = 0.003;

double depth_of_shelf(const PocketTable& t, double shelf) {
    return shelf + t.corner.radius - t.corner.mouth / 2.0;
}

/// Nine-foot table. The playing surface is 100 x 50 in. The mouths are the middle of the range in the WPA
/// equipment specifications (corner 4.5 to 4.625 in, side 5 to 5.125 in), and so are the angles between rail
/// and facing (corner 142, side 104 degrees; here measured from 135 and from 90). The nose, at 64 % of the
/// ball's diameter, is within the specified 62.5 to 64.5 %. Cushion width, pocket radii and the depth at the
/// sides are as on the seven-foot table; the shelf there is then 4 mm (specified: 0 to 9.5 mm).
PocketTable nine_foot() {
    PocketTable t = seven_foot();
    t.length = 2.54;
    t.width = 1.27;
    t.corner.mouth = 4.5625 * 0.0254;
    t.corner.angle = 142.0 - 135.0;
    t.corner.depth = depth_of_shelf(t, kCornerShelf);
    t.corner.jaw_radius = t.side.jaw_radius = kPointRadius;
    t.side.mouth = 5.0625 * 0.0254;
    t.side.angle = 104.0 - 90.0;
    t.side_run = tan_deg(t.side.angle);
    return t;
}

/// Eight-foot table: playing surface 92 x 46 in, the eight-foot size of the WPA equipment specifications
/// (tables of 88 x 44 in are also sold as eight-foot). Pockets as on the nine-foot table, because the
/// specification has one set for both.
PocketTable eight_foot() {
    PocketTable t = nine_foot();
    t.length = 92.0 * 0.0254;
    t.width = 46.0 * 0.0254;
    return t;
}

/// Coin-operated bar table, called seven-foot in America: playing surface 80 x 40 in (Valley, Diamond),
/// Valley's mouths (corner 4 7/8, side 4 3/4 in), angles of the BCA (corner 142, side 103 degrees). Otherwise
/// as the nine-foot table.
PocketTable bar_table() {
    PocketTable t = nine_foot();
    t.length = 80.0 * 0.0254;
    t.width = 40.0 * 0.0254;
    t.corner.mouth = 4.875 * 0.0254;
    t.corner.depth = depth_of_shelf(t, kCornerShelf);
    t.side.mouth = 4.75 * 0.0254;
    t.side.angle = 103.0 - 90.0;
    t.side_run = tan_deg(t.side.angle);
    return t;
}

/// Twelve-foot snooker table. Playing surface 3.569 x 1.778 m (11 ft 8 1/2 in x 5 ft 10 in, rules of the
/// WPBSA, section 1). Nose height 7/5 of the ball's radius (Mathavan, Jackson, Parkin 2010). The pocket
/// templates of the WPBSA are not published: mouths of 89 and 105 mm are commonly quoted (from memory). Jaw
/// radii, depths and pocket radii are chosen to match: the jaws are large and round, and a ball falls when
/// its centre passes the corner, or the rail line at the side.
PocketTable snooker_table() {
    constexpr double kSideAngle = 10.0;
    return {
        .length = 3.569,
        .width = 1.778,
        .rail_width = 0.0508,
        .nose_height = 1.4 * 0.02625,
        .corner = {.mouth = 0.089, .angle = 0.0, .depth = 0.055, .radius = 0.050, .jaw_radius = 0.100},
        .side = {.mouth = 0.105, .angle = kSideAngle, .depth = 0.055, .radius = 0.050, .jaw_radius = 0.040},
        .side_run = tan_deg(kSideAngle)};
}

/// Seven-foot table for English pool: playing surface 6 x 3 ft. Round jaws as on a snooker table, scaled to
/// the smaller balls.
PocketTable english_pool_table() {
    constexpr double kBalls = 0.0254 / 0.02625;
    PocketTable t = snooker_table();
    t.length = 1.8288;  // 6 ft
    t.width = 0.9144;
    for (double* length :
         {&t.nose_height, &t.corner.mouth, &t.corner.depth, &t.corner.radius, &t.corner.jaw_radius,
          &t.side.mouth, &t.side.depth, &t.side.radius, &t.side.jaw_radius})
        *length *= kBalls;
    return t;
}

/// Nine-foot table with corner mouths of 4 1/4 in, as in many professional events.
PocketTable nine_foot_tight() {
    return with_measures(nine_foot(), {.corner_pockets = {.mouth = 4.25 * 0.0254}});
}

/// Ten-foot pool table, twice as long as wide: 112 x 56 in (recalled). Pockets as on the nine-foot table.
PocketTable ten_foot() {
    return with_measures(nine_foot(), {.size = Vec2(56.0 * 0.0254, 112.0 * 0.0254)});
}

/// Ten-foot snooker table: 9 ft 5 in x 4 ft 10 in, by owners' accounts. Pockets as on the twelve-foot one.
PocketTable snooker_ten_foot() {
    return with_measures(snooker_table(), {.size = Vec2(58.0 * 0.0254, 113.0 * 0.0254)});
}

/// Chinese eight-ball: the surface and nose of a nine-foot pool table, the round jaws of a snooker table,
/// mouths of 84 to 86 mm (recalled).
PocketTable chinese_eight_ball() {
    const Measures pool = measures_of(nine_foot());
    return with_measures(snooker_table(), {.cushion_height = pool.cushion_height,
                                           .corner_pockets = {.mouth = 0.085},
                                           .side_pockets = {.mouth = 0.086},
                                           .size = pool.size});
}

/// Russian pyramid, twelve feet: 3.55 x 1.775 m, points at the sides rounded by 11 mm (basic requirements of
/// the International Committee of Pyramid); mouths 72 to 73 and 82 to 83 mm; nose at 5/8 of the ball, as on a
/// pool table (recalled). Facings, shelves, holes and points at the corners are chosen so that a ball just
/// passes.
PocketTable pyramid_table() {
    constexpr double kSharp = 0.005;
    return with_measures(
        nine_foot(),
        {.cushion_height = 0.0425,
         .corner_pockets =
             {.mouth = 0.0725, .angle_deg = 136.0, .shelf = 0.03, .jaw_radius = kSharp, .radius = 0.05},
         .side_pockets =
             {.mouth = 0.0825, .angle_deg = 100.0, .shelf = 0.01, .jaw_radius = 0.011, .radius = 0.05},
         .size = Vec2(1.775, 3.55)});
}

/// A jaw and the straight facing beside it, in the frame of the corner: x and y from the corner into the
/// table.
struct JawAndFacing {
    Vec2 jaw;        ///< centre of the circle
    Vec2 tip, back;  ///< ends of the facing, at the nose and behind it
    /// The same on the other rail of the corner.
    JawAndFacing swapped() const { return {{jaw.y(), jaw.x()}, {tip.y(), tip.x()}, {back.y(), back.x()}}; }
};

/// At the corner pocket, on the short rail. The jaw's circle touches the nose line and the facing.
JawAndFacing corner_jaw(const PocketTable& t) {
    const double angle = 45.0 + t.corner.angle, r = t.corner.jaw_radius;
    const double mouth = t.corner.mouth * sin_cos_deg(45.0).cos;
    const double start = mouth + r / tan_deg((90.0 + angle) / 2.0);
    const SinCos c = sin_cos_deg(angle);
    return {{start, -r},
            {start - r * c.cos, -r + r * c.sin},
            {mouth - t.rail_width * tan_deg(angle), -t.rail_width}};
}

/// At the side pocket, on the long rail.
JawAndFacing side_jaw(const PocketTable& t) {
    const double end = (t.length - t.side.mouth) / 2.0, r = t.side.jaw_radius;
    const double y = end - r / tan_deg((90.0 + t.side.angle) / 2.0);
    const SinCos s = sin_cos_deg(t.side.angle);
    return {{-r, y}, {-r + r * s.sin, y + r * s.cos}, {-t.rail_width, end + t.rail_width * t.side_run}};
}

/// Clockwise from the corner at the origin: head-left corner, left rail, foot rail, right rail, head rail.
/// Each quarter of the table mirrors the previous one.
Table build(const char* preset, const PocketTable& t) {
    const JawAndFacing short_rail = corner_jaw(t), long_rail = short_rail.swapped(), side = side_jaw(t);
    const double w = t.width, l = t.length, h = t.nose_height;
    const double start = long_rail.jaw.y(), end = side.jaw.y();  // of the straight nose on the long rail
    const double diagonal = t.corner.depth * sin_cos_deg(45.0).cos;
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
        add(corner, across + " rail", short_rail, t.corner.jaw_radius);
        add(corner, along + " rail", long_rail, t.corner.jaw_radius);
        const Vec2 from = at({0.0, to_corner ? end : start}), to = at({0.0, to_corner ? start : end});
        cushions.push_back({"", from, to, h, fmt::format("{} rail, {} half", along, across)});
        add(middle, across + " half", side, t.side.jaw_radius);
        table.pockets.push_back(
            {"", at({-diagonal, -diagonal}), t.corner.radius, kPocketDepth, corner + " pocket"});
        if (to_corner) {
            std::reverse(cushions.begin(), cushions.end());
            std::reverse(jaws.begin(), jaws.end());
            const double y = foot ? l : 0.0, x = right ? w - start : start;
            cushions.push_back({"", {x, y}, {right ? start : w - start, y}, h, across + " rail"});
        } else {
            table.pockets.push_back({"", at({-t.side.depth, l / 2.0}), t.side.radius, kPocketDepth, middle});
        }
        table.cushions.insert(table.cushions.end(), cushions.begin(), cushions.end());
        table.jaws.insert(table.jaws.end(), jaws.begin(), jaws.end());
    }
    detail::number_parts(table);
    return table;
}

/// [m] Nose of a carom table (UMB rules).
constexpr double kCaromNose = 0.037;

/// Carom table, no pockets, nose 37 mm above the cloth (UMB rules).
Table carom_table(const char* preset, double length, const Measures& changed) {
    const Vec2 size = changed.size.value_or(Vec2(length / 2.0, length));
    const double w = size.x(), l = size.y(), h = changed.cushion_height.value_or(kCaromNose);
    Table table;
    table.preset = preset;
    table.width = w;
    table.length = l;
    table.cushions = {{"", {0.0, 0.0}, {0.0, l}, h, "left rail"},
                      {"", {0.0, l}, {w, l}, h, "foot rail"},
                      {"", {w, l}, {w, 0.0}, h, "right rail"},
                      {"", {w, 0.0}, {0.0, 0.0}, h, "head rail"}};
    detail::number_parts(table);
    return table;
}

struct WithPockets {
    const char* name;
    PocketTable (*make)();
};
constexpr WithPockets kWithPockets[] = {{"seven_foot", seven_foot},
                                        {"seven_foot_bar", bar_table},
                                        {"eight_foot", eight_foot},
                                        {"nine_foot", nine_foot},
                                        {"nine_foot_tight", nine_foot_tight},
                                        {"ten_foot", ten_foot},
                                        {"snooker", snooker_table},
                                        {"english_pool", english_pool_table},
                                        {"snooker_ten_foot", snooker_ten_foot},
                                        {"chinese_eight_ball", chinese_eight_ball},
                                        {"pyramid", pyramid_table}};

const WithPockets* with_pockets(std::string_view preset) {
    for (const WithPockets& row : kWithPockets)
        if (preset == row.name) return &row;
    return nullptr;
}

struct WithoutPockets {
    const char *name, *also;
    double length;
};
/// Match table, 2.84 x 1.42 m between nose lines (UMB rules), and the small club table, 2.3 x 1.15 m
/// (recalled).
constexpr WithoutPockets kWithoutPockets[] = {{"carom", "carom_ten_foot", 2.84},
                                              {"carom_small", "carom_small", 2.3}};

const WithoutPockets& without_pockets(std::string_view preset) {
    for (const WithoutPockets& row : kWithoutPockets)
        if (preset == row.name || preset == row.also) return row;
    throw std::invalid_argument(
        fmt::format("unknown table preset {}{}", in_quotes(preset),
                    did_you_mean(preset, {std::begin(kTablePresets), std::end(kTablePresets)})));
}

}  // namespace

std::optional<PocketTable> pocket_table(std::string_view preset) {
    const WithPockets* row = with_pockets(preset);
    return row != nullptr ? std::optional(row->make()) : std::nullopt;
}

Table make_table(std::string_view preset, const Measures& changed) {
    Table table;
    if (const WithPockets* row = with_pockets(preset)) {
        table = build(row->name, with_measures(row->make(), changed));
    } else {
        const WithoutPockets& known = without_pockets(preset);
        table = carom_table(known.name, known.length, changed);
    }
    table.measures = changed;
    return table;
}

Measures measures_of(std::string_view preset, const Measures& changed) {
    if (const WithPockets* row = with_pockets(preset))
        return measures_of(with_measures(row->make(), changed));
    const double length = without_pockets(preset).length;
    return {.cushion_height = changed.cushion_height.value_or(kCaromNose),
            .size = changed.size.value_or(Vec2(length / 2.0, length))};
}

}  // namespace carom
