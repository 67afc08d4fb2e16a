// Aiming by geometry.
#include "carom/games/aim.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/math.h"
#include "carom/games/spots.h"
#include "lines.h"

namespace carom::games {
namespace {

/// [-] Directions tried across the width of a pocket, before the ends of the widest run are refined.
constexpr int kDirections = 144;
/// [-] Bisections between a direction that enters and one that does not: to 1e-11 of the gap.
constexpr int kHalvings = 36;
/// [ball radii] Rounding of positions: a ball against a cushion may run along it.
constexpr double kAlongCushion = 1e-9;

double between_segments(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
    const bool parted_by_ab = cross(b - a, c - a) * cross(b - a, d - a) > 0.0;
    const bool parted_by_cd = cross(d - c, a - c) * cross(d - c, b - c) > 0.0;
    if (!parted_by_ab && !parted_by_cd && cross(b - a, d - c) != 0.0) return 0.0;
    return std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d), distance_to_segment(c, a, b),
                     distance_to_segment(d, a, b)});
}

/// Distance to the edge of a pocket's circle; infinite if the line misses it.
double way_to_circle(const Pocket& pocket, const Vec2& from, const Vec2& towards) {
    const Vec2 to = pocket.center - from;
    const double along = dot(to, towards), aside = cross(towards, to);
    if (along <= 0.0 || std::abs(aside) >= pocket.radius) return std::numeric_limits<double>::infinity();
    return std::max(0.0, along - std::sqrt(pocket.radius * pocket.radius - aside * aside));
}

/// Distance through a pocket's mouth to the circle's edge, or beside it; infinite if the line misses the
/// mouth, or is too flat to it.
double way_through_mouth(const Table& table, const Pocket& pocket, const Vec2& from, const Vec2& towards) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const auto jaws = detail::jaws_of(table, pocket);
    if (!jaws) return kNever;
    const Vec2 across = jaws->second->center - jaws->first->center, to = jaws->first->center - from;
    const double turn = cross(towards, across);
    if (std::abs(turn) < detail::kSteepest * length(across)) return kNever;
    const double way = cross(to, across) / turn, share = cross(to, towards) / turn;
    return way > 0.0 && share > 0.0 && share < 1.0 ? way : kNever;
}

/// A line into a pocket must lead into its circle or, off a facing, into its mouth.
enum class Goal : std::uint8_t { kCircle, kMouth };

double way_into(const Table& table, const Pocket& pocket, Goal goal, const Vec2& from, const Vec2& towards) {
    return goal == Goal::kCircle ? way_to_circle(pocket, from, towards)
                                 : way_through_mouth(table, pocket, from, towards);
}

/// Whether a cushion is the facing of a pocket: one end lies behind the noses. A ball that rubs there still
/// falls.
bool is_facing(const Table& table, const Cushion& cushion) {
    const auto behind = [&](const Vec2& end) {
        const Vec2 in = end - table.corner;
        return in.x() < 0.0 || in.y() < 0.0 || in.x() > table.width || in.y() > table.length;
    };
    return behind(cushion.from) || behind(cushion.to);
}

/// Whether a ball reaches this pocket without touching noses or jaws.
bool enters(const Table& table, const Pocket& pocket, Goal goal, const Vec2& from, const Vec2& towards,
            double R) {
    const double way = way_into(table, pocket, goal, from, towards);
    if (!std::isfinite(way)) return false;
    const Vec2 end = from + way * towards;
    const double least = R * (1.0 - kAlongCushion);
    return std::all_of(table.cushions.begin(), table.cushions.end(),
                       [&](const Cushion& c) {
                           return is_facing(table, c) || between_segments(from, end, c.from, c.to) >= least;
                       }) &&
           std::all_of(table.jaws.begin(), table.jaws.end(),
                       [&](const Jaw& j) {
                           // A straight path ends farthest from the centre of a wall around it.
                           if (j.around()) return length(end - j.center) <= j.radius - least;
                           return distance_to_segment(j.center, from, end) >= j.radius + least;
                       }) &&
           std::none_of(table.pockets.begin(), table.pockets.end(), [&](const Pocket& other) {
               return &other != &pocket && way_to_circle(other, from, towards) < way;
           });
}

/// A direction at an angle [degrees] to another one.
Vec2 turned(const Vec2& direction, double deg) {
    const auto [sin, cos] = sin_cos_deg(deg);
    return {cos * direction.x() - sin * direction.y(), sin * direction.x() + cos * direction.y()};
}

/// The last direction that enters the pocket, between one that does and one that does not [degrees].
template <class Enters>
double edge(double in, double out, const Enters& enters_at) {
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (in + out);
        (enters_at(middle) ? in : out) = middle;
    }
    return in;
}

}  // namespace

double direction_deg(const Vec2& direction) {
    return carom::direction_deg(direction.x(), direction.y());
}

Vec2 ghost_ball(const Vec2& object, const Vec2& towards, double both) {
    return object - both * towards;
}

double cut_angle_deg(const Vec2& cue, const Vec2& ghost, const Vec2& towards) {
    const Vec2 way = ghost - cue;
    const double size = length(way);
    return size > 0.0 ? arc_cos(std::clamp(dot(way, towards) / size, -1.0, 1.0)) * kDegrees : 0.0;
}

namespace detail {

const BallStart& ball_of(const Scene& scene, std::string_view id) {
    if (const int ball = index_of(scene.ball, id); ball >= 0) return scene.ball[ball];
    throw std::invalid_argument("there is no ball \"" + std::string(id) + "\" in the scene");
}

const Pocket& pocket_of(const Scene& scene, std::string_view id) {
    if (const int p = index_of(scene.table.pockets, id); p >= 0) return scene.table.pockets[p];
    throw std::invalid_argument("there is no pocket \"" + std::string(id) + "\" on the table");
}

std::optional<std::pair<const Jaw*, const Jaw*>> jaws_of(const Table& table, const Pocket& pocket) {
    std::vector<const Jaw*> jaws;
    for (const Jaw& jaw : table.jaws)
        if (!jaw.is_arc()) jaws.push_back(&jaw);
    if (jaws.size() < 2) return std::nullopt;
    std::partial_sort(jaws.begin(), jaws.begin() + 2, jaws.end(), [&](const Jaw* a, const Jaw* b) {
        return (a->center - pocket.center).squaredNorm() < (b->center - pocket.center).squaredNorm();
    });
    return std::pair(jaws[0], jaws[1]);
}

double hit_aim_deg(const Vec2& way, double both, double hit) {
    const double reach = both / std::max(length(way), 1e-9);
    return direction_deg(way) + 90.0 - arc_cos(std::clamp(hit * reach, -1.0, 1.0)) * kDegrees;
}

PocketLine line_from(const Table& table, const Pocket& pocket, const Vec2& from, double R) {
    PocketLine line;
    line.pocket = pocket.id;
    const Vec2 to = pocket.center - from;
    const double distance = length(to);
    if (!(distance > pocket.radius)) return line;
    line.towards = to / distance;
    // A mouth is a little wider than its circle.
    const double half = 90.0 - arc_cos(std::min(1.0, 1.5 * pocket.radius / distance)) * kDegrees;
    const double step = 2.0 * half / kDirections;
    for (const Goal goal : {Goal::kCircle, Goal::kMouth}) {
        const auto enters_at = [&](double deg) {
            return enters(table, pocket, goal, from, turned(to / distance, deg), R);
        };
        int best_first = 0, best_count = 0, count = 0;
        for (int k = 0; k <= kDirections; ++k) {
            count = enters_at(k * step - half) ? count + 1 : 0;
            if (count <= best_count) continue;
            best_count = count;
            best_first = k - count + 1;
        }
        if (best_count == 0) continue;
        const double first = best_first * step - half, last = first + (best_count - 1) * step;
        const double low = edge(first, first - step, enters_at), high = edge(last, last + step, enters_at);
        line.width_deg = high - low;
        line.towards = turned(to / distance, 0.5 * (low + high));
        line.distance = way_into(table, pocket, goal, from, line.towards);
        break;
    }
    return line;
}

}  // namespace detail

std::vector<PocketLine> pocket_lines(const Scene& scene, std::string_view ball, std::string_view cue_ball) {
    const BallStart& start = detail::ball_of(scene, ball);
    const Vec2 from = planar(start.position);
    const double R = scene.size_of(start).R;
    const int struck = index_of(scene.ball, cue_ball);
    const double both = R + (struck < 0 ? scene.balls.R : scene.size_of(scene.ball[struck]).R);
    std::vector<PocketLine> lines;
    for (const Pocket& pocket : scene.table.pockets) {
        PocketLine line = detail::line_from(scene.table, pocket, from, R);
        line.ghost = ghost_ball(from, line.towards, both);
        double nearest = std::numeric_limits<double>::infinity();
        for (const BallStart& other : scene.ball) {
            if (line.width_deg == 0.0 || other.id == ball || other.id == cue_ball) continue;
            const Lying there = {planar(other.position), scene.size_of(other).R, 0.0};
            const double away = length(there.place - from);
            if (away >= nearest ||
                is_clear(from, from + line.distance * line.towards, R, std::span(&there, 1)))
                continue;
            nearest = away;
            line.in_the_way = other.id;
        }
        lines.push_back(line);
    }
    return lines;
}

}  // namespace carom::games
