// Which effects a scene can ever feel; geometry in final form.
#include "carom/engine/plan.h"

#include <fmt/format.h>

#include <cmath>

#include "carom/engine/tolerances.h"
#include "cue.h"
#include "motion.h"

namespace carom {

namespace {

// An end of a cushion needs a circle of its own unless a jaw rounds it off.
bool rounded_by_jaw(const Vec2& end, const std::vector<Jaw>& jaws) {
    for (const Jaw& jaw : jaws) {
        if (std::abs(length(end - jaw.center) - jaw.radius) <= kJawJoinShare * jaw.radius) return true;
    }
    return false;
}

void add_geometry(const Table& table, Plan& plan) {
    for (std::size_t i = 0; i < table.cushions.size(); ++i) {
        const Cushion& cushion = table.cushions[i];
        const Vec2 along = cushion.to - cushion.from;
        const double extent = length(along);
        plan.cushions.push_back({cushion.from, along / extent, extent, cushion.height});
        for (const Vec2& end : {cushion.from, cushion.to}) {
            bool known = rounded_by_jaw(end, table.jaws);
            for (const Nose& nose : plan.noses) known = known || (nose.radius == 0.0 && nose.center == end);
            if (!known) plan.noses.push_back({end, 0.0, cushion.height, EventType::kBallCushion, static_cast<int>(i)});
        }
    }
    for (std::size_t i = 0; i < table.jaws.size(); ++i) {
        const Jaw& jaw = table.jaws[i];
        plan.noses.push_back({jaw.center, jaw.radius, jaw.height, EventType::kBallJaw, static_cast<int>(i)});
    }
    plan.pockets = table.pockets;
}

bool any_sidespin(const Scene& scene) {
    for (const BallStart& ball : scene.ball) {
        if (ball.spin.z() != 0.0) return true;
    }
    return scene.cue && scene.cue->side != 0.0;
}

void decide_effects(const Scene& scene, Plan& plan) {
    const BallParams& p = scene.balls;
    const auto add = [&](const char* keyword, bool in_force, std::string reason) {
        plan.effects.push_back({keyword, in_force, std::move(reason)});
    };
    const auto by_coefficient = [&](const char* keyword, const char* symbol, double value) {
        add(keyword, value != 0.0, fmt::format("{} = {}", symbol, value));
    };
    by_coefficient("sliding", "mu_s", p.mu_s);
    by_coefficient("rolling", "mu_r", p.mu_r);
    if (p.mu_sp == 0.0) add("spin_decay", false, "mu_sp = 0");
    else if (!any_sidespin(scene) && p.mu_b == 0.0 && (p.f_c == 0.0 || scene.table.cushions.empty() ||
                                                       scene.physics.cushion == CushionModel::kSmooth))
        add("spin_decay", false, "no ball can ever have vertical spin: none at the start, no friction in impacts");
    else add("spin_decay", true, fmt::format("mu_sp = {}", p.mu_sp));
    const bool one_ball = scene.ball.size() < 2;
    const bool frictionless_model = scene.physics.ball_ball == BallBallModel::kElastic;
    if (one_ball) add("throw", false, "one ball only");
    else if (frictionless_model) add("throw", false, "model elastic has no friction");
    else by_coefficient("throw", "mu_b", p.mu_b);
    if (one_ball) add("cloth_in_impact", false, "one ball only");
    else if (scene.physics.ball_ball != BallBallModel::kMathavan)
        add("cloth_in_impact", false, fmt::format("model {} does not read the cloth", name(scene.physics.ball_ball)));
    else if (p.mu_s == 0.0 || p.mu_b == 0.0) add("cloth_in_impact", false, p.mu_s == 0.0 ? "mu_s = 0" : "mu_b = 0");
    else add("cloth_in_impact", true, "mu_s and mu_b > 0; without vertical slip it is 0 at that impact");
    const bool cushions = !scene.table.cushions.empty() || !scene.table.jaws.empty();
    add("cushions", cushions, cushions ? fmt::format("{} cushions, {} jaws", scene.table.cushions.size(), scene.table.jaws.size())
                                       : "the table has none");
    if (!cushions) add("cushion_friction", false, "the table has no cushions");
    else if (scene.physics.cushion == CushionModel::kSmooth) add("cushion_friction", false, "model smooth");
    else add("cushion_friction", true, fmt::format("model {}, f_c = {}", name(scene.physics.cushion), p.f_c));
    add("pockets", !scene.table.pockets.empty(),
        scene.table.pockets.empty() ? "the table has none" : fmt::format("{} pockets", scene.table.pockets.size()));
    const bool squirt = scene.cue && scene.cue->side != 0.0 && scene.cue->end_mass != 0.0;
    add("squirt", squirt, squirt ? "the cue strikes off centre" : (scene.cue ? "no side offset, or end mass 0" : "no cue"));
    if (scene.ball.size() < 3) add("clusters", false, "fewer than three balls");
    else if (scene.physics.clusters == ClusterModel::kSequential) add("clusters", false, "clusters = \"sequential\": pair by pair");
    else add("clusters", true, fmt::format("clusters = \"{}\"; decided per impact: no third ball within reach means the pair alone",
                                           name(scene.physics.clusters)));
    plan.clusters = scene.ball.size() < 3 ? ClusterModel::kSequential : scene.physics.clusters;
    add("airborne", false, "not simulated: the model is planar");
}

}  // namespace

Plan make_plan(const Scene& scene, kernel::Isa isa) {
    Plan plan;
    plan.scene = scene;
    plan.balls = scene.balls;
    plan.gravity = scene.physics.gravity;
    add_geometry(scene.table, plan);
    plan.cushion = &cushion_model(scene.physics.cushion);
    plan.jaw = &cushion_model(scene.physics.jaw_model());
    decide_effects(scene, plan);
    plan.isa = isa;
    if (scene.physics.substeps) plan.march = kernel::march_function(isa);
    else plan.by_tolerance = kernel::tolerance_function(isa);
    if (scene.cue) {
        const double vertical = strike(*scene.cue, scene.balls).dropped_vertical;
        if (vertical > 0.0)
            plan.warnings.push_back(fmt::format("the elevated cue would give the ball a vertical speed of {:.3g} m/s; the model "
                                                "is planar and drops it", vertical));
    }
    return plan;
}

}  // namespace carom
