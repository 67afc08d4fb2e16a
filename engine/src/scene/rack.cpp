#include "scene/rack.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "base/draws.h"
#include "carom/engine/ball_ball.h"
#include "carom/engine/math.h"

namespace carom {
namespace {

/// Number of balls in each row, from the apex.
std::vector<int> rows_of(const Rack& rack) {
    if (rack.game == RackGame::kThreeCushion || rack.game == RackGame::kFourBall) return {};
    if (rack.game == RackGame::kNineBall) return {1, 2, 3, 2, 1};
    if (rack.game == RackGame::kTenBall) return {1, 2, 3, 4};
    if (rack.game == RackGame::kLine || rack.game == RackGame::kScatter)
        return std::vector<int>(static_cast<std::size_t>(rack.count), 1);
    std::vector<int> rows(rack.game == RackGame::kTriangle ? static_cast<std::size_t>(rack.rows) : 5);
    std::iota(rows.begin(), rows.end(), 1);
    return rows;
}

/// Shuffles by the algorithm of Fisher and Yates.
void shuffle(std::vector<int>& numbers, SplitMix64& random) {
    for (std::size_t i = numbers.size(); i > 1; --i) {
        std::swap(numbers[i - 1], numbers[random.below(static_cast<int>(i))]);
    }
}

/// By the world standardised rules, the 8 is in the middle of the third row, one solid and one stripe are in
/// the back corners, and the others are random.
std::vector<int> eight_ball_numbers(SplitMix64& random) {
    const int solid = 1 + random.below(7);
    const int stripe = 9 + random.below(7);
    const bool solid_left = random.below(2) == 0;
    std::vector<int> numbers;
    for (int n = 1; n <= 15; ++n) {
        if (n != 8 && n != solid && n != stripe) numbers.push_back(n);
    }
    shuffle(numbers, random);
    numbers.insert(numbers.begin() + 4, 8);
    numbers.insert(numbers.begin() + 10, solid_left ? solid : stripe);
    numbers.push_back(solid_left ? stripe : solid);
    return numbers;
}

/// The 1 is at the apex, the last ball (9 or 10) in the middle of the third row, and the others are random.
std::vector<int> rotation_numbers(int last, SplitMix64& random) {
    std::vector<int> numbers(static_cast<std::size_t>(last - 2));
    std::iota(numbers.begin(), numbers.end(), 2);
    shuffle(numbers, random);
    numbers.insert(numbers.begin(), 1);
    numbers.insert(numbers.begin() + 4, last);
    return numbers;
}

std::vector<int> numbers_of(const Rack& rack, SplitMix64& random) {
    if (rack.game == RackGame::kEightBall) return eight_ball_numbers(random);
    if (rack.game == RackGame::kNineBall) return rotation_numbers(9, random);
    if (rack.game == RackGame::kTenBall) return rotation_numbers(10, random);
    std::vector<int> out(static_cast<std::size_t>(balls_of(rack)));
    std::iota(out.begin(), out.end(), 1);
    return out;
}

constexpr std::size_t kPink = 4;  // among the colours of snooker

/// Balls with their own spots.
std::vector<RackedBall> spotted(const Rack& rack, const Table& table) {
    const Vec2 beside = opening_spot(table), head = head_spot(table), foot = foot_spot(table);
    if (rack.game == RackGame::kThreeCushion) return {{"white", beside}, {"yellow", head}, {"red", foot}};
    if (rack.game == RackGame::kFourBall)
        return {{"white", beside}, {"yellow", foot + head - beside}, {"red1", head}, {"red2", foot}};
    std::vector<RackedBall> balls;
    if (rack.game == RackGame::kSnooker)
        for (const char* colour : {"yellow", "green", "brown", "blue", "pink", "black"})
            balls.push_back({colour, snooker_spot(table, colour)});
    return balls;
}

/// Metropolis sampling of hard discs, starting from the rack without jitter. Every step is a valid rack.
void add_jitter(std::vector<Vec2>& places, const std::vector<double>& radii, const Rack& rack,
                SplitMix64& random) {
    // With a gap of 0, only the outer balls can move at first; after a hundred rounds every ball has moved.
    constexpr int kRounds = 100;
    const std::vector<Vec2> slots = places;
    std::vector<std::vector<std::size_t>> near(slots.size());
    for (std::size_t i = 0; i < slots.size(); ++i) {
        for (std::size_t j = 0; j < slots.size(); ++j) {
            // Opposite corners of two boxes: 2 sqrt(2) jitter.
            const double reach = contact_distance(radii[i], radii[j], false) + 3.0 * rack.jitter;
            if (i != j && (slots[i] - slots[j]).squaredNorm() < reach * reach) near[i].push_back(j);
        }
    }
    for (int round = 0; round < kRounds; ++round) {
        for (std::size_t i = 0; i < slots.size(); ++i) {
            const double dx = rack.jitter * (2.0 * random.uniform() - 1.0);
            const double dy = rack.jitter * (2.0 * random.uniform() - 1.0);
            const Vec2 place = slots[i] + Vec2(dx, dy);
            const bool free = std::none_of(near[i].begin(), near[i].end(), [&](std::size_t j) {
                return (place - places[j]).squaredNorm() < 4.0 * radii[i] * radii[j];
            });
            if (free) places[i] = place;
        }
    }
}

/// Normal about R, truncated at kCut standard deviations.
std::vector<double> radii_of(const Rack& rack, double R, std::size_t balls, SplitMix64& random) {
    constexpr double kCut = 2.5;
    std::vector<double> radii(balls, R);
    if (!(rack.radius_sd > 0.0)) return radii;
    for (double& radius : radii) {
        double off;
        do off = standard_normal(random);
        while (std::abs(off) > kCut);
        radius += rack.radius_sd * off;
    }
    return radii;
}

/// Draws positions until they are free, ball after ball.
std::vector<RackedBall> scattered(const Rack& rack, const Table& table, const std::vector<double>& radii,
                                  std::span<const BallStart> others) {
    // Enough to find 1 % of the bed free, except once in 10^8 racks.
    constexpr int kTries = 2000;
    SplitMix64 random(rack.seed);
    std::vector<RackedBall> out;
    const auto is_free = [&](const Vec2& place, double aside) {
        const auto clear = [&place](const Vec2& other, double apart) {
            return (place - other).squaredNorm() >= apart * apart;
        };
        return std::all_of(table.jaws.begin(), table.jaws.end(),
                           [&](const Jaw& jaw) { return clear(jaw.center, aside + jaw.radius); }) &&
               std::all_of(
                   table.pockets.begin(), table.pockets.end(),
                   [&](const Pocket& pocket) { return clear(pocket.center, pocket.radius + rack.gap); }) &&
               std::all_of(others.begin(), others.end(),
                           [&](const BallStart& ball) {
                               const double radius = ball.position.z() - ball.height;
                               return clear(planar(ball.position), aside + radius);
                           }) &&
               std::all_of(out.begin(), out.end(),
                           [&](const RackedBall& ball) { return clear(ball.position, aside + ball.radius); });
    };
    for (int number = 1; number <= rack.count; ++number) {
        const double R = radii[static_cast<std::size_t>(number) - 1], aside = R + rack.gap;
        const Vec2 low = table.corner + Vec2(aside, aside);
        const Vec2 room = Vec2(table.width, table.length) - 2.0 * Vec2(aside, aside);
        int tries = kTries;
        Vec2 place;
        do {
            if (tries-- == 0 || !(room.x() > 0.0) || !(room.y() > 0.0))
                throw std::invalid_argument(
                    fmt::format("there is no room for ball {} of {}; use fewer balls or a smaller gap",
                                number, rack.count));
            // Separate statements, because the order of the draws determines the layout.
            place.x() = low.x() + room.x() * random.uniform();
            place.y() = low.y() + room.y() * random.uniform();
        } while (!is_free(place, aside));
        out.push_back({std::to_string(number), place, R});
    }
    return out;
}

}  // namespace

void RackedBall::put(BallStart& ball, const BallSize& common) const {
    ball.position = {position.x(), position.y(), radius};
    const double ratio = radius / common.R;
    if (radius != common.R) ball.own = BallSize{radius, common.m * ratio * ratio * ratio};
}

int balls_of(const Rack& rack) {
    const std::vector<int> rows = rows_of(rack);
    return std::accumulate(rows.begin(), rows.end(), 0);
}

std::vector<Vec2> rack_slots(const Rack& rack, const Vec2& apex, double R) {
    const double pitch = 2.0 * R + rack.gap;
    const double row_pitch = rack.game == RackGame::kLine ? pitch : pitch * (std::sqrt(3.0) / 2.0);
    std::vector<Vec2> out;
    const std::vector<int> rows = rows_of(rack);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const double y = apex.y() + static_cast<double>(row) * row_pitch;
        for (int k = 0; k < rows[row]; ++k) {
            const int twice = 2 * k - (rows[row] - 1);  // half pitches from the axis, with sign
            const double aside = std::abs(twice) * (0.5 * pitch);
            // With the offset rounded to what apex.x + aside can represent, apex.x +- offset are both exact,
            // so that left and right mirror each other bit for bit.
            const double offset = (std::abs(apex.x()) + aside) - std::abs(apex.x());
            out.emplace_back(twice < 0 ? apex.x() - offset : apex.x() + offset, y);
        }
    }
    return out;
}

std::vector<RackedBall> make_rack(const Rack& rack, const Table& table, double R,
                                  std::span<const BallStart> others) {
    const std::vector<RackedBall> fixed = spotted(rack, table);
    const auto racked = static_cast<std::size_t>(balls_of(rack));
    SplitMix64 sizes = draws_of(rack.seed, 0, "balls.radius_sd");
    const std::vector<double> radii = radii_of(rack, R, racked + fixed.size(), sizes);
    if (rack.game == RackGame::kScatter) return scattered(rack, table, radii, others);
    const Vec2 place = rack.position.value_or(foot_spot(table));
    Vec2 apex = place;
    if (rack.game == RackGame::kSnooker)
        apex.y() += contact_distance(radii[0], radii[racked + kPink], false) + rack.gap;
    SplitMix64 random(rack.seed);
    const std::vector<int> numbers = numbers_of(rack, random);
    std::vector<Vec2> slots = rack_slots(rack, apex, R);
    std::size_t spot = 0;
    if (rack.spot_ball) {
        spot = static_cast<std::size_t>(std::find(numbers.begin(), numbers.end(), *rack.spot_ball) -
                                        numbers.begin());
        apex = place - (slots[spot] - place);
        slots = rack_slots(rack, apex, R);
    }
    std::vector<double> by_slot(racked);
    for (std::size_t i = 0; i < racked; ++i) by_slot[i] = radii[static_cast<std::size_t>(numbers[i]) - 1];
    if (rack.radius_sd > 0.0 && racked > 0) press(slots, by_slot, R, rack.gap, spot, sizes);
    if (rack.jitter > 0.0) add_jitter(slots, by_slot, rack, random);
    if (rack.angle_deg != 0.0) {
        const auto [sin, cos] = sin_cos_deg(rack.angle_deg);
        for (Vec2& slot : slots) {
            const Vec2 d = slot - place;
            slot = place + Vec2(cos * d.x() - sin * d.y(), sin * d.x() + cos * d.y());
        }
    }
    std::vector<RackedBall> out(slots.size());
    for (std::size_t i = 0; i < slots.size(); ++i)
        out[numbers[i] - 1] = {std::to_string(numbers[i]), slots[i]};
    out.insert(out.end(), fixed.begin(), fixed.end());
    for (std::size_t i = 0; i < out.size(); ++i) out[i].radius = radii[i];
    return out;
}

}  // namespace carom
