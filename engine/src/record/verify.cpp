#include "carom/engine/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "carom/engine/airborne.h"
#include "carom/engine/tolerances.h"
#include "contact/touch.h"
#include "physics/motion.h"
#include "record/gaps.h"
#include "record/verify_between.h"
#include "record/verify_effects.h"
#include "record/verify_events.h"

namespace carom {

namespace {

bool keeps_energy(const Plan& plan) {
    const Physics& physics = plan.scene.physics;
    return !plan.ball_ball->reads_cloth ||
           (physics.cloth_slip == kernel::ClothSlip::kConsistent && physics.substeps.value_or(100) >= 100);
}

std::optional<Violation> check_finite(const Record& record) {
    for (const BallTrack& track : record.tracks) {
        for (const Segment& s : track.segments) {
            const bool ok = std::isfinite(s.start) && s.r.allFinite() && s.v.allFinite() && s.w.allFinite() &&
                            s.a.allFinite() && s.dw.allFinite() && std::isfinite(s.spin_decay) &&
                            !std::isnan(s.duration) && s.duration >= 0.0;
            if (!ok)
                return Violation{
                    0, "U1",
                    fmt::format("ball {} at {:.17g} s has a number that is not finite", track.id, s.start)};
        }
    }
    return std::nullopt;
}

}  // namespace

double energy_at(const Record& record, double t) {
    double energy = 0.0;
    for (int i = 0; i < static_cast<int>(record.tracks.size()); ++i)
        energy += ball_energy(record, i, record.state_at(i, t));
    return energy;
}

std::optional<Violation> verify(const Record& record, const Plan& plan) {
    if (auto violation = check_finite(record)) return violation;
    if (auto violation = verify_events(record, plan)) return violation;
    if (auto violation = verify_between(record, plan, keeps_energy(plan))) return violation;
    return verify_skipped(record, plan);
}

}  // namespace carom
