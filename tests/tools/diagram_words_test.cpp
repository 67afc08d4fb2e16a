// The words below a drawing and the title above it.
#include "report/diagram_words.h"

#include <gtest/gtest.h>

#include <string>

#include "base/setup.h"
#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"

namespace carom::tools {
namespace {

Record played_scene(const std::string& scene) {
    return simulate(make_plan(read_scene(CAROM_SOURCE_DIR "/scenes/" + scene), kernel::Isa::kScalar));
}

TEST(DiagramWords, OmitZeros) {
    Cue cue;
    cue.speed = 2.0;
    cue.aim_deg = 90.0;
    cue.side = cue.height = 0.0;
    EXPECT_EQ(stroke_words(cue, Units::kMetric), "cue 2.0 m/s, aim 90.00 deg, tip in the middle");
    cue.height = -0.3;
    EXPECT_EQ(stroke_words(cue, Units::kMetric), "cue 2.0 m/s, aim 90.00 deg, tip 0.3 R low");
    cue.side = 0.2;
    cue.elevation_deg = 20.0;
    EXPECT_EQ(stroke_words(cue, Units::kInch),
              "cue 4.5 mph, aim 90.00 deg, elevation 20 deg, tip 0.2 R left, 0.3 R low");
}

TEST(DiagramWords, StateCaromPointsAndFallsOnlyWithPockets) {
    EXPECT_TRUE(outcome_words(played_scene("three_cushion.toml"))
                    .starts_with("4 cushions before the second ball: a point of three cushions; "))
        << outcome_words(played_scene("three_cushion.toml"));
    EXPECT_TRUE(outcome_words(played_scene("hello.toml")).starts_with("nothing falls; "));
    EXPECT_TRUE(outcome_words(played_scene("draw.toml")).starts_with("1 falls into the "));
}

TEST(DiagramWords, StatePlacesAndRadiusInTheChosenUnits) {
    const Record shot = played_scene("three_cushion.toml");
    EXPECT_EQ(places_words(shot, Units::kMetric),
              "metres: white at 0.500, 0.710; yellow at 0.710, 0.710; red at 0.710, 2.130; radius 0.0307");
    EXPECT_EQ(places_words(shot, Units::kInch),
              "inches: white at 19.69, 27.95; yellow at 27.95, 27.95; red at 27.95, 83.86; radius 1.211");
    EXPECT_EQ(places_words(played_scene("eight_ball_break.toml"), Units::kMetric), "") << "too many";
}

TEST(DiagramWords, UseTheTitleInTheFirstComment) {
    EXPECT_EQ(scene_title("# Stop shot: straight in.\n[table]\n"), "Stop shot");
    EXPECT_EQ(scene_title("# On a table of 2.3 m, as in cafes. More.\n"), "On a table of 2.3 m, as in cafes");
    EXPECT_EQ(scene_title("# Two balls.\n"), "Two balls");
    EXPECT_EQ(scene_title("# without an end"), "without an end");
    EXPECT_EQ(scene_title("[table]\n# inside\n"), "");
}

}  // namespace
}  // namespace carom::tools
