// The conclusions of carom accuracy from its measurements, and the promise of its recommendation.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/simulate.h"
#include "commands/accuracy/scene.h"
#include "reference/random_impacts.h"
#include "support/engine_cases.h"

namespace carom::tools {
namespace {

using namespace test;

TEST(DeservedTolerance, IsTheLoosestPowerOfTenThatKeepsTheTarget) {
    EXPECT_EQ(deserved_tolerance(1.0, 1e-2), 1e-3);  // looser ones are solved as 1e-3
    EXPECT_EQ(deserved_tolerance(0.0, 1e-3), 1e-3);
    EXPECT_EQ(deserved_tolerance(2.0, 1e-3), 1e-4);
    EXPECT_EQ(deserved_tolerance(9.9e4, 1e-3), 1e-8);
    EXPECT_EQ(deserved_tolerance(1.1e5, 1e-3), 1e-9);
    EXPECT_EQ(deserved_tolerance(9e9, 1e-3), 1e-13);
    EXPECT_EQ(deserved_tolerance(2e10, 1e-3), std::nullopt);
    EXPECT_EQ(deserved_tolerance(INFINITY, 1e-3), std::nullopt);
    EXPECT_EQ(deserved_tolerance(NAN, 1e-3), std::nullopt);
}

// A setting that cannot finish becomes a row with the reason and without figures.
TEST(SceneAccuracy, AFailedSettingIsARow) {
    SceneAccuracy result;
    result.rows.resize(2);
    for (SceneAccuracyRow& r : result.rows) r.method = "march";
    result.rows[0].setting = "N=100";
    result.rows[1].setting = "N=1000";
    result.rows[1].failed = "it did not end";
    const std::string text = scene_accuracy_text(result, "s.toml");
    EXPECT_NE(text.find("failed: it did not end\n"), std::string::npos) << text;
    const auto rows = nlohmann::json::parse(scene_accuracy_json(result)).at("rows");
    EXPECT_FALSE(rows.at(0).contains("failed"));
    EXPECT_EQ(rows.at(1).at("failed"), "it did not end");
    EXPECT_FALSE(rows.at(1).contains("ns_min"));
}

// A ball that rolls straight: a start moved by d moves the end by d.
TEST(Gain, IsOneWithoutContacts) {
    Scene scene = empty_scene();
    add_ball(scene, "1", 0.0, 0.0, 1.0, 0.0, rolling_spin(1.0, 0.0, scene.balls.R));
    const Plan plan = plan_of(scene);
    EXPECT_NEAR(gain_of(plan, simulate(plan)), 1.0, 1e-3);
}

// A full hit turned by d: the object ball leaves at d / (2R), and travels s further.
TEST(Gain, OfAFullHitFollowsFromTheLineOfCentres) {
    Scene scene = empty_scene();
    scene.balls.mu_b = 0.0;
    const double R = scene.balls.R;
    add_ball(scene, "1", 0.0, 0.0, 1.0, 0.0, rolling_spin(1.0, 0.0, R));
    add_ball(scene, "2", 0.5, 0.0);
    const Plan plan = plan_of(scene);
    const Record record = simulate(plan);
    const double run = final_positions(record)[1].x() - 0.5;
    const double gain = gain_of(plan, record);
    EXPECT_GT(gain, 0.8 * run / (2.0 * R));
    EXPECT_LT(gain, 1.2 * run / (2.0 * R));
}

TEST(Gain, OfASceneAtRestIsOne) {
    Scene scene = empty_scene();
    add_ball(scene, "1", 0.0, 0.0);
    const Plan plan = plan_of(scene);
    EXPECT_EQ(gain_of(plan, simulate(plan)), 1.0);
}

TEST(FinalError, IsTheWorstAndTheMedianBall) {
    const std::vector<Vec2> a = {{0, 0}, {1, 0}, {2, 0}}, b = {{0, 0}, {1, 3}, {2, 1}};
    EXPECT_DOUBLE_EQ(final_error(a, b).largest, 3.0);
    EXPECT_DOUBLE_EQ(final_error(a, b).median, 1.0);
    EXPECT_EQ(final_error({}, {}).largest, 0.0);
}

TEST(OutcomeOf, NamesContactsAndTheFirstBallHit) {
    Scene scene = empty_scene();
    add_ball(scene, "cue", 0.0, 0.0, 2.0, 0.0);
    add_ball(scene, "far", 0.8, 0.0);
    add_ball(scene, "near", 0.4, 0.0);
    const ShotContacts outcome = contacts_of(scene, simulate(plan_of(scene)));
    EXPECT_EQ(outcome.first_contact, "near");
    ASSERT_GE(outcome.contacts.size(), 2u);
    EXPECT_EQ(outcome.contacts[0], "ball_ball cue near");
    EXPECT_EQ(outcome.pockets, (std::vector<int>{-1, -1, -1}));
}

Scene seeded_break(reference::Generator& rng, int seed) {
    char text[400];
    const double x = 0.635 + rng.uniform(-0.012, 0.012), speed = rng.uniform(5.0, 12.0);
    std::snprintf(text, sizeof text,
                  "[rack]\ngame = \"eight_ball\"\ngap = 1e-4\njitter = 3e-5\nseed = %d\n[[ball]]\nid = "
                  "\"cue\"\nposition = [%.17g, 0.5]\nvelocity = [0, %.17g]\n",
                  seed, x, speed);
    return parse_scene(text, "break.toml");
}

// The recommendation promises: played with it, a break ends within 1 mm of the other converged method, in at
// least 19 of 20 breaks.
TEST(Recommendation, MeetsAMillimetreOnSeededBreaks) {
#ifdef CAROM_SANITIZED
    constexpr int kDrawn = 1, kLeast = 0;
#else
    constexpr int kDrawn = 20, kLeast = 15;
#endif
    reference::Generator rng(9);
    AccuracySceneArgs args;
    args.march.clear();
    args.repeat = 1;
    int allowed = 0, met = 0, looser = 0;
    for (int i = 0; i < kDrawn; ++i) {
        const Scene scene = seeded_break(rng, i + 1);
        const SceneAccuracy result = measure_scene_accuracy(scene, args);
        if (!result.recommended) continue;
        ++allowed;
        const std::vector<Vec2> end = final_positions(simulate(with_reference(scene)));
        const auto error = [&](double t) {
            return final_error(final_positions(simulate(with_tolerance(scene, t))), end).largest;
        };
        met += error(*result.recommended) <= args.target ? 1 : 0;
        looser += error(1e-4) <= args.target ? 1 : 0;
    }
    std::printf("allowed %d, met %d; tolerance 1e-4 would have met %d\n", allowed, met, looser);
    EXPECT_GE(allowed, kLeast);
    EXPECT_GE(20 * met, 19 * allowed);
    // A tolerance chosen without the shot does not: the recommendation is informative.
    EXPECT_LE(looser, met - kLeast / 2);
}

}  // namespace
}  // namespace carom::tools
