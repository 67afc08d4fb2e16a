// Only the effects that a scene needs: decisions, refusals, late need, and proof that a skipped effect
// changes no bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"

#include "reference/random_impacts.h"
#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

const EffectDecision& decision(const Plan& plan, const std::string& keyword) {
    for (const EffectDecision& d : plan.effects)
        if (d.keyword == keyword) return d;
    throw std::out_of_range(keyword);
}

Plan plan_of_text(const std::string& text) {
    return make_plan(parse_scene(text, "s.toml"), kernel::Isa::kScalar);
}

std::string plan_error(const std::string& text) {
    try {
        plan_of_text(text);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

// A random scene on a box of 1.2 x 2.4 m: up to four balls, moving and resting, at most 40 events.
Scene random_scene(reference::Generator& rng) {
    Scene scene = empty_scene();
    scene.table = box(1.2, 2.4, 0.036576);
    if (rng.next() % 2 == 0) scene.physics.substeps = 200;
    scene.stop.events = 40;
    scene.balls.mu_s = rng.uniform(0.1, 0.4);
    scene.balls.mu_r = rng.uniform(0.005, 0.02);
    scene.balls.mu_b = rng.uniform(0.01, 0.1);
    scene.balls.f_c = rng.uniform(0.05, 0.3);
    const int count = 1 + static_cast<int>(rng.next() % 4);
    for (int i = 0; i < count; ++i) {
        const double x = 0.1 + 0.27 * i + rng.uniform(0.0, 0.15), y = rng.uniform(0.1, 2.3);
        const bool moves = i == 0 || rng.next() % 3 == 0;
        const double R = scene.balls.R, vx = moves ? rng.uniform(-3.0, 3.0) : 0.0,
                     vy = moves ? rng.uniform(-3.0, 3.0) : 0.0;
        Vec3 w = rolling_spin(vx, vy, R);
        if (moves && rng.next() % 2 == 0)
            w += Vec3{rng.uniform(-50.0, 50.0), rng.uniform(-50.0, 50.0), rng.uniform(-50.0, 50.0)};
        add_ball(scene, std::to_string(i), x, y, vx, vy, w);
    }
    return scene;
}

void no_side(Scene& scene) {
    for (BallStart& ball : scene.ball) ball.spin.z() = 0.0;
}

void strike_instead(Scene& scene, reference::Generator& rng) {
    scene.ball[0].velocity.setZero();
    scene.ball[0].spin.setZero();
    Cue cue;
    cue.ball = scene.ball[0].id;
    cue.speed = rng.uniform(0.5, 3.0);
    cue.aim_deg = rng.next() % 3 == 0 ? 90.0 * static_cast<double>(rng.next() % 4) : rng.uniform(0.0, 360.0);
    cue.elevation_deg = rng.uniform(0.0, 40.0);
    cue.height = rng.uniform(-0.3, 0.3);
    cue.side = rng.uniform(-0.3, 0.3);
    scene.cue = cue;
}

// Every effect, and a change that makes it unnecessary in a random scene.
struct Zero {
    const char* keyword;
    void (*make)(Scene&, reference::Generator&);
};
const Zero kZeros[] = {
    {"sliding", [](Scene& s, reference::Generator&) { s.balls.mu_s = 0.0; }},
    {"rolling", [](Scene& s, reference::Generator&) { s.balls.mu_r = 0.0; }},
    {"spin_decay",
     [](Scene& s, reference::Generator&) {
         s.balls.mu_b = s.balls.f_c = 0.0;
         no_side(s);
     }},
    {"spin_decay", [](Scene& s, reference::Generator&) { s.balls.mu_sp = 0.0; }},
    {"throw", [](Scene& s, reference::Generator&) { s.balls.mu_b = 0.0; }},
    {"throw",
     [](Scene& s, reference::Generator&) {
         s.balls.mu_b = 0.0;
         s.physics.ball_ball = ball_ball_model("inelastic");
     }},
    {"cloth_in_impact", [](Scene& s, reference::Generator&) { s.balls.mu_b = 0.0; }},
    {"cloth_in_impact", [](Scene& s, reference::Generator&) { s.balls.mu_s = 0.0; }},
    {"cloth_in_impact",
     [](Scene& s, reference::Generator&) { s.physics.ball_ball = ball_ball_model("inelastic"); }},
    {"cushions",
     [](Scene& s, reference::Generator&) {
         s.table = box(900.0, 900.0, 0.036576);
         s.table.cushions.erase(s.table.cushions.begin());
         s.table.cushions.pop_back();
         s.stop.time = 1.5;
     }},
    {"cushion_friction",
     [](Scene& s, reference::Generator& rng) {
         const CushionModelInfo* kClosed[] = {&kHan2005, cushion_model("impulse"), cushion_model("stronge")};
         s.physics.cushion = kClosed[rng.next() % 3];
         s.balls.f_c = 0.0;
         // A rhomboid of diagonal noses with round jaws in two corners and a post in the middle.
         const double R = s.balls.R;
         const Vec2 corners[] = {{-0.31, 0.05}, {-0.12, 2.61}, {1.53, 2.37}, {1.29, -0.22}};
         s.table.cushions.clear();
         for (int k = 0; k < 4; ++k)
             s.table.cushions.push_back({"c" + std::to_string(k), corners[k], corners[(k + 1) % 4], R});
         s.table.jaws = {
             {"j1", corners[1], 0.2, R}, {"j2", corners[3], 0.17, R}, {"j3", {0.6, 2.45}, 0.0, R}};
         if (rng.next() % 2 == 0) s.physics.jaw = kClosed[rng.next() % 3];
     }},
    {"pockets",
     [](Scene& s, reference::Generator& rng) {
         s.stop.time = 1.0;
         for (int i = 0; i < 3; ++i)
             s.table.pockets.push_back({"p", Vec2(500.0 + 5.0 * i, rng.uniform(-500.0, 500.0)), 0.06, 0.08});
     }},
    {"squirt",
     [](Scene& s, reference::Generator& rng) {
         strike_instead(s, rng);
         s.cue->side = 0.0;
         s.cue->elevation_deg = 0.0;  // a raised cue squirts up and down as well
     }},
    {"squirt",
     [](Scene& s, reference::Generator& rng) {
         strike_instead(s, rng);
         s.cue->end_mass = 0.0;
     }},
    {"clusters",
     [](Scene& s, reference::Generator&) {
         while (s.ball.size() > 2) s.ball.pop_back();
     }},
};

// Skipped, or forced on with nothing to do, the record is the same bit for bit.
TEST(Effects, SkippedAndZeroGiveTheSameRecordOver1000Scenes) {
    for (const Zero& zero : kZeros) {
        reference::Generator rng(20261121);
        std::size_t events = 0;
        for (int i = 0; i < 1000; ++i) {
            Scene scene = random_scene(rng);
            zero.make(scene, rng);
            const Plan skipped = make_plan(scene, kernel::Isa::kScalar);
            ASSERT_FALSE(decision(skipped, zero.keyword).in_force)
                << zero.keyword << " " << i << ": " << decision(skipped, zero.keyword).reason;
            scene.effects.push_back({zero.keyword, true, {}});
            const Plan full = make_plan(scene, kernel::Isa::kScalar);
            ASSERT_TRUE(decision(full, zero.keyword).in_force);
            const Record a = simulate(skipped), b = simulate(full);
            ASSERT_EQ(a.hash(), b.hash()) << zero.keyword << " " << i;
            events += a.events.size();
            if (i < 100) {
                const auto late = verify(a, skipped);
                EXPECT_FALSE(late) << zero.keyword << " " << i << " " << late->law << ": " << late->message;
            }
        }
        EXPECT_GT(events, 800u) << zero.keyword << ": scenes in which something happens";
    }
}

// Everything forced on, in scenes that need only part of it: the plan skips nothing that matters.
TEST(Effects, PlanAndEverythingOnGiveTheSameRecord) {
    reference::Generator rng(5);
    for (int i = 0; i < 1000; ++i) {
        Scene scene = random_scene(rng);
        if (i % 3 == 0) scene.stop.time = 0.05;
        const Plan plan = make_plan(scene, kernel::Isa::kScalar);
        for (const EffectInfo& effect : effect_table()) scene.effects.push_back({effect.keyword, true, {}});
        const Record a = simulate(plan), b = simulate(make_plan(scene, kernel::Isa::kScalar));
        ASSERT_EQ(a.hash(), b.hash()) << i;
    }
}

const std::string kBreak =
    "[rack]\n[[ball]]\nid = \"cue\"\nposition = [0.635, 0.5]\n[cue]\noffset = [0.1, 0.1]\n";

TEST(Effects, RefusingWhatTheSceneNeedsIsAnErrorAtItsLine) {
    for (const EffectInfo& effect : effect_table()) {
        const std::string keyword = effect.keyword, line = keyword + " = false";
        const std::string lifted = keyword == "airborne" ? kBreak + "elevation_deg = 5\n" : kBreak;
        const std::string message = plan_error("[effects]\n" + line + "\n" + lifted);
        const std::string place = "s.toml:2:" + std::to_string(keyword.size() + 4) + ": effects." + line +
                                  ", but the scene needs it: ";
        EXPECT_EQ(message.rfind(place, 0), 0u) << message;
        EXPECT_NE(message.find("; remove the line"), std::string::npos) << message;
        // A scene that does not need it accepts both.
        const std::string still = "table.cushion = []\n[[ball]]\n";
        EXPECT_EQ(plan_error("[effects]\n" + line + "\n[table]\ncushion = []\n[[ball]]\n"), "") << keyword;
        EXPECT_EQ(plan_error("[effects]\n" + keyword + " = true\n" + kBreak), "") << keyword;
    }
}

TEST(Effects, AFlightIsNotForcedIntoThePlanarModel) {
    const std::string text =
        "[[ball]]\n[cue]\nelevation_deg = 30\n[physics]\nvertical = \"drop\"\n[effects]\n";
    try {
        plan_of(parse_scene(text + "airborne = true\n", "planar.toml"));
        ADD_FAILURE() << "nothing was refused";
    } catch (const SceneError& error) {
        EXPECT_EQ(
            std::string(error.what()),
            "planar.toml:7:12: effects.airborne = true contradicts vertical = \"drop\"; remove one of them");
    }
    EXPECT_FALSE(
        plan_of(parse_scene(text + "airborne = false\n", "planar.toml")).in_force(Effect::kAirborne));
}

TEST(Effects, ListsContainTheNeededParts) {
    const Plan full = plan_of_text(kBreak);
    EXPECT_EQ(full.geometry.cushions.size(), 18u);
    EXPECT_EQ(full.geometry.pockets.size(), 6u);
    for (const EffectDecision& d : full.effects) EXPECT_EQ(d.in_force, d.keyword != "airborne") << d.keyword;
    // A slow ball in the middle of the table: it rests after 0.51 m.
    const std::string slow =
        "[[ball]]\nposition = [0.635, 1.2]\nvelocity = [0, 0.3]\nspin = [-10.498687664041995, 0, 0]\n";
    const Plan alone = plan_of_text(slow);
    EXPECT_TRUE(alone.geometry.cushions.empty() && alone.geometry.noses.empty() &&
                alone.geometry.pockets.empty());
    EXPECT_FALSE(alone.pairs);
    EXPECT_FALSE(alone.in_force(Effect::kSliding));
    EXPECT_TRUE(alone.in_force(Effect::kRolling));
    EXPECT_FALSE(alone.in_force(Effect::kSpinDecay));
    EXPECT_EQ(decision(alone, "cushions").reason,
              "none within reach: ball cue, the only one that moves, goes no farther than 0.459 m");
    EXPECT_EQ(verify(simulate(alone), alone), std::nullopt);
    // With another ball in its path nothing bounds the shot; beyond its reach the other ball changes nothing.
    const std::string other = "[[ball]]\nid = \"1\"\nposition = [0.635, ";
    const Plan hit = plan_of_text(slow + other + "1.6]\n");
    EXPECT_TRUE(hit.pairs);
    EXPECT_FALSE(hit.geometry.cushions.empty());
    const Plan miss = plan_of_text(slow + other + "1.8]\n");
    EXPECT_FALSE(miss.pairs);
    EXPECT_TRUE(miss.geometry.cushions.empty());
    // Until a stop, energy bounds the reach: 0.355 m/s for 0.1 s.
    EXPECT_TRUE(plan_of_text(slow + other + "1.6]\n[stop]\ntime = 0.1\n").geometry.cushions.empty());
    // A ball that rests inside a pocket's circle falls.
    EXPECT_EQ(plan_of_text("[[ball]]\nposition = [0.005, 0.005]\n").geometry.pockets.size(), 6u);
    EXPECT_TRUE(plan_of_text("[[ball]]\nposition = [0.6, 0.6]\n").geometry.pockets.empty());
}

// Scenes near the limit of their reach never meet a skipped part.
TEST(Effects, ReachIsNeverUnderestimated) {
    reference::Generator rng(99);
    int skipped = 0, met = 0;
    for (int i = 0; i < 4000; ++i) {
        Scene scene = empty_scene();
        scene.table = box(1.2, 2.4, 0.036576);
        scene.table.pockets.push_back({"p1", Vec2(-0.03, 1.2), 0.06, 0.08});
        const double speed = rng.uniform(0.05, 0.6), angle = rng.uniform(0.0, 6.28318);
        const double vx = speed * std::cos(angle), vy = speed * std::sin(angle);
        const double x = rng.uniform(0.2, 1.0), y = rng.uniform(0.2, 2.2);
        add_ball(scene, "a", x, y, vx, vy, Vec3{rng.uniform(-20.0, 20.0), rng.uniform(-20.0, 20.0), 0.0});
        if (i % 2) scene.ball[0].spin = rolling_spin(vx, vy, scene.balls.R);
        if (i % 3 == 0) scene.stop.time = rng.uniform(0.05, 1.0);
        add_ball(scene, "b", 0.1, 0.1);
        const Plan plan = plan_of(scene);
        const Record record = simulate(plan);
        const auto late = verify(record, plan);
        ASSERT_FALSE(late) << i << " " << late->law << ": " << late->message;
        skipped += plan.geometry.cushions.empty() ? 1 : 0;
        met += count(record, EventType::kBallCushion) > 0 ? 1 : 0;
    }
    EXPECT_GT(skipped, 500);
    EXPECT_GT(met, 500);
}

// The checker of verified runs finds each wrong skip of a plan.
TEST(Effects, LateNeedIsCaught) {
    Scene scene = empty_scene();
    scene.table = box(1.2, 2.4, 0.036576);
    scene.table.pockets.push_back({"p1", Vec2(0.6, 1.9), 0.06, 0.08});
    add_ball(scene, "a", 0.6, 0.5, 0.0, 2.0, Vec3(0.0, 0.0, 30.0));
    add_ball(scene, "b", 0.605, 1.2);
    const auto law = [&](auto spoil) {
        Plan plan = plan_of(scene);
        spoil(plan);
        scene.stop.time = 3.0;
        const auto violation = verify(simulate(plan), plan);
        return violation ? violation->law + ": " + violation->message : std::string();
    };
    EXPECT_EQ(law([](Plan&) {}), "");
    EXPECT_NE(law([](Plan& p) { p.skip(Effect::kSpinDecay); }).find("E: the plan skips spin_decay"),
              std::string::npos);
    EXPECT_NE(law([](Plan& p) { p.geometry.pockets.clear(); }).find("E: the plan skips pockets"),
              std::string::npos);
    scene.table.pockets.clear();
    EXPECT_NE(law([](Plan& p) {
                  p.geometry.cushions.clear();
                  p.geometry.noses.clear();
              }).find("E: the plan skips cushions"),
              std::string::npos);
    scene.table = {};
    EXPECT_EQ(law([](Plan&) {}), "");
    EXPECT_NE(law([](Plan& p) { p.pairs = false; }), "");
    scene.ball.pop_back();
    scene.stop.time = 1.0;
    const auto friction = [&](auto spoil) {
        Plan plan = plan_of(scene);
        spoil(plan);
        const auto violation = verify(simulate(plan), plan);
        return violation ? violation->message : std::string();
    };
    EXPECT_NE(friction([](Plan& p) { p.skip(Effect::kSliding); }).find("the plan skips sliding"),
              std::string::npos);
    EXPECT_NE(friction([](Plan& p) { p.skip(Effect::kRolling); }).find("the plan skips rolling"),
              std::string::npos);
}

// Two moving balls that cannot meet in time each follow their own segments. If b's first segment lasted, it
// would pass through a.
TEST(Effects, VerifyFollowsSegmentsOnlyToTheirEnds) {
    Scene scene = empty_scene();
    scene.table = {};
    scene.balls.mu_s = 0.2;
    scene.balls.mu_r = 1e-9;
    scene.stop.time = 60.0;
    add_ball(scene, "a", 0.0, 0.0, 0.0, 1e-4);
    add_ball(scene, "b", 0.2, 0.0, 1e-4, 0.0);
    const Plan plan = plan_of(scene);
    EXPECT_FALSE(plan.pairs);
    const auto violation = verify(simulate(plan), plan);
    EXPECT_FALSE(violation) << violation->message;
}

// P4: no cliff between a skipped effect and a vanishing one.
TEST(Effects, VanishingFrictionIsNoFriction) {
    reference::Generator rng(3);
    for (int i = 0; i < 100; ++i) {
        Scene scene = random_scene(rng);
        scene.stop.events = 3;
        scene.balls.mu_b = 0.0;
        const Record none = simulate(plan_of(scene));
        scene.balls.mu_b = 1e-12;
        const Record some = simulate(plan_of(scene));
        const double t = std::min(none.duration, some.duration);
        for (std::size_t b = 0; b < scene.ball.size(); ++b) {
            const Vec3 apart = none.state_at(static_cast<int>(b), t).position -
                               some.state_at(static_cast<int>(b), t).position;
            EXPECT_LE(apart.norm(), 1e-8) << i;
        }
    }
}

}  // namespace
}  // namespace carom
