// Threads, resuming, raw frames, contact sheets, measuring.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/render/png.h"
#include "carom/render/sequence.h"
#include "render/hand_made.h"
#include "support/read_png.h"

namespace carom::render {
namespace {

using render_test::same_pixels;
using render_test::ScratchFolder;

Record rolling_ball() {
    Record record = render_test::rectangle_record();
    Segment segment = render_test::still({0.5, 0.5, render_test::kR});
    segment.v = Vec3(0.2, 1.0, 0.0);
    segment.w = Vec3(-1.0, 0.2, 0.0) / render_test::kR;
    segment.state = MotionState::kRolling;
    render_test::add_ball(record, "7", segment);
    record.duration = 0.5;
    return record;
}

SequenceOptions options_for(const std::string& pattern) {
    SequenceOptions options;
    options.pattern = pattern;
    options.size = {160, 90};
    options.table_samples = 2;
    return options;
}

TEST(Pipeline, ThreadsChangeNothingInTheFrames) {
    const ScratchFolder folder("threads");
    const Record record = rolling_ball();
    SequenceOptions options = options_for(folder.file("a%02d.png"));
    options.jobs = 1;
    const std::size_t count = render_sequence(record, options).size();
    ASSERT_EQ(count, 31U);
    options.pattern = folder.file("b%02d.png");
    options.jobs = 5;
    for (const FrameTiming& timing : render_sequence(record, options)) {
        EXPECT_GT(timing.draw_ms, 0.0);
        EXPECT_GT(timing.readback_ms, 0.0);
        EXPECT_GT(timing.encode_ms, 0.0);
        EXPECT_GT(timing.write_ms, 0.0);
    }
    for (long k = 0; k < static_cast<long>(count); ++k) {
        EXPECT_TRUE(same_pixels(render_test::read_png(frame_path(folder.file("a%02d.png"), k)),
                                render_test::read_png(frame_path(options.pattern, k))))
            << k;
    }
    EXPECT_EQ(folder.entries(), 2 * count);
}

TEST(Pipeline, RawFramesComeInOrderWithTheSamePixels) {
    const ScratchFolder folder("raw");
    const Record record = rolling_ball();
    SequenceOptions options = options_for(folder.file("%02d.png"));
    render_sequence(record, options);
    std::vector<std::vector<std::uint8_t>> frames;
    options.raw = [&](const std::uint8_t* rgb, std::size_t bytes) { frames.emplace_back(rgb, rgb + bytes); };
    options.pattern = "not used";
    render_sequence(record, options);
    ASSERT_EQ(frames.size(), 31U);
    for (std::size_t k = 0; k < frames.size(); ++k) {
        const Image image = render_test::read_png(frame_path(folder.file("%02d.png"), static_cast<long>(k)));
        ASSERT_EQ(frames[k].size(), 3U * 160 * 90);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < frames[k].size(); ++i)
            differ += frames[k][i] != image.rgbx[i / 3 * 4 + i % 3];
        EXPECT_EQ(differ, 0U) << k;
    }
    EXPECT_EQ(folder.entries(), 31U);
}

TEST(Pipeline, BothWritersGiveTheSamePixels) {
    const ScratchFolder folder("writers");
    SequenceOptions options = options_for(folder.file("a%02d.png"));
    const std::vector<FrameTiming> changes = render_sequence(rolling_ball(), options);
    options.pattern = folder.file("b%02d.png");
    options.libpng = true;
    const std::vector<FrameTiming> whole = render_sequence(rolling_ball(), options);
    for (long k = 0; k < static_cast<long>(whole.size()); ++k) {
        EXPECT_TRUE(same_pixels(render_test::read_png(frame_path(folder.file("a%02d.png"), k)),
                                render_test::read_png(frame_path(options.pattern, k))))
            << k;
        EXPECT_EQ(whole[static_cast<std::size_t>(k)].encoded_share, 1.0);
    }
    EXPECT_GT(changes.back().encoded_share, 0.0);
    EXPECT_LT(changes.back().encoded_share, 0.5);
}

// Threads, their number and an encoder's earlier contents change no byte.
TEST(Pipeline, BytesDependOnThePixelsAlone) {
    const ScratchFolder folder("bytes");
    SequenceOptions options = options_for(folder.file("a%02d.png"));
    options.jobs = 1;
    const std::size_t count = render_sequence(rolling_ball(), options).size();
    options.pattern = folder.file("b%02d.png");
    options.jobs = 3;
    render_sequence(rolling_ball(), options);
    options.pattern = folder.file("c%02d.png");
    for (long k = 0; k < static_cast<long>(count); k += 10) {
        options.frame = k;
        render_sequence(rolling_ball(), options);
    }
    const auto bytes = [&folder](char run, long k) {
        std::ifstream file(frame_path(folder.file(std::string(1, run) + "%02d.png"), k), std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    for (long k = 0; k < static_cast<long>(count); ++k) {
        EXPECT_FALSE(bytes('a', k).empty());
        EXPECT_EQ(bytes('a', k), bytes('b', k)) << k;
        if (k % 10 == 0) {
            EXPECT_EQ(bytes('a', k), bytes('c', k)) << k;
        }
    }
}

// The frames of a stream against the formulas of ITU-R BT.709 in floating point, also at an odd size.
TEST(Pipeline, Y4mFramesHaveTheirPixelsColours) {
    const ScratchFolder folder("y4m");
    for (const FrameSize size : {FrameSize{160, 90}, FrameSize{81, 45}}) {
        SequenceOptions options = options_for(folder.file("%02d.png"));
        options.size = size;
        render_sequence(rolling_ball(), options);
        options.raw_format = RawFormat::kY4m;
        std::vector<std::vector<std::uint8_t>> frames;
        options.raw = [&](const std::uint8_t* bytes, std::size_t count) {
            frames.emplace_back(bytes, bytes + count);
        };
        render_sequence(rolling_ball(), options);
        ASSERT_EQ(frames.size(), 31U);
        const int w = size.width, h = size.height, columns = (w + 1) / 2, rows = (h + 1) / 2;
        for (const long k : {0L, 1L, 30L}) {
            const std::vector<std::uint8_t>& frame = frames[static_cast<std::size_t>(k)];
            const Image image = render_test::read_png(frame_path(options.pattern, k));
            ASSERT_EQ(frame.size(), static_cast<std::size_t>(6 + w * h + 2 * columns * rows));
            EXPECT_EQ(std::string(frame.begin(), frame.begin() + 6), "FRAME\n");
            const auto brightness = [](const double* c) {
                return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
            };
            double worst = 0.0;
            const auto look = [&](std::size_t at, double expected) {
                worst = std::max(worst, std::abs(frame[at] - expected));
            };
            for (int y = 0; y < h; ++y) {
                for (int x = 0; x < w; ++x) {
                    const std::uint8_t* p = image.pixel(x, y);
                    const double c[] = {p[0] / 255.0, p[1] / 255.0, p[2] / 255.0};
                    look(6 + static_cast<std::size_t>(y) * static_cast<std::size_t>(w) +
                             static_cast<std::size_t>(x),
                         16.0 + 219.0 * brightness(c));
                }
            }
            for (int y = 0; y < rows; ++y) {
                for (int x = 0; x < columns; ++x) {
                    double c[3] = {};
                    for (int i = 0; i < 12; ++i)
                        c[i % 3] += image.pixel(std::min(2 * x + i / 3 % 2, w - 1),
                                                std::min(2 * y + i / 6, h - 1))[i % 3] /
                                    1020.0;
                    const std::size_t at =
                        frame.size() - static_cast<std::size_t>(2 * columns * rows - y * columns - x);
                    look(at, 128.0 + 224.0 * (c[2] - brightness(c)) / 1.8556);
                    look(at + static_cast<std::size_t>(columns * rows),
                         128.0 + 224.0 * (c[0] - brightness(c)) / 1.5748);
                }
            }
            EXPECT_LT(worst, 0.51) << w << " " << k;
        }
    }
}

TEST(Pipeline, AStreamsHeaderStatesTheRateAsARatio) {
    const auto rate = [](double fps) {
        const std::string line = y4m_header({64, 36}, fps);
        return line.substr(0, line.find(" Ip "));
    };
    EXPECT_EQ(rate(60.0), "YUV4MPEG2 W64 H36 F60:1");
    EXPECT_EQ(rate(0.8), "YUV4MPEG2 W64 H36 F4:5");
    EXPECT_EQ(rate(29.97), "YUV4MPEG2 W64 H36 F2997:100");
    EXPECT_EQ(rate(30000.0 / 1001.0), "YUV4MPEG2 W64 H36 F30000:1001");
    EXPECT_EQ(rate(1.0 / 3.0), "YUV4MPEG2 W64 H36 F1:3");
    EXPECT_THROW(y4m_header({64, 36}, 1e-12), RenderError);
    EXPECT_EQ(y4m_header({64, 36}, 60.0).back(), '\n');
}

TEST(Pipeline, AFailingThreadStopsTheRunWithItsMessage) {
    const Record record = rolling_ball();
    SequenceOptions options = options_for("");
    int frames = 0;
    options.raw = [&](const std::uint8_t*, std::size_t) {
        if (++frames == 3) throw RenderError("the reader went away");
    };
    try {
        render_sequence(record, options);
        FAIL();
    } catch (const RenderError& error) {
        EXPECT_STREQ(error.what(), "the reader went away");
    }
    EXPECT_LT(frames, 10);
}

TEST(Pipeline, ProgressMayStopTheRun) {
    const ScratchFolder folder("stop");
    SequenceOptions options = options_for(folder.file("%02d.png"));
    options.jobs = 3;
    options.progress = [](long done, long) {
        if (done == 8) throw std::runtime_error("interrupted");
    };
    EXPECT_THROW(render_sequence(rolling_ball(), options), std::runtime_error);
    // Every existing file is complete.
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        EXPECT_EQ(render_test::read_png(entry.path().string()).size, options.size);
    }
    EXPECT_LE(folder.entries(), 8U);
}

TEST(Pipeline, RefusesConflictingOptions) {
    SequenceOptions options = options_for("");
    options.jobs = -1;
    EXPECT_THROW(render_sequence(rolling_ball(), options), RenderError);
}

TEST(Sheet, ShowsTheShotRowByRow) {
    const ScratchFolder folder("sheet");
    Record record = rolling_ball();
    SequenceOptions options = options_for("");
    options.size = {482, 270};
    render_sheet(record, options, 3, 4, folder.file("sheet.png"));
    const Image sheet = render_test::read_png(folder.file("sheet.png"));
    EXPECT_EQ(sheet.size, (FrameSize{482, 362})) << "as wide as was asked for, with pictures of that shape";
    // 3 x 4 pictures of 159 x 89 with 2 pixels between them; the middle of each is cloth, and first and last
    // differ.
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 3; ++column) {
            const std::uint8_t* p = sheet.pixel(column * 161 + 85, row * 91 + 60);
            EXPECT_GT(p[1], p[0] + 20) << column << " " << row;
        }
    }
    int differ = 0;
    for (int y = 20; y < 89; ++y) {
        for (int x = 0; x < 159; ++x) {
            differ += std::abs(sheet.pixel(x, y)[0] - sheet.pixel(2 * 161 + x, 3 * 91 + y)[0]) > 40;
        }
    }
    EXPECT_GT(differ, 10);
    EXPECT_THROW(render_sheet(record, options, 0, 3, folder.file("no.png")), RenderError);
    EXPECT_THROW(render_sheet(record, options, 100, 3, folder.file("no.png")), RenderError);
    EXPECT_EQ(folder.entries(), 1U);
}

}  // namespace
}  // namespace carom::render
