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

// All coefficients are explicit, so that changed presets or defaults do not affect these shots.
constexpr const char* kCoefficients = R"(
[table]
preset = "nine_foot"
[balls]
radius = 0.028575
mass = 0.170097
mu_s = 0.2
mu_r = 0.01
mu_sp = 0.0127
mu_b = 0.05
e_b = 0.95
e_c = 0.85
f_c = 0.2
[cue]
speed = {speed}
aim_deg = {aim}
elevation_deg = 0.0
offset = [0.0, 0.1]
mass = 0.567
end_mass = 0.00567
restitution = 1.0
[physics]
gravity = 9.81
ball_ball = "mathavan"
cushion = "han_2005"
cloth_slip = "consistent"
clusters = "{clusters}"
tolerance = 1e-6
)";

constexpr const char* kBreak = R"(
[rack]
game = "{game}"
gap = {gap}
seed = {seed}
[[ball]]
id = "cue"
position = [{x}, 0.50]
)";

// Cue ball and object ball are a metre apart; the hit is up to two thirds full on either side.
constexpr const char* kTwoBalls = R"(
[[ball]]
id = "cue"
position = [0.635, 0.60]
[[ball]]
id = "1"
position = [0.635, 1.60]
)";

// A three-cushion table with the balls of a match.
constexpr const char* kThreeCushion = R"(
[table]
preset = "carom"
[balls]
radius = 0.03075
mass = 0.21
mu_s = 0.2
mu_r = 0.0045
mu_sp = 0.0127
mu_b = 0.05
e_b = 0.95
e_c = 0.87
f_c = 0.26
[[ball]]
id = "white"
position = [0.5275, 0.71]
[[ball]]
id = "yellow"
position = [0.71, 0.71]
[[ball]]
id = "red"
position = [0.71, 2.13]
[cue]
ball = "white"
speed = 3.0
aim_deg = 90.0
elevation_deg = 0.0
offset = [0.1, 0.2]
mass = 0.567
end_mass = 0.00567
restitution = 1.0
[physics]
gravity = 9.81
ball_ball = "mathavan"
cushion = "han_2005"
cloth_slip = "consistent"
clusters = "compliant"
tolerance = 1e-6
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
                           {"two_ball_shot", nullptr, 0.0, "compliant"}};

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
        std::string balls = kTwoBalls;
        double speed = 9.0, aim = 90.0;
        if (shot.game == nullptr) {
            aim += rng.uniform(-2.0, 2.0);
            speed = rng.uniform(1.0, 3.0);
        } else {
            if (seed != 0) speed = rng.uniform(8.0, 10.0);
            const double x = seed == 0 ? 0.635 : 0.635 + rng.uniform(-0.01, 0.01);
            balls = fmt::format(kBreak, fmt::arg("game", shot.game), fmt::arg("gap", shot.gap),
                                fmt::arg("seed", seed == 0 ? 1 : seed), fmt::arg("x", x));
        }
        return parse_scene(balls + fmt::format(kCoefficients, fmt::arg("speed", speed), fmt::arg("aim", aim),
                                               fmt::arg("clusters", shot.clusters)),
                           name);
    }
    throw std::invalid_argument("no shot is called " + name);
}

Scene many_scene(const std::string& name) {
    if (name == "many three_cushion") return parse_scene(kThreeCushion, name);
    const auto scene = [&](const std::string& balls, double speed) {
        return parse_scene(balls + fmt::format(kCoefficients, fmt::arg("speed", speed), fmt::arg("aim", 90.0),
                                               fmt::arg("clusters", "compliant")),
                           name);
    };
    // Presets as shipped.
    const auto drawn = [&](const char* game) {
        return parse_scene(fmt::format("[table]\npreset = \"nine_foot\"\n[balls]\npreset = \"pool\"\n"
                                       "[rack]\ngame = \"{}\"\n[[ball]]\nid = \"cue\"\n"
                                       "position = [0.635, 0.5]\n[cue]\nball = \"cue\"\nspeed = 8.0\n"
                                       "aim_deg = 90.0\n",
                                       game),
                           name);
    };
    if (name == "many drawn_eight_ball") return drawn("eight_ball");
    if (name == "many drawn_nine_ball") return drawn("nine_ball");
    if (name == "many two_ball") return scene(kTwoBalls, 3.0);
    if (name == "many eight_ball_break")
        return scene(fmt::format(kBreak, fmt::arg("game", "eight_ball"), fmt::arg("gap", 1e-4),
                                 fmt::arg("seed", 1), fmt::arg("x", 0.635)),
                     9.0);
    throw std::invalid_argument("no batch is called " + name);
}

Scene gas_scene(int n, long events, std::uint64_t seed) {
    Scene scene;
    scene.file = fmt::format("gas of {}", n);
    BallParams& b = scene.balls = make_ball_params("pool_classic");
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
