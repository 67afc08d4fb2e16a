// Makes the plan of a scene: what must be computed for it, and the table in its final form.
#include "carom/engine/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carom/engine/tolerances.h"
#include "physics/cue.h"
#include "physics/motion.h"
#include "plan/effects.h"

namespace carom {

namespace {

// [share of the jaw radius] A cushion end this close to a jaw's circle is rounded off by it and needs no tip
// of its own. The jaw is a full circle, so nothing can slip between the two.
constexpr double kJawJoinShare = 1e-9;

// An end of a cushion needs a circle of its own unless a jaw rounds it off.
bool rounded_by_jaw(const Vec2& end, const std::vector<Jaw>& jaws) {
    return std::any_of(jaws.begin(), jaws.end(), [&](const Jaw& jaw) {
        return std::abs(length(end - jaw.center) - jaw.radius) <= kJawJoinShare * jaw.radius;
    });
}

void add_geometry(const Table& table, Plan& plan) {
    const auto inset = [&](double height) {
        return nose_inset(plan.scene.physics.cushion_touch, plan.sizes.front().R, height);
    };
    for (std::size_t i = 0; i < table.cushions.size(); ++i) {
        const Cushion& cushion = table.cushions[i];
        const Vec2 along = cushion.to - cushion.from;
        const double extent = length(along);
        plan.geometry.cushions.push_back(
            {cushion.from, along / extent, extent, cushion.height, inset(cushion.height)});
        for (const Vec2& end : {cushion.from, cushion.to}) {
            bool known = rounded_by_jaw(end, table.jaws);
            for (const Nose& nose : plan.geometry.noses)
                known = known || (nose.radius == 0.0 && nose.center == end);
            if (!known)
                plan.geometry.noses.push_back({end, 0.0, cushion.height, EventType::kBallCushion,
                                               static_cast<int>(i), inset(cushion.height)});
        }
    }
    for (std::size_t i = 0; i < table.jaws.size(); ++i) {
        const Jaw& jaw = table.jaws[i];
        plan.geometry.noses.push_back({jaw.center, jaw.radius, jaw.height, EventType::kBallJaw,
                                       static_cast<int>(i), inset(jaw.height)});
    }
    plan.geometry.pockets = table.pockets;
}

// The friction that moves a ball of this radius, without the effects that the plan skips.
MotionParams motion_of(const Plan& plan, double R) {
    MotionParams p = motion_params(plan.balls, plan.gravity, R);
    p.sliding = plan.in_force(Effect::kSliding);
    p.rolling = plan.in_force(Effect::kRolling);
    p.spin_decay = plan.in_force(Effect::kSpinDecay);
    return p;
}

// Chooses a tree of boxes where it is faster than a loop through all of them.
void choose_search(Plan& plan) {
    const std::size_t parts =
        plan.geometry.cushions.size() + plan.geometry.noses.size() + plan.geometry.pockets.size();
    if (parts >= kTreeFromParts) plan.table_search = Search::kTree;
    const std::size_t balls = plan.scene.ball.size();
    if (balls >= kTreeFromBalls) plan.ball_search = Search::kTree;
    if (balls >= kShortBoxesFromBalls) plan.box_travel = kBoxTravel;
}

}  // namespace

double nose_inset(CushionTouch touch, double R, double height) {
    return touch == CushionTouch::kRadius ? 0.0 : R - std::sqrt(height * (2.0 * R - height));
}

Plan make_plan(const Scene& scene, kernel::Isa isa) {
    Plan plan;
    plan.scene = scene;
    plan.balls = scene.balls;
    plan.gravity = scene.physics.gravity;
    for (const BallStart& ball : scene.ball) plan.sizes.push_back(scene.size_of(ball));
    plan.alike = scene.alike();
    add_geometry(scene.table, plan);
    plan.ball_ball = scene.physics.ball_ball;
    plan.cushion = scene.physics.cushion;
    plan.jaw = scene.physics.jaw_model();
    decide_effects(scene, plan);
    for (const BallSize& size : plan.sizes) plan.motion.push_back(motion_of(plan, size.R));
    choose_search(plan);
    plan.isa = isa;
    plan.contact_phase = kernel::contact_phase_function(isa);
    plan.impact.tolerance = scene.physics.tolerance;
    if (scene.physics.substeps) {
        plan.impact.march = kernel::march_function(isa);
        plan.impact.substeps = *scene.physics.substeps;
    } else {
        plan.impact.by_tolerance = kernel::tolerance_function(isa);
    }
    for (const BallStart& ball : scene.ball) {
        if (!scene.cue || scene.cue->ball != ball.id) continue;
        const double vertical = strike(*scene.cue, scene.size_of(ball)).dropped_vertical;
        if (vertical > 0.0)
            plan.warnings.push_back(
                fmt::format("the elevated cue would give the ball a vertical speed of {:.3g} m/s; the model "
                            "is planar and drops it",
                            vertical));
    }
    return plan;
}

}  // namespace carom
