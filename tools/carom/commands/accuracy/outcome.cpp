// The outcome of a shot, its difference from another run of the shot, and its gain.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/setup.h"
#include "carom/engine/simulate.h"
#include "commands/accuracy/scene.h"
#include "reference/contact_phase.h"
#include "reference/solver.h"

namespace carom::tools {
namespace {

/// A ToleranceFunction that calls the power series of the tests, rounded to double.
void by_power_series(const kernel::Ball& ball1, const kernel::Ball& ball2, const kernel::ImpactParams& params,
                     double tolerance, kernel::ImpactResult& result) noexcept {
    const reference::ImpactTruth truth = reference::reference_impact(ball1, ball2, params);
    if (!truth.ok) {  // separating or bad: the kernel reports it
        kernel::tolerance_function(kernel::Isa::kScalar)(ball1, ball2, params, tolerance, result);
        if (result.status == kernel::ImpactStatus::kOk) result.status = kernel::ImpactStatus::kStepLimit;
        return;
    }
    for (int k = 0; k < 3; ++k) {
        result.v1[k] = static_cast<double>(truth.v1[k]);
        result.w1[k] = static_cast<double>(truth.w1[k]);
        result.v2[k] = static_cast<double>(truth.v2[k]);
        result.w2[k] = static_cast<double>(truth.w2[k]);
    }
    result.steps = truth.steps;
    result.status = kernel::ImpactStatus::kOk;
    result.method = kernel::ToleranceMethod::kNone;
}

}  // namespace

ShotContacts contacts_of(const Scene& scene, const Record& record) {
    ShotContacts outcome;
    const int struck = struck_ball(scene);
    for (const Event& event : record.events) {
        if (kind(event.type).phase != EventPhase::kImpact) continue;
        const std::string a = record.tracks.at(event.a).id, b = record.partner_id(event);
        outcome.contacts.push_back(fmt::format("{} {} {}", name(event.type), a, b));
        const bool balls = balls_collide(event.type);
        if (balls && outcome.first_contact.empty() && (event.a == struck || event.b == struck))
            outcome.first_contact = event.a == struck ? b : a;
    }
    for (const BallTrack& track : record.tracks) outcome.pockets.push_back(track.pocket);
    return outcome;
}

std::vector<Vec2> final_positions(const Record& record) {
    std::vector<Vec2> list;
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const Vec3 r = record.state_at(static_cast<int>(i), record.duration).position;
        list.emplace_back(r.x(), r.y());
    }
    return list;
}

FinalError final_error(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
    std::vector<double> apart;
    for (std::size_t i = 0; i < a.size(); ++i) apart.push_back((a[i] - b[i]).norm());
    if (apart.empty()) return {};
    return {*std::max_element(apart.begin(), apart.end()), median(apart)};
}

bool has_clusters(const Record& record) {
    return std::any_of(record.events.begin(), record.events.end(),
                       [](const Event& e) { return e.type == EventType::kBallCluster; });
}

double twin_step(const Record& record) {
    return has_clusters(record) ? 1e-9 : 1e-12;
}

double gain_of(const Plan& plan, const Record& record) {
    const int struck = struck_ball(plan.scene);
    if (struck < 0) return 1.0;  // nothing moves: an offset stays as it is
    const std::vector<Vec2> end = final_positions(record);
    const auto ball = static_cast<std::size_t>(struck);
    double gain = 0.0;
    for (const int axis : {0, 1}) {
        Plan twin = plan;
        Vec3& position = twin.scene.ball[ball].position;
        const double before = position[axis];
        position[axis] = before + twin_step(record);
        const double step = position[axis] - before;  // the step after rounding
        if (step == 0.0) continue;
        gain =
            std::max(gain, final_error(final_positions(simulate(twin, interruptible())), end).largest / step);
    }
    return gain;
}

std::optional<double> deserved_tolerance(double gain, double target) {
    const double most = target / (std::max(gain, 1.0) * kFlight);
    for (const double tolerance :
         {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, kernel::kTightestTolerance})
        if (tolerance <= most) return tolerance;
    return std::nullopt;
}

Plan with_tolerance(const Scene& scene, double tolerance) {
    Scene copy = scene;
    copy.physics.substeps.reset();
    copy.physics.march = March::kSummed;
    copy.physics.tolerance = tolerance;
    return make_plan(copy, chosen_isa());
}

Plan with_substeps(const Scene& scene, int substeps, March march) {
    Scene copy = scene;
    copy.physics.substeps = substeps;
    copy.physics.march = march;
    Plan plan = make_plan(copy, chosen_isa());
    // The published result is of an impact that takes no time; here only its steps are compared.
    plan.contact_time = with_tolerance(scene, kDefaultTolerance).contact_time;
    return plan;
}

Plan with_reference(const Scene& scene) {
    Plan plan = with_tolerance(scene, kernel::kTightestTolerance);
    plan.impact.by_tolerance = &by_power_series;
    plan.contact_phase = &reference::contact_phase;
    return plan;
}

}  // namespace carom::tools
