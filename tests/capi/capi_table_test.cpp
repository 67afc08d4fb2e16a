// libcarom.so: the data that a game draws and queries, by closed forms and against the library.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "owned.h"

namespace carom::test {
namespace {

struct PlayedShot {
    explicit PlayedShot(const std::string& text)
        : scene_(parsed(text)), record_(played(scene_.get())), scene(scene_.get()), record(record_.get()) {}

  private:
    ScenePtr scene_;
    RecordPtr record_;

  public:
    carom_scene* const scene;
    carom_record* const record;
};

constexpr double kRadius = 0.028575;

/// A straight shot at the left rail, without anything that turns it.
const char* const kBank =
    "[balls]\nmu_s = 0\nmu_r = 0\nmu_sp = 0\nmu_b = 0\nf_c = 0\ne_c = 1\n[physics]\ncushion = \"smooth\"\n"
    "[stop]\ntime = 1\n[[ball]]\nid = \"cue\"\nposition = [0.635, 0.9525]\nvelocity = [-1, 0]\n";

TEST(CApiTable, PartsDiamondsAndSpots) {
    const PlayedShot shot(kPot);
    const ValuePtr plan = made(carom_scene_plan, shot.scene);
    EXPECT_EQ(number(plan, "table.width"), 1.27);
    EXPECT_EQ(number(plan, "table.length"), 2.54);
    EXPECT_EQ(number(plan, "table.corner[0]"), 0.0);
    EXPECT_EQ(carom_value_count(plan.get(), "table.cushions"), 18u);  // six noses, and the pockets' facings
    EXPECT_EQ(carom_value_count(plan.get(), "table.pockets"), 6u);
    EXPECT_EQ(text(plan, "table.cushions[0].id"), "c1");
    EXPECT_GT(number(plan, "table.cushions[0].height"), kRadius);
    EXPECT_EQ(text(plan, "table.pockets[2].id"), "p3");
    EXPECT_NE(text(plan, "table.pockets[2].name"), "");
    const PlayedShot round(
        "[[table.arc]]\ncenter = [0, 0]\nradius = 1\nheight = 0.03\nfrom_deg = 30\nto_deg = 90\n"
        "[[ball]]\nid = \"cue\"\nposition = [0, 0]\n[cue]\nspeed = 1\naim_deg = 60\n");
    const ValuePtr arc = made(carom_value_part, made(carom_scene_plan, round.scene).get(), "table.jaws[0]");
    EXPECT_EQ(text(arc, "id"), "a1");
    EXPECT_EQ(number(arc, "from_deg"), 30.0);
    EXPECT_EQ(number(arc, "to_deg"), 90.0);
    EXPECT_EQ(text(arc, "side"), "inside");
    double place[2];
    ASSERT_EQ(carom_scene_diamond(shot.scene, "right", 3.0, place), CAROM_OK);
    EXPECT_EQ(place[0], 1.27);
    EXPECT_DOUBLE_EQ(place[1], 3.0 / 8.0 * 2.54);
    ASSERT_EQ(carom_scene_diamond(shot.scene, "foot", 1.0, place), CAROM_OK);
    EXPECT_DOUBLE_EQ(place[0], 1.27 / 4.0);
    EXPECT_EQ(carom_scene_diamond(shot.scene, "top", 1.0, place), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_scene_diamond(shot.scene, "left", NAN, place), CAROM_BAD_ARGUMENT);
    ASSERT_EQ(carom_scene_spot(shot.scene, "head", place), CAROM_OK);
    EXPECT_DOUBLE_EQ(place[1], 2.54 / 4.0);
    EXPECT_EQ(carom_scene_spot(shot.scene, "middle", place), CAROM_BAD_ARGUMENT);
}

// A ball hits the first of two frozen ones, which pushes the second; nobody hits the fourth ball.
TEST(CApiTable, WhoHitWhom) {
    const PlayedShot shot(
        "[stop]\ntime = 1\n[[ball]]\nid = \"cue\"\nposition = [0.3, 0.6]\nvelocity = [2, 0]\n"
        "[[ball]]\nid = \"1\"\nposition = [0.6, 0.6]\n"
        "[[ball]]\nid = \"2\"\nposition = [0.65715, 0.6]\n"
        "[[ball]]\nid = \"3\"\nposition = [0.6, 1.2]\n");
    std::vector<carom_hit> hits(carom_record_hit_count(shot.record));
    ASSERT_GE(hits.size(), 2u);
    ASSERT_EQ(carom_record_hits(shot.record, hits.data()), CAROM_OK);
    for (const carom_hit& hit : hits) {
        carom_event event;
        ASSERT_EQ(carom_record_event(shot.record, static_cast<std::size_t>(hit.event), &event), CAROM_OK);
        EXPECT_GE(hit.time, event.time);
        EXPECT_NE(hit.a, 3);
        EXPECT_TRUE(std::string(hit.with) != "ball" || hit.b != 3);
    }
    EXPECT_EQ(std::minmax(hits[0].a, hits[0].b), std::minmax(0, 1));
    EXPECT_EQ(std::minmax(hits[1].a, hits[1].b), std::minmax(1, 2));
    EXPECT_LT(hits[0].time, hits[1].time);
    // The last ball has the momentum of its hit. Two milliseconds later the cloth has hardly slowed it.
    double rvw[9];
    ASSERT_EQ(carom_record_state(shot.record, 2, hits[1].time + 2e-3, rvw, nullptr), CAROM_OK);
    EXPECT_NEAR(hits[1].impulse, 0.170097 * rvw[3], 0.01 * hits[1].impulse);
    EXPECT_EQ(carom_record_hits(shot.record, nullptr), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_record_hits(nullptr, hits.data()), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_record_hit_count(nullptr), 0u);
}

TEST(CApiTable, EventsHaveColumns) {
    const PlayedShot shot(kBank);
    const std::size_t events = carom_record_event_count(shot.record);
    const char* names[] = {"diamond", "closing", "cut_deg", "normal_x", "lost", "b_x"};
    std::vector<double> numbers(6 * events);
    ASSERT_EQ(carom_record_events(shot.record, 6, names, numbers.data()), CAROM_OK) << carom_last_error();
    const double wanted[] = {3.0, 1.0, 0.0, 1.0, 0.0};
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(numbers[k], wanted[k], 1e-9) << names[k];
    EXPECT_TRUE(std::isnan(numbers[5]));
    // The columns of a later event do not depend on the others that are asked for.
    std::vector<double> closing(events);
    ASSERT_EQ(carom_record_events(shot.record, 1, names + 1, closing.data()), CAROM_OK);
    for (std::size_t i = 0; i < events; ++i)
        EXPECT_TRUE(closing[i] == numbers[6 * i + 1] || std::isnan(closing[i])) << i;
    const char* unknown = "speed";
    EXPECT_EQ(carom_record_events(shot.record, 1, &unknown, closing.data()), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "no column \"speed\"; `carom describe events` lists them");
}

TEST(CApiTable, TheSceneReturnsItsContents) {
    const PlayedShot shot(kPot);
    const ValuePtr plan = made(carom_scene_plan, shot.scene);
    carom_cue cue;
    ASSERT_EQ(carom_value_cue(plan.get(), "cue", &cue), CAROM_OK) << carom_last_error();
    EXPECT_EQ(text(plan, "cue.ball"), "cue");
    EXPECT_EQ(cue.speed, 2.25);
    EXPECT_EQ(text(plan, "balls[1].id"), "1");
    EXPECT_EQ(number(plan, "balls[1].position[1]"), 2.24);
    EXPECT_EQ(number(plan, "balls[1].radius"), kRadius);
    ASSERT_EQ(carom_scene_set(shot.scene, "physics.gravity", "1.62"), CAROM_OK) << carom_last_error();
    ASSERT_EQ(carom_scene_set(shot.scene, "physics.ball_ball", "\"two_step\""), CAROM_OK);
    EXPECT_EQ(carom_scene_set(shot.scene, "physics.gravity", "-1"), CAROM_BAD_SCENE);
    EXPECT_EQ(carom_scene_set(shot.scene, "physics.gravitation", "1"), CAROM_BAD_SCENE);
    EXPECT_EQ(carom_scene_set(shot.scene, "gravity", "1"), CAROM_BAD_ARGUMENT);
    std::string text(carom_scene_text(shot.scene, nullptr, 0) + 1, '\0');
    carom_scene_text(shot.scene, text.data(), text.size());
    EXPECT_NE(text.find("gravity = 1.62"), std::string::npos);
    EXPECT_NE(text.find("ball_ball = \"two_step\""), std::string::npos);
    ASSERT_EQ(carom_scene_set_cue(shot.scene, nullptr, nullptr), CAROM_OK);
    EXPECT_TRUE(std::isnan(number(made(carom_scene_plan, shot.scene), "cue")));
}

TEST(CApiTable, ARecordIsWrittenAndReadAgain) {
    const PlayedShot shot(kPot), other(kBank);
    std::string text(carom_record_text(shot.record, nullptr, 0) + 1, '\0');
    ASSERT_EQ(carom_record_text(shot.record, text.data(), text.size()) + 1, text.size());
    const std::string path = ::testing::TempDir() + "capi_record.json";
    ASSERT_EQ(carom_record_write(shot.record, path.c_str()), CAROM_OK) << carom_last_error();
    char wanted[17], hash[17];
    carom_record_hash(shot.record, wanted);
    carom_record* again = nullptr;
    ASSERT_EQ(carom_record_parse(text.c_str(), shot.scene, &again), CAROM_OK) << carom_last_error();
    carom_record_hash(again, hash);
    EXPECT_STREQ(hash, wanted);
    carom_record_free(again);
    ASSERT_EQ(carom_record_read(path.c_str(), shot.scene, &again), CAROM_OK) << carom_last_error();
    carom_record_hash(again, hash);
    EXPECT_STREQ(hash, wanted);
    carom_record_free(again);
    std::remove(path.c_str());
    EXPECT_EQ(carom_record_parse(text.c_str(), other.scene, &again), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(again, nullptr);
    EXPECT_NE(carom_record_parse("{}", shot.scene, &again), CAROM_OK);

    const double times[] = {0.0, 0.5};
    double xyzw[2 * 2 * 4];
    ASSERT_EQ(carom_record_orientations(shot.record, 2, times, xyzw), CAROM_OK);
    EXPECT_EQ(xyzw[3], 1.0);
    double norm = 0.0;
    for (int k = 8; k < 12; ++k) norm += xyzw[k] * xyzw[k];
    EXPECT_NEAR(norm, 1.0, 1e-12);
    EXPECT_LT(std::abs(xyzw[11]), 1.0);
}

}  // namespace
}  // namespace carom::test
