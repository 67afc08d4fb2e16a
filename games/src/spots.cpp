#include "carom/games/spots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

namespace carom::games {

double head_string(const Table& table) {
    return table.corner.y() + table.length / 4.0;
}

bool in_area(const Table& table, InHand area, const Vec2& place) {
    if (area == InHand::kNo) return false;
    if (area == InHand::kHeadString) return place.y() < head_string(table);
    if (area != InHand::kD) return true;
    const Vec2 from = place - snooker_spot(table, "brown");
    return from.y() <= 0.0 && from.squaredNorm() <= radius_of_d(table) * radius_of_d(table);
}

bool is_free(const Vec2& place, double R, std::span<const Lying> others) {
    return std::all_of(others.begin(), others.end(), [&](const Lying& other) {
        const double least = R + other.R + other.gap;
        return (place - other.place).squaredNorm() >= least * least;
    });
}

bool is_clear(const Vec2& from, const Vec2& to, double R, std::span<const Lying> others) {
    const Vec2 way = to - from;
    const double way2 = way.squaredNorm();
    return std::all_of(others.begin(), others.end(), [&](const Lying& other) {
        const double share = way2 > 0.0 ? std::clamp(dot(other.place - from, way) / way2, 0.0, 1.0) : 0.0;
        const double least = R + other.R + other.gap;
        return (from + share * way - other.place).squaredNorm() > least * least;
    });
}

std::optional<Vec2> nearest_free(const Vec2& from, const Vec2& direction, double reach, double R,
                                 std::span<const Lying> others) {
    if (is_free(from, R, others)) return from;
    double best = std::numeric_limits<double>::infinity();
    for (const Lying& other : others) {
        // Where the line leaves the disc that this ball keeps free of other centres.
        const double least = R + other.R + other.gap;
        const Vec2 to = other.place - from;
        const double along = dot(to, direction), aside2 = to.squaredNorm() - along * along;
        if (aside2 >= least * least) continue;
        double s = along + std::sqrt(least * least - aside2);
        // Rounding may leave it inside by a few ulp.
        double step = 0x1p-52 * (std::abs(s) + least + length(from));
        while (!is_free(from + s * direction, R, std::span(&other, 1))) {
            s += step;
            step *= 2.0;
        }
        if (s >= 0.0 && s <= reach && s < best && is_free(from + s * direction, R, others)) best = s;
    }
    if (best > reach) return std::nullopt;
    return from + best * direction;
}

Vec2 spot_on_long_string(const Table& table, const Vec2& spot, double R, std::span<const Lying> others) {
    const Vec2 up(0.0, 1.0);
    const double to_foot = table.corner.y() + table.length - R - spot.y();
    if (const auto place = nearest_free(spot, up, to_foot, R, others)) return *place;
    if (const auto place = nearest_free(spot, -up, spot.y() - table.corner.y() - R, R, others)) return *place;
    throw std::invalid_argument("there is no room on the long string for another ball");
}

Vec2 spot_snooker(const Table& table, std::string_view colour, double R, std::span<const Lying> others) {
    const Vec2 own = snooker_spot(table, colour);
    if (is_free(own, R, others)) return own;
    for (const std::string_view other : kColours) {
        const Vec2 spot = snooker_spot(table, other);
        if (is_free(spot, R, others)) return spot;
    }
    const Vec2 up(0.0, 1.0);
    const double to_top = table.corner.y() + table.length - R - own.y();
    if (const auto place = nearest_free(own, up, to_top, R, others)) return *place;
    if (const auto place = nearest_free(own, -up, own.y() - table.corner.y() - R, R, others)) return *place;
    throw std::invalid_argument("there is no room for the " + std::string(colour));
}

}  // namespace carom::games
