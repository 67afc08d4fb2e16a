// carom sweep: one table, whatever the number of threads and parts, and whatever happened on the way.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "cli.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;

/// Eight-ball breaks that differ in aim, speed and rack.
std::vector<std::string> breaks(int count, const std::string& output,
                                const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {
        "sweep",   std::string(CAROM_SOURCE_DIR) + "/scenes/eight_ball_break.toml",
        "--vary",  "cue.aim_deg=normal(0.3)",
        "--vary",  "cue.speed=uniform(8,10)",
        "--vary",  "rack.seed=integer(1,1000000)",
        "--seed",  "7",
        "--count", std::to_string(count),
        "-o",      output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

void expect_ok(const ProcessResult& result) {
    EXPECT_EQ(result.status, 0) << result.err;
}

/// The file that a sweep leaves when it is stopped, or "".
std::string part_in(const TemporaryFolder& folder) {
    for (const auto& entry : fs::directory_iterator(folder.path()))
        if (entry.path().extension() == ".part") return entry.path().string();
    return "";
}

/// Waits until some rows stand in the unfinished file of a sweep.
std::string wait_for_rows(const TemporaryFolder& folder) {
    for (int i = 0; i < 1000; ++i) {
        const std::string part = part_in(folder);
        if (!part.empty() && lines_of(read_file(part)).size() > 5) return part;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return "";
}

TEST(CliSweep, TheTableIsTheSameForAnyJobsAndAsShards) {
    const TemporaryFolder folder;
    const std::string one = folder.file("one.csv"), two = folder.file("two.csv");
    expect_ok(carom(breaks(60, one, {"--jobs", "1"})));
    expect_ok(carom(breaks(60, two, {"--jobs", "3"})));
    const std::string whole = read_file(one);
    EXPECT_EQ(whole, read_file(two));
    std::string parts;
    for (const char* shard : {"1/4", "2/4", "3/4", "4/4"}) {
        expect_ok(carom(breaks(60, folder.file("part.csv"), {"--shard", shard})));
        parts += read_file(folder.file("part.csv"));
        fs::remove(folder.file("part.csv"));
    }
    EXPECT_EQ(whole, parts);
    EXPECT_EQ(part_in(folder), "");

    const std::vector<std::string> lines = lines_of(whole);
    ASSERT_EQ(lines.size(), 61u);
    EXPECT_EQ(lines[0].substr(0, 116),
              "shot,cue.aim_deg,cue.speed,rack.seed,outcome,duration,events,first_contact,contacts,cushions,"
              "pocketed,cue.x,cue.y,cu");
    for (std::size_t i = 1; i < lines.size(); ++i) {
        EXPECT_EQ(lines[i].find(std::to_string(i - 1) + ","), 0u) << lines[i];
        EXPECT_EQ(std::count(lines[i].begin(), lines[i].end(), ','),
                  std::count(lines[0].begin(), lines[0].end(), ','));
        EXPECT_NE(lines[i].find(",at_rest,"), std::string::npos) << lines[i];
    }
}

TEST(CliSweep, GoesOnAfterAKill) {
    const TemporaryFolder folder;
    const std::string whole = folder.file("whole.csv"), killed = folder.file("killed.csv");
    const std::vector<std::string> command = breaks(600, killed, {"--jobs", "2"});
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.begin(), CAROM_PROGRAM);
    std::string part;
    {
        const Process process(arguments, {});
        part = wait_for_rows(folder);
        ASSERT_NE(part, "");
        // The destructor kills it with SIGKILL.
    }
    EXPECT_FALSE(fs::exists(killed));
    // Half a row, as a full disk or a crash may leave it.
    std::ofstream(part, std::ios::app) << "123,90.0";
    const ProcessResult result = carom(command);
    expect_ok(result);
    EXPECT_NE(result.err.find("going on with " + part), std::string::npos) << result.err;
    EXPECT_EQ(part_in(folder), "");
    expect_ok(carom(breaks(600, whole)));
    EXPECT_EQ(read_file(killed), read_file(whole));
}

TEST(CliSweep, AnInterruptLeavesWhatWasDone) {
    const TemporaryFolder folder;
    const std::string output = folder.file("a.csv");
    std::vector<std::string> arguments = breaks(100000, output);
    arguments.insert(arguments.begin(), CAROM_PROGRAM);
    Process process(arguments, {});
    const std::string part = wait_for_rows(folder);
    ASSERT_NE(part, "");
    const ProcessResult second = carom(breaks(100000, output));
    EXPECT_EQ(second.status, 1);
    EXPECT_EQ(second.err, "carom: " + part + ": another program is writing this file\n");
    process.interrupt();
    const ProcessResult result = process.finish("");
    EXPECT_EQ(result.status, 130);
    EXPECT_EQ(result.err, "carom: stopped; the same command goes on with " + part + "\n");
    EXPECT_FALSE(fs::exists(output));
    const std::string rows = read_file(part);
    EXPECT_EQ(rows.back(), '\n');

    // Rows of another build are not continued.
    std::ofstream(part, std::ios::app) << lines_of(rows).size() - 1 << ",1,2,3\n";
    const ProcessResult again = carom(breaks(100000, output));
    EXPECT_EQ(again.status, 1);
    EXPECT_NE(again.err.find("its last row is not what this program computes"), std::string::npos)
        << again.err;
}

TEST(CliSweep, AStatusFileSaysHowFarItIs) {
    const TemporaryFolder folder;
    const std::string status = folder.file("status.json"), output = folder.file("a.csv");
    expect_ok(carom(breaks(30, output, {"--shard", "2/3", "--status", status})));
    const auto done = nlohmann::json::parse(read_file(status));
    EXPECT_EQ(done["state"], "done");
    EXPECT_EQ(done["output"], output);
    EXPECT_EQ(done["first"], 10);
    EXPECT_EQ(done["last"], 20);
    EXPECT_EQ(done["rows"], 10);
    EXPECT_EQ(done["played"], 10);
    EXPECT_GT(done["shots_per_second"], 0.0);
    EXPECT_EQ(done["outcomes"]["at_rest"], 10);
    EXPECT_EQ(done["outcomes"]["failed"], 0);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.csv", "status.json"}));

    const std::string nowhere = folder.file("no/status.json");
    const ProcessResult refused = carom(breaks(30, output, {"--status", nowhere}));
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find(nowhere), std::string::npos) << refused.err;
}

TEST(CliSweep, TheLastShardOfTheLargestSweepHasItsNumbers) {
    const TemporaryFolder folder;
    const std::string status = folder.file("status.json");
    // 2^53 shots in 999 999 parts: no shard has a whole
    // share, and the product of the two numbers has 73 bits.
    std::vector<std::string> arguments =
        breaks(1, folder.file("a.csv"), {"--shard", "999999/999999", "--status", status, "--jobs", "1"});
    arguments.insert(arguments.begin(), CAROM_PROGRAM);
    *(std::find(arguments.begin(), arguments.end(), "--count") + 1) = "9007199254740992";
    Process process(arguments, {});
    const std::string part = wait_for_rows(folder);
    ASSERT_NE(part, "");
    process.interrupt();
    EXPECT_EQ(process.finish("").status, 130);
    const auto stopped = nlohmann::json::parse(read_file(status));
    EXPECT_EQ(stopped["state"], "stopped");
    EXPECT_EQ(stopped["first"], 9007190247532730);  // floor(2^53 * 999998 / 999999)
    EXPECT_EQ(stopped["last"], 9007199254740992);
    EXPECT_EQ(read_file(part).find("9007190247532730,"), 0u);
    const std::vector<std::string> rows = lines_of(read_file(part));
    EXPECT_EQ(stopped["rows"], rows.size());
    EXPECT_EQ(rows.back().find(std::to_string(9007190247532730 + rows.size() - 1) + ","), 0u) << rows.back();

    // The same command goes on, and says which rows are there without having played them.
    Process again(arguments, {});
    for (int i = 0; i < 1000 && lines_of(read_file(part)).size() < rows.size() + 5; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    again.interrupt();
    EXPECT_EQ(again.finish("").status, 130);
    const auto later = nlohmann::json::parse(read_file(status));
    EXPECT_EQ(later["rows"].get<std::uint64_t>() - later["played"].get<std::uint64_t>(), rows.size());
}

TEST(CliSweep, ShotsThatCannotBePlayedAreRowsToo) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", kSmallScene), output = folder.file("a.csv");
    expect_ok(carom(
        {"sweep", scene, "--vary", "ball.cue.position.y=uniform(1.7,2.1)", "--count", "40", "-o", output}));
    const std::vector<std::string> lines = lines_of(read_file(output));
    int invalid = 0, hit = 0;
    for (const std::string& line : lines) {
        invalid += line.find(",invalid,,,,,,,,,,,,,,,,\"balls \"\"") != std::string::npos;
        hit += line.find(",1,") != std::string::npos;
    }
    EXPECT_GT(invalid, 3);
    EXPECT_GT(hit, 3);
}

TEST(CliSweep, AShotThatFailsIsARowAndAnExitStatus) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", kStuckScene), output = folder.file("a.csv");
    const ProcessResult result =
        carom({"sweep", scene, "--vary", "balls.mu_s=list(0.6,0.0)", "--count", "8", "-o", output});
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find(" shots failed while running; their rows say why\n"), std::string::npos)
        << result.err;
    int failed = 0, stopped = 0;
    for (const std::string& line : lines_of(read_file(output))) {
        failed +=
            line.find(",0.6,failed,") != line.npos && line.find("reached its limit of steps") != line.npos;
        stopped += line.find(",0,time,1,") != line.npos;
    }
    EXPECT_GT(failed, 0);
    EXPECT_EQ(failed + stopped, 8);
}

TEST(CliSweep, SaysWhatItNeeds) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", kSmallScene), output = folder.file("a.csv");
    const auto error = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"sweep", scene, "-o", output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult result = carom(arguments);
        EXPECT_EQ(result.status, 2);
        EXPECT_EQ(result.out, "");
        return result.err;
    };
    const std::string vary = "cue.speed=uniform(1,2)";
    EXPECT_EQ(error({"--count", "3"}), "carom: --vary is required; see carom sweep --help\n");
    EXPECT_EQ(error({"--vary", vary, "--count", "0"}),
              "carom: --count: expected 1 to 9007199254740992 shots\n");
    EXPECT_EQ(error({"--vary", vary, "--count", "3", "--shard", "3/2"}),
              "carom: --shard 3/2: expected I/N with 1 <= I <= N, as in 2/4\n");
    EXPECT_EQ(error({"--vary", "cue.speed=uniform(2,1)", "--count", "3"}),
              "carom: --vary: cue.speed=uniform(2,1): uniform(a,b) needs a <= b\n");
    EXPECT_EQ(error({"--vary", vary, "--count", "9007199254740993"}),
              "carom: --count: expected 1 to 9007199254740992 shots\n");
    EXPECT_EQ(error({"--vary", vary, "--count", "3", "--status", output}),
              "carom: --status and -o name the same file; give each its own\n");
    EXPECT_NE(error({"--vary", vary, "--count", "3x"}).find("--count"), std::string::npos);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"s.toml"});
    const ProcessResult folder_asked =
        carom({"sweep", scene, "--vary", vary, "--count", "3", "-o", folder.path().string()});
    EXPECT_EQ(folder_asked.status, 1);
    EXPECT_EQ(folder_asked.err, "carom: " + folder.path().string() + ": cannot write: Is a directory\n");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"s.toml"});
    expect_ok(carom({"sweep", scene, "--vary", vary, "--count", "3", "-o", "/dev/null"}));
}

}  // namespace
}  // namespace carom::test
