// The frames of a run as a trace, with given costs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "margin/lab_margin.h"

namespace carom::tools {
namespace {

TEST(MarginTrace, ALateFramePushesTheNextOne) {
    MarginRun run;
    run.frames.resize(3);
    for (std::size_t s = 0; s < kMarginStages; ++s) run.stage[s].assign(3, s < kReadback ? 0.0 : 1.0);
    run.stage[kDraw] = {20.0, 1.0, 1.0};
    const auto trace = nlohmann::json::parse(margin_trace(run, 100.0)).at("traceEvents");
    std::vector<double> starts;
    for (const auto& event : trace)
        if (event.at("cat") == "frame") starts.push_back(event.at("ts").get<double>());
    // The first frame lasts 23 ms: the second begins then, and the third is also late.
    EXPECT_EQ(starts, (std::vector<double>{0.0, 23000.0, 27000.0}));
}

}  // namespace
}  // namespace carom::tools
