// The reader of records: what it says about a wrong, old or hostile file. No file crashes it.
#include <gtest/gtest.h>
#include <pthread.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/printable.h"
#include "carom/engine/record.h"
#include "record_sample.h"
#include "reference/random_impacts.h"
#include "support/process.h"

namespace carom {
namespace {

using test::changed;
using test::Json;
using test::record_error;
using test::sample_record;
using test::TemporaryFolder;

TEST(RecordFile, SaysWhatIsWrong) {
    const struct {
        const char* pointer;
        Json value;
        const char* message;
    } kCases[] = {
        {"/format", "other", " this is not a carom record; write one with carom simulate SCENE -o shot.json"},
        {"/version", 4,
         " version: this program reads versions 1 to 3; use the carom that wrote it, or write it again: "
         "carom "
         "simulate SCENE -o shot.json"},
        {"/version", 0, " version: expected an integer from 1 to 1000000"},
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
        {"/tracks/1/segments/0/state", "colliding",
         " tracks[1].segments: the motion of a colliding ball before or after its cluster is missing"},
        {"/tracks/0/segments/3/start", 0.0, " tracks[0].segments[3]: starts before the previous segment"},
        {"/tracks/0/segments/3/duration", -1.0,
         " tracks[0].segments[3].duration: expected a number of at least 0"},
        {"/tracks/0/segments/3/held", 1, " tracks[0].segments[3].held: expected true or false"},
        {"/tracks/0/segments/3/w/0", -1.1e25,
         " tracks[0].segments[3].w[0]: expected a number of at most 1e25, which no shot exceeds"},
        {"/duration", 1e300, " duration: expected a number of at most 1e25, which no shot exceeds"},
        {"/tracks/0/pocket", 1, " tracks[0].pocket: expected an integer from -1 to 0"},
        {"/events/0/a", 3, " events[0].a: expected an integer from 0 to 2"},
        {"/events/0/a", 0.5, " events[0].a: expected an integer from 0 to 2"},
        {"/events/0/b", 0, " events[0].b: expected an integer from -1 to -1"},
        {"/events/1/b", -1, " events[1].b: expected an integer from 0 to 2"},
        {"/events/3/b", 1, " events[3].b: expected an integer from 0 to 0"},
        {"/events/3/type", "ball_moon", " events[3].type: unknown name \"ball_moon\""},
        {"/events/3/type", "\x1b[2J\xc2\x9b\xe2\x80\xae", " events[3].type: unknown name \"?[2J??\""},
        {"/render/size/1", "\x1b[2J", " render.size[1]: expected an integer from 1 to 16384"},
        {"/balls/mu_b_more", -1, " balls.mu_b_more: expected a number of at least 0"},
        {"/events/1/time", 9.0, " events[2]: happens before the previous event"},
        {"/events/2/balls/1", 3, " events[2].balls[1]: expected an integer from 0 to 2"},
        {"/events/4/nose", -1, " events[4].nose: expected an integer from 0 to 4"},
        {"/events/1/steps", -1, " events[1].steps: expected an integer from 0 to 9223372036854775807"},
    };
    EXPECT_EQ(record_error(changed("", nullptr)), "no error");
    for (const auto& c : kCases) EXPECT_EQ(record_error(changed(c.pointer, c.value)), c.message) << c.pointer;
}

// 1e25 rad/s for 1e25 s on a fixed axis, and on one that
// swerves: every number that a record may have gives a state.
TEST(RecordFile, TheLargestNumbersGiveStates) {
    Json largest = Json::parse(changed("", nullptr));
    largest["duration"] = 1e25;
    for (Json& track : largest["tracks"]) {
        Json last = track["segments"].back();
        last["state"] = "sliding";
        last["start"] = 0.0;
        last["duration"] = nullptr;
        for (const char* key : {"r", "v", "w"}) last[key] = {1e25, -1e25, 1e25};
        last["a"] = {1e25, 1e25};
        last["dw"] = track == largest["tracks"][0] ? Json{1e25, 1e25} : Json{0.0, 0.0};
        track["segments"] = Json::array({last});
    }
    const Record record = parse_record(largest.dump(), "shot.json");
    for (int ball = 0; ball < static_cast<int>(record.tracks.size()); ++ball) {
        const BallState state = record.state_at(ball, 1e25);
        EXPECT_TRUE(state.position.allFinite() && state.velocity.allFinite() && state.spin.allFinite());
        EXPECT_NEAR(record.orientation_at(ball, 1e25).norm(), 1.0, 1e-12) << ball;
    }
}

TEST(RecordFile, HostileFilesAreErrors) {
    const std::string cut = changed("", nullptr);
    EXPECT_EQ(record_error(""), "1:1: this is not JSON, or the file was cut short");
    EXPECT_EQ(record_error("{\n  \"format\" 1}"), "2:12: this is not JSON, or the file was cut short");
    EXPECT_NE(record_error(cut.substr(0, cut.size() / 2)).find("cut short"), std::string::npos);
    EXPECT_NE(record_error(std::string(1000000, '[')).find("not JSON"), std::string::npos);
    EXPECT_NE(record_error(std::string(1000000, '[') + std::string(1000000, ']')).find("not a carom record"),
              std::string::npos);
    EXPECT_NE(record_error("{\"format\":\"carom-record\",\"version\":1e999}").find("cannot be read"),
              std::string::npos);
    EXPECT_NE(record_error("{\"format\":\"\xff\"}").find("not JSON"), std::string::npos);
    EXPECT_NE(record_error("null").find("not a carom record"), std::string::npos);
    EXPECT_NE(record_error("{\"format\":\"carom-record\"}").find("the key \"version\" is missing"),
              std::string::npos);
    EXPECT_NE(record_error(std::string(64, '\0')).find("not JSON"), std::string::npos);
    EXPECT_EQ(record_error("{\"format\":\"carom-record\",\"\\u0066ormat\":1}"),
              " the key \"format\" appears twice");
    EXPECT_THROW(read_record("/nonexistent/r.json"), SceneError);
    EXPECT_THROW(read_record("/dev/zero"), SceneError);
    EXPECT_THROW(read_record("/"), SceneError);
}

TEST(RecordFile, NestingNeedsNoStack) {
    pthread_attr_t small;
    ASSERT_EQ(pthread_attr_init(&small), 0);
    ASSERT_EQ(pthread_attr_setstacksize(&small, std::size_t{512} << 10), 0);
    const auto read = [](void* found) -> void* {
        const std::string open(1000000, '['), close(1000000, ']');
        auto& messages = *static_cast<std::vector<std::string>*>(found);
        Json in_a_key = Json::parse(changed("", nullptr));
        in_a_key["extra"] = "HERE";
        std::string text = in_a_key.dump();
        text.replace(text.find("\"HERE\""), 6, open + close);
        for (const std::string& t : {open, open + close, text}) messages.push_back(record_error(t));
        return nullptr;
    };
    std::vector<std::string> messages;
    pthread_t thread{};
    ASSERT_EQ(pthread_create(&thread, &small, read, &messages), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&small);
    ASSERT_EQ(messages.size(), 3u);
    EXPECT_EQ(messages[0], "1:1000001: this is not JSON, or the file was cut short");
    EXPECT_NE(messages[1].find("not a carom record"), std::string::npos);
    EXPECT_EQ(messages[2], "no error");
}

/// The sample as version 1 had it.
Json version_1() {
    Json json = Json::parse(changed("/version", 1));
    for (const char* key : {"mu_b_more", "mu_b_fall", "e_c_fall", "e_c_above", "f_c_more", "f_c_fall", "e_t",
                            "e_t_more", "e_t_fall", "e_h"})
        json["balls"].erase(key);
    for (const char* list : {"cushions", "jaws", "pockets"})
        for (Json& part : json["table"][list]) part.erase("name");
    for (Json& event : json["events"]) event.erase("queue_ns");
    return json;
}

TEST(RecordFile, Version1IsReadWithANote) {
    std::vector<std::string> notes;
    const Record old = parse_record(version_1().dump(), "old.json", &notes);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("version 1 of the format lacks mu_b_fit"), std::string::npos) << notes[0];
    // Everything else is present.
    Record expected = sample_record();
    BallParams& balls = expected.balls;
    balls.mu_b_more = balls.mu_b_fall = 0.0;
    balls.e_c_fall = balls.e_c_above = balls.f_c_more = balls.f_c_fall = 0.0;
    balls.e_t_more = balls.e_t_fall = balls.e_h = 0.0;
    balls.e_t = 0.5;
    for (Cushion& c : expected.table.cushions) c.name.clear();
    for (Jaw& j : expected.table.jaws) j.name.clear();
    for (Pocket& p : expected.table.pockets) p.name.clear();
    for (EventCost& cost : expected.costs) cost.queue_ns = 0.0;
    EXPECT_TRUE(old == expected);
    EXPECT_TRUE(parse_record(version_1().dump(), "old.json") == expected);
    // What version 1 may lack, version 2 may not.
    Json json = version_1();
    json["version"] = 2;
    EXPECT_EQ(record_error(json.dump()), " table.cushions[0]: the key \"name\" is missing");
}

TEST(RecordFile, UnknownKeysAreLeftOutWithANote) {
    std::vector<std::string> notes;
    Json json = Json::parse(changed("/tracks/1/segments/2/jerk\x1b", {{"of", {1, "]}", nullptr}}}));
    EXPECT_TRUE(parse_record(json.dump(), "r.json", &notes) == sample_record());
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0], "the key tracks[1].segments[2].jerk? is unknown to this program and was left out");
    json["weather"] = {{"rain", true}};
    json["events"][0]["sound"] = "\"click\\";
    notes.clear();
    EXPECT_TRUE(parse_record(json.dump(), "r.json", &notes) == sample_record());
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].substr(0, 72),
              "3 keys are unknown to this program and were left out, the first of them ");
}

TEST(RecordFile, AnyWayOfWritingTheSameJsonIsRead) {
    const std::string text = changed("", nullptr);
    // Indented, keys and ids as escapes, a byte order mark in front.
    std::string other = "\xef\xbb\xbf" + Json::parse(text).dump(3);
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"\"mu_s\"", "\"\\u006du_s\""},
                                   {"\"ball 1\"", "\"b\\u0061ll\\u00201\""}}) {
        ASSERT_NE(other.find(from), std::string::npos) << from;
        other.replace(other.find(from), from.size(), to);
    }
    EXPECT_TRUE(parse_record(other, "r.json") == sample_record());
    const auto gravity = [&](const std::string& number) {
        std::string changed_text = text;
        const std::string key = "\"gravity\":9.80665";
        EXPECT_NE(changed_text.find(key), std::string::npos);
        changed_text.replace(changed_text.find(key), key.size(), "\"gravity\":" + number);
        return parse_record(changed_text, "r.json").gravity;
    };
    EXPECT_EQ(gravity("1E1"), 10.0);
    EXPECT_EQ(gravity("18446744073709551616"), 0x1p64);
    EXPECT_EQ(gravity("1e-400"), 0.0);
    EXPECT_EQ(gravity("4.9e-324"), 4.9e-324);
    EXPECT_TRUE(std::signbit(gravity("-0.0")));
}

TEST(Printable, NothingSteersATerminal) {
    EXPECT_EQ(printable("cue 8 \xc3\xa9 \xe7\x90\x83 \xf0\x9f\x8e\xb1"),
              "cue 8 \xc3\xa9 \xe7\x90\x83 \xf0\x9f\x8e\xb1");
    EXPECT_EQ(printable("a\x1b[2J\r\n\t\x7f"), "a?[2J????");
    EXPECT_EQ(printable("\xc2\x9b"
                        "2J"),
              "?2J");  // C1
    EXPECT_EQ(printable("\xe2\x80\xae|\xe2\x81\xa6|\xd8\x9c|\xe2\x80\xa8"),
              "?|?|?|?");                                       // direction, line end
    EXPECT_EQ(printable("\xff|\xc0\x80|\xe7\x90"), "?|??|??");  // no UTF-8
    EXPECT_EQ(printable(std::string(60, 'x')), std::string(60, 'x'));
    EXPECT_EQ(printable(std::string(61, 'x')), std::string(60, 'x') + "...");
    EXPECT_EQ(printable(std::string(59, 'x') + "\xc3\xa9"), std::string(59, 'x') + "...");
    EXPECT_EQ(in_quotes("a\n"), "\"a?\"");
}

TEST(RecordFile, AnyChangedByteIsReadOrRefused) {
    reference::Generator rng(11);
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
