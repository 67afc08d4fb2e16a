// The table: cushions, jaws and pockets. Lengths in m, heights above the cloth.
//
// Frame: right-handed, z up, x along the short side, y along the long side, origin where two nose lines meet.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/field.h"
#include "carom/engine/tolerances.h"
#include "carom/engine/vec.h"

namespace carom {

/// Places on and off the table.
inline constexpr Interval kCoordinate = at_least(-kMaxCoordinate, kMaxCoordinate, "m");
inline constexpr Interval kNoseHeight = more_than(0.0, kMaxLength, "m");

/// A straight cushion nose between two points. It acts on both sides, and its ends are round with radius 0,
/// so that neighbouring cushions leave no gap.
struct Cushion {
    std::string id;
    Vec2 from, to;
    double height;
    std::string name{};
    bool operator==(const Cushion&) const = default;
};
inline constexpr Field<Cushion> kCushionFields[] = {
    field<&Cushion::id>("id", "`c1`, `c2`, ...", {.files = Files::kRecord}),
    field<&Cushion::from>("from", kCoordinate, "one end of a straight nose line",
                          {.shape = "[x, y]", .needed = true}),
    field<&Cushion::to>("to", kCoordinate, "the other end", {.shape = "[x, y]", .needed = true}),
    field<&Cushion::height>("height", kNoseHeight, "of the nose above the cloth",
                            {.standard = "1.28 x ball radius"}),
    field<&Cushion::name>("name", "for people, such as: left rail, head half", {.files = Files::kRecord}),
};

/// A rounded jaw: a full circle. A ball touches it at centre distance R + radius. With the last three members
/// it is an arc: a round wall that acts on one side only.
struct Jaw {
    std::string id;
    Vec2 center;
    double radius;
    double height;
    std::string name{};
    std::optional<std::string> side = std::nullopt;  ///< side of the circle on which the balls are
    std::optional<double> from_deg = std::nullopt, to_deg = std::nullopt;
    bool is_arc() const { return side.has_value(); }
    /// Whether it encloses the balls.
    bool around() const { return side == "inside"; }
    bool operator==(const Jaw&) const = default;
};
inline constexpr const char* kArcSides[] = {"inside", "outside"};
inline constexpr Field<Jaw> kJawFields[] = {
    field<&Jaw::id>("id", "`j1`, `j2`, ...", {.files = Files::kRecord}),
    field<&Jaw::center>("center", kCoordinate, "of the circle", {.shape = "[x, y]", .needed = true}),
    field<&Jaw::radius>("radius", at_least(0.0, kMaxLength, "m"), "of the full circle; 0 is a post",
                        {.needed = true}),
    field<&Jaw::height>("height", kNoseHeight, "of the nose above the cloth",
                        {.standard = "1.28 x ball radius"}),
    field<&Jaw::name>("name", "for people", {.files = Files::kRecord}),
    field<&Jaw::side>("side", "of an arc on which the balls are: `inside` for a round table",
                      {.later = true, .standard = "inside", .names = kArcSides}),
    field<&Jaw::from_deg>("from_deg", at_least(-kMaxAngle, kMaxAngle, "degrees"),
                          "of an arc: direction from the centre to its first end; 0 is +x",
                          {.later = true, .standard = "0"}),
    field<&Jaw::to_deg>("to_deg", at_least(-kMaxAngle, kMaxAngle, "degrees"),
                        "of an arc: to its other end, counter-clockwise; 360 more is the full circle",
                        {.later = true, .standard = "`from_deg` + 360"}),
};

/// A ball whose centre crosses the circle falls (docs/reference/physics.md, "Pockets").
struct Pocket {
    std::string id;
    Vec2 center;
    double radius;
    double depth;  ///< a pocketed ball rests at (center, -depth)
    std::string name{};
    bool operator==(const Pocket&) const = default;
};
inline constexpr Field<Pocket> kPocketFields[] = {
    field<&Pocket::id>("id", "`p1`, `p2`, ...", {.files = Files::kRecord}),
    field<&Pocket::center>("center", kCoordinate, "of the circle", {.shape = "[x, y]", .needed = true}),
    field<&Pocket::radius>("radius", more_than(0.0, kMaxLength, "m"),
                           "a ball whose centre crosses this circle falls", {.needed = true}),
    field<&Pocket::depth>("depth", kCoordinate, "depth of a pocketed ball below the cloth, for drawing",
                          {.files = Files::kRecord}),
    field<&Pocket::name>("name", "for people", {.files = Files::kRecord}),
};

/// Measures of the corner or side pockets that replace a preset's.
struct PocketMeasures {
    std::optional<double> mouth = std::nullopt, throat = std::nullopt, angle_deg = std::nullopt,
                          shelf = std::nullopt, jaw_radius = std::nullopt, radius = std::nullopt;
    bool operator==(const PocketMeasures&) const = default;
};
inline constexpr Interval kMeasure = more_than(0.0, kMaxLength, "m");
inline constexpr Field<PocketMeasures> kPocketMeasureFields[] = {
    field<&PocketMeasures::mouth>("mouth", kMeasure,
                                  "between the points where the facings begin, at the nose",
                                  {.later = true, .standard = "preset's"}),
    field<&PocketMeasures::angle_deg>(
        "angle_deg", {90.0, false, 180.0, true, "degrees"},
        "between nose and facing: 135 at a corner and 90 at a side are parallel "
        "facings",
        {.later = true, .standard = "preset's"}),
    field<&PocketMeasures::throat>(
        "throat", kMeasure, "between the back ends of the facings",
        {.later = true, .standard = "from `angle_deg`", .instead_of = "angle_deg"}),
    field<&PocketMeasures::shelf>("shelf", at_least(0.0, kMaxLength, "m"),
                                  "from the middle of the mouth to the edge of the hole",
                                  {.later = true, .standard = "preset's"}),
    field<&PocketMeasures::jaw_radius>("jaw_radius", at_least(0.0, kMaxLength, "m"),
                                       "of the point between nose and facing",
                                       {.later = true, .standard = "preset's"}),
    field<&PocketMeasures::radius>("radius", kMeasure, "of the hole",
                                   {.later = true, .standard = "preset's"}),
};

/// Measures that replace a preset's, as a person would measure them.
struct Measures {
    std::optional<double> cushion_height = std::nullopt, rail_width = std::nullopt;
    PocketMeasures corner_pockets{}, side_pockets{};
    std::optional<Vec2> size = std::nullopt;  ///< between the noses
    bool operator==(const Measures&) const = default;
};
inline constexpr Field<Measures> kMeasureFields[] = {
    field<&Measures::size>("size", more_than(0.0, kMaxLength, "m"), "between the noses, the short side first",
                           {.shape = "[width, length]", .later = true, .standard = "preset's"}),
    field<&Measures::cushion_height>("cushion_height", kNoseHeight, "of the noses above the cloth",
                                     {.later = true, .standard = "preset's"}),
    field<&Measures::rail_width>("rail_width", kMeasure, "from the noses to the back ends of the facings",
                                 {.later = true, .standard = "preset's"}),
};
/// The sections of both kinds of pocket, in [table].
struct PocketSection {
    const char *key, *path;
    PocketMeasures Measures::*pockets;
};
inline constexpr PocketSection kPocketSections[] = {
    {"corner_pockets", "table.corner_pockets", &Measures::corner_pockets},
    {"side_pockets", "table.side_pockets", &Measures::side_pockets}};

/// Cushions are "c1", "c2", ..., jaws "j1", ..., arcs (after the jaws in their list) "a1", ..., and pockets
/// "p1", ..., in list order. Presets list them clockwise seen from above, from the pocket (or corner) at the
/// origin.
struct Table {
    std::string preset;  ///< "seven_foot", ..., or "" for a custom outline
    /// The cloth's name in the scene; its friction is in BallParams.
    std::optional<std::string> cloth = std::nullopt;
    double width = 0.0,
           length = 0.0;         ///< playing surface between nose lines; the bounding box of a custom outline
    Vec2 corner = Vec2::Zero();  ///< its corner of smallest x and y: the origin, except for a custom outline
    std::vector<Cushion> cushions;
    std::vector<Jaw> jaws;
    std::vector<Pocket> pockets;
    Measures measures{};  ///< differing from the preset's
    /// A flying ball beyond it is out; nothing: out behind any cushion.
    std::optional<Rectangle> bed = std::nullopt;
    bool operator==(const Table&) const = default;
};
inline constexpr const char* kCloths[] = {"club", "tournament", "match_heated"};
inline constexpr const char* kStandardTable = "nine_foot";
/// carom_ten_foot is another name of carom, a ten-foot table.
inline constexpr const char* kTablePresets[] = {
    "seven_foot", "seven_foot_bar", "eight_foot",     "nine_foot",        "nine_foot_tight",
    "ten_foot",   "snooker",        "english_pool",   "snooker_ten_foot", "chinese_eight_ball",
    "pyramid",    "carom",          "carom_ten_foot", "carom_small"};
/// The keys of [table] besides the lists of cushions, jaws and pockets.
inline constexpr Field<Table> kTableFields[] = {
    field<&Table::preset>("preset", "a table with published sizes", {.names = kTablePresets}),
    field<&Table::cloth>(
        "cloth",
        "rolling friction by name: `mu_r` = 0.01, 0.0075 or 0.0045; `mu_r` in `[balls]` overrides it",
        {.files = Files::kScene, .standard = "as `[balls]`", .names = kCloths}),
    field<&Table::width>("width", at_least(0.0, kMaxCoordinate, "m"), "between the nose lines along x",
                         {.files = Files::kRecord}),
    field<&Table::length>("length", at_least(0.0, kMaxCoordinate, "m"), "between the nose lines along y",
                          {.files = Files::kRecord}),
    field<&Table::corner>("corner", kCoordinate, "the corner of smallest x and y",
                          {.shape = "[x, y]", .files = Files::kRecord}),
    field<&Table::bed>(
        "bed", kCoordinate,
        "two corners of the playing surface: a ball in the air is out when it leaves this rectangle",
        {.shape = "[x0, y0, x1, y1]", .later = true, .standard = "behind any cushion"}),
};

/// Index of the ball, pocket, ... with this id, or -1.
template <class Part>
int index_of(const std::vector<Part>& list, std::string_view id) {
    for (std::size_t i = 0; i < list.size(); ++i)
        if (list[i].id == id) return static_cast<int>(i);
    return -1;
}
template <class Part>
std::vector<std::string> ids_of(const std::vector<Part>& list) {
    std::vector<std::string> ids;
    ids.reserve(list.size());
    for (const Part& part : list) ids.push_back(part.id);
    return ids;
}

/// A point on the long axis or `aside` of it [m], from the table's corner of smallest y.
Vec2 spot_on_axis(const Table& table, double y, double aside = 0.0);
/// Spots on the long axis: the head string, the centre and the foot string, at a quarter, a half and three
/// quarters of the length. Racks are at the foot spot by default.
Vec2 head_spot(const Table& table);
Vec2 center_spot(const Table& table);
Vec2 foot_spot(const Table& table);
/// The cue ball's position at the start of a carom game, beside the head spot.
Vec2 opening_spot(const Table& table);
/// The colours of snooker, in descending value from 7 to 2.
inline constexpr std::array<std::string_view, 6> kColours = {"black", "pink",  "blue",
                                                             "brown", "green", "yellow"};
/// The spot of a snooker colour. @throws std::invalid_argument for another id
Vec2 snooker_spot(const Table& table, std::string_view colour);
/// The radius of the D [m], which is centred on the brown spot.
double radius_of_d(const Table& table);

}  // namespace carom
