// What carom accuracy concludes from its measurements, and the promise of its recommendation.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/box2d_shot.h"
#include "accuracy/kernel.h"
#include "bench/kernel.h"
#include "bench/shot.h"
#include "carom/engine/simulate.h"
#include "commands/accuracy/scene.h"
#include "reference/random_impacts.h"
#include "support/engine_cases.h"

namespace carom::tools {
namespace {

using namespace test;

TEST(LogSlope, IsThatOfAPowerLaw) {
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

// The tables of growth, which take minutes to measure.
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

TEST(Reach, TakesTheCheapestSettingThatDoes) {
    std::vector<KernelAccuracyRow> rows = {row("a", 5.0, 1e-4, 1e-2), row("a", 50.0, 1e-6, 1e-3),
                                           row("a", 40.0, 1e-7, 1e-5), row("b", 9.0, 1e-13, 1e-10),
                                           row("formula", 1.0, 0.0, 0.0)};
    rows.back().other_model = true;
    const std::vector<KernelReach> reach = reach_of(rows);
    ASSERT_EQ(reach.size(), 8u);  // two methods, four errors; the formula solves something else
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

TEST(DeservedTolerance, IsTheLoosestPowerOfTenThatKeepsTheTarget) {
    EXPECT_EQ(deserved_tolerance(1.0, 1e-2), 1e-3);  // looser is solved as 1e-3 anyway
    EXPECT_EQ(deserved_tolerance(0.0, 1e-3), 1e-3);
    EXPECT_EQ(deserved_tolerance(2.0, 1e-3), 1e-4);
    EXPECT_EQ(deserved_tolerance(9.9e4, 1e-3), 1e-8);
    EXPECT_EQ(deserved_tolerance(1.1e5, 1e-3), 1e-9);
    EXPECT_EQ(deserved_tolerance(9e9, 1e-3), 1e-13);
    EXPECT_EQ(deserved_tolerance(2e10, 1e-3), std::nullopt);
    EXPECT_EQ(deserved_tolerance(INFINITY, 1e-3), std::nullopt);
    EXPECT_EQ(deserved_tolerance(NAN, 1e-3), std::nullopt);
}

// What could not be finished is a row that says why, and no figure.
TEST(SceneAccuracy, ASettingThatFailsIsARow) {
    SceneAccuracy result;
    result.rows.resize(2);
    for (SceneAccuracyRow& r : result.rows) r.method = "march";
    result.rows[0].setting = "N=100";
    result.rows[1].setting = "N=1000";
    result.rows[1].failed = "it did not end";
    const std::string text = scene_accuracy_text(result, "s.toml");
    EXPECT_NE(text.find("failed: it did not end\n"), std::string::npos) << text;
    const auto rows = nlohmann::json::parse(scene_accuracy_json(result)).at("rows");
    EXPECT_FALSE(rows.at(0).contains("failed"));
    EXPECT_EQ(rows.at(1).at("failed"), "it did not end");
    EXPECT_FALSE(rows.at(1).contains("ns_min"));
}

// A ball that rolls straight: put aside by d it ends aside by d.
TEST(Gain, IsOneWithoutAnyContact) {
    Scene scene = empty_scene();
    add_ball(scene, "1", 0.0, 0.0, 1.0, 0.0, rolling_spin(1.0, 0.0, scene.balls.R));
    const Plan plan = plan_of(scene);
    EXPECT_NEAR(gain_of(plan, simulate(plan)), 1.0, 1e-3);
}

// A full hit turned by d: the object ball leaves at d / (2R), and runs s further.
TEST(Gain, OfAFullHitIsTheLeverOfTheLineOfCentres) {
    Scene scene = empty_scene();
    scene.balls.mu_b = 0.0;
    const double R = scene.balls.R;
    add_ball(scene, "1", 0.0, 0.0, 1.0, 0.0, rolling_spin(1.0, 0.0, R));
    add_ball(scene, "2", 0.5, 0.0);
    const Plan plan = plan_of(scene);
    const Record record = simulate(plan);
    const double run = final_positions(record)[1].x() - 0.5;
    const double gain = gain_of(plan, record);
    EXPECT_GT(gain, 0.8 * run / (2.0 * R));
    EXPECT_LT(gain, 1.2 * run / (2.0 * R));
}

TEST(Gain, OfASceneAtRestIsOne) {
    Scene scene = empty_scene();
    add_ball(scene, "1", 0.0, 0.0);
    const Plan plan = plan_of(scene);
    EXPECT_EQ(gain_of(plan, simulate(plan)), 1.0);
}

TEST(FinalError, IsTheFarthestBallAndTheMiddleOne) {
    const std::vector<Vec2> a = {{0, 0}, {1, 0}, {2, 0}}, b = {{0, 0}, {1, 3}, {2, 1}};
    EXPECT_DOUBLE_EQ(final_error(a, b).largest, 3.0);
    EXPECT_DOUBLE_EQ(final_error(a, b).median, 1.0);
    EXPECT_EQ(final_error({}, {}).largest, 0.0);
}

TEST(OutcomeOf, NamesContactsAndTheFirstBallHit) {
    Scene scene = empty_scene();
    add_ball(scene, "cue", 0.0, 0.0, 2.0, 0.0);
    add_ball(scene, "far", 0.8, 0.0);
    add_ball(scene, "near", 0.4, 0.0);
    const ShotContacts outcome = contacts_of(simulate(plan_of(scene)));
    EXPECT_EQ(outcome.first_contact, "near");
    ASSERT_GE(outcome.contacts.size(), 2u);
    EXPECT_EQ(outcome.contacts[0], "ball_ball cue near");
    EXPECT_EQ(outcome.pockets, (std::vector<int>{-1, -1, -1}));
}

Scene seeded_break(reference::Generator& rng, int seed) {
    char text[400];
    const double x = 0.635 + rng.uniform(-0.012, 0.012), speed = rng.uniform(5.0, 12.0);
    std::snprintf(text, sizeof text,
                  "[rack]\ngame = \"eight_ball\"\ngap = 1e-4\njitter = 3e-5\nseed = %d\n[[ball]]\nid = "
                  "\"cue\"\nposition = [%.17g, 0.5]\nvelocity = [0, %.17g]\n",
                  seed, x, speed);
    return parse_scene(text, "break.toml");
}

// The promise of the recommendation: the tolerance that follows from the gain meets 1 mm on at least 95 of
// every 100 breaks for which double precision allows it.
TEST(Recommendation, MeetsAMillimetreOnSeededBreaks) {
    constexpr double kTarget = 1e-3;
    reference::Generator rng(9);
    int allowed = 0, met = 0, unresolved = 0, looser = 0;
    for (int i = 0; i < 100; ++i) {
        const Scene scene = seeded_break(rng, i + 1);
        const Plan tight = with_tolerance(scene, kernel::kTightestTolerance);
        const Record truth = simulate(tight);
        const std::vector<Vec2> end = final_positions(truth);
        const double agreement =
            final_error(final_positions(simulate(with_power_series(scene))), end).largest;
        const auto tolerance = deserved_tolerance(gain_of(tight, truth), kTarget);
        if (!tolerance || agreement > 0.1 * kTarget) {
            ++unresolved;
            continue;
        }
        ++allowed;
        const auto error = [&](double t) {
            return final_error(final_positions(simulate(with_tolerance(scene, t))), end).largest;
        };
        met += error(*tolerance) <= kTarget ? 1 : 0;
        looser += error(1e-3) <= kTarget ? 1 : 0;
    }
    RecordProperty("allowed", allowed);
    RecordProperty("met", met);
    std::printf("allowed %d, met %d, unresolved %d; tolerance 1e-3 would have met %d\n", allowed, met,
                unresolved, looser);
    EXPECT_GE(allowed, 50);
    EXPECT_GE(20 * met, 19 * allowed);
    // A tolerance chosen without looking at the shot does not: the recommendation says something.
    EXPECT_LT(looser, met);
}

TEST(Box2d, ABallRollsAsFarAsRollingFrictionLetsIt) {
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
    EXPECT_LT(hit.positions[0].y(), 1.0);  // what is left to the cue ball is (1 - e) / 2 of its speed
    EXPECT_GT(hit.positions[1].y(), 1.0);
    EXPECT_LT(hit.positions[1].y(), scene.table.length);

    Scene pocketed = empty_scene();
    pocketed.table = make_table("nine_foot");
    const Vec2 corner = pocketed.table.pockets[0].center, start(0.3, 0.3), way = corner - start;
    add_ball(pocketed, "cue", start.x(), start.y(), 2.0 * way.x() / way.norm(), 2.0 * way.y() / way.norm());
    EXPECT_EQ(run_box2d(simulate(plan_of(pocketed)), 240.0).pockets[0], 0);
}

TEST(Box2d, NothingMovesWhereNothingMoves) {
    Scene scene = empty_scene();
    add_ball(scene, "1", 0.25, 0.5);
    const Box2dOutcome shot = run_box2d(simulate(plan_of(scene)), 60.0);
    EXPECT_EQ(shot.duration, 0.0);
    EXPECT_NEAR(shot.positions[0].x(), 0.25, 1e-7);
}

}  // namespace
}  // namespace carom::tools
