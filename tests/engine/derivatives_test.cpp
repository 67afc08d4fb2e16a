// Derivatives of shots: in closed form, against differences of higher order, and refusals.
// CAROM_RESIDUALS=1 prints the figures of lab/notes/2026-11-derivatives_by_differences.md.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/derivatives.h"
#include "carom/engine/plan.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"

#include "reference/random_impacts.h"
#include "support/drawn_breaks.h"
#include "support/hard_scenes.h"

namespace carom {
namespace {

using namespace test;

#ifdef CAROM_SANITIZED
constexpr int kShots = 8, kRacks = 1, kOfEach = 4;
#else
constexpr int kShots = 200, kRacks = 20, kOfEach = 12;
#endif
constexpr double kEnd = std::numeric_limits<double>::infinity();
const std::vector<std::string> kStroke{"cue.speed", "cue.aim_deg", "cue.offset.side", "cue.offset.height"};

Scene scene_of(const std::string& name) {
    return read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/" + name + ".toml");
}

/// A shot, and its derivatives at the end and of all its events.
struct Shot {
    Shot(const Scene& scene, const std::vector<std::string>& inputs, double time = kEnd)
        : plan(plan_of(scene)),
          record(simulate(plan)),
          by(plan, record, inputs, {time}, all_events(record)) {}
    static std::vector<std::size_t> all_events(const Record& record) {
        std::vector<std::size_t> list;
        for (std::size_t e = 0; e < record.events.size(); ++e)
            if (record.events[e].type != EventType::kBallOut) list.push_back(e);
        return list;
    }
    Vec3 end(int ball, std::size_t input) const { return by.state(0, ball, input).position; }
    Plan plan;
    Record record;
    Derivatives by;
};

// A ball that slides, then rolls to rest: d = (12/49) v^2 / (mu_s g) + (25/49) v^2 / (2 mu_r g).
TEST(Derivatives, SlideAndRoll) {
    Scene scene = empty_scene();
    scene.balls.mu_s = 0.2;
    scene.balls.mu_r = 0.01;
    add_ball(scene, "1", {0.0, 0.0, scene.balls.R}, {1.5, 0.0, 0.0});
    const std::vector<std::string> inputs{"ball.1.velocity.x", "balls.mu_s", "balls.mu_r", "physics.gravity",
                                          "ball.1.position.y"};
    const Shot shot(scene, inputs);
    const double g = scene.physics.gravity, v = 1.5;
    const double slide = 12.0 / 49.0 * v * v / (0.2 * g), roll = 25.0 / 98.0 * v * v / (0.01 * g);
    const double expected[] = {2.0 * (slide + roll) / v, -slide / 0.2, -roll / 0.01, -(slide + roll) / g,
                               0.0};
    for (std::size_t k = 0; k < inputs.size(); ++k) {
        EXPECT_NEAR(shot.end(0, k).x(), expected[k], 1e-8 * (1.0 + std::abs(expected[k]))) << inputs[k];
        EXPECT_LT(shot.by.error(k), 1e-8) << inputs[k];
    }
    EXPECT_NEAR(shot.end(0, 4).y(), 1.0, 1e-8);
    // Sliding ends at 2 v / (7 mu_s g), and rolling 5 v / (7 mu_r g) later.
    EXPECT_NEAR(shot.by.event_time(0, 0), 2.0 / (7.0 * 0.2 * g), 1e-8);
    EXPECT_NEAR(shot.by.event_time(1, 0), 2.0 / (7.0 * 0.2 * g) + 5.0 / (7.0 * 0.01 * g), 1e-8);
}

/// Nimble's issue 97: ball 1 meets ball 2 at rest, without friction.
Scene nimble(double aside, double e_b) {
    Scene scene = frictionless();
    scene.physics.ball_ball = ball_ball_model("inelastic");
    scene.physics.clusters = ClusterModel::kSequential;
    scene.balls.R = 0.1;
    scene.balls.e_b = e_b;
    add_ball(scene, "1", {0.0, 0.0, 0.1}, {1.0, 0.0, 0.0});
    add_ball(scene, "2", {0.52, aside, 0.1});
    scene.stop.time = 1.0;
    return scene;
}

TEST(Derivatives, OfAPair) {
    for (const auto& [aside, e_b] : {std::pair{0.0, 1.0}, {0.05, 1.0}, {0.05, 0.8}}) {
        const Shot shot(nimble(aside, e_b), {"ball.1.position.x", "ball.2.position.x"});
        // Both balls are carried by the share of the speed that the impact passes on along x.
        const double cosine = 1.0 - aside * aside / 0.04, passed = 0.5 * (1.0 + e_b) * cosine;
        for (const int ball : {0, 1})
            for (const std::size_t by : {0u, 1u}) {
                const double own = ball == 0 ? 1.0 - passed : passed;
                EXPECT_NEAR(shot.end(ball, by).x(), by == 0u ? own : 1.0 - own, 1e-8) << aside << " " << e_b;
                EXPECT_NEAR(std::abs(shot.end(ball, by).y()),
                            0.5 * (1.0 + e_b) * aside / 0.2 * std::sqrt(cosine), 1e-8);
            }
    }
    // v_x of ball 1 is sin^2 of the angle of the line of centres, whose sine is y / 0.2.
    for (const double thin : {1e-2, 1e-4, 1e-6})
        EXPECT_NEAR(
            std::abs(Shot(nimble(0.2 - thin, 1.0), {"ball.2.position.y"}).by.state(0, 0, 0).velocity.x()),
            2.0 * (0.2 - thin) / 0.04, 1e-5)
            << thin;
}

TEST(Derivatives, OfAWall) {
    Scene scene = frictionless();
    scene.table = box(1.0, 1.0, 0.03);
    scene.physics.cushion = cushion_model("smooth");
    scene.balls.e_c = 0.8;
    add_ball(scene, "1", {0.2, 0.5, scene.balls.R}, {1.0, 0.3, 0.0});
    scene.stop.time = 1.0;
    const Shot shot(scene, {"ball.1.velocity.x", "balls.e_c", "ball.1.position.x"});
    const Event* hit = first(shot.record, EventType::kBallCushion);
    ASSERT_NE(hit, nullptr);
    const auto at = static_cast<std::size_t>(hit - shot.record.events.data());
    // It hits after t at v = 1, then runs back for 1 - t at e v.
    const double t = hit->time, way[] = {t + 0.8 * t - 0.8, -(1.0 - t), -0.8};
    const double when[] = {-t, 0.0, -1.0};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(shot.end(0, k).x(), k == 0 ? 0.8 * -1.0 : way[k], 1e-8) << k;
        EXPECT_NEAR(shot.by.event_time(at, k), when[k], 1e-8) << k;
    }
    EXPECT_NEAR(shot.by.event_place(at, 0).y(), 0.3 * when[0], 1e-8);
}

/// The derivatives of the final places by one input, from six-point differences at the step that agrees best
/// with the next larger and smaller ones, and how well they agree. Two steps may agree by chance.
struct Reference {
    std::vector<Vec2> slopes;
    double apart = kEnd;
};
double largest(const std::vector<Vec2>& list) {
    double most = 0.0;
    for (const Vec2& v : list) most = std::max(most, v.norm());
    return most;
}
double apart(const std::vector<Vec2>& one, const std::vector<Vec2>& two) {
    double most = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i) most = std::max(most, (one[i] - two[i]).norm());
    return most / std::max(1e-6, largest(two));
}
Reference reference(Scene scene, const std::string& key, double longest) {
    scene.physics.tolerance = 1e-12;
    const SceneNumber number(scene, key);
    const double value = number.value(scene);
    Reference best;
    std::vector<Vec2> last;
    double last_apart = kEnd;
    RunBuffers buffers;
    Planner planner(scene, kernel::best_isa());
    for (double h = longest; h > 1e-4 * longest; h /= 2.5) {
        std::vector<Vec2> now(scene.ball.size(), Vec2::Zero());
        for (const auto& [steps, weight] : {std::pair{3.0, 1.0}, {2.0, -9.0}, {1.0, 45.0}})
            for (const double side : {-1.0, 1.0}) {
                number.put(planner.scene(), value + side * steps * h);
                Outcome outcome;
                simulate(planner.plan(), buffers, outcome);
                for (std::size_t i = 0; i < now.size(); ++i)
                    now[i] += side * weight * planar(outcome.balls[i].position) / (60.0 * h);
            }
        if (!last.empty()) {
            const double agrees = apart(now, last);
            if (std::max(agrees, last_apart) < best.apart) best = {last, std::max(agrees, last_apart)};
            last_apart = agrees;
        }
        last = std::move(now);
    }
    return best;
}

std::vector<Vec2> ends(const Derivatives& by, const Scene& scene, std::size_t input) {
    std::vector<Vec2> slopes;
    for (int ball = 0; ball < static_cast<int>(scene.ball.size()); ++ball)
        slopes.push_back(planar(by.state(0, ball, input).position));
    return slopes;
}

/// Relative errors of columns, their estimates, and the shots that they took.
struct Tally {
    std::vector<double> errors, ratios, shots;
    int columns = 0, refused = 0, whole = 0;

    /// @param known  compare only if the reference is known this well
    /// @param most  compare the first of the columns only
    void add(const Scene& scene, const std::vector<std::string>& inputs, double longest, double known,
             std::size_t most = 4) {
        const Plan plan = plan_of(scene);
        const Record record = simulate(plan);
        const Derivatives by(plan, record, inputs, {kEnd});
        shots.push_back(by.shots());
        bool all = true;
        for (std::size_t k = 0; k < inputs.size(); ++k) {
            ++columns;
            if (by.refusal(k).empty() && k >= most) continue;
            if (!by.refusal(k).empty()) {
                ++refused, all = false;
                continue;
            }
            const Reference truth = reference(scene, inputs[k], longest);
            if (!(truth.apart < known)) continue;
            errors.push_back(apart(ends(by, scene, k), truth.slopes));
            // The reference errs, too.
            ratios.push_back(std::max(0.0, errors.back() - truth.apart) / by.error(k));
        }
        whole += all ? 1 : 0;
    }
    double mean_shots() const {
        return std::accumulate(shots.begin(), shots.end(), 0.0) / static_cast<double>(shots.size());
    }
    void print(const std::string& what) const {
        report(fmt::format("{}: {} columns, {} compared, refused", what, columns, errors.size()).c_str(),
               refused);
        for (const double share : {0.5, 0.9, 0.99, 1.0})
            report(fmt::format("{}: error, share {}", what, share).c_str(), share_of(errors, share));
        report((what + ": error over estimate, 99 %").c_str(), share_of(ratios, 0.99));
        report(fmt::format("{}: at most {} shots, mean", what, share_of(shots, 1.0)).c_str(), mean_shots());
    }
};

/// A stroke at one of some balls; some may fall.
Scene random_shot(std::uint64_t seed, int balls) {
    reference::Generator rng(seed);
    Scene scene;
    scene.table = make_table("seven_foot");
    use_balls(scene, "pool");
    const double R = scene.balls.R;
    for (int i = 0; i < balls; ++i) {
        BallStart ball;
        ball.id = i == 0 ? "cue" : std::to_string(i);
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

template <class Change>
Tally many(int shots, int balls, double known, const std::vector<std::string>& inputs, Change change) {
    Tally tally;
    for (std::uint64_t seed = 0; static_cast<int>(tally.shots.size()) < shots; ++seed) {
        Scene scene = random_shot(seed, balls);
        change(scene);
        try {
            validate(scene);
        } catch (const SceneError&) {
            continue;  // balls overlap
        }
        tally.add(scene, inputs, 1e-3, known);
    }
    return tally;
}

TEST(Derivatives, TwoAndFiveBalls) {
    for (const auto& [balls, most] : {std::pair{2, 1e-5}, {5, 1e-4}}) {
        const Tally tally = many(kShots, balls, 1e-6, kStroke, [](Scene&) {});
        tally.print(fmt::format("{} balls", balls));
        EXPECT_EQ(tally.refused, 0);
        EXPECT_GE(tally.errors.size(), static_cast<std::size_t>(9 * tally.columns / 10));
        EXPECT_LT(share_of(tally.errors, 0.5), 1e-8);
        EXPECT_LT(share_of(tally.errors, 0.99), most);
        EXPECT_LT(share_of(tally.ratios, 0.99), 3.0);
        EXPECT_LE(tally.mean_shots(), balls == 2 ? 20.0 : 30.0);
    }
}

TEST(Derivatives, NineBallBreaks) {
    Tally tally;
    reference::Generator rng(81);
    for (int k = 0; k < kRacks; ++k) tally.add(drawn_break("nine_ball", rng), kStroke, 3e-6, 1e-3, 2);
    tally.print("nine-ball breaks");
    report("nine-ball breaks: with all columns", tally.whole);
    EXPECT_GE(20 * tally.whole, 17 * kRacks);
    EXPECT_LT(share_of(tally.errors, 0.9), 1e-3);
    EXPECT_LE(tally.mean_shots(), 60.0);
}

// Every model of impacts, unlike balls, fits and flights.
TEST(Derivatives, EveryModel) {
    const std::vector<std::string> inputs{"cue.speed", "balls.e_c", "ball.1.position.x"};
    const auto compare = [&](const std::string& what, const std::function<void(Scene&)>& change) {
        const Tally tally = many(kOfEach, 3, 1e-7, inputs, change);
        tally.print(what);
        EXPECT_GE(4 * tally.errors.size(), 3 * static_cast<std::size_t>(tally.columns)) << what;
        EXPECT_LT(share_of(tally.errors, 1.0), 1e-5) << what;
    };
    for (const char* cushion : {"mathavan_2010", "stronge", "impulse", "smooth"})
        compare(cushion, [&](Scene& s) { s.physics.cushion = cushion_model(cushion); });
    for (const char* model : {"inelastic", "elastic", "two_step"})
        compare(model, [&](Scene& s) { s.physics.ball_ball = ball_ball_model(model); });
    compare("unlike balls", [&](Scene& s) {
        for (BallStart& ball : s.ball) {
            const double share = 0.8 + 0.3 * ball.position.x();
            ball.own = BallSize{share * s.balls.R, share * share * s.balls.m};
            ball.position.z() = ball.own->R;
        }
    });
    compare("fits", [](Scene& s) {
        s.balls.mu_b = 0.009951, s.balls.mu_b_more = 0.108, s.balls.mu_b_fall = 1.088;
        s.balls.f_c = 0.17, s.balls.f_c_more = 0.05, s.balls.f_c_fall = 0.4;
    });
    compare("a raised cue", [](Scene& s) {
        s.physics.ball_ball = ball_ball_model("two_step");
        s.cue->elevation_deg = 20.0;
        s.balls.e_h = 0.2;
    });
}

// Scenes that the replay on dual numbers refused: resting contacts, pucks, unlike discs, a corner, clusters
// in space, the published integration.
TEST(Derivatives, WhereTheyWereRefused) {
    const auto compare = [](const std::string& what, Scene scene, const std::vector<std::string>& inputs) {
        const Plan plan = plan_of(scene);
        const Derivatives by(plan, simulate(plan), inputs, {kEnd});
        for (std::size_t k = 0; k < inputs.size(); ++k) {
            EXPECT_EQ(by.refusal(k), "") << what;
            const Reference truth = reference(scene, inputs[k], 1e-4);
            EXPECT_LT(truth.apart, 1e-4) << what;
            const double error = apart(ends(by, scene, k), truth.slopes);
            report((what + " " + inputs[k]).c_str(), error);
            EXPECT_LT(error, 1e-4) << what << " " << inputs[k];
        }
    };
    compare("resting balls", scene_of("snooker_break"), {"cue.speed", "cue.aim_deg"});
    // Its spin drives it further into the cushion.
    compare("pressed on a rail",
            parse_scene("[table]\npreset = \"nine_foot\"\n[[ball]]\nid = \"1\"\nposition = [0.028576, 0.5]\n"
                        "velocity = [-1e-4, 0.1]\nspin = [0, -40, 0]\n",
                        "s.toml"),
            {"ball.1.velocity.y", "ball.1.spin.y"});
    Scene discs = empty_scene();
    discs.balls.disc = true;
    add_ball(discs, "1", 0.0, 0.0, 1.0, 0.0);
    add_ball(discs, "2", 0.5, 0.02);
    discs.ball.back().own = BallSize{0.04, discs.balls.m};
    discs.ball.back().position.z() = 0.04;
    discs.physics.ball_ball = ball_ball_model("elastic");
    discs.balls.mu_b = 0.0;
    compare("unlike discs", discs, {"ball.1.velocity.x", "ball.1.position.y"});
    discs.ball.back().own.reset();
    discs.ball.back().position.z() = discs.balls.R;
    discs.balls.slides = true;
    compare("pucks", discs, {"ball.1.velocity.x", "ball.1.position.y"});
    Scene corner = frictionless();
    corner.table = box(1.0, 1.0, 0.03);
    corner.physics.cushion = cushion_model("smooth");
    add_ball(corner, "1", {0.5, 0.5, corner.balls.R}, {1.0, 1.0, 0.0});
    corner.stop.time = 0.7;
    compare("a corner", corner, {"ball.1.velocity.x", "ball.1.position.y"});
    Scene raised = scene_of("nine_ball_break");
    raised.cue->aim_deg = 81.0;
    raised.cue->elevation_deg = 5.0;
    compare("a cluster in space", raised, {"cue.speed"});
    Scene march = scene_of("draw");
    march.physics.substeps = 1000;
    EXPECT_EQ(Shot(march, {"cue.speed"}).by.refusal(0), "");
}

// The ball rolls from the stroke on: with side it slides first, so the derivatives of both sides differ.
TEST(Derivatives, AtACorner) {
    const Plan plan = plan_of(scene_of("follow"));
    const Derivatives end(plan, simulate(plan), {"cue.offset.side", "cue.speed"}, {kEnd});
    EXPECT_EQ(end.refusal(0, kRoughDerivativeError), "");
    EXPECT_NEAR(end.error(0), 0.0055 / 0.262 * 0.3, 1e-3);
    EXPECT_LT(end.error(1), kMostDerivativeError);
}

// A stop ends a shot at a time, or at an event whose time does not move.
TEST(Derivatives, OfShotsThatAreStopped) {
    Scene scene = scene_of("draw");
    const Record whole = simulate(plan_of(scene));
    const double time = whole.events[3].time;
    scene.stop.events = 4;
    const Shot by_events(scene, kStroke);
    scene.stop.events.reset();
    scene.stop.time = time;
    const Shot by_time(scene, kStroke);
    scene.stop.time.reset();
    const Plan plan = plan_of(scene);
    const Derivatives within(plan, whole, kStroke, {5.0, time, 0.0});
    for (std::size_t k = 0; k < kStroke.size(); ++k) {
        EXPECT_NEAR((by_events.end(0, k) - by_time.end(0, k)).norm(), 0.0, 1e-4);
        EXPECT_NEAR((within.state(1, 0, k).position - by_time.end(0, k)).norm(), 0.0, 1e-4);
        EXPECT_EQ(within.state(2, 1, k).position.norm(), 0.0) << "before it is hit";
        EXPECT_EQ(within.state(0, 1, k).position.norm(), 0.0) << "it has fallen";
    }
}

// Only a column in which events begin or end at once is refused: a ball that just touches another one.
TEST(Derivatives, RefuseOnlyTheColumnThatJumps) {
    Scene scene = frictionless();
    scene.physics.ball_ball = ball_ball_model("elastic");
    const double R = scene.balls.R;
    add_ball(scene, "1", {0.0, 0.0, R}, {1.0, 0.0, 0.0});
    add_ball(scene, "2", {0.5, 2.0 * R, R});
    scene.stop.time = 1.0;
    const Shot shot(scene, {"ball.1.velocity.x", "ball.1.position.y", "ball.1.position.x"});
    EXPECT_EQ(shot.by.refusal(0), "");
    EXPECT_NE(shot.by.refusal(1).find("ball.1.position.y has no derivative here: an event begins or ends "
                                      "within the smallest step (estimated error "),
              std::string::npos)
        << shot.by.refusal(1);
    EXPECT_EQ(shot.by.refusal(2), "");
    EXPECT_THROW(shot.by.check(), DerivativeError);
    // A ball at a rail cannot be moved into it.
    scene.table = box(1.0, 1.0, 0.03);
    scene.ball[0].position = {0.3, 0.3, R};
    scene.ball[1].position = {R, 0.5, R};
    const Shot rail(scene, {"ball.2.position.x", "ball.1.velocity.x"});
    EXPECT_NE(rail.by.refusal(0).find("ball.2.position.x has no derivative here: "), std::string::npos);
    EXPECT_EQ(rail.by.refusal(1), "");
}

TEST(Derivatives, BadInputsAreNamed) {
    const auto why_not = [](const Scene& scene, const std::string& input) -> std::string {
        try {
            Shot(scene, {input});
        } catch (const std::exception& error) {
            return error.what();
        }
        return "";
    };
    const Scene draw = scene_of("draw");
    Scene fit = draw;
    fit.balls.mu_b = 0.009951, fit.balls.mu_b_more = 0.108, fit.balls.mu_b_fall = 1.088;
    EXPECT_EQ(why_not(fit, "balls.mu_b").substr(0, 12), "balls.mu_b: ");
    EXPECT_EQ(why_not(fit, "balls.mu_b_fit.0"), "");
    Scene elastic = draw;
    elastic.balls.e_b = 1.0;
    EXPECT_EQ(why_not(elastic, "balls.e_b"),
              "balls.e_b = 1 is at the end of its range, where it has no derivative; move it inwards");
    EXPECT_EQ(why_not(draw, "stop.events"), "stop.events is not a real number that the scene sets");
    EXPECT_THROW(Shot(draw, {"cue.spede"}), std::invalid_argument);
    EXPECT_THROW(Shot(draw, {"table.size.0"}), std::invalid_argument);
    // A record from a file may belong to another scene.
    Scene more = draw;
    add_ball(more, "3", {0.3, 0.3, more.balls.R});
    EXPECT_THROW(Derivatives(plan_of(more), simulate(plan_of(draw)), {"cue.speed"}, {kEnd}),
                 std::invalid_argument);
}

}  // namespace
}  // namespace carom
