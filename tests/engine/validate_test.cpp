// Scenes built in code are refused with the same messages as files: random mistakes are compared with the
// route through a text. The files of bad scenes are tested in scene_rules_test.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "carom/engine/cushion.h"
#include "carom/engine/scene.h"
#include "carom/kernel/splitmix64.h"

namespace carom::test {
namespace {

template <class Check>
std::string message_of(Check&& check) {
    try {
        check();
    } catch (const SceneError& error) {
        EXPECT_EQ(error.what(), "s: " + error.message());
        return error.message();
    }
    return "";
}

std::string by_struct(const Scene& scene) {
    return message_of([&] { validate(scene); });
}

/// The route through a text, without its locations, since nobody wrote that text.
std::string by_text(const Scene& scene) {
    try {
        parse_scene(scene_text(scene), scene.file);
    } catch (const SceneError& error) {
        const std::string text = error.message();
        const std::size_t line = text.find(" in line ");
        return line == text.npos ? text : text.substr(0, line) + text.substr(text.find(';', line));
    }
    return "";
}

Scene good() {
    return parse_scene(
        "[[ball]]\nposition = [0.6, 0.5]\n[[ball]]\nid = \"1\"\nposition = [0.6, 1.5]\n[cue]\n", "s");
}

/// Some balls on some table, with some wrong numbers.
Scene random_scene(SplitMix64& random) {
    static const char* const kTables[] = {"seven_foot", "nine_foot", "snooker", "carom"};
    Scene s;
    s.file = "s";
    s.table = make_table(kTables[random.below(4)]);
    use_balls(s, kBallPresets[random.below(std::size(kBallPresets))]);
    const int count = 1 + random.below(6);
    for (int i = 0; i < count; ++i) {
        BallStart ball;
        ball.id = i == 0 ? "cue" : std::to_string(i);
        ball.position = Vec3(-0.02 + random.uniform() * 1.2, -0.02 + random.uniform() * 2.2, s.balls.R);
        s.ball.push_back(ball);
    }
    if (random.below(2) == 0) s.cue = Cue();
    return s;
}

double wrong(SplitMix64& random, double x) {
    const double values[] = {0.0, -x, -1.0, 1.5 * x, 0.95, 2.0, 1e7, 1e300, std::nan(""), -1.0 / 0.0};
    return values[random.below(10)];
}

/// Changes a number, an id, a name or a model.
void spoil(Scene& s, SplitMix64& random) {
    const auto number = [&](double& x) { x = wrong(random, x); };
    const auto row = [&](auto& fields, auto& object) {
        const auto& f = fields[random.below(static_cast<int>(std::size(fields)))];
        const FieldValue value = f.get(object);
        if (f.options.files == Files::kRecord) return;
        if (const auto* x = std::get_if<double>(&value)) f.set(object, wrong(random, *x));
        if (const auto* list = std::get_if<std::vector<double>>(&value); list && f.element != nullptr)
            if (double* x =
                    f.element(object, static_cast<std::size_t>(random.below(static_cast<int>(f.count())))))
                number(*x);
    };
    BallStart& ball = s.ball[random.below(static_cast<int>(s.ball.size()))];
    switch (random.below(16)) {
        case 0:
        case 1:
            return row(kBallFields, s.balls);
        case 2:
            return row(kPhysicsFields, s.physics);
        case 3:
            if (s.cue) row(kCueFields, *s.cue);
            return;
        case 4:
            return row(kBallStartFields, ball);
        case 5:
            if (!s.table.jaws.empty())
                row(kJawFields, s.table.jaws[random.below(static_cast<int>(s.table.jaws.size()))]);
            return;
        case 6:
            return row(kCushionFields,
                       s.table.cushions[random.below(static_cast<int>(s.table.cushions.size()))]);
        case 7:
            s.physics.cushion =
                all_of(s.physics.cushion)[random.below(static_cast<int>(all_of(s.physics.cushion).size()))];
            return;
        case 8:
            ball.id = random.below(2) == 0 ? "cue" : "a\x07";
            return;
        case 9:
            ball.own = BallSize{s.balls.R, s.balls.m * (0.5 + random.uniform())};
            return;
        case 10:
            s.stop.time = wrong(random, 1.0);
            return;
        case 11:
            if (s.cue) s.cue->ball = random.below(2) == 0 ? "white" : s.ball.back().id;
            return;
        case 12:
            ball.velocity = Vec3(1.0, 0.0, 0.0);
            return;
        case 13:
            s.table.bed = Rectangle(0.0, random.below(2), 1.0, 1.0);
            return;
        case 14:
            s.render.eye = Vec3(1.0, 2.0, 3.0);
            if (random.below(2) == 0) s.render.target = s.render.eye;
            return;
        default:
            return row(kRenderFields, s.render);
    }
}

TEST(Validate, GivesTheTextsMessageForRandomMistakes) {
    SplitMix64 random(7);
    int refused = 0;
    std::set<std::string> kinds;
    for (int i = 0; i < 4000; ++i) {
        Scene scene = random_scene(random);
        for (int k = random.below(4); k > 0; --k) spoil(scene, random);
        for (BallStart& ball : scene.ball) ball.position.z() = scene.size_of(ball).R + ball.height;
        if (std::isnan(scene.balls.R)) continue;  // a separate rule: no height is such a radius
        const std::string want = by_text(scene);
        ASSERT_EQ(by_struct(scene), want) << scene_text(scene);
        refused += !want.empty();
        kinds.insert(want.substr(want.find(' ') + 1, 12));
    }
    EXPECT_GT(refused, 1000);
    EXPECT_LT(refused, 3500);
    EXPECT_GT(kinds.size(), 20u);
}

// Values that no file can express.
TEST(Validate, RefusesValuesThatNoFileCanExpress) {
    Scene scene = good();
    scene.physics.ball_ball = nullptr;
    EXPECT_EQ(by_struct(scene), "physics.ball_ball is not a model; choose one");
    scene = good();
    scene.effects = {{"pockets", true, {}}, {"pockets", true, {}}};
    EXPECT_EQ(by_struct(scene), "effects.pockets appears twice; keep one of the two");
    scene = good();
    scene.ball[1].id = "\xff";
    EXPECT_EQ(by_struct(scene), "the ball id \"?\" is not UTF-8; convert it");
    scene = good();
    scene.table.cloth = "sand";
    EXPECT_EQ(by_struct(scene), by_text(scene));
    EXPECT_NE(by_struct(scene), "");
}

}  // namespace
}  // namespace carom::test
