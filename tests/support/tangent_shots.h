// Shots with their derivatives, and differences to compare them with.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"
#include "carom/engine/tangents.h"

#include "support/hard_scenes.h"

namespace carom::test {

inline Scene scene_of(const std::string& name) {
    return read_scene(std::string(CAROM_SOURCE_DIR) + "/scenes/" + name + ".toml");
}

struct Shot {
    Shot(const Scene& scene, const std::vector<std::string>& inputs)
        : plan(plan_of(scene)), record(simulate(plan)), tangents(plan, record, inputs) {}
    Plan plan;
    Record record;
    Tangents tangents;
};

/// The final states of all balls that stay, and the times at which the others fell.
inline std::vector<double> results(const Record& record) {
    std::vector<double> all;
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallState end = record.state_at(static_cast<int>(i), record.duration);
        if (!is_gone(end.state)) all.insert(all.end(), {end.position.x(), end.position.y()});
    }
    for (const Event& e : record.events) all.push_back(e.type == EventType::kBallOut ? 0.0 : e.time);
    return all;
}
inline std::vector<double> derivatives(const Shot& shot, std::size_t input) {
    std::vector<double> all;
    for (std::size_t i = 0; i < shot.record.tracks.size(); ++i) {
        const int ball = static_cast<int>(i);
        if (is_gone(shot.record.state_at(ball, shot.record.duration).state)) continue;
        const Vec3 d = shot.tangents.at_end(ball, input).position;
        all.insert(all.end(), {d.x(), d.y()});
    }
    for (std::size_t e = 0; e < shot.record.events.size(); ++e)
        all.push_back(shot.record.events[e].type == EventType::kBallOut ? 0.0
                                                                        : shot.tangents.event_time(e, input));
    return all;
}
inline bool same_order(const Record& one, const Record& two) {
    return std::equal(
        one.events.begin(), one.events.end(), two.events.begin(), two.events.end(),
        [](const Event& p, const Event& q) { return p.type == q.type && p.a == q.a && p.b == q.b; });
}

/// The largest difference of two lists, relative to the largest number of the second.
inline double apart(const std::vector<double>& one, const std::vector<double>& two) {
    double worst = 0.0, largest = 1e-3;
    for (std::size_t i = 0; i < one.size(); ++i) {
        worst = std::max(worst, std::abs(one[i] - two[i]));
        largest = std::max(largest, std::abs(two[i]));
    }
    return worst / largest;
}

/// The error of the derivatives against four-point differences, at the step that agrees best with the next
/// larger and smaller ones. Nothing if no three steps agree: an event is too near, or the shot amplifies its
/// rounding too much. Two steps may agree by chance (seed 400 of han_2005).
inline std::optional<double> error_of(const Scene& scene, const Shot& shot, const std::string& key,
                                      std::size_t input) {
    const SceneNumber number(scene, key);
    const double value = number.value(scene);
    const std::vector<double> exact = derivatives(shot, input);
    std::vector<double> last;
    double best = 5e-10, last_apart = std::numeric_limits<double>::infinity();
    std::optional<double> error;
    for (double h = 1e-3; h > 1e-8; h /= 3.0) {
        std::vector<double> sum(exact.size(), 0.0);
        bool holds = true;
        for (const auto& [steps, weight] : {std::pair{-2.0, 1.0}, {-1.0, -8.0}, {1.0, 8.0}, {2.0, -1.0}}) {
            Scene moved = scene;
            number.put(moved, value + steps * h);
            const Record record = simulate(plan_of(moved));
            holds = holds && same_order(record, shot.record);
            if (!holds) break;
            const std::vector<double> all = results(record);
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * all[i] / (12.0 * h);
        }
        if (!holds) continue;
        if (!last.empty()) {
            const double now = apart(last, sum), worse = std::max(now, last_apart);
            last_apart = now;
            if (worse < best) {
                best = worse;
                error = apart(last, exact);
            }
        }
        last = sum;
    }
    return error;
}

/// The cue ball meets one of three touching balls, `off` radii beside its centre.
inline Scene combination(double off) {
    Scene scene = empty_scene();
    const double R = scene.balls.R;
    add_ball(scene, "cue", {0.0, off * R, R});
    add_ball(scene, "1", {0.5, 0.0, R});
    for (const auto& [id, angle] : {std::pair{"2", 0.6}, {"3", -0.9}})
        add_ball(scene, id, {0.5 + 2.0 * R * std::cos(angle), 2.0 * R * std::sin(angle), R});
    scene.cue = Cue();
    scene.cue->speed = 2.0;
    scene.cue->aim_deg = 0.0;
    // Differences of shots are as smooth as the clusters are exact.
    scene.physics.tolerance = 1e-11;
    return scene;
}

}  // namespace carom::test
