// A whole break: times, first and last state, memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/simulate.h"
#include "carom/render/png.h"
#include "carom/render/renderer.h"
#include "carom/render/sequence.h"
#include "render/hand_made.h"

namespace carom::render {
namespace {

const Record& the_break() {
    static const Record record = [] {
        const Scene scene = read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/eight_ball_break.toml");
        return simulate(make_plan(scene, kernel::Isa::kScalar));
    }();
    return record;
}

// Finds a ball in the picture by removing it. The ball is painted white: then red only increases where it is,
// and only decreases in its shadow.
std::optional<Vec2> measured_centre(Renderer& renderer, const DrawList& list, std::size_t ball) {
    DrawList with = list, without = list;
    with.balls[ball].style = BallStyle{};
    without.balls.erase(without.balls.begin() + static_cast<std::ptrdiff_t>(ball));
    Image a, b;
    renderer.draw(with);
    renderer.read(a);
    renderer.draw(without);
    renderer.read(b);
    double weight = 0.0;
    Vec2 sum(0.0, 0.0);
    // The neighbours mirror the ball: count only its own disc.
    const Vec3 at = list.balls[ball].center;
    const Vec2 middle = *list.camera.project(at);
    const double reach =
        (*list.camera.project(at + Vec3(list.balls[ball].radius, 0.0, 0.0)) - middle).norm() + 1.0;
    for (int y = 0; y < a.size.height; ++y) {
        for (int x = 0; x < a.size.width; ++x) {
            if (!((Vec2(x + 0.5, y + 0.5) - middle).norm() < reach)) continue;
            const double w = std::clamp((a.pixel(x, y)[0] - b.pixel(x, y)[0]) / 60.0, 0.0, 1.0);
            weight += w;
            sum += w * Vec2(x + 0.5, y + 0.5);
        }
    }
    if (weight < 50.0) return std::nullopt;
    return Vec2(sum / weight);
}

TEST(Break, EveryBallIsWithinHalfAPixelOfTheRecord) {
    const Record& record = the_break();
    StageOptions options;
    options.size = {1280, 720};
    const Stage stage(record, options);
    Renderer renderer;
    const long frames = frame_count(0.0, record.duration, 60.0);
    int measured = 0;
    for (long k : {0L, 20L, frames / 2, frames - 1}) {
        const double t = frame_time(0.0, k, 60.0);
        DrawList list = stage.at(t);
        // Nothing hides part of a white ball, and nothing else on the table is white.
        for (DrawBall& ball : list.balls) {
            ball.style = BallStyle{};
            ball.style.color = {0.0F, 0.0F, 0.3F};
        }
        for (std::size_t i = 0; i < list.balls.size(); ++i) {
            if (list.balls[i].in_pocket) continue;
            const std::optional<Vec2> centre = measured_centre(renderer, list, i);
            ASSERT_TRUE(centre) << "frame " << k << " ball " << i;
            const Vec2 expected = *list.camera.project(list.balls[i].center);
            EXPECT_LT((*centre - expected).norm(), 0.5) << "frame " << k << " ball " << i;
            ++measured;
        }
        // The draw list itself matches the record's state.
        std::size_t on_table = 0, drawn = 0;
        for (std::size_t i = 0; i < record.tracks.size(); ++i) {
            const BallState state = record.state_at(static_cast<int>(i), t);
            if (state.state == MotionState::kPocketed) continue;
            ++on_table;
            for (const DrawBall& ball : list.balls) drawn += ball.center == state.position;
        }
        EXPECT_EQ(drawn, on_table) << "frame " << k;
    }
    EXPECT_GT(measured, 40);
}

TEST(Break, FrameTimesAreExactAndTheLastShowsTheEnd) {
    const Record& record = the_break();
    SequenceOptions options;
    options.pattern = "";
    options.size = {96, 54};
    options.table_samples = 1;
    const std::vector<FrameTiming> timings = render_sequence(record, options);
    ASSERT_EQ(timings.size(), static_cast<std::size_t>(frame_count(0.0, record.duration, 60.0)));
    for (std::size_t k = 0; k < timings.size(); ++k) {
        EXPECT_EQ(timings[k].frame, static_cast<long>(k));
        EXPECT_EQ(timings[k].time, static_cast<double>(k) / 60.0);
    }
    EXPECT_LE(timings.back().time, record.duration);
    EXPECT_GT(timings.back().time + 1.0 / 60.0, record.duration);
}

long peak_memory_kb() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.rfind("VmHWM:", 0) == 0) return std::stol(line.substr(6));
    }
    return -1;
}

// Mesa's own memory differs by tens of megabytes between releases, so a sequence's memory is counted from
// there.
TEST(Break, A1080pSequenceUsesUnder240MegabytesBesidesTheDriver) {
#ifdef CAROM_SANITIZED
    GTEST_SKIP() << "the sanitizer's own memory counts";
#endif
    const render_test::ScratchFolder folder("memory");
    SequenceOptions options;
    options.pattern = folder.file("%03d.png");
    options.table_samples = 2;
    options.size = {16, 16};
    options.frame = 0;
    ASSERT_EQ(render_sequence(the_break(), options).size(), 1U);  // the driver, its compiler, the shaders
    const long idle = peak_memory_kb();
    ASSERT_GT(idle, 0);
    options.size = {1920, 1080};
    options.frame.reset();
    options.jobs = 16;
    options.to = 0.6;
    EXPECT_EQ(render_sequence(the_break(), options).size(), 37U);
    const long peak = peak_memory_kb();
    std::printf(
        "peak memory at 1920x1080 with 16 encoder threads: %ld MB, of which %ld MB are an idle renderer's\n",
        peak / 1024, idle / 1024);
    EXPECT_LT(peak - idle, 240000000 / 1024);
}

}  // namespace
}  // namespace carom::render
