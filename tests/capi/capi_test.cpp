// The C interface: the results of the C++ one, and a status with a message for every failure.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "carom/engine/simulate.h"
#include "owned.h"
#include "reference/random_impacts.h"

namespace carom::test {
using reference::Impact;
using reference::random_impacts;

namespace {

constexpr double kPoolR = 0.028575;
constexpr carom_impact_params kParams{kPoolR, 0.17, 0.2, 0.2, 0.05, 0.95};

std::vector<double> rvw_of(const kernel::Ball& ball) {
    std::vector<double> rvw;
    for (const double* row : {ball.r, ball.v, ball.w}) rvw.insert(rvw.end(), row, row + 3);
    return rvw;
}

TEST(CApi, CollidesAsTheKernelDoes) {
    const auto impacts = random_impacts(3, 50);
    for (const Impact& i : impacts) {
        const auto in1 = rvw_of(i.ball1), in2 = rvw_of(i.ball2);
        std::vector<double> out1(9), out2(9);
        const auto& p = i.params;
        const carom_impact_params params{p.R, p.m, p.mu_s1, p.mu_s2, p.mu_b, p.e_b};
        ASSERT_EQ(carom_collide_balls(in1.data(), in2.data(), &params, 1e-8, out1.data(), out2.data()),
                  CAROM_OK);
        kernel::ImpactResult result{};
        kernel::tolerance_function(kernel::best_isa())(i.ball1, i.ball2, i.params, 1e-8, result);
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(out1[0 + k], in1[0 + k]);
            EXPECT_EQ(out1[3 + k], result.v1[k]);
            EXPECT_EQ(out2[3 + k], result.v2[k]);
            EXPECT_EQ(out1[6 + k], result.w1[k]);
            EXPECT_EQ(out2[6 + k], result.w2[k]);
        }
        // Outputs may be inputs, also crosswise.
        std::vector<double> a = in1, b = in2;
        ASSERT_EQ(carom_collide_balls(a.data(), b.data(), &params, 1e-8, b.data(), a.data()), CAROM_OK);
        EXPECT_EQ(b, out1);
        EXPECT_EQ(a, out2);
    }
}

// More than one block, a ragged end, separate parameters, in place.
TEST(CApi, ABatchKeepsTheBoundOfSingleImpacts) {
    const auto impacts = random_impacts(4, 131);
    std::vector<double> balls1, balls2;
    std::vector<carom_impact_params> params;
    for (const Impact& i : impacts) {
        const auto one = rvw_of(i.ball1), two = rvw_of(i.ball2);
        balls1.insert(balls1.end(), one.begin(), one.end());
        balls2.insert(balls2.end(), two.begin(), two.end());
        params.push_back(
            {i.params.R, i.params.m, i.params.mu_s1, i.params.mu_s2, i.params.mu_b, i.params.e_b});
    }
    const std::vector<double> before1 = balls1, before2 = balls2;
    std::vector<std::int32_t> status(impacts.size(), -1);
    ASSERT_EQ(carom_collide_balls_batch(impacts.size(), balls1.data(), balls2.data(), params.data(),
                                        params.size(), 1e-9, balls1.data(), balls2.data(), status.data()),
              CAROM_OK)
        << carom_last_error();
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        double one[9], two[9];
        carom_collide_balls(&before1[9 * i], &before2[9 * i], &params[i], 1e-9, one, two);
        EXPECT_EQ(status[i], CAROM_IMPACT_OK);
        const double speed =
            std::hypot(before1[9 * i + 3] - before2[9 * i + 3], before1[9 * i + 4] - before2[9 * i + 4]);
        for (std::size_t k = 0; k < 9; ++k) {
            const double scale = (k < 6 ? 1.0 : 1.0 / params[i].R) * (2e-9 * speed + 1e-14);
            EXPECT_NEAR(balls1[9 * i + k], one[k], scale) << i << " " << k;
            EXPECT_NEAR(balls2[9 * i + k], two[k], scale) << i << " " << k;
        }
    }
}

TEST(CApi, ABadImpactIsNamedAndTheOthersAreSolved) {
    const double cue[9] = {0, 0, kPoolR, 0, 1, 0}, object[9] = {0, 2 * kPoolR, kPoolR};
    std::vector<double> in1, in2;
    for (int i = 0; i < 70; ++i) {
        in1.insert(in1.end(), cue, cue + 9);
        in2.insert(in2.end(), object, object + 9);
    }
    in1[9 * 66 + 3] = std::nan("");
    in1[9 * 3 + 4] = -1.0;  // moving away
    std::vector<double> out1(in1.size()), out2(in1.size());
    std::int32_t status[70];
    EXPECT_EQ(carom_collide_balls_batch(70, in1.data(), in2.data(), &kParams, 1, 1e-6, out1.data(),
                                        out2.data(), status),
              CAROM_BAD_ARGUMENT);
    EXPECT_EQ(std::string(carom_last_error()).rfind("impact 66: ", 0), 0u) << carom_last_error();
    EXPECT_EQ(status[66], CAROM_IMPACT_BAD_STATE);
    EXPECT_EQ(status[3], CAROM_IMPACT_NOT_APPROACHING);
    EXPECT_EQ(out1[9 * 3 + 4], -1.0);
    EXPECT_EQ(status[69], CAROM_IMPACT_OK);
    EXPECT_GT(out2[9 * 69 + 4], 0.9);

    double after1[9], after2[9];
    carom_impact_params bad = kParams;
    bad.mu_b = 7.0;
    EXPECT_EQ(carom_collide_balls(cue, object, &bad, 1e-6, after1, after2), CAROM_BAD_ARGUMENT);
    EXPECT_STRNE(carom_last_error(), "");
    EXPECT_EQ(after1[4], 1.0);
    for (const double tolerance : {0.0, 1.0, std::nan("")})
        EXPECT_EQ(carom_collide_balls(cue, object, &kParams, tolerance, after1, after2), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_collide_balls(nullptr, object, &kParams, 1e-6, after1, after2), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "a required pointer is NULL");
    EXPECT_EQ(carom_collide_balls_batch(2, cue, object, &kParams, 3, 1e-6, after1, after2, nullptr),
              CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_collide_balls_batch(0, nullptr, nullptr, nullptr, 0, 1e-6, nullptr, nullptr, nullptr),
              CAROM_OK);
}

/// Frees the objects of a test.
struct Handles {
    carom_scene* scene = nullptr;
    carom_record* record = nullptr;
    ~Handles() {
        carom_scene_free(scene);
        carom_record_free(record);
    }
};

TEST(CApi, ARecordIsVerified) {
    const auto scene = shipped_scene("draw");
    const RecordPtr shot = played(scene.get());
    char broken[200] = "?";
    EXPECT_EQ(carom_record_verify(shot.get(), broken, sizeof broken), 0u);
    EXPECT_STREQ(broken, "");
    std::string text(carom_record_text(shot.get(), nullptr, 0), ' ');
    carom_record_text(shot.get(), text.data(), text.size() + 1);
    const auto check = [&](const std::string& changed) {
        Handles read;
        EXPECT_EQ(carom_record_parse(changed.c_str(), scene.get(), &read.record), CAROM_OK);
        return carom_record_verify(read.record, broken, sizeof broken);
    };
    EXPECT_EQ(check(text), 0u);
    std::string late = text;
    late.replace(late.find("\"type\":\"ball_ball\""), 18, "\"type\":\"ball_ball_hold\"");
    EXPECT_GT(check(late), 0u);
    EXPECT_EQ(std::string(broken).substr(0, 3), "U5 ") << broken;
    std::string other = text;
    other.replace(other.find("\"gravity\": 9.81"), 15, "\"gravity\": 9.80");
    EXPECT_EQ(check(other), static_cast<std::size_t>(-1));
    EXPECT_NE(std::string(carom_last_error()).find("gravity is 9.8, and 9.81 in the scene"),
              std::string::npos);
}

TEST(CApi, AShotMatchesTheEngine) {
    const RecordPtr c = played(shipped_scene("eight_ball_break").get());
    const Record record =
        simulate(make_plan(read_scene(CAROM_SOURCE_DIR "/scenes/eight_ball_break.toml"), kernel::best_isa()));
    char hash[17];
    ASSERT_EQ(carom_record_hash(c.get(), hash), CAROM_OK);
    EXPECT_EQ(hash, record.hash());
    EXPECT_EQ(carom_record_duration(c.get()), record.duration);
    ASSERT_EQ(carom_record_event_count(c.get()), record.events.size());
    ASSERT_EQ(carom_record_ball_count(c.get()), 16u);
    EXPECT_STREQ(carom_record_ball_id(c.get(), 0), "cue");
    EXPECT_EQ(carom_record_ball_id(c.get(), 16), nullptr);
    for (std::size_t i = 0; i < record.events.size(); ++i) {
        carom_event event;
        ASSERT_EQ(carom_record_event(c.get(), i, &event), CAROM_OK);
        EXPECT_EQ(event.time, record.events[i].time);
        EXPECT_STREQ(event.type, name(record.events[i].type));
        EXPECT_EQ(event.b, record.partner_id(record.events[i]));
    }
    double rvw[9];
    const char* state = nullptr;
    ASSERT_EQ(carom_record_state(c.get(), 3, 1.25, rvw, &state), CAROM_OK);
    const BallState s = record.state_at(3, 1.25);
    EXPECT_EQ(Vec3(rvw[0], rvw[1], rvw[2]), s.position);
    EXPECT_EQ(Vec3(rvw[3], rvw[4], rvw[5]), s.velocity);
    EXPECT_EQ(Vec3(rvw[6], rvw[7], rvw[8]), s.spin);
    EXPECT_STREQ(state, name(s.state));

    carom_event event;
    EXPECT_EQ(carom_record_event(c.get(), record.events.size(), &event), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_record_state(c.get(), 16, 0.0, rvw, nullptr), CAROM_BAD_ARGUMENT);
    EXPECT_STREQ(carom_last_error(), "ball 16 is out of range; there are 16");
    EXPECT_EQ(carom_record_state(c.get(), 0, std::nan(""), rvw, nullptr), CAROM_BAD_ARGUMENT);
}

TEST(CApi, AStateReadCanBeSet) {
    Handles h, again;
    const double start[9] = {0.6, 0.7, kPoolR, 0.3, 1.5, 0, -20, 3, 11}, other[9] = {0.65, 1.6, kPoolR};
    ASSERT_EQ(carom_scene_create("nine_foot", "pool", &h.scene), CAROM_OK);
    ASSERT_EQ(carom_scene_set_ball(h.scene, "a", start), CAROM_OK);
    ASSERT_EQ(carom_scene_set_ball(h.scene, "b", other), CAROM_OK);
    ASSERT_EQ(carom_simulate(h.scene, 0.3, &h.record), CAROM_OK) << carom_last_error();
    EXPECT_EQ(carom_record_duration(h.record), 0.3);
    ASSERT_EQ(carom_scene_create("nine_foot", "pool", &again.scene), CAROM_OK);
    for (std::size_t i = 0; i < 2; ++i) {
        double rvw[9];
        ASSERT_EQ(carom_record_state(h.record, i, 0.3, rvw, nullptr), CAROM_OK);
        ASSERT_EQ(carom_scene_set_ball(again.scene, carom_record_ball_id(h.record, i), rvw), CAROM_OK);
    }
    ASSERT_EQ(carom_simulate(again.scene, -1.0, &again.record), CAROM_OK) << carom_last_error();
    EXPECT_GT(carom_record_event_count(again.record), 3u);
}

TEST(CApi, ExplainsABadScene) {
    Handles h;
    EXPECT_EQ(carom_scene_parse("[ball]\n", "x.toml", &h.scene), CAROM_BAD_SCENE);
    EXPECT_EQ(std::string(carom_last_error()).rfind("x.toml:1:1: ", 0), 0u) << carom_last_error();
    EXPECT_EQ(h.scene, nullptr);
    EXPECT_EQ(carom_scene_read("/no/such/scene.toml", &h.scene), CAROM_BAD_SCENE);
    EXPECT_EQ(carom_scene_create("twenty_foot", "pool", &h.scene), CAROM_BAD_ARGUMENT);
    ASSERT_EQ(carom_scene_create("", "pool", &h.scene), CAROM_OK);
    EXPECT_EQ(carom_simulate(h.scene, -1.0, &h.record), CAROM_BAD_SCENE);
    EXPECT_EQ(h.record, nullptr);
    const double low[9] = {0, 0, 0}, fine[9] = {0, 0, kPoolR};
    ASSERT_EQ(carom_scene_set_ball(h.scene, "cue", low), CAROM_OK);
    EXPECT_EQ(carom_simulate(h.scene, -1.0, &h.record), CAROM_BAD_SCENE);
    EXPECT_NE(std::string(carom_last_error()).find("set z to the sum of the two"), std::string::npos)
        << carom_last_error();
    ASSERT_EQ(carom_scene_set_ball(h.scene, "cue", fine), CAROM_OK);
    carom_cue cue;
    carom_cue_init(&cue);
    cue.side = 0.9;
    ASSERT_EQ(carom_scene_set_cue(h.scene, "cue", &cue), CAROM_OK);
    EXPECT_EQ(carom_simulate(h.scene, -1.0, &h.record), CAROM_BAD_SCENE);
    EXPECT_NE(std::string(carom_last_error()).find("cue.offset"), std::string::npos) << carom_last_error();
    ASSERT_EQ(carom_scene_set_cue(h.scene, nullptr, nullptr), CAROM_OK);
    EXPECT_EQ(carom_scene_set_ball_param(h.scene, "mu", 0.1), CAROM_BAD_ARGUMENT);
    ASSERT_EQ(carom_scene_set_ball_param(h.scene, "mu_s", -0.1), CAROM_OK);
    EXPECT_EQ(carom_simulate(h.scene, -1.0, &h.record), CAROM_BAD_SCENE);
    ASSERT_EQ(carom_scene_set_ball_param(h.scene, "mu_s", 0.1), CAROM_OK);
    ASSERT_EQ(carom_scene_set_ball_param(h.scene, "mu_r", 0.11), CAROM_OK);
    EXPECT_EQ(carom_simulate(h.scene, -1.0, &h.record), CAROM_BAD_SCENE);
    EXPECT_NE(std::string(carom_last_error()).find("balls.mu_r = 0.11 is above balls.mu_s = 0.1"),
              std::string::npos)
        << carom_last_error();
    ASSERT_EQ(carom_scene_set_ball_param(h.scene, "mu_r", 0.01), CAROM_OK);
    ASSERT_EQ(carom_scene_set_ball_param(h.scene, "radius", 0.03), CAROM_OK);
    double radius = 0.0;
    ASSERT_EQ(carom_scene_get_ball_param(h.scene, "radius", &radius), CAROM_OK);
    EXPECT_EQ(radius, 0.03);
    EXPECT_EQ(carom_simulate(h.scene, -1.0, &h.record), CAROM_OK) << carom_last_error();
}

TEST(CApi, EndlessMotionContinuesToTheCallsTimeLimit) {
    // No cushion is within reach of one ball; the other only spins.
    for (const char* text : {"[stop]\ntime = 0.2\n[physics]\ngravity = 0\n[[ball]]\nvelocity = [1, 0]\n",
                             "[stop]\nevents = 7\n[balls]\nmu_sp = 0\n[[ball]]\nspin = [0, 0, 5]\n"}) {
        const RecordPtr record = played(parsed(text).get(), 0.1);
        EXPECT_EQ(carom_record_duration(record.get()), 0.1) << text;
        double start[9], end[9];
        ASSERT_EQ(carom_record_state(record.get(), 0, 0.0, start, nullptr), CAROM_OK);
        ASSERT_EQ(carom_record_state(record.get(), 0, 0.1, end, nullptr), CAROM_OK);
        EXPECT_NEAR(end[0] - start[0], 0.1 * start[3], 1e-15) << text;
    }
}

TEST(CApi, EveryBallParameterHasAName) {
    const ScenePtr scene = parsed(
        "[balls]\nmu_b_fit = [0.009951, 0.108, 1.088]\n[physics]\nball_ball = \"inelastic\"\n"
        "[[ball]]\nid = \"a\"\nradius = 0.03\nmass = 0.2\n");
    const auto get = [&](const char* name) {
        double value = -1.0;
        EXPECT_EQ(carom_scene_get_ball_param(scene.get(), name, &value), CAROM_OK) << carom_last_error();
        return value;
    };
    EXPECT_EQ(get("mu_b"), 0.009951);
    EXPECT_EQ(get("mu_b_more"), 0.108);
    EXPECT_EQ(get("mu_b_fall"), 1.088);
    ASSERT_EQ(carom_scene_set_ball_param(scene.get(), "mu_b_more", 0.2), CAROM_OK);
    EXPECT_EQ(get("mu_b_more"), 0.2);
    // A number replaces the fit, as in a scene file.
    ASSERT_EQ(carom_scene_set_ball_param(scene.get(), "mu_b", 0.05), CAROM_OK);
    EXPECT_EQ(get("mu_b"), 0.05);
    EXPECT_EQ(get("mu_b_more"), 0.0);
    EXPECT_EQ(get("mu_b_fall"), 0.0);
    // Each parameter is separate: none changes another.
    const char* names[] = {"radius",    "mass",      "mu_s", "mu_r", "mu_sp", "mu_b",
                           "mu_b_more", "mu_b_fall", "e_b",  "e_c",  "f_c"};
    double next = 0.01;
    for (const char* name : names)
        ASSERT_EQ(carom_scene_set_ball_param(scene.get(), name, next += 0.01), CAROM_OK) << name;
    next = 0.01;
    for (const char* name : names) EXPECT_EQ(get(name), next += 0.01) << name;
}

TEST(CApi, ABallKeepsItsOwnRadiusAndMass) {
    const ScenePtr scene = parsed(
        "[physics]\nball_ball = \"elastic\"\n[[ball]]\nid = \"a\"\nposition = [0.6, 1]\nradius = 0.04\nmass "
        "= 0.2\n"
        "[[ball]]\nid = \"b\"\nposition = [0.6, 2]\n");
    ASSERT_EQ(carom_scene_set_ball_param(scene.get(), "radius", 0.03), CAROM_OK);
    double rvw[9];
    ASSERT_EQ(carom_record_state(played(scene.get()).get(), 0, 0.0, rvw, nullptr), CAROM_OK);
    EXPECT_EQ(rvw[2], 0.04);
    const double elsewhere[9] = {0.5, 1.5, 0.04};
    ASSERT_EQ(carom_scene_set_ball(scene.get(), "a", elsewhere), CAROM_OK);
    ASSERT_EQ(carom_record_state(played(scene.get()).get(), 0, 0.0, rvw, nullptr), CAROM_OK);
    EXPECT_EQ(rvw[1], 1.5);
    EXPECT_EQ(rvw[2], 0.04);
}

TEST(CApi, AFailedRunHasAMessage) {
    const ScenePtr scene = parsed(
        "[balls]\nmu_s = 0.6\nmu_b = 4\n[physics]\nsubsteps = 10\n[stop]\ntime = 1\n"
        "[[ball]]\nid = \"a\"\nposition = [0.6, 1]\nvelocity = [0, 1]\nspin = [-1e6, 0, 0]\n"
        "[[ball]]\nid = \"b\"\nposition = [0.6, 1.06]\n");
    carom_record* record = nullptr;
    EXPECT_EQ(carom_simulate(scene.get(), -1.0, &record), CAROM_FAILED);
    EXPECT_EQ(record, nullptr);
    EXPECT_NE(std::string(carom_last_error()).find("the impact of a and b could not be computed"),
              std::string::npos);
    EXPECT_EQ(carom_simulate(scene.get(), std::nan(""), &record), CAROM_BAD_ARGUMENT);
}

TEST(CApi, AnUnknownInstructionSetIsRefused) {
    const double one[9] = {0, 0, kPoolR, 0, 1, 0}, two[9] = {0, 2 * kPoolR, kPoolR};
    double after1[9], after2[9];
    ::setenv("CAROM_ISA", "v9", 1);
    EXPECT_EQ(carom_collide_balls(one, two, &kParams, 1e-6, after1, after2), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(std::string(carom_last_error()).rfind("CAROM_ISA", 0), 0u) << carom_last_error();
    ::unsetenv("CAROM_ISA");
    EXPECT_EQ(carom_collide_balls(one, two, &kParams, 1e-6, after1, after2), CAROM_OK);
}

TEST(CApi, WritesTheSceneAsAFile) {
    Handles h, again;
    const double at[9] = {0.5, 0.5, kPoolR};
    ASSERT_EQ(carom_scene_create("seven_foot", "pool", &h.scene), CAROM_OK);
    ASSERT_EQ(carom_scene_set_ball(h.scene, "cue", at), CAROM_OK);
    const std::size_t length = carom_scene_text(h.scene, nullptr, 0);
    std::string text(length + 1, '?');
    EXPECT_EQ(carom_scene_text(h.scene, text.data(), text.size()), length);
    EXPECT_EQ(text.back(), '\0');
    text.pop_back();
    EXPECT_EQ(carom_scene_parse(text.c_str(), "again", &again.scene), CAROM_OK) << carom_last_error();
    char few[8];
    EXPECT_EQ(carom_scene_text(h.scene, few, sizeof few), length);
    EXPECT_EQ(std::string(few), "[table]");
    EXPECT_EQ(carom_scene_text(nullptr, nullptr, 0), static_cast<std::size_t>(-1));
}

// A default cue is the same in a file, in C++ and in C.
TEST(CApi, TheDefaultCueMatchesSceneFilesAndCpp) {
    carom_cue c;
    carom_cue_init(&c);
    const Cue file = *parse_scene("[[ball]]\n[cue]\n", "x").cue, cpp;
    for (const Cue& cue : {file, cpp}) {
        EXPECT_EQ(cue.ball, "cue");
        EXPECT_EQ(cue.speed, 9.0);
        EXPECT_EQ(cue.height, 0.1);
        EXPECT_EQ(cue.speed, c.speed);
        EXPECT_EQ(cue.aim_deg, c.aim_deg);
        EXPECT_EQ(cue.elevation_deg, c.elevation_deg);
        EXPECT_EQ(cue.side, c.side);
        EXPECT_EQ(cue.height, c.height);
        EXPECT_EQ(cue.mass, c.mass);
        EXPECT_EQ(cue.end_mass, c.end_mass);
        EXPECT_EQ(cue.restitution, c.restitution);
    }
}

// Without a cue, whatever the defaults, the ball stays.
TEST(CApi, WithoutACueTheBallStays) {
    Scene scene = parse_scene("[[ball]]\n", "x");
    EXPECT_FALSE(scene.cue);
    scene.cue = Cue{};
    EXPECT_EQ(scene_text(scene), scene_text(parse_scene("[[ball]]\n[cue]\n", "x")));
    const ScenePtr bare = parsed("[[ball]]\n[cue]\n");
    ASSERT_EQ(carom_scene_set_cue(bare.get(), nullptr, nullptr), CAROM_OK);
    EXPECT_EQ(carom_record_event_count(played(bare.get()).get()), 0u);
}

TEST(CApi, NullArgumentsAreRefused) {
    carom_cue_init(nullptr);
    carom_scene_free(nullptr);
    carom_record_free(nullptr);
    EXPECT_EQ(carom_record_duration(nullptr), 0.0);
    EXPECT_EQ(carom_record_ball_count(nullptr), 0u);
    EXPECT_EQ(carom_record_event_count(nullptr), 0u);
    EXPECT_EQ(carom_record_ball_id(nullptr, 0), nullptr);
    EXPECT_EQ(carom_simulate(nullptr, 0.0, nullptr), CAROM_BAD_ARGUMENT);
    carom_record* record = nullptr;
    EXPECT_EQ(carom_simulate(nullptr, 0.0, &record), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_record_hash(nullptr, nullptr), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(carom_scene_set_ball(nullptr, nullptr, nullptr), CAROM_BAD_ARGUMENT);
}

TEST(CApi, EachThreadHasItsOwnMessage) {
    EXPECT_EQ(carom_scene_create("twenty_foot", "pool", nullptr), CAROM_BAD_ARGUMENT);
    const std::string mine = carom_last_error();
    std::thread([] { EXPECT_STREQ(carom_last_error(), ""); }).join();
    EXPECT_EQ(carom_last_error(), mine);
    EXPECT_STREQ(carom_version(), CAROM_VERSION);
}

}  // namespace
}  // namespace carom::test
