// Records as files: all data read back, and no partial file remains.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "record_sample.h"
#include "support/process.h"

namespace carom {
namespace {

using test::sample_record;
using test::TemporaryFolder;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// All data that a record file must keep. If you add a field to one of these structs, the compiler leads you
// here: the names below no longer match. Then write the field in engine/src/record/write.cpp, read it in
// read.cpp beside it, describe it in docs/reference/ (a record without it needs a default and a note), and
// give it a distinct value in sample_record(). Balls, table and render settings have rows:
// scene_rows_test.cpp.
struct FieldsOfARecord {
    Table table;
    BallParams balls;
    double gravity;
    RenderSettings render;
    std::vector<BallTrack> tracks;
    std::vector<Event> events;
    std::vector<std::vector<int>> clusters;
    std::vector<EventCost> costs;
    double setup_detect_ns, duration, start_time;
    StopReason stopped;
    std::shared_ptr<void> not_kept;
};
static_assert(sizeof(Record) == sizeof(FieldsOfARecord),
              "Record has another field: see the comment above, record files have to keep it");

// Every value differs from its neighbours and from its struct's initial value, so that a lost or swapped one
// shows.
void expect_unusual(std::vector<double> values) {
    for (const double value : values) EXPECT_NE(value, 0.0);
    std::sort(values.begin(), values.end());
    EXPECT_EQ(std::adjacent_find(values.begin(), values.end()), values.end());
}

TEST(RecordFile, TheSampleHasADistinctValueInEveryField) {
    const Record record = sample_record();
    const auto& [preset, cloth, width, length, corner, cushions, jaws, pockets, measures, bed] = record.table;
    ASSERT_TRUE(bed);
    expect_unusual({(*bed)[0], (*bed)[1], (*bed)[2], (*bed)[3]});
    EXPECT_FALSE(cloth);  // the balls contain its friction
    EXPECT_NE(preset, Table().preset);
    expect_unusual({width, length, corner.x(), corner.y()});
    const auto& [nose, rail, corners, sides, size] = measures;
    const auto& [mouth, throat, angle, shelf, jaw, hole] = corners;
    ASSERT_TRUE(nose && rail && size && mouth && throat && angle && shelf && jaw && hole && sides.mouth);
    expect_unusual(
        {*nose, *rail, size->x(), size->y(), *mouth, *throat, *angle, *shelf, *jaw, *hole, *sides.mouth});
    const auto& [c_id, from, to, c_height, c_name] = cushions.at(0);
    expect_unusual({to.x(), to.y(), c_height});
    const auto& [j_id, j_center, j_radius, j_height, j_name, side, from_deg, to_deg] = jaws.at(0);
    ASSERT_TRUE(side && from_deg && to_deg);
    expect_unusual({j_center.x(), j_center.y(), j_radius, j_height, *from_deg, *to_deg});
    const auto& [p_id, p_center, p_radius, p_depth, p_name] = pockets.at(0);
    expect_unusual({p_center.x(), p_center.y(), p_radius, p_depth});
    for (const std::string& text : {c_id, c_name, j_id, j_name, p_id, p_name}) EXPECT_NE(text, "");
    const auto& [R, m, mu_s, mu_r, mu_sp, mu_b, e_b, e_c, f_c, mu_b_more, mu_b_fall, f_c_more, f_c_fall,
                 e_c_fall, e_c_above, e_t, e_t_more, e_t_fall, e_h, disc, slides] = record.balls;
    EXPECT_TRUE(disc == 1.0 && slides == 1.0);
    expect_unusual({R, m, mu_s, mu_r, mu_sp, mu_b, e_b, e_c, f_c, mu_b_more, mu_b_fall, f_c_more, f_c_fall,
                    e_c_fall, e_c_above, e_t, e_t_more, e_t_fall, e_h});
    const auto& [fps, pixels, lines, camera, hides_cue, eye, target, color] = record.render;
    EXPECT_TRUE(fps != 60.0 && pixels != 1280 && lines != 720 && camera != "top" && eye && target);
    EXPECT_TRUE(hides_cue && color);
    const auto& [id, segments, pocket, own] = record.tracks.at(1);
    EXPECT_TRUE(!id.empty() && pocket != -1 && record.tracks.at(2).own);
    const auto odd = std::find_if(segments.begin(), segments.end(), [](const Segment& s) {
        return s.held && !s.ends && s.state != MotionState::kStationary && std::isfinite(s.duration);
    });
    ASSERT_NE(odd, segments.end());
    const auto& [start, r, v, w, a, dw, spin_decay, duration, state, held, ends] = *odd;
    expect_unusual({start, r[0], r[1], r[2], v[0], v[1], v[2], w[0], w[1], w[2], a[0], a[1], dw[0], dw[1],
                    spin_decay, duration});
    EXPECT_TRUE(start > 0.0 && state != MotionState::kStationary && held && !ends);
    const auto& [time, type, ball, partner, detail, slow] = record.events.at(4);
    EXPECT_TRUE(slow);
    EXPECT_TRUE(time != 0.0 && type != EventType::kCueStrike && ball != -1 && partner != -1 && detail != -1);
    const auto& [detect_ns, resolve_ns, kernel_ns, steps, method, queue_ns] = record.costs.at(1);
    expect_unusual({detect_ns, resolve_ns, kernel_ns, queue_ns});
    EXPECT_TRUE(steps != 0 && !method.empty());
    expect_unusual({record.gravity - 9.81, record.setup_detect_ns, record.duration, record.start_time});
    EXPECT_NE(record.stopped, StopReason::kAtRest);
}

TEST(RecordFile, ReadsBackWhole) {
    const TemporaryFolder folder;
    const Record a = sample_record();
    write_record(a, folder.file("a.json"));
    std::vector<std::string> notes;
    const Record b = read_record(folder.file("a.json"), &notes);
    EXPECT_EQ(notes, std::vector<std::string>{});
    EXPECT_TRUE(b.table == a.table);
    EXPECT_TRUE(b.balls == a.balls);
    EXPECT_TRUE(b.render == a.render);
    EXPECT_TRUE(b.tracks == a.tracks);
    EXPECT_TRUE(b.events == a.events);
    EXPECT_TRUE(b.costs == a.costs);
    EXPECT_TRUE(b == a);
    EXPECT_EQ(b.hash(), a.hash());
    EXPECT_EQ(b.partner_id(b.events[5]), "p,1");
    // A second round trip yields the same file byte for byte, which also keeps signed zeros, although they
    // compare equal.
    EXPECT_TRUE(std::signbit(b.table.cushions.at(0).from.y()));
    write_record(b, folder.file("b.json"));
    EXPECT_EQ(test::read_file(folder.file("a.json")), test::read_file(folder.file("b.json")));
}

TEST(RecordFile, KeepsUnknownMethods) {
    const TemporaryFolder folder;
    Record record = sample_record();
    const std::string longer(200, 'm');
    record.costs[2].method = longer;
    write_record(record, folder.file("a.json"));
    EXPECT_EQ(read_record(folder.file("a.json")).costs.at(2).method, longer);
}

TEST(Record, AGrowingCopyHasItsOwnOrientations) {
    const auto roll = [](double start) {
        Segment s;
        s.start = start;
        s.r = Vec3(start, 0.0, 0.03);
        s.v = Vec3(1.0, 0.0, 0.0);
        s.w = Vec3(0.0, 30.0 + start, 0.0);
        s.a = s.dw = Vec2::Zero();
        s.duration = kInfinity;
        return s;
    };
    Record record;
    record.balls = make_ball_params("pool");
    record.duration = 0.1;
    record.tracks.push_back({"cue", {roll(0.0)}});
    record.orientation_at(0, 0.05);
    Record longer = record;
    longer.duration = 0.2;
    longer.tracks[0].segments.push_back(roll(0.1));
    const Eigen::Quaterniond turned = longer.orientation_at(0, 0.2);
    EXPECT_NEAR(
        turned.angularDistance(Eigen::Quaterniond(Eigen::AngleAxisd(30.0 * 0.1 + 30.1 * 0.1, Vec3::UnitY()))),
        0.0, 1e-7);
}

TEST(RecordFile, LeavesNoTemporaryFile) {
    const TemporaryFolder folder;
    folder.write("a.json", "old");
    write_record(sample_record(), folder.file("a.json"));
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
    EXPECT_EQ(test::read_file(folder.file("a.json")), record_json(sample_record()));
}

TEST(RecordFile, AFailureNamesTheFileAndKeepsTheOldFile) {
    const TemporaryFolder folder;
    Record broken = sample_record();
    broken.costs.pop_back();
    folder.write("a.json", "old");
    EXPECT_THROW(write_record(broken, folder.file("a.json")), std::runtime_error);
    EXPECT_THROW(record_json(broken), std::runtime_error);
    EXPECT_EQ(test::read_file(folder.file("a.json")), "old");
    try {
        write_record(sample_record(), folder.file("none/a.json"));
        FAIL() << "a folder that is not there";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("none/a.json: "), std::string::npos) << error.what();
    }
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
}

TEST(RecordFile, ADeviceIsWrittenNotReplaced) {
    write_record(sample_record(), "/dev/null");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace carom
