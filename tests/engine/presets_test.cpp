// Presets of balls, cloths and cues: their values, overrides by a file, and comparison with measurements on
// real tables (docs/reference/physics.md, "Where the numbers come from"), including the models' known misses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/cushion.h"
#include "carom/engine/simulate.h"
#include "carom/engine/verify.h"

namespace {

using carom::EventType;
using carom::parse_scene;
using carom::Record;
using carom::Scene;
using carom::Segment;

const std::string kBall = "[[ball]]\nposition = [0.6, 0.5]\n";

Record run(const std::string& text) {
    return simulate(make_plan(carom::parse_scene(text, "preset.toml"), carom::kernel::Isa::kScalar));
}

const carom::Event& first(const Record& r, EventType type) {
    for (const carom::Event& e : r.events)
        if (e.type == type) return e;
    throw std::runtime_error("there is no such event");
}

/// Speeds of a ball that rolled straight into a cushion at `v` [m/s]: just after it, and once rolling again.
/// `keys` go to [balls].
std::pair<double, double> rebound(const std::string& preset, double v, const std::string& keys = "") {
    const bool snooker = preset.rfind("snooker", 0) == 0;
    const double R = carom::make_ball_params(preset).R, height = snooker ? 0.03675 : 0.037;
    const Record r =
        run(fmt::format("[table]\n[[table.cushion]]\nfrom = [-1, 1]\nto = [1, 1]\nheight = {}\n"
                        "[balls]\npreset = \"{}\"\nmu_r = 1e-9\n{}\n"
                        "[[ball]]\nposition = [0, {}]\nvelocity = [0, {}]\nspin = [{}, 0, 0]\n"
                        "[stop]\ntime = 3\n",
                        height, preset, keys, 0.999 - R, v, -v / R));
    const double hit = first(r, EventType::kBallCushion).time;
    double at_once = 0.0;
    for (const Segment& s : r.tracks[0].segments) {
        if (s.start < hit) continue;
        if (at_once == 0.0) at_once = s.v.norm();
        if (s.state == carom::MotionState::kRolling) return {at_once, s.v.norm()};
    }
    return {at_once, 0.0};
}

// Ratio of the speed when rolling again to the speed before, from 68 impacts of a three-cushion match; each
// median is known to 0.012.
TEST(Presets, CaromCushionMatchesTheMeasurement) {
    const double measured[][2] = {{0.54, 0.598}, {0.70, 0.589}, {0.85, 0.583},
                                  {1.12, 0.581}, {1.44, 0.568}, {1.86, 0.573}};
    for (const auto& [v, ratio] : measured) EXPECT_NEAR(rebound("carom", v).second / v, ratio, 0.012) << v;
    EXPECT_LT(rebound("carom_classic", 0.54).second / 0.54, 0.598 - 0.024);
}

// Mathavan, Jackson, Parkin (2009): speeds just after the impact, each within 0.05 m/s.
TEST(Presets, SnookerCushionMatchesTheMeasurement) {
    for (const auto& [v, speed] :
         {std::pair{1.0, 0.948}, {1.5, 1.404}, {2.0, 1.816}, {2.5, 2.184}, {3.0, 2.508}, {3.5, 2.789}})
        EXPECT_NEAR(rebound("snooker", v).first, speed, 0.05) << v;
    // The free-ball impulse model loses a quarter of the speed to the slate.
    EXPECT_LT(rebound("snooker_classic", 1.0).first, 0.948 - 0.2);
}

/// [degrees] Throw of the object ball by a cue ball without spin.
double throw_at(const std::string& keys, double v, double cut_deg) {
    const double R = carom::make_ball_params("pool").R, cut = cut_deg * std::numbers::pi / 180.0;
    const double x = 2.0 * R * std::sin(cut), y = 2.0 * R * std::cos(cut) + 1e-7;
    const Record r = run(
        fmt::format("[table]\ncushion = []\n[balls]\n{}\n[[ball]]\nposition = [0, 0]\nvelocity = [0, {}]\n"
                    "[[ball]]\nid = \"1\"\nposition = [{}, {}]\n",
                    keys, v, x, y));
    const auto after = r.state_at(1, first(r, EventType::kBallBall).time).velocity;
    return (cut - std::atan2(after.x(), after.y())) * 180.0 / std::numbers::pi;
}

// D. Alciatore, Billiards Digest 9/2006: stun shots, in degrees.
TEST(Presets, PoolBallsThrowAsMeasured) {
    for (const double v : {0.447, 1.341, 3.129}) EXPECT_NEAR(throw_at("", v, 10.0), 1.5, 0.5) << v;
    EXPECT_NEAR(throw_at("", 0.447, 35.0), 5.5, 0.5);
    EXPECT_LT(throw_at("", 3.129, 30.0), 0.5 * throw_at("", 0.447, 30.0));
    // A single friction halves the throw and makes it the same at every speed, except for the turning of the
    // line of centres during the contact.
    EXPECT_LT(throw_at("preset = \"pool_classic\"", 0.447, 35.0), 3.0);
    EXPECT_NEAR(throw_at("preset = \"pool_classic\"", 3.129, 35.0),
                throw_at("preset = \"pool_classic\"", 0.447, 35.0), 0.2);
}

// The laws themselves: friction depends on the slip at the nose, restitution on the normal speed.
TEST(Presets, CushionFitsFollowTheirFormulas) {
    carom::BallParams p = carom::make_ball_params("pool");
    p.f_c = 0.1, p.f_c_more = 0.2, p.f_c_fall = 0.5;
    p.e_c = 0.9, p.e_c_fall = 0.1, p.e_c_above = 1.0;
    const carom::Vec2 normal(0.0, -1.0);
    const auto contact = [&](double v, double w_z) {
        return cushion_contact(p, p.size(), p.R, normal, {0.3, v, 0.0}, {0.0, 0.0, w_z});
    };
    // With the nose at centre height the slip is the speed along the cushion, v_x - R w_z.
    EXPECT_NEAR(contact(0.5, -40.0).f_c, 0.1 + 0.2 * std::exp(-0.5 * (0.3 + 40.0 * p.R)), 1e-15);
    EXPECT_EQ(contact(0.5, 0.0).e_c, 0.9);
    EXPECT_NEAR(contact(3.0, 0.0).e_c, 0.7, 1e-15);
    EXPECT_EQ(contact(20.0, 0.0).e_c, 0.0);
}

// Against a nose above its equator, a resting ball's centre is less than R from the nose line.
TEST(Presets, CushionTouch) {
    const std::string table =
        "[table]\n[[table.cushion]]\nfrom = [-1, 1]\nto = [1, 1]\nheight = 0.03675\n"
        "[balls]\npreset = \"snooker\"\n[physics]\ncushion_touch = \"{}\"\n";
    const double R = 0.02625, near = std::sqrt(0.03675 * (2.0 * R - 0.03675));
    const auto met = [&](const char* touch) {
        const carom::Plan plan =
            make_plan(parse_scene(fmt::format(fmt::runtime(table), touch) +
                                      "[[ball]]\nposition = [0, 0.5]\nvelocity = [0, 1]\n",
                                  "touch.toml"),
                      carom::kernel::Isa::kScalar);
        const Record r = simulate(plan);
        EXPECT_FALSE(verify(r, plan));
        return 1.0 - r.state_at(0, first(r, EventType::kBallCushion).time).position.y();
    };
    EXPECT_NEAR(met("radius"), R, 1e-14);
    EXPECT_NEAR(met("nose"), near, 1e-14);
    EXPECT_NEAR(R - near, 0.00219, 5e-6);
    // A ball may also start there and stay.
    EXPECT_NO_THROW(run(fmt::format(fmt::runtime(table), "nose") +
                        fmt::format("[[ball]]\nposition = [0, {}]\nvelocity = [1, 0]\n", 1.0 - near)));
    EXPECT_THROW(run(fmt::format(fmt::runtime(table), "radius") +
                     fmt::format("[[ball]]\nposition = [0, {}]\n", 1.0 - near)),
                 carom::SceneError);
}

// A leather tip gives the ball 1.73 / 2 of the speed from a lossless tip.
TEST(Presets, ALeatherTipLosesSpeed) {
    const auto speed = [](const std::string& keys) {
        return run("[[ball]]\n[cue]\nspeed = 2\n" + keys).state_at(0, 0.0).velocity.norm();
    };
    EXPECT_NEAR(speed("") / speed("preset = \"lossless\"\n"), 0.865, 1e-15);
    EXPECT_NEAR(speed("preset = \"break\"\n") / speed("preset = \"lossless\"\n"), 0.92, 1e-15);
}

std::vector<double> cushion_of(const carom::BallParams& p) {
    return {p.e_c, p.e_c_fall, p.e_c_above, p.f_c, p.f_c_more, p.f_c_fall};
}

// The measured coefficients, and the game's cushion model.
TEST(Presets, BallPresets) {
    const Scene snooker = parse_scene("[balls]\npreset = \"snooker\"\n" + kBall, "preset.toml");
    EXPECT_EQ(snooker.balls.R, 0.02625);
    EXPECT_EQ(snooker.balls.m, 0.140);
    EXPECT_EQ(snooker.balls.mu_r, 0.0128);
    EXPECT_EQ(cushion_of(snooker.balls), (std::vector<double>{1.0, 0.08, 1.7, 0.14, 0.0, 0.0}));
    EXPECT_STREQ(name(snooker.physics.cushion), "mathavan_2010");
    const Scene carom = parse_scene("[balls]\npreset = \"carom\"\nmass = 0.2\n" + kBall, "preset.toml");
    EXPECT_EQ(carom.balls.R, 0.03075);
    EXPECT_EQ(carom.balls.m, 0.2);
    EXPECT_EQ(carom.balls.mu_r, 0.0045);
    EXPECT_EQ(cushion_of(carom.balls), (std::vector<double>{0.9, 0.02, 0.0, 0.19, 0.23, 0.7}));
    EXPECT_STREQ(name(carom.physics.cushion), "han_2005");
    EXPECT_EQ(carom::make_ball_params("carom").m, 0.21);
    EXPECT_THROW(carom::make_ball_params("marble"), std::invalid_argument);
}

TEST(Presets, ExplicitKeysOverrideThePreset) {
    const Scene s = parse_scene(
        "[balls]\npreset = \"snooker\"\nmu_r = 0.02\ne_c = 0.9\n[physics]\ncushion = \"han_2005\"\n" + kBall,
        "preset.toml");
    EXPECT_EQ(s.balls.mu_r, 0.02);
    EXPECT_EQ(cushion_of(s.balls), (std::vector<double>{0.9, 0.0, 0.0, 0.14, 0.0, 0.0}));
    EXPECT_STREQ(name(s.physics.cushion), "han_2005");
}

// The coefficients from before the measured ones: sizes differ, the rest is shared.
TEST(Presets, ClassicPresets) {
    for (const char* game : {"pool", "snooker", "carom"}) {
        const Scene s =
            parse_scene(fmt::format("[balls]\npreset = \"{}_classic\"\n", game) + kBall, "preset.toml");
        const carom::BallParams measured = carom::make_ball_params(game), &p = s.balls;
        EXPECT_EQ((std::vector<double>{p.R, p.m}), (std::vector<double>{measured.R, measured.m}));
        EXPECT_EQ((std::vector<double>{p.mu_s, p.mu_r, p.mu_sp, p.mu_b, p.mu_b_more, p.e_b, p.e_c, p.f_c}),
                  (std::vector<double>{0.2, 0.01, 0.0127, 0.05, 0.0, 0.95, 0.85, 0.2}));
        EXPECT_STREQ(name(s.physics.cushion), "han_2005");
    }
}

// A number replaces the preset's fit, and a fit the preset's number.
TEST(Presets, OneFormOfFrictionReplacesTheOther) {
    const Scene number = parse_scene("[balls]\nmu_b = 0.05\n" + kBall, "preset.toml");
    EXPECT_EQ(number.balls.mu_b, 0.05);
    EXPECT_EQ(number.balls.mu_b_more, 0.0);
    EXPECT_EQ(number.balls.mu_b_fall, 0.0);
    const Scene fit =
        parse_scene("[balls]\npreset = \"carom\"\nmu_b_fit = [0.01, 0.1, 1.0]\n" + kBall, "preset.toml");
    EXPECT_EQ(fit.balls.mu_b, 0.01);
    EXPECT_EQ(fit.balls.mu_b_more, 0.1);
    EXPECT_EQ(fit.balls.mu_b_fall, 1.0);
}

TEST(Presets, ClothsByName) {
    const auto mu_r = [](const std::string& text) {
        return parse_scene(text + kBall, "preset.toml").balls.mu_r;
    };
    EXPECT_EQ(mu_r("[table]\ncloth = \"club\"\n"), 0.01);
    EXPECT_EQ(mu_r("[table]\ncloth = \"tournament\"\n"), 0.0075);
    EXPECT_EQ(mu_r("[table]\npreset = \"carom\"\ncloth = \"match_heated\"\n"), 0.0045);
    EXPECT_EQ(mu_r("[table]\ncushion = []\ncloth = \"tournament\"\n"), 0.0075);
    EXPECT_EQ(mu_r("[table]\ncloth = \"tournament\"\n[balls]\nmu_r = 0.02\n"), 0.02);
    EXPECT_EQ(mu_r("[table]\ncloth = \"tournament\"\n[balls]\npreset = \"snooker\"\n"), 0.0075);
}

TEST(Presets, CuesByKind) {
    const auto cue = [](const std::string& text) {
        return *parse_scene(kBall + "[cue]\n" + text, "preset.toml").cue;
    };
    EXPECT_EQ(cue("preset = \"plain\"").end_mass, 0.00844);
    EXPECT_EQ(cue("preset = \"break\"").restitution, 0.84);
    EXPECT_EQ(cue("preset = \"lossless\"").restitution, 1.0);
    const carom::Cue own = cue("mass = 0.5\npreset = \"plain\"\nrestitution = 0.7");
    EXPECT_EQ((std::vector<double>{own.mass, own.end_mass, own.restitution}),
              (std::vector<double>{0.5, 0.00844, 0.7}));
}

TEST(Presets, SomeCueBallsHaveTheirOwnSize) {
    const std::string balls =
        "[[ball]]\nposition = [0.6, 0.5]\n[[ball]]\nid = \"1\"\nposition = [0.6, 1.0]\n";
    const auto scene = [&](const std::string& text) {
        const Scene read = parse_scene(balls + text, "preset.toml");
        const std::string written = carom::scene_text(read);
        EXPECT_EQ(carom::scene_text(parse_scene(written, "preset.toml")), written) << text;
        return read;
    };
    const Scene bar = scene("[balls]\npreset = \"bar_box_oversized\"\n");
    EXPECT_NEAR(bar.size_of(bar.ball[0]).R, 0.0603 / 2.0, 2e-5);
    EXPECT_NEAR(bar.size_of(bar.ball[0]).m, 0.200, 1e-3);
    EXPECT_EQ(bar.ball[0].position.z(), bar.size_of(bar.ball[0]).R);
    EXPECT_FALSE(bar.ball[1].own);
    const Scene heavy = scene("[balls]\npreset = \"bar_box_heavy\"\n");
    EXPECT_EQ(heavy.size_of(heavy.ball[0]).R, heavy.balls.R);
    EXPECT_NEAR(heavy.size_of(heavy.ball[0]).m, 0.191, 1e-3);
    const Scene pub = scene("[balls]\npreset = \"english_pool\"\n");
    EXPECT_NEAR(pub.balls.R, 0.0508 / 2.0, 1e-12);
    EXPECT_NEAR(pub.size_of(pub.ball[0]).R, 0.0476 / 2.0, 2e-5);
    EXPECT_LT(pub.size_of(pub.ball[0]).m, pub.balls.m);
    // Any preset may have one, and this preset's may be overridden in part.
    const Scene own = scene("[balls]\npreset = \"pool\"\n[balls.cue]\nmass = 0.2\n");
    EXPECT_EQ(own.size_of(own.ball[0]), (carom::BallSize{own.balls.R, 0.2}));
    const Scene part = scene("[balls]\npreset = \"bar_box_oversized\"\ncue = { mass = 0.21 }\n");
    EXPECT_EQ(part.size_of(part.ball[0]), (carom::BallSize{bar.size_of(bar.ball[0]).R, 0.21}));
    // It is the ball that the cue strikes.
    const Scene other = scene("[balls]\npreset = \"bar_box_heavy\"\n[cue]\nball = \"1\"\n");
    EXPECT_FALSE(other.ball[0].own);
    EXPECT_TRUE(other.ball[1].own);
    // The ball's own size wins, even if it equals the common one.
    const Scene plain = parse_scene(
        "[[ball]]\nradius = 0.028575\nmass = 0.170097\n"
        "[balls]\npreset = \"bar_box_oversized\"\n",
        "preset.toml");
    EXPECT_FALSE(plain.ball[0].own);
    EXPECT_FALSE(parse_scene(carom::scene_text(plain), "preset.toml").ball[0].own);
}

}  // namespace
