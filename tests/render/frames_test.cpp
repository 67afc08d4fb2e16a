// Names, times and files of a sequence.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "carom/render/png.h"
#include "carom/render/sequence.h"
#include "render/hand_made.h"
#include "support/read_png.h"

namespace carom::render {
namespace {

using render_test::ScratchFolder;

TEST(FrameCount, EndsAreIncludedAndComputedFromIntegers) {
    EXPECT_EQ(frame_count(0.0, 0.0, 60.0), 1);
    EXPECT_EQ(frame_count(0.0, 0.1, 60.0),
              7);  // 6 / 60 is the double 0.1; 0.1 * 60 rounds to 6.000000000000001 or 6
    EXPECT_EQ(frame_count(0.0, 0.3, 10.0), 4);    // 0.3 * 10 rounds to 3, and 3 / 10 is the double 0.3
    EXPECT_EQ(frame_count(0.0, 0.7, 100.0), 71);  // 0.7 * 100 rounds to 70, or below
    EXPECT_EQ(frame_count(0.0, 0.29, 100.0),
              30);  // 0.29 * 100 is 28.999999999999996: a product alone would lose one
    EXPECT_EQ(frame_count(0.0, std::nextafter(0.1, 0.0), 60.0), 6);
    EXPECT_EQ(frame_count(0.5, 0.4, 60.0), 0);
    EXPECT_EQ(frame_count(1.0, 2.0, 60.0), 61);
}

TEST(FrameCount, CountsExactlyTheTimesThatFit) {
    for (double fps : {7.0, 24.0, 29.97, 60.0, 1000.0}) {
        for (int k = 0; k < 400; ++k) {
            const double to = frame_time(0.25, k, fps);
            EXPECT_EQ(frame_count(0.25, to, fps), k + 1) << fps;
            EXPECT_EQ(frame_count(0.25, std::nextafter(to, 0.0), fps), k) << fps;
        }
    }
}

TEST(FrameCount, RefusesUncountableFrames) {
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_THROW(frame_count(0.0, 1.0, 0.0), RenderError);
    EXPECT_THROW(frame_count(0.0, 1.0, -60.0), RenderError);
    EXPECT_THROW(frame_count(0.0, 1.0, std::nan("")), RenderError);
    EXPECT_THROW(frame_count(0.0, infinity, 60.0), RenderError);
    EXPECT_THROW(frame_count(-infinity, 1.0, 60.0), RenderError);
    // Frames at the same instant would be counted forever.
    for (const double late : {1e16, 1e17, 1e300}) EXPECT_THROW(frame_count(late, late, 60.0), RenderError);
}

TEST(FramePath, FillsInTheNumber) {
    EXPECT_EQ(frame_path("frames/%05d.png", 42), "frames/00042.png");
    EXPECT_EQ(frame_path("f%d.png", 123456), "f123456.png");
    EXPECT_EQ(frame_path("%02d", 7), "07");
    EXPECT_EQ(frame_path("100%%/%03d.png", 5), "100%/005.png");
    EXPECT_EQ(frame_path("%010d", 5), "0000000005");
    EXPECT_EQ(frame_path("%03d.png", 12345), "12345.png");
    // A pattern without a number is a single frame.
    EXPECT_EQ(frame_path("frame.png", 5), "frame.png");
    EXPECT_EQ(frame_path("%%d", 5), "%d");
    EXPECT_FALSE(is_numbered("frame.png"));
    EXPECT_TRUE(is_numbered("frame%d.png"));
}

TEST(FramePath, RefusesEverythingElse) {
    for (const char* pattern : {"%d_%d.png", "%s.png", "%5d.png", "%0d.png", "%", "a%", "%i.png", "%05x.png",
                                "%-5d", "%05", "%0100d"}) {
        try {
            frame_path(pattern, 1);
            FAIL() << pattern << " was accepted";
        } catch (const RenderError& error) {
            EXPECT_NE(std::string(error.what()).find(std::string("'") + pattern + "'"), std::string::npos)
                << error.what();
        }
    }
}

Image test_image() {
    Image image;
    image.resize({37, 23});
    for (std::size_t i = 0; i < image.rgbx.size(); ++i) {
        image.rgbx[i] = i % 4 == 3 ? 0xFF : static_cast<std::uint8_t>(i * 7 + i / 13);
    }
    return image;
}

TEST(Png, ReadsBackTheSamePixels) {
    const ScratchFolder folder("png");
    const Image image = test_image();
    for (int level : {0, 1, 6, 9}) {
        std::vector<std::uint8_t> bytes;
        encode_png(image, level, bytes);
        write_file(folder.file("a.png"), bytes);
        EXPECT_TRUE(render_test::same_pixels(render_test::read_png(folder.file("a.png")), image)) << level;
    }
    EXPECT_EQ(folder.entries(), 1U);
}

// Limits the file size to imitate a disk that fills up in the middle of a file.
TEST(Files, AFullDiskLeavesNothing) {
    const ScratchFolder folder("full");
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit small{10000, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    std::string message;
    try {
        write_file(folder.file("big.png"), std::vector<std::uint8_t>(50000, 1));
    } catch (const RenderError& error) {
        message = error.what();
    }
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_EQ(message.find(folder.file("big.png")), 0U) << message;
    EXPECT_EQ(folder.entries(), 0U);
}

TEST(Files, AFolderWithTheFilesNameIsAnErrorThatLeavesNothing) {
    const ScratchFolder folder("inway");
    std::filesystem::create_directory(folder.file("00000.png"));
    EXPECT_THROW(write_file(folder.file("00000.png"), {1, 2, 3}), RenderError);
    EXPECT_EQ(folder.entries(), 1U);
}

Record one_ball() {
    Record record = render_test::rectangle_record();
    render_test::add_ball(record, "cue", 0.5, 0.5);
    record.duration = 0.05;
    return record;
}

SequenceOptions small_options(const std::string& pattern) {
    SequenceOptions options;
    options.pattern = pattern;
    options.size = {160, 90};
    options.table_samples = 2;
    return options;
}

TEST(Sequence, WritesNumberedFramesAndTimesThem) {
    const ScratchFolder folder("sequence");
    SequenceOptions options = small_options(folder.file("new/%03d.png"));
    long last = 0;
    options.progress = [&](long done, long total) {
        EXPECT_EQ(done, last + 1);
        EXPECT_EQ(total, 4);
        last = done;
    };
    const std::vector<FrameTiming> timings = render_sequence(one_ball(), options);
    ASSERT_EQ(timings.size(), 4U);
    EXPECT_EQ(last, 4);
    for (long k = 0; k < 4; ++k) {
        const FrameTiming& timing = timings[k];
        EXPECT_EQ(timing.frame, k);
        EXPECT_EQ(timing.time, static_cast<double>(k) / 60.0);
        EXPECT_GT(timing.draw_ms, 0.0);
        EXPECT_GT(timing.encode_ms, 0.0);
        const Image image = render_test::read_png(folder.file("new/00" + std::to_string(k) + ".png"));
        EXPECT_EQ(image.size, options.size);
    }
    EXPECT_EQ(folder.entries(), 5U);  // the folder and four frames, no temporary file
}

TEST(Sequence, OneFrameIsTheSameAsInTheWholeSequence) {
    const ScratchFolder folder("oneframe");
    Record record = one_ball();
    record.tracks[0].segments[0].v = Vec3(0.0, 3.0, 0.0);
    record.tracks[0].segments[0].state = MotionState::kRolling;
    SequenceOptions options = small_options(folder.file("a%d.png"));
    render_sequence(record, options);
    options.pattern = folder.file("b%d.png");
    options.frame = 2;
    ASSERT_EQ(render_sequence(record, options).size(), 1U);
    EXPECT_TRUE(render_test::same_pixels(render_test::read_png(folder.file("a2.png")),
                                         render_test::read_png(folder.file("b2.png"))));
    EXPECT_FALSE(render_test::same_pixels(render_test::read_png(folder.file("a1.png")),
                                          render_test::read_png(folder.file("b2.png"))));
    options.frame = 4;
    EXPECT_THROW(render_sequence(record, options), RenderError);
}

TEST(Sequence, AnEmptyPatternWritesNothing) {
    EXPECT_EQ(render_sequence(one_ball(), small_options("")).size(), 4U);
}

TEST(Sequence, AFileWithTheFoldersNameIsReported) {
    const ScratchFolder folder("nofolder");
    std::ofstream(folder.file("frames")) << "a file";
    for (const char* name : {"frames/%d.png", "absent/frames/%d.png"}) {
        try {
            render_sequence(one_ball(), small_options(folder.file(name)));
            FAIL() << name;
        } catch (const RenderError& error) {
            EXPECT_EQ(std::string(error.what())
                          .find(std::filesystem::path(folder.file(name)).parent_path().string()),
                      0U)
                << error.what();
        }
    }
    EXPECT_EQ(folder.entries(), 1U);
}

TEST(Sequence, AFrameThatCannotBeWrittenIsNamedAndLeavesNothing) {
    const ScratchFolder folder("unwritable");
    // A folder with the second frame's name also stops root, whom permissions would not.
    std::filesystem::create_directory(folder.file("1.png"));
    try {
        render_sequence(one_ball(), small_options(folder.file("%d.png")));
        FAIL();
    } catch (const RenderError& error) {
        EXPECT_EQ(std::string(error.what()).find(folder.file("1.png")), 0U) << error.what();
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        EXPECT_EQ(entry.path().extension(), ".png") << entry.path();
    }
}

TEST(Sequence, RefusesBadOptions) {
    SequenceOptions options = small_options("");
    options.camera = "periscope";
    EXPECT_THROW(render_sequence(one_ball(), options), RenderError);
    options = small_options("frame.png");
    EXPECT_THROW(render_sequence(one_ball(), options), RenderError);
    options = small_options("");
    options.size = {0, 90};
    EXPECT_THROW(render_sequence(one_ball(), options), RenderError);
}

}  // namespace
}  // namespace carom::render
