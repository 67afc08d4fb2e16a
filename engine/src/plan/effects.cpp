#include "plan/effects.h"

#include <fmt/format.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace carom {

/// The inputs of the decisions. The plan contains the decisions already made.
struct EffectFacts {
    const Scene& scene;
    const Plan& plan;
    const Reach& reach;
    Words say;  ///< the reasons

    const BallParams& balls() const { return scene.balls; }
    bool has_cushions() const { return !scene.table.cushions.empty() || !scene.table.jaws.empty(); }
    bool impacts() const { return plan.pairs || (reach.cushions && has_cushions()); }
};

namespace {

using Facts = EffectFacts;

Need coefficient(const Facts& f, const char* symbol, double value) {
    return {value != 0.0, f.say("{} = {}", symbol, value)};
}

/// "mu_b = 0.06", or the formula if the coefficient falls with the slip.
std::string say(const Facts& f, const char* symbol, const Falling& x) {
    return x.constant() ? f.say("{} = {}", symbol, x.at_rest)
                        : f.say("{} = {} + {} exp(-{} u)", symbol, x.at_rest, x.more, x.fall);
}

Need no_two_balls_meet(const Facts& f) {
    return {false, f.say("no two balls can meet: {}", f.reach.why)};
}

Need sliding(const Facts& f) {
    if (f.scene.physics.gravity == 0.0) return {false, f.say("gravity = 0: no friction on the cloth")};
    if (f.balls().mu_s != 0.0 && !f.reach.slips && !f.impacts())
        return {false, f.say("no ball ever slips: none does at the start, and none meets anything")};
    return coefficient(f, "mu_s", f.balls().mu_s);
}

Need rolling(const Facts& f) {
    if (f.scene.physics.gravity == 0.0) return {false, f.say("gravity = 0: no resistance of the cloth")};
    if (f.balls().mu_r != 0.0 && !f.reach.moves) return {false, f.say("no ball ever moves")};
    return coefficient(f, "mu_r", f.balls().mu_r);
}

Need spin_decay(const Facts& f) {
    const double mu_sp = f.balls().mu_sp;
    if (f.scene.physics.gravity == 0.0) return {false, f.say("gravity = 0: no friction on the cloth")};
    if (mu_sp == 0.0) return coefficient(f, "mu_sp", mu_sp);
    const auto needed = [&](const char* why) { return Need{true, f.say("mu_sp = {}; {}", mu_sp, why)}; };
    bool side = f.scene.cue && f.scene.cue->side != 0.0 && f.scene.cue->speed != 0.0;
    for (const BallStart& ball : f.scene.ball) side = side || ball.spin.z() != 0.0;
    if (side) return needed("a ball starts with vertical spin");
    if (f.plan.in_force(Effect::kThrow)) return needed("friction between balls makes vertical spin");
    const bool rough = f.balls().cushion_friction().most() != 0.0 &&
                       (f.plan.cushion->reads_friction || f.plan.jaw->reads_friction);
    if (rough && f.plan.in_force(Effect::kCushions)) return needed("cushion friction makes vertical spin");
    return {false, f.say("no ball can ever have vertical spin: none at the start, no friction in impacts")};
}

Need ball_friction_needed(const Facts& f) {
    const BallParams& p = f.balls();
    if (f.scene.ball.size() < 2) return {false, f.say("one ball only")};
    if (!f.plan.ball_ball->reads_friction)
        return {false, f.say("model {} has no friction", f.plan.ball_ball->name)};
    if (!p.ball_friction().any()) return coefficient(f, "mu_b", 0.0);
    if (!f.plan.pairs) return no_two_balls_meet(f);
    return {true, say(f, "mu_b", p.ball_friction())};
}

Need cloth_in_impact(const Facts& f) {
    const BallParams& p = f.balls();
    if (f.scene.ball.size() < 2) return {false, f.say("one ball only")};
    if (!f.plan.ball_ball->reads_cloth)
        return {false, f.say("model {} does not read the cloth", f.plan.ball_ball->name)};
    const bool tilted = !f.scene.of_one_radius();
    if (p.mu_s == 0.0 || (!p.ball_friction().any() && !tilted))
        return {false, f.say("{} = 0", p.mu_s == 0.0 ? "mu_s" : "mu_b")};
    if (!f.plan.pairs) return no_two_balls_meet(f);
    if (tilted) return {true, f.say("mu_s > 0, and balls of different radius press each other on the cloth")};
    return {true, f.say("mu_s and mu_b > 0; without vertical slip it is 0 at that impact")};
}

Need cushions(const Facts& f) {
    if (!f.has_cushions()) return {false, f.say("the table has none")};
    if (!f.reach.cushions) return {false, f.say("none within reach: {}", f.reach.why)};
    return {true, f.say("{} cushions, {} jaws", f.scene.table.cushions.size(), f.scene.table.jaws.size())};
}

Need cushion_friction(const Facts& f) {
    const Table& table = f.scene.table;
    if (!f.has_cushions()) return {false, f.say("the table has no cushions")};
    if (!f.reach.cushions) return {false, f.say("no cushion within reach: {}", f.reach.why)};
    const CushionModelInfo &straight = *f.plan.cushion, &jaw = *f.plan.jaw;
    if (&straight == &kSmooth && (&jaw == &kSmooth || table.jaws.empty()))
        return {false, f.say("model smooth")};
    bool level = !f.scene.lifts() && !f.plan.ball_ball->free && f.balls().cushion_friction().most() == 0.0 &&
                 straight.reflects_when_level && jaw.reflects_when_level;
    for (const BallSize& ball : f.plan.sizes) {
        for (const Cushion& c : table.cushions) level = level && c.height == ball.R;
        for (const Jaw& j : table.jaws) level = level && j.height == ball.R;
    }
    if (level) return {false, f.say("f_c = 0 and the noses at ball height: smooth")};
    const std::string friction = say(f, "f_c", f.balls().cushion_friction());
    return {true, &straight == &jaw ? f.say("model {}, {}", straight.name, friction)
                                    : f.say("model {}, jaws {}, {}", straight.name, jaw.name, friction)};
}

Need pockets(const Facts& f) {
    if (f.scene.table.pockets.empty()) return {false, f.say("the table has none")};
    if (!f.reach.pockets) return {false, f.say("none within reach: {}", f.reach.why)};
    return {true, f.say("{} pockets", f.scene.table.pockets.size())};
}

Need squirt(const Facts& f) {
    if (!f.scene.cue) return {false, f.say("no cue")};
    const bool up = f.scene.lifts() && f.scene.cue->elevation_deg > 0.0 && f.scene.cue->height != 0.0;
    if ((f.scene.cue->side == 0.0 && !up) || f.scene.cue->end_mass == 0.0)
        return {false, f.say("no side offset, or end mass 0")};
    return {true, f.say("the cue strikes off centre")};
}

Need clusters(const Facts& f) {
    const ClusterModel model = f.scene.physics.clusters;
    if (f.scene.ball.size() < 3) return {false, f.say("fewer than three balls")};
    if (model == ClusterModel::kSequential) return {false, f.say("clusters = \"sequential\": pair by pair")};
    if (!f.plan.pairs) return no_two_balls_meet(f);
    return {true, f.say("clusters = \"{}\"; decided per impact: no third ball within reach means the "
                        "pair alone",
                        name(model))};
}

Need contact_lasts(const Facts& f) {
    if (f.scene.ball.size() < 2) return {false, f.say("one ball only")};
    // Forced on, it does not change the model.
    if (f.scene.physics.clusters != ClusterModel::kCompliant)
        return {false, f.say("clusters = \"{}\": impacts are instants", name(f.scene.physics.clusters))};
    if (f.scene.physics.substeps)
        return {false, f.say("substeps = {}: the published result", *f.scene.physics.substeps)};
    if (f.plan.ball_ball->free) return {false, f.say("model {} has free impacts", f.plan.ball_ball->name)};
    if (!f.plan.pairs) return no_two_balls_meet(f);
    return {true, f.say("clusters = \"compliant\": the line of centres turns while two balls touch")};
}

Need airborne(const Facts& f) {
    const Scene& s = f.scene;
    if (s.physics.vertical == Vertical::kDrop)
        return {false, f.say("vertical = \"drop\": the model is planar")};
    for (const BallStart& ball : s.ball)
        if (ball.flies()) return {true, f.say("ball {} starts in the air", ball.id)};
    if (s.lifts()) return {true, f.say("the cue is raised by {} degrees", s.cue->elevation_deg)};
    const bool tilted = !s.alike(), rough = f.balls().ball_friction().any();
    if (s.physics.ball_ball->free && f.plan.pairs && (tilted || rough))
        return {true,
                f.say("ball_ball = \"{}\": an impact of two balls may lift them", s.physics.ball_ball->name)};
    const bool noses = f.reach.cushions && f.has_cushions() &&
                       (s.physics.cushion != &kSmooth || s.physics.jaw_model() != &kSmooth);
    if (f.balls().e_h > 0.0 && noses)
        return {true, f.say("e_h = {}: a cushion may throw a ball up", f.balls().e_h)};
    return {false, f.say("all balls start on the cloth, the cue is level, and no impact lifts a ball")};
}

// In the order of Effect, which users know.
constexpr EffectInfo kTable[kEffects] = {
    {.keyword = "sliding",
     .skipped_when = "`mu_s` or `gravity` is 0, or no ball ever slips",
     .keys = "`mu_s`, `gravity`",
     .need = sliding},
    {.keyword = "rolling",
     .skipped_when = "`mu_r` or `gravity` is 0, or nothing moves",
     .keys = "`mu_r`, `gravity`",
     .need = rolling},
    {.keyword = "spin_decay",
     .skipped_when = "`mu_sp` or `gravity` is 0, or no ball can ever have vertical spin",
     .keys = "`mu_sp`, `gravity`, `spin`",
     .need = spin_decay,
     .last = true},
    {.keyword = "throw",
     .skipped_when = "no friction between balls, or no two balls can meet",
     .keys = "`mu_b`, `mu_b_fit`, `ball_ball`",
     .need = ball_friction_needed,
     .leave_out = [](Plan& plan) { plan.balls.mu_b = plan.balls.mu_b_more = 0.0; }},
    {.keyword = "cloth_in_impact",
     .skipped_when = "`mu_s` or `mu_b` is 0, a model other than `mathavan`, or no two balls can meet",
     .keys = "`mu_s`, `cloth_slip`, `ball_ball`",
     .need = cloth_in_impact},
    {.keyword = "cushions",
     .skipped_when = "none within reach",
     .keys = "`cushion`, `jaw`, `e_c`, `preset`",
     .need = cushions,
     .leave_out =
         [](Plan& plan) {
             plan.geometry.cushions.clear();
             plan.geometry.noses.clear();
         }},
    {.keyword = "cushion_friction",
     .skipped_when =
         "model `smooth`, or `f_c` = 0 and all noses at ball height (closed forms), or no cushion "
         "within reach",
     .keys = "`f_c`, `height`, `cushion`, `jaw`",
     .need = cushion_friction,
     .leave_out = [](Plan& plan) { plan.cushion = plan.jaw = &kSmooth; }},
    {.keyword = "pockets",
     .skipped_when = "none within reach",
     .keys = "`pocket`, `preset`",
     .need = pockets,
     .leave_out = [](Plan& plan) { plan.geometry.pockets.clear(); }},
    {.keyword = "squirt",
     .skipped_when = "no cue, no side offset, or `end_mass` 0",
     .keys = "`offset`, `end_mass`",
     .need = squirt},
    {.keyword = "clusters",
     .skipped_when = "fewer than three balls, `sequential`, or no two balls can meet",
     .keys = "`clusters`",
     .need = clusters,
     .leave_out = [](Plan& plan) { plan.clusters = ClusterModel::kSequential; }},
    {.keyword = "airborne",
     .skipped_when =
         "`vertical` is `drop`, or all balls start on the cloth, the cue is level, and no impact can lift a "
         "ball (`e_h` 0, a model other than `two_step`)",
     .keys = "`vertical`, `height`, `velocity`, `elevation_deg`, `ball_ball`, `e_h`",
     .need = airborne},
    {.keyword = "contact_time",
     .skipped_when = "`clusters` is not `compliant`, `substeps`, model `two_step`, or no two balls can meet",
     .keys = "`clusters`, `substeps`",
     .need = contact_lasts,
     .leave_out = [](Plan& plan) { plan.contact_time = false; }},
};

/// The plan's decision, overridden by [effects].
void decide(const EffectInfo& info, const Facts& facts, EffectDecision& decision) {
    Need need = info.need(facts);
    decision.in_force = need.needed;
    for (const EffectOverride& o : facts.scene.effects) {
        if (o.keyword != info.keyword || o.in_force == need.needed) continue;
        if (need.needed)
            throw SceneError(facts.scene.file, o.where,
                             fmt::format("effects.{} = false, but the scene needs it: {}; remove the line",
                                         info.keyword, need.reason));
        if (info.need == airborne && facts.scene.physics.vertical == Vertical::kDrop)
            throw SceneError(facts.scene.file, o.where,
                             "effects.airborne = true contradicts vertical = \"drop\"; remove one of them");
        decision.in_force = true;
        need.reason = facts.say("forced on; not needed: {}", need.reason);
    }
    decision.reason = std::move(need.reason);
}

}  // namespace

std::span<const EffectInfo> effect_table() {
    return kTable;
}

void decide_effects(Plan& plan, ReachMemory& memory, const Words& say) {
    const Scene& scene = plan.scene;
    const Reach reach = reach_of(scene, memory, say);
    plan.pairs = scene.ball.size() > 1 && reach.pairs;
    plan.clusters = scene.physics.clusters;
    plan.skipped.reset();
    if (plan.effects.empty()) {
        for (const EffectInfo& info : kTable) plan.effects.push_back({info.keyword, true, {}});
    }
    for (const bool last : {false, true}) {
        for (const EffectInfo& info : kTable) {
            if (info.last != last) continue;
            const std::ptrdiff_t i = &info - kTable;
            decide(info, {scene, plan, reach, say}, plan.effects[i]);
            if (plan.effects[i].in_force) continue;
            plan.skip(static_cast<Effect>(i));
            if (info.leave_out != nullptr) info.leave_out(plan);
        }
    }
}

}  // namespace carom
