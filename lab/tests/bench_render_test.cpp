// Input that carom-lab bench render refuses.
#include "bench/render.h"

#include <gtest/gtest.h>

#include "carom/render/error.h"

namespace carom::tools {
namespace {

TEST(BenchRender, NeedsThreeFrames) {
    EXPECT_THROW(bench_render(Record(), 2, render::Backend::kOsmesa), render::RenderError);
}

}  // namespace
}  // namespace carom::tools
