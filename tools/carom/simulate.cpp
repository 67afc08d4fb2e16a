// carom simulate: runs a scene and says what happened.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include <memory>
#include "base/output_file.h"
#include "carom/engine/verify.h"
#include "console.h"
#include "options.h"
#include "report/csv.h"
#include "setup.h"

namespace carom::tools {
namespace {

struct SimulateArgs {
    std::string scene;
    std::string record;  ///< file names; empty: not asked for
    std::string events;
    std::string samples;
    std::optional<double> sample_dt;  ///< [s]
    std::optional<double> until;      ///< [s]
    bool hash = false;
    bool profile = false;
    bool json = false;
    bool verify = false;  ///< check the laws after every event
};

/// Sums of a profiled run over the events of one kind [ns].
struct CostSum {
    long count = 0;
    double detect = 0.0, resolve = 0.0, kernel = 0.0;
};

std::array<CostSum, kEventTypes> costs_by_kind(const Record& record) {
    std::array<CostSum, kEventTypes> sums{};
    for (std::size_t i = 0; i < record.costs.size(); ++i) {
        CostSum& sum = sums[static_cast<std::size_t>(record.events.at(i).type)];
        ++sum.count;
        sum.detect += record.costs[i].detect_ns;
        sum.resolve += record.costs[i].resolve_ns;
        sum.kernel += record.costs[i].kernel_ns;
    }
    return sums;
}

std::string result_json(const Record& record) {
    using Json = nlohmann::ordered_json;
    const auto numbers = [](const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); };
    Json balls = Json::array();
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallState s = record.state_at(static_cast<int>(i), record.duration);
        Json pocket = nullptr;
        if (s.pocket >= 0) pocket = record.table.pockets.at(static_cast<std::size_t>(s.pocket)).id;
        balls.push_back({{"id", record.tracks[i].id},
                         {"state", name(s.state)},
                         {"position", numbers(s.position)},
                         {"velocity", numbers(s.velocity)},
                         {"spin", numbers(s.spin)},
                         {"pocket", pocket}});
    }
    Json all = {{"duration", record.duration},
                {"events", record.events.size()},
                {"hash", record.hash()},
                {"balls", balls}};
    if (!record.costs.empty()) {
        Json kinds = Json::array();
        const std::array<CostSum, kEventTypes> sums = costs_by_kind(record);
        for (int type = 0; type < kEventTypes; ++type) {
            const CostSum& sum = sums[type];
            if (sum.count == 0) continue;
            kinds.push_back({{"type", name(static_cast<EventType>(type))},
                             {"count", sum.count},
                             {"detect_ns", sum.detect},
                             {"resolve_ns", sum.resolve},
                             {"kernel_ns", sum.kernel}});
        }
        all["profile"] = {{"setup_detect_ns", record.setup_detect_ns}, {"kinds", kinds}};
    }
    return all.dump() + "\n";
}

const char* reason(StopReason stopped) {
    switch (stopped) {
        case StopReason::kAtRest:
            return "everything is at rest";
        case StopReason::kTime:
            return "stopped at its time";
        case StopReason::kEvents:
            return "stopped at its number of events";
        case StopReason::kEndless:
            return "nothing more happens, but balls move for ever";
    }
    return "";
}

std::string summary(const Record& record, const std::string& scene) {
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    fmt::format_to(line, "{}: {}, {:.4f} s, {}; {}\n\nevents\n", scene, counted(record.tracks.size(), "ball"),
                   record.duration, counted(record.events.size(), "event"), reason(record.stopped));
    std::array<long, kEventTypes> counts{};
    for (const Event& event : record.events) ++counts[static_cast<std::size_t>(event.type)];
    for (int type = 0; type < kEventTypes; ++type) {
        const long count = counts[type];
        if (count > 0) fmt::format_to(line, "  {:<22}{:>6}\n", name(static_cast<EventType>(type)), count);
    }
    fmt::format_to(line, "\npocketed\n");
    long pocketed = 0;
    for (const Event& event : record.events) {
        if (event.type != EventType::kBallPocket) continue;
        ++pocketed;
        fmt::format_to(line, "  {:<6} in {} at {:.4f} s\n",
                       record.tracks.at(static_cast<std::size_t>(event.a)).id, record.partner_id(event),
                       event.time);
    }
    if (pocketed == 0) fmt::format_to(line, "  none\n");
    fmt::format_to(line, "\nballs at the end (m)\n");
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallState s = record.state_at(static_cast<int>(i), record.duration);
        fmt::format_to(line, "  {:<6} {:<11}{:>11.6f}{:>11.6f}\n", record.tracks[i].id, name(s.state),
                       s.position.x(), s.position.y());
    }
    return fmt::to_string(out);
}

/// Where the time of a profiled run went.
std::string profile_report(const Record& record) {
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    const std::array<CostSum, kEventTypes> sums = costs_by_kind(record);
    fmt::format_to(line, "\ncost by kind of event (mean ns; kernel is a part of resolve)\n");
    fmt::format_to(line, "  {:<22}{:>6}{:>12}{:>12}{:>12}\n", "", "count", "detect", "resolve", "kernel");
    double total = record.setup_detect_ns;
    for (int type = 0; type < kEventTypes; ++type) {
        const CostSum& sum = sums[type];
        if (sum.count == 0) continue;
        const auto n = static_cast<double>(sum.count);
        total += sum.detect + sum.resolve;
        fmt::format_to(line, "  {:<22}{:>6}{:>12.0f}{:>12.0f}{:>12.0f}\n", name(static_cast<EventType>(type)),
                       sum.count, sum.detect / n, sum.resolve / n, sum.kernel / n);
    }
    fmt::format_to(line, "  first detection of all pairs: {:.0f} ns; all together: {:.3f} ms\n",
                   record.setup_detect_ns, total * 1e-6);
    fmt::format_to(line, "\nkernel by ball-ball event and cluster\n  {:>12}  {:<12}{:>12}{:>8}  {}\n",
                   "time (s)", "balls", "ns", "steps", "method");
    for (std::size_t i = 0; i < record.costs.size(); ++i) {
        const Event& event = record.events[i];
        if (event.type != EventType::kBallBall && event.type != EventType::kBallCluster) continue;
        const EventCost& cost = record.costs[i];
        fmt::format_to(
            line, "  {:>12.6f}  {:<12}{:>12.0f}{:>8}  {}\n", event.time,
            record.tracks.at(static_cast<std::size_t>(event.a)).id + " " + record.partner_id(event),
            cost.kernel_ns, cost.steps, cost.method);
    }
    return fmt::to_string(out);
}

void check_args(const SimulateArgs& args) {
    if (!args.samples.empty() && !args.sample_dt) throw UsageError("--samples needs --sample-dt S");
    if (args.samples.empty() && args.sample_dt) throw UsageError("--sample-dt needs --samples FILE");
    if (args.sample_dt && !(*args.sample_dt > 0.0 && std::isfinite(*args.sample_dt))) {
        throw UsageError("--sample-dt: expected a number of seconds greater than 0");
    }
    if (args.until && !(*args.until >= 0.0 && std::isfinite(*args.until))) {
        throw UsageError("--until: expected a number of seconds of at least 0");
    }
}

void write_files(const SimulateArgs& args, const Record& record) {
    if (!args.record.empty()) write_record(record, args.record);
    if (!args.events.empty()) {
        OutputFile file(args.events);
        write_events_csv(record, file);
        file.commit();
    }
    if (!args.samples.empty()) {
        OutputFile file(args.samples);
        write_samples_csv(record, *args.sample_dt, file);
        file.commit();
    }
}

/// Names the first law that the run broke, if any.
int verified(const Record& record, const Plan& plan) {
    const std::optional<Violation> violation = verify(record, plan);
    if (!violation) return kOk;
    std::string where = "after the last event";
    if (violation->event < record.events.size()) {
        const Event& event = record.events[violation->event];
        where = fmt::format("event {} ({} {} {}, t = {:.17g} s)", violation->event, name(event.type),
                            record.tracks.at(static_cast<std::size_t>(event.a)).id, record.partner_id(event),
                            event.time);
    }
    message(fmt::format("{} broken at {}: {}", violation->law, where, violation->message));
    return kFailed;
}

int run(const SimulateArgs& args) {
    check_args(args);
    const Plan plan = plan_scene(args.scene);
    SimulateOptions options;
    options.profile = args.profile;
    options.until = args.until;
    const Record record = simulate_plan(plan, options);
    write_files(args, record);
    const int status = args.verify ? verified(record, plan) : kOk;
    // --hash stands for the summary, so that alone it is one line and nothing else; --json holds the hash
    // anyway.
    if (args.json) {
        print(result_json(record));
        return status;
    }
    print(args.hash ? record.hash() + "\n" : summary(record, args.scene));
    if (args.profile) print(profile_report(record));
    return status;
}

}  // namespace

void add_simulate(Options& program) {
    auto args = std::make_shared<SimulateArgs>();
    Options& command =
        program.command("simulate", "Run a scene: what happened, events, record, sampled states, hash");
    command.argument("SCENE", args->scene, "Scene file (TOML)").required = true;
    command.option("-o,--output", &args->record, "FILE.json",
                   "Write the record, for carom render (default: not written)");
    command.option("--events", &args->events, "FILE.csv", "Write the events (default: not written)");
    command.option("--samples", &args->samples, "FILE.csv",
                   "Write sampled states; needs --sample-dt (default: not written)");
    command.option("--sample-dt", &args->sample_dt, "S", "Time between samples in s (default: none)");
    command.option("--until", &args->until, "S",
                   "Stop at this time in s at the latest (default: the scene's end)");
    command.flag("--hash", args->hash,
                 "Print the hash of all bits of the record instead of the summary (default: off)");
    command.flag("--profile", args->profile,
                 "Time every event: cost by kind, kernel by ball-ball event, columns in the events file "
                 "(default: off)");
    command.flag("--json", args->json, "Print JSON (default: off)");
    command.flag(
        "--verify", args->verify,
        "Check the laws after every event; a broken one is named, and the exit status is 1 (default: off)");
    command.run = [args] { return run(*args); };
}

}  // namespace carom::tools
