// carom render: complete, numbered frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/record.h"
#include "cli.h"

namespace carom::test {
namespace {

class CliRender : public ::testing::Test {
  protected:
    std::string pattern() const { return folder_.file("frames/%05d.png"); }
    std::string frame(int k) const {
        char name[32];
        std::snprintf(name, sizeof name, "frames/%05d.png", k);
        return folder_.file(name);
    }

    TemporaryFolder folder_;
    std::string scene_ = folder_.write("s.toml", kSmallScene);
};

/// Width and height stated by a PNG file; {0, 0} if it is incomplete.
std::pair<unsigned, unsigned> png_size(const std::string& path) {
    const std::string bytes = read_file(path);
    const std::string end("IEND\xAE\x42\x60\x82", 8);
    if (bytes.substr(0, 8) != "\x89PNG\r\n\x1a\n" || bytes.size() < 45) return {0, 0};
    if (bytes.substr(bytes.size() - 8) != end) return {0, 0};
    const auto number = [&bytes](std::size_t at) {
        unsigned value = 0;
        for (std::size_t i = at; i < at + 4; ++i) value = 256 * value + static_cast<unsigned char>(bytes[i]);
        return value;
    };
    return {number(16), number(20)};
}

TEST_F(CliRender, FramesAreNumberedFromZeroAndComplete) {
    const ProcessResult result =
        carom({"render", scene_, "-o", pattern(), "--fps", "10", "--from", "0.5", "--to", "0.8"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out, "4 frames, 320x180 at 10 fps: " + pattern() +
                              "\nto make a film of them: ffmpeg -y -framerate 10 -i " + pattern() +
                              " -frames:v 4 -pix_fmt yuv420p shot.mp4\n");
    for (int k = 0; k < 4; ++k) EXPECT_EQ(png_size(frame(k)), std::make_pair(320u, 180u)) << k;
    EXPECT_EQ(folder_.names().size(), 5u);
    EXPECT_NE(read_file(frame(0)), read_file(frame(3)));
}

TEST_F(CliRender, ARecordHasTheSameFramesAsItsScene) {
    ASSERT_EQ(carom({"simulate", scene_, "-o", folder_.file("r.json")}).status, 0);
    const std::vector<std::string> options = {"--fps", "10", "--to", "0.3", "--size", "160x90"};
    for (const auto& [input, name] : {std::pair{scene_, "a"}, {folder_.file("r.json"), "b"}}) {
        std::vector<std::string> arguments = {"render", input, "-o",
                                              folder_.file(std::string(name) + "%d.png")};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = carom(arguments);
        ASSERT_EQ(result.status, 0) << result.err;
    }
    for (const char* k : {"0", "1", "2", "3"}) {
        EXPECT_EQ(read_file(folder_.file(std::string("a") + k + ".png")),
                  read_file(folder_.file(std::string("b") + k + ".png")));
    }
}

TEST_F(CliRender, ARecordWithAnUnknownKeyIsDrawnWithANote) {
    std::string text = read_file(CAROM_SOURCE_DIR "/tests/fuzz/corpus/record/short.json");
    text.insert(1, "\"weather\": 1, ");
    const std::string newer = folder_.write("newer.json", text);
    const ProcessResult result = carom({"render", newer, "-o", pattern(), "--at", "0", "--size", "64x36"});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.err.substr(0, newer.size() + 15), "carom: note: " + newer + ": ");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1);
}

TEST_F(CliRender, OneFrameAndOneInstant) {
    ProcessResult result = carom({"render", scene_, "-o", pattern(), "--fps", "10", "--frame", "7"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "1 frame: " + frame(7) + "\n");
    result = carom({"render", scene_, "-o", pattern(), "--at", "0.7"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "1 frame: " + frame(0) + "\n");
    EXPECT_EQ(folder_.names().size(), 3u);
    EXPECT_EQ(read_file(frame(0)), read_file(frame(7)));  // 7 / 10 s is 0.7 s
}

}  // namespace
}  // namespace carom::test
