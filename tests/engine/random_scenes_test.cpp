// 30 000 seeded scenes of two families to rest without a violation, the regressions they revealed
// (support/random_scenes.h), and some scenes of crowded families and natural shots. With CAROM_RANDOM_SCENES
// in the environment, a scan of other seeds instead (support/scene_scan.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"

#include "support/crowded_scenes.h"
#include "support/natural_shots.h"
#include "support/random_scenes.h"
#include "support/scene_scan.h"

namespace carom {
namespace {

using namespace test;

// Sanitizers take thirty times as long, and look for errors that many scenes share.
#ifdef CAROM_SANITIZED
constexpr int kScenes = 2000, kOtherScenes = 1000;
#else
constexpr int kScenes = 20000, kOtherScenes = 10000;
#endif
constexpr int kParts = 20;

class RandomScenes : public testing::TestWithParam<int> {};

void come_to_rest(int from, int to, DrawOrder order) {
    for (int seed = from; seed < to; ++seed) {
        const Scene scene = RandomScene(static_cast<std::uint64_t>(seed), order).make();
        const std::string what = what_breaks(scene);
        EXPECT_EQ(what, "") << "seed " << seed
                            << (order == DrawOrder::kFirstFirst ? " of the other family" : "") << "\n"
                            << dump(scene);
    }
}

TEST_P(RandomScenes, ComeToRest) {
    const int part = GetParam();
    come_to_rest(part * (kScenes / kParts), (part + 1) * (kScenes / kParts), DrawOrder::kLastFirst);
    come_to_rest(part * (kOtherScenes / kParts), (part + 1) * (kOtherScenes / kParts),
                 DrawOrder::kFirstFirst);
}

// The same shots with cushions whose friction and restitution fall, touched where the sphere meets the nose.
TEST(RandomScenes, WithFitsAndNoses) {
    for (std::uint64_t seed = 0; seed < kScenes / 40; ++seed) {
        Scene scene = RandomScene(seed).make();
        BallParams& b = scene.balls;
        b.f_c = 0.17, b.f_c_more = 0.09, b.f_c_fall = 0.4;
        b.e_c = 0.9, b.e_c_fall = 0.05, b.e_c_above = 0.5;
        scene.physics.cushion_touch = CushionTouch::kNose;
        if (scene.ball.empty()) continue;
        EXPECT_EQ(what_breaks(scene), "") << "seed " << seed << "\n" << dump(scene);
    }
}

INSTANTIATE_TEST_SUITE_P(Part, RandomScenes, testing::Range(0, kParts));

/// The seven-foot table's cushion and jaw, with a ball at their join.
Table cushion_and_jaw() {
    Table table;
    table.width = 0.9906;
    table.length = 1.9812;
    table.cushions = {{"c18", {0.8995982772122183, 0.0}, {0.091001722787781708, 0.0}, 0.036576}};
    table.jaws = {{"j12", {0.8995982772122183, -0.02095}, 0.02095, 0.036576}};
    return table;
}

Scene smooth_scene(ClusterModel clusters = ClusterModel::kSequential) {
    Scene scene = empty_scene();
    scene.balls.mu_b = 0.0;
    scene.physics.ball_ball = ball_ball_model("elastic");
    scene.physics.cushion = &kSmooth;
    scene.physics.clusters = clusters;
    return scene;
}

// A ball held at a cushion lets go at the cushion's end. It went round forever there.
TEST(RandomSceneRegressions, OffTheEndOfACushion) {
    Scene scene = smooth_scene();
    scene.table.cushions = {{"c3", {0.0, 0.091001722787781708}, {0.0, 0.91508373076875005}, 0.036576}};
    scene.balls.mu_s = 0.6;
    scene.balls.e_c = 0.0;
    add_ball(scene, "14", 0.30867884068796231, 0.71580989896748548, -7.1357863660954077, 0.077123077199810583,
             Vec3(183.59121245570637, -291.18699124810286, 28.434528466564402));
    EXPECT_EQ(what_breaks(scene), "");
}

// A stopped ball stays: a velocity of 1e-20 m/s was stopped again and again.
TEST(RandomSceneRegressions, StoppedPushedBall) {
    Scene scene = smooth_scene();
    scene.balls.mu_s = 0.05;
    add_ball(scene, "1", 0.55245100000000003, 1.525452435703369);
    add_ball(scene, "3", 0.5810265, 1.5749466535550534);
    add_ball(scene, "4", 0.60960199999999998, 1.6244408714067378);
    add_ball(scene, "9", 0.52387550000000005, 1.4759582178516844, 0.0, 0.0,
             Vec3(0.4378448403207158, 7.3395409822137019, -6.1226418398206057));
    EXPECT_EQ(what_breaks(scene), "");
}

// Rolling friction brakes a ball; it does not drive one that was held at rest. The energy rose from 0.
TEST(RandomSceneRegressions, HeldBallDoesNotStartByItself) {
    Scene scene = empty_scene();
    scene.table.cushions = {{"right", {1.0, 2.0}, {1.0, 0.0}, 0.036576}};
    scene.physics.ball_ball = ball_ball_model("elastic");
    scene.physics.clusters = ClusterModel::kSequential;
    scene.balls.mu_s = scene.balls.mu_r = 0.05;
    scene.balls.e_c = 0.0;
    add_ball(scene, "9", 0.6950051009078293, 1.6528781070028749, 0.0, 0.0,
             Vec3(-35.837978173050871, 303.8618430760348, 0.0));
    add_ball(scene, "10", 0.97142499999900001, 1.971425);
    EXPECT_EQ(what_breaks(scene), "");
}

// From the jaw onto the cushion: noticed where the cushion begins, and captured without closing on either.
TEST(RandomSceneRegressions, FromAJawOntoTheCushion) {
    Scene scene = smooth_scene();
    scene.table = cushion_and_jaw();
    add_ball(scene, "7", 0.8995982772122183, 0.028575, 0.0, 0.0,
             Vec3(7.8366512943658257, -1.5873334438344489, 5.6399809888732193));
    EXPECT_EQ(what_breaks(scene), "");
}

// A ball that leaves a cushion at its end, onto the jaw: held and let go again each 3e-11 s, in which it does
// not move by an ulp (seed 13566).
TEST(RandomSceneRegressions, LeavingACushionAtItsEnd) {
    Scene scene = smooth_scene(ClusterModel::kCompliant);
    scene.table = make_table("seven_foot");
    scene.balls.mu_r = 0.05;
    add_ball(scene, "9", 0.96202500000000002, 1.06611626923125, 0.0, 0.0,
             Vec3(0.00055663092577602443, 0.00098977630429800947, -0.00043071009198011835));
    settles_within(scene, 100);
}

// A ball that rolls between two others and touches both: its contact opened almost without force as its
// normal turned, and closed again at once where the loop keeps the balls, 10 000 times (seed 16275 of the
// other family).
TEST(RandomSceneRegressions, FastBetweenTwoThatItTouches) {
    Scene scene = empty_scene();
    scene.table = box(1.0, 2.0, 0.036576);
    scene.physics.ball_ball = ball_ball_model("inelastic");
    scene.balls.mu_b = 0.2;
    scene.balls.e_b = 1.0;
    add_ball(scene, "2", 0.35553333717668034, 1.958153509869857, -0.037363507765253434, 0.011989777107804094);
    add_ball(scene, "3", 0.29838333717668036, 1.958153509869857, 0.02648949185983325, 4.966073769823338);
    add_ball(scene, "13", 0.24123333717668036, 1.958153509869857, 8.007143387223751e-07);
    settles_within(scene, 100);
}

Scene on_a_box(double mu_s, double mu_b, ClusterModel clusters = ClusterModel::kCompliant) {
    Scene scene = empty_scene();
    scene.table = box(1.0, 2.0, 0.036576);
    scene.balls.mu_s = mu_s;
    scene.balls.mu_b = mu_b;
    scene.physics.clusters = clusters;
    return scene;
}

// A ball that all but rests on two others: the rolling friction at the start of an interval opened a contact
// and that of its middle closed it, 350 000 times in 0.06 s (seed 36153).
TEST(RandomSceneRegressions, SlowBallTurnedByItsFriction) {
    Scene scene = on_a_box(0.05, 0.2);
    scene.physics.ball_ball = ball_ball_model("inelastic");
    add_ball(scene, "1", 0.52857500000000002, 1.5884800554788419, -6.6204355991043666e-07,
             -5.6711011464052133e-07, Vec3(-64.902608883415695, 63.3283501590588, 51.608987921466046));
    add_ball(scene, "2", 0.5, 1.6379734073051226);
    add_ball(scene, "4", 0.55715000000000003, 1.5389867036525613);
    add_ball(scene, "6", 0.47142499999999998, 1.5884800554788419);
    add_ball(scene, "8", 0.5, 1.5389867036525613);
    settles_within(scene, 2000);
}

// The same with a faster ball: a contact is let go by the forces of the interval that follows (seed 27258).
TEST(RandomSceneRegressions, ContactOpensByTheForcesOfItsInterval) {
    Scene scene = on_a_box(0.05, 0.05);
    scene.balls.e_b = 0.5;
    add_ball(scene, "5", 0.22303194215926808, 1.6157338876770437, -0.0012092744755627007,
             0.0011422913710512788, Vec3(-0.039975201086658925, -0.042319316730103265, 0.0));
    add_ball(scene, "8", 0.18305421019465828, 1.5748939140363802, -2.1895433723912657e-05,
             -2.0018905954546402e-05, Vec3(0.00070057413664204385, -0.00076624439978696961, 0.0));
    add_ball(scene, "9", 0.14449499264491861, 1.6170757731935099);
    add_ball(scene, "13", 0.27826206633841316, 1.6010452565902855, -0.0030356828708997014,
             -0.0057251125335906483, Vec3(2.5859338638962877, -5.2993177912967093, -5.6338504552641515));
    settles_within(scene, 4000);
}

// A row of balls against a cushion, driven by spin: bounces of 1e-8 m/s every 7e-9 s. The contact behind the
// first one is pressed together, and held (seed 21755).
TEST(RandomSceneRegressions, RowOfSlowBouncesIsHeld) {
    Scene scene = smooth_scene(ClusterModel::kRigid);
    scene.table = box(1.0, 2.0, 0.036576);
    scene.balls.mu_s = 0.05;
    scene.balls.mu_r = 0.005;
    scene.balls.mu_sp = 0.044;
    scene.balls.mu_b = 0.05;
    scene.balls.e_c = 0.0;
    add_ball(scene, "2", 0.74271261822262002, 1.971425, 0.45961526192624519, 0.0,
             Vec3(-30.623504109145518, 36.915848047559379, 0.0));
    add_ball(scene, "5", 0.91427500000000006, 1.971425);
    add_ball(scene, "6", 0.85712500000000003, 1.971425, 0.0, 0.0,
             Vec3(-1.8374819309470101, 43.348233207543856, 0.0));
    add_ball(scene, "18", 0.97142499999999998, 1.971425);
    settles_within(scene, 5000);
}

// A ball exactly between two at rest: margins that there was no room for made forces of 2450 m/s^2, and their
// friction energy (seed 50388 of the other family).
TEST(RandomSceneRegressions, NoRoomForMarginsBetweenTwoBalls) {
    Scene scene = empty_scene();
    scene.table = make_table("seven_foot");
    scene.balls.mu_s = 0.05;
    scene.balls.e_b = scene.balls.e_c = 1.0;
    scene.physics.ball_ball = ball_ball_model("inelastic");
    add_ball(scene, "1", 0.40957500000000002, 1.5749440554788419);
    add_ball(scene, "11", 0.46672500000000006, 1.4759573518262805);
    add_ball(scene, "14", 0.43815000000000004, 1.5254507036525613, 0.0, 0.0,
             Vec3(0.00061807070659330781, -0.00065226470737741018, 0.00071318711995510878));
    EXPECT_EQ(what_breaks(scene), "");
}

// One contact of a group has no room for its margin: the others keep theirs. Two balls got 7.7e-10 m into
// each other (seed 76535 of the other family).
TEST(RandomSceneRegressions, MarginsOfTheOthersStay) {
    Scene scene = on_a_box(0.2, 0.05, ClusterModel::kSequential);
    scene.physics.cushion = &kSmooth;
    scene.balls.e_b = 0.8;
    scene.balls.e_c = 0.0;
    scene.balls.f_c = 0.0;
    add_ball(scene, "2", 0.028575, 0.085828979700361463, 0.0, -0.92016176438258568,
             Vec3(32.201636548821895, -31.303222890133142, -124.56441845933541));
    add_ball(scene, "11", 0.085724999999999982, 0.02857500000598235);
    add_ball(scene, "13", 0.028575, 0.028575000000000156);
    EXPECT_EQ(what_breaks(scene), "");
}

// Whole scenes, by seed: friction between two balls that turned their slip
// over each 1e-5 s (24832), and a slip that a capture had ended but that went
// on to drive its ball (33636 of the other family, where the energy rose).
TEST(RandomSceneRegressions, SlipsThatEnd) {
    settles_within(RandomScene(24832).make(), 40000);
    EXPECT_EQ(what_breaks(RandomScene(33636, DrawOrder::kFirstFirst).make()), "");
}

/// Scenes in which contacts do not end well yet (lab/notes/2026-11-jams.md): if you fix one, remove it here.
struct Open {
    const char* family;
    std::uint64_t seed;
    const char* why;
};
constexpr Open kOpen[] = {
    {"zigzag/extreme", 4, "takes 0.2 s in clusters"},
};

bool is_open(const std::string& family, std::uint64_t seed) {
    return std::any_of(std::begin(kOpen), std::end(kOpen),
                       [&](const Open& open) { return open.family == family && open.seed == seed; });
}

/// A small share of the families for long campaigns (lab/measure/campaign).
class Families : public testing::TestWithParam<std::string> {};

// A glancing contact of a cluster opened in the map and kept closing in the loop: one raised break in thirty
// stood still at an instant. tools/slow runs 20 000.
std::uint64_t seeds_of(const std::string& family) {
    if (family == "raised_break") return kScenes / 20;
    return natural_shot(family, 0) ? 50 : 10;
}

TEST_P(Families, KeepTheLaws) {
    const std::uint64_t seeds = seeds_of(GetParam());
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Scene scene = *family_scene(GetParam(), seed);
        if (is_open(GetParam(), seed)) continue;
        try {
            validate(scene);
        } catch (const SceneError&) {
            continue;  // the numbers left no room
        }
        EXPECT_EQ(what_breaks(scene), "") << GetParam() << ", seed " << seed << "\n" << scene_text(scene);
    }
}

std::vector<std::string> families() {
    std::vector<std::string> names(natural_families().begin(), natural_families().end());
    for (const char* name : crowded_families())
        for (const char* level : {"", "/wide", "/extreme"}) names.push_back(std::string(name) + level);
    return names;
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
    std::string name = info.param;
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Crowded, Families, testing::ValuesIn(families()), test_name);

/// The same scene with its balls listed in another order.
Scene reordered(Scene scene, std::uint64_t seed) {
    reference::Generator random(seed);
    for (std::size_t i = scene.ball.size(); i-- > 1;)
        std::swap(scene.ball[i], scene.ball[random.next() % (i + 1)]);
    return scene;
}

void order_changes_nothing(const std::string& family, std::uint64_t seed) {
    const Scene scene = *family_scene(family, seed), other = reordered(scene, seed + 77);
    const Record one = simulate(plan_of(scene)), two = simulate(plan_of(other));
    ASSERT_EQ(one.events.size(), two.events.size()) << family << ", seed " << seed;
    for (std::size_t k = 0; k < one.events.size(); ++k) {
        ASSERT_EQ(one.events[k].time, two.events[k].time) << family << ", seed " << seed << ", event " << k;
        ASSERT_EQ(one.events[k].type, two.events[k].type) << family << ", seed " << seed << ", event " << k;
    }
    for (const BallTrack& track : one.tracks)
        for (const BallTrack& same : two.tracks)
            EXPECT_TRUE(same.id != track.id || same.segments == track.segments)
                << family << ", seed " << seed;
}

// The first of several events at one instant depended on matches played with earlier motions, and so on the
// list of balls: in seed 33 of rack_in_box the order of events changed.
TEST(SceneFamilies, TheOrderOfTheBallsChangesNothing) {
    for (const char* family : {"rack_in_box", "narrow_channel", "rings", "touching", "between_frozen",
                               "eight_ball_break", "raised_break"})
        for (std::uint64_t seed = 0; seed < 20; ++seed) order_changes_nothing(family, seed);
    order_changes_nothing("rack_in_box", 33);
}

TEST(SceneFamilies, AreKnownByName) {
    EXPECT_EQ(families().size(), 7u + 3u * 15u);
    EXPECT_FALSE(family_scene("rings/huge", 0));
    EXPECT_FALSE(family_scene("ring", 0));
    EXPECT_EQ(*family_scene("rings/wide", 7), *family_scene("rings/wide", 7));
}

}  // namespace
}  // namespace carom

// ctest passes the name of the test to run: then it is a test, whatever the environment says.
int main(int count, char** arguments) {
    const char* wanted = std::getenv("CAROM_RANDOM_SCENES");
    if (wanted != nullptr && count == 1) return carom::test::scan_scenes(wanted);
    testing::InitGoogleTest(&count, arguments);
    return RUN_ALL_TESTS();
}
