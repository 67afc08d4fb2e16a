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
const char* const kPot =
    "[[ball]]\nid = \"cue\"\nposition = [0.60, 1.94]\n[[ball]]\nid = \"1\"\nposition = [0.30, 2.24]\n"
    "[cue]\nspeed = 2.25\naim_deg = 135\n";

TEST(CApiTable, PartsDiamondsAndSpots) {
    const PlayedShot shot(kPot);
    carom_table table;
    ASSERT_EQ(carom_scene_table(shot.scene, &table), CAROM_OK);
    EXPECT_EQ(table.width, 1.27);
    EXPECT_EQ(table.length, 2.54);
    EXPECT_EQ(table.cushions, 18u);  // six noses, and the pockets' facings
    EXPECT_EQ(table.pockets, 6u);
    carom_part part;
    ASSERT_EQ(carom_scene_part(shot.scene, CAROM_CUSHION, 0, &part), CAROM_OK);
    EXPECT_STREQ(part.id, "c1");
    EXPECT_EQ(part.radius, 0.0);
    EXPECT_GT(part.height, kRadius);
    ASSERT_EQ(carom_scene_part(shot.scene, CAROM_POCKET, 2, &part), CAROM_OK);
    EXPECT_STREQ(part.id, "p3");
    EXPECT_STRNE(part.name, "");
    EXPECT_EQ(part.from[0], part.to[0]);
    EXPECT_EQ(carom_scene_part(shot.scene, CAROM_POCKET, 6, &part), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_scene_part(shot.scene, CAROM_BALL, 0, &part), CAROM_BAD_ARGUMENT);
    const PlayedShot round(
        "[[table.arc]]\ncenter = [0, 0]\nradius = 1\nheight = 0.03\nfrom_deg = 30\nto_deg = 90\n"
        "[[ball]]\nid = \"cue\"\nposition = [0, 0]\n[cue]\nspeed = 1\naim_deg = 60\n");
    ASSERT_EQ(carom_scene_part(round.scene, CAROM_JAW, 0, &part), CAROM_OK);
    EXPECT_STREQ(part.id, "a1");
    EXPECT_EQ(part.from_deg, 30.0);
    EXPECT_EQ(part.to_deg, 90.0);
    EXPECT_EQ(part.inside, 1);
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
        carom_event_details event;
        ASSERT_EQ(carom_record_event_details(shot.record, static_cast<std::size_t>(hit.event), &event),
                  CAROM_OK);
        EXPECT_GE(hit.time, event.time);
        EXPECT_NE(hit.a, 3);
        EXPECT_TRUE(hit.partner != CAROM_BALL || hit.b != 3);
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

TEST(CApiTable, AnEventHasItsNumbers) {
    const PlayedShot shot(kBank);
    carom_event_details d;
    ASSERT_EQ(carom_record_event_details(shot.record, 0, &d), CAROM_OK);
    EXPECT_EQ(d.type, CAROM_BALL_CUSHION);
    EXPECT_EQ(d.partner, CAROM_CUSHION);
    EXPECT_EQ(d.a, 0);
    EXPECT_NEAR(d.time, 0.635 - kRadius, 1e-12);
    EXPECT_NEAR(d.diamond, 3.0, 1e-12);
    EXPECT_NEAR(d.closing, 1.0, 1e-12);
    EXPECT_NEAR(d.cut_deg, 0.0, 1e-9);
    EXPECT_NEAR(d.normal[0], 1.0, 1e-12);
    EXPECT_NEAR(d.lost, 0.0, 1e-12);
    EXPECT_EQ(carom_record_event_details(shot.record, 99, &d), CAROM_BAD_ARGUMENT);
    for (int type = 0; type < kEventTypes; ++type) {
        // The enumeration matches the engine's.
        EXPECT_NE(name(static_cast<EventType>(type)), nullptr);
    }
    EXPECT_STREQ(name(static_cast<EventType>(CAROM_BALL_POCKET)), "ball_pocket");
    EXPECT_STREQ(name(static_cast<EventType>(CAROM_BALL_JAW_RELEASE)), "ball_jaw_release");
    EXPECT_STREQ(name(static_cast<EventType>(CAROM_BALL_OUT)), "ball_out");
    EXPECT_EQ(CAROM_BALL_OUT + 1, kEventTypes);
    EXPECT_EQ(static_cast<int>(Partner::kPocket), CAROM_POCKET);
}

TEST(CApiTable, TheSceneReturnsItsContents) {
    const PlayedShot shot(kPot);
    carom_cue cue;
    const char* id;
    ASSERT_EQ(carom_scene_cue(shot.scene, &cue, &id), CAROM_OK);
    EXPECT_STREQ(id, "cue");
    EXPECT_EQ(cue.speed, 2.25);
    EXPECT_EQ(carom_scene_ball_count(shot.scene), 2u);
    double rvw[9], radius;
    ASSERT_EQ(carom_scene_ball(shot.scene, 1, &id, rvw, &radius), CAROM_OK);
    EXPECT_STREQ(id, "1");
    EXPECT_EQ(rvw[1], 2.24);
    EXPECT_EQ(radius, kRadius);
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
    EXPECT_EQ(carom_scene_cue(shot.scene, &cue, nullptr), CAROM_BAD_ARGUMENT);
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

TEST(CApiTable, AimsPotTheBall) {
    const PlayedShot shot(kPot);
    carom_pocket_line lines[6];
    ASSERT_EQ(carom_pocket_lines(shot.scene, "1", "cue", lines), CAROM_OK) << carom_last_error();
    EXPECT_GT(lines[2].width_deg, 0.0);
    EXPECT_STREQ(lines[2].in_the_way, "");
    EXPECT_NEAR(std::hypot(lines[2].ghost[0] - 0.30, lines[2].ghost[1] - 2.24), 2 * kRadius, 1e-12);
    carom_cue how;
    carom_cue_init(&how);
    how.speed = 2.0;
    how.height = 0.0;
    carom_aim aim;
    ASSERT_EQ(carom_aim_pot(shot.scene, "cue", &how, "1", "p3", &aim), CAROM_OK) << carom_last_error();
    ASSERT_EQ(aim.found, 1) << aim.why;
    EXPECT_NEAR(aim.cue.aim_deg, 135.0, 1.0);
    ASSERT_EQ(carom_aim_pot(shot.scene, "cue", &how, "1", "p6", &aim), CAROM_OK);
    EXPECT_EQ(aim.found, 0);
    EXPECT_STRNE(aim.why, "");
    EXPECT_EQ(carom_aim_pot(shot.scene, "cue", &how, "7", "p3", &aim), CAROM_BAD_ARGUMENT);
    size_t count = 99;
    ASSERT_EQ(carom_bank_routes(shot.scene, "cue", &how, "1", "p1", 0, nullptr, &count), CAROM_OK);
    EXPECT_LE(count, 6u);
}

TEST(CApiTable, TheCueBallMayBePlacedWithinItsArea) {
    const PlayedShot shot(
        "[[ball]]\nid = \"cue\"\nposition = [0.3, 0.3]\n[[ball]]\nid = \"1\"\nposition = [0.2, 0.2]\n"
        "[[ball]]\nid = \"9\"\nposition = [0.7, 1.0]\n[cue]\nspeed = 4.0\naim_deg = 225.0\n"
        "offset = [0.0, 0.4]\n");
    carom_game_state state;
    ASSERT_EQ(carom_game_new(CAROM_NINE_BALL, 0, 0, &state), CAROM_OK);
    state.opening = 0;
    state.in_hand = CAROM_NOT_IN_HAND;
    carom_verdict* verdict = nullptr;
    ASSERT_EQ(carom_judge(&state, shot.record, nullptr, &verdict), CAROM_OK) << carom_last_error();
    std::int32_t allowed = -1;
    const double free[2] = {0.5, 0.5}, taken[2] = {0.7, 1.0};
    ASSERT_EQ(carom_may_place(shot.record, verdict, 0, free, &allowed), CAROM_OK) << carom_last_error();
    EXPECT_EQ(allowed, 1);
    ASSERT_EQ(carom_may_place(shot.record, verdict, 0, taken, &allowed), CAROM_OK);
    EXPECT_EQ(allowed, 0);
    const PlayedShot other(kPot);
    EXPECT_EQ(carom_may_place(other.record, verdict, 0, free, &allowed), CAROM_BAD_ARGUMENT);
    carom_verdict_free(verdict);
}

}  // namespace
}  // namespace carom::test
