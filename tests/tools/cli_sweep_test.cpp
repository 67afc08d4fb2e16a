// carom sweep: the same table for any number of threads and parts, and after any interruption.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "base/fnv.h"
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

/// The folder left by a stopped sweep, or "".
std::string parts_in(const TemporaryFolder& folder) {
    for (const auto& entry : fs::directory_iterator(folder.path()))
        if (entry.path().extension() == ".parts") return entry.path().string();
    return "";
}

/// Its parts, in the order of their shots.
std::vector<std::string> files_in(const std::string& parts) {
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(parts))
        if (entry.path().extension() == ".csv") files.push_back(entry.path().string());
    std::sort(files.begin(), files.end(), [](const std::string& a, const std::string& b) {
        return std::stoull(fs::path(a).stem()) < std::stoull(fs::path(b).stem());
    });
    return files;
}

/// The rows of all parts, without the last two lines of each, which describe it.
std::vector<std::string> rows_in(const std::string& parts) {
    std::vector<std::string> rows;
    for (const std::string& file : files_in(parts)) {
        const std::vector<std::string> lines = lines_of(read_file(file));
        rows.insert(rows.end(), lines.begin(), lines.end() - 2);
    }
    return rows;
}

/// Waits until a sweep has written this many parts.
std::string wait_for_parts(const TemporaryFolder& folder, std::size_t count = 1) {
    for (int i = 0; i < 2000; ++i) {
        const std::string parts = parts_in(folder);
        if (!parts.empty() && files_in(parts).size() >= count) return parts;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return "";
}

/// Interrupts a sweep once it has written some rows. Returns its folder.
std::string interrupted_parts(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), CAROM_PROGRAM);
    Process process(arguments, {});
    std::string parts = wait_for_parts(folder);
    process.interrupt();
    EXPECT_EQ(process.finish("").status, 130);
    return parts;
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
    EXPECT_EQ(parts_in(folder), "");

    const std::vector<std::string> lines = lines_of(whole);
    ASSERT_EQ(lines.size(), 61u);
    EXPECT_TRUE(lines[0].starts_with(
        "shot,cue.aim_deg,cue.speed,rack.seed,status,duration,events,first_hit,contacts,approach_cushions,"
        "pocketed,cue.x,cue.y,cue.pocket,cue.fell,cue.cushions,"))
        << lines[0];
    for (std::size_t i = 1; i < lines.size(); ++i) {
        EXPECT_EQ(lines[i].find(std::to_string(i - 1) + ","), 0u) << lines[i];
        EXPECT_EQ(std::count(lines[i].begin(), lines[i].end(), ','),
                  std::count(lines[0].begin(), lines[0].end(), ','));
        EXPECT_NE(lines[i].find(",at_rest,"), std::string::npos) << lines[i];
    }
}

TEST(CliSweep, ResumesAfterAKill) {
    const TemporaryFolder folder;
    const std::string whole = folder.file("whole.csv"), killed = folder.file("killed.csv");
    const std::vector<std::string> command = breaks(1200, killed, {"--jobs", "2"});
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.begin(), CAROM_PROGRAM);
    std::string parts;
    for (const std::size_t count : {1u, 2u}) {
        const Process process(arguments, {});
        parts = wait_for_parts(folder, count);
        ASSERT_NE(parts, "");
        // The destructor kills it with SIGKILL.
    }
    EXPECT_FALSE(fs::exists(killed));
    // Half a part without its final name, as a crash may leave it.
    std::ofstream(parts + "/.carom.1.0.tmp") << "123,90.0";
    const ProcessResult result = carom(command);
    expect_ok(result);
    EXPECT_NE(result.err.find("continuing with " + parts), std::string::npos) << result.err;
    EXPECT_EQ(folder.names(), std::vector<std::string>{"killed.csv"});
    expect_ok(carom(breaks(1200, whole)));
    EXPECT_EQ(read_file(killed), read_file(whole));
}

TEST(CliSweep, UsesOnlyTheThreadsOfJobs) {
    for (const int jobs : {1, 2}) {
        const TemporaryFolder folder;
        std::vector<std::string> arguments =
            breaks(100000, folder.file("a.csv"), {"--jobs", std::to_string(jobs)});
        arguments.insert(arguments.begin(), CAROM_PROGRAM);
        Process process(arguments, {});
        ASSERT_NE(wait_for_parts(folder), "");
        int most = 0;
        for (int i = 0; i < 100; ++i) {
            most = std::max(most, process.threads());
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        process.interrupt();
        EXPECT_EQ(process.finish("").status, 130);
        // Three more threads write rows, write a part and wait; the thread sanitizer adds one.
        EXPECT_LE(most, jobs + 4);
        EXPECT_GT(most, jobs);
    }
}

TEST(CliSweep, AnInterruptKeepsFinishedParts) {
    const TemporaryFolder folder;
    const std::string output = folder.file("a.csv");
    std::vector<std::string> arguments = breaks(100000, output);
    arguments.insert(arguments.begin(), CAROM_PROGRAM);
    Process process(arguments, {});
    const std::string parts = wait_for_parts(folder);
    ASSERT_NE(parts, "");
    const ProcessResult second = carom(breaks(100000, output));
    EXPECT_EQ(second.status, 1);
    EXPECT_EQ(second.err,
              "carom: " + parts + "/lock: another program is writing the files that this lock protects\n");
    process.interrupt();
    const ProcessResult result = process.finish("");
    EXPECT_EQ(result.status, 130);
    EXPECT_EQ(result.err, "carom: stopped; run the same command to continue with " + parts + "\n");
    // No table, no lock, no temporary file.
    EXPECT_EQ(folder.names().size(), files_in(parts).size());
}

TEST(CliSweep, ExistingPartsAreChecked) {
    const TemporaryFolder folder;
    const std::vector<std::string> command = breaks(100000, folder.file("a.csv"));
    const std::string parts = interrupted_parts(folder, command);
    ASSERT_NE(parts, "");
    const auto refused = [&](const std::string& message) {
        const ProcessResult result = carom(command);
        EXPECT_EQ(result.status, 1);
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    };
    const std::string part = parts + "/0.csv", text = read_file(part);
    const auto write = [&](const std::string& other) { std::ofstream(part, std::ios::binary) << other; };
    for (const std::size_t at : {std::size_t{0}, text.size() / 2, text.size() - 25, text.size() - 2}) {
        std::string changed = text;
        changed[at] ^= 1;
        write(changed);
        refused(part + ": its rows were changed after they were written; remove it and run the sweep again");
    }
    for (const std::string& short_one :
         {std::string(), text.substr(0, 20), text.substr(0, text.size() - 1)}) {
        write(short_one);
        refused("were changed after they were written");
    }

    // From another build with other bits.
    const auto signed_again = [&](std::string other) {
        Fnv hash;
        hash.add_long(other);
        write(other + fmt::format("{:016x}\n", hash.value()));
    };
    const std::string rows = text.substr(0, text.find("{\"version\"")), about = text.substr(rows.size());
    const std::string said = about.substr(0, about.find('\n') + 1);
    std::string other = said;
    other.replace(12, 1, "9");
    signed_again(rows + other);
    refused(part + ": this is carom ");
    for (const std::string& file : files_in(parts))
        if (file != part) fs::remove(file);
    signed_again(rows.substr(0, rows.size() - 1) + "9\n" + said);
    refused("its last row differs from the one that this program computes; remove it to start again");

    fs::remove(part);
    EXPECT_EQ(interrupted_parts(folder, command), parts);
    EXPECT_EQ(rows_in(parts)[0] + "\n", rows.substr(0, rows.find('\n') + 1));
}

// Others may also write to the folder.
TEST(CliSweep, ALinkIsNotFollowed) {
    const TemporaryFolder folder, elsewhere;
    const std::vector<std::string> command = breaks(100000, folder.file("a.csv"));
    const std::string parts = interrupted_parts(folder, command);
    ASSERT_NE(parts, "");
    fs::remove_all(parts);
    const auto refused = [&] {
        const ProcessResult result = carom(command);
        EXPECT_EQ(result.status, 1);
        EXPECT_EQ(result.err, "carom: " + parts + ": this is not a folder; remove it\n");
        fs::remove(parts);
    };
    fs::create_directory_symlink(elsewhere.path(), parts);
    refused();
    std::ofstream(parts) << "of value\n";
    refused();
    EXPECT_TRUE(elsewhere.names().empty());
}

TEST(CliSweep, AStatusFileReportsProgress) {
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
    // 2^53 shots in 999 999 parts: no shard is an exact fraction, and the product of the two numbers has 73
    // bits.
    std::vector<std::string> arguments =
        breaks(1, folder.file("a.csv"), {"--shard", "999999/999999", "--status", status, "--jobs", "1"});
    arguments.insert(arguments.begin(), CAROM_PROGRAM);
    *(std::find(arguments.begin(), arguments.end(), "--count") + 1) = "9007199254740992";
    const std::vector<std::string> command(arguments.begin() + 1, arguments.end());
    const std::string parts = interrupted_parts(folder, command);
    ASSERT_NE(parts, "");
    const auto stopped = nlohmann::json::parse(read_file(status));
    EXPECT_EQ(stopped["state"], "stopped");
    EXPECT_EQ(stopped["first"], 9007190247532730);  // floor(2^53 * 999998 / 999999)
    EXPECT_EQ(stopped["last"], 9007199254740992);
    const std::vector<std::string> rows = rows_in(parts);
    EXPECT_EQ(rows.front().find("9007190247532730,"), 0u) << rows.front();
    EXPECT_EQ(stopped["rows"], rows.size());
    EXPECT_EQ(rows.back().find(std::to_string(9007190247532730 + rows.size() - 1) + ","), 0u) << rows.back();

    // The same command continues, and reports existing rows without replaying them.
    const std::size_t count = files_in(parts).size();
    Process again(arguments, {});
    EXPECT_EQ(wait_for_parts(folder, count + 1), parts);
    again.interrupt();
    EXPECT_EQ(again.finish("").status, 130);
    const auto later = nlohmann::json::parse(read_file(status));
    EXPECT_EQ(later["rows"].get<std::uint64_t>() - later["played"].get<std::uint64_t>(), rows.size());
}

TEST(CliSweep, InvalidShotsAreAlsoRows) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", kSmallScene), output = folder.file("a.csv");
    expect_ok(carom(
        {"sweep", scene, "--vary", "ball.cue.position.y=uniform(1.7,2.1)", "--count", "40", "-o", output}));
    const std::vector<std::string> lines = lines_of(read_file(output));
    const std::string empty(22, ',');
    int invalid = 0, hit = 0;
    for (const std::string& line : lines) {
        invalid += line.find(",invalid" + empty + "\"balls \"\"") != std::string::npos;
        hit += line.find(",1,1,") != std::string::npos;
    }
    EXPECT_GT(invalid, 3);
    EXPECT_GT(hit, 3);
}

TEST(CliSweep, AFailedShotIsARowAndAnExitStatus) {
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

TEST(CliSweep, FailuresInExistingPartsCount) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", kStuckScene), output = folder.file("a.csv");
    std::vector<std::string> command = {"sweep",   scene,   "--vary", "balls.mu_s=list(0.6,0.0)",
                                        "--count", "60000", "-o",     output};
    command.insert(command.begin(), CAROM_PROGRAM);
    {
        const Process killed(command, {});
        ASSERT_NE(wait_for_parts(folder), "");
    }
    command.erase(command.begin());
    const ProcessResult result = carom(command);
    EXPECT_EQ(result.status, 1);
    const std::string table = read_file(output);
    int failed = 0;
    for (std::size_t at = 0; (at = table.find(",0.6,failed,", at)) != table.npos; ++at) ++failed;
    EXPECT_NE(result.err.find("continuing with "), result.err.npos) << result.err;
    EXPECT_NE(result.err.find(std::to_string(failed) + " shots failed while running"), result.err.npos)
        << result.err;
}

TEST(CliSweep, APlotAfterAKillShowsTheWholeTable) {
    const TemporaryFolder folder, pictures;
    const std::string scene = folder.write("s.toml", kSmallScene);
    const auto command = [&](const std::string& name) {
        return std::vector<std::string>{"sweep",     scene,
                                        "--vary",    "cue.aim_deg=normal(1)",
                                        "--vary",    "cue.speed=uniform(1,5)",
                                        "--count",   "60000",
                                        "--measure", "travel(cue)",
                                        "--plot",    pictures.file(name + ".svg"),
                                        "-o",        folder.file(name + ".csv")};
    };
    std::vector<std::string> arguments = command("killed");
    arguments.insert(arguments.begin(), CAROM_PROGRAM);
    {
        const Process killed(arguments, {});
        if (wait_for_parts(folder).empty()) GTEST_SKIP() << "this build has no cairo";
    }
    const ProcessResult result = carom(command("killed"));
    expect_ok(result);
    EXPECT_NE(result.err.find("continuing with "), result.err.npos) << result.err;
    expect_ok(carom(command("whole")));
    EXPECT_TRUE(read_file(pictures.file("killed.svg")) == read_file(pictures.file("whole.svg")));
}

}  // namespace
}  // namespace carom::test
