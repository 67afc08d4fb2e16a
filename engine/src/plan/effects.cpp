#include "plan/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "plan/reach.h"

namespace carom {
namespace {

struct Need {
    bool needed;
    std::string reason;
};

class Decisions {
  public:
    Decisions(const Scene& scene, Plan& plan)
        : scene_(scene), plan_(plan), p_(scene.balls), reach_(reach_of(scene)) {}

    void run() {
        // Later decisions use earlier ones: what nothing can reach has no friction either.
        plan_.pairs = scene_.ball.size() > 1 && reach_.pairs;
        cushions_ = decide("cushions", cushions());
        if (!cushions_) {
            plan_.geometry.cushions.clear();
            plan_.geometry.noses.clear();
        }
        if (!decide("pockets", pockets())) plan_.geometry.pockets.clear();
        if (!decide("cushion_friction", cushion_friction())) {
            plan_.cushion = &cushion_model(CushionModel::kSmooth);
            plan_.jaw = plan_.cushion;
        }
        throw_ = decide("throw", ball_friction_needed());
        plan_.friction = throw_;
        if (!throw_) plan_.balls.mu_b = plan_.balls.mu_b_more = 0.0;
        plan_.cloth_in_impact = decide("cloth_in_impact", cloth_in_impact());
        plan_.spin_decay = decide("spin_decay", spin_decay());
        plan_.sliding = decide("sliding", sliding());
        plan_.rolling = decide("rolling", rolling());
        plan_.squirt = decide("squirt", squirt());
        plan_.clusters = decide("clusters", clusters()) ? scene_.physics.clusters : ClusterModel::kSequential;
        sort_by_keyword();
        plan_.effects.push_back({"airborne", false, "not simulated: the model is planar"});
    }

  private:
    bool decide(const char* keyword, const Need& need) {
        EffectDecision decision{keyword, need.needed, need.reason};
        for (const EffectOverride& o : scene_.effects) {
            if (o.keyword != keyword) continue;
            if (!o.in_force && need.needed) {
                throw SceneError(
                    scene_.file, o.where,
                    fmt::format("effects.{} = false, but the scene needs it: {}; remove the line", keyword,
                                need.reason));
            }
            if (o.in_force && !need.needed) {
                decision.in_force = true;
                decision.reason = "forced on; not needed: " + need.reason;
            }
        }
        plan_.effects.push_back(decision);
        return decision.in_force;
    }

    Need coefficient(const char* symbol, double value) const {
        return {value != 0.0, fmt::format("{} = {}", symbol, value)};
    }

    bool impacts() const { return plan_.pairs || (reach_.cushions && has_cushions()); }
    bool has_cushions() const { return !scene_.table.cushions.empty() || !scene_.table.jaws.empty(); }

    Need sliding() const {
        if (scene_.physics.gravity == 0.0) return {false, "gravity = 0: no friction on the cloth"};
        if (p_.mu_s == 0.0) return coefficient("mu_s", p_.mu_s);
        if (!reach_.slips && !impacts())
            return {false, "no ball ever slips: none does at the start, and none meets anything"};
        return coefficient("mu_s", p_.mu_s);
    }
    Need rolling() const {
        if (scene_.physics.gravity == 0.0) return {false, "gravity = 0: no resistance of the cloth"};
        if (p_.mu_r == 0.0) return coefficient("mu_r", p_.mu_r);
        if (!reach_.moves) return {false, "no ball ever moves"};
        return coefficient("mu_r", p_.mu_r);
    }
    Need spin_decay() const {
        if (scene_.physics.gravity == 0.0) return {false, "gravity = 0: no friction on the cloth"};
        if (p_.mu_sp == 0.0) return coefficient("mu_sp", p_.mu_sp);
        bool side = scene_.cue && scene_.cue->side != 0.0 && scene_.cue->speed != 0.0;
        for (const BallStart& ball : scene_.ball) side = side || ball.spin.z() != 0.0;
        if (side) return {true, fmt::format("mu_sp = {}; a ball starts with vertical spin", p_.mu_sp)};
        if (throw_)
            return {true, fmt::format("mu_sp = {}; friction between balls makes vertical spin", p_.mu_sp)};
        const bool rough = p_.f_c != 0.0 && (plan_.cushion->reads_friction || plan_.jaw->reads_friction);
        if (cushions_ && rough)
            return {true, fmt::format("mu_sp = {}; cushion friction makes vertical spin", p_.mu_sp)};
        return {false, "no ball can ever have vertical spin: none at the start, no friction in impacts"};
    }
    Need ball_friction_needed() const {
        if (scene_.ball.size() < 2) return {false, "one ball only"};
        if (!plan_.ball_ball->reads_friction)
            return {false, fmt::format("model {} has no friction", plan_.ball_ball->name)};
        if (!p_.ball_friction()) return coefficient("mu_b", 0.0);
        if (!plan_.pairs) return {false, "no two balls can meet: " + reach_.why};
        if (p_.mu_b_more == 0.0) return coefficient("mu_b", p_.mu_b);
        return {true, fmt::format("mu_b = {} + {} exp(-{} u)", p_.mu_b, p_.mu_b_more, p_.mu_b_fall)};
    }
    Need cloth_in_impact() const {
        if (scene_.ball.size() < 2) return {false, "one ball only"};
        if (!plan_.ball_ball->reads_cloth)
            return {false, fmt::format("model {} does not read the cloth", plan_.ball_ball->name)};
        if (p_.mu_s == 0.0 || !p_.ball_friction()) return {false, p_.mu_s == 0.0 ? "mu_s = 0" : "mu_b = 0"};
        if (!plan_.pairs) return {false, "no two balls can meet: " + reach_.why};
        return {true, "mu_s and mu_b > 0; without vertical slip it is 0 at that impact"};
    }
    Need cushions() const {
        if (!has_cushions()) return {false, "the table has none"};
        if (!reach_.cushions) return {false, "none within reach: " + reach_.why};
        return {true,
                fmt::format("{} cushions, {} jaws", scene_.table.cushions.size(), scene_.table.jaws.size())};
    }
    // A frictionless nose at ball height reflects: the closed forms then are the smooth one. mathavan_2010 is
    // left alone, because it gets there by an integration that rounds differently.
    Need cushion_friction() const {
        if (!has_cushions()) return {false, "the table has no cushions"};
        if (!reach_.cushions) return {false, "no cushion within reach: " + reach_.why};
        const CushionModelInfo &straight = *plan_.cushion, &jaw = *plan_.jaw;
        if (straight.model == CushionModel::kSmooth &&
            (jaw.model == CushionModel::kSmooth || scene_.table.jaws.empty()))
            return {false, "model smooth"};
        bool level = p_.f_c == 0.0 && straight.model != CushionModel::kMathavan2010 &&
                     jaw.model != CushionModel::kMathavan2010;
        for (const BallSize& ball : plan_.sizes) {
            for (const Cushion& c : scene_.table.cushions) level = level && c.height == ball.R;
            for (const Jaw& j : scene_.table.jaws) level = level && j.height == ball.R;
        }
        if (level) return {false, "f_c = 0 and the noses at ball height: smooth"};
        return {true, straight.model == jaw.model
                          ? fmt::format("model {}, f_c = {}", straight.name, p_.f_c)
                          : fmt::format("model {}, jaws {}, f_c = {}", straight.name, jaw.name, p_.f_c)};
    }
    Need pockets() const {
        if (scene_.table.pockets.empty()) return {false, "the table has none"};
        if (!reach_.pockets) return {false, "none within reach: " + reach_.why};
        return {true, fmt::format("{} pockets", scene_.table.pockets.size())};
    }
    Need squirt() const {
        if (!scene_.cue) return {false, "no cue"};
        if (scene_.cue->side == 0.0 || scene_.cue->end_mass == 0.0)
            return {false, "no side offset, or end mass 0"};
        return {true, "the cue strikes off centre"};
    }
    Need clusters() const {
        if (scene_.ball.size() < 3) return {false, "fewer than three balls"};
        if (scene_.physics.clusters == ClusterModel::kSequential)
            return {false, "clusters = \"sequential\": pair by pair"};
        if (!plan_.pairs) return {false, "no two balls can meet: " + reach_.why};
        return {true,
                fmt::format(
                    "clusters = \"{}\"; decided per impact: no third ball within reach means the pair alone",
                    name(scene_.physics.clusters))};
    }

    // The order in which people know them.
    void sort_by_keyword() {
        std::vector<EffectDecision> sorted;
        for (const char* keyword : kEffectKeywords) {
            for (const EffectDecision& d : plan_.effects)
                if (d.keyword == keyword) sorted.push_back(d);
        }
        plan_.effects = std::move(sorted);
    }

    const Scene& scene_;
    Plan& plan_;
    const BallParams& p_;
    Reach reach_;
    bool cushions_ = false, throw_ = false;
};

}  // namespace

void decide_effects(const Scene& scene, Plan& plan) {
    Decisions(scene, plan).run();
}

}  // namespace carom
