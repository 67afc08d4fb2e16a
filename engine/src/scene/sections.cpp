#include "scene/sections.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/plan.h"
#include "carom/engine/tolerances.h"
#include "carom/kernel/tolerance.h"
#include "scene/rack.h"

namespace carom::detail {
namespace {

// [ball radii] Cue offsets beyond this from the centre are refused: with chalk, a tip slips off at about
// half a radius (static friction of about 0.6 between tip and ball gives sin(atan 0.6) = 0.51), and a miscue
// is not simulated.
constexpr double kMiscueOffset = 0.5;

/// Ids go into CSV files and messages as they are.
void check_id(const Section& section, const std::string& id) {
    if (id.empty()) section.fail("id", "a ball's id is empty; give it a name");
    if (id.size() > kMaxIdLength)
        section.fail("id", "the ball id {} is longer than {} bytes; shorten it", in_quotes(id), kMaxIdLength);
    for (const char c : id) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == ',' || c == '"') {
            section.fail("id", "the ball id {} holds a comma, a quote or a control character; leave it out",
                         in_quotes(id));
        }
    }
}

BallStart read_ball(const Section& s, const BallSize& common) {
    BallStart ball;
    BallSize size = common;
    s.read(kSizeFields, size);
    if (!(size == common)) ball.own = size;
    ball.where = s.where();
    s.read(kBallStartFields, ball);
    check_id(s, ball.id);
    ball.position.z() = size.R;
    return ball;
}

/// The keys of a section whose rows stand in two tables.
std::vector<std::string_view> joined(std::vector<std::string_view> keys,
                                     const std::vector<std::string_view>& more) {
    keys.insert(keys.end(), more.begin(), more.end());
    return keys;
}

}  // namespace

void read_balls(const Section& top, Scene& scene) {
    const auto s = top.section(
        "balls", joined(keys_of(kBallPresetFields, Files::kScene), keys_of(kBallFields, Files::kScene)));
    if (s) s->read(kBallPresetFields, scene);
    use_balls(scene, scene.ball_preset);
    if (!s) return;
    s->read(kBallFields, scene.balls);
    for (const auto& [number, fit] :
         {std::pair{"mu_b", "mu_b_fit"}, std::pair{"e_c", "e_c_fit"}, std::pair{"f_c", "f_c_fit"}})
        if (s->has(number) && s->has(fit))
            s->fail(fit, "balls.{} and balls.{} are two values for one coefficient; remove one", number, fit);
    if (scene.balls.e_c > 1.0)
        s->fail("e_c_fit", "balls.e_c_fit starts at a restitution of {}; give 0 to 1", scene.balls.e_c);
}

void read_ball_list(const Section& top, Scene& scene) {
    const auto tables = top.tables("ball");
    if (!tables) return;
    const auto keys = joined(keys_of(kBallStartFields, Files::kScene), keys_of(kSizeFields, Files::kScene));
    for (const toml::table* table : *tables) {
        const Section s(*table, top.file(), "ball", keys);
        if (scene.ball.size() == kMaxBalls)
            s.fail(s.where(), "more than {} balls; leave some out", kMaxBalls);
        scene.ball.push_back(read_ball(s, scene.balls.size()));
    }
}

void read_rack(const Section& top, Scene& scene) {
    Rack rack;
    const auto s = top.read("rack", kRackFields, rack);
    if (!s) return;
    if (s->has("count") && rack.game != RackGame::kLine)
        s->fail("count", "rack.count belongs to the game line; leave it out or set game = \"line\"");
    if (s->has("rows") && rack.game != RackGame::kTriangle)
        s->fail("rows", "rack.rows belongs to the game triangle; leave it out or set game = \"triangle\"");
    const bool spots = rack.game == RackGame::kSnooker || rack.game == RackGame::kThreeCushion;
    for (const char* key : {"position", "spot_ball", "angle_deg"})
        if (spots && s->has(key))
            s->fail(
                key,
                "rack.{} moves a rack, and the balls of this game stand on spots of the table; leave it out",
                key);
    if (spots && !(scene.table.length > 0.0)) {
        s->fail("game",
                "this layout puts balls on the spots of a table, and the cloth is endless; choose a table");
    }
    if (rack.spot_ball && *rack.spot_ball > balls_of(rack))
        s->fail("spot_ball", "rack.spot_ball = {}: the balls of this rack are 1 to {}; name one of them",
                *rack.spot_ball, balls_of(rack));
    for (const RackedBall& ball : make_rack(rack, scene.table, scene.balls.R)) {
        if (scene.ball.size() == kMaxBalls)
            s->fail(s->where(), "more than {} balls; leave some out", kMaxBalls);
        BallStart start;
        start.id = ball.id;
        start.position = {ball.position.x(), ball.position.y(), scene.balls.R};
        start.where = s->where();
        scene.ball.push_back(start);
    }
}

void read_cue(const Section& top, Scene& scene) {
    Cue cue;
    const auto s = top.read("cue", kCueFields, cue);
    if (!s) return;
    cue.where = s->where();
    const Vec2 offset(cue.side, cue.height);
    if (offset.squaredNorm() > kMiscueOffset * kMiscueOffset) {
        s->fail("offset",
                "cue.offset is {:.4g} ball radii from the centre, where the tip slips off; keep it within {}",
                offset.norm(), kMiscueOffset);
    }
    if (cue.end_mass > cue.mass) {
        s->fail("end_mass", "cue.end_mass = {} is more than the whole cue, cue.mass = {}; make it smaller",
                cue.end_mass, cue.mass);
    }
    const BallStart* struck = nullptr;
    for (const BallStart& ball : scene.ball) {
        if (ball.id == cue.ball) struck = &ball;
    }
    if (!struck) {
        s->fail("ball", "cue.ball: there is no ball {}; add a [[ball]] with this id or name another",
                in_quotes(cue.ball));
    }
    if (!struck->velocity.isZero(0.0) || !struck->spin.isZero(0.0)) {
        s->fail(struck->where,
                "ball {} has a velocity or spin of its own and is struck by the cue; remove one of the two",
                in_quotes(struck->id));
    }
    scene.cue = cue;
}

void read_physics(const Section& top, Scene& scene) {
    const auto s = top.read("physics", kPhysicsFields, scene.physics);
    if (s && s->has("substeps") && s->has("tolerance"))
        s->fail("substeps",
                "physics.substeps and physics.tolerance exclude each other; remove one of the two");
    const BallParams& p = scene.balls;
    for (const auto& [key, value] :
         {std::pair{"mu_s", p.mu_s},
          std::pair{p.mu_b_more > 0.0 ? "mu_b_fit" : "mu_b", p.mu_b + p.mu_b_more}}) {
        if (value > kernel::kLargestFriction && scene.physics.ball_ball->reads_tolerance &&
            !scene.physics.substeps)
            top.fail(top.where("balls", key),
                     "balls.{} = {}: the impact by tolerance takes frictions up to {}; lower it, or set "
                     "physics.substeps = 1000",
                     key, value, kernel::kLargestFriction);
    }
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
    if (r.eye.has_value() != r.target.has_value())
        s->fail(r.eye ? "eye" : "target", "render.eye and render.target go together; give both or neither");
    if (r.eye && s->has("camera"))
        s->fail("camera", "render.camera and render.eye exclude each other; remove one of the two");
    if (r.eye && *r.eye == *r.target)
        s->fail("target", "render.target is where the eye is; move one of the two");
}

}  // namespace carom::detail
