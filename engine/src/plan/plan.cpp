// Makes the plan of a scene: the required computations, and the table in final form.
#include "carom/engine/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "carom/engine/airborne.h"
#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/math.h"
#include "carom/engine/printable.h"
#include "carom/engine/tolerances.h"
#include "physics/cue.h"
#include "physics/motion.h"
#include "plan/effects.h"

namespace carom {

namespace {

// [share of the jaw radius] A jaw rounds off a cushion end this close to its circle, and then replaces the
// end's own tip. The jaw is a full circle, so nothing can slip between the two.
constexpr double kJawJoinShare = 1e-9;

// An end of a cushion needs its own circle unless a jaw rounds it off.
bool rounded_by_jaw(const Vec2& end, const std::vector<Jaw>& jaws) {
    return std::any_of(jaws.begin(), jaws.end(), [&](const Jaw& jaw) {
        return !jaw.is_arc() && std::abs(length(end - jaw.center) - jaw.radius) <= kJawJoinShare * jaw.radius;
    });
}

bool needs_tip(const Geometry& geometry, const Table& table, const Vec2& end) {
    return !rounded_by_jaw(end, table.jaws) &&
           std::none_of(geometry.noses.begin(), geometry.noses.end(),
                        [&](const Nose& nose) { return nose.radius == 0.0 && nose.center == end; });
}

// Joins arcs that continue each other on one circle, so that a ball does not leave its wall at a joint. An
// arc has the index of its first part. @return the other parts, by their indices
std::vector<std::pair<Jaw, int>> join_arcs(std::vector<std::pair<Jaw, int>>& jaws) {
    // [-] Distance of two directions that are one.
    constexpr double kSameEnd = 1e-12;
    std::vector<std::pair<Jaw, int>> parts;
    const auto meet = [](const Vec2& end, const Vec2& start) { return length(end - start) <= kSameEnd; };
    const auto joins = [&](Jaw& arc, const Jaw& next) {
        if (!arc.is_arc() || !next.is_arc()) return false;
        const Nose one = nose_of(arc, 0, 0.0), other = nose_of(next, 0, 0.0);
        if (!continues(one, other) || one.height != other.height || one.span.whole || other.span.whole)
            return false;
        const double turn = *next.to_deg - *next.from_deg;
        if (meet(one.span.to, other.span.from))
            arc.to_deg = *arc.to_deg + turn;
        else if (meet(other.span.to, one.span.from))
            arc.from_deg = *arc.from_deg - turn;
        else
            return false;
        return true;
    };
    for (std::size_t i = 0; i < jaws.size(); ++i)
        for (std::size_t k = i + 1; k < jaws.size();)
            if (joins(jaws[i].first, jaws[k].first)) {
                parts.push_back(jaws[k]);
                jaws.erase(jaws.begin() + static_cast<std::ptrdiff_t>(k));
                k = i + 1;
            } else {
                ++k;
            }
    return parts;
}

Geometry geometry_of(const Scene& scene) {
    const Table& table = scene.table;
    const double R = scene.size_of(scene.ball.front()).R;
    const auto inset = [&](double height) { return nose_inset(scene.physics.cushion_touch, R, height); };
    Geometry geometry;
    for (std::size_t i = 0; i < table.cushions.size(); ++i) {
        const Cushion& cushion = table.cushions[i];
        geometry.cushions.push_back(line_of(cushion, inset(cushion.height)));
        for (const Vec2& end : {cushion.from, cushion.to})
            if (needs_tip(geometry, table, end))
                geometry.noses.push_back({end, 0.0, cushion.height, Partner::kCushion, static_cast<int>(i),
                                          inset(cushion.height)});
    }
    std::vector<std::pair<Jaw, int>> jaws;
    for (const Jaw& jaw : table.jaws) jaws.emplace_back(jaw, static_cast<int>(jaws.size()));
    for (const auto& [jaw, i] : join_arcs(jaws))
        geometry.joined.push_back(nose_of(jaw, i, inset(jaw.height)));
    for (const auto& [jaw, i] : jaws) {
        const Nose nose = nose_of(jaw, i, inset(jaw.height));
        geometry.noses.push_back(nose);
        if (nose.span.whole) continue;
        for (const Vec2& out : {nose.span.from, nose.span.to}) {
            const Vec2 end = jaw.center + jaw.radius * out;
            if (needs_tip(geometry, table, end))
                geometry.noses.push_back({end, 0.0, jaw.height, Partner::kJaw, i, inset(jaw.height)});
        }
    }
    geometry.pockets = table.pockets;
    return geometry;
}

// The friction on a ball of this radius, without skipped effects.
MotionParams motion_of(const Plan& plan, double R) {
    MotionParams p = motion_params(plan.balls, plan.gravity, R);
    p.sliding = plan.in_force(Effect::kSliding);
    p.rolling = plan.in_force(Effect::kRolling);
    p.spin_decay = plan.in_force(Effect::kSpinDecay);
    return p;
}

// Chooses a tree of boxes if it is faster than a loop over all of them.
void choose_search(Plan& plan) {
    plan.table_search = plan.ball_search = Search::kDirect;
    plan.box_travel = std::numeric_limits<double>::infinity();
    const std::size_t parts =
        plan.geometry.cushions.size() + plan.geometry.noses.size() + plan.geometry.pockets.size();
    if (parts >= kTreeFromParts) plan.table_search = Search::kTree;
    const std::size_t balls = plan.scene.ball.size();
    if (balls >= kTreeFromBalls) plan.ball_search = Search::kTree;
    if (balls >= kShortBoxesFromBalls) plan.box_travel = kBoxTravel;
}

// Fills in everything that follows from the plan's scene and instruction set.
void fill(Plan& plan, const Geometry& geometry, ReachMemory& memory, const Words& say) {
    const Scene& scene = plan.scene;
    plan.balls = scene.balls;
    plan.gravity = scene.physics.gravity;
    plan.sizes.clear();
    for (const BallStart& ball : scene.ball) plan.sizes.push_back(scene.size_of(ball));
    plan.geometry = geometry;
    plan.ball_ball = scene.physics.ball_ball;
    plan.cushion = scene.physics.cushion;
    plan.jaw = scene.physics.jaw_model();
    plan.contact_time = scene.physics.clusters == ClusterModel::kCompliant && !scene.physics.substeps &&
                        !scene.physics.ball_ball->free;
    decide_effects(plan, memory, say);
    plan.motion.clear();
    for (const BallSize& size : plan.sizes) plan.motion.push_back(motion_of(plan, size.R));
    choose_search(plan);
    plan.impact = {};
    plan.impact.tolerance = plan.cluster_tolerance = scene.physics.tolerance;
    plan.impact.cloth_slip = scene.physics.cloth_slip;
    if (scene.physics.substeps) {
        plan.impact.march = scene.physics.march == March::kPublished
                                ? kernel::march_function(plan.isa)
                                : kernel::summed_march_function(plan.isa);
        plan.impact.substeps = *scene.physics.substeps;
    } else {
        plan.impact.by_tolerance = kernel::tolerance_function(plan.isa);
    }
}

void warn_of_tip(Plan& plan, const BallStart& ball) {
    const Cue& cue = *plan.scene.cue;
    const BallSize size = plan.scene.size_of(ball);
    if (ball.height > 0.0 || !(cue.elevation_deg > 0.0) || !(cue.speed > 0.0)) return;
    const StruckBall struck = strike(cue, size, plan.in_force(Effect::kSquirt), Vertical::kKeep);
    Velocities after{struck.v, struck.w};
    hit_cloth(plan.balls, motion_of(plan, size.R), after);
    if (meets_tip_again(cue, size, after.v, after.w))
        plan.warnings.push_back(
            fmt::format("at an elevation of {} degrees the ball would rebound from the cloth into the tip; "
                        "this second hit is not simulated",
                        cue.elevation_deg));
}

// [-] The smallest restitution of a contact in a cluster, because the exponent of the unloading law is
// limited.
constexpr double kLeastInCluster = 0.0016;

void warn_of_clusters(Plan& plan) {
    const double e_b = plan.e_b();
    if (plan.clusters == ClusterModel::kCompliant && plan.sizes.size() > 2 && e_b < kLeastInCluster)
        plan.warnings.push_back(fmt::format("balls.e_b is {:.4g}, but impacts of three or more balls use {}",
                                            e_b, kLeastInCluster));
}

// Limits beyond which a value is probably in the wrong unit. [m], [m/s], [kg]
constexpr double kBesideTable = 0.25;
constexpr double kFastestStroke = 25.0;  // breaks are struck at 9 to 13
constexpr double kSmallestBall = 0.005, kLargestBall = 0.5;
constexpr double kLightestBall = 0.01, kHeaviestBall = 2.0, kLightestCue = 0.1, kHeaviestCue = 3.0;

/// Warns of valid numbers that look as if they were in a different unit.
void warn_of_units(Plan& plan) {
    const Scene& scene = plan.scene;
    const Table& table = scene.table;
    const auto say = [&plan](std::string text) { plan.warnings.push_back(std::move(text)); };
    double farthest = kBesideTable;
    const BallStart* away = nullptr;
    for (const BallStart& ball : scene.ball) {
        const Vec2 from = planar(ball.position) - table.corner,
                   to = table.corner + Vec2(table.width, table.length) - planar(ball.position);
        const double beyond = std::max({-from.x(), -from.y(), -to.x(), -to.y()});
        if (!(table.width > 0.0 && table.length > 0.0) || !(beyond > farthest)) continue;
        farthest = beyond;
        away = &ball;
    }
    if (away != nullptr)
        say(fmt::format("ball {} lies {:.3g} m outside the table; positions are in m", in_quotes(away->id),
                        farthest));
    if (scene.cue && scene.cue->speed > kFastestStroke)
        say(fmt::format("the cue moves at {:.4g} m/s, while a hard break is about 10; speeds are in m/s",
                        scene.cue->speed));
    for (const BallStart& ball : scene.ball) {
        const double speed = length3(ball.velocity);
        if (!(speed > 2.0 * kFastestStroke)) continue;
        say(fmt::format("ball {} starts at {:.4g} m/s; speeds are in m/s", in_quotes(ball.id), speed));
        break;
    }
    const auto first = [&plan](double BallSize::*of, double least, double most) {
        return std::find_if(plan.sizes.begin(), plan.sizes.end(),
                            [&](const BallSize& size) { return size.*of < least || size.*of > most; });
    };
    if (const auto ball = first(&BallSize::R, kSmallestBall, kLargestBall); ball != plan.sizes.end())
        say(fmt::format("a ball has a radius of {:.4g} m, while a pool ball has 0.0286; radii are in m",
                        ball->R));
    if (const auto ball = first(&BallSize::m, kLightestBall, kHeaviestBall); ball != plan.sizes.end())
        say(fmt::format("a ball has a mass of {:.4g} kg, while a pool ball has 0.17; masses are in kg",
                        ball->m));
    if (scene.cue && !(scene.cue->mass >= kLightestCue && scene.cue->mass <= kHeaviestCue))
        say(fmt::format("the cue has a mass of {:.4g} kg, while a usual one has 0.54; masses are in kg",
                        scene.cue->mass));
}

/// Warns of a game's balls on another game's table.
void warn_of_rack(Plan& plan) {
    const Scene& scene = plan.scene;
    const std::string& table = scene.table.preset;
    const auto has = [&scene](auto... ids) { return ((index_of(scene.ball, ids) >= 0) && ...); };
    const bool snooker = has("black", "pink", "blue", "1") && !table.starts_with("snooker"),
               pool = has("cue", "1", "2", "3", "7", "8") && scene.table.pockets.empty();
    if (table.empty() || !(snooker || pool)) return;
    plan.warnings.push_back(
        fmt::format("the {} balls are on the table {}; did you mean preset = \"{}\" in [table]?",
                    snooker ? "snooker" : "pool", table, snooker ? "snooker" : "nine_foot"));
}

void warn(Plan& plan) {
    const Scene& scene = plan.scene;
    warn_of_units(plan);
    warn_of_rack(plan);
    warn_of_clusters(plan);
    for (const BallStart& ball : scene.ball) {
        if (!scene.cue || scene.cue->ball != ball.id) continue;
        if (plan.in_force(Effect::kAirborne)) {
            warn_of_tip(plan, ball);
            continue;
        }
        const double vertical = strike(*scene.cue, scene.size_of(ball)).dropped_vertical;
        if (vertical > 0.0)
            plan.warnings.push_back(
                fmt::format("the elevated cue would give the ball a vertical speed of {:.3g} m/s; the model "
                            "is planar and drops it",
                            vertical));
    }
}

Plan bare_plan(const Scene& scene, kernel::Isa isa) {
    Plan plan;
    plan.scene = scene;
    plan.isa = isa;
    plan.contact_phase = kernel::contact_phase_function(isa);
    return plan;
}

}  // namespace

CushionLine line_of(const Cushion& cushion, double inset) {
    const Vec2 along = cushion.to - cushion.from;
    const double extent = length(along);
    return {cushion.from, along / extent, extent, cushion.height, inset};
}

ArcSpan span_of(const Jaw& jaw) {
    if (!jaw.is_arc()) return {};
    const auto direction = [](double deg) {
        const SinCos at = sin_cos_deg(deg);
        return Vec2(at.cos, at.sin);
    };
    const double turn = *jaw.to_deg - *jaw.from_deg;
    // At least 360 degrees, up to rounding.
    const bool whole = turn > 360.0 - 1e-9;
    return {direction(*jaw.from_deg), direction(*jaw.to_deg), whole, turn > 180.0};
}

Nose nose_of(const Jaw& jaw, int index, double inset) {
    return {jaw.center,  jaw.around() ? -jaw.radius : jaw.radius, jaw.height, Partner::kJaw, index, inset,
            span_of(jaw)};
}

double nose_inset(CushionTouch touch, double R, double height) {
    return touch == CushionTouch::kRadius ? 0.0 : R - std::sqrt(height * (2.0 * R - height));
}

Plan make_plan(const Scene& scene, kernel::Isa isa) {
    Plan plan = bare_plan(scene, isa);
    ReachMemory memory;
    fill(plan, geometry_of(scene), memory, Words(true));
    warn(plan);
    return plan;
}

struct Planner::Memory {
    bool has_geometry = false;
    Geometry geometry;  // with everything that balls may hit
    ReachMemory reach;
};

Planner::Planner(const Scene& scene, kernel::Isa isa)
    : plan_(bare_plan(scene, isa)), memory_(std::make_unique<Memory>()) {}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;

const Plan& Planner::plan(bool same_table) {
    Geometry& geometry = memory_->geometry;
    if (!same_table || !memory_->has_geometry) {
        geometry = geometry_of(plan_.scene);
        memory_->has_geometry = true;
        // The loop refers to pockets by index. Copying their names for every shot would allocate memory.
        for (Pocket& pocket : geometry.pockets) pocket.name.clear();
    }
    try {
        fill(plan_, geometry, memory_->reach, Words(false));
    } catch (const SceneError&) {  // [effects] excludes a needed one; the error must say why
        fill(plan_, geometry, memory_->reach, Words(true));
        throw;
    }
    return plan_;
}

bool loses_nothing(const Plan& plan) {
    for (const Effect effect : {Effect::kSliding, Effect::kRolling, Effect::kSpinDecay, Effect::kThrow,
                                Effect::kClothInImpact, Effect::kPockets, Effect::kAirborne})
        if (plan.in_force(effect)) return false;
    const BallParams& p = plan.balls;
    const bool balls = !plan.pairs || !plan.ball_ball->reads_restitution || p.e_b == 1.0;
    const bool smooth = plan.cushion == &kSmooth && plan.jaw == &kSmooth;
    const bool cushions = !plan.in_force(Effect::kCushions) || (smooth && p.e_c == 1.0 && p.e_c_fall == 0.0);
    return balls && cushions;
}

}  // namespace carom
