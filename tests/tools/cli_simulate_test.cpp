// carom simulate: one hash, exact headers, the documented JSON, files that are whole or absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/simulate.h"
#include "carom/kernel/isa.h"
#include "cli.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

class CliSimulate : public ::testing::Test {
  protected:
    ProcessResult run(std::vector<std::string> options = {}) {
        options.insert(options.begin(), {"simulate", scene_});
        return carom(options);
    }

    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);
};

TEST_F(CliSimulate, HashIsOneLineAndTheSameOnEveryRunAndInstructionSet) {
    const ProcessResult first = run({"--hash"});
    ASSERT_EQ(first.status, 0) << first.err;
    ASSERT_EQ(first.out.size(), 17u) << first.out;
    EXPECT_EQ(first.out.find_first_not_of("0123456789abcdef"), 16u);
    EXPECT_EQ(first.err, "");
    EXPECT_EQ(run({"--hash"}).out, first.out);
    for (const kernel::Isa isa : {kernel::Isa::kScalar, kernel::Isa::kV3, kernel::Isa::kV4}) {
        if (!kernel::available(isa)) continue;
        EXPECT_EQ(carom_isa(kernel::name(isa), {"simulate", scene_, "--hash"}).out, first.out)
            << kernel::name(isa);
    }
    // Neither profiling nor writing a file changes the hash.
    EXPECT_EQ(lines_of(run({"--hash", "--profile"}).out).at(0) + "\n", first.out);
    EXPECT_EQ(run({"--hash", "-o", folder_.file("r.json")}).out, first.out);
    EXPECT_EQ(read_record(folder_.file("r.json")).hash() + "\n", first.out);
}

TEST_F(CliSimulate, LinesMayHaveWindowsEnds) {
    const auto as_in_windows = [](const std::string& text) {
        std::string out;
        for (const std::string& line : lines_of(text)) out += line + "\r\n";
        return out;
    };
    const std::string hash = run({"--hash", "-o", folder_.file("r.json")}).out;
    EXPECT_EQ(read_file(folder_.file("r.json")).find('\r'), std::string::npos);
    scene_ = folder_.write("windows.toml", as_in_windows(kSmallScene));
    EXPECT_EQ(run({"--hash"}).out, hash);
    const std::string record =
        folder_.write("windows.json", as_in_windows(read_file(folder_.file("r.json"))));
    EXPECT_EQ(read_record(record).hash() + "\n", hash);
}

TEST_F(CliSimulate, VerifyNamesTheBrokenLawAndTheEvent) {
    const ProcessResult good = run({"--hash", "--verify"});
    EXPECT_EQ(good.status, 0) << good.err;
    EXPECT_EQ(good.out, run({"--hash"}).out);
    EXPECT_EQ(good.err, "");
    // The published march with few steps gains energy in a lossless impact.
    const std::string scene =
        folder_.write("gain.toml",
                      "[balls]\ne_b = 1.0\nmu_b = 0.05\n[physics]\nsubsteps = 100\n"
                      "[[ball]]\nid = \"a\"\nposition = [0.3, 0.5]\nvelocity = [0, 3.0]\n"
                      "[[ball]]\nid = \"b\"\nposition = [0.3, 0.55716]\n");
    const ProcessResult bad = carom({"simulate", scene, "--hash", "--verify"});
    EXPECT_EQ(bad.status, 1);
    EXPECT_EQ(bad.out.size(), 17u) << "the result is printed all the same";
    EXPECT_NE(bad.err.find("U4 broken at event "), std::string::npos) << bad.err;
    EXPECT_NE(bad.err.find("(ball_ball a b, t = "), std::string::npos) << bad.err;
    EXPECT_NE(bad.err.find("energy rises from "), std::string::npos) << bad.err;
    EXPECT_EQ(carom({"simulate", scene, "--hash"}).status, 0);
}

// A record of another program is any file.
TEST_F(CliSimulate, VerifyChecksARecordFromAFile) {
    const std::string record = folder_.file("shot.json");
    ASSERT_EQ(run({"--hash", "-o", record}).status, 0);
    const ProcessResult good = run({"--verify", record});
    EXPECT_EQ(good.status, 0) << good.err;
    EXPECT_NE(good.out.find("every law holds"), std::string::npos) << good.out;
    Json bad = Json::parse(read_file(record));
    bad["events"].erase(1);
    const ProcessResult broken = run({"--verify", folder_.write("bad.json", bad.dump())});
    EXPECT_EQ(broken.status, 1);
    EXPECT_NE(broken.err.find("U6 broken at "), std::string::npos) << broken.err;
    // Refused by the first difference.
    bad = Json::parse(read_file(record));
    bad["balls"]["mu_s"] = 0.3;
    const ProcessResult other = run({"--verify", folder_.write("other.json", bad.dump())});
    EXPECT_EQ(other.status, 2);
    EXPECT_NE(
        other.err.find("other.json: the record is of another scene or physics: balls.mu_s is 0.3, and 0.2 "
                       "in the scene"),
        std::string::npos)
        << other.err;
    EXPECT_EQ(run({record}).status, 2) << "a record without --verify";
    EXPECT_EQ(run({"--verify", folder_.file("none.json")}).status, 2);
}

TEST_F(CliSimulate, AnotherSceneHasAnotherHash) {
    std::string text = kSmallScene;
    text.replace(text.find("speed = 4.0"), 11, "speed = 4.1");
    const std::string other = folder_.write("other.toml", text);
    EXPECT_NE(carom({"simulate", other, "--hash"}).out, run({"--hash"}).out);
}

TEST_F(CliSimulate, JsonHasTheDocumentedShape) {
    const ProcessResult result = run({"--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json json = Json::parse(result.out);
    ASSERT_EQ(json.size(), 9u);
    EXPECT_EQ(json.at("first_hit"), "1");
    EXPECT_GT(json.at("duration").get<double>(), 1.0);
    EXPECT_GT(json.at("events").get<int>(), 5);
    EXPECT_EQ(json.at("hash").get<std::string>() + "\n", run({"--hash"}).out);
    ASSERT_EQ(json.at("balls").size(), 3u);
    for (const Json& ball : json.at("balls")) {
        ASSERT_EQ(ball.size(), 8u);
        const std::string state = ball.at("state");
        EXPECT_TRUE(state == "stationary" || state == "pocketed") << state;
        EXPECT_EQ(ball.at("pocket").get<std::string>().empty(), state != "pocketed");
        EXPECT_EQ(ball.at("fell") >= 0, state == "pocketed");
        for (const char* key : {"position", "velocity", "spin"}) {
            ASSERT_EQ(ball.at(key).size(), 3u);
            for (const Json& number : ball.at(key)) EXPECT_TRUE(number.is_number());
        }
    }
    EXPECT_EQ(json.at("balls")[2].at("id"), "ball 2");
}

TEST_F(CliSimulate, JsonNumbersHaveTheBitsOfTheRecord) {
    const Json json = Json::parse(run({"--json", "-o", folder_.file("r.json")}).out);
    const Record record = read_record(folder_.file("r.json"));
    EXPECT_EQ(json.at("duration").get<double>(), record.duration);
    EXPECT_EQ(json.at("events").get<std::size_t>(), record.events.size());
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallState s = record.state_at(static_cast<int>(i), record.duration);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(json.at("balls")[i].at("position")[k].get<double>(), s.position[static_cast<int>(k)]);
            EXPECT_EQ(json.at("balls")[i].at("spin")[k].get<double>(), s.spin[static_cast<int>(k)]);
        }
    }
}

TEST_F(CliSimulate, SummaryDescribesTheShot) {
    const ProcessResult result = run();
    ASSERT_EQ(result.status, 0) << result.err;
    for (const char* part :
         {": 3 balls, ", " events; everything is at rest", " s  cue is struck: ", " s  cue meets 1, cut ",
          "\npocketed\n", "\nfinal positions (m)\n", "\n  cue ", "\n  1 "}) {
        EXPECT_NE(result.out.find(part), std::string::npos) << part << "\n" << result.out;
    }
}

TEST_F(CliSimulate, ALongShotIsSummarisedAndListIsComplete) {
    const std::string rack = CAROM_SOURCE_DIR "/scenes/eight_ball_break.toml";
    const std::string told = carom({"simulate", rack}).out, whole = carom({"simulate", rack, "--list"}).out;
    EXPECT_TRUE(contains(told, "balls at once")) << told;
    EXPECT_TRUE(contains(told, " s  then ")) << told;
    EXPECT_LE(std::count(told.begin(), told.end(), '\n'), 40);
    const std::size_t events = simulate(make_plan(read_scene(rack), kernel::best_isa())).events.size();
    EXPECT_GT(std::count(whole.begin(), whole.end(), '\n'), static_cast<std::ptrdiff_t>(events));
    EXPECT_FALSE(contains(told + whole, "nan"));
}

TEST_F(CliSimulate, InchesAndMilesPerHourOnRequest) {
    const std::string metric = run().out, inch = run({"--units", "inch"}).out;
    EXPECT_TRUE(contains(metric, " m/s\n") && contains(metric, "final positions (m)")) << metric;
    EXPECT_TRUE(contains(inch, " mph\n") && contains(inch, "final positions (in)")) << inch;
    // Files stay in SI.
    run({"--units", "inch", "--events", folder_.file("i.csv")});
    run({"--events", folder_.file("m.csv")});
    EXPECT_EQ(read_file(folder_.file("i.csv")), read_file(folder_.file("m.csv")));
}

TEST_F(CliSimulate, SummaryNamesPocketedBalls) {
    const ProcessResult result = carom({"simulate", CAROM_SOURCE_DIR "/scenes/stop.toml"});
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string_view text = result.out;
    const std::size_t begin = text.find("\npocketed\n"), end = text.find("\n\n", begin);
    ASSERT_NE(end, std::string_view::npos) << text;
    const std::string_view list = text.substr(begin, end - begin);
    EXPECT_EQ(list.rfind("\npocketed\n  1      in p", 0), 0u) << text;
    EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 2) << text;
}

TEST_F(CliSimulate, AFailedRunReportsItsState) {
    const std::string stuck = folder_.write("stuck.toml", kStuckScene);
    const ProcessResult result = carom({"simulate", stuck, "-o", folder_.file("r.json")});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.out, "");
    const std::vector<std::string> lines = lines_of(result.err);
    ASSERT_EQ(lines.size(), 4u) << result.err;
    EXPECT_EQ(lines[0].rfind("carom: simulation stopped at t = 0.00", 0), 0u) << lines[0];
    EXPECT_NE(lines[0].find("after 0 events: the impact of a and b could not be computed: the integration "
                            "reached its limit of steps"),
              std::string::npos)
        << lines[0];
    EXPECT_EQ(lines[1], "last events:");
    EXPECT_EQ(lines[2], "balls that move (id state x y vx vy wx wy wz):");
    EXPECT_EQ(lines[3].rfind("  a sliding ", 0), 0u) << lines[3];
    EXPECT_FALSE(std::filesystem::exists(folder_.file("r.json")));
}

TEST_F(CliSimulate, StopsAfterItsEvents) {
    const std::string scene = folder_.write("e.toml", std::string(kSmallScene) + "[stop]\nevents = 3\n");
    const ProcessResult result = carom({"simulate", scene});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find(" 3 events; stopped at the event limit\n"), std::string::npos) << result.out;
}

TEST_F(CliSimulate, UntilStopsTheRun) {
    const Json json = Json::parse(run({"--json", "--until", "0.125"}).out);
    EXPECT_EQ(json.at("duration").get<double>(), 0.125);
    EXPECT_EQ(json.at("balls")[0].at("state"), "sliding");
    EXPECT_NE(run({"--until", "0.125"}).out.find("stopped at the time limit"), std::string::npos);
}

TEST_F(CliSimulate, ReportsEndlessMotion) {
    const std::string spins = folder_.write(
        "events.toml",
        "[balls]\nmu_sp = 0\n[[ball]]\nposition = [0.6, 0.5]\nspin = [0, 0, 5]\n[stop]\nevents = 4\n");
    const ProcessResult endless = carom({"simulate", spins, "--verify"});
    EXPECT_EQ(endless.status, 0) << endless.err;
    EXPECT_TRUE(contains(endless.out, "1 ball, 0.0000 s, 0 events; no more events, but balls move forever\n"))
        << endless.out;
    ASSERT_EQ(carom({"sweep", spins, "--vary", "ball.cue.position.x=list(1)", "--count", "1", "-o",
                     folder_.file("u.csv")})
                  .status,
              0);
    EXPECT_TRUE(contains(read_file(folder_.file("u.csv")), ",endless,0,0,"));
}

TEST_F(CliSimulate, EventsFile) {
    ASSERT_EQ(run({"--events", folder_.file("e.csv"), "-o", folder_.file("r.json")}).status, 0);
    const std::vector<std::string> lines = lines_of(read_file(folder_.file("e.csv")));
    const Record record = read_record(folder_.file("r.json"));
    ASSERT_EQ(lines.size(), record.events.size() + 1);
    EXPECT_TRUE(lines[0].starts_with("time,type,a,b,a_x,a_y,a_z,")) << lines[0];
    EXPECT_TRUE(lines[1].starts_with("0,cue_strike,cue,,0.635,0.5,")) << lines[1];
    for (std::size_t i = 0; i < record.events.size(); ++i) {
        EXPECT_EQ(std::stod(lines[i + 1]), record.events[i].time);
    }
}

TEST_F(CliSimulate, ProfileAddsColumnsAndAReport) {
    const ProcessResult result = run({"--profile", "--events", folder_.file("e.csv")});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("\ncost by kind of event"), std::string::npos);
    EXPECT_NE(result.out.find("\nkernel by ball-ball event"), std::string::npos);
    const std::vector<std::string> lines = lines_of(read_file(folder_.file("e.csv")));
    EXPECT_TRUE(lines.at(0).starts_with("time,type,a,b,detect_ns,resolve_ns,kernel_ns,steps,method,a_x"));
    int marches = 0;
    for (const std::string& line : lines) {
        if (line.find(",ball_ball,") == std::string::npos) continue;
        ++marches;
        EXPECT_TRUE(contains(line, ",collocation_4,")) << line;
    }
    EXPECT_GT(marches, 0);
    const Json json = Json::parse(run({"--profile", "--json"}).out);
    EXPECT_TRUE(json.at("profile").at("kinds").is_array());
}

TEST_F(CliSimulate, SamplesFile) {
    ASSERT_EQ(
        run({"--samples", folder_.file("s.csv"), "--sample-dt", "0.1", "-o", folder_.file("r.json")}).status,
        0);
    const std::vector<std::string> lines = lines_of(read_file(folder_.file("s.csv")));
    const Record record = read_record(folder_.file("r.json"));
    EXPECT_EQ(lines.at(0), "time,ball,state,x,y,z,vx,vy,vz,wx,wy,wz");
    std::size_t times = 0;
    while (static_cast<double>(times) * 0.1 <= record.duration) ++times;
    ASSERT_EQ(lines.size(), 1 + 3 * times);
    // Row k of the cue ball has the bits of state_at(k dt).
    for (std::size_t k = 0; k < times; ++k) {
        const double time = static_cast<double>(k) * 0.1;
        const BallState s = record.state_at(0, time);
        double x = NAN, y = NAN, row_time = NAN;
        char state[32];
        ASSERT_EQ(std::sscanf(lines[1 + 3 * k].c_str(), "%lf,cue,%31[a-z],%lf,%lf", &row_time, state, &x, &y),
                  4);
        EXPECT_EQ(row_time, time);
        EXPECT_EQ(x, s.position.x());
        EXPECT_EQ(y, s.position.y());
        EXPECT_STREQ(state, name(s.state));
    }
}

TEST_F(CliSimulate, FilesAreReplacedWholeAlsoThroughLinks) {
    folder_.write("real.json", "old");
    std::filesystem::create_symlink(folder_.file("real.json"), folder_.file("link.json"));
    ASSERT_EQ(run({"-o", folder_.file("link.json")}).status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder_.file("link.json")));
    EXPECT_NO_THROW(read_record(folder_.file("real.json")));
    for (const std::string& name : folder_.names()) EXPECT_EQ(name.find(".tmp"), std::string::npos) << name;
}

}  // namespace
}  // namespace carom::test
