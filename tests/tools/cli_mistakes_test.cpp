// Mistyped files, names and numbers, and obstacles placed by others.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "cli.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;

class Mistakes : public testing::Test {
  protected:
    /// Expects exit status 2, this message and no output.
    static void refused(const std::string& message, const std::vector<std::string>& arguments) {
        const ProcessResult result = carom(arguments);
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_TRUE(contains(result.err, message)) << result.err;
    }
    std::vector<std::string> sweep(const std::string& output,
                                   const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all = {"sweep",   scene_, "--vary", "cue.speed=uniform(1,2)",
                                        "--count", "6",    "-o",     output};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);
};

TEST_F(Mistakes, HelpAndVersionAreAlsoCommands) {
    EXPECT_EQ(carom({"help"}).out, carom({"--help"}).out);
    EXPECT_EQ(carom({"help", "sweep"}).out, carom({"sweep", "--help"}).out);
    for (const char* version : {"version", "-V"}) EXPECT_EQ(carom({version}).out, carom({"--version"}).out);
}

TEST_F(Mistakes, MistypedOptionsAndValuesAreExplained) {
    refused("unknown option --verfy; did you mean --verify? See carom simulate --help",
            {"simulate", scene_, "--verfy"});
    refused("8ball: expected one of", {"judge", scene_, "--game", "8ball"});
    refused("did you mean eight_ball?", {"judge", scene_, "--game", "8ball"});
    refused("--target 1mm: expected a number, without a unit", {"accuracy", scene_, "--target", "1mm"});
    refused("frames need a number in their names", {"render", scene_, "-o", folder_.file("a.png")});
    const ProcessResult alone = carom({});
    EXPECT_EQ(alone.status, 2);
    EXPECT_EQ(alone.out, carom({"--help"}).out);
    const ProcessResult formats = carom({"describe"});
    EXPECT_EQ(formats.status, 0);
    EXPECT_TRUE(contains(formats.out, "carom describe scene-schema\n"));
}

TEST_F(Mistakes, LikelyUnitsAndTablesAreWarnedOf) {
    const auto warned = [this](const std::string& text) {
        return carom({"check", folder_.write("w.toml", text + "\n[cue]\noffset = [0, 0]\n")}).err;
    };
    EXPECT_TRUE(contains(warned("balls.mass = 170\n[[ball]]"), "warning: a ball has a mass of 170 kg"));
    EXPECT_TRUE(contains(carom({"check", folder_.write("c.toml", "[[ball]]\n[cue]\nmass = 540\n")}).err,
                         "the cue has a mass of 540 kg"));
    const std::string cue = "[[ball]]\nposition = [0.9, 0.2]\n";
    EXPECT_TRUE(
        contains(warned("rack.game = \"snooker\"\n" + cue), "the snooker balls are on the table nine_foot"));
    EXPECT_TRUE(contains(warned("table.preset = \"carom\"\nrack.game = \"eight_ball\"\n" + cue),
                         "the pool balls are on the table carom"));
    const std::string right =
        "table.preset = \"snooker\"\nballs.preset = \"snooker\"\nrack.game = \"snooker\"\n";
    EXPECT_FALSE(contains(warned(right + cue), "warning:"));
    EXPECT_FALSE(contains(warned("rack.game = \"eight_ball\"\n" + cue), "warning:"));
}

TEST_F(Mistakes, StandardStreamsQuietAndClosedPipes) {
    const std::string scene = read_file(scene_);
    ProcessOptions input;
    input.input = scene;
    const ProcessResult read = carom({"simulate", "-", "--hash"}, input);
    EXPECT_EQ(read.out, carom({"simulate", scene_, "--hash"}).out) << read.err;
    const ProcessResult record = carom({"simulate", scene_, "-o", "-"});
    EXPECT_EQ(record.out, read_file([&] {
                  carom({"simulate", scene_, "-o", folder_.file("r.json")});
                  return folder_.file("r.json");
              }()));
    const ProcessResult quiet =
        carom({"check", folder_.write("w.toml", "balls.mass = 170\n[[ball]]\n"), "--quiet"});
    EXPECT_EQ(quiet.out + quiet.err, "");
    EXPECT_EQ(quiet.status, 0);
    EXPECT_TRUE(contains(carom({"check", "missing.toml", "--quiet"}).err, "missing.toml"));
    ProcessOptions closed;
    closed.close_output = true;
    EXPECT_EQ(carom({"simulate", scene_, "--events", "-"}, closed).err, "");
}

TEST_F(Mistakes, NoFileIsReadAndWrittenOrWrittenTwice) {
    const std::string before = read_file(scene_), same = folder_.file("same");
    const std::string link = folder_.file("link.toml");
    fs::create_symlink(scene_, link);
    refused("would overwrite the input", {"simulate", scene_, "-o", link});
    refused("would overwrite the input", {"simulate", scene_, "-o", folder_.path().string() + "/./s.toml"});
    // Files that do not exist yet, each under two names.
    fs::create_symlink(same, folder_.file("to_same"));
    fs::create_symlink("to_same", folder_.file("to_link"));
    fs::create_directory_symlink(".", folder_.file("here"));
    for (const std::string& other : {folder_.file("./same"), folder_.file("to_same"), folder_.file("to_link"),
                                     folder_.file("here/same")})
        for (const auto& [one, two] : {std::pair(same, other), std::pair(other, same)}) {
            refused("name the same file", {"simulate", scene_, "-o", one, "--events", two});
            refused("name the same file", sweep(one, {"--status", two}));
        }
    EXPECT_FALSE(fs::exists(same));
    const std::string cwd = fs::current_path().string();
    fs::current_path(folder_.path());
    refused("name the same file", {"simulate", scene_, "-o", "a.json", "--events", "./a.json"});
    refused("name the same file", {"simulate", scene_, "-o", "a.json", "--events", folder_.file("a.json")});
    refused("would overwrite the input", {"render", "./s.toml", "-o", "s.toml"});
    fs::current_path(cwd);
    EXPECT_EQ(read_file(scene_), before);
    // One file with two names on the disk.
    fs::create_hard_link(scene_, folder_.file("twin.toml"));
    refused("would overwrite the input", {"simulate", scene_, "-o", folder_.file("twin.toml")});
    EXPECT_EQ(carom({"simulate", scene_, "-o", "/dev/null", "--events", "/dev/null"}).status, 0);
    EXPECT_EQ(carom({"simulate", scene_, "--events", "/dev/stdout", "--samples", "/dev/stdout", "--sample-dt",
                     "0.1"})
                  .status,
              0);
    // Not everything below /dev is a device.
    if (!fs::is_directory("/dev/shm")) return;
    const std::string shared = "/dev/shm/carom." + std::to_string(::getpid()) + ".json";
    refused("name the same file", {"simulate", scene_, "-o", shared, "--events", shared});
    EXPECT_FALSE(fs::exists(shared));
    fs::copy_file(scene_, shared);
    refused("would overwrite the input", {"simulate", shared, "-o", shared});
    EXPECT_EQ(read_file(shared), before);
    fs::remove(shared);
}

// A pattern expands to names; the scene was once drawn over, or removed as a frame of another picture.
TEST_F(Mistakes, FramesNeverReplaceInputs) {
    const std::string before = read_file(scene_);
    const std::string as_frame = folder_.file("s00002.png"), in_percent = folder_.file("p%d.png");
    fs::copy_file(scene_, as_frame);
    fs::copy_file(scene_, in_percent);
    fs::create_symlink(scene_, folder_.file("l7.png"));
    const auto both = [&](const std::string& input, const std::string& pattern) {
        refused("would overwrite the input", {"render", input, "-o", pattern, "--size", "32x18"});
        refused("would overwrite the input",
                {"render", input, "-o", pattern, "--size", "32x18", "--at", "0.1"});
    };
    both(as_frame, folder_.file("s%05d.png"));
    both(folder_.path().string() + "/./s00002.png", folder_.file("s%05d.png"));
    both(scene_, folder_.file("l%d.png"));
    refused("would overwrite the input",
            {"render", in_percent, "-o", folder_.file("p%%d.png"), "--size", "32x18", "--at", "0.1"});
    const std::string cwd = fs::current_path().string();
    fs::current_path(folder_.path());
    fs::copy_file(scene_, "sheet.png");
    refused("would overwrite the input", {"render", "s00002.png", "-o", "s%05d.png", "--size", "32x18"});
    refused("would overwrite the input", {"render", "sheet.png", "--sheet", "2x2", "--size", "64x36"});
    fs::current_path(cwd);
    for (const std::string& name : {scene_, as_frame, in_percent, folder_.file("sheet.png")})
        EXPECT_EQ(read_file(name), before) << name;
}

TEST_F(Mistakes, OnePictureHasItsGivenName) {
    const std::string one = folder_.file("f.png");
    const ProcessResult result = carom({"render", scene_, "--at", "0.1", "--size", "32x18", "-o", one});
    EXPECT_EQ(result.out, "1 frame: " + one + "\n") << result.err;
    EXPECT_TRUE(fs::exists(one));
}

TEST_F(Mistakes, OlderFramesStayOutOfTheFilm) {
    const std::string pattern = folder_.file("a film %d.png");
    const ProcessResult result =
        carom({"render", scene_, "--fps", "10", "--to", "0.3", "--size", "32x18", "-o", pattern});
    EXPECT_TRUE(contains(result.out, "ffmpeg -y -framerate 10 -i '" + pattern + "' -frames:v 4 "))
        << result.out;
}

TEST_F(Mistakes, NumbersInAnotherUnitCauseAWarning) {
    const struct {
        const char *scene, *warning;
    } kCases[] = {
        {"[[ball]]\nposition = [50, 45]\n",
         "warning: ball \"cue\" lies 48.7 m outside the table; positions are in m"},
        {"[[ball]]\nposition = [2.0, 0.45]\n", "warning: ball \"cue\" lies 0.73 m outside the table"},
        {"[[ball]]\n[cue]\nspeed = 2500\n[stop]\nevents = 3\n", "warning: the cue moves at 2500 m/s"},
        {"[[ball]]\nvelocity = [300, 0]\n[stop]\nevents = 3\n", "warning: ball \"cue\" starts at 300 m/s"},
        {"[table]\ncushion = []\n[balls]\nradius = 28.575\n[[ball]]\n",
         "warning: a ball has a radius of 28.57 m"},
    };
    for (const auto& c : kCases) {
        const ProcessResult result = carom({"simulate", folder_.write("units.toml", c.scene)});
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_TRUE(contains(result.err, c.warning)) << result.err;
    }
    for (const std::string& shipped : shipped_scenes())
        EXPECT_FALSE(contains(carom({"check", shipped}).err, "are in m")) << shipped;
}

TEST_F(Mistakes, StandardOutputMayBeAFile) {
    const ProcessResult samples = carom({"simulate", scene_, "--samples", "-", "--sample-dt", "0.5"});
    EXPECT_EQ(lines_of(samples.out)[0].substr(0, 10), "time,ball,") << samples.out;
    EXPECT_FALSE(contains(samples.out, "final positions"));
    EXPECT_FALSE(fs::exists("-"));
}

// A shell's >>: earlier contents stay, and the output follows them.
TEST_F(Mistakes, OutputIsAppendedToAnOpenFile) {
    const std::string log = folder_.file("log.txt");
    const std::string hash = carom({"simulate", scene_, "--hash"}).out;
    const std::string events = carom({"simulate", scene_, "--events", "-"}).out;
    const auto shell = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"sh", "-c", "exec \"$@\" >>" + log, "sh", CAROM_PROGRAM});
        folder_.write("log.txt", "before\n");
        const ProcessResult result = run_process(words);
        EXPECT_EQ(result.status, 0) << result.err;
        return read_file(log);
    };
    for (const char* name : {"-", "/dev/stdout", "/dev/fd/1"})
        EXPECT_EQ(shell({"simulate", scene_, "--events", name, "--hash"}), "before\n" + events + hash)
            << name;
    const std::string table = folder_.file("table.csv");
    ASSERT_EQ(carom(sweep(table)).status, 0);
    EXPECT_TRUE(shell(sweep("/dev/stdout")).starts_with("before\n" + read_file(table)));
}

TEST_F(Mistakes, TheLargestSeedIsAccepted) {
    EXPECT_EQ(carom(sweep("/dev/null", {"--seed", "18446744073709551615"})).status, 0);
}

TEST_F(Mistakes, AShardReplacesNoOther) {
    const std::string output = folder_.file("a.csv");
    ASSERT_EQ(carom(sweep(output, {"--shard", "1/2"})).status, 0);
    const std::string first = read_file(output);
    refused("perhaps from another shard", sweep(output, {"--shard", "2/2"}));
    EXPECT_EQ(read_file(output), first);
}

// Others may also write to the folder.
TEST_F(Mistakes, TemporaryFilesAreNewAndNotLinks) {
    const std::string record = folder_.file(std::string(240, 'r') + ".json");
    EXPECT_EQ(carom({"simulate", scene_, "-o", record}).status, 0);
    EXPECT_TRUE(fs::exists(record));
    // Permissions stay, and dangling links are followed.
    const std::string secret = folder_.write("secret.csv", "");
    fs::permissions(secret, fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(carom({"simulate", scene_, "--events", secret}).status, 0);
    EXPECT_EQ(fs::status(secret).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    const std::string target = folder_.file("target.csv"), link = folder_.file("link.csv");
    fs::create_symlink("target.csv", link);
    EXPECT_EQ(carom({"simulate", scene_, "--events", link}).status, 0);
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_TRUE(fs::is_regular_file(target));
}

TEST_F(Mistakes, NamesCannotControlTheTerminal) {
    const std::string record = folder_.file("r.json");
    ASSERT_EQ(carom({"simulate", scene_, "-o", record}).status, 0);
    std::string text = read_file(record);
    const std::size_t at = text.find("\"ball 2\"");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 8, "\"\\u001b[2J\"");
    const ProcessResult ids = carom({"render", folder_.write("bad.json", text), "--camera", "follow",
                                     "--ball", "nobody", "--at", "0", "-o", folder_.file("f.png")});
    EXPECT_EQ(ids.status, 1);
    EXPECT_TRUE(contains(ids.err, "?[2J")) << ids.err;
    EXPECT_EQ(ids.err.find('\x1b'), std::string::npos);
    const ProcessResult result = carom({"simulate", folder_.file("no\x1b[2J.toml")});
    EXPECT_EQ(result.err.find('\x1b'), std::string::npos);
    EXPECT_EQ(result.status, 2);
}

}  // namespace
}  // namespace carom::test
