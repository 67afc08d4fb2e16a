// The measures of a table as a person would take them, and the resulting dimensions.
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "carom/engine/math.h"
#include "carom/engine/table.h"
#include "scene/pocket_table.h"

namespace carom {
namespace {

/// [m] or [degrees] Two measures are equal within this: more than the rounding of a sum, and less than
/// anybody measures.
constexpr double kSame = 1e-12;

/// The angle between nose and facing if the facing runs along the pocket's axis.
constexpr double kCornerAxis = 135.0, kSideAxis = 90.0;

const double kRoot2 = std::sqrt(2.0);

/// The pocket along its axis: the facings begin at the ends of the mouth and converge.
struct Channel {
    double throat;  ///< between their back ends
    double depth;   ///< of their back ends behind the mouth
    double edge;    ///< of the hole's nearest point behind the mouth: the shelf
    double width_at(double x, double mouth) const { return mouth - (mouth - throat) * (x / depth); }
};

Channel corner_channel(const PocketTable& t) {
    const double run = tan_deg(45.0 + t.corner.angle);
    return {.throat = t.corner.mouth - kRoot2 * t.rail_width * (run - 1.0),
            .depth = t.rail_width * (run + 1.0) / kRoot2,
            .edge = t.corner.depth - t.corner.radius + t.corner.mouth / 2.0};
}

Channel side_channel(const PocketTable& t) {
    return {.throat = t.side.mouth - 2.0 * t.rail_width * t.side_run,
            .depth = t.rail_width,
            .edge = t.side.depth - t.side.radius};
}

bool replace(double& mine, const std::optional<double>& wanted) {
    if (!wanted || std::abs(*wanted - mine) <= kSame) return false;
    mine = *wanted;
    return true;
}

/// The angle in degrees with this tangent, from 0 to 90; 0 for a negative one.
double angle_with_tangent(double tangent) {
    double low = 0.0, high = 90.0;
    // Halving 90 degrees 60 times leaves less than an ulp of any relevant angle.
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (tan_deg(middle) < tangent ? low : high) = middle;
    }
    return high;
}

/// @returns whether the facing changed
bool replace_angle(double& angle, double axis, const std::optional<double>& wanted) {
    double whole = axis + angle;
    if (!replace(whole, wanted)) return false;
    angle = whole - axis;
    return true;
}

PocketMeasures measures(const PocketShape& shape, const Channel& channel, double axis) {
    return {.mouth = shape.mouth,
            .throat = channel.throat,
            .angle_deg = axis + shape.angle,
            .shelf = channel.edge,
            .jaw_radius = shape.jaw_radius,
            .radius = shape.radius};
}

}  // namespace

const char* balls_for(std::string_view table_preset) {
    for (const char* game : {"snooker", "english_pool", "pyramid", "carom"})
        if (table_preset.substr(0, std::string_view(game).size()) == game) return game;
    return "pool";
}

double cut_off_deg(double mouth, double R) {
    return mouth > 2.0 * R ? arc_cos(2.0 * R / mouth) * kDegrees : 0.0;
}

PocketTable with_measures(PocketTable t, const Measures& changed) {
    if (changed.size) {
        replace(t.width, changed.size->x());
        replace(t.length, changed.size->y());
    }
    replace(t.nose_height, changed.cushion_height);
    const double corner_shelf = corner_channel(t).edge, side_shelf = side_channel(t).edge;
    replace(t.rail_width, changed.rail_width);
    const PocketMeasures &corner = changed.corner_pockets, &side = changed.side_pockets;
    // The hole follows the mouth and its own radius, so that the shelf stays.
    const bool corner_moves =
        int(replace(t.corner.mouth, corner.mouth)) + replace(t.corner.radius, corner.radius);
    double shelf = corner_shelf;
    if (replace(shelf, corner.shelf) || corner_moves)
        t.corner.depth = shelf + t.corner.radius - t.corner.mouth / 2.0;
    replace(t.side.mouth, side.mouth);
    const bool side_moves = replace(t.side.radius, side.radius);
    shelf = side_shelf;
    if (replace(shelf, side.shelf) || side_moves) t.side.depth = shelf + t.side.radius;
    replace(t.corner.jaw_radius, corner.jaw_radius);
    replace(t.side.jaw_radius, side.jaw_radius);
    replace_angle(t.corner.angle, kCornerAxis, corner.angle_deg);
    if (replace_angle(t.side.angle, kSideAxis, side.angle_deg)) t.side_run = tan_deg(t.side.angle);
    double throat = corner_channel(t).throat;
    if (replace(throat, corner.throat))
        t.corner.angle = angle_with_tangent(1.0 + (t.corner.mouth - throat) / (kRoot2 * t.rail_width)) - 45.0;
    throat = side_channel(t).throat;
    if (replace(throat, side.throat)) {
        t.side.angle = angle_with_tangent((t.side.mouth - throat) / (2.0 * t.rail_width));
        t.side_run = tan_deg(t.side.angle);
    }
    return t;
}

Measures measures_of(const PocketTable& t) {
    return {.cushion_height = t.nose_height,
            .rail_width = t.rail_width,
            .corner_pockets = measures(t.corner, corner_channel(t), kCornerAxis),
            .side_pockets = measures(t.side, side_channel(t), kSideAxis),
            .size = Vec2(t.width, t.length)};
}

namespace {

std::optional<Misfit> pocket_misfit(const char* section, const PocketShape& shape, const Channel& channel,
                                    double to_rail, double rail_width, double smallest, double largest) {
    const auto says = [section](const char* key, const std::string& message) {
        return Misfit{section, key, message};
    };
    if (shape.mouth <= 2.0 * largest)
        return says("mouth", fmt::format("is {:.6g} m, not wider than a ball ({:.6g} m); widen it",
                                         shape.mouth, 2.0 * largest));
    if (!(channel.throat > 0.0))
        return says(
            "angle_deg",
            fmt::format("lets the facings cross: {:.4g} m behind the noses the throat is {:.4g} m wide; "
                        "use a smaller angle, a wider mouth or a narrower rail_width",
                        rail_width, channel.throat));
    if (!(shape.jaw_radius * (1.0 - sin_cos_deg(to_rail).sin) < rail_width))
        return says("jaw_radius",
                    fmt::format("= {} m leaves no facing in front of a rail_width of {} m; make "
                                "it smaller",
                                shape.jaw_radius, rail_width));
    // A ball must reach the hole, and none may pass beside it.
    if (!(channel.edge < channel.depth))
        return says("shelf", fmt::format("= {:.4g} m puts the hole behind the facings, which end {:.4g} m "
                                         "behind the mouth; make it shorter",
                                         channel.edge, channel.depth));
    if (channel.width_at(channel.edge, shape.mouth) <= 2.0 * largest)
        return says("throat", fmt::format("is too narrow: at the hole the facings leave {:.4g} m for a ball "
                                          "of {:.4g} m; widen it, or make the shelf shorter",
                                          channel.width_at(channel.edge, shape.mouth), 2.0 * largest));
    const double center = channel.edge + shape.radius, x = std::fmin(center, channel.depth);
    const double half_chord = std::sqrt((shape.radius + (center - x)) * (shape.radius - (center - x)));
    if (half_chord < 0.5 * channel.width_at(x, shape.mouth) - smallest)
        return says("radius",
                    fmt::format("= {:.4g} m lets a ball pass between the hole and a facing; make it "
                                "larger",
                                shape.radius));
    return std::nullopt;
}

}  // namespace

std::optional<Misfit> misfit(const PocketTable& t, double smallest, double largest) {
    const double corner_angle = 45.0 + t.corner.angle;
    if (auto corner = pocket_misfit("corner_pockets", t.corner, corner_channel(t), corner_angle, t.rail_width,
                                    smallest, largest))
        return corner;
    if (auto side = pocket_misfit("side_pockets", t.side, side_channel(t), t.side.angle, t.rail_width,
                                  smallest, largest))
        return side;
    if (t.width > t.length)
        return Misfit{"", "size",
                      fmt::format("= [{}, {}] has the long side first; swap the two", t.width, t.length)};
    // The part of a rail that a pocket removes: half a mouth, and the rounded point.
    const double at_corner =
        t.corner.mouth / kRoot2 + t.corner.jaw_radius / tan_deg((90.0 + corner_angle) / 2.0);
    const double at_side = t.side.mouth / 2.0 + t.side.jaw_radius / tan_deg((90.0 + t.side.angle) / 2.0);
    if (!(at_corner + at_side < t.length / 2.0) || !(2.0 * at_corner < t.width))
        return Misfit{
            "", "size",
            fmt::format("= [{}, {}] leaves no straight nose between the pockets; make it larger, or "
                        "the mouths and jaw radii smaller",
                        t.width, t.length)};
    return std::nullopt;
}

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
