// carom render: the view, overlays, contact sheets, raw frames, resuming, OpenGL libraries, and refusals of a
// disk.
#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli.h"

namespace carom::test {
namespace {

class CliRenderOptions : public ::testing::Test {
  protected:
    /// Renders one small picture and returns its bytes.
    std::string picture(const std::vector<std::string>& options, const std::string& at = "0.5") {
        const std::string name = folder_.file("p" + std::to_string(++count_) + "_%d.png");
        std::vector<std::string> arguments = {"render", record_, "-o", name, "--at", at};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = carom(arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return read_file(folder_.file("p" + std::to_string(count_) + "_0.png"));
    }

    /// Expects a refusal that says `part`, and no new file.
    void expect_refused(int status, const std::string& part, const std::vector<std::string>& options,
                        ProcessOptions process = {}) {
        const std::size_t before = folder_.names().size();
        std::vector<std::string> arguments = {"render", record_};
        if (std::find(options.begin(), options.end(), "-o") == options.end())
            arguments.insert(arguments.end(), {"-o", folder_.file("n%d.png")});
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = carom(arguments, std::move(process));
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(folder_.names().size(), before);
    }

    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);
    std::string record_ = [this] {
        const std::string path = folder_.file("r.json");
        EXPECT_EQ(carom({"simulate", scene_, "-o", path}).status, 0);
        return path;
    }();
    int count_ = 0;
};

TEST_F(CliRenderOptions, ViewsDiffer) {
    const std::string top = picture({});
    EXPECT_TRUE(picture({"--camera", "top"}) == top);
    const std::string free = picture({"--eye", "0.6,-0.5,0.8", "--target", "0.6,1,0"});
    EXPECT_TRUE(free != top);
    EXPECT_TRUE(picture({"--eye", "0.6,-0.5,0.9", "--target", "0.6,1,0"}) != free);
    EXPECT_TRUE(picture({"--eye", "0.6,-0.5,0.8", "--target", "0.5,1,0"}) != free);
    const std::string follow = picture({"--camera", "follow", "--ball", "1"});
    EXPECT_TRUE(picture({"--camera", "follow", "--ball", "cue"}) != follow);
}

TEST_F(CliRenderOptions, EveryOverlayShows) {
    // Before the first hit, whose place the ghost shows.
    const std::string at = "0.1";
    std::vector<std::string> seen = {picture({}, at)};
    for (const char* layer : {"trails", "events", "spin", "ghost", "clock", "margin", "all", "diamonds"}) {
        const std::string with = picture({"--overlay", layer}, at);
        for (const std::string& other : seen) EXPECT_TRUE(with != other) << layer;
        seen.push_back(with);
    }
}

// For a scene, the margin bar also counts the simulation.
TEST_F(CliRenderOptions, TheMarginOverlayAcceptsAScene) {
    const ProcessResult result =
        carom({"render", scene_, "--overlay", "margin", "--fps", "8", "--from", "0.3", "--to", "0.6",
               "--size", "96x54", "-o", folder_.file("m%d.png")});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(folder_.names().size(), 2u + 3u);
}

TEST_F(CliRenderOptions, ASheetIsASinglePicture) {
    const std::string sheet = folder_.file("sheet.png");
    const ProcessResult result =
        carom({"render", record_, "--sheet", "3x2", "--size", "300x180", "-o", sheet});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "6 pictures: " + sheet + "\n");
    const std::string bytes = read_file(sheet);
    EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\x01\x2C\0\0\0\x76", 8));  // 300 x 118
    EXPECT_EQ(folder_.names().size(), 3u);                                     // scene, record, sheet
}

TEST_F(CliRenderOptions, RawFramesAreRgbInOrder) {
    const ProcessResult result =
        carom({"render", record_, "--raw", "--fps", "4", "--to", "0.5", "--size", "64x36"});
    ASSERT_EQ(result.status, 0) << result.err;
    constexpr std::size_t kFrame = 64 * 36 * 3;
    ASSERT_EQ(result.out.size(), 3 * kFrame);
    EXPECT_TRUE(result.out.substr(0, kFrame) != result.out.substr(kFrame, kFrame));
    EXPECT_NE(result.err.find("ffmpeg -f rawvideo -pix_fmt rgb24 -s 64x36 -framerate 4 -i - "),
              std::string::npos)
        << result.err;
    // The last frame alone equals the last of the three.
    const ProcessResult last = carom({"render", record_, "--raw", "--at", "0.5", "--size", "64x36"});
    EXPECT_TRUE(last.out == result.out.substr(2 * kFrame));
    EXPECT_EQ(folder_.names().size(), 2u);  // no file
}

TEST_F(CliRenderOptions, AFullDeviceEndsRawFramesWithAMessage) {
    ProcessOptions options;
    options.output_to = "/dev/full";
    const ProcessResult result = carom({"render", record_, "--raw", "--size", "640x360"}, options);
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("No space left"), std::string::npos) << result.err;
}

TEST_F(CliRenderOptions, BothBackEndsGiveTheSameFile) {
    ProcessResult egl =
        carom({"render", record_, "-o", folder_.file("e%d.png"), "--at", "0.5", "--gl", "egl"});
    if (egl.status == 1 && egl.err.find("libegl1") != std::string::npos) GTEST_SKIP() << egl.err;
    ASSERT_EQ(egl.status, 0) << egl.err;
    EXPECT_TRUE(read_file(folder_.file("e0.png")) == picture({"--gl", "osmesa"}));
    // Without OSMesa the default is EGL: files with OSMesa's names that are not libraries come first in the
    // path.
    TemporaryFolder fake;
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
        fake.write(name, "no library");
    ProcessOptions options;
    options.environment = {{"LD_LIBRARY_PATH", fake.path().string()}};
    const ProcessResult found =
        carom({"render", record_, "-o", folder_.file("a%d.png"), "--at", "0.5"}, options);
    ASSERT_EQ(found.status, 0) << found.err;
    EXPECT_TRUE(read_file(folder_.file("e0.png")) == read_file(folder_.file("a0.png")));
}

TEST_F(CliRenderOptions, AMissingLibraryNamesItsPackage) {
    // Files with these names that are not libraries, first in the path.
    TemporaryFolder fake;
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", "libEGL.so.1", "libEGL.so"})
        fake.write(name, "no library");
    ProcessOptions options;
    options.environment = {{"LD_LIBRARY_PATH", fake.path().string()}};
    expect_refused(1, "libosmesa6", {"--gl", "osmesa"}, options);
    expect_refused(1, "libegl1", {"--gl", "egl"}, options);
    expect_refused(1, "libegl1", {}, options);
}

TEST_F(CliRenderOptions, AReadOnlyFolderIsNamed) {
    if (::geteuid() == 0) GTEST_SKIP() << "permissions do not stop root";
    const std::string locked = folder_.file("locked");
    ASSERT_EQ(::mkdir(locked.c_str(), 0555), 0);
    expect_refused(1, locked, {"--at", "0", "-o", locked + "/%d.png"});
}

}  // namespace
}  // namespace carom::test
