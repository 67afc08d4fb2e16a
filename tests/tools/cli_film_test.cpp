// carom render -o shot.mp4: films made by ffmpeg, and frames and streams as other programs read them. Missing
// programs are skipped.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "cli.h"

namespace carom::test {
namespace {

class CliFilm : public ::testing::Test {
  protected:
    /// A substitute for ffmpeg, first in the path.
    ProcessOptions with_ffmpeg(const std::string& script) const {
        std::filesystem::create_directory(folder_.path() / "bin");
        const std::string program = folder_.write("bin/ffmpeg", "#!/bin/sh\n" + script);
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        ProcessOptions options;
        options.environment = {{"PATH", folder_.file("bin") + ":" + std::getenv("PATH")}};
        return options;
    }

    /// All files in the folder except the scene and the substitute for ffmpeg.
    std::vector<std::string> made() const {
        std::vector<std::string> names = folder_.names();
        std::erase_if(names, [](const std::string& name) { return name == "s.toml" || name == "ffmpeg"; });
        return names;
    }

    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);
};

bool can_run(const std::vector<std::string>& arguments) {
    return run_process(arguments).status == 0;
}

const bool kHasFfmpeg = can_run({"ffmpeg", "-version"});

/// RGB bytes of all frames, as ffmpeg decodes them.
std::string decoded(const std::vector<std::string>& input) {
    std::vector<std::string> arguments = {"ffmpeg", "-v", "error"};
    arguments.insert(arguments.end(), input.begin(), input.end());
    for (const char* word : {"-f", "rawvideo", "-pix_fmt", "rgb24", "-"}) arguments.emplace_back(word);
    const ProcessResult result = run_process(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
}

/// Root mean square difference of two pictures, in steps of 8 bits.
double picture_difference(const std::string& a, const std::string& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double d = static_cast<unsigned char>(a[i]) - static_cast<unsigned char>(b.at(i));
        sum += d * d;
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST_F(CliFilm, EveryFormatHasItsFramesAndColors) {
    if (!kHasFfmpeg) GTEST_SKIP() << "there is no ffmpeg";
    const std::vector<std::string> part = {"--from", "0.2", "--to", "0.5", "--fps", "30"};
    const auto render = [&](const std::string& name) {
        std::vector<std::string> arguments = {"render", scene_, "-o", folder_.file(name)};
        arguments.insert(arguments.end(), part.begin(), part.end());
        return carom(arguments);
    };
    ASSERT_EQ(render("%02d.png").status, 0);
    const std::string frames = decoded({"-framerate", "30", "-i", folder_.file("%02d.png")});
    constexpr std::size_t kFrame = 3 * 320 * 180;
    ASSERT_EQ(frames.size(), 10 * kFrame);
    for (const std::string ending : {".mp4", ".webm", ".gif", ".webp"}) {
        const ProcessResult result = render("shot" + ending);
        if (contains(result.err, "Unknown encoder")) continue;  // an ffmpeg built without it
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.out, "10 frames, 320x180 at 30 fps: " + folder_.file("shot" + ending) + "\n");
        if (ending == ".webp") continue;  // ffmpeg writes animated ones but does not read them
        const std::string film = decoded({"-i", folder_.file("shot" + ending)});
        ASSERT_EQ(film.size(), frames.size()) << ending;
        for (const std::size_t k : {std::size_t{0}, std::size_t{9}}) {
            const double off =
                picture_difference(frames.substr(k * kFrame, kFrame), film.substr(k * kFrame, kFrame));
            EXPECT_LT(off, 6.0) << ending << " " << k;
        }
        EXPECT_GT(picture_difference(film.substr(0, kFrame), film.substr(9 * kFrame)), 1.0) << ending;
    }
    if (std::filesystem::exists(folder_.file("shot.webp"))) {
        const std::string webp = read_file(folder_.file("shot.webp"));
        int pictures = 0;
        for (std::size_t at = webp.find("ANMF"); at != std::string::npos; at = webp.find("ANMF", at + 1))
            ++pictures;
        EXPECT_EQ(pictures, 10);
    }
    for (const std::string& name : made()) EXPECT_FALSE(contains(name, ".tmp")) << name;
}

TEST_F(CliFilm, AStreamMayBePiped) {
    if (!kHasFfmpeg) GTEST_SKIP() << "there is no ffmpeg";
    const ProcessResult stream =
        carom({"render", scene_, "--y4m", "--fps", "10", "--to", "0.2", "--size", "159x91"});
    ASSERT_EQ(stream.status, 0) << stream.err;
    EXPECT_TRUE(contains(stream.err, "3 frames of Y4M")) << stream.err;
    EXPECT_EQ(stream.out.substr(0, 30), "YUV4MPEG2 W159 H91 F10:1 Ip A1");
    const std::string path = folder_.write("s.y4m", stream.out);
    EXPECT_EQ(decoded({"-i", path}).size(), 3u * 3u * 159u * 91u);
}

TEST_F(CliFilm, OtherProgramsReadTheFrames) {
    ASSERT_EQ(carom({"render", scene_, "-o", folder_.file("a%d.png"), "--at", "0.4"}).status, 0);
    ASSERT_EQ(
        carom({"render", scene_, "-o", folder_.file("b%d.png"), "--at", "0.4", "--png-writer", "libpng"})
            .status,
        0);
    EXPECT_NE(read_file(folder_.file("a0.png")), read_file(folder_.file("b0.png")));
    if (kHasFfmpeg) {
        const std::string pixels = decoded({"-i", folder_.file("a0.png")});
        EXPECT_EQ(pixels.size(), 3u * 320u * 180u);
        EXPECT_TRUE(pixels == decoded({"-i", folder_.file("b0.png")}));
    }
    const std::string same =
        "import sys\nfrom PIL import Image\n"
        "a, b = (Image.open(p).convert('RGB').tobytes() for p in sys.argv[1:])\nsys.exit(0 if a == b else "
        "3)\n";
    const ProcessResult pillow =
        run_process({"python3", "-c", same, folder_.file("a0.png"), folder_.file("b0.png")});
    const bool no_pillow = contains(pillow.err, "ModuleNotFoundError") || pillow.status == 127;
    EXPECT_EQ(no_pillow ? 0 : pillow.status, 0) << pillow.err;
    if (!kHasFfmpeg && no_pillow) GTEST_SKIP() << "there is neither ffmpeg nor Pillow";
}

TEST_F(CliFilm, WithoutFfmpegItsPackageIsNamed) {
    ProcessOptions options;
    options.environment = {{"PATH", folder_.file("nothing")}};
    const ProcessResult result = carom({"render", scene_, "-o", folder_.file("shot.mp4")}, options);
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(contains(result.err, "install the package ffmpeg")) << result.err;
    EXPECT_EQ(lines_of(result.err).size(), 1u);
    EXPECT_TRUE(made().empty());
}

TEST_F(CliFilm, AFailureOfFfmpegIsReportedAndKeepsTheOldFile) {
    folder_.write("shot.mp4", "old");
    // Fails at once; after some frames, when a part is written; at the end.
    for (const std::string script :
         {"echo 'no such thing' >&2; exit 3",
          "for f; do :; done; head -c 100000 > \"${f#file:}\"; echo 'no such thing' >&2; exit 3",
          "for f; do :; done; cat > \"${f#file:}\"; echo 'no such thing' >&2; exit 3"}) {
        const ProcessResult result =
            carom({"render", scene_, "-o", folder_.file("shot.mp4"), "--to", "0.5", "--fps", "500"},
                  with_ffmpeg(script + "\n"));
        EXPECT_EQ(result.status, 1) << script;
        EXPECT_EQ(result.err,
                  "carom: " + folder_.file("shot.mp4") + ": ffmpeg failed (exit status 3): no such thing\n");
        EXPECT_EQ(made(), std::vector<std::string>{"shot.mp4"});
        EXPECT_EQ(read_file(folder_.file("shot.mp4")), "old");
    }
}

TEST_F(CliFilm, AnInterruptLeavesNoFile) {
    // One substitute reads, the other has stopped reading.
    for (const std::string script : {"cat > \"${f#file:}\"", "touch \"${f#file:}\"; sleep 100"}) {
        const ProcessOptions options =
            with_ffmpeg("for f; do :; done; echo > " + folder_.file("started") + "; exec sh -c '" +
                        std::string("f=\"$0\"; ") + script + "' \"$f\"\n");
        Process process({CAROM_PROGRAM, "render", scene_, "-o", folder_.file("shot.mp4"), "--fps", "2000"},
                        options);
        for (int wait = 0; wait < 1000 && !std::filesystem::exists(folder_.file("started")); ++wait)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        ASSERT_TRUE(std::filesystem::exists(folder_.file("started")));
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        process.interrupt();
        const ProcessResult result = process.finish("");
        EXPECT_EQ(result.status, 130) << result.err;
        EXPECT_EQ(made(), std::vector<std::string>{"started"});
        std::filesystem::remove(folder_.file("started"));
    }
}

}  // namespace
}  // namespace carom::test
