// carom simulate: runs a scene and reports what happened.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/console.h"
#include "base/game_state.h"
#include "base/options.h"
#include "base/setup.h"
#include "base/shown_units.h"
#include "base/verdict.h"
#include "carom/engine/printable.h"
#include "carom/engine/simulate.h"
#include "carom/engine/verify.h"
#include "carom/games/measures.h"
#include "carom/interface/shape.h"
#include "commands/simulate/story.h"
#include "report/csv.h"
#include "report/table.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

struct SimulateArgs {
    std::string scene;
    std::string checked;  ///< a record to verify; empty: the run is verified
    std::string record;   ///< file names; empty: not written
    std::string events;
    std::string samples;
    std::optional<double> sample_dt;  ///< [s]
    std::optional<double> until;      ///< [s]
    bool hash = false;
    bool profile = false;
    bool json = false;
    bool list = false;  ///< print every event
    std::string units = kUnits[0];
    bool verify = false;  ///< check the physical laws after every event
    std::vector<std::string> measures;
    std::string game;  ///< rules for measures
};

/// The measures of --measure.
std::vector<games::Measure> measures_of(const SimulateArgs& args, const Scene& scene) {
    std::optional<games::Game> game;
    if (!args.game.empty()) game = game_of(args.game);
    std::vector<games::Measure> list;
    for (const std::string& text : args.measures) {
        try {
            list.emplace_back(text, scene, game);
        } catch (const games::MeasureError& error) {
            throw UsageError(fmt::format("--measure {}", error.what()));
        }
    }
    return list;
}

/// The value of a measure, or the reason why the game cannot judge the shot.
template <class F>
auto measured(const games::Measure& measure, F&& f) {
    try {
        return f();
    } catch (const std::invalid_argument& refused) {
        throw UsageError(fmt::format("--measure {}: {}", measure.text(), refused.what()));
    }
}

/// The total cost of a profiled run's events, by kind. The text shows the means.
Table costs_by_kind(const Record& record) {
    Table table(Column("type", "", "<24"), Column("count", "count", ">6"),
                Column("detect_ns", "detect", ">12"), Column("resolve_ns", "resolve", ">12"),
                Column("kernel_ns", "kernel", ">12"));
    for (int type = 0; type < kEventTypes; ++type) {
        long count = 0;
        double detect = 0.0, resolve = 0.0, kernel = 0.0;
        for (std::size_t i = 0; i < record.costs.size(); ++i) {
            if (record.events.at(i).type != static_cast<EventType>(type)) continue;
            ++count;
            detect += record.costs[i].detect_ns;
            resolve += record.costs[i].resolve_ns;
            kernel += record.costs[i].kernel_ns;
        }
        if (count == 0) continue;
        const auto mean = [count](double sum) { return Cell(sum, fmt::format("{:.0f}", sum / count)); };
        const std::string title = name(static_cast<EventType>(type));
        table.add({{title, "  " + title}, count, mean(detect), mean(resolve), mean(kernel)});
    }
    return table;
}

std::string result_json(const Scene& scene, const Record& record, const Outcome& outcome,
                        const std::vector<games::Measure>& measures) {
    Json all = interface::value_of(outcome, record, scene);
    Json kinds = Json::object();
    for (const Event& event : record.events) {
        Json& count = kinds[name(event.type)];
        count = count.is_null() ? 1 : count.get<int>() + 1;
    }
    all["events_by_kind"] = kinds;
    all["hash"] = record.hash();
    for (const games::Measure& measure : measures)
        all["measures"][measure.text()] = measured(measure, [&] { return measure_json(measure, record); });
    if (!record.costs.empty()) {
        all["profile"] = {{"setup_detect_ns", record.setup_detect_ns},
                          {"kinds", table_json(costs_by_kind(record))}};
    }
    return all.dump() + "\n";
}

std::string summary(const Record& record, const std::string& scene, const SimulateArgs& args,
                    const std::vector<games::Measure>& measures) {
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    const Units units = units_of(args.units);
    const Unit length = length_unit(units);
    fmt::format_to(line, "{}: {}, {:.4f} s, {}; {}\n\n", scene, counted(record.tracks.size(), "ball"),
                   record.duration, counted(record.events.size(), "event"), words(record.stopped).sentence);
    fmt::format_to(line, "{}", args.list ? all_events(record, units) : story(record, units));
    fmt::format_to(line, "\npocketed\n");
    long pocketed = 0;
    for (const Event& event : record.events) {
        if (event.type != EventType::kBallPocket) continue;
        ++pocketed;
        fmt::format_to(line, "  {:<6} in {} at {:.4f} s\n", record.tracks.at(event.a).id,
                       record.partner_id(event), event.time);
    }
    if (pocketed == 0) fmt::format_to(line, "  none\n");
    const std::string title = fmt::format("\noff the table ({})\n", length.name);
    bool off = false;
    for (const Event& event : record.events) {
        if (event.type != EventType::kBallOut) continue;
        const Vec3 there = record.state_at(event.a, event.time).position * length.factor;
        fmt::format_to(line, "{}  {:<6} left at {:.6f}, {:.6f}, {:.6f} (height), at {:.4f} s\n",
                       std::exchange(off, true) ? "" : title, record.tracks.at(event.a).id, there.x(),
                       there.y(), there.z(), event.time);
    }
    fmt::format_to(line, "\nfinal positions ({})\n", length.name);
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const BallState s = record.state_at(static_cast<int>(i), record.duration);
        fmt::format_to(line, "  {:<6} {:<11}{:>11.6f}{:>11.6f}\n", record.tracks[i].id, name(s.state),
                       s.position.x() * length.factor, s.position.y() * length.factor);
    }
    if (!measures.empty()) fmt::format_to(line, "\nmeasures\n");
    for (const games::Measure& measure : measures) {
        const std::string value = measured(measure, [&] { return games::text_of(measure.of(record)); });
        fmt::format_to(line, "  {:<24} {}\n", measure.text(), value.empty() ? "(none)" : value);
    }
    return fmt::to_string(out);
}

/// The distribution of a profiled run's time.
std::string profile_report(const Record& record) {
    double total = record.setup_detect_ns;
    for (const EventCost& cost : record.costs) total += cost.detect_ns + cost.resolve_ns;
    Table kernels(Column("", "  time (s)", ">14.6f"), Column("", "  balls", "<14"),
                  Column("", "ns", ">12.0f"), Column("", "steps", ">8"), Column("", "  method", "<"));
    for (std::size_t i = 0; i < record.costs.size(); ++i) {
        const Event& event = record.events[i];
        if (!balls_collide(event.type)) continue;
        const EventCost& cost = record.costs[i];
        kernels.add({event.time, "  " + record.tracks.at(event.a).id + " " + record.partner_id(event),
                     cost.kernel_ns, cost.steps, fmt::format("  {}", cost.method)});
    }
    return fmt::format(
        "\ncost by kind of event (mean ns; resolve includes kernel)\n{}  first search of all pairs: {:.0f} "
        "ns; total: {:.3f} ms\n\nkernel by ball-ball event and cluster\n{}",
        table_text(costs_by_kind(record)), record.setup_detect_ns, total * 1e-6, table_text(kernels));
}

void check_args(const SimulateArgs& args) {
    if (!args.checked.empty() && !args.verify)
        throw UsageError(fmt::format("{}: a record is read only to check it; add --verify", args.checked));
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
    if (!args.events.empty()) write_events_csv(record, args.events);
    if (!args.samples.empty()) write_samples_csv(record, *args.sample_dt, args.samples);
}

/// Reports the first law that the record breaks, if any.
int verified(const Record& record, const Plan& plan) {
    const std::optional<Violation> violation = verify(record, plan);
    if (violation) message(describe(*violation, record));
    return violation ? kFailed : kOk;
}

/// Checks a record from a file, which this or another program wrote.
int verified_file(const SimulateArgs& args, const Plan& plan) {
    if (!is_record(args.checked))
        throw UsageError(fmt::format("{}: a record has a name that ends in .json", args.checked));
    const Record record = read_shot(args.checked, {});
    require_scene(record, plan, args.checked);
    const int status = verified(record, plan);
    if (status == kOk)
        print(fmt::format("{}: {} and {}, {:.4f} s: every law holds\n", args.checked,
                          counted(record.tracks.size(), "ball"), counted(record.events.size(), "event"),
                          record.duration));
    return status;
}

int run(const SimulateArgs& args) {
    check_args(args);
    const Plan plan = plan_scene(args.scene);
    if (!args.checked.empty()) return verified_file(args, plan);
    SimulateOptions options;
    options.profile = args.profile;
    options.until = args.until;
    const std::vector<games::Measure> measures = measures_of(args, plan.scene);
    Outcome outcome;
    const Record record = simulate_plan(plan, options, &outcome);
    write_files(args, record);
    const int status = args.verify ? verified(record, plan) : kOk;
    // --hash replaces the summary, so that the output is one line. JSON always contains the hash.
    if (args.json) {
        print(result_json(plan.scene, record, outcome, measures));
        return status;
    }
    // Also with --quiet, and beside a file on standard output: it was asked for.
    const auto asked = [](bool option, const auto& text) {
        if (option) print_bytes(harmless(text()));
    };
    if (!args.hash) print(summary(record, args.scene, args, measures));
    asked(args.hash, [&] { return record.hash() + "\n"; });
    asked(args.list && (args.hash || quiet()), [&] { return all_events(record, units_of(args.units)); });
    asked(args.profile, [&] { return profile_report(record); });
    return status;
}

}  // namespace

void add_simulate(Options& program) {
    auto [command, args] = program.command<SimulateArgs>(
        "simulate", "Simulate a scene: print what happened, write events, record or samples", run);
    command.argument("SCENE", args.scene, "Scene file (TOML)").required = true;
    command.argument(
        "RECORD", args.checked,
        "With --verify, check this record of the scene (.json) instead of a run (default: the run)");
    command.option("-o,--output", &args.record, "FILE.json",
                   "Write the record, which carom render reads (default: not written)");
    command.option("--events", &args.events, "FILE.csv",
                   "Write the events; - prints them instead of the summary (default: not written)");
    command.option("--samples", &args.samples, "FILE.csv",
                   "Write sampled states; needs --sample-dt (default: not written)");
    command.option("--sample-dt", &args.sample_dt, "S", "Time between samples in s (default: none)");
    command.option("--until", &args.until, "S",
                   "Stop at this time in s at the latest (default: the scene's end)");
    command.flag("--list", args.list, "Print every event, also of a long shot (default: off)");
    command.option("--units", &args.units, "UNITS", "Units of the printed values; files are always in SI")
        .one_of({kUnits[0], kUnits[1]});
    command.flag("--hash", args.hash,
                 "Print the hash of all bits of the record instead of the summary (default: off)");
    command.flag("--profile", args.profile,
                 "Time every event: cost by kind, kernel cost by ball-ball event, extra columns in the "
                 "events file (default: off)");
    command.option("--measure", &args.measures, "EXPRESSION",
                   "Print a measure or expression (see carom describe measures); may be repeated "
                   "(default: none)");
    command.option("--game", &args.game, "GAME", "Rules for measures such as point (default: none)")
        .one_of(game_names());
    command.flag("--json", args.json, "Print JSON (default: off)");
    command.flag("--verify", args.verify,
                 "Check the laws of mechanics; report the first one broken, with exit status 1 "
                 "(default: off)");
}

}  // namespace carom::tools
