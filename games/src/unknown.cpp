#include "unknown.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/draws.h"

namespace carom::games::detail {
namespace {

/// Metropolis sampling, as in a rack with jitter: a move that makes balls overlap is dropped.
void move_balls(Scene& scene, const Unknown& sd, SplitMix64& random) {
    // [-] Half-width of the square, in standard deviations of the gaps: measured on racks of 9, 10 and 15.
    constexpr double kSquare = 2.5;
    // [m] Balls nearer than this are neighbours of a rack.
    constexpr double kRacked = 1e-3;
    // After 60 rounds the balls inside of a rack have moved, too.
    constexpr int kRounds = 60;
    const std::vector<BallStart> meant = scene.ball;
    std::vector<std::vector<std::size_t>> near(meant.size());
    const auto gap = [&](std::size_t i, std::size_t j, const Vec2& place) {
        const double both = 4.0 * scene.size_of(meant[i]).R * scene.size_of(meant[j]).R;
        return (place - planar(scene.ball[j].position)).norm() - std::sqrt(both);
    };
    for (std::size_t i = 0; i < meant.size(); ++i)
        for (std::size_t j = 0; j < meant.size(); ++j)
            if (i != j && gap(i, j, planar(meant[i].position)) < kRacked) near[i].push_back(j);
    for (std::size_t i = 0; i < meant.size(); ++i)
        if (near[i].empty())
            for (int axis = 0; axis < 2; ++axis)
                scene.ball[i].position[axis] += sd.places * standard_normal(random);
    for (int round = 0; round < kRounds; ++round)
        for (std::size_t i = 0; i < meant.size(); ++i) {
            if (near[i].empty()) continue;
            Vec2 place = planar(meant[i].position);
            for (int axis = 0; axis < 2; ++axis)
                place[axis] += kSquare * sd.gaps * (2.0 * random.uniform() - 1.0);
            const bool free = std::all_of(near[i].begin(), near[i].end(),
                                          [&](std::size_t j) { return gap(i, j, place) >= 0.0; });
            if (free) scene.ball[i].position.head<2>() = place;
        }
}

/// Multiplies the restitution at every speed, up to 1.
void change_rails(BallParams& balls, double factor) {
    balls.e_c *= factor;
    balls.e_c_fall *= factor;
    if (balls.e_c > 1.0 && balls.e_c_fall > 0.0) balls.e_c_above += (balls.e_c - 1.0) / balls.e_c_fall;
    balls.e_c = std::min(balls.e_c, 1.0);
}

}  // namespace

std::vector<std::string> table_keys(const Scene& scene, const std::vector<bool>& resized) {
    std::vector<std::string> keys = {"balls.mu_s", "balls.mu_r"};
    if (scene.balls.e_c_fall > 0.0)
        keys.insert(keys.end(), {"balls.e_c_fit.0", "balls.e_c_fit.1", "balls.e_c_fit.2"});
    else
        keys.emplace_back("balls.e_c");
    for (std::size_t i = 0; i < scene.ball.size(); ++i)
        for (const char* number : {"position.x", "position.y", "radius", "mass"})
            if (resized[i] || *number == 'p') keys.push_back("ball." + scene.ball[i].id + "." + number);
    return keys;
}

std::vector<double> table_values(const Scene& table, const std::vector<bool>& resized) {
    const BallParams& balls = table.balls;
    std::vector<double> values = {balls.mu_s, balls.mu_r, balls.e_c};
    if (balls.e_c_fall > 0.0) values.insert(values.end(), {balls.e_c_fall, balls.e_c_above});
    for (std::size_t i = 0; i < table.ball.size(); ++i) {
        const BallStart& ball = table.ball[i];
        values.insert(values.end(), {ball.position.x(), ball.position.y()});
        const BallSize size = table.size_of(ball);
        if (resized[i]) values.insert(values.end(), {size.R, size.m});
    }
    return values;
}

Scene drawn_table(const Scene& scene, const Unknown& sd, std::uint64_t seed, std::uint64_t index) {
    // [-] Frictions and restitutions change by at most this part.
    constexpr double kMost = 0.9;
    constexpr int kTries = 20;
    SplitMix64 random = draws_of(seed, index, "table");
    const auto factor = [&](double by) {
        return 1.0 + std::clamp(by * standard_normal(random), -kMost, kMost);
    };
    Scene drawn = scene;
    drawn.balls.mu_s *= factor(sd.cloth);
    drawn.balls.mu_r *= factor(sd.cloth);
    change_rails(drawn.balls, factor(sd.rails));
    for (int tries = 0; (sd.places > 0.0 || sd.gaps > 0.0) && tries < kTries; ++tries) {
        move_balls(drawn, sd, random);
        try {
            validate(drawn);
            break;
        } catch (const SceneError&) {
            drawn.ball = scene.ball;
        }
    }
    return drawn;
}

}  // namespace carom::games::detail
