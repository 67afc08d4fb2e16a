// The bookkeeping of carom margin, with given costs.
#include "base/margin.h"

#include <vector>

#include <gtest/gtest.h>

namespace carom::tools {
namespace {

/// A run with these simulate and draw costs; the other stages of rendering cost 1 ms each.
MarginRun run_of(const std::vector<double>& simulate, const std::vector<double>& draw) {
    MarginRun run;
    run.frames.resize(simulate.size());
    run.stage[kSimulate] = simulate;
    run.stage[kDetect] = simulate;
    for (const std::size_t s : {kResolve, kKernel, kCluster}) run.stage[s].assign(simulate.size(), 0.0);
    run.stage[kDraw] = draw;
    for (const std::size_t s : {kReadback, kEncode, kWrite}) run.stage[s].assign(draw.size(), 1.0);
    return run;
}

TEST(Margin, AFrameSumsItsStagesAndIsTheMedianOfItsRuns) {
    const std::vector<MarginRun> runs = {run_of({1, 0, 0}, {5, 6, 7}), run_of({3, 0, 0}, {5, 9, 7}),
                                         run_of({2, 0, 1}, {5, 7, 80})};
    const Margin margin = combine(runs, 100.0, true);
    EXPECT_EQ(margin.budget_ms, 10.0);
    EXPECT_EQ(margin.total, (std::vector<double>{2 + 5 + 3, 7 + 3, 7 + 3}));
    EXPECT_EQ(margin.missed, 0);  // exactly in time is in time
    // Frames 0 and 1 of the second run; the third has one.
    EXPECT_EQ(margin.all.missed.low, 0.0);
    EXPECT_EQ(margin.all.missed.high, 2.0);
    EXPECT_EQ(margin.first.max.low, 10.0);
    EXPECT_EQ(margin.first.max.high, 10.0);
    EXPECT_EQ(margin.warm.max.low, 12.0);
    EXPECT_EQ(margin.warm.max.high, 84.0);
    EXPECT_EQ(margin.warm.missed.low, 1.0);
    EXPECT_EQ(margin.slack(0), 0.0);
    EXPECT_DOUBLE_EQ(margin.frame_spread, 0.3);  // (12 - 9) / 10 is the median
}

TEST(Margin, MissedFramesAndTheWorst) {
    const Margin margin = combine({run_of({0, 4, 0}, {5, 5, 30})}, 100.0, true);
    EXPECT_EQ(margin.missed, 2);
    EXPECT_EQ(margin.missed_shown, 1);  // 4 + 5 + 1 = 10 is in time without the file
    EXPECT_EQ(margin.worst, 2u);
    EXPECT_DOUBLE_EQ(margin.slack(2), -230.0);
}

TEST(Margin, WithoutRenderingAFrameIsItsSimulation) {
    const Margin margin = combine({run_of({0, 4, 1}, {})}, 500.0, false);
    EXPECT_EQ(margin.total, (std::vector<double>{0, 4, 1}));
    EXPECT_EQ(margin.missed, 1);
    EXPECT_FALSE(margin.has(kDraw));
    EXPECT_TRUE(margin.has(kCluster));
}

TEST(Accounting, ContainsSetUpAndTheFirstFrameOfEveryRun) {
    MarginRun run = run_of({1, 2, 3}, {100, 10, 20});
    run.setup_ms = 50.0;
    run.frames[1].events = {0, 1};
    Accounting sum = combine({run, run}, 100.0, true).accounting;
    EXPECT_DOUBLE_EQ(sum.setup_ms, 2 * 50);
    EXPECT_DOUBLE_EQ(sum.first_frames_ms, 2 * (1 + 100 + 3));
    EXPECT_DOUBLE_EQ(sum.frames_ms, 2 * (5 + 30 + 2 * 3));
    sum.start_ms = 6.0, sum.timing_ms = 4.0, sum.wall_ms = 500.0;
    EXPECT_DOUBLE_EQ(sum.share(), (100 + 208 + 82 + 10) / 500.0);
    EXPECT_EQ(combine({run}, 100.0, true).quiet, 2u);
}

}  // namespace
}  // namespace carom::tools
