// Scenes built in code are refused with the same messages as files: for every bad scene that a struct can
// represent, and for random mistakes, compared with the route through a text.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/scene.h"
#include "carom/engine/tolerances.h"
#include "carom/kernel/splitmix64.h"
#include "support/files.h"

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

Scene with_rack(const char* rack) {
    return parse_scene(std::string("[[ball]]\nposition = [0.6, 0.5]\n[rack]\ngame = ") + rack, "s");
}

void place(Scene& scene, std::size_t ball, double x, double y) {
    scene.ball[ball].position = Vec3(x, y, scene.size_of(scene.ball[ball]).R);
}

void set_radius(Scene& scene, double R) {
    scene.balls.R = R;
    for (BallStart& ball : scene.ball) ball.position.z() = R;
}

void own_outline(Scene& scene) {
    scene.table = Table();
    scene.table.cushions = {{"c1", Vec2(0, 0), Vec2(0, 3), 0.036576}};
}

using Mistake = std::function<void(Scene&)>;

/// The mistake of each bad scene file, made in a struct.
const std::map<std::string, Mistake>& mistakes() {
    static const double kInfinity = std::numeric_limits<double>::infinity();
    static const std::map<std::string, Mistake> all = {
        {"balls_unknown", [](Scene& s) { s.ball_preset = "tennis"; }},
        {"camera_eye", [](Scene& s) { s.render.eye = Vec3(1, 2, 3); }},
        {"cue_and_spin", [](Scene& s) { s.ball[0].spin = Vec3(0, 0, 5); }},
        {"cue_and_velocity", [](Scene& s) { s.ball[0].velocity = Vec3(1, 0, 0); }},
        {"cue_ball_missing", [](Scene& s) { s.ball.erase(s.ball.begin()); }},
        {"cue_ball_unknown", [](Scene& s) { s.cue->ball = "white"; }},
        {"cue_speed_negative", [](Scene& s) { s.cue->speed = -1.0; }},
        {"cushion_of_no_length",
         [](Scene& s) {
             own_outline(s);
             s.table.cushions[0].to = s.table.cushions[0].from;
         }},
        {"effects_unknown",
         [](Scene& s) {
             s.effects.push_back({"wind", true, {}});
         }},
        {"elevation", [](Scene& s) { s.cue->elevation_deg = 90.0; }},
        {"empty", [](Scene& s) { s.ball.clear(), s.cue.reset(); }},
        {"no_balls", [](Scene& s) { s.ball.clear(), s.cue.reset(); }},
        {"end_mass", [](Scene& s) { s.cue->end_mass = 1.0; }},
        {"eye_is_target", [](Scene& s) { s.render.eye = s.render.target = Vec3(1, 2, 3); }},
        {"fps_zero", [](Scene& s) { s.render.fps = 0.0; }},
        {"friction_beyond_tolerance", [](Scene& s) { s.balls.mu_b = 1.5, s.balls.mu_b_more = 0.0; }},
        {"friction_negative", [](Scene& s) { s.balls.mu_s = -0.1; }},
        {"gravity_negative", [](Scene& s) { s.physics.gravity = -9.81; }},
        {"id_empty", [](Scene& s) { s.ball[1].id = ""; }},
        {"id_too_long", [](Scene& s) { s.ball[1].id = std::string(65, 'x'); }},
        {"id_with_comma", [](Scene& s) { s.ball[1].id = "a,b"; }},
        {"image_too_large", [](Scene& s) { s.render.width = 20000; }},
        {"in_cushion", [](Scene& s) { place(s, 0, 0.02, 0.5); }},
        {"infinite_speed", [](Scene& s) { s.cue->speed = kInfinity; }},
        {"mass_negative", [](Scene& s) { s.balls.m = -0.17; }},
        {"mathavan_cushion_jams",
         [](Scene& s) { s.balls.f_c = 2.0, s.physics.cushion = cushion_model("mathavan_2010"); }},
        {"miscue", [](Scene& s) { s.cue->side = s.cue->height = 0.4; }},
        {"never_rests_gravity", [](Scene& s) { s.physics.gravity = 0.0; }},
        {"never_rests_rolling", [](Scene& s) { s.balls.mu_r = 0.0; }},
        {"never_rests_sliding", [](Scene& s) { s.balls.mu_s = 0.0; }},
        {"never_rests_spin", [](Scene& s) { s.balls.mu_sp = 0.0; }},
        {"nose_too_high",
         [](Scene& s) {
             own_outline(s);
             s.table.cushions[0].height = 0.06;
         }},
        {"nose_too_high_for_small_balls", [](Scene& s) { set_radius(s, 0.01); }},
        {"not_finite", [](Scene& s) { place(s, 0, 0.6, std::nan("")); }},
        {"overlap", [](Scene& s) { s.ball[1].id = "one", place(s, 1, 0.65, 0.5); }},
        {"overlap_with_rack", [](Scene& s) { s = with_rack("\"eight_ball\""), place(s, 0, 0.635, 1.91); }},
        {"pocket_radius_zero",
         [](Scene& s) {
             own_outline(s);
             s.table.pockets = {{"p1", Vec2(1, 1), 0.0, kPocketDepth}};
         }},
        {"radius_zero", [](Scene& s) { set_radius(s, 0.0); }},
        {"restitution_above_one", [](Scene& s) { s.balls.e_b = 1.05; }},
        {"restitution_fit_above_one",
         [](Scene& s) { s.balls.e_c = 1.2, s.balls.e_c_fall = 0.08, s.balls.e_c_above = 1.7; }},
        {"cushion_touch_of_unlike_balls",
         [](Scene& s) {
             s.physics.cushion_touch = CushionTouch::kNose;
             s.physics.ball_ball = ball_ball_model("inelastic");
             s.physics.clusters = ClusterModel::kSequential;
             s.ball[1].own = BallSize{s.balls.R, 0.2};
         }},
        {"rolling_above_sliding", [](Scene& s) { s.balls.mu_r = 1.2; }},
        {"rolling_of_cloth_above_sliding", [](Scene& s) { s.balls.mu_s = 0.009; }},
        {"rolling_of_preset_above_sliding",
         [](Scene& s) {
             use_balls(s, "snooker");
             set_radius(s, s.balls.R);
             s.balls.mu_s = 0.01;
         }},
        {"same_id", [](Scene& s) { s.ball[1].id = "cue"; }},
        {"same_id_by_default", [](Scene& s) { s.ball[1].id = "cue"; }},
        {"same_id_in_rack", [](Scene& s) { s = with_rack("\"eight_ball\""), s.ball[0].id = "7"; }},
        {"ball_beside_bed",
         [](Scene& s) {
             s.table.bed = Rectangle(0.0, 0.0, 1.0, 1.0);
             place(s, 0, 0.5, 1.5);
             s.ball[0].height = 0.1;
             s.ball[0].position.z() += 0.1;
         }},
        {"ball_behind_rail",
         [](Scene& s) {
             place(s, 0, -0.05, 1.0);
             s.ball[0].height = 0.2;
             s.ball[0].position.z() += 0.2;
         }},
        {"bed_without_surface", [](Scene& s) { s.table.bed = Rectangle(0.0, 1.0, 2.0, 1.0); }},
        {"bed_of_planar_scene",
         [](Scene& s) {
             s.table.bed = Rectangle(0.0, 0.0, 1.27, 2.54);
             s.physics.vertical = Vertical::kDrop;
         }},
        {"id_of_a_formula", [](Scene& s) { s.ball[0].id = "=1+1"; }},
        {"id_of_a_cushion", [](Scene& s) { s.ball[0].id = "c12"; }},
        {"id_that_steers", [](Scene& s) { s.ball[0].id = "a\u202eb"; }},
        {"too_small_a_number", [](Scene& s) { s.ball[0].velocity.x() = 1e-310; }},
        {"stop_negative", [](Scene& s) { s.stop.time = -1.0; }},
        {"march_without_substeps", [](Scene& s) { s.physics.march = March::kPublished; }},
        {"substeps_zero", [](Scene& s) { s.physics.substeps = 0; }},
        {"preset_mistyped", [](Scene& s) { s.table.preset = "nine_fot"; }},
        {"table_unknown", [](Scene& s) { s.table.preset = "twenty_foot"; }},
        {"too_far", [](Scene& s) { place(s, 0, 1e7, 0.5); }},
        {"too_many_balls",
         [](Scene& s) {
             for (int i = 0; i < 4096; ++i) {
                 s.ball.push_back(s.ball[1]);
                 s.ball.back().id = "b" + std::to_string(i);
             }
         }},
    };
    return all;
}

/// Mistakes only possible in a file: syntax, types, keys, names of models, racks.
const std::set<std::string> kOfFiles = {"ball_not_a_table",
                                        "ball_single_brackets",
                                        "camera_and_eye",
                                        "cloth_slip_unknown",
                                        "cushion_model_unknown",
                                        "cushion_without_end",
                                        "date",
                                        "duplicate_key",
                                        "duplicate_section",
                                        "effects_not_boolean",
                                        "image_fraction",
                                        "jaw_model_unknown",
                                        "jaw_without_radius",
                                        "model_unknown",
                                        "preset_and_outline",
                                        "rack_count_of_eight_ball",
                                        "rack_gap_negative",
                                        "rack_jitter_negative",
                                        "rack_jitter_too_wide",
                                        "rack_rows_of_eight_ball",
                                        "rack_seed_negative",
                                        "rack_snooker_without_table",
                                        "rack_unknown",
                                        "section_written_twice_over",
                                        "syntax",
                                        "syntax_unclosed",
                                        "tolerance",
                                        "top_level_key",
                                        "two_ball_frictions",
                                        "two_cushion_restitutions",
                                        "unknown_key",
                                        "unknown_key_first",
                                        "unknown_section",
                                        "wrong_element",
                                        "wrong_length",
                                        "wrong_type_array",
                                        "wrong_type_integer",
                                        "wrong_type_number",
                                        "wrong_type_string"};
/// Same rule as another file's, at a place that only the route through the text reports: see
/// OfRandomMistakes.
const std::set<std::string> kSameRule = {"in_jaw", "above_jaw", "in_own_cushion", "rack_does_not_fit"};

TEST(Validate, GivesTheReadersMessageForEveryBadScene) {
    for (const auto& path : toml_files(std::filesystem::path(CAROM_TEST_DATA) / "bad_scenes")) {
        const std::string name = path.stem().string();
        if (kOfFiles.count(name) + kSameRule.count(name) != 0) continue;
        const auto mistake = mistakes().find(name);
        ASSERT_NE(mistake, mistakes().end()) << name << ": give it a row, or say why no struct can hold it";
        std::string want = read_file(path);
        want = want.substr(2, want.find('\n') - 2);
        want = want.substr(want.find(": ") + 2);
        if (const std::size_t line = want.find(" in line "); line != want.npos)
            want = want.substr(0, line) + want.substr(want.find(';', line));
        Scene scene = good();
        mistake->second(scene);
        EXPECT_TRUE(matches(want, by_struct(scene)))
            << name << ": want " << want << "\ngot  " << by_struct(scene);
    }
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
    switch (random.below(12)) {
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
