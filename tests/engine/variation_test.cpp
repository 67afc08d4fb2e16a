// Many scenes from one file: keys, distributions, and a shot's independence of all else.
#include "carom/engine/variation.h"
#include "carom/engine/cushion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/draws.h"
#include "scene/distribution.h"
#include "support/process.h"
#include "support/scenes.h"

namespace carom::test {
namespace {

class VariationTest : public testing::Test {
  protected:
    /// A key's value in a shot, as tables write it.
    static std::string drawn(const VariedShot& shot, std::size_t key) { return text_of(shot.values[key]); }
    Variation vary(const std::vector<std::string>& rules, std::uint64_t seed = 1) {
        return Variation(folder_.write("s.toml", text_), rules, seed);
    }
    /// The message of a rule that must fail.
    std::string error_of(const std::string& rule) {
        try {
            vary({rule});
        } catch (const VariationError& error) {
            return error.what();
        }
        return "";
    }
    TemporaryFolder folder_;
    std::string text_ = kSmallScene;
};

TEST_F(VariationTest, TheBallsSpeedVariesBesideTheAim) {
    const std::string ball = "[[ball]]\nposition = [0.6, 1.0]\n[cue]\naim_deg = 90\noffset = [0, 0]\n";
    for (const char* said : {"ball_speed = 1.0\n", "speed = 1.0\n", ""}) {
        text_ = ball + said;
        const Variation both = vary({"cue.aim_deg=uniform(80,100)", "cue.ball_speed=grid(1,2,2)"});
        const std::optional<Scene> slow = both.shot(0).scene, fast = both.shot(1).scene;
        ASSERT_TRUE(slow && fast) << said << both.shot(0).error;
        EXPECT_NEAR(fast->cue->speed, 2.0 * slow->cue->speed, 1e-12);
        EXPECT_NE(slow->cue->aim_deg, fast->cue->aim_deg);
        EXPECT_FALSE(vary({"cue.ball_speed=uniform(1,2)"}).shot(0).scene->cue->speed == 1.0);
    }
}

TEST_F(VariationTest, OfATextEqualsThatOfAFile) {
    const std::vector<std::string> rules = {"cue.speed=uniform(1,5)"};
    const Variation file = vary(rules), text = Variation::from_text(kSmallScene, "a text", rules, 1);
    EXPECT_EQ(file.fingerprint(), text.fingerprint());
    EXPECT_EQ(file.shot(3).values, text.shot(3).values);
    EXPECT_EQ(text.base().file, "a text");
    EXPECT_THROW(Variation::from_text("[[ball]", "a text", rules, 1), SceneError);
    EXPECT_THROW(Variation::from_text(kSmallScene, "a text", {"cue.haste=uniform(1,5)"}, 1), VariationError);
}

TEST_F(VariationTest, EveryKindOfKeyReachesItsValue) {
    const Variation v = vary({"cue.speed=list(2.5)", "cue.offset.side=list(-0.1)", "cue.offset.1=list(0.3)",
                              "ball.cue.position.x=list(0.7)", "ball.ball.2.position=list([0.5, 1.5])",
                              "ball.ball.2.velocity=list([0.5, 0])", "balls.mu_b_fit.0=list(0.07)",
                              "physics.cushion=list(\"stronge\")", "table.pocket.p1.radius=list(0.07)",
                              "table.cushion.c2.to.y=list(4)", "stop.events=integer(7,7)"});
    const VariedShot shot = v.shot(5);
    ASSERT_TRUE(shot.scene) << shot.error;
    const Scene& s = *shot.scene;
    EXPECT_EQ(s.cue->speed, 2.5);
    EXPECT_EQ(s.cue->side, -0.1);
    EXPECT_EQ(s.cue->height, 0.3);
    EXPECT_EQ(s.ball[0].position.x(), 0.7);
    EXPECT_EQ(s.ball[0].position.y(), 0.5);
    EXPECT_EQ(s.ball[1].position.y(), 1.5);
    EXPECT_EQ(s.ball[1].velocity.x(), 0.5);
    EXPECT_EQ(s.balls.mu_b, 0.07);
    EXPECT_EQ(s.physics.cushion, cushion_model("stronge"));
    EXPECT_EQ(s.table.pockets[0].radius, 0.07);
    EXPECT_EQ(s.table.cushions[1].to.y(), 4.0);
    EXPECT_EQ(s.stop.events, 7);
    EXPECT_EQ(v.base().cue->speed, 4.0);
    EXPECT_EQ(drawn(shot, 0), "2.5");
    EXPECT_EQ(drawn(shot, 4), "[ 0.5, 1.5 ]");
    EXPECT_EQ(drawn(shot, 7), "stronge");
}

TEST_F(VariationTest, AShotDependsOnSeedNumberAndKeyAlone) {
    const std::string speed = "cue.speed=uniform(1,2)";
    const Variation alone = vary({speed}), among = vary({"cue.aim_deg=normal(90,1)", speed}),
                    other_seed = vary({speed}, 2);
    std::set<std::string> seen;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const std::string value = drawn(alone.shot(i), 0);
        EXPECT_EQ(value, drawn(among.shot(i), 1));
        EXPECT_NE(value, drawn(other_seed.shot(i), 0));
        seen.insert(value);
    }
    EXPECT_EQ(seen.size(), 1000u);
    EXPECT_EQ(alone.shot(999).values, alone.shot(999).values);
    EXPECT_NE(alone.fingerprint(), among.fingerprint());
    EXPECT_NE(alone.fingerprint(), other_seed.fingerprint());
    // A fixed value: changing the generator would change every published sweep.
    EXPECT_EQ(drawn(alone.shot(0), 0), "1.1117882243348463");
    EXPECT_EQ(std::stod(drawn(alone.shot(7), 0)), alone.shot(7).scene->cue->speed);
}

TEST_F(VariationTest, UnitsFollowTheKeys) {
    const Variation v =
        vary({"cue.speed=uniform(1,2)", "cue.aim_deg=normal(90,1)", "balls.mu_s=uniform(0.1,0.2)",
              "physics.cushion=list(\"stronge\")", "table.pocket.p1.radius=uniform(0.05,0.06)",
              "cue.offset.side=normal(0.1)", "ball.cue.position=list([0.5,0.5])"});
    std::vector<std::string> units;
    for (std::size_t i = 0; i < v.keys().size(); ++i) units.push_back(v.unit(i));
    EXPECT_EQ(units, (std::vector<std::string>{"m/s", "degrees", "", "", "m", "ball radii", ""}));
    const std::string rack = folder_.write("r.toml", "[rack]\ngame = \"eight_ball\"\n");
    const Variation breaks(rack, {"rack.gap=uniform(0,1e-4)", "rack.seed=integer(1,9)"}, 1);
    EXPECT_EQ(breaks.unit(0), "m");
    EXPECT_EQ(breaks.unit(1), "");
}

TEST_F(VariationTest, NormalIsCentredOnTheScenesNumber) {
    const Variation v = vary({"cue.speed=normal(0.1)"});
    double sum = 0.0;
    for (std::uint64_t i = 0; i < 400; ++i) sum += v.shot(i).scene->cue->speed;
    EXPECT_NEAR(sum / 400.0, 4.0, 4.0 * 0.1 / 20.0);
}

TEST_F(VariationTest, InvalidValuesYieldNoScene) {
    const Variation v = vary({"ball.cue.position.y=uniform(1.5,2.5)"});  // the other ball is at (0.6, 2)
    int bad = 0;
    for (std::uint64_t i = 0; i < 200; ++i) {
        const VariedShot shot = v.shot(i);
        const double y = std::stod(drawn(shot, 0));
        EXPECT_EQ(shot.scene.has_value(), std::hypot(0.035, y - 2.0) >= 2 * 0.028575) << y;
        if (shot.scene) continue;
        ++bad;
        EXPECT_NE(shot.error.find("overlap by"), std::string::npos) << shot.error;
        EXPECT_EQ(shot.error.find("s.toml"), std::string::npos) << shot.error;
    }
    EXPECT_GT(bad, 5);
}

/// shot() drops source locations: toml++ does not copy them.
Scene without_places(Scene scene) {
    for (BallStart& ball : scene.ball) ball.where = {};
    if (scene.cue) scene.cue->where = {};
    return scene;
}

// The fast path makes the same scene as the file, or reports that it cannot.
TEST_F(VariationTest, PutMakesTheSceneOfTheFile) {
    const auto expect_same = [&](const std::vector<std::string>& rules, int quick) {
        const Variation v = vary(rules);
        Scene scene = v.base();
        std::vector<DrawnValue> values(rules.size());
        int made = 0;
        for (std::uint64_t i = 0; i < 60; ++i) {
            const VariedShot shot = v.shot(i);
            v.draw(i, values);
            const std::optional<Change> change = v.put(values, scene);
            if (!change) continue;
            ++made;
            EXPECT_EQ(values, shot.values);
            if (shot.scene) {
                EXPECT_EQ(without_places(scene), without_places(*shot.scene)) << i;
                EXPECT_NO_THROW(validate_change(scene, *change));
                continue;
            }
            try {
                validate(scene);
                ADD_FAILURE() << shot.error;
            } catch (const SceneError& error) {
                EXPECT_EQ(error.message(), shot.error);
            }
            EXPECT_THROW(validate_change(scene, *change), SceneError) << shot.error;
        }
        EXPECT_EQ(made, quick) << rules.front();
    };
    expect_same({"cue.speed=uniform(-1,3)", "cue.offset.side=uniform(-0.6,0.6)", "cue.end_mass=uniform(0,1)",
                 "cue.elevation_deg=normal(80,10)"},
                60);
    expect_same({"ball.cue.position.y=uniform(-0.1,2.5)", "ball.cue.position.0=uniform(0,1.3)",
                 "balls.mu_s=uniform(0,1.2)", "balls.f_c=list(0, 0.5, 1.5)", "balls.e_c=uniform(0.5,1.1)"},
                60);
    expect_same({"physics.gravity=list(0,9.81)", "physics.tolerance=uniform(1e-9,1e-5)",
                 "stop.time=uniform(-1,5)", "stop.events=integer(1,9)"},
                60);
    expect_same({"physics.cushion=list(\"stronge\",\"smooth\")", "cue.speed=uniform(1,2)"}, 0);
    expect_same({"balls.radius=uniform(0.028,0.029)"}, 0);
    expect_same(
        {"ball.ball.2.mass=uniform(0.16,0.18)", "balls.f_c=list(0)", "physics.ball_ball=list(\"inelastic\")"},
        0);
    expect_same({"table.pocket.p1.radius=uniform(0.05,0.07)"}, 0);
    text_ =
        "[balls]\nmu_r = 0.02\n[table]\ncloth = \"club\"\n[[ball]]\nposition = [0.6, 0.5]\n[rack]\ngame = "
        "\"eight_ball\"\n[cue]\n";
    expect_same({"rack.seed=integer(1,100)", "rack.jitter=uniform(0,0.0001)", "rack.gap=uniform(0,0.001)",
                 "rack.angle_deg=uniform(-5,5)", "balls.mu_r=uniform(0.01,0.02)"},
                60);
    expect_same({"rack.spot_ball=integer(1,15)"}, 0);
    expect_same({"rack.method=list(\"template\", \"triangle\")"}, 0);
    expect_same({"balls.radius_sd=uniform(0,1e-5)"}, 0);
    text_ = "[balls]\nradius_sd = 1e-5\n" + text_.substr(text_.find("[table]"));
    expect_same({"rack.seed=integer(1,100)"}, 0);
    text_ = text_.substr(text_.find("[table]"));
    text_.insert(text_.find("[cue]"), "method = \"triangle\"\n");
    expect_same({"rack.seed=integer(1,100)"}, 60);
}

TEST_F(VariationTest, PutLeavesInvalidScenesToTheReader) {
    text_ = "[[ball]]\nposition = [0.6, 0.5]\n[rack]\ngame = \"eight_ball\"\n[cue]\n";
    for (const char* rule : {"rack.seed=integer(-50,50)", "rack.gap=uniform(-0.001,0.001)",
                             "stop.events=list(5, 1.5)", "cue.speed=list(1, \"fast\")"}) {
        const Variation v = vary({rule});
        Scene scene = v.base();
        int left = 0;
        for (std::uint64_t i = 0; i < 60; ++i) {
            const VariedShot shot = v.shot(i);
            const bool made = v.put(shot.values, scene).has_value();
            EXPECT_EQ(made, shot.scene.has_value()) << rule << ' ' << shot.error;
            if (made) {
                EXPECT_EQ(without_places(scene), without_places(*shot.scene));
            }
            left += !made;
        }
        EXPECT_GT(left, 10) << rule;
        EXPECT_LT(left, 50) << rule;
    }
}

TEST_F(VariationTest, GridsFormAProductAndTheLastVariesFastest) {
    const Variation v = vary({"cue.speed=grid(1,4,7)", "cue.aim_deg=uniform(0,90)",
                              "physics.cushion=grid(list(\"stronge\",\"han_2005\"))"});
    EXPECT_EQ(v.grid(), 14u);
    EXPECT_EQ(v.kind(0), ValueKind::kNumber);
    EXPECT_EQ(v.kind(2), ValueKind::kText);
    for (std::uint64_t i = 0; i < 28; ++i) {
        const VariedShot shot = v.shot(i);
        ASSERT_TRUE(shot.scene) << shot.error;
        EXPECT_EQ(shot.scene->cue->speed, 1.0 + 0.5 * static_cast<double>(i / 2 % 7)) << i;
        EXPECT_EQ(drawn(shot, 2), i % 2 == 0 ? "stronge" : "han_2005");
    }
    // Keys beside a grid are redrawn in its second round.
    EXPECT_NE(drawn(v.shot(0), 1), drawn(v.shot(14), 1));
    EXPECT_EQ(vary({"cue.speed=uniform(1,2)"}).grid(), 0u);
    // The ends are exact, and whole steps are whole numbers.
    const Variation tenths = vary({"cue.speed=grid(0.1,0.7,7)", "stop.events=grid(9,3,3)"});
    EXPECT_EQ(drawn(tenths.shot(18), 0) + " " + drawn(tenths.shot(18), 1), "0.7 9");
    EXPECT_EQ(tenths.shot(20).scene->stop.events, 3);
    EXPECT_EQ(tenths.kind(1), ValueKind::kWhole);
    Scene scene = tenths.base();
    std::vector<DrawnValue> values(2);
    tenths.draw(19, values);
    ASSERT_TRUE(tenths.put(values, scene));
    EXPECT_EQ(values, tenths.shot(19).values);
}

TEST_F(VariationTest, AllShotsHaveTheSameBalls) {
    text_ = "[rack]\ngame = \"line\"\ncount = 3\n";
    const Variation v = vary({"rack.count=integer(2,4)"});
    for (std::uint64_t i = 0; i < 50; ++i) {
        const VariedShot shot = v.shot(i);
        EXPECT_EQ(shot.scene.has_value(), drawn(shot, 0) == "3");
        if (shot.scene) continue;
        EXPECT_NE(shot.error.find("its balls differ from those"), std::string::npos);
    }
}

TEST_F(VariationTest, BadRulesSayWhatToDo) {
    const struct {
        const char *rule, *says;
    } cases[] = {
        {"cue.speed", "expected KEY=DISTRIBUTION"},
        {"=uniform(1,2)", "expected KEY=DISTRIBUTION"},
        {"speed=uniform(1,2)", "name a value in its section, such as cue.speed"},
        {"cue.=uniform(1,2)", "the name of the value is missing"},
        {"cue.sped=uniform(1,2)", "unknown key \"sped\" in [cue]; the keys there are preset, ball, speed,"},
        {"cue.sped=uniform(1,2)", "; did you mean speed?"},
        {"cue.aim=normal(0.1)", "unknown key \"aim\" in [cue]"},
        {"cue.aimdeg=normal(0.1)", "; did you mean aim_deg?"},
        {"ball.cue.positoin=list([1,1])", "; did you mean position?"},
        {"effects.squrt=list(true)", "; did you mean squirt?"},
        {"quue.speed=uniform(1,2)", "unknown section or key \"quue\""},
        {"que.speed=normal(1)", "; did you mean cue?"},
        {"rack.seed=integer(1,2)", "the scene has no [rack]"},
        {"ball.1.position.x=uniform(0,1)",
         "there is no such ball; write ball.ID.position.x with one of these ids: cue, ball.2"},
        {"ball.cue.spin.z=uniform(0,1)", "does not contain this array"},
        {"cue.offset.2=uniform(0,1)", "the array in the scene file is shorter"},
        {"cue.offset.left=uniform(0,1)", "\"left\" is not an element of an array"},
        {"cue.speed.x=uniform(0,1)", "does not contain this array"},
        {"table.pocket.1.radius=uniform(0,1)", "name the part by its number, as in table.pocket.p1.radius"},
        {"table.pocket.p2.radius=uniform(0,1)", "does not contain this part"},
        {"table.jaw.j1.radius=uniform(0,1)", "does not contain this part"},
        {"cue.speed=uniform(1)", "uniform has 1 values; write uniform(a,b)"},
        {"cue.speed=uniform(2,1)", "needs a <= b"},
        {"cue.speed=uniform(-1e308,1e308)", "b - a is too large"},
        {"cue.speed=uniform(1,nan)", "must be a finite number"},
        {"cue.speed=uniform(9007199254740993,9007199254740993)",
         "value 1 of uniform = 9007199254740993 has more digits than a number can store; write "
         "9007199254740992.0"},
        {"cue.speed=normal(1,9007199254740993)", "value 2 of normal = 9007199254740993 has more digits"},
        {"cue.speed=list(9007199254740993)", "shot 0: cue.speed = 9007199254740993 is out of range"},
        {"cue.speed=integer(1,9007199254740993)", "needs -1000000000 <= a <= b"},
        {"cue.speed=uniform(1,2", "expected uniform(a,b)"},
        {"cue.speed=uniform(1],v=[2)", "cannot read the values"},
        {"cue.speed=grid(1,2)", "grid has 2 values; write grid(a,b,n) or grid(list(v,...))"},
        {"cue.speed=grid(1,2,1)", "grid(a,b,n) needs n >= 2"},
        {"cue.speed=grid(1,2,0)", "grid(a,b,n) needs 1 <= n"},
        {"cue.speed=grid(1,2,1.5)", "value 3 of grid"},
        {"cue.speed=grid(list())", "list has 0 values"},
        {"cue.speed=grid(-1e308,1e308,3)", "b - a is too large"},
        {"cue.speed=gauss(1,2)", "unknown distribution \"gauss\""},
        {"cue.speed=unifrom(1,2)", "; did you mean uniform?"},
        {"cue.speed=normal(-1)", "must be at least 0"},
        {"cue.aim_deg=normal(1)",
         "needs a number in the scene as its centre; add it, or use normal(mean,sd)"},
        {"cue.speed=integer(1.5,2)", "value 1 of integer must be an integer"},
        {"cue.speed=integer(3,2)", "needs -1000000000 <= a <= b"},
        {"cue.speed=list()", "list has 0 values"},
        {"physics.cushion=list(smooth)", "strings in double quotes"},
        {"cue.speed=list(\"fast\")",
         "none of the first 100 shots is a valid scene; shot 0: cue.speed must be a number, or a number"},
        {"cue.speed=uniform(-2,-1)", "none of the first 100 shots is a valid scene; shot 0: cue.speed = -"},
    };
    for (const auto& c : cases)
        EXPECT_NE(error_of(c.rule).find(c.says), std::string::npos) << error_of(c.rule);
    try {
        vary({"cue.offset=list([0,0])", "cue.offset.side=uniform(0,0.1)"});
        ADD_FAILURE() << "two rules for one value";
    } catch (const VariationError& error) {
        EXPECT_NE(std::string(error.what()).find("cue.offset already varies this value"), std::string::npos);
    }
}

// Moments and tails of 1e6 draws, within five standard errors.
TEST(StandardNormal, HasTheMomentsAndTailsOfTheNormalDistribution) {
    SplitMix64 random(42);
    constexpr int kDraws = 1000000;
    double sum = 0.0, squares = 0.0, fourth = 0.0;
    int beyond_two = 0, beyond_three = 0;
    for (int i = 0; i < kDraws; ++i) {
        const double x = standard_normal(random);
        sum += x;
        squares += x * x;
        fourth += x * x * x * x;
        beyond_two += std::abs(x) > 2.0;
        beyond_three += std::abs(x) > 3.0;
    }
    constexpr double n = kDraws;
    EXPECT_NEAR(sum / n, 0.0, 5.0 / std::sqrt(n));
    EXPECT_NEAR(squares / n, 1.0, 5.0 * std::sqrt(2.0 / n));
    EXPECT_NEAR(fourth / n, 3.0, 5.0 * std::sqrt(96.0 / n));
    EXPECT_NEAR(beyond_two / n, 0.0455003, 5.0 * std::sqrt(0.0455 / n));
    EXPECT_NEAR(beyond_three / n, 0.0026998, 5.0 * std::sqrt(0.0027 / n));
}

TEST(Distribution, DrawsCoverTheirRanges) {
    SplitMix64 random(1);
    const auto uniform = detail::parse_distribution("uniform(-1, 3)", nullptr);
    const auto integer = detail::parse_distribution("integer(-2,2)", nullptr);
    double least = 9.0, most = -9.0;
    std::set<std::int64_t> seen;
    for (int i = 0; i < 10000; ++i) {
        const double x = std::get<double>(uniform.draw(random));
        least = std::min(least, x);
        most = std::max(most, x);
        seen.insert(std::get<std::int64_t>(integer.draw(random)));
    }
    EXPECT_GE(least, -1.0);
    EXPECT_LT(least, -0.99);
    EXPECT_LT(most, 3.0);
    EXPECT_GT(most, 2.99);
    EXPECT_EQ(seen, (std::set<std::int64_t>{-2, -1, 0, 1, 2}));
}

TEST(NewValues, ReadAsIfWrittenInTheFile) {
    const std::string text = with_values(kSmallScene, "s.toml",
                                         {{"cue.speed", "0.1"},
                                          {"cue.offset.side", "-0.25"},
                                          {"ball.ball.2.position", "[0.7, 1.7]"},
                                          {"physics.cushion", "\"stronge\""},
                                          {"table.pocket.p1.radius", "0.05"}});
    const Scene scene = parse_scene(text, "s.toml"), before = parse_scene(kSmallScene, "s.toml");
    EXPECT_EQ(scene.cue->speed, 0.1);
    EXPECT_EQ(scene.cue->side, -0.25);
    EXPECT_EQ(scene.cue->height, 0.1);
    EXPECT_EQ(scene.ball[1].position.x(), 0.7);
    EXPECT_EQ(scene.physics.cushion, cushion_model("stronge"));
    EXPECT_EQ(scene.table.pockets[0].radius, 0.05);
    EXPECT_EQ(scene.table.cushions, before.table.cushions);
    EXPECT_EQ(scene_text(parse_scene(with_values(kSmallScene, "s.toml", {}), "s.toml")), scene_text(before));
}

TEST(NewValues, ExplainErrors) {
    const auto error_of = [](const std::string& key, const std::string& value) -> std::string {
        try {
            return with_values(kSmallScene, "s.toml", {{key, value}});
        } catch (const VariationError& error) {
            return error.what();
        }
    };
    EXPECT_EQ(error_of("cue.speed", "1, 2"), "cue.speed: expected one value, not 2");
    EXPECT_EQ(error_of("cue.speed", "").rfind("cue.speed: expected one value, not 0", 0), 0u);
    EXPECT_EQ(error_of("cue.speed", "x = 1").rfind("cue.speed: cannot read the values of value(x = 1)", 0),
              0u);
    EXPECT_EQ(error_of("ball.9.position", "[0, 0]").rfind("ball.9.position: there is no such ball;", 0), 0u);
    EXPECT_EQ(error_of("speed", "1"), "speed: name a value in its section, such as cue.speed");
    EXPECT_THROW(with_values("[", "s.toml", {}), SceneError);
}

}  // namespace
}  // namespace carom::test
