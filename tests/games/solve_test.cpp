// The search for a shot: it finds existing shots, its figures are unbiased, and threads change nothing.
#include "carom/games/solve.h"
#include "carom/games/break.h"
#include "carom/games/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/engine_cases.h"
#include "support/scenes.h"
#include "unknown.h"

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
    const Measure point("point", scene, &games::kThreeCushion);
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
    options.racks = asked.racks;
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

// Six seeds of find.md's command; before, they found 0.31 to 0.81 of exact tables.
TEST(Solve, SixSeedsFindTheSame) {
    const Scene scene = shipped("three_cushion");
    const Measure want("point", scene, &games::kThreeCushion);
    SolveOptions options = small();
    options.shots = 40000;
    options.choices = games::default_choices();
    double worst = 1.0, best = 0.0;
    for (options.seed = 1; options.seed <= 6; ++options.seed) {
        std::size_t played = 0;
        options.progress = [&](std::size_t done) { played = std::max(played, done); };
        std::vector<double> starts;
        const Solution found = games::solve(scene, want, kernel::best_isa(), options, &starts).at(0);
        const double rate = games::share_of(found.successes, found.shots).value;
        worst = std::min(worst, rate), best = std::max(best, rate);
        EXPECT_EQ(starts.size(), 2u);
        for (const double start : starts) EXPECT_GT(start, 0.0);
        EXPECT_LE(played, options.shots);
    }
    EXPECT_LE(best - worst, 0.06);
    EXPECT_GT(worst, 0.75);
}

TEST(Solve, TablesAreDrawnAndExactOnesBeside) {
    const Scene scene = shipped("three_cushion");
    const Measure want("point", scene, &games::kThreeCushion);
    SolveOptions options = small();
    options.shots = 10000;
    options.hand = {0.0, 0.0, 0.0, 0.0};
    // Without errors of a hand, an exact table has one result.
    options.choices = {{"cue.speed", scene.cue->speed, scene.cue->speed}};
    const Solution drawn = games::solve(scene, want, kernel::best_isa(), options).at(0);
    EXPECT_GT(drawn.successes, 0u);
    EXPECT_LT(drawn.successes, drawn.shots);
    EXPECT_EQ(drawn.exact, drawn.shots);
    options.unknown = games::kExactTable;
    const Solution exact = games::solve(scene, want, kernel::best_isa(), options).at(0);
    EXPECT_EQ(exact.successes, exact.shots);
    EXPECT_EQ(exact.exact, exact.successes);
}

TEST(Solve, DrawnTablesHaveTheirDeviations) {
    games::BreakOptions wanted;
    wanted.game = "eight_ball";
    const games::BreakSearch asked = games::break_search(wanted);
    const games::Unknown sd;
    std::vector<double> gaps, cloth, rails, places;
    for (std::uint64_t i = 0; i < 300; ++i) {
        const Scene rack = asked.racks(i), drawn = games::detail::drawn_table(rack, sd, 1, i);
        EXPECT_NO_THROW(validate(drawn));
        cloth.push_back(drawn.balls.mu_s / rack.balls.mu_s);
        rails.push_back(drawn.balls.e_c / rack.balls.e_c);
        places.push_back(drawn.ball[0].position.x() - rack.ball[0].position.x());
        for (std::size_t a = 1; a < rack.ball.size(); ++a)
            for (std::size_t b = a + 1; b < rack.ball.size(); ++b) {
                const auto gap = [&](const Scene& s) {
                    return planar(s.ball[a].position - s.ball[b].position).norm() - 2.0 * s.balls.R;
                };
                if (gap(rack) < 1e-4) gaps.push_back(gap(drawn));
            }
    }
    const auto deviation = [](const std::vector<double>& values) {
        double sum = 0.0, squares = 0.0;
        for (const double v : values) sum += v, squares += v * v;
        const auto n = static_cast<double>(values.size());
        return std::sqrt(squares / n - sum * sum / (n * n));
    };
    EXPECT_NEAR(deviation(gaps), sd.gaps, 0.15 * sd.gaps);
    EXPECT_GE(*std::min_element(gaps.begin(), gaps.end()), -1e-15);
    EXPECT_NEAR(deviation(cloth), sd.cloth, 0.15 * sd.cloth);
    EXPECT_NEAR(deviation(rails), sd.rails, 0.15 * sd.rails);
    EXPECT_NEAR(deviation(places), sd.places, 0.15 * sd.places);
}

// A ball frozen to a cushion, and a restitution of 1, have draws on one side only.
TEST(Solve, DrawnTablesAreValid) {
    const Scene scene = parse_scene(
        "[table]\npreset = \"snooker\"\n[balls]\npreset = \"snooker\"\n[[ball]]\nposition = [0.02625, 1.5]\n"
        "[[ball]]\nid = \"1\"\nposition = [0.5, 1.5]\n[cue]\nspeed = 2\n",
        "frozen.toml");
    int moved = 0;
    for (std::uint64_t i = 0; i < 100; ++i) {
        const Scene drawn = games::detail::drawn_table(scene, {}, 3, i);
        EXPECT_NO_THROW(validate(drawn));
        EXPECT_LE(drawn.balls.e_c, 1.0);
        moved += drawn.ball[0].position != scene.ball[0].position ? 1 : 0;
    }
    EXPECT_GT(moved, 90);
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
