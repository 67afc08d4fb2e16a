// The record reader: its messages about wrong, old or hostile files. No file crashes it.
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

TEST(RecordFile, ExplainsErrors) {
    EXPECT_EQ(record_error(changed("", nullptr)), "no error");
    // A place in the sample, its new value, and the message.
    const Json rows = Json::parse(test::read_file(CAROM_TEST_DATA "/record_messages.json"));
    for (const Json& row : rows)
        EXPECT_EQ(record_error(changed(row.at(0), row.at(1))), row.at(2).get<std::string>()) << row;
    EXPECT_GE(rows.size(), 30u);
}

// 1e25 rad/s for 1e25 s on a fixed axis, and on a turning one: every number allowed in a record yields a
// state.
TEST(RecordFile, TheLargestNumbersYieldStates) {
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

TEST(RecordFile, UnknownKeysAreIgnoredWithANote) {
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

TEST(RecordFile, EquivalentJsonIsRead) {
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

TEST(Printable, NamesCannotControlATerminal) {
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
