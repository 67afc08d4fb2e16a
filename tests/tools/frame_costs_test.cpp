// Every event belongs to exactly one frame, and the sums are complete.
#include "base/margin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/clock.h"
#include "carom/render/sequence.h"
#include "reference/random_impacts.h"

namespace carom::tools {
namespace {

Record record_with_events(const std::vector<double>& times) {
    Record record;
    for (const double time : times) {
        record.events.push_back({time, EventType::kSlideRoll, 0, -1});
        record.costs.push_back({1000.0, 200.0, 30.0, 1, ""});
    }
    record.setup_detect_ns = 5000.0;
    return record;
}

TEST(FrameOf, AnEventAtAFrameBelongsToThatFrame) {
    for (const double fps : {24.0, 29.97, 59.94, 60.0, 90.0, 120.0, 144.0, 1000.0, 0.3}) {
        constexpr long kFrames = 5000;
        for (long k = 0; k < kFrames; ++k) {
            const double t = render::frame_time(0.0, k, fps);
            ASSERT_EQ(frame_of(t, 0.0, fps, kFrames), k) << fps;
            if (k > 0) {
                ASSERT_EQ(frame_of(std::nextafter(t, 0.0), 0.0, fps, kFrames), k - 1) << fps;
            }
            ASSERT_EQ(frame_of(std::nextafter(t, 1e9), 0.0, fps, kFrames), k) << fps;
        }
    }
}

TEST(FrameOf, MatchesItsDefinitionAtAnyTime) {
    reference::Generator rng(3);
    for (int i = 0; i < 100000; ++i) {
        const double fps = rng.uniform(1.0, 300.0), from = rng.uniform(0.0, 5.0),
                     t = from + rng.uniform(0.0, 20.0);
        constexpr long kFrames = 10000;
        const long k = frame_of(t, from, fps, kFrames);
        ASSERT_LE(render::frame_time(from, k, fps), t);
        ASSERT_LT(t, render::frame_time(from, k + 1, fps));
    }
}

TEST(FrameOf, TimesOutsideBelongToTheFirstOrLastFrame) {
    EXPECT_EQ(frame_of(-1.0, 0.0, 60.0, 10), 0);
    EXPECT_EQ(frame_of(0.5, 1.0, 60.0, 10), 0);
    EXPECT_EQ(frame_of(1e300, 0.0, 60.0, 10), 9);
    EXPECT_EQ(frame_of(3.0, 0.0, 60.0, 1), 0);
}

TEST(CostsByFrame, SumsByFrameAreComplete) {
    const std::vector<FrameCost> sums =
        costs_by_frame(record_with_events({0.0, 0.05, 0.1, 0.1, 0.19999, 0.5}), 0.0, 10.0, 4);
    ASSERT_EQ(sums.size(), 4u);
    EXPECT_EQ(sums[0].events, (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(sums[1].events, (std::vector<std::size_t>{2, 3, 4}));
    EXPECT_TRUE(sums[2].events.empty());
    EXPECT_EQ(sums[3].events, std::vector<std::size_t>{5});
    EXPECT_DOUBLE_EQ(sums[0].simulate_ms(), 5000e-6 + 2 * 1200e-6);  // including the first detection
    EXPECT_DOUBLE_EQ(sums[1].simulate_ms(), 3 * 1200e-6);
    EXPECT_DOUBLE_EQ(sums[1].kernel_ms, 3 * 30e-6);
    EXPECT_EQ(sums[2].simulate_ms(), 0.0);
}

TEST(CostsByFrame, PartsAddUpAndClustersCountSeparately) {
    Record record = record_with_events({0.05, 0.05, 0.15});
    record.events[1].type = EventType::kBallCluster;
    const std::vector<FrameCost> sums = costs_by_frame(record, 0.0, 10.0, 2);
    EXPECT_DOUBLE_EQ(sums[0].detect_ms, (5000 + 2 * 1000) * 1e-6);
    EXPECT_DOUBLE_EQ(sums[0].resolve_ms, 2 * 170e-6);
    EXPECT_DOUBLE_EQ(sums[0].kernel_ms, 30e-6);
    EXPECT_DOUBLE_EQ(sums[0].cluster_ms, 30e-6);
    EXPECT_DOUBLE_EQ(sums[0].simulate_ms(), (5000 + 2 * 1200) * 1e-6);
    EXPECT_EQ(sums[1].cluster_ms, 0.0);
    EXPECT_DOUBLE_EQ(sums[1].simulate_ms(), 1200e-6);
}

TEST(CostsByFrame, AgreesWithTheRendererOnTheFrames) {
    reference::Generator rng(5);
    for (int i = 0; i < 1000; ++i) {
        const double fps = rng.uniform(1.0, 200.0), duration = rng.uniform(0.0, 20.0);
        const long frames = render::frame_count(0.0, duration, fps);
        // A shot's last event is at its duration, never past the last frame's interval.
        EXPECT_EQ(frame_of(duration, 0.0, fps, frames + 5), frames - 1);
    }
}

TEST(Percentile, IsTheNearestRank) {
    std::vector<double> values;
    for (int i = 1; i <= 200; ++i) values.push_back(i);
    EXPECT_EQ(percentile(values, 50.0), 100.0);
    EXPECT_EQ(percentile(values, 95.0), 190.0);
    EXPECT_EQ(percentile(values, 99.0), 198.0);
    EXPECT_EQ(percentile(values, 100.0), 200.0);
    EXPECT_EQ(percentile(values, 0.0), 1.0);
    EXPECT_EQ(percentile({7.0}, 99.0), 7.0);
}

TEST(Median, IsTheMiddleValue) {
    EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
    EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
}

}  // namespace
}  // namespace carom::tools
