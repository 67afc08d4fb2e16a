#include "carom/engine/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "record/inputs_json.h"
#include "record/verify_between.h"
#include "record/verify_effects.h"
#include "record/verify_events.h"
#include "record/verify_motion.h"

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

/// The inputs that a record repeats: the first of them that differs names another scene.
nlohmann::ordered_json inputs_of(const Record& record) {
    nlohmann::ordered_json inputs = {{"gravity", record.gravity}}, balls = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallSize size = record.size(static_cast<int>(i));
        balls.push_back({{"id", record.tracks[i].id}, {"radius", size.R}, {"mass", size.m}});
    }
    inputs["ball"] = balls;
    inputs["table"] = table_json(record.table);
    inputs["balls"] = balls_json(record.balls);
    return inputs;
}

}  // namespace

void require_scene(const Record& record, const Plan& plan, const std::string& name) {
    Record of;
    of.table = plan.scene.table;
    of.balls = plan.balls;
    of.gravity = plan.gravity;
    for (const BallStart& ball : plan.scene.ball) of.tracks.push_back({ball.id, {}, -1, ball.own});
    const nlohmann::ordered_json asked = inputs_of(of), found = inputs_of(record);
    const auto changes = nlohmann::ordered_json::diff(asked, found);
    if (changes.empty()) return;
    const nlohmann::ordered_json::json_pointer at(changes[0]["path"].get<std::string>());
    const auto value = [&at](const nlohmann::ordered_json& all) {
        return all.contains(at) ? all[at].dump() : std::string("missing");
    };
    std::string key = at.to_string().substr(1);
    std::replace(key.begin(), key.end(), '/', '.');
    throw SceneError(
        name, {},
        fmt::format("the record is of another scene or physics: {} is {}, and {} in the scene; use "
                    "the scene that it was made from",
                    key, value(found), value(asked)));
}

std::string describe(const Violation& violation, const Record& record) {
    std::string where = "after the last event";
    if (violation.event < record.events.size()) {
        const Event& event = record.events[violation.event];
        where = fmt::format("event {} ({} {} {}, t = {:.17g} s)", violation.event, name(event.type),
                            record.tracks.at(event.a).id, record.partner_id(event), event.time);
    }
    return fmt::format("{} broken at {}: {}", violation.law, where, violation.message);
}

double energy_at(const Record& record, double t) {
    double energy = 0.0;
    for (int i = 0; i < static_cast<int>(record.tracks.size()); ++i)
        energy += ball_energy(record, i, record.state_at(i, t));
    return energy;
}

std::optional<Violation> verify(const Record& record, const Plan& plan) {
    if (auto violation = check_finite(record)) return violation;
    if (auto violation = verify_motion(record, plan)) return violation;
    if (auto violation = verify_events(record, plan)) return violation;
    if (auto violation = verify_end(record, plan)) return violation;
    if (auto violation = verify_between(record, plan, keeps_energy(plan))) return violation;
    return verify_skipped(record, plan);
}

}  // namespace carom
