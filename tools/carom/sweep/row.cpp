#include "sweep/row.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

#include "carom/engine/simulate.h"
#include "console.h"

namespace carom::tools {
namespace {

/// Text as a field of a CSV file: on one line, in quotes where it needs them.
std::string field(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    if (text.find_first_of(",\"") == text.npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
}

/// The ball that is struck, or else the first one that moves; -1 where none does.
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
            const std::vector<int>& members = record.clusters.at(static_cast<std::size_t>(e.detail));
            if (std::find(members.begin(), members.end(), ball) != members.end())
                other = nearest(record, members, ball, e.time);
        }
        if (other >= 0) return record.tracks.at(static_cast<std::size_t>(other)).id;
    }
    return "";
}

ShotOutcome outcome_of(StopReason reason) {
    switch (reason) {
        case StopReason::kAtRest:
            return ShotOutcome::kAtRest;
        case StopReason::kTime:
            return ShotOutcome::kTime;
        case StopReason::kEndless:
            return ShotOutcome::kEndless;
        case StopReason::kEvents:
            break;
    }
    return ShotOutcome::kEvents;
}

void write_results(fmt::memory_buffer& out, const Scene& scene, const Record& record) {
    const auto at = std::back_inserter(out);
    std::string pocketed;
    for (const Event& e : record.events) {
        if (e.type != EventType::kBallPocket) continue;
        pocketed += (pocketed.empty() ? "" : ";") + record.tracks.at(static_cast<std::size_t>(e.a)).id;
    }
    const int ball = shooter(scene);
    fmt::format_to(at, ",{},{},{},{}", record.duration, record.events.size(),
                   ball < 0 ? "" : first_contact(record, ball), pocketed);
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallState s = record.state_at(static_cast<int>(i), record.duration);
        fmt::format_to(at, ",{},{},{}", s.position.x(), s.position.y(),
                       s.pocket < 0 ? "" : record.table.pockets.at(static_cast<std::size_t>(s.pocket)).id);
    }
    fmt::format_to(at, ",\n");
}

}  // namespace

const char* name(ShotOutcome outcome) {
    constexpr const char* kNames[kShotOutcomes] = {"at_rest", "time",    "events",
                                                   "endless", "invalid", "failed"};
    return kNames[static_cast<int>(outcome)];
}

std::string sweep_header(const Variation& variation) {
    std::string header = "shot";
    for (const std::string& key : variation.keys()) header += ',' + field(key);
    header += ",outcome,duration,events,first_contact,pocketed";
    for (const BallStart& ball : variation.base().ball)
        header += fmt::format(",{0}.x,{0}.y,{0}.pocket", ball.id);
    return header + ",message\n";
}

SweepRow sweep_row(const Variation& variation, std::uint64_t index, kernel::Isa isa) {
    const VariedShot shot = variation.shot(index);
    std::string start = fmt::format("{}", index);
    for (const std::string& value : shot.values) start += ',' + field(value);
    const auto without_results = [&](ShotOutcome outcome, const std::string& message) {
        const std::size_t empty = 4 + 3 * variation.base().ball.size();
        return SweepRow{
            fmt::format("{},{}{},{}\n", start, name(outcome), std::string(empty, ','), field(message)),
            outcome};
    };
    if (!shot.scene) return without_results(ShotOutcome::kInvalid, shot.error);
    SimulateOptions options;
    options.progress = [](std::size_t, double) { throw_if_interrupted(); };
    try {
        const Record record = simulate(make_plan(*shot.scene, isa), options);
        const ShotOutcome outcome = outcome_of(record.stopped);
        fmt::memory_buffer out;
        fmt::format_to(std::back_inserter(out), "{},{}", start, name(outcome));
        write_results(out, *shot.scene, record);
        return {fmt::to_string(out), outcome};
    } catch (const SceneError& error) {  // [effects] refuses what these values need
        return without_results(ShotOutcome::kInvalid, error.message());
    } catch (const SimulationError& error) {
        return without_results(ShotOutcome::kRunFailed, error.what());
    }
}

}  // namespace carom::tools
