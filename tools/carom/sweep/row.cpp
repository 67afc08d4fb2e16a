#include "sweep/row.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

#include "carom/engine/simulate.h"
#include "setup.h"

namespace carom::tools {
namespace {

/// The ball that is struck, or else the first one that moves; -1 if no ball moves.
int shooter(const Scene& scene) {
    for (std::size_t i = 0; i < scene.ball.size(); ++i) {
        const BallStart& ball = scene.ball[i];
        const bool moves =
            scene.cue ? ball.id == scene.cue->ball : !ball.velocity.isZero(0.0) || !ball.spin.isZero(0.0);
        if (moves) return static_cast<int>(i);
    }
    return -1;
}

/// The ball of a cluster that is nearest to one of its members.
int nearest(const Record& record, const std::vector<int>& cluster, int ball, double time) {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    const Vec3 p = record.state_at(ball, time).position;
    for (const int other : cluster) {
        const double distance = other == ball ? least : (record.state_at(other, time).position - p).norm();
        if (distance >= least) continue;
        least = distance;
        best = other;
    }
    return best;
}

/// The id of the first ball that the shooter touches, or "".
std::string first_contact(const Record& record, int ball) {
    for (const Event& e : record.events) {
        const bool cluster = e.type == EventType::kBallCluster;
        if (!cluster && e.type != EventType::kBallBall && e.type != EventType::kBallBallHold) continue;
        int other = e.a == ball ? e.b : e.b == ball ? e.a : -1;
        if (other < 0 && cluster) {
            const std::vector<int>& members = record.clusters.at(e.detail);
            if (std::find(members.begin(), members.end(), ball) != members.end())
                other = nearest(record, members, ball, e.time);
        }
        if (other >= 0) return record.tracks.at(other).id;
    }
    return "";
}

/// The ids of the balls that were pocketed, in order.
std::string pocketed(const Record& record) {
    std::string ids;
    for (const Event& e : record.events)
        if (e.type == EventType::kBallPocket) ids += (ids.empty() ? "" : ";") + record.tracks.at(e.a).id;
    return ids;
}

}  // namespace

const char* name(ShotOutcome outcome) {
    constexpr const char* kNames[kShotOutcomes] = {"at_rest", "time",    "events",
                                                   "endless", "invalid", "failed"};
    return kNames[static_cast<int>(outcome)];
}

std::vector<SweepColumn> sweep_columns(const Variation& variation) {
    std::vector<SweepColumn> columns;
    const auto add = [&columns](std::string key, std::function<Cell(const SweptShot&)> value) {
        columns.push_back({std::move(key), std::move(value)});
    };
    const auto add_result = [&add](const std::string& key, auto value) {
        add(key, [value](const SweptShot& s) { return s.record ? Cell(value(s)) : Cell(); });
    };
    add("shot", [](const SweptShot& s) { return Cell(s.index); });
    for (std::size_t i = 0; i < variation.keys().size(); ++i)
        add(variation.keys()[i], [i](const SweptShot& s) { return Cell(s.varied.values.at(i)); });
    add("outcome", [](const SweptShot& s) { return Cell(name(s.outcome)); });
    add_result("duration", [](const SweptShot& s) { return s.record->duration; });
    add_result("events", [](const SweptShot& s) { return s.record->events.size(); });
    add_result("first_contact", [](const SweptShot& s) {
        const int ball = shooter(*s.varied.scene);
        return ball < 0 ? "" : first_contact(*s.record, ball);
    });
    add_result("pocketed", [](const SweptShot& s) { return pocketed(*s.record); });
    const std::vector<BallStart>& balls = variation.base().ball;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        add_result(balls[i].id + ".x", [i](const SweptShot& s) { return s.end.at(i).position.x(); });
        add_result(balls[i].id + ".y", [i](const SweptShot& s) { return s.end.at(i).position.y(); });
        add_result(balls[i].id + ".pocket", [i](const SweptShot& s) {
            const int pocket = s.end.at(i).pocket;
            return pocket < 0 ? "" : s.record->table.pockets.at(pocket).id;
        });
    }
    add("message", [](const SweptShot& s) { return Cell(s.message); });
    return columns;
}

SweptShot swept_shot(const Variation& variation, std::uint64_t index, kernel::Isa isa) {
    SweptShot shot;
    shot.index = index;
    shot.varied = variation.shot(index);
    shot.message = shot.varied.error;
    if (!shot.varied.scene) return shot;
    try {
        shot.record = simulate(make_plan(*shot.varied.scene, isa), interruptible());
        shot.outcome = static_cast<ShotOutcome>(shot.record->stopped);
        for (std::size_t i = 0; i < shot.record->tracks.size(); ++i)
            shot.end.push_back(shot.record->state_at(static_cast<int>(i), shot.record->duration));
    } catch (const SceneError& error) {  // [effects] refuses what these values need
        shot.message = error.message();
    } catch (const SimulationError& error) {
        shot.outcome = ShotOutcome::kRunFailed;
        shot.message = error.what();
    }
    return shot;
}

}  // namespace carom::tools
