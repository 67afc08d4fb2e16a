// External faults: a full disk, a read-only folder, a reader that closes the pipe, signals, a killed run.
// Afterwards files are whole or absent, and the exit status states the result.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/output_file.h"
#include "carom/engine/printable.h"
#include "cli.h"

#if defined(__SANITIZE_THREAD__)
#define CAROM_TEST_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define CAROM_TEST_TSAN 1
#endif
#endif
#ifndef CAROM_TEST_TSAN
#define CAROM_TEST_TSAN 0
#endif

namespace carom::test {
namespace {

namespace fs = std::filesystem;

class Faults : public ::testing::Test {
  protected:
    std::string frame(int k) const {
        char name[32];
        std::snprintf(name, sizeof name, "frames/%05d.png", k);
        return folder_.file(name);
    }
    std::string pattern() const { return folder_.file("frames/%05d.png"); }

    /// Starts a render that is far from its end when its third frame appears.
    std::unique_ptr<Process> long_render() const {
        auto process = std::make_unique<Process>(
            std::vector<std::string>{CAROM_PROGRAM, "render", scene_, "-o", pattern(), "--fps", "2000",
                                     "--size", "640x360"},
            ProcessOptions{});
        for (int wait = 0; wait < 6000 && !fs::exists(frame(2)); ++wait)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        EXPECT_TRUE(fs::exists(frame(2)));
        return process;
    }

    std::vector<std::string> temporary_files() const {
        std::vector<std::string> found;
        for (const std::string& name : folder_.names())
            if (name.find(".tmp") != std::string::npos) found.push_back(name);
        return found;
    }

    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);
};

/// Every file that the program writes, by its option.
TEST_F(Faults, AFileThatMayNotGrowIsNamedAndNotLeftPartial) {
    const std::vector<std::vector<std::string>> commands = {
        {"simulate", scene_, "-o"},
        {"simulate", scene_, "--events"},
        {"simulate", scene_, "--sample-dt", "0.1", "--samples"},
        {"margin", scene_, "--no-render", "--csv"},
        {"accuracy", scene_, "--repeat", "1", "--csv"},
        {"render", scene_, "--size", "320x180", "--at", "0.5", "-o"},
        {"render", scene_, "--size", "320x180", "--to", "0.1", "-o"},
        {"render", scene_, "--size", "320x180", "--sheet", "2x2", "-o"},
    };
    for (std::vector<std::string> command : commands) {
        const bool frames = command[0] == "render" && command[4] != "--sheet";
        command.push_back(folder_.file(frames ? "out%d.png" : "out.png"));
        ProcessOptions options;
        options.file_limit = 500;
        const ProcessResult result = carom(command, options);
        EXPECT_EQ(result.status, 1) << command[0] << " " << command[command.size() - 2];
        EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
        EXPECT_NE(result.err.find("File too large"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(folder_.path().string()), std::string::npos)
            << "names no file: " << result.err;
        EXPECT_EQ(folder_.names(), std::vector<std::string>{"s.toml"}) << command[0];
    }
}

TEST_F(Faults, AClosedPipeEndsEveryCommandQuietly) {
    for (const std::vector<std::string>& command :
         std::vector<std::vector<std::string>>{{"simulate", scene_},
                                               {"simulate", scene_, "--json"},
                                               {"check", scene_},
                                               {"compare", scene_, scene_},
                                               {"compare", scene_, scene_, "--json"},
                                               {"margin", scene_, "--no-render"},
                                               {"accuracy", scene_, "--repeat", "1"},
                                               {"render", scene_, "--raw", "--size", "64x36"}}) {
        ProcessOptions options;
        options.close_output = true;
        const ProcessResult result = carom(command, options);
        EXPECT_EQ(result.status, 1) << command[0];
        EXPECT_EQ(result.err, "") << command[0];
    }
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"s.toml"});
}

TEST_F(Faults, ASignalKeepsFinishedFramesAndLeavesNoTemporaryFile) {
    for (const auto& [signal, status] : {std::pair{SIGINT, 130}, {SIGTERM, 143}}) {
        const std::unique_ptr<Process> process = long_render();
        process->send(signal);
        EXPECT_EQ(process->finish("").status, status);
        EXPECT_EQ(temporary_files(), std::vector<std::string>{});
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(fs::exists(frame(k)));
        fs::remove_all(folder_.path() / "frames");
    }
}

// Renders over the frames of a longer film from another camera, killed after some frame: a frame is whole or
// absent, and drawing again makes the film.
TEST_F(Faults, AKilledRenderMixesNoTwoPictures) {
    const auto command = [this](const char* camera, const char* to) {
        return std::vector<std::string>{"render", scene_,  "-o",   pattern(), "--fps",    "100",
                                        "--size", "64x36", "--to", to,        "--camera", camera};
    };
    ASSERT_EQ(carom(command("top", "0.29")).status, 0);
    std::vector<std::string> whole;
    for (int k = 0; k < 30; ++k) whole.push_back(read_file(frame(k)));
    ASSERT_EQ(carom(command("rail", "0.4")).status, 0);
    // The file may vanish while it is read.
    const auto is_own = [&](int k) {
        std::ifstream file(frame(k), std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {}) == whole[k];
    };
    for (const int stop : {0, 7, 20}) {
        std::vector<std::string> arguments = command("top", "0.29");
        arguments.insert(arguments.begin(), CAROM_PROGRAM);
        Process process(arguments, ProcessOptions{});
        for (int wait = 0; wait < 20000 && !is_own(stop); ++wait)
            std::this_thread::sleep_for(std::chrono::microseconds(300));
        process.send(SIGKILL);
        process.finish("");
        for (int k = 0; k < 30; ++k) EXPECT_TRUE(!fs::exists(frame(k)) || is_own(k)) << stop << " " << k;
    }
    ASSERT_EQ(carom(command("top", "0.29")).status, 0);
    for (int k = 0; k < 30; ++k) EXPECT_EQ(read_file(frame(k)), whole[k]) << k;
}

// The rotations of five hundred balls, each with nearly as many keys as are allowed: seconds of work.
TEST_F(Faults, ASignalEndsAnExport) {
    std::string text = "[table]\ncushion = []\n[balls]\nmu_s = 0\nmu_r = 0\nmu_sp = 0\n[stop]\ntime = 390\n";
    for (int ball = 0; ball < 500; ++ball)
        text += "[[ball]]\nid = \"" + std::to_string(ball) + "\"\nposition = [0, " +
                std::to_string(0.2 * ball) + "]\nspin = [0, 0, 100]\n";
    const std::string spins = folder_.write("spins.toml", text);
    Process process({CAROM_PROGRAM, "export", spins, "-o", folder_.file("spins.glb")}, ProcessOptions{});
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    process.send(SIGTERM);
    EXPECT_EQ(process.finish("").status, 143);
    EXPECT_FALSE(fs::exists(folder_.file("spins.glb")));
}

// A file name may contain any byte except "/" and 0; the output remains text.
TEST_F(Faults, NamesThatAreNotUtf8AreEscaped) {
    const std::string odd = folder_.file("b\xff\x01<.toml"), page = folder_.file("o.html");
    const auto made = [&](const char* ending) { return folder_.file(std::string("m\x1b[31m\xff") + ending); };
    fs::copy_file(scene_, odd);
    const std::vector<std::vector<std::string>> commands = {
        {"simulate", odd},
        {"compare", odd, odd},
        {"compare", odd, odd, "--json"},
        {"view", odd, "-o", page},
        {"margin", odd, "--no-render", "--json"},
        {"margin", odd, "--no-render"},
        {"accuracy", odd, "--repeat", "1"},
        {"check", odd},
        {"view", odd, "-o", made(".html")},
        {"export", odd, "-o", made(".glb")},
        {"sweep", odd, "--vary", "cue.speed=uniform(1,2)", "--count", "2", "-o", made(".csv")},
        {"render", odd, "--size", "32x18", "--at", "0.1", "-o", made(".png")},
        {"render", odd, "--size", "32x18", "--to", "0.1", "-o", made("%d.png")},
        {"render", odd, "--size", "64x36", "--sheet", "2x2", "-o", made(".png")}};
    for (const std::vector<std::string>& command : commands) {
        const ProcessResult result = carom(command);
        EXPECT_EQ(result.status, 0) << command[0] << result.err;
        std::string all = result.out;
        if (fs::exists(page)) all += read_file(page);
        EXPECT_TRUE(is_utf8(all)) << command[0];
        EXPECT_EQ(all.find_first_of("\x01\x1b"), std::string::npos) << command[0];
        fs::remove(page);
    }
}

TEST_F(Faults, TheNextRunRemovesAKilledRunsFiles) {
    const std::string left = folder_.write(".carom.1.0.tmp", "half"),
                      other = folder_.write(".carom.2.0.tmp", "");
    const int writes = ::open(other.c_str(), O_RDWR);
    ASSERT_EQ(::flock(writes, LOCK_EX), 0);
    folder_.write(".carom.tmp.not", "mine");
    const std::string pipe = folder_.file(".carom.3.0.tmp"), link = folder_.file(".carom.4.0.tmp");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    fs::create_symlink(scene_, link);
    // Another program's unfinished file stays.
    OutputFile begun(folder_.file("other.txt"));
    begun.write("whole");
    ASSERT_EQ(carom({"simulate", scene_, "-o", folder_.file("r.json")}).status, 0);
    begun.commit();
    EXPECT_EQ(read_file(folder_.file("other.txt")), "whole");
    EXPECT_TRUE(fs::exists(pipe));
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::exists(other)) << "another program writes it";
    EXPECT_TRUE(fs::exists(folder_.file(".carom.tmp.not")));
    ::close(writes);
}

TEST_F(Faults, TwoRendersDoNotShareFrames) {
    const std::vector<std::string> command = {"render", scene_,  "-o",   pattern(),
                                              "--size", "64x36", "--to", "0.2"};
    fs::create_directory(folder_.path() / "frames");
    {
        const FileLock lock(pattern() + ".lock", true);
        const ProcessResult result = carom(command);
        EXPECT_EQ(result.status, 1);
        EXPECT_NE(result.err.find("%05d.png.lock: another program is writing"), std::string::npos)
            << result.err;
        EXPECT_FALSE(fs::exists(frame(0)));
    }
    {
        // Another run of a single frame holds the lock: other single frames may be drawn meanwhile, a film
        // may not.
        const FileLock lock(pattern() + ".lock", false);
        EXPECT_EQ(carom(command).status, 1);
        EXPECT_FALSE(fs::exists(frame(0)));
        std::vector<std::string> one = command;
        one.insert(one.end(), {"--frame", "0"});
        EXPECT_EQ(carom(one).status, 0);
        EXPECT_TRUE(fs::exists(frame(0)));
    }
    EXPECT_EQ(carom(command).status, 0);
    EXPECT_FALSE(fs::exists(pattern() + ".lock"));
}

TEST_F(Faults, ATooLargeRecordIsRefusedUnread) {
    const std::string path = folder_.write("huge.json", "{");
    fs::resize_file(path, (std::uintmax_t{256} << 20) + 1);  // sparse: takes no space
    const ProcessResult result = carom({"render", path, "-o", pattern()});
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.err,
              "carom: " + path +
                  ": is larger than 256 MiB; stop the shot earlier ([stop]) and write it in parts\n");
}

// The sanitizers need more address space than these limits allow.
#ifndef CAROM_SANITIZED
/// 12 MB of almost empty items, which once became 400 MB that could not be freed without more memory.
TEST_F(Faults, ARecordBeyondTheMemoryLimitIsAMessage) {
    std::string text = "{\"format\":\"carom-record\",\"version\":2,\"x\":[";
    for (int i = 0; i < 4000000; ++i) text += "{},";
    const std::string path = folder_.write("hostile.json", text + "1]}");
    const auto with_limit = [&](int kilobytes) {
        return run_process({"/bin/sh", "-c",
                            "ulimit -v " + std::to_string(kilobytes) + "; exec \"$0\" \"$@\"", CAROM_PROGRAM,
                            "render", path, "-o", pattern()});
    };
    const ProcessResult enough = with_limit(300000);
    EXPECT_EQ(enough.status, 2);
    EXPECT_EQ(enough.err, "carom: " + path + ": the key \"duration\" is missing\n");
    int out_of_memory = 0;
    for (int kilobytes = 40000; kilobytes < 100000; kilobytes += 6000) {
        const ProcessResult result = with_limit(kilobytes);
        if (result.err == "carom: out of memory\n") {
            EXPECT_EQ(result.status, 1);
            ++out_of_memory;
        } else {
            EXPECT_EQ(result.status, 2) << kilobytes << ": " << result.err;
            EXPECT_EQ(result.err, enough.err);
        }
    }
    EXPECT_GT(out_of_memory, 0);
}
#endif

// Stacks larger than the address space: the system starts no thread.
TEST_F(Faults, FailedThreadStartsAreAnErrorWithARemedy) {
#if CAROM_TEST_TSAN
    GTEST_SKIP() << "the thread sanitizer lays out memory itself, and does not start with such stacks";
#endif
    ProcessOptions options;
    options.stack_limit = 1L << 46;
    options.environment = {{"LP_NUM_THREADS", "0"}};  // Mesa's own
    for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
             {"render", scene_, "--size", "64x36", "--to", "0.1", "--jobs", "4", "-o", pattern()},
             {"sweep", scene_, "--vary", "cue.speed=uniform(3,4)", "--count", "4", "--jobs", "4", "-o",
              folder_.file("t.csv")}}) {
        const ProcessResult result = carom(command, options);
        EXPECT_EQ(result.status, 1) << command[0];
        EXPECT_NE(result.err.find(" of 4 threads could be started ("), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("; use fewer with --jobs\n"), std::string::npos) << result.err;
        EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
    }
    EXPECT_FALSE(fs::exists(folder_.file("t.csv")));
    EXPECT_FALSE(fs::exists(frame(0)));
    // One job works.
    const ProcessResult alone =
        carom({"render", scene_, "--size", "64x36", "--to", "0.1", "--jobs", "1", "-o", pattern()}, options);
    EXPECT_EQ(alone.status, 0) << alone.err;
}

/// A name in a scene or a record is data and never becomes a path.
TEST_F(Faults, NamesInAFileNeverBecomePaths) {
    std::string scene(kSmallScene);
    for (std::size_t at; (at = scene.find("ball 2")) != std::string::npos;) scene.replace(at, 6, "../../x");
    const std::string path = folder_.write("names.toml", scene);
    fs::create_directory(folder_.path() / "in");
    ProcessOptions options;
    options.folder = folder_.file("in");
    ASSERT_EQ(carom({"simulate", path, "-o", "r.json", "--events", "e.csv", "--samples", "s.csv",
                     "--sample-dt", "0.1"},
                    options)
                  .status,
              0);
    ASSERT_EQ(carom({"render", "r.json", "-o", "f%d.png", "--at", "0", "--size", "64x36"}, options).status,
              0);
    std::vector<std::string> names = folder_.names();
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names,
              (std::vector<std::string>{"e.csv", "f0.png", "names.toml", "r.json", "s.csv", "s.toml"}));
}

}  // namespace
}  // namespace carom::test
