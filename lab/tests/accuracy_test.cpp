// The conclusions of carom-lab accuracy from its measurements, and the shot in Box2D.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/box2d_shot.h"
#include "accuracy/kernel.h"
#include "bench/kernel.h"
#include "bench/shot.h"
#include "carom/engine/simulate.h"
#include "commands/accuracy/scene.h"
#include "support/engine_cases.h"

namespace carom::tools {
namespace {

using namespace test;

TEST(LogSlope, IsTheExponentOfAPowerLaw) {
    std::vector<double> x, y;
    for (double n = 10.0; n < 1e6; n *= 3.0) {
        x.push_back(n);
        y.push_back(7.0 / (n * n));
    }
    EXPECT_NEAR(log_slope(x, y), -2.0, 1e-12);
    EXPECT_TRUE(std::isnan(log_slope({10.0}, {1.0})));
}

KernelAccuracyRow row(const char* method, double ns, double median, double worst) {
    KernelAccuracyRow r;
    r.method = method;
    r.kind = "single";
    r.ns_min = ns;
    r.error_median = median;
    r.error_max = worst;
    return r;
}

// Growth tables, which take minutes to measure.
TEST(BenchTables, ShowGrowth) {
    ShotBench shots;
    shots.growth = {
        {"gas", ClusterModel::kSequential, 16, Search::kDirect, true, 1234.0, 1300.0, 1.0, 650.0},
        {"gas compliant", ClusterModel::kCompliant, 16, Search::kDirect, true, 2345.0, 2400.0, 1.0, 650.0}};
    const std::string gas = shot_bench_text(shots);
    EXPECT_NE(gas.find("\ngas compliant             16 direct*     2345"), std::string::npos) << gas;
    EXPECT_NE(gas.find("1234"), std::string::npos) << gas;
    EXPECT_NE(gas.find("650"), std::string::npos) << gas;
    KernelBench kernels;
    for (const auto& [n, ns] : {std::pair{100, 2111.0}, {1000, 21222.0}, {10000, 213333.0}})
        kernels.growth.push_back({"march summed", kernel::Isa::kScalar, n, ns, ns});
    const std::string growth = kernel_bench_text(kernels);
    EXPECT_NE(growth.find("march summed              scalar       2111     21222    213333\n"),
              std::string::npos)
        << growth;
}

TEST(Reach, SelectsTheCheapestSufficientSetting) {
    std::vector<KernelAccuracyRow> rows = {row("a", 5.0, 1e-4, 1e-2), row("a", 50.0, 1e-6, 1e-3),
                                           row("a", 40.0, 1e-7, 1e-5), row("b", 9.0, 1e-13, 1e-10),
                                           row("formula", 1.0, 0.0, 0.0)};
    rows.back().other_model = true;
    const std::vector<KernelReach> reach = reach_of(rows);
    ASSERT_EQ(reach.size(), 8u);  // two methods, four errors; the formula solves another problem
    EXPECT_EQ(reach[0].error, 1e-3);
    EXPECT_EQ(reach[0].ns_median, 5.0);
    EXPECT_EQ(reach[0].ns_all, 40.0);
    EXPECT_EQ(reach[1].ns_median, 40.0);
    EXPECT_TRUE(std::isinf(reach[1].ns_all));
    EXPECT_TRUE(std::isinf(reach[2].ns_median));
    EXPECT_EQ(reach[7].method, "b");
    EXPECT_EQ(reach[7].ns_median, 9.0);
    EXPECT_TRUE(std::isinf(reach[7].ns_all));
}

TEST(Box2d, RollingFrictionLimitsTheDistance) {
    Scene scene = empty_scene();
    add_ball(scene, "1", 0.0, 0.0, 1.0, 0.0, rolling_spin(1.0, 0.0, scene.balls.R));
    const Record record = simulate(plan_of(scene));
    const Box2dOutcome shot = run_box2d(record, 1000.0);
    EXPECT_NEAR(shot.positions[0].x(), final_positions(record)[0].x(), 0.02);
    EXPECT_NEAR(shot.positions[0].y(), 0.0, 1e-6);
    EXPECT_EQ(shot.first_contact, "");
}

TEST(Box2d, HitsBouncesAndPockets) {
    Scene scene = empty_scene();
    scene.table = make_table("nine_foot");
    add_ball(scene, "cue", 0.5, 0.6, 0.0, 2.0);
    add_ball(scene, "object", 0.5, 1.0);
    const Box2dOutcome hit = run_box2d(simulate(plan_of(scene)), 240.0);
    EXPECT_EQ(hit.first_contact, "object");
    EXPECT_LT(hit.positions[0].y(), 1.0);  // the cue ball keeps (1 - e) / 2 of its speed
    EXPECT_GT(hit.positions[1].y(), 1.0);
    EXPECT_LT(hit.positions[1].y(), scene.table.length);

    Scene pocketed = empty_scene();
    pocketed.table = make_table("nine_foot");
    const Vec2 corner = pocketed.table.pockets[0].center, start(0.3, 0.3), way = corner - start;
    add_ball(pocketed, "cue", start.x(), start.y(), 2.0 * way.x() / way.norm(), 2.0 * way.y() / way.norm());
    EXPECT_EQ(run_box2d(simulate(plan_of(pocketed)), 240.0).pockets[0], 0);
}

TEST(Box2d, RestingBallsStay) {
    Scene scene = empty_scene();
    add_ball(scene, "1", 0.25, 0.5);
    const Box2dOutcome shot = run_box2d(simulate(plan_of(scene)), 60.0);
    EXPECT_EQ(shot.duration, 0.0);
    EXPECT_NEAR(shot.positions[0].x(), 0.25, 1e-7);
}

}  // namespace
}  // namespace carom::tools
