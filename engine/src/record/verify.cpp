#include "carom/engine/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "contact/detect.h"
#include "contact/roots.h"
#include "contact/touch.h"
#include "physics/motion.h"
#include "record/record_json.h"
#include "record/verify_parts.h"

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

namespace {

class Skipped {
  public:
    Skipped(const Record& record, const Plan& plan) : record_(record), plan_(plan) {}

    std::optional<Violation> run() {
        const Scene& scene = plan_.scene;
        // If no event can follow the run, its last segments continue forever.
        const bool for_ever =
            record_.stopped == StopReason::kAtRest || record_.stopped == StopReason::kEndless;
        last_ = for_ever ? kNever : record_.duration;
        const bool check_cushions = plan_.geometry.cushions.empty() && plan_.geometry.noses.empty() &&
                                    !(scene.table.cushions.empty() && scene.table.jaws.empty());
        const bool check_pockets = plan_.geometry.pockets.empty() && !scene.table.pockets.empty();
        for (std::size_t i = 0; i < record_.tracks.size() && !found_; ++i) {
            const std::vector<Segment>& segments = record_.tracks[i].segments;
            for (std::size_t k = 0; k < segments.size() && !found_; ++k) {
                ball_ = &record_.tracks[i].id;
                R_ = record_.size(static_cast<int>(i)).R;
                start_ = segments[k].start;
                const double end = end_of(segments, k);
                if (is_gone(segments[k].state) || end < start_) continue;
                check_frictions(segments[k], end > start_);
                const Path path = path_of(segments[k], start_, end);
                if (check_cushions) check_table(path);
                if (check_pockets) check_pocket(path);
                if (!plan_.pairs && path.moves) check_pairs(static_cast<int>(i), segments[k], end);
            }
        }
        return found_;
    }

  private:
    void need(const char* keyword, const std::string& what) {
        if (found_) return;
        std::size_t event = 0;
        while (event < record_.events.size() && record_.events[event].time <= start_) ++event;
        found_ = Violation{
            event, "E",
            fmt::format("the plan skips {}, but ball {} {} after {:.17g} s", keyword, *ball_, what, start_)};
    }

    double end_of(const std::vector<Segment>& segments, std::size_t k) const {
        return k + 1 < segments.size() ? segments[k + 1].start : last_;
    }

    /// The part of a segment, which has already begun, between two times.
    static Path path_of(const Segment& s, double from, double to) {
        const double t = from - s.start;
        return {s.r.head<2>() + t * (s.v.head<2>() + 0.5 * t * s.a),
                s.v.head<2>() + t * s.a,
                s.a,
                std::min(to - from, s.duration - t),
                s.state == MotionState::kRolling,
                translates(s.state)};
    }

    // A segment replaced at the same instant never happened.
    void check_frictions(const Segment& s, bool lasts) {
        if (!lasts) return;
        const BallParams& p = plan_.scene.balls;
        if (!plan_.in_force(Effect::kAirborne) && flies(s.state)) need("airborne", "flies");
        if (!plan_.in_force(Effect::kSpinDecay) && p.mu_sp * plan_.gravity != 0.0 && s.w.z() != 0.0)
            need("spin_decay", "has vertical spin");
        if (!plan_.in_force(Effect::kSliding) && p.mu_s * plan_.gravity != 0.0 &&
            s.state == MotionState::kSliding)
            need("sliding", "slips");
        if (!plan_.in_force(Effect::kRolling) && p.mu_r * plan_.gravity != 0.0 &&
            s.state == MotionState::kRolling)
            need("rolling", "rolls");
    }

    void check_table(const Path& path) {
        for (const Cushion& c : plan_.scene.table.cushions) {
            const bool meets = time_to_line(path, line_of(c, 0.0), R_) < kNever ||
                               time_to_circle(path, c.from, R_) < kNever ||
                               time_to_circle(path, c.to, R_) < kNever;
            if (meets) need("cushions", "meets cushion " + c.id);
        }
        for (const Jaw& j : plan_.scene.table.jaws)
            if (time_to_nose(path, nose_of(j, 0, 0.0), R_) < kNever) need("cushions", "meets jaw " + j.id);
    }

    void check_pocket(const Path& path) {
        for (const Pocket& p : plan_.scene.table.pockets) {
            if (is_inside(p, path.r) || time_to_pocket(path, p.center, p.radius) < kNever)
                need("pockets", "enters pocket " + p.id);
        }
    }

    // Meanwhile, every other ball moves along its own segments.
    void check_pairs(int ball, const Segment& s, double end) {
        for (std::size_t j = 0; j < record_.tracks.size(); ++j) {
            if (static_cast<int>(j) == ball) continue;
            const double reach =
                contact_distance(R_, record_.size(static_cast<int>(j)).R, record_.balls.discs());
            const std::vector<Segment>& others = record_.tracks[j].segments;
            for (std::size_t k = 0; k < others.size(); ++k) {
                const double from = std::max(s.start, others[k].start), to = std::min(end, end_of(others, k));
                if (is_gone(others[k].state) || to < from) continue;
                if (time_to_ball(path_of(s, from, to), path_of(others[k], from, to), reach) < kNever)
                    need("ball-ball impacts", "meets ball " + record_.tracks[j].id);
            }
        }
    }

    const Record& record_;
    const Plan& plan_;
    double R_ = 0.0;  // of that ball
    const std::string* ball_ = nullptr;
    double start_ = 0.0;  // [s] of its segment
    double last_ = 0.0;   // [s] when the last segments end
    std::optional<Violation> found_;
};

}  // namespace

std::optional<Violation> verify_skipped(const Record& record, const Plan& plan) {
    return Skipped(record, plan).run();
}

}  // namespace carom
