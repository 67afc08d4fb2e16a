// Random scenes with balls in the air: thrown, dropped, in piles, on three tables.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/math.h"
#include "carom/engine/simulate.h"
#include "reference/random_impacts.h"
#include "support/engine_cases.h"
#include "support/random_scenes.h"

namespace carom {
namespace {

using namespace test;
using reference::Generator;

bool is_valid(const Scene& scene) {
    try {
        validate(scene);
    } catch (const SceneError&) {
        return false;
    }
    return true;
}

void add_if_valid(Scene& scene, const BallStart& ball) {
    scene.ball.push_back(ball);
    if (!is_valid(scene)) scene.ball.pop_back();
}

/// Adds three to six balls that touch or nearly touch, and one or two that land on them; skips balls that do
/// not fit.
void add_pile(Scene& scene, Generator& random) {
    const double R = scene.balls.R, apart = 2.0 * R + (random.next() % 3) * random.uniform(0.0, 2e-4);
    const double x = random.uniform(0.2, scene.table.width - 0.2),
                 y = random.uniform(0.2, scene.table.length - 0.2);
    const auto add = [&](const std::string& id, double right, double up, double height, const Vec3& v) {
        BallStart ball;
        ball.id = id;
        ball.height = height;
        ball.position = {x + right, y + up, R + height};
        ball.velocity = v;
        add_if_valid(scene, ball);
    };
    const int rows = 2 + static_cast<int>(random.next() % 2);
    for (int row = 0; row < rows; ++row)
        for (int k = 0; k <= row; ++k)
            add("pile" + std::to_string(10 * row + k), (k - 0.5 * row) * apart,
                0.5 * std::sqrt(3.0) * row * apart, 0.0, Vec3::Zero());
    const int falling = 1 + static_cast<int>(random.next() % 2);
    for (int n = 0; n < falling; ++n)
        add("onto" + std::to_string(n), random.uniform(-R, R), random.uniform(0.0, 2.0 * R),
            random.uniform(1.5 * R, 0.2) + 2.2 * R * n,
            {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-2.0, 1.0)});
}

/// A random scene with balls in the air: thrown, dropped, struck by a raised cue, unlike, between jaws.
Scene flying_scene(std::uint64_t seed) {
    Generator random(seed);
    const auto chance = [&](double p) { return random.uniform(0.0, 1.0) < p; };
    Scene scene = empty_scene();
    const double kind = random.uniform(0.0, 1.0);
    scene.table = kind < 0.5   ? make_table("seven_foot")
                  : kind < 0.8 ? make_table("snooker")
                               : box(1.0, 2.0, 0.036576);
    scene.balls.e_t = random.uniform(0.2, 0.8);
    if (chance(0.3)) scene.balls.e_h = random.uniform(0.0, 0.5);
    scene.balls.e_b = random.uniform(0.5, 1.0);
    static constexpr const char* kCushions[] = {"han_2005", "stronge", "impulse", "smooth"};
    scene.physics.cushion = cushion_model(kCushions[static_cast<int>(random.uniform(0.0, 4.0))]);
    const bool two_step = chance(0.4), unlike = two_step && chance(0.5);
    if (two_step) scene.physics.ball_ball = ball_ball_model("two_step");
    scene.physics.clusters = chance(0.5) ? ClusterModel::kCompliant : ClusterModel::kSequential;
    const int balls = 1 + static_cast<int>(random.uniform(0.0, 8.0));
    const double width = scene.table.width, length_of_table = scene.table.length;
    for (int tries = 0; static_cast<int>(scene.ball.size()) < balls && tries < 200; ++tries) {
        BallStart ball;
        ball.id = std::to_string(scene.ball.size());
        BallSize size = scene.balls.size();
        if (unlike && chance(0.4)) size.R *= random.uniform(0.8, 1.2), size.m *= random.uniform(0.6, 1.5);
        if (unlike) ball.own = size;
        const double x = random.uniform(0.06, width - 0.06), y = random.uniform(0.06, length_of_table - 0.06);
        if (chance(0.4)) ball.height = random.uniform(0.0, 0.2);
        ball.position = {x, y, size.R + ball.height};
        const double fast = random.uniform(0.0, 5.0);
        if (chance(0.5)) {
            const SinCos way = sin_cos(random.uniform(0.0, 6.28));
            const double up = random.uniform(-1.0, 2.0);
            ball.velocity = {fast * way.cos, fast * way.sin, chance(0.5) ? up : 0.0};
            for (int k = 0; k < 3; ++k) ball.spin[k] = random.uniform(-100.0, 100.0);
        }
        add_if_valid(scene, ball);
    }
    // Sometimes drop one more ball onto two others.
    if (scene.ball.size() >= 2 && chance(0.3)) {
        BallStart top = scene.ball.front();
        top.id = "top";
        top.velocity = top.spin = Vec3::Zero();
        top.height += 2.2 * top.position.z() + random.uniform(0.0, 0.05);
        top.position.z() = scene.size_of(top).R + top.height;
        top.position.x() += random.uniform(-0.01, 0.01);
        scene.ball.push_back(top);
    }
    if (chance(0.3)) add_pile(scene, random);
    return scene;
}

/// Combines flights, pockets anywhere, racks and odd numbers; each scene family omits some of these.
Scene mixed_scene(std::uint64_t seed) {
    Scene scene = flying_scene(seed);
    Generator random(seed + 1000000007);
    const auto chance = [&](double p) { return random.uniform(0.0, 1.0) < p; };
    const auto share = [&] { return chance(0.2) ? 0.0 : chance(0.2) ? 1.0 : random.uniform(0.0, 1.0); };
    BallParams& b = scene.balls;
    if (chance(0.3)) b.e_b = share();
    if (chance(0.3)) b.e_t = 0.98 * share();
    if (chance(0.3)) b.e_c = share();
    if (chance(0.3)) b.f_c = share();
    if (chance(0.2)) b.mu_s = chance(0.3) ? 0.0 : random.uniform(0.0, 1.0);
    if (chance(0.3)) b.e_h = random.uniform(0.0, 1.0);
    if (chance(0.2)) scene.physics.cushion = cushion_model("mathavan_2010");
    if (chance(0.2)) scene.physics.cushion_touch = CushionTouch::kNose;
    if (chance(0.1)) scene.physics.clusters = ClusterModel::kRigid;
    if (chance(0.3))
        scene.table.pockets.push_back(
            {"hole", {random.uniform(0.2, 0.8), random.uniform(0.2, 1.5)}, random.uniform(0.03, 0.2)});
    // Several balls enter one pocket, on the cloth and above it.
    for (int n = 0; n < 4 && !scene.table.pockets.empty() && chance(0.8); ++n) {
        const Pocket& pocket = scene.table.pockets[seed % scene.table.pockets.size()];
        const SinCos from = sin_cos(random.uniform(0.0, 6.28)), way = sin_cos(random.uniform(-0.3, 0.3));
        const double away = pocket.radius + random.uniform(0.0, 0.25), fast = random.uniform(0.2, 5.0);
        BallStart ball;
        ball.id = "near" + std::to_string(n);
        ball.height = chance(0.5) ? random.uniform(0.0, 0.05) : 0.0;
        ball.position = {pocket.center.x() + away * from.cos, pocket.center.y() + away * from.sin,
                         b.R + ball.height};
        const Table& t = scene.table;
        const Vec3& r = ball.position;
        if (t.width > 0.0 && !(r.x() > b.R && r.y() > b.R && r.x() < t.width - b.R && r.y() < t.length - b.R))
            continue;
        ball.velocity = {-fast * (from.cos * way.cos - from.sin * way.sin),
                         -fast * (from.sin * way.cos + from.cos * way.sin), 0.0};
        add_if_valid(scene, ball);
    }
    // A rack, and a ball that flies at it.
    if (chance(0.2) && scene.table.width > 0.9) {
        Rack rack;
        rack.game = chance(0.5) ? RackGame::kNineBall : RackGame::kTenBall;
        rack.gap = random.uniform(0.0, 1e-3);
        BallStart ball;
        for (const RackedBall& r : make_rack(rack, scene.table, b.R)) {
            ball.id = "rack" + r.id;
            ball.position = {r.position.x(), r.position.y(), b.R};
            add_if_valid(scene, ball);
        }
        ball.id = "breaks";
        ball.height = random.uniform(0.0, 0.05);
        ball.position = {0.5 * scene.table.width + random.uniform(-0.05, 0.05), 0.4 * scene.table.length,
                         b.R + ball.height};
        ball.velocity = {random.uniform(-0.5, 0.5), random.uniform(3.0, 13.0), random.uniform(-1.0, 1.0)};
        add_if_valid(scene, ball);
    }
    scene.stop.time = 60.0;
    scene.stop.events = 5000;
    return scene;
}

// Reordering a scene's balls changes no bit.
TEST(Airborne, TheOrderOfTheBallsDoesNotMatter) {
    for (std::uint64_t seed = 1; seed <= 120; ++seed) {
        const Scene scene = seed % 2 == 0 ? mixed_scene(seed) : flying_scene(seed);
        if (scene.ball.empty() || !is_valid(scene)) continue;
        std::vector<std::size_t> order(scene.ball.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::mt19937_64 random(seed);
        for (std::size_t i = order.size(); i-- > 1;) std::swap(order[i], order[random() % (i + 1)]);
        Scene turned = scene;
        for (std::size_t i = 0; i < order.size(); ++i) turned.ball[i] = scene.ball[order[i]];
        const Record a = simulate(plan_of(scene)), b = simulate(plan_of(turned));
        ASSERT_EQ(a.events.size(), b.events.size()) << seed;
        EXPECT_EQ(a.duration, b.duration) << seed;
        for (std::size_t i = 0; i < order.size(); ++i)
            EXPECT_EQ(a.tracks[order[i]].segments, b.tracks[i].segments) << seed;
    }
}

// Forcing the effect on where nothing needs it changes no bit.
TEST(Airborne, ForcingItOnWithoutNeedChangesNothing) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        Scene scene = RandomScene(seed).make();
        const Plan plan = plan_of(scene);
        ASSERT_FALSE(plan.in_force(Effect::kAirborne));
        scene.effects.push_back({"airborne", true, {}});
        const Plan forced = plan_of(scene);
        ASSERT_TRUE(forced.in_force(Effect::kAirborne));
        SimulateOptions options;
        EXPECT_EQ(simulate(plan, options).hash(), simulate(forced, options).hash()) << seed;
    }
}

// CAROM_FLYING_SCENES=FROM:COUNT runs other seeds; CAROM_FLYING_TEXT=1 prints the scenes.
TEST(Airborne, RandomScenesComeToRest) {
    std::uint64_t from = 1, count = 400;
    if (const char* asked = std::getenv("CAROM_FLYING_SCENES")) {
        char* rest = nullptr;
        from = std::strtoull(asked, &rest, 10);
        count = std::strtoull(rest + 1, nullptr, 10);
    }
    int broken = 0, flights = 0, outs = 0, pocketed = 0;
    for (std::uint64_t seed = from; seed < from + count; ++seed) {
        const Scene scene = flying_scene(seed);
        if (scene.ball.empty() || !is_valid(scene)) continue;
        if (std::getenv("CAROM_FLYING_TEXT") != nullptr) std::printf("%s", scene_text(scene).c_str());
        const std::string what = what_breaks(scene);
        broken += !what.empty();
        EXPECT_EQ(what, "") << "seed " << seed;
        if (!what.empty()) continue;
        const Record r = simulate(plan_of(scene));
        flights += test::count(r, EventType::kBallCloth);
        outs += test::count(r, EventType::kBallOut);
        pocketed += test::count(r, EventType::kBallPocket);
    }
    EXPECT_EQ(broken, 0);
    if (count >= 400) {
        EXPECT_GT(flights, 1000);
        EXPECT_GT(outs, 10);
        EXPECT_GT(pocketed, 10);
    }
}

// CAROM_MIXED_SCENES=FROM:COUNT runs other seeds.
TEST(Airborne, MixedScenesKeepTheLaws) {
    std::uint64_t from = 1, count = 1000;
    if (const char* asked = std::getenv("CAROM_MIXED_SCENES")) {
        char* rest = nullptr;
        from = std::strtoull(asked, &rest, 10);
        count = std::strtoull(rest + 1, nullptr, 10);
    }
    int broken = 0, ran = 0;
    for (std::uint64_t seed = from; seed < from + count; ++seed) {
        const Scene scene = mixed_scene(seed);
        if (!is_valid(scene)) continue;
        ++ran;
        const std::string what = what_breaks(scene);
        // A ball that balances exactly ends the run with a message.
        if (what.find(" balance") != std::string::npos) continue;
        broken += !what.empty();
        EXPECT_EQ(what, "") << "seed " << seed << "\n" << (count == 1 ? scene_text(scene) : "");
    }
    EXPECT_EQ(broken, 0);
    EXPECT_GT(ran, static_cast<int>(count / 2));
}

/// Airborne balls over open tables: jaws of any size, posts and single cushions, with or without a bed.
Scene walled_scene(std::uint64_t seed) {
    Generator random(seed + 2000000011);
    const auto chance = [&](double p) { return random.uniform(0.0, 1.0) < p; };
    Scene scene = empty_scene();
    scene.balls.e_t = random.uniform(0.2, 0.8);
    scene.balls.e_h = chance(0.3) ? random.uniform(0.0, 0.5) : 0.0;
    const auto place = [&] { return Vec2(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)); };
    const auto nose = [&] { return random.uniform(0.1, 1.9) * scene.balls.R; };
    Table& table = scene.table;
    const int jaws = 1 + static_cast<int>(random.uniform(0.0, 4.0));
    for (int n = 0; n < jaws; ++n)
        table.jaws.push_back({"", place(), chance(0.2) ? 0.0 : random.uniform(1e-3, 0.2), nose()});
    if (chance(0.5)) table.cushions.push_back({"", place(), place(), nose()});
    if (chance(0.3)) table.pockets.push_back({"", place(), random.uniform(0.03, 0.2), 0.08});
    if (chance(0.5)) table.bed = Rectangle(-1.0, -1.0, 1.0, 1.0);
    const int balls = 1 + static_cast<int>(random.uniform(0.0, 5.0));
    for (int tries = 0; static_cast<int>(scene.ball.size()) < balls && tries < 100; ++tries) {
        BallStart ball;
        ball.id = std::to_string(scene.ball.size());
        ball.height = chance(0.8) ? random.uniform(0.0, 0.3) : 0.0;
        const Vec2 at = place();
        ball.position = {at.x(), at.y(), scene.balls.R + ball.height};
        const SinCos way = sin_cos(random.uniform(0.0, 6.28));
        const double fast = random.uniform(0.0, 3.0);
        ball.velocity = {fast * way.cos, fast * way.sin, random.uniform(-1.0, 2.0)};
        add_if_valid(scene, ball);
    }
    scene.stop.time = 60.0;
    return scene;
}

// A ball that flies over a wall is out; none plays on inside it. CAROM_WALLED_SCENES=FROM:COUNT runs other
// seeds.
TEST(Airborne, NoBallLandsInsideAWall) {
    std::uint64_t from = 1, count = 2000;
    if (const char* asked = std::getenv("CAROM_WALLED_SCENES")) {
        char* rest = nullptr;
        from = std::strtoull(asked, &rest, 10);
        count = std::strtoull(rest + 1, nullptr, 10);
    }
    int outs = 0, met = 0;
    for (std::uint64_t seed = from; seed < from + count; ++seed) {
        const Scene scene = walled_scene(seed);
        if (scene.ball.empty() || !is_valid(scene)) continue;
        const std::string what = what_breaks(scene);
        EXPECT_EQ(what, "") << "seed " << seed << "\n" << (count == 1 ? scene_text(scene) : "");
        if (!what.empty()) continue;
        const Record r = simulate(plan_of(scene));
        outs += test::count(r, EventType::kBallOut);
        met += test::count(r, EventType::kBallJaw);
        for (const BallTrack& track : r.tracks) {
            for (const Segment& s : track.segments) {
                if (is_gone(s.state)) continue;
                for (const Jaw& jaw : scene.table.jaws)
                    EXPECT_GT(length(planar(s.r) - jaw.center), jaw.radius - 1e-12) << "seed " << seed;
            }
        }
    }
    EXPECT_GT(outs, static_cast<int>(count / 10));
    EXPECT_GT(met, static_cast<int>(count / 10));
}

}  // namespace
}  // namespace carom
