// Derivatives of shots against differences of whole shots, in every model, and the accuracy of margins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/plan.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"
#include "carom/engine/tangents.h"

#include "reference/random_impacts.h"
#include "support/hard_scenes.h"
#include "support/tangent_shots.h"

namespace carom {
namespace {

using namespace test;

const std::vector<std::string> kStroke{"cue.speed", "cue.aim_deg", "cue.offset.side", "cue.offset.height"};

void compare(Scene scene, const std::vector<std::string>& inputs, const std::string& what) {
    scene.physics.tolerance = 1e-12;
    const Shot shot(scene, inputs);
    for (std::size_t k = 0; k < inputs.size(); ++k) {
        const auto error = error_of(scene, shot, inputs[k], k);
        ASSERT_TRUE(error) << what << " " << inputs[k];
        EXPECT_LE(*error, 1e-8) << what << " " << inputs[k];
    }
}

TEST(Tangents, ScenesAgainstDifferences) {
    std::vector<std::string> inputs = kStroke;
    for (const char* key : {"balls.mu_s", "balls.mu_r", "table.pocket.p3.radius", "balls.e_b", "balls.radius",
                            "physics.gravity", "ball.cue.position.x", "ball.1.position.y"})
        inputs.push_back(key);
    compare(scene_of("draw"), inputs, "draw");
    std::vector<std::string> carom = kStroke;
    for (const char* key : {"balls.mu_s", "balls.mu_r", "balls.mu_sp", "balls.e_b", "table.cushion.c1.height",
                            "balls.e_c_fit.0", "balls.f_c_fit.0", "balls.radius", "physics.gravity",
                            "ball.white.position.x", "ball.red.position.y"})
        carom.push_back(key);
    Scene three = scene_of("three_cushion");
    three.cue->aim_deg = -7.0;  // the shipped shot barely touches a ball at its end
    compare(three, carom, "three_cushion");
}

// In the air every contact separates at some least speed, which then sets the restitution.
TEST(Tangents, PlasticBallsInTheAir) {
    Scene scene = empty_scene();
    scene.balls.e_b = 0.0;
    add_ball(scene, "a", Vec3(0.0, 0.0, 0.5), Vec3(2.0, 0.0, 0.0), Vec3(0.0, 0.0, 100.0));
    add_ball(scene, "b", Vec3(0.1, 0.01, 0.5));
    for (BallStart& ball : scene.ball) ball.height = 0.5 - scene.balls.R;
    scene.stop.time = 0.2;
    compare(scene, {"ball.a.position.y", "ball.b.position.x", "balls.radius"}, "plastic");
}

/// A stroke at one of two balls; some may fall.
Scene random_shot(std::uint64_t seed, const char* ball_ball, const char* cushion) {
    reference::Generator rng(seed);
    Scene scene;
    scene.table = make_table("seven_foot");
    use_balls(scene, "pool");
    scene.physics.ball_ball = ball_ball_model(ball_ball);
    scene.physics.cushion = cushion_model(cushion);
    scene.physics.tolerance = 1e-12;
    const double R = scene.balls.R;
    for (const char* id : {"cue", "1", "2"}) {
        BallStart ball;
        ball.id = id;
        ball.position = {rng.uniform(0.1, 0.9), rng.uniform(0.1, 1.9), R};
        scene.ball.push_back(ball);
    }
    const Vec3 to = scene.ball[1].position - scene.ball[0].position;
    scene.cue = Cue();
    scene.cue->speed = rng.uniform(0.7, 3.5);
    scene.cue->aim_deg = std::atan2(to.y(), to.x()) * 180.0 / 3.141592653589793 + rng.uniform(-3.0, 3.0);
    scene.cue->side = rng.uniform(-0.3, 0.3);
    scene.cue->height = rng.uniform(-0.3, 0.3);
    return scene;
}

struct Tally {
    int shots = 0, compared = 0, refused = 0;
    double worst = 0.0;
    std::string where;
};
/// Compares random shots until `wanted` of them keep their order of events.
template <class Change>
Tally compare_random(int wanted, const char* ball_ball, const char* cushion, Change change) {
    const std::vector<std::string> inputs{"cue.speed", "cue.aim_deg", "balls.e_c", "ball.1.position.x"};
    Tally tally;
    int seed = 0;
    for (; tally.shots < wanted && seed < 3 * wanted; ++seed) {
        Scene scene = random_shot(static_cast<std::uint64_t>(seed), ball_ball, cushion);
        change(scene);
        try {
            validate(scene);
        } catch (const SceneError&) {
            continue;  // balls overlap
        }
        try {
            const Shot shot(scene, inputs);
            const int before = tally.compared;
            for (std::size_t k = 0; k < inputs.size(); ++k) {
                const auto error = error_of(scene, shot, inputs[k], k);
                if (!error) continue;
                ++tally.compared;
                if (*error <= tally.worst) continue;
                tally.worst = *error;
                tally.where = std::to_string(seed) + " " + inputs[k];
            }
            tally.shots += tally.compared > before ? 1 : 0;
        } catch (const TangentError& error) {
            ++tally.refused;
            if (std::getenv("CAROM_RESIDUALS") != nullptr) std::printf("%d: %s\n", seed, error.what());
        }
    }
    if (std::getenv("CAROM_RESIDUALS") != nullptr)
        std::printf("%s %s: %d shots, %d columns compared, %d of %d refused, worst %g at %s\n", ball_ball,
                    cushion, tally.shots, tally.compared, tally.refused, seed, tally.worst,
                    tally.where.c_str());
    return tally;
}
template <class Change>
void expect_right(int wanted, const char* ball_ball, const char* cushion, Change change) {
    const Tally tally = compare_random(wanted, ball_ball, cushion, change);
    // The turning of the line of centres has a corner where friction stops the slip.
    EXPECT_LT(tally.worst, 2e-7) << ball_ball << " " << cushion << " " << tally.where;
    EXPECT_EQ(tally.shots, wanted) << ball_ball << " " << cushion;
    EXPECT_LE(tally.refused, wanted / 10) << ball_ball << " " << cushion;
}

void every_cushion(int wanted) {
    for (const char* cushion : {"han_2005", "mathavan_2010", "stronge", "impulse", "smooth"})
        expect_right(wanted, "mathavan", cushion, [](Scene&) {});
}
/// Every ball has its own radius and mass.
void unlike_balls(int wanted) {
    std::uint64_t draws = 1000;
    const auto change = [&draws](Scene& s) {
        reference::Generator rng(++draws);
        for (BallStart& ball : s.ball) {
            const double R = s.balls.R * rng.uniform(0.8, 1.25);
            ball.own = BallSize{R, s.balls.m * rng.uniform(0.5, 2.0)};
            ball.position.z() = R;
        }
    };
    for (const char* model : {"mathavan", "elastic"}) expect_right(wanted, model, "han_2005", change);
    expect_right(wanted, "mathavan", "mathavan_2010", change);
}
void every_pair_of_balls(int wanted) {
    for (const char* model : {"inelastic", "elastic", "two_step"})
        expect_right(wanted, model, "han_2005", [](Scene&) {});
}
void unlike_balls_fits_and_flights(int wanted) {
    expect_right(wanted, "mathavan", "han_2005", [](Scene& s) {
        s.ball[0].own = BallSize{s.balls.R, 1.1 * s.balls.m};
    });
    expect_right(wanted, "mathavan", "mathavan_2010", [](Scene& s) {
        s.balls.mu_b = 0.009951, s.balls.mu_b_more = 0.108, s.balls.mu_b_fall = 1.088;
        s.balls.f_c = 0.17, s.balls.f_c_more = 0.05, s.balls.f_c_fall = 0.4;
    });
    expect_right(wanted, "two_step", "han_2005", [](Scene& s) {
        s.cue->elevation_deg = 20.0;
        s.balls.e_h = 0.2;
    });
}

// Sanitizers are thirty times slower.
#ifdef CAROM_SANITIZED
constexpr int kMany = 100;
#else
constexpr int kMany = 500;
#endif
constexpr int kFew = 20;

TEST(Tangents, EveryCushion) {
    every_cushion(kFew);
}
TEST(Tangents, EveryPairOfBalls) {
    every_pair_of_balls(kFew);
}
TEST(Tangents, BallsOfAnySize) {
    unlike_balls(kFew);
}
TEST(Tangents, TwoHundredShotsOfBallsOfAnySize) {
    unlike_balls(200);
}
TEST(Tangents, UnlikeBallsFitsAndFlights) {
    unlike_balls_fits_and_flights(kFew);
}
TEST(Tangents, ManyOfEveryModel) {
    every_cushion(kMany);
    every_pair_of_balls(kMany);
    unlike_balls_fits_and_flights(kMany);
}

// A break multiplies small differences, so its derivatives are compared right after the first impact.
TEST(Tangents, Clusters) {
    std::vector<std::string> inputs = kStroke;
    inputs.insert(inputs.end(), {"balls.e_b", "balls.mu_b", "ball.cue.position.y"});
    int compared = 0, refused = 0;
    for (const double off : {0.3, 0.8, -0.5, -1.2}) {
        const Scene scene = combination(off);
        std::optional<Shot> played;
        try {
            played.emplace(scene, inputs);
        } catch (const TangentError&) {
            ++refused;
            continue;
        }
        const Shot& shot = *played;
        EXPECT_EQ(shot.record.clusters.size(), 1u);
        EXPECT_LT(shot.tangents.impact_error(), 1e-6);
        for (std::size_t k = 0; k < inputs.size(); ++k) {
            const auto error = error_of(scene, shot, inputs[k], k);
            compared += error ? 1 : 0;
            EXPECT_LT(error.value_or(0.0), 1e-8) << off << " " << inputs[k];
        }
    }
    EXPECT_GE(compared, 8);
    EXPECT_LE(refused, 1);
    Scene broken = scene_of("ten_ball_break");
    broken.stop.time = simulate(plan_of(broken)).events[1].time + 1e-3;
    const Shot shot(broken, kStroke);
    ASSERT_EQ(shot.record.clusters.size(), 1u);
    for (std::size_t k : {0u, 1u}) {
        // The differences use a cluster of any tolerance at which its result is smooth.
        double least = 1.0;
        for (const double tolerance : {1e-10, 1e-11}) {
            const double h = 1e-6;
            const SceneNumber number(broken, kStroke[k]);
            std::vector<Record> at;
            for (const double by : {-h, h}) {
                Scene moved = broken;
                number.put(moved, number.value(broken) + by);
                Plan plan = plan_of(moved);
                plan.cluster_tolerance = tolerance;
                at.push_back(simulate(plan));
            }
            double worst = 0.0, largest = 0.0;
            for (int ball = 0; ball < 11; ++ball) {
                const double end = shot.record.duration;
                const Vec3 by_differences =
                    (at[1].state_at(ball, end).velocity - at[0].state_at(ball, end).velocity) / (2.0 * h);
                worst = std::max(worst, (shot.tangents.at_end(ball, k).velocity - by_differences).norm());
                largest = std::max(largest, by_differences.norm());
            }
            least = std::min(least, worst / largest);
        }
        EXPECT_LT(least, 1e-5) << kStroke[k];
    }
}

/// Whether every ball has the same events in the same order.
bool same_shot(const Record& one, const Record& two) {
    const auto events_of = [](const Record& record, int ball) {
        std::vector<Event> list;
        for (Event e : record.events) {
            if (e.a != ball && !(kind(e.type).partner == Partner::kBall && e.b == ball)) continue;
            e.time = 0.0;
            list.push_back(e);
        }
        return list;
    };
    for (int ball = 0; ball < static_cast<int>(one.tracks.size()); ++ball)
        if (events_of(one, ball) != events_of(two, ball)) return false;
    return true;
}

Record moved(const Scene& scene, const char* key, double by) {
    const SceneNumber number(scene, key);
    Scene other = scene;
    number.put(other, number.value(scene) + by);
    return simulate(plan_of(other));
}

constexpr int kShots = 40;

// Margins are linear, shots are not: most shots survive nine tenths of a margin, and half have changed a
// tenth beyond it.
TEST(Tangents, Margins) {
    int all = 0, held = 0, changed = 0;
    for (int seed = 0; seed < kShots; ++seed) {
        const Scene scene = random_shot(static_cast<std::uint64_t>(seed), "mathavan", "han_2005");
        for (const char* key : {"cue.aim_deg", "cue.speed"}) {
            try {
                const Shot shot(scene, {key});
                const Margin margin = shot.tangents.margins()[0];
                for (const double way : {-margin.down, margin.up}) {
                    if (!(std::abs(way) < 0.3)) continue;
                    ++all;
                    held += same_shot(shot.record, moved(scene, key, 0.9 * way)) ? 1 : 0;
                    changed += same_shot(shot.record, moved(scene, key, 1.1 * way)) ? 0 : 1;
                }
            } catch (const TangentError&) {
                continue;
            }
        }
    }
    if (std::getenv("CAROM_RESIDUALS") != nullptr)
        std::printf("margins: %d, %d hold at 0.9, %d changed at 1.1\n", all, held, changed);
    EXPECT_GT(all, kShots);
    EXPECT_GT(held, 7 * all / 10);
    EXPECT_GT(changed, all / 2);
}

}  // namespace
}  // namespace carom
