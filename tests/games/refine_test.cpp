// Shots adjusted until balls rest at given places.
#include "carom/games/refine.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "support/scenes.h"

namespace carom::games {
namespace {

const std::vector<Choice> kStroke{{"cue.aim_deg", -360.0, 360.0},
                                  {"cue.speed", 0.5, 6.0},
                                  {"cue.offset.side", -0.4, 0.4},
                                  {"cue.offset.height", -0.4, 0.4}};

Vec2 end_of(const Scene& scene, int ball) {
    const Record record = simulate(make_plan(scene, kernel::Isa::kScalar));
    return planar(record.state_at(ball, record.duration).position);
}

/// The shipped shot barely touches a ball at its end, so every place is near another order of events.
Scene aimed_three_cushion() {
    Scene scene = test::shipped("three_cushion");
    scene.cue->aim_deg = -7.0;
    return scene;
}

TEST(Refine, MovesABallToItsPlace) {
    struct Case {
        const char* name;
        Scene scene;
        Vec2 by;
    };
    for (const Case& c : {Case{"draw", test::shipped("draw"), {-0.06, 0.05}},
                          Case{"draw", test::shipped("draw"), {0.04, 0.02}},
                          Case{"three_cushion", aimed_three_cushion(), {0.003, 0.005}}}) {
        const Scene& scene = c.scene;
        const Vec2 place = end_of(scene, 0) + c.by;
        const std::vector<Place> places{{0, place}};
        const Refined found = refine(scene, kStroke, places, kernel::Isa::kScalar);
        EXPECT_EQ(found.trouble, "") << c.name;
        EXPECT_LE(found.miss, kRefined) << c.name;
        EXPECT_LE(found.shots, 12) << c.name;
        EXPECT_LT((end_of(found.scene, 0) - place).norm(), 1e-6) << c.name;
    }
}

TEST(Refine, TwoBallsAtOnce) {
    const Scene scene = aimed_three_cushion();
    const std::vector<Place> places{{0, end_of(scene, 0) + Vec2(0.002, 0.001)},
                                    {1, end_of(scene, 1) + Vec2(0.001, 0.002)}};
    const Refined found = refine(scene, kStroke, places, kernel::Isa::kScalar);
    EXPECT_EQ(found.trouble, "");
    for (const Place& place : places) EXPECT_LT((end_of(found.scene, place.ball) - place.at).norm(), 1e-6);
}

TEST(Refine, ReadsThePlacesOfAGoal) {
    const Scene scene = test::shipped("draw");
    const auto places = [&](const char* want) { return Measure(want, scene).places(); };
    const std::vector<Place> two =
        places("not scratch and (cue near (0.6, 1.2, 0.05) and 1 near (0.2, 0.3))");
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0].ball, 0);
    EXPECT_EQ(two[0].at, Vec2(0.6, 1.2));
    EXPECT_EQ(two[1].ball, 1);
    EXPECT_EQ(two[1].at, Vec2(0.2, 0.3));
    for (const char* want : {"scratch", "not cue near (0.6, 1.2)", "scratch or cue near (0.6, 1.2)",
                             "distance(cue, 0.6, 1.2) >= 0.1"})
        EXPECT_TRUE(places(want).empty()) << want;
}

TEST(Refine, ReportsFailure) {
    const Scene scene = test::shipped("draw");
    // Behind the rail, and a ball that falls.
    const std::vector<Place> outside{{0, Vec2(-1.0, 1.0)}}, fallen{{1, Vec2(0.5, 0.5)}};
    EXPECT_NE(refine(scene, kStroke, outside, kernel::Isa::kScalar).trouble, "");
    EXPECT_EQ(refine(scene, kStroke, fallen, kernel::Isa::kScalar).trouble,
              "a ball that is wanted at rest falls");
}

}  // namespace
}  // namespace carom::games
