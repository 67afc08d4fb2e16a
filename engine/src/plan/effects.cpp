#include "plan/effects.h"

#include <fmt/format.h>

#include <cstddef>
#include <span>
#include <string>

#include "plan/reach.h"

namespace carom {

/// What the decisions depend on. The plan holds those that are made already.
struct EffectFacts {
    const Scene& scene;
    const Plan& plan;
    const Reach& reach;

    const BallParams& balls() const { return scene.balls; }
    bool has_cushions() const { return !scene.table.cushions.empty() || !scene.table.jaws.empty(); }
    bool impacts() const { return plan.pairs || (reach.cushions && has_cushions()); }
};

namespace {

using Facts = EffectFacts;

Need coefficient(const char* symbol, double value) {
    return {value != 0.0, fmt::format("{} = {}", symbol, value)};
}

Need no_two_balls_meet(const Facts& f) {
    return {false, "no two balls can meet: " + f.reach.why};
}

Need sliding(const Facts& f) {
    if (f.scene.physics.gravity == 0.0) return {false, "gravity = 0: no friction on the cloth"};
    if (f.balls().mu_s != 0.0 && !f.reach.slips && !f.impacts())
        return {false, "no ball ever slips: none does at the start, and none meets anything"};
    return coefficient("mu_s", f.balls().mu_s);
}

Need rolling(const Facts& f) {
    if (f.scene.physics.gravity == 0.0) return {false, "gravity = 0: no resistance of the cloth"};
    if (f.balls().mu_r != 0.0 && !f.reach.moves) return {false, "no ball ever moves"};
    return coefficient("mu_r", f.balls().mu_r);
}

Need spin_decay(const Facts& f) {
    const double mu_sp = f.balls().mu_sp;
    if (f.scene.physics.gravity == 0.0) return {false, "gravity = 0: no friction on the cloth"};
    if (mu_sp == 0.0) return coefficient("mu_sp", mu_sp);
    const auto needed = [&](const char* why) {
        return Need{true, fmt::format("mu_sp = {}; {}", mu_sp, why)};
    };
    bool side = f.scene.cue && f.scene.cue->side != 0.0 && f.scene.cue->speed != 0.0;
    for (const BallStart& ball : f.scene.ball) side = side || ball.spin.z() != 0.0;
    if (side) return needed("a ball starts with vertical spin");
    if (f.plan.in_force(Effect::kThrow)) return needed("friction between balls makes vertical spin");
    const bool rough = f.balls().most_cushion_friction() != 0.0 &&
                       (f.plan.cushion->reads_friction || f.plan.jaw->reads_friction);
    if (rough && f.plan.in_force(Effect::kCushions)) return needed("cushion friction makes vertical spin");
    return {false, "no ball can ever have vertical spin: none at the start, no friction in impacts"};
}

Need ball_friction_needed(const Facts& f) {
    const BallParams& p = f.balls();
    if (f.scene.ball.size() < 2) return {false, "one ball only"};
    if (!f.plan.ball_ball->reads_friction)
        return {false, fmt::format("model {} has no friction", f.plan.ball_ball->name)};
    if (!p.ball_friction()) return coefficient("mu_b", 0.0);
    if (!f.plan.pairs) return no_two_balls_meet(f);
    if (p.mu_b_more == 0.0) return coefficient("mu_b", p.mu_b);
    return {true, fmt::format("mu_b = {} + {} exp(-{} u)", p.mu_b, p.mu_b_more, p.mu_b_fall)};
}

Need cloth_in_impact(const Facts& f) {
    const BallParams& p = f.balls();
    if (f.scene.ball.size() < 2) return {false, "one ball only"};
    if (!f.plan.ball_ball->reads_cloth)
        return {false, fmt::format("model {} does not read the cloth", f.plan.ball_ball->name)};
    if (p.mu_s == 0.0 || !p.ball_friction()) return {false, p.mu_s == 0.0 ? "mu_s = 0" : "mu_b = 0"};
    if (!f.plan.pairs) return no_two_balls_meet(f);
    return {true, "mu_s and mu_b > 0; without vertical slip it is 0 at that impact"};
}

Need cushions(const Facts& f) {
    if (!f.has_cushions()) return {false, "the table has none"};
    if (!f.reach.cushions) return {false, "none within reach: " + f.reach.why};
    return {true,
            fmt::format("{} cushions, {} jaws", f.scene.table.cushions.size(), f.scene.table.jaws.size())};
}

Need cushion_friction(const Facts& f) {
    const Table& table = f.scene.table;
    if (!f.has_cushions()) return {false, "the table has no cushions"};
    if (!f.reach.cushions) return {false, "no cushion within reach: " + f.reach.why};
    const CushionModelInfo &straight = *f.plan.cushion, &jaw = *f.plan.jaw;
    if (&straight == &kSmooth && (&jaw == &kSmooth || table.jaws.empty())) return {false, "model smooth"};
    bool level =
        f.balls().most_cushion_friction() == 0.0 && straight.reflects_when_level && jaw.reflects_when_level;
    for (const BallSize& ball : f.plan.sizes) {
        for (const Cushion& c : table.cushions) level = level && c.height == ball.R;
        for (const Jaw& j : table.jaws) level = level && j.height == ball.R;
    }
    if (level) return {false, "f_c = 0 and the noses at ball height: smooth"};
    const BallParams& p = f.balls();
    const std::string friction = p.f_c_more == 0.0
                                     ? fmt::format("f_c = {}", p.f_c)
                                     : fmt::format("f_c = {} + {} exp(-{} u)", p.f_c, p.f_c_more, p.f_c_fall);
    return {true, &straight == &jaw
                      ? fmt::format("model {}, {}", straight.name, friction)
                      : fmt::format("model {}, jaws {}, {}", straight.name, jaw.name, friction)};
}

Need pockets(const Facts& f) {
    if (f.scene.table.pockets.empty()) return {false, "the table has none"};
    if (!f.reach.pockets) return {false, "none within reach: " + f.reach.why};
    return {true, fmt::format("{} pockets", f.scene.table.pockets.size())};
}

Need squirt(const Facts& f) {
    if (!f.scene.cue) return {false, "no cue"};
    if (f.scene.cue->side == 0.0 || f.scene.cue->end_mass == 0.0)
        return {false, "no side offset, or end mass 0"};
    return {true, "the cue strikes off centre"};
}

Need clusters(const Facts& f) {
    const ClusterModel model = f.scene.physics.clusters;
    if (f.scene.ball.size() < 3) return {false, "fewer than three balls"};
    if (model == ClusterModel::kSequential) return {false, "clusters = \"sequential\": pair by pair"};
    if (!f.plan.pairs) return no_two_balls_meet(f);
    return {true, fmt::format("clusters = \"{}\"; decided per impact: no third ball within reach means the "
                              "pair alone",
                              name(model))};
}

// In the order of Effect, in which people know them.
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
     .skipped_when = "`mu_s` or `mu_b` is 0, another model than `mathavan`, or no two balls can meet",
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
};

/// What the plan decides, with what [effects] says about it.
EffectDecision decide(const EffectInfo& info, const Facts& facts) {
    const Need need = info.need(facts);
    EffectDecision decision{info.keyword, need.needed, need.reason};
    for (const EffectOverride& o : facts.scene.effects) {
        if (o.keyword != info.keyword || o.in_force == need.needed) continue;
        if (need.needed)
            throw SceneError(facts.scene.file, o.where,
                             fmt::format("effects.{} = false, but the scene needs it: {}; remove the line",
                                         info.keyword, need.reason));
        decision.in_force = true;
        decision.reason = "forced on; not needed: " + need.reason;
    }
    return decision;
}

}  // namespace

std::span<const EffectInfo> effect_table() {
    return kTable;
}

void decide_effects(const Scene& scene, Plan& plan) {
    const Reach reach = reach_of(scene);
    plan.pairs = scene.ball.size() > 1 && reach.pairs;
    plan.clusters = scene.physics.clusters;
    plan.effects.resize(kEffects);
    for (const bool last : {false, true}) {
        for (const EffectInfo& info : kTable) {
            if (info.last != last) continue;
            const std::ptrdiff_t i = &info - kTable;
            plan.effects[i] = decide(info, {scene, plan, reach});
            if (plan.effects[i].in_force) continue;
            plan.skip(static_cast<Effect>(i));
            if (info.leave_out != nullptr) info.leave_out(plan);
        }
    }
    plan.effects.push_back({"airborne", false, "not simulated: the model is planar"});
}

}  // namespace carom
