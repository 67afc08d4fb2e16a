// carom view and carom play: their pages. The script computes the engine's states bit for bit; a browser
// shows them, navigates by keys and pointer, prints nothing on its console, and loads nothing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "browser.h"
#include "carom/engine/record.h"
#include "carom/kernel/splitmix64.h"
#include "carom/render/draw_list.h"
#include "cli.h"

namespace carom::test {
namespace {

std::string stem(const std::string& path) {
    return std::filesystem::path(path).stem().string();
}

/// A record whose balls have names that would end the script, begin a tag, or end a line. Scenes refuse such
/// names, but records may come from anywhere.
std::string hostile_record(const TemporaryFolder& folder) {
    const std::string file = folder.file("hostile.json");
    EXPECT_EQ(carom({"simulate", folder.write("small.toml", kSmallScene), "-o", file, "--hash"}).status, 0);
    Json record = Json::parse(read_file(file));
    record["tracks"][0]["id"] = "</script><script>document.title='x'</script>";
    record["tracks"][1]["id"] = "<b>1</b><!--";
    record["tracks"][2]["id"] = "a\u2028b'\"&amp;\\";
    return folder.write("hostile.json", record.dump());
}

/// Times at which a page is compared with the engine: outside the shot, regular ones, events and their
/// neighbours, random ones.
std::vector<double> times_of(const Record& record) {
    std::vector<double> times = {-1.0, 0.0, record.duration, record.duration + 1.0};
    for (int k = 1; k < 300; ++k) times.push_back(record.duration * k / 300.0);
    for (const Event& event : record.events)
        for (const double toward : {-1.0, 1e9}) {
            times.push_back(event.time);
            times.push_back(std::nextafter(event.time, toward));
        }
    SplitMix64 random(7);
    for (int k = 0; k < 200; ++k) times.push_back(record.duration * random.uniform());
    return times;
}

std::string states_csv(const Record& record) {
    std::string csv;
    for (const double t : times_of(record)) {
        for (int i = 0; i < static_cast<int>(record.tracks.size()); ++i) {
            const BallState s = record.state_at(i, t);
            csv += fmt::format("{},{},{},{}", i, t, name(s.state), s.pocket);
            for (const Vec3* v : {&s.position, &s.velocity, &s.spin})
                for (const double x : *v) csv += fmt::format(",{}", x);
            const Eigen::Quaterniond q = record.orientation_at(i, t);
            csv += fmt::format(",{},{},{},{}\n", q.w(), q.x(), q.y(), q.z());
        }
    }
    return csv;
}

/// The page of a scene or of a record, and the record that it contains.
struct MadePage {
    std::string file;
    Record record;
};

MadePage make_page(const TemporaryFolder& folder, const std::string& scene,
                   const std::vector<std::string>& options = {}) {
    const std::string file = folder.file(stem(scene) + ".html");
    std::vector<std::string> arguments = {"view", scene, "-o", file};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProcessResult made = carom(arguments);
    EXPECT_EQ(made.status, 0) << made.err;
    if (scene.ends_with(".json")) return {file, read_record(scene)};
    const std::string json = folder.file(stem(scene) + ".json");
    EXPECT_EQ(carom({"simulate", scene, "-o", json, "--hash"}).status, 0);
    return {file, read_record(json)};
}

TEST(View, PageStatesEqualTheEnginesBits) {
    if (!has("node")) GTEST_SKIP() << "node is not installed";
    const TemporaryFolder folder;
    std::vector<std::string> scenes = shipped_scenes();
    scenes.push_back(hostile_record(folder));
    EXPECT_GE(scenes.size(), 20u);
    double most_turned = 0.0;
    for (const std::string& scene : scenes) {
        const MadePage page = make_page(folder, scene);
        const std::string csv = states_csv(page.record), file = folder.write("states.csv", csv);
        const ProcessResult node = run_process({"node", kView + std::string("states.mjs"), page.file, file});
        ASSERT_EQ(node.status, 0) << node.err;
        long compared = 0, differ = -1;
        double turned = 1.0;
        const char* const counts = std::strstr(node.out.c_str(), "compared ");
        ASSERT_NE(counts, nullptr) << node.out;
        ASSERT_EQ(std::sscanf(counts, "compared %ld differ %ld turned %lf", &compared, &differ, &turned), 3)
            << node.out;
        EXPECT_EQ(differ, 0) << scene << "\n" << node.out;
        EXPECT_EQ(compared, 11 * std::count(csv.begin(), csv.end(), '\n'));
        // Orientations use another sin and cos, and accumulate over all segments.
        EXPECT_LT(turned, 1e-9) << scene;
        most_turned = std::max(most_turned, turned);
    }
    RecordProperty("largest_difference_of_an_orientation_rad", fmt::format("{}", most_turned));
}

Json manifest_page(const std::string& name, const MadePage& page) {
    const Record& record = page.record;
    const render::Stage stage(record, {});
    const render::Bounds& bounds = stage.table()->bounds;
    const double times[] = {0.21 * record.duration, 0.55 * record.duration, record.duration};
    Json states = Json::array();
    for (const double t : times) {
        Json balls = Json::array();
        for (int i = 0; i < static_cast<int>(record.tracks.size()); ++i) {
            const BallState s = record.state_at(i, t);
            balls.push_back({{"id", record.tracks[i].id},
                             {"x", s.position.x()},
                             {"y", s.position.y()},
                             {"z", s.position.z()},
                             {"state", carom::name(s.state)},
                             {"radius", record.size(i).R}});
        }
        states.push_back(balls);
    }
    return {
        {"name", name},
        {"file", page.file},
        {"bounds", {{"low", {bounds.low.x(), bounds.low.y()}}, {"high", {bounds.high.x(), bounds.high.y()}}}},
        {"times", times},
        {"states", states}};
}

TEST(View, ABrowserShowsEveryScene) {
    if (!has("node")) GTEST_SKIP() << "node is not installed";
    if (!has("chromium")) GTEST_SKIP() << "chromium is not installed";
    const TemporaryFolder folder;
    Json pages = Json::array();
    std::vector<std::string> scenes = shipped_scenes();
    scenes.push_back(hostile_record(folder));
    for (const std::string& scene : scenes) {
        const bool timed = stem(scene) == "eight_ball_break";
        const MadePage page = make_page(
            folder, scene, timed ? std::vector<std::string>{"--margin"} : std::vector<std::string>());
        pages.push_back(manifest_page(stem(scene), page));
        if (!timed) continue;
        const auto bytes = std::filesystem::file_size(page.file);
        EXPECT_LT(bytes, 200000u) << "the page of a break";
        RecordProperty("bytes_of_the_page_of_a_break", std::to_string(bytes));
    }
    // Two shots in one page, and the distance of their cue balls at some instant.
    const std::string other = CAROM_SOURCE_DIR "/scenes/follow.toml";
    const TemporaryFolder more;
    const MadePage two = make_page(more, CAROM_SOURCE_DIR "/scenes/draw.toml", {other});
    pages.insert(pages.begin(), manifest_page("two", two));
    constexpr double kInstant = 0.9;
    const Vec3 apart = two.record.state_at(0, kInstant).position -
                       make_page(more, other).record.state_at(0, kInstant).position;
    EXPECT_GT(apart.norm(), 0.1);
    pages[0]["second"] = {{"time", kInstant}, {"apart", 1000.0 * apart.norm()}};
    const Json manifest = {{"chromium", "chromium"},
                           {"profile", folder.file("profile")},
                           {"timed", "eight_ball_break"},
                           {"pages", pages},
                           {"reports", Json::array()}};
    expect_no_fault(folder, manifest);
}

TEST(View, APageContainsItsRecordAndPolicy) {
    const TemporaryFolder folder;
    const MadePage page = make_page(folder, hostile_record(folder));
    const std::string html = read_file(page.file);
    EXPECT_TRUE(contains(
        html, "content=\"default-src 'none'; base-uri 'none'; form-action 'none'; style-src 'sha256-"));
    EXPECT_FALSE(contains(html, "unsafe"));
    // Only the page's own scripts end a script; names of balls cannot. The policy has one hash for the style
    // and one for each script; the data are two more elements.
    const auto count = [&html](const char* text) {
        std::size_t found = 0;
        for (std::size_t at = 0; (at = html.find(text, at)) != std::string::npos; ++at) ++found;
        return found;
    };
    EXPECT_GT(count("'sha256-"), 6u);
    EXPECT_EQ(count("</script"), 2u + count("'sha256-") - 1u);
    const std::string before = "<script type=\"application/json\" id=\"shot\">";
    const std::size_t from = html.find(before) + before.size();
    const Record held = parse_record(html.substr(from, html.find("</script>", from) - from), "the page");
    EXPECT_EQ(held.hash(), page.record.hash());
    EXPECT_EQ(held.tracks.at(0).id, "</script><script>document.title='x'</script>");
}

TEST(View, ARecordIsShownUnchanged) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("small.toml", kSmallScene), json = folder.file("shot.json"),
                      page = folder.file("shot.html");
    ASSERT_EQ(carom({"simulate", scene, "-o", json}).status, 0);
    const ProcessResult plain = carom({"view", json, scene, "-o", page});
    EXPECT_EQ(plain.status, 0) << plain.err;
    EXPECT_EQ(plain.err, "");
    EXPECT_TRUE(contains(read_file(page), "id=\"second\""));
    EXPECT_TRUE(contains(read_file(page), "\"margin\":null"));
    EXPECT_TRUE(
        contains(carom({"view", json, "-o", page, "--margin"}).err, "shot.json is not profiled; use"));
    ASSERT_EQ(carom({"simulate", scene, "-o", json, "--profile"}).status, 0);
    const ProcessResult profiled = carom({"view", json, "-o", page});
    EXPECT_EQ(profiled.status, 0) << profiled.err;
    EXPECT_EQ(profiled.err, "");
    EXPECT_TRUE(contains(read_file(page), "simulation only; "));
}

TEST(View, MarginAddsEveryFrameToThePage) {
    const TemporaryFolder folder;
    const std::string page = folder.file("shot.html");
    const ProcessResult made =
        carom({"view", folder.write("small.toml", kSmallScene), "--margin", "-o", page});
    ASSERT_EQ(made.status, 0) << made.err;
    const std::string html = read_file(page), before = "id=\"page\">";
    const std::size_t from = html.find(before) + before.size();
    const Json data = Json::parse(html.substr(from, html.find("</script>", from) - from));
    // Three diamonds between two pockets, on each of six rails.
    EXPECT_EQ(data.at("shape").at("numbers").size(), 18u);
    const Json& margin = data.at("margin");
    EXPECT_EQ(margin.at("series").at(0).at("name"), "whole frame");
    EXPECT_EQ(margin.at("levels").at(0).at("y"), 1000.0 / 60.0);
    EXPECT_EQ(margin.at("marks").size(), 1u);
    EXPECT_EQ(data.at("command"),
              fmt::format("carom view {} --margin -o {}", folder.file("small.toml"), page));
    const Record record = parse_record(
        html.substr(html.find("id=\"shot\">") + 10, html.find("</script>") - html.find("id=\"shot\">") - 10),
        "page");
    EXPECT_EQ(margin.at("series").at(0).at("points").size(),
              static_cast<std::size_t>(record.duration * 60.0) + 1);
    EXPECT_EQ(record.costs.size(), record.events.size());
}

TEST(Play, WritesAPageIfItHasWebAssembly) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("small.toml", kSmallScene), page = folder.file("play.html");
    const ProcessResult made = carom({"play", scene, "--lock", "cue.speed,ball", "-o", page});
    if (made.status == 2) {
        EXPECT_TRUE(contains(made.err, "built without WebAssembly; run tools/web")) << made.err;
        return;
    }
    const std::string html = read_file(page);
    EXPECT_TRUE(contains(html, "\"lock\":[\"cue.speed\",\"ball\"]"));
    EXPECT_TRUE(contains(html, "nine_foot_tight"));
}

}  // namespace
}  // namespace carom::test
