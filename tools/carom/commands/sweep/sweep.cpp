// carom sweep: simulates many shots of one scene and writes one row per shot.
//
// A row depends only on the scene, the rules, the seed and its number. The engine plays a block of shots on
// all threads, and their rows are written in order.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "base/console.h"
#include "base/game_state.h"
#include "base/options.h"
#include "base/output_file.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "commands/sweep/rows.h"
#include "commands/sweep/status.h"
#include "commands/sweep/table_in_parts.h"
#include "commands/sweep/tally.h"
#include "report/diagram.h"
#include "report/sweep_plot.h"

namespace carom::tools {
namespace {

struct SweepArgs {
    std::string scene;
    std::vector<std::string> vary;  ///< "KEY=DISTRIBUTION"
    std::optional<long> count;      ///< nothing: every point of the grids once
    std::uint64_t seed = 1;
    int jobs = 0;
    std::string shard;  ///< "2/4"; empty: all
    std::string output;
    std::string status;  ///< a file; empty: none
    std::vector<std::string> measures;
    std::string game;
    std::string plot;
    bool json = false;
};

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kMostShards = 1000000;
/// A block of shots grows until it takes this long, which is how often the progress moves.
constexpr std::chrono::milliseconds kBlockTime(100);
/// [shots] Limits the memory of a block.
constexpr std::uint64_t kLargestBlock = std::uint64_t{1} << 16;

/// [shots] A plot shows the first ones: more would not change it, and need memory.
constexpr std::size_t kMostPlotted = 1000000;

/// Shots `first` to `last - 1`.
struct ShotRange {
    std::uint64_t first, last;
    bool header;  ///< belongs to the first shard
};

ShotRange shard_range(const std::string& text, std::uint64_t count) {
    if (text.empty()) return {0, count, true};
    if (const auto part = numbers_in<std::uint64_t, 2>(text, '/')) {
        const auto [i, n] = *part;
        // count * k / n without the product, which may overflow.
        const auto begin = [count, n = n](std::uint64_t k) { return count / n * k + count % n * k / n; };
        if (i >= 1 && i <= n && n <= kMostShards) return {begin(i - 1), begin(i), i == 1};
    }
    throw UsageError(fmt::format("--shard {}: expected I/N with 1 <= I <= N, as in 2/4", text));
}

std::uint64_t failures(const Outcomes& outcomes) {
    return outcomes[static_cast<std::size_t>(ShotStatus::kFailed)];
}

void add(const std::vector<PlotShot>& shots, SweepPlot& plot) {
    const std::size_t room = kMostPlotted - std::min(kMostPlotted, plot.shots.size());
    plot.shots.insert(plot.shots.end(), shots.begin(),
                      shots.begin() + static_cast<std::ptrdiff_t>(std::min(room, shots.size())));
}

/// Runs the missing shots of the table, block by block, and writes the rows of each while the next is played.
/// Two blocks are never played at once, because each uses all of the sweep's threads.
Outcomes write_rows(TableInParts& table, const Sweep& sweep, const ShotRange& range, SweepStatus& status,
                    std::vector<Tally>& tallies, SweepPlot& plot) {
    Outcomes outcomes{};
    ProgressLine line("sweep");
    auto block = 2 * static_cast<std::uint64_t>(sweep.threads);
    std::uint64_t begun = table.next();
    std::future<SweepRows> next;
    const auto begin_next = [&] {
        const std::uint64_t first = begun, shots = std::min(block, range.last - begun);
        begun += shots;
        next = std::async(std::launch::async, [&sweep, first, shots] {
            return play_rows(sweep, first, static_cast<std::size_t>(shots));
        });
    };
    if (begun < range.last) begin_next();
    while (table.next() < range.last) {
        const Clock::time_point start = Clock::now();
        const std::uint64_t shots = begun - table.next();
        const SweepRows rows = next.get();
        if (Clock::now() - start < kBlockTime && block < kLargestBlock) block *= 2;
        if (begun < range.last) begin_next();
        table.add(rows.text, shots, failures(rows.outcomes));
        for (std::size_t i = 0; i < outcomes.size(); ++i) outcomes[i] += rows.outcomes[i];
        for (std::size_t i = 0; i < rows.values.size(); ++i) tallies[i % tallies.size()].add(rows.values[i]);
        add(rows.plotted, plot);
        status.show(table.next(), outcomes);
        line.show_bar(static_cast<long>(table.next() - range.first),
                      static_cast<long>(range.last - range.first));
    }
    return outcomes;
}

/// What the shots that this run has played came to.
std::string summary(const Outcomes& outcomes, const std::vector<Tally>& tallies, const SweepArgs& args,
                    int jobs, double seconds) {
    std::uint64_t shots = 0;
    for (const std::uint64_t n : outcomes) shots += n;
    if (args.json) {
        nlohmann::ordered_json json = {
            {"file", harmless(args.output)}, {"shots", shots}, {"seconds", seconds}};
        for (int i = 0; i < kShotStatuses; ++i)
            json["outcomes"][name(static_cast<ShotStatus>(i))] = outcomes[i];
        json["measures"] = nlohmann::ordered_json::array();
        for (const Tally& tally : tallies) json["measures"].push_back(tally.json());
        return json.dump() + "\n";
    }
    std::string text =
        fmt::format("{}: {} in {:.2f} s on {}, {:.0f} per second\n", args.output, counted(shots, "shot"),
                    seconds, counted(static_cast<std::size_t>(jobs), "thread"),
                    static_cast<double>(shots) / std::max(seconds, 1e-9));
    for (int i = 0; i < kShotStatuses; ++i) {
        const std::uint64_t n = outcomes[i];
        if (n > 0) text += fmt::format("  {:<8}{:>10}\n", name(static_cast<ShotStatus>(i)), n);
    }
    for (const Tally& tally : tallies) text += tally.text();
    return text;
}

std::vector<games::Measure> read_measures(const SweepArgs& args, const Scene& scene) {
    std::optional<games::Game> game;
    if (!args.game.empty()) game = game_of(args.game);
    std::vector<games::Measure> measures;
    try {
        for (const std::string& text : args.measures) measures.emplace_back(text, scene, game);
    } catch (const games::MeasureError& error) {
        throw UsageError(fmt::format("--measure {}", error.what()));
    }
    return measures;
}

/// What a plot needs from every shot: the first measure, over the first two numbers that vary.
SweepPlot prepare_plot(const SweepArgs& args, Sweep& sweep) {
    SweepPlot plot;
    if (args.plot.empty()) return plot;
    diagram_format(args.plot);
    if (sweep.measures.empty() || !sweep.measures.front().is_number())
        throw UsageError(
            "--plot draws the first --measure, which has to be a number; carom describe measures "
            "lists them");
    plot.measure = sweep.measures.front().text();
    sweep.plot = true;
    const Variation& variation = sweep.variation;
    for (std::size_t k = 0; k < variation.keys().size() && plot.axes.size() < 2; ++k) {
        if (variation.kind(k) == ValueKind::kText) continue;
        const std::string unit = variation.unit(k);
        plot.axes.push_back(variation.keys()[k] + (unit.empty() ? "" : " [" + unit + "]"));
        sweep.plot_keys.push_back(k);
    }
    if (plot.axes.size() == 2) return plot;
    plot.axes.clear();
    sweep.plot_keys.clear();
    return plot;
}

Variation read_variation(const SweepArgs& args) {
    try {
        return Variation(args.scene, args.vary, args.seed);
    } catch (const VariationError& error) {
        throw UsageError(fmt::format("--vary: {}", error.what()));
    }
}

int run(const SweepArgs& args) {
    if (args.count && (*args.count < 1 || *args.count > static_cast<long>(kMostShots)))
        throw UsageError(fmt::format("--count: expected 1 to {} shots", kMostShots));
    const kernel::Isa isa = chosen_isa();
    const Variation variation = read_variation(args);
    const std::uint64_t count = args.count ? static_cast<std::uint64_t>(*args.count) : variation.grid();
    if (count == 0) throw UsageError("--count is missing; only a grid knows how many shots it has");
    const ShotRange range = shard_range(args.shard, count);
    for (const std::string& warning : make_plan(variation.base(), isa).warnings)
        message("warning: " + warning);
    const std::vector<games::Measure> measures = read_measures(args, variation.base());
    std::uint64_t columns = 0;
    for (const games::Measure& measure : measures)
        for (const char c : measure.text() + args.game + '\n')
            columns = (columns ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    // Each range of shots has parts of its own.
    const std::uint64_t id = variation.fingerprint() ^ columns ^ (range.first * 0x9e3779b97f4a7c15u) ^
                             (range.last * 0xbf58476d1ce4e5b9u);
    if (!args.shard.empty() && std::filesystem::is_regular_file(args.output))
        throw UsageError(fmt::format(
            "-o {}: this file exists, perhaps from another shard; give each shard its own, or remove it",
            args.output));
    const int jobs =
        args.jobs > 0 ? args.jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    Sweep sweep{variation, measures, isa, jobs};
    SweepPlot plot = prepare_plot(args, sweep);
    std::vector<Tally> tallies(measures.begin(), measures.end());
    TableInParts table(args.output, id, range.header ? sweep_header(sweep) : "", range.first,
                       [&](std::string_view rows) {
                           if (sweep.plot) add(plotted_rows(sweep, rows), plot);
                       });
    const std::uint64_t from = table.next();
    if (from > range.first) {
        // Another build may have other bits.
        if (!table.ends_with(play_rows(sweep, from - 1, 1).text))
            throw std::runtime_error(
                fmt::format("{}: its last row is not what this program computes; remove it to start again",
                            table.folder()));
        message(fmt::format("continuing with {}: {} of {} shots are done", table.folder(), from - range.first,
                            range.last - range.first));
    }
    const Clock::time_point start = Clock::now();
    Outcomes outcomes{};
    SweepStatus status(args.status, args.output, range.first, range.last, from);
    try {
        outcomes = write_rows(table, sweep, range, status, tallies, plot);
    } catch (const std::system_error& error) {
        throw std::runtime_error(fmt::format("not all of {} could be started ({}); use fewer with --jobs",
                                             counted(static_cast<std::size_t>(jobs), "thread"),
                                             error.what()));
    } catch (const Interrupted&) {
        table.keep();
        status.end("stopped");
        if (!table.folder().empty())
            message(fmt::format("stopped; run the same command to continue with {}", table.folder()));
        throw;
    }
    table.commit();
    if (sweep.plot) {
        OutputFile file(args.plot);
        file.write(draw_plot(plot, diagram_format(args.plot)));
        file.commit();
    }
    status.end("done");
    print(
        summary(outcomes, tallies, args, jobs, std::chrono::duration<double>(Clock::now() - start).count()));
    if (table.failed() == 0) return kOk;
    message(fmt::format("{} failed while running; {} why", counted(table.failed(), "shot"),
                        table.failed() == 1 ? "its row says" : "their rows say"));
    return kFailed;
}

}  // namespace

void add_sweep(Options& program) {
    auto [command, args] = program.command<SweepArgs>(
        "sweep", "Simulate many shots of one scene with varied values, one row per shot", run);
    command.argument("SCENE", args.scene, "Scene file (TOML)").required = true;
    Option& vary = command.option("--vary", &args.vary, "KEY=DISTRIBUTION",
                                  "What varies and how, once per key: uniform(a,b), normal(sd) around the "
                                  "scene's value, normal(mean,sd), integer(a,b), list(v,...), or in steps: "
                                  "grid(a,b,n), n values from a to b, and grid(list(v,...)); several grids "
                                  "make a product, the last one fastest");
    vary.required = true;
    command.option("--measure", &args.measures, "EXPRESSION",
                   "A column more, and a line of the summary: any measure or expression that carom describe "
                   "measures explains, as often as wanted (default: none)");
    command.option("--game", &args.game, "GAME", "What measures such as foul judge by (default: none)")
        .one_of(game_names());
    command.option("--plot", &args.plot, "FILE",
                   "Draw the first measure: a map over the first two numbers that "
                   "vary, or a histogram; .svg, .png or .pdf (default: not drawn)");
    command.flag("--json", args.json, "Print the summary as JSON (default: off)");
    command.option("--count", &args.count, "N", "Number of shots (default: every point of the grids once)");
    command.option("--seed", &args.seed, "S", "Seed of all draws");
    command.option("--jobs", &args.jobs, "J", "Threads; 0: one per core; the rows do not depend on it")
        .in(0, 256);
    command.option("--shard", &args.shard, "I/N",
                   "Play only the I-th of N parts; the files of all parts, concatenated, are the whole table "
                   "(default: all)");
    command.option("--status", &args.status, "FILE",
                   "Write the progress every second, as JSON (default: not written)");
    command.option("-o,--output", &args.output, "FILE.csv", "Table to write").required = true;
    command.footer =
        "To continue a sweep that was stopped or killed, run the same command again (docs/guide/sweep.md).";
}

}  // namespace carom::tools
