// The search for a shot: it finds existing shots, its figures are unbiased, and threads change nothing.
#include "carom/games/solve.h"
#include "carom/games/break.h"
#include "carom/games/refine.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/engine_cases.h"
#include "support/scenes.h"

namespace carom::test {
namespace {

using games::Measure;
using games::Solution;
using games::SolveOptions;

SolveOptions small() {
    SolveOptions options;
    options.shots = 30000;
    options.best = 1;
    return options;
}

TEST(Solve, FindsAPotFromAnyDirection) {
    const Scene scene = shipped("draw");
    const Measure want("\"1\" in pocketed and not scratch", scene);
    SolveOptions options = small();
    options.choices = {{"cue.aim_deg", 0.0, 360.0}, {"cue.speed", 0.5, 6.0}};
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        options.seed = seed;
        const std::vector<Solution> found = games::solve(scene, want, kernel::best_isa(), options);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_GT(static_cast<double>(found[0].successes), 0.9 * static_cast<double>(found[0].shots));
        EXPECT_NEAR(found[0].values[0], 135.0, 2.0);
        // Without execution errors the shot achieves its goal.
        EXPECT_TRUE(want.holds(simulate(plan_of(found[0].scene))));
    }
}

TEST(Solve, SearchesTheSpeedOfTheBall) {
    const Scene scene = shipped("draw");
    const Measure want("\"1\" in pocketed and cue near (0.35, 2.19, 0.1)", scene);
    SolveOptions options = small();
    options.shots = 3000;
    options.choices = {{"cue.aim_deg", 134.0, 136.0}, {games::kBallSpeed, 1.0, 3.0}};
    const Solution found = games::solve(scene, want, kernel::best_isa(), options).at(0);
    const Record record = simulate(plan_of(found.scene));
    EXPECT_NEAR(length3(record.tracks[0].segments[1].v), found.values[1], 1e-9);
    const games::Exact exact = games::exact(found, want, kernel::best_isa(), options);
    EXPECT_EQ(exact.refined.trouble, "");
    EXPECT_EQ(exact.choices[1].key, "cue.speed");
}

TEST(Solve, FindsAThreeCushionPointAndAKickByItsRoute) {
    const Scene scene = shipped("three_cushion");
    SolveOptions options = small();
    options.choices = games::default_choices();
    const Measure point("point", scene, games::Game::kThreeCushion);
    const Solution found = games::solve(scene, point, kernel::best_isa(), options).at(0);
    EXPECT_GT(static_cast<double>(found.successes), 0.5 * static_cast<double>(found.shots));
    EXPECT_TRUE(Measure("point(three_cushion) and carom", scene).holds(simulate(plan_of(found.scene))));
    const Scene draw = shipped("draw");
    const Measure kick("cushions_before(1) == 2 and route == \"right, foot\"", draw);
    const Solution kicked = games::solve(draw, kick, kernel::best_isa(), options).at(0);
    EXPECT_GT(static_cast<double>(kicked.successes), 0.5 * static_cast<double>(kicked.shots));
}

TEST(Solve, HitAimsAtItsBall) {
    const Scene scene = shipped("draw");
    SolveOptions options = small();
    options.shots = 3000;
    options.choices = {{"hit.1", 0.0, 0.0}, {"cue.speed", 2.0, 2.0}};
    options.hand = {0.0, 0.0, 0.0, 0.0};
    const Solution full =
        games::solve(scene, Measure("first_hit == \"1\"", scene), kernel::best_isa(), options).at(0);
    EXPECT_NEAR(full.scene.cue->aim_deg, 135.0, 1e-6);
    EXPECT_EQ(full.successes, full.shots);
    for (const double hit : {0.99, -0.99, 1.01, -1.01}) {
        options.choices[0] = {"hit.1", hit, hit};
        const Solution edge =
            games::solve(scene, Measure("first_hit == \"1\"", scene), kernel::best_isa(), options).at(0);
        EXPECT_EQ(edge.successes > 0, std::abs(hit) < 1.0) << hit;
    }
}

// Without execution errors the ball is hit at any speed, if the aim passes less than its edge away.
TEST(Solve, AMapShowsTheDecisiveInput) {
    const Scene scene = parse_scene(
        "[table]\ncushion = []\n[[ball]]\n[[ball]]\nid = \"1\"\nposition = [0.635, 1.5]\n[cue]\nspeed = 2\n",
        "open.toml");
    const Measure want("first_hit == \"1\"", scene);
    SolveOptions options = small();
    options.shots = 1000;
    options.choices = {{"cue.offset.height", -0.2, 0.2}, {"cue.speed", 2.0, 3.0}, {"hit.1", -3.0, 3.0}};
    options.hand = {0.0, 0.0, 0.0, 0.0};
    Solution around;
    around.values = {0.0, 2.5, 0.0};
    const games::SuccessMap map = games::success_map(scene, want, kernel::best_isa(), options, around);
    EXPECT_EQ(map.choices, (std::array<std::size_t, 2>{2, 0}));
    ASSERT_EQ(map.cells.size(), 24u * 24u);
    for (const auto& cell : map.cells) {
        EXPECT_EQ(cell.success, std::abs(cell.place[0]) < 1.0 ? 1.0 : 0.0) << cell.place[0];
        EXPECT_LE(std::abs(cell.place[1]), 0.2);
    }
    EXPECT_NEAR(map.cells.back().place[0], 3.0 - 0.125, 1e-12);
    options.choices.resize(1);
    EXPECT_THROW(games::success_map(scene, want, kernel::best_isa(), options, around), std::invalid_argument);
}

// Each layout includes its balls' sizes: otherwise most layouts would overlap.
TEST(Solve, LayoutsOfUnlikeBalls) {
    games::BreakOptions wanted;
    wanted.radius_sd = 1e-4;
    const games::BreakSearch asked = games::break_search(wanted);
    SolveOptions options = small();
    options.shots = 3000;
    options.choices = {{"hit.1", 0.0, 0.0}, {"cue.speed", 2.0, 2.0}};
    options.hand = {0.0, 0.0, 0.0, 0.0};
    options.layouts = asked.layouts;
    const Measure want("first_hit == \"1\"", asked.scene);
    const Solution full = games::solve(asked.scene, want, kernel::best_isa(), options).at(0);
    EXPECT_EQ(full.successes, full.shots);
}

TEST(Solve, ThreadsAndTheOrderOfPlayChangeNothing) {
    const Scene scene = shipped("side_bank");
    const Measure want("\"1\" in pocketed", scene);
    SolveOptions options = small();
    options.best = 3;
    options.choices = {{"cue.aim_deg", 50.0, 54.0}, {"cue.speed", 1.0, 4.0}};
    options.threads = 1;
    const std::vector<Solution> one = games::solve(scene, want, kernel::best_isa(), options);
    options.threads = 2;
    const std::vector<Solution> two = games::solve(scene, want, kernel::best_isa(), options);
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].values, two[i].values);
        EXPECT_EQ(one[i].successes, two[i].successes);
    }
}

TEST(Solve, TheFiguresComeFromShotsUnseenBySearch) {
    // A coin: no input matters, so the best success rate is one half, however many candidates were tried.
    const Scene scene = shipped("draw");
    const Measure want("x(cue) > 0.748", scene);
    SolveOptions options = small();
    options.choices = {{"cue.speed", 2.24, 2.26}};
    options.hand = {0.5, 0.2, 0.05, 0.0};
    const Solution found = games::solve(scene, want, kernel::best_isa(), options).at(0);
    const double share = static_cast<double>(found.successes) / static_cast<double>(found.shots);
    // The same shots again with other errors.
    options.seed = 99;
    options.choices = {{"cue.speed", found.values[0], found.values[0]}};
    const Solution again = games::solve(scene, want, kernel::best_isa(), options).at(0);
    EXPECT_GT(share, 0.2);
    EXPECT_LT(share, 0.8);
    EXPECT_NEAR(share, static_cast<double>(again.successes) / static_cast<double>(again.shots), 0.05);
}

TEST(Solve, MistakesAreRefused) {
    const Scene scene = shipped("draw");
    const Measure want("scratch", scene);
    const auto refused = [&](std::vector<games::Choice> choices) {
        SolveOptions options = small();
        options.choices = std::move(choices);
        EXPECT_THROW(games::solve(scene, want, kernel::best_isa(), options), std::invalid_argument);
    };
    refused({});
    refused({{"cue.sped", 0.0, 1.0}});
    refused({{"hit.7", 0.0, 1.0}});
    refused({{"cue.speed", 2.0, 1.0}});
    refused({{"cue.speed", 0.0, HUGE_VAL}});
}

}  // namespace
}  // namespace carom::test
