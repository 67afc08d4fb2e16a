#include "scene_sections.h"

#include <fmt/format.h>

#include <cmath>

#include "carom/engine/tolerances.h"
#include "carom/kernel/tolerance.h"
#include "rack.h"

namespace carom::detail {
namespace {

/// Presets are built by name; the value says no more than that the name is there.
constexpr Choice<bool> kBallPresets[] = {{"pool", true}, {"snooker", true}, {"carom", true}};

constexpr Choice<RackGame> kRackGames[] = {
    {"eight_ball", RackGame::kEightBall}, {"nine_ball", RackGame::kNineBall},
    {"snooker", RackGame::kSnooker},      {"three_cushion", RackGame::kThreeCushion},
    {"triangle", RackGame::kTriangle},    {"line", RackGame::kLine}};
constexpr Choice<BallBallModel> kBallBallModels[] = {{"mathavan", BallBallModel::kMathavan},
                                                     {"inelastic", BallBallModel::kInelastic},
                                                     {"elastic", BallBallModel::kElastic}};
constexpr Choice<CushionModel> kCushionModels[] = {{"han_2005", CushionModel::kHan2005},
                                                   {"smooth", CushionModel::kSmooth},
                                                   {"mathavan_2010", CushionModel::kMathavan2010},
                                                   {"stronge", CushionModel::kStronge},
                                                   {"impulse", CushionModel::kImpulse}};
constexpr Choice<ClothSlipSign> kClothSlipSigns[] = {{"consistent", ClothSlipSign::kConsistent},
                                                     {"as_published", ClothSlipSign::kAsPublished}};
constexpr Choice<ClusterModel> kClusterModels[] = {{"compliant", ClusterModel::kCompliant},
                                                   {"sequential", ClusterModel::kSequential},
                                                   {"rigid", ClusterModel::kRigid}};
constexpr Choice<bool> kCameras[] = {{"top", true}, {"rail", true}, {"player", true}, {"follow", true}};

constexpr Interval kFriction = at_least(0.0, kMaxFriction);
constexpr Interval kRestitution = at_least(0.0, 1.0);

/// Ids go into CSV files and messages as they are.
void check_id(const Section& section, const std::string& id) {
    if (id.empty()) section.fail("id", "a ball's id is empty; give it a name");
    if (id.size() > kMaxIdLength) {
        section.fail("id", fmt::format("the ball id {} is longer than {} bytes; shorten it", in_quotes(id),
                                       kMaxIdLength));
    }
    for (const char c : id) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == ',' || c == '"') {
            section.fail(
                "id",
                fmt::format("the ball id {} holds a comma, a quote or a control character; leave it out",
                            in_quotes(id)));
        }
    }
}

BallStart read_ball(const Section& s, const BallSize& common) {
    BallStart ball;
    BallSize size = common;
    size.R = s.number("radius", size.R, at_least(kMinLength, kMaxLength, "m"));
    size.m = s.number("mass", size.m, at_least(kMinMass, kMaxMass, "kg"));
    if (!(size == common)) ball.own = size;
    ball.where = s.where();
    ball.id = s.text("id", "cue");
    check_id(s, ball.id);
    const Vec2 p = s.vec2("position", {0.635, 0.5}, "[x, y]", kCoordinate);
    ball.position = {p.x(), p.y(), size.R};
    const Vec2 v = s.vec2("velocity", Vec2::Zero(), "[vx, vy]", at_least(-kMaxSpeed, kMaxSpeed, "m/s"));
    ball.velocity = {v.x(), v.y(), 0.0};
    const auto w = s.numbers("spin", 3, "[wx, wy, wz]", at_least(-kMaxSpin, kMaxSpin, "rad/s"));
    if (w) ball.spin = {(*w)[0], (*w)[1], (*w)[2]};
    return ball;
}

}  // namespace

void read_balls(const Section& top, Scene& scene) {
    scene.balls = make_ball_params(scene.ball_preset);
    const toml::table* table = top.table("balls");
    if (!table) return;
    const Section s(
        *table, top.file(), "balls",
        {"preset", "radius", "mass", "mu_s", "mu_r", "mu_sp", "mu_b", "mu_b_fit", "e_b", "e_c", "f_c"});
    s.choice("preset", true, kBallPresets);
    scene.ball_preset = s.text("preset", scene.ball_preset);
    BallParams p = make_ball_params(scene.ball_preset);
    p.R = s.number("radius", p.R, at_least(kMinLength, kMaxLength, "m"));
    p.m = s.number("mass", p.m, at_least(kMinMass, kMaxMass, "kg"));
    p.mu_s = s.number("mu_s", p.mu_s, kFriction);
    p.mu_r = s.number("mu_r", p.mu_r, kFriction);
    p.mu_sp = s.number("mu_sp", p.mu_sp, kFriction);
    p.mu_b = s.number("mu_b", p.mu_b, kFriction);
    if (const auto fit = s.numbers("mu_b_fit", 3, "[a, b, c] for a + b exp(-c u)", kFriction)) {
        if (s.has("mu_b"))
            s.fail("mu_b_fit", "balls.mu_b and balls.mu_b_fit are two values for one friction; remove one");
        p.mu_b = (*fit)[0];
        p.mu_b_more = (*fit)[1];
        p.mu_b_fall = (*fit)[2];
    }
    p.e_b = s.number("e_b", p.e_b, kRestitution);
    p.e_c = s.number("e_c", p.e_c, kRestitution);
    p.f_c = s.number("f_c", p.f_c, kFriction);
    for (const auto& [key, value] :
         {std::pair{"mu_s", p.mu_s},
          std::pair{p.mu_b_more > 0.0 ? "mu_b_fit" : "mu_b", p.mu_b + p.mu_b_more}}) {
        if (value > kernel::kLargestFriction && scene.physics.ball_ball == BallBallModel::kMathavan &&
            !scene.physics.substeps)
            s.fail(s.where(key),
                   fmt::format(
                       "balls.{} = {}: the impact by tolerance takes frictions up to {}; lower it, or set "
                       "physics.substeps = 1000",
                       key, value, kernel::kLargestFriction));
    }
    scene.balls = p;
}

void read_ball_list(const Section& top, Scene& scene) {
    const auto tables = top.tables("ball");
    if (!tables) return;
    for (const toml::table* table : *tables) {
        const Section s(*table, top.file(), "ball", {"id", "position", "velocity", "spin", "radius", "mass"});
        if (scene.ball.size() == kMaxBalls)
            s.fail(s.where(), fmt::format("more than {} balls; leave some out", kMaxBalls));
        scene.ball.push_back(read_ball(s, scene.balls.size()));
    }
}

void read_rack(const Section& top, Scene& scene) {
    const toml::table* table = top.table("rack");
    if (!table) return;
    const Section s(*table, top.file(), "rack", {"game", "gap", "jitter", "seed", "count", "rows"});
    Rack rack;
    rack.game = s.choice("game", rack.game, kRackGames);
    rack.gap = s.number("gap", rack.gap, at_least(0.0, kMaxLength, "m"));
    rack.jitter = s.number("jitter", rack.jitter, at_least(0.0, kMaxLength, "m"));
    rack.seed = static_cast<std::uint64_t>(s.integer("seed", 1, 0, INT64_MAX));
    if (s.has("count") && rack.game != RackGame::kLine) {
        s.fail("count", "rack.count belongs to the game line; leave it out or set game = \"line\"");
    }
    rack.count = static_cast<int>(s.integer("count", rack.count, 1, kMaxBalls));
    if (s.has("rows") && rack.game != RackGame::kTriangle) {
        s.fail("rows", "rack.rows belongs to the game triangle; leave it out or set game = \"triangle\"");
    }
    rack.rows = static_cast<int>(s.integer("rows", rack.rows, 1, kMaxRackRows));
    const bool spots = rack.game == RackGame::kSnooker || rack.game == RackGame::kThreeCushion;
    if (spots && !(scene.table.length > 0.0)) {
        s.fail("game",
               "this layout puts balls on the spots of a table, and the cloth is endless; choose a table");
    }
    for (const RackedBall& ball : make_rack(rack, scene.table, scene.balls.R)) {
        if (scene.ball.size() == kMaxBalls) {
            s.fail(s.where(), fmt::format("more than {} balls; leave some out", kMaxBalls));
        }
        BallStart start;
        start.id = ball.id;
        start.position = {ball.position.x(), ball.position.y(), scene.balls.R};
        start.where = s.where();
        scene.ball.push_back(start);
    }
}

void read_cue(const Section& top, Scene& scene) {
    const toml::table* table = top.table("cue");
    if (!table) return;
    const Section s(*table, top.file(), "cue",
                    {"ball", "speed", "aim_deg", "elevation_deg", "offset", "mass", "end_mass"});
    Cue cue;
    cue.where = s.where();
    cue.ball = s.text("ball", cue.ball);
    cue.speed = s.number("speed", cue.speed, at_least(0.0, kMaxSpeed, "m/s"));
    cue.aim_deg = s.number("aim_deg", cue.aim_deg, at_least(-kMaxAngle, kMaxAngle, "degrees"));
    cue.elevation_deg = s.number("elevation_deg", cue.elevation_deg, {0.0, false, 90.0, true, "degrees"});
    const Vec2 offset =
        s.vec2("offset", {cue.side, cue.height}, "[side, height]", at_least(-1.0, 1.0, "ball radii"));
    cue.side = offset.x();
    cue.height = offset.y();
    if (offset.squaredNorm() > kMiscueOffset * kMiscueOffset) {
        s.fail(
            "offset",
            fmt::format(
                "cue.offset is {:.4g} ball radii from the centre, where the tip slips off; keep it within {}",
                offset.norm(), kMiscueOffset));
    }
    cue.mass = s.number("mass", cue.mass, at_least(kMinMass, kMaxMass, "kg"));
    cue.end_mass = s.number("end_mass", cue.end_mass, at_least(0.0, kMaxMass, "kg"));
    if (cue.end_mass > cue.mass) {
        s.fail("end_mass",
               fmt::format("cue.end_mass = {} is more than the whole cue, cue.mass = {}; make it smaller",
                           cue.end_mass, cue.mass));
    }
    const BallStart* struck = nullptr;
    for (const BallStart& ball : scene.ball) {
        if (ball.id == cue.ball) struck = &ball;
    }
    if (!struck) {
        s.fail("ball",
               fmt::format("cue.ball: there is no ball {}; add a [[ball]] with this id or name another",
                           in_quotes(cue.ball)));
    }
    if (!struck->velocity.isZero(0.0) || !struck->spin.isZero(0.0)) {
        s.fail(
            struck->where,
            fmt::format(
                "ball {} has a velocity or spin of its own and is struck by the cue; remove one of the two",
                in_quotes(struck->id)));
    }
    scene.cue = cue;
}

void read_physics(const Section& top, Scene& scene) {
    const toml::table* table = top.table("physics");
    if (!table) return;
    const Section s(
        *table, top.file(), "physics",
        {"gravity", "ball_ball", "cushion", "jaw", "cloth_slip", "clusters", "tolerance", "substeps"});
    Physics& p = scene.physics;
    p.gravity = s.number("gravity", p.gravity, at_least(0.0, kMaxGravity, "m/s^2"));
    p.ball_ball = s.choice("ball_ball", p.ball_ball, kBallBallModels);
    p.cushion = s.choice("cushion", p.cushion, kCushionModels);
    if (s.has("jaw")) p.jaw = s.choice("jaw", p.cushion, kCushionModels);
    p.cloth_slip = s.choice("cloth_slip", p.cloth_slip, kClothSlipSigns);
    p.clusters = s.choice("clusters", p.clusters, kClusterModels);
    p.tolerance =
        s.number("tolerance", p.tolerance, at_least(kernel::kTightestTolerance, kernel::kLoosestTolerance));
    if (s.has("substeps")) {
        if (s.has("tolerance"))
            s.fail(s.where("substeps"),
                   "physics.substeps and physics.tolerance exclude each other; remove one of the two");
        p.substeps = static_cast<int>(s.integer("substeps", 1, 1, kMaxSubsteps));
    }
}

void read_effects(const Section& top, Scene& scene) {
    const toml::table* table = top.table("effects");
    if (!table) return;
    const Section s(*table, top.file(), "effects",
                    {"sliding", "rolling", "spin_decay", "throw", "cloth_in_impact", "cushions",
                     "cushion_friction", "pockets", "squirt", "clusters"});
    for (const char* keyword : kEffectKeywords) {
        if (const auto on = s.boolean(keyword)) scene.effects.push_back({keyword, *on, s.where(keyword)});
    }
}

void read_stop(const Section& top, Scene& scene) {
    const toml::table* table = top.table("stop");
    if (!table) return;
    const Section s(*table, top.file(), "stop", {"time", "events"});
    scene.stop.time = s.number("time", at_least(0.0, kMaxTime, "s"));
    scene.stop.events = s.integer("events", 0, INT64_MAX);
}

void read_render(const Section& top, Scene& scene) {
    const toml::table* table = top.table("render");
    if (!table) return;
    const Section s(*table, top.file(), "render", {"fps", "size", "camera", "eye", "target"});
    RenderSettings& r = scene.render;
    r.fps = s.number("fps", r.fps, more_than(0.0, kMaxFps, "frames per second"));
    const auto size = s.numbers("size", 2, "[width, height]", at_least(1.0, kMaxImageSize, "pixels"));
    if (size) {
        r.width = static_cast<int>((*size)[0]);
        r.height = static_cast<int>((*size)[1]);
        if (r.width != (*size)[0] || r.height != (*size)[1])
            s.fail("size", "render.size must be whole pixels; drop the fraction");
    }
    s.choice("camera", true, kCameras);
    r.camera = s.text("camera", r.camera);
    const auto point = [&](const char* key) -> std::optional<Vec3> {
        const auto p = s.numbers(key, 3, "[x, y, z]", kCoordinate);
        return p ? std::optional<Vec3>(Vec3((*p)[0], (*p)[1], (*p)[2])) : std::nullopt;
    };
    r.eye = point("eye");
    r.target = point("target");
    if (r.eye.has_value() != r.target.has_value())
        s.fail(r.eye ? "eye" : "target", "render.eye and render.target go together; give both or neither");
    if (r.eye && s.has("camera"))
        s.fail("camera", "render.camera and render.eye exclude each other; remove one of the two");
    if (r.eye && *r.eye == *r.target)
        s.fail("target", "render.target is where the eye is; move one of the two");
}

}  // namespace carom::detail
