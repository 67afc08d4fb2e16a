// Frequency of a run's progress reports, and so how soon it can be stopped.
#include "support/gas.h"

#include <stdexcept>
#include <string>

namespace carom {
namespace {

using namespace test;

struct Calls {
    std::size_t count = 0, last_events = 0;
    Record record;
};

Calls calls_of(const Scene& scene, int rounds) {
    Calls calls;
    SimulateOptions options;
    options.progress_rounds = rounds;
    options.progress = [&calls](std::size_t events, double) {
        ++calls.count;
        EXPECT_GE(events, calls.last_events);
        calls.last_events = events;
    };
    calls.record = simulate(plan_of(scene), options);
    return calls;
}

std::size_t count_of(const Record& record, EventType type) {
    std::size_t count = 0;
    for (const Event& e : record.events) count += e.type == type ? 1U : 0U;
    return count;
}

TEST(Progress, IsReportedEverySixtyFourthRound) {
    const Scene scene = gas(100, 6400, 7);
    const Calls every = calls_of(scene, 1);
    EXPECT_EQ(every.count, 6400u);
    EXPECT_EQ(calls_of(scene, SimulateOptions{}.progress_rounds).count, every.count / 64);
    EXPECT_EQ(calls_of(scene, 100).count, every.count / 100);
}

TEST(Progress, AShortRunReportsNothing) {
    EXPECT_EQ(calls_of(gas(16, 63, 7), 64).count, 0u);
    EXPECT_EQ(calls_of(gas(16, 64, 7), 64).count, 1u);
}

// Otherwise sixty-four marches of ten million steps would run for a minute without a check for signals.
TEST(Progress, IsReportedAfterEveryLongRound) {
    Scene scene = read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/eight_ball_break.toml");
    const Calls compliant = calls_of(scene, 1000000);
    ASSERT_GT(compliant.record.clusters.size(), 0u);
    EXPECT_GE(compliant.count, compliant.record.clusters.size());
    EXPECT_LT(compliant.count, compliant.record.events.size() / 2);

    scene.physics.clusters = ClusterModel::kSequential;
    const std::size_t short_ones = calls_of(scene, 1000000).count;
    scene.physics.substeps = 2000;
    const Calls march = calls_of(scene, 1000000);
    EXPECT_GE(march.count, count_of(march.record, EventType::kBallBall));
    EXPECT_GT(march.count, short_ones + 10);
}

TEST(Progress, IsReportedForRestingContacts) {
    Scene scene = empty_scene();
    const double R = scene.balls.R;
    // Its spin pushes its neighbour along.
    add_ball(scene, "a", 0.0, 0.0, 0.0, 0.0, Vec3(0.0, 100.0, 0.0));
    add_ball(scene, "b", 2.0 * R, 0.0);
    const Calls calls = calls_of(scene, 1000000);
    ASSERT_GT(count_of(calls.record, EventType::kBallBallHold), 0u);
    EXPECT_GT(calls.count, 0u);
}

TEST(Progress, AnExceptionOfTheCallbackEndsTheRun) {
    SimulateOptions options;
    options.progress = [](std::size_t events, double) {
        if (events > 1000) throw std::out_of_range("enough");
    };
    EXPECT_THROW(simulate(plan_of(gas(100, 100000000, 7)), options), std::out_of_range);
}

}  // namespace
}  // namespace carom
