// Records as files: the same bits come back, nothing half-written stays, and no file crashes the reader.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "reference/random_impacts.h"
#include "support/process.h"

namespace carom {
using namespace reference;
namespace {

using Json = nlohmann::json;
using test::TemporaryFolder;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Any finite double, all exponents alike; signed zeros and subnormals are among them.
double any_double(reference::SplitMix64& rng) {
    for (;;) {
        const double value = std::bit_cast<double>(rng.next());
        if (std::isfinite(value)) return value;
    }
}

Segment any_segment(reference::SplitMix64& rng, double start) {
    Segment s;
    s.start = start;
    for (int i = 0; i < 3; ++i) {
        s.r[i] = any_double(rng);
        s.v[i] = any_double(rng);
        s.w[i] = any_double(rng);
    }
    for (int i = 0; i < 2; ++i) {
        s.a[i] = any_double(rng);
        s.dw[i] = any_double(rng);
    }
    s.spin_decay = std::abs(any_double(rng));
    s.duration = rng.next() % 3 == 0 ? kInfinity : std::abs(any_double(rng));
    s.state = static_cast<MotionState>(rng.next() % 5);
    s.held = rng.next() % 2 == 0;
    s.ends = rng.next() % 2 == 0;
    return s;
}

Record sample_record() {
    reference::SplitMix64 rng(7);
    Record record;
    record.table.preset = "nine_foot";
    record.table.width = 1.27;
    record.table.length = 2.54;
    record.table.cushions = {{"left", {0.0, -0.0}, {0.1, 2.54}, 0.037}};
    record.table.jaws = {{"jaw \"1\"", {1e-300, 0.1}, 0.04, 0.037}};
    record.table.pockets = {{"p,1", {1.0 / 3.0, 0.1}, 0.06, 0.08}};
    record.balls = {0.028575, 0.170097, 0.2, 0.01, 0.0127, 0.05, 0.95, 0.85, 0.2};
    record.gravity = 9.80665;
    record.render = {59.94, 1920, 1080, "top", Vec3(0.1, -1.0 / 3.0, 2.0), Vec3(0.5, 1.0, 0.0)};
    record.duration = 7.0 / 3.0;
    record.stopped = StopReason::kEvents;
    record.setup_detect_ns = 1234.5;
    for (int ball = 0; ball < 3; ++ball) {
        BallTrack track;
        track.id = "ball " + std::to_string(ball);
        for (int i = 0; i < 200; ++i) track.segments.push_back(any_segment(rng, i / 300.0));
        track.pocket = ball == 1 ? 0 : -1;
        record.tracks.push_back(track);
    }
    record.tracks[0].segments[0].v = Vec3(-0.0, 5e-324, std::numeric_limits<double>::max());
    record.events = {{0.0, EventType::kCueStrike, 0, -1},     {0.1, EventType::kBallBall, 0, 2},
                     {0.1, EventType::kBallCushion, 1, 0},    {0.2, EventType::kBallJaw, 1, 0},
                     {0.3, EventType::kBallPocket, 1, 0},     {1.0 / 3.0, EventType::kSlideRoll, 0, -1},
                     {7.0 / 3.0, EventType::kRollStop, 2, -1}};
    record.events.insert(record.events.begin() + 2, {0.1, EventType::kBallCluster, 0, 1, 0});
    record.clusters = {{0, 1, 2}};
    record.events[4].detail = 1;  // a jaw is a round nose
    record.start_time = 1e6 / 3.0;
    for (std::size_t i = 0; i < record.events.size(); ++i) {
        record.costs.push_back(
            {0.1 * static_cast<double>(i), 2.5, 1.25, static_cast<long>(i), i == 1 ? "march" : ""});
    }
    return record;
}

void expect_same_segment(const Segment& a, const Segment& b) {
    EXPECT_TRUE(same_bits(a.start, b.start));
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(same_bits(a.r[i], b.r[i])) << a.r[i];
        EXPECT_TRUE(same_bits(a.v[i], b.v[i])) << a.v[i];
        EXPECT_TRUE(same_bits(a.w[i], b.w[i])) << a.w[i];
    }
    for (int i = 0; i < 2; ++i) {
        EXPECT_TRUE(same_bits(a.a[i], b.a[i])) << a.a[i];
        EXPECT_TRUE(same_bits(a.dw[i], b.dw[i])) << a.dw[i];
    }
    EXPECT_TRUE(same_bits(a.spin_decay, b.spin_decay));
    EXPECT_TRUE(same_bits(a.duration, b.duration));
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.held, b.held);
    EXPECT_EQ(a.ends, b.ends);
}

TEST(RecordFile, ReadsBackToTheSameBits) {
    const TemporaryFolder folder;
    const Record a = sample_record();
    write_record(a, folder.file("a.json"));
    const Record b = read_record(folder.file("a.json"));
    ASSERT_EQ(b.tracks.size(), a.tracks.size());
    for (std::size_t i = 0; i < a.tracks.size(); ++i) {
        EXPECT_EQ(b.tracks[i].id, a.tracks[i].id);
        EXPECT_EQ(b.tracks[i].pocket, a.tracks[i].pocket);
        ASSERT_EQ(b.tracks[i].segments.size(), a.tracks[i].segments.size());
        for (std::size_t k = 0; k < a.tracks[i].segments.size(); ++k) {
            expect_same_segment(a.tracks[i].segments[k], b.tracks[i].segments[k]);
        }
    }
    ASSERT_EQ(b.events.size(), a.events.size());
    ASSERT_EQ(b.costs.size(), a.costs.size());
    for (std::size_t i = 0; i < a.events.size(); ++i) {
        EXPECT_TRUE(same_bits(a.events[i].time, b.events[i].time));
        EXPECT_EQ(a.events[i].type, b.events[i].type);
        EXPECT_EQ(a.events[i].a, b.events[i].a);
        EXPECT_EQ(a.events[i].b, b.events[i].b);
        EXPECT_EQ(a.events[i].detail, b.events[i].detail);
        EXPECT_TRUE(same_bits(a.costs[i].detect_ns, b.costs[i].detect_ns));
        EXPECT_EQ(a.costs[i].steps, b.costs[i].steps);
        EXPECT_STREQ(a.costs[i].method, b.costs[i].method);
    }
    EXPECT_EQ(b.hash(), a.hash());
    EXPECT_EQ(b.clusters, a.clusters);
    EXPECT_TRUE(same_bits(a.start_time, b.start_time));
    EXPECT_EQ(b.stopped, a.stopped);
    EXPECT_TRUE(same_bits(a.duration, b.duration));
    EXPECT_TRUE(same_bits(a.gravity, b.gravity));
    EXPECT_TRUE(same_bits(a.setup_detect_ns, b.setup_detect_ns));
    EXPECT_TRUE(same_bits(a.balls.mu_sp, b.balls.mu_sp));
    EXPECT_TRUE(same_bits(a.render.fps, b.render.fps));
    EXPECT_EQ(b.render.width, 1920);
    EXPECT_EQ(b.render.eye, a.render.eye);
    EXPECT_EQ(b.render.target, a.render.target);
    EXPECT_EQ(b.table.jaws.at(0).id, "jaw \"1\"");
    EXPECT_TRUE(std::signbit(b.table.cushions.at(0).from.y()));
    EXPECT_EQ(b.partner_id(b.events[5]), "p,1");
    // A second trip gives the same file, byte for byte.
    write_record(b, folder.file("b.json"));
    EXPECT_EQ(test::read_file(folder.file("a.json")), test::read_file(folder.file("b.json")));
}

TEST(RecordFile, LeavesNoTemporaryFile) {
    const TemporaryFolder folder;
    folder.write("a.json", "old");
    write_record(sample_record(), folder.file("a.json"));
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
    EXPECT_EQ(test::read_file(folder.file("a.json")).substr(0, 10), "{\"format\":");
}

TEST(RecordFile, AFailureNamesTheFileAndKeepsTheOldOne) {
    const TemporaryFolder folder;
    Record broken = sample_record();
    broken.costs.pop_back();
    folder.write("a.json", "old");
    EXPECT_THROW(write_record(broken, folder.file("a.json")), std::runtime_error);
    EXPECT_EQ(test::read_file(folder.file("a.json")), "old");
    try {
        write_record(sample_record(), folder.file("none/a.json"));
        FAIL() << "a folder that is not there";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("none/a.json: "), std::string::npos) << error.what();
    }
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
}

TEST(RecordFile, ADeviceIsWrittenToAndNotReplaced) {
    write_record(sample_record(), "/dev/null");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

/// Reads `text` as a record; the message of its error, which names the file, without that name.
std::string error_of(const std::string& text) {
    const TemporaryFolder folder;
    const std::string path = folder.write("r.json", text);
    try {
        read_record(path);
    } catch (const SceneError& error) {
        const std::string what = error.what();
        EXPECT_EQ(what.substr(0, path.size() + 1), path + ":");
        return what.substr(path.size() + 1);
    }
    return "no error";
}

/// The sample as JSON with one value replaced.
std::string changed(const std::string& pointer, const Json& value) {
    static const std::string text = [] {
        const TemporaryFolder folder;
        write_record(sample_record(), folder.file("r.json"));
        return test::read_file(folder.file("r.json"));
    }();
    Json json = Json::parse(text);
    if (!pointer.empty()) json[Json::json_pointer(pointer)] = value;
    return json.dump();
}

TEST(RecordFile, SaysWhatIsWrong) {
    const struct {
        const char* pointer;
        Json value;
        const char* message;
    } kCases[] = {
        {"/format", "other", " this is no record of carom; carom simulate SCENE -o shot.json writes one"},
        {"/version", 2, " version: this program reads version 1 only"},
        {"/duration", -1, " duration: expected a number of at least 0"},
        {"/duration", nullptr, " duration: expected a number"},
        {"/stopped", "tired", " stopped: unknown name \"tired\""},
        {"/table/preset", std::string(300, 'x'), " table.preset: the string is longer than 256 bytes"},
        {"/table/preset", 5, " table.preset: expected a string"},
        {"/balls/R", 0, " balls.R: expected a number greater than 0"},
        {"/render/size", Json::array({1}), " render.size: expected [width, height]"},
        {"/render/size/0", 0, " render.size[0]: expected an integer from 1 to 16384"},
        {"/render/size/0", 18446744073709551615u, " render.size[0]: expected an integer from 1 to 16384"},
        {"/tracks", Json::array(), " tracks: a record needs at least one ball"},
        {"/tracks", 5, " tracks: expected a list"},
        {"/tracks/1/segments", Json::array(), " tracks[1].segments: a ball needs at least one segment"},
        {"/tracks/0/segments/3/r", Json::array({1, 2}),
         " tracks[0].segments[3].r: expected a list of 3 numbers"},
        {"/tracks/0/segments/3/r/1", "x", " tracks[0].segments[3].r[1]: expected a number"},
        {"/tracks/0/segments/3/start", 0.0,
         " tracks[0].segments[3]: starts before the segment in front of it"},
        {"/tracks/0/segments/3/duration", -1.0,
         " tracks[0].segments[3].duration: expected a number of at least 0"},
        {"/tracks/0/segments/3/held", 1, " tracks[0].segments[3].held: expected true or false"},
        {"/tracks/0/pocket", 1, " tracks[0].pocket: expected an integer from -1 to 0"},
        {"/events/0/a", 3, " events[0].a: expected an integer from 0 to 2"},
        {"/events/0/a", 0.5, " events[0].a: expected an integer from 0 to 2"},
        {"/events/0/b", 0, " events[0].b: expected an integer from -1 to -1"},
        {"/events/1/b", -1, " events[1].b: expected an integer from 0 to 2"},
        {"/events/3/b", 1, " events[3].b: expected an integer from 0 to 0"},
        {"/events/3/type", "ball_moon", " events[3].type: unknown name \"ball_moon\""},
        {"/events/1/time", 9.0, " events[2]: happens before the event in front of it"},
        {"/events/2/balls/1", 3, " events[2].balls[1]: expected an integer from 0 to 2"},
        {"/events/4/nose", -1, " events[4].nose: expected an integer from 0 to 2"},
        {"/events/1/steps", -1, " events[1].steps: expected an integer from 0 to 9223372036854775807"},
    };
    EXPECT_EQ(error_of(changed("", nullptr)), "no error");
    for (const auto& c : kCases) EXPECT_EQ(error_of(changed(c.pointer, c.value)), c.message) << c.pointer;
}

TEST(RecordFile, HostileFilesAreErrors) {
    const std::string cut = changed("", nullptr);
    EXPECT_EQ(error_of(""), "1:1: this is not JSON, or the file was cut short");
    EXPECT_EQ(error_of("{\n  \"format\" 1}"), "2:12: this is not JSON, or the file was cut short");
    EXPECT_NE(error_of(cut.substr(0, cut.size() / 2)).find("cut short"), std::string::npos);
    EXPECT_NE(error_of(std::string(1000000, '[')).find("not JSON"), std::string::npos);
    EXPECT_NE(error_of(std::string(1000000, '[') + std::string(1000000, ']')).find("no record"),
              std::string::npos);
    EXPECT_NE(error_of("{\"format\":\"carom-record\",\"version\":1e999}").find("cannot be read"),
              std::string::npos);
    EXPECT_NE(error_of("{\"format\":\"\xff\"}").find("not JSON"), std::string::npos);
    EXPECT_NE(error_of("null").find("no record"), std::string::npos);
    EXPECT_NE(error_of("{\"format\":\"carom-record\"}").find("the key \"version\" is missing"),
              std::string::npos);
    EXPECT_NE(error_of(std::string(64, '\0')).find("not JSON"), std::string::npos);
    EXPECT_THROW(read_record("/nonexistent/r.json"), SceneError);
    EXPECT_THROW(read_record("/dev/zero"), SceneError);
    EXPECT_THROW(read_record("/"), SceneError);
}

TEST(RecordFile, AnyChangedByteIsReadOrRefused) {
    reference::SplitMix64 rng(11);
    Record small = sample_record();
    for (BallTrack& track : small.tracks) track.segments.resize(2);
    const TemporaryFolder folder;
    const std::string path = folder.file("r.json");
    write_record(small, path);
    const std::string text = test::read_file(path);
    int refused = 0;
    for (int i = 0; i < 1000; ++i) {
        std::string bad = text;
        for (std::uint64_t n = rng.next() % 3; n-- > 0;) {
            const std::size_t at = rng.next() % bad.size(), length = 1 + rng.next() % 20;
            bad.erase(at, length);
        }
        const std::size_t at = rng.next() % bad.size();
        bad[at] = static_cast<char>(rng.next());
        folder.write("r.json", bad);
        try {
            const Record record = read_record(path);
            ASSERT_FALSE(record.tracks.empty());
        } catch (const SceneError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace carom
