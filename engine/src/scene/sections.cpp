#include "scene/sections.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/plan.h"
#include "carom/engine/strike.h"
#include "carom/engine/tolerances.h"
#include "carom/kernel/tolerance.h"
#include "scene/rack.h"

namespace carom {
namespace detail {
namespace {

// [m] Mean gap of balls in a wooden triangle.
constexpr double kTriangleGap = 5e-5;
// [-] Largest balls.radius_sd, of the radius: balls that differ more do not form rows.
constexpr double kMostOfRadius = 0.005;

BallStart read_ball(const Section& s, const BallSize& common, const std::optional<BallSize>& cue_ball,
                    const std::string& cue_id) {
    BallStart ball;
    ball.where = s.where();
    s.read(kBallStartFields, ball);
    BallSize size = cue_ball && ball.id == cue_id ? *cue_ball : common;
    s.read(kSizeFields, size);
    if (!(size == common)) ball.own = size;
    check_id(s, ball.id);
    ball.position.z() = size.R + ball.height;
    return ball;
}

/// The keys of a section whose rows are in two tables.
std::vector<std::string_view> joined(std::vector<std::string_view> keys,
                                     const std::vector<std::string_view>& more) {
    keys.insert(keys.end(), more.begin(), more.end());
    return keys;
}

std::optional<Section> balls_section(const Section& top) {
    auto keys = joined(keys_of(kBallPresetFields, Files::kScene), keys_of(kBallFields, Files::kScene));
    keys = joined(std::move(keys), keys_of(kRackedBallFields, Files::kScene));
    keys.emplace_back("cue");
    return top.section("balls", keys);
}

/// The keys that the method of a rack sets, and those that it excludes.
void apply_method(const Section& s, Rack& rack) {
    if (rack.method == RackMethod::kGap) return;
    for (const RackGame game :
         {RackGame::kThreeCushion, RackGame::kFourBall, RackGame::kLine, RackGame::kScatter})
        if (rack.game == game)
            s.fail("method",
                   "rack.method applies only to balls racked in rows; leave it out or choose another game");
    if (rack.method == RackMethod::kTriangle) {
        if (!s.has("gap")) rack.gap = kTriangleGap;
        if (!s.has("jitter")) rack.jitter = kTriangleGap;
        return;
    }
    for (const char* key : {"gap", "jitter"})
        if (s.has(key))
            s.fail(key,
                   "rack.{} cannot be combined with a template, which closes all contacts; leave out rack.{} "
                   "or rack.method",
                   key, key);
    rack.gap = 0.0;
}

/// Puts the balls of a rack after the others.
void place_rack(const Section& top, const Section& s, const Rack& rack, Scene& scene) {
    if (rack.radius_sd > kMostOfRadius * scene.balls.R)
        top.fail(top.where("balls", "radius_sd"),
                 "balls.radius_sd = {} is more than a 200th of the radius, {} m; make it smaller",
                 rack.radius_sd, scene.balls.R);
    const bool lattice = rack.radius_sd > 0.0 && rack.game != RackGame::kScatter;
    if (lattice && balls_of(rack) > kMaxPressedBalls)
        s.fail(s.has("rows") ? "rows" : "count",
               "at most {} balls of different size can be racked, not {}; leave some out", kMaxPressedBalls,
               balls_of(rack));
    const bool scatter = rack.game == RackGame::kScatter;
    if (s.has("count") && rack.game != RackGame::kLine && !scatter)
        s.fail("count",
               "rack.count belongs to the games line and scatter; leave it out or set game = \"line\"");
    if (s.has("rows") && rack.game != RackGame::kTriangle)
        s.fail("rows", "rack.rows belongs to the game triangle; leave it out or set game = \"triangle\"");
    const bool spots = rack.game == RackGame::kSnooker || rack.game == RackGame::kThreeCushion ||
                       rack.game == RackGame::kFourBall;
    for (const char* key : {"position", "spot_ball", "angle_deg"})
        if (spots && s.has(key))
            s.fail(key, "rack.{} cannot move the balls of this game from their spots; leave it out", key);
    for (const char* key : {"jitter", "position", "spot_ball", "angle_deg"})
        if (scatter && s.has(key)) s.fail(key, "rack.{} does not apply to a scatter; leave it out", key);
    if (scatter && scene.table.preset.empty())
        s.fail("game", "a scatter needs a table by name; set table.preset");
    if (spots && !(scene.table.length > 0.0)) {
        s.fail("game",
               "this layout needs the spots of a table, and an endless cloth has none; choose a table");
    }
    if (rack.spot_ball && *rack.spot_ball > balls_of(rack))
        s.fail("spot_ball", "rack.spot_ball = {} is not in this rack; choose 1 to {}", *rack.spot_ball,
               balls_of(rack));
    std::vector<RackedBall> racked;
    try {
        racked = make_rack(rack, scene.table, scene.balls.R, scene.ball);
    } catch (const std::invalid_argument& error) {
        s.fail(s.has("count") ? "count" : "game", "{}", error.what());
    }
    for (const RackedBall& ball : racked) {
        if (scene.ball.size() == kMaxBalls)
            s.fail(s.where(), "more than {} balls; leave some out", kMaxBalls);
        BallStart start;
        start.id = ball.id;
        ball.put(start, scene.balls.size());
        start.where = s.where();
        scene.ball.push_back(start);
    }
}

}  // namespace

void read_balls(const Section& top, Scene& scene) {
    const auto s = balls_section(top);
    scene.ball_preset = balls_for(top.peek("table", "preset").value_or(""));
    if (s) s->read(kBallPresetFields, scene);
    use_balls(scene, scene.ball_preset);
    if (!s) return;
    s->read(kBallFields, scene.balls);
    for (const auto& [number, fit] : {std::pair{"mu_b", "mu_b_fit"}, std::pair{"e_c", "e_c_fit"},
                                      std::pair{"f_c", "f_c_fit"}, std::pair{"e_t", "e_t_fit"}})
        if (s->has(number) && s->has(fit))
            s->fail(fit, "balls.{} and balls.{} are two values for one coefficient; remove one", number, fit);
    check_fits(*s, scene.balls);
    BallSize cue = scene.cue_ball.value_or(scene.balls.size());
    if (s->read("cue", kSizeFields, cue)) scene.cue_ball = cue;
}

void read_ball_list(const Section& top, Scene& scene) {
    const auto tables = top.tables("ball");
    if (!tables) return;
    const auto keys = joined(keys_of(kBallStartFields, Files::kScene), keys_of(kSizeFields, Files::kScene));
    const std::string struck = top.peek("cue", "ball").value_or(Cue().ball);
    for (const toml::table* table : *tables) {
        const Section s(*table, top.file(), "ball", keys);
        if (scene.ball.size() == kMaxBalls)
            s.fail(s.where(), "more than {} balls; leave some out", kMaxBalls);
        scene.ball.push_back(read_ball(s, scene.balls.size(), scene.cue_ball, struck));
    }
}

std::optional<Section> read_rack_keys(const Section& top, Rack& rack) {
    auto s = top.read("rack", kRackFields, rack);
    if (const auto balls = balls_section(top)) balls->read(kRackedBallFields, rack);
    if (!s && rack.radius_sd > 0.0)
        top.fail(top.where("balls", "radius_sd"),
                 "balls.radius_sd applies only to racked balls; add a [rack], or give a ball its own radius");
    if (s) apply_method(*s, rack);
    return s;
}

void read_rack(const Section& top, Scene& scene) {
    Rack rack;
    if (const auto s = read_rack_keys(top, rack)) place_rack(top, *s, rack, scene);
}

void read_cue(const Section& top, Scene& scene) {
    Cue cue;
    const auto s = top.section("cue", joined(keys_of(kCueFields, Files::kScene), kAimKeys));
    if (!s) return;
    const bool automatic = top.peek("cue", "elevation_deg") == "auto";
    s->read(kCueFields, cue, automatic ? "elevation_deg" : "");
    read_aim(*s, scene, cue);
    cue.where = s->where();
    if (automatic) {
        const CueRoom room = room_for(scene, cue);
        if (!room.clears_deg)
            s->fail("elevation_deg",
                    "cue.elevation_deg = \"auto\": no elevation keeps the cue out of {}; aim "
                    "or strike elsewhere",
                    room.in);
        cue.elevation_deg = *room.clears_deg;
    }
    check_cue(*s, scene, cue);
    scene.cue = cue;
}

void read_physics(const Section& top, Scene& scene) {
    const auto s = top.read("physics", kPhysicsFields, scene.physics);
    if (s && s->has("substeps") && s->has("tolerance"))
        s->fail("substeps",
                "physics.substeps and physics.tolerance exclude each other; remove one of the two");
    check_kernel(top, scene);
}

void read_effects(const Section& top, Scene& scene) {
    std::vector<std::string_view> keywords;
    for (const EffectInfo& effect : effect_table()) keywords.push_back(effect.keyword);
    const auto s = top.section("effects", keywords);
    if (!s) return;
    for (const EffectInfo& effect : effect_table()) {
        if (const auto on = s->boolean(effect.keyword))
            scene.effects.push_back({effect.keyword, *on, s->where(effect.keyword)});
    }
}

void read_stop(const Section& top, Scene& scene) {
    top.read("stop", kStopFields, scene.stop);
}

void read_render(const Section& top, Scene& scene) {
    RenderSettings& r = scene.render;
    const auto s = top.read("render", kRenderFields, r);
    if (!s) return;
    check_camera(*s, r);
}

}  // namespace detail

void add_rack(Scene& scene, Rack rack) {
    using detail::Section;
    const Section s(scene.file, "rack");
    s.check(kRackFields, rack);
    Section(scene.file, "balls").check(kRackedBallFields, rack);
    detail::apply_method(s, rack);
    detail::place_rack(Section(scene.file, ""), s, rack, scene);
}

}  // namespace carom
