#include "bench/shot_cases.h"

#include <fmt/format.h>

#include <stdexcept>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/math.h"
#include "reference/random_impacts.h"

namespace carom::tools {
namespace {

using reference::Generator;

constexpr const char* kBreak = R"(
[table]
preset = "nine_foot"
[rack]
game = "{game}"
gap = {gap}
seed = {seed}
[[ball]]
id = "cue"
position = [{x}, 0.50]
[cue]
speed = {speed}
aim_deg = 90.0
offset = [0.0, 0.1]
[physics]
clusters = "{clusters}"
)";

// Cue ball and object ball a metre apart; the cue ball hits it up to two thirds full on either side.
constexpr const char* kTwoBalls = R"(
[table]
preset = "nine_foot"
[[ball]]
id = "cue"
position = [0.635, 0.60]
[[ball]]
id = "1"
position = [0.635, 1.60]
[cue]
speed = {speed}
aim_deg = {aim}
)";

struct Shot {
    const char* name;
    const char* game;  // nullptr: two balls
    double gap;        // of the rack [m]
    const char* clusters;
};

constexpr Shot kShots[] = {{"eight_ball_break", "eight_ball", 1e-4, "sequential"},
                           {"nine_ball_break", "nine_ball", 1e-4, "sequential"},
                           {"eight_ball_break compliant", "eight_ball", 0.0, "compliant"},
                           {"two_ball_shot", nullptr, 0.0, ""}};

}  // namespace

std::vector<std::string> shot_names() {
    std::vector<std::string> names;
    for (const Shot& shot : kShots) names.emplace_back(shot.name);
    return names;
}

Scene shot_scene(const std::string& name, std::uint64_t seed) {
    Generator rng(seed);
    for (const Shot& shot : kShots) {
        if (name != shot.name) continue;
        std::string text;
        if (shot.game == nullptr) {
            text = fmt::format(kTwoBalls, fmt::arg("speed", rng.uniform(1.0, 3.0)),
                               fmt::arg("aim", 90.0 + rng.uniform(-2.0, 2.0)));
        } else {
            text = fmt::format(kBreak, fmt::arg("game", shot.game), fmt::arg("gap", shot.gap),
                               fmt::arg("seed", seed == 0 ? 1 : seed),
                               fmt::arg("x", seed == 0 ? 0.635 : 0.635 + rng.uniform(-0.01, 0.01)),
                               fmt::arg("speed", seed == 0 ? 9.0 : rng.uniform(8.0, 10.0)),
                               fmt::arg("clusters", shot.clusters));
        }
        return parse_scene(text, name);
    }
    throw std::invalid_argument("no shot is called " + name);
}

Scene gas_scene(int n, long events, std::uint64_t seed) {
    Scene scene;
    scene.file = fmt::format("gas of {}", n);
    BallParams& b = scene.balls = make_ball_params("pool");
    b.mu_s = b.mu_r = b.mu_sp = b.mu_b = b.f_c = 0.0;
    b.e_b = b.e_c = 1.0;
    scene.physics.ball_ball = ball_ball_model("elastic");
    scene.physics.cushion = &kSmooth;
    scene.physics.clusters = ClusterModel::kSequential;
    scene.stop.events = events;
    int rows = 1;
    for (int k = 1; k * k <= n; ++k)
        if (n % k == 0) rows = k;
    const int columns = n / rows;
    const double cell = 4.0 * b.R, height = 1.28 * b.R;
    const double w = cell * rows, l = cell * columns;
    scene.table.width = w;
    scene.table.length = l;
    scene.table.cushions = {{"c1", {0, 0}, {0, l}, height},
                            {"c2", {0, l}, {w, l}, height},
                            {"c3", {w, l}, {w, 0}, height},
                            {"c4", {w, 0}, {0, 0}, height}};
    Generator rng(seed);
    for (int i = 0; i < n; ++i) {
        BallStart ball;
        ball.id = std::to_string(i + 1);
        const int row = i % rows, column = i / rows;
        const double x = row + rng.uniform(0.3, 0.7), y = column + rng.uniform(0.3, 0.7);
        ball.position = Vec3(x * cell, y * cell, b.R);
        const SinCos v = sin_cos_deg(rng.uniform(0.0, 360.0));
        ball.velocity = Vec3(v.cos, v.sin, 0.0);
        ball.spin = Vec3(-v.sin / b.R, v.cos / b.R, 0.0);
        scene.ball.push_back(ball);
    }
    return scene;
}

}  // namespace carom::tools
