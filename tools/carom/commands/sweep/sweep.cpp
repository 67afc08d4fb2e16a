// carom sweep: simulates many shots of one scene and writes one row per shot.
//
// A row depends only on the scene, the rules, the seed and its number. The engine plays a block of shots on
// all threads, and their rows are written in order.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <future>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "base/console.h"
#include "base/game_state.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "commands/sweep/plot.h"
#include "commands/sweep/rows.h"
#include "commands/sweep/status.h"
#include "commands/sweep/table_in_parts.h"
#include "commands/sweep/tally.h"

namespace carom::tools {
namespace {

struct SweepArgs {
    std::string scene;
    std::vector<std::string> vary;      ///< "KEY=DISTRIBUTION"
    std::optional<std::int64_t> count;  ///< empty: every point of the grids once
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
/// A block of shots grows until it takes this long; progress is shown once per block.
constexpr std::chrono::milliseconds kBlockTime(100);
/// [shots] Limits the memory of a block.
constexpr std::uint64_t kLargestBlock = std::uint64_t{1} << 16;

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

/// Sums over the played shots.
struct Totals {
    Outcomes outcomes{};
    std::vector<Tally> tallies;
    PlottedSweep plot;

    /// @return how many of the shots failed
    std::uint64_t add(const games::SweptShots& shots) {
        const std::uint64_t before = failures(outcomes);
        for (std::size_t i = 0; i < shots.count; ++i) {
            const ShotStatus status = shots.outcomes.status[i];
            ++outcomes[static_cast<std::size_t>(status)];
            for (std::size_t m = 0; m < tallies.size() && has_result(status); ++m)
                tallies[m].add(shots.measured[i * tallies.size() + m]);
        }
        plot.add(shots);
        return failures(outcomes) - before;
    }
};

/// Runs the missing shots of the table, block by block, and writes the rows of each while the next is played
/// and memory for the one after it is allocated. Two blocks are never played at once, because each uses all
/// threads.
void write_rows(TableInParts& table, const games::Sweep& sweep, kernel::Isa isa, int threads,
                const ShotRange& range, SweepStatus& status, Totals& totals) {
    ProgressLine line("sweep");
    auto size = 2 * static_cast<std::uint64_t>(threads);
    std::uint64_t begun = table.next();
    std::mutex playing;
    std::deque<std::future<SweepBlock>> blocks;
    std::string rows;
    const auto begin_next = [&] {
        const std::uint64_t first = begun, shots = std::min(size, range.last - begun);
        if (shots == 0) return;
        begun += shots;
        blocks.push_back(std::async(std::launch::async, [&sweep, &playing, isa, threads, first, shots] {
            return play_block(sweep, first, static_cast<std::size_t>(shots), isa, threads, playing);
        }));
    };
    begin_next();
    begin_next();
    while (table.next() < range.last) {
        const Clock::time_point start = Clock::now();
        const SweepBlock block = blocks.front().get();
        blocks.pop_front();
        if (Clock::now() - start < kBlockTime && size < kLargestBlock) size *= 2;
        begin_next();
        rows.clear();
        for (const std::string& row : block.rows) rows += row;
        table.add(rows, block.shots.count, totals.add(block.shots));
        status.show(table.next(), totals.outcomes);
        line.show_bar(static_cast<std::int64_t>(table.next() - range.first),
                      static_cast<std::int64_t>(range.last - range.first));
    }
}

/// Sums over the shots of this run.
std::string summary(const Totals& totals, const SweepArgs& args, int jobs, double seconds) {
    const auto& [outcomes, tallies, plot] = totals;
    const std::uint64_t shots = std::accumulate(outcomes.begin(), outcomes.end(), std::uint64_t{0});
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

games::Sweep read_sweep(const SweepArgs& args) {
    std::optional<games::Game> game;
    if (!args.game.empty()) game = game_of(args.game);
    try {
        return games::Sweep(Variation(args.scene, args.vary, args.seed), args.measures, game);
    } catch (const VariationError& error) {
        throw UsageError(fmt::format("--vary: {}", error.what()));
    } catch (const games::MeasureError& error) {
        throw UsageError(fmt::format("--measure {}", error.what()));
    }
}

/// The name of this sweep's parts: each range of shots has its own.
std::uint64_t id_of(const games::Sweep& sweep, const SweepArgs& args, const ShotRange& range) {
    std::uint64_t columns = 0;
    for (const games::Measure& measure : sweep.measures())
        for (const char c : measure.text() + args.game + '\n')
            columns = (columns ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return sweep.variation().fingerprint() ^ columns ^ (range.first * 0x9e3779b97f4a7c15u) ^
           (range.last * 0xbf58476d1ce4e5b9u);
}

int run(const SweepArgs& args) {
    if (args.count && (*args.count < 1 || *args.count > static_cast<std::int64_t>(kMostShots)))
        throw UsageError(fmt::format("--count: expected 1 to {} shots", kMostShots));
    const kernel::Isa isa = chosen_isa();
    const games::Sweep sweep = read_sweep(args);
    const Variation& variation = sweep.variation();
    const std::uint64_t count = args.count ? static_cast<std::uint64_t>(*args.count) : variation.grid();
    if (count == 0) throw UsageError("--count is missing; give it, or vary a key by grid(...)");
    const ShotRange range = shard_range(args.shard, count);
    for (const std::string& warning : make_plan(variation.base(), isa).warnings)
        message("warning: " + warning);
    if (!args.shard.empty() && std::filesystem::is_regular_file(args.output))
        throw UsageError(fmt::format(
            "-o {}: this file exists, perhaps from another shard; give each shard its own, or remove it",
            args.output));
    const int jobs =
        args.jobs > 0 ? args.jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const std::vector<games::Measure>& measures = sweep.measures();
    Totals totals{{}, {measures.begin(), measures.end()}, {sweep, args.plot}};
    TableInParts table(args.output, id_of(sweep, args, range), range.header ? sweep_header(sweep) : "",
                       range.first, [&](std::string_view rows) { totals.plot.add(rows); });
    const std::uint64_t from = table.next();
    if (from > range.first) {
        // Another build may have other bits.
        std::mutex playing;
        if (!table.ends_with(play_block(sweep, from - 1, 1, isa, 1, playing).rows.front()))
            throw std::runtime_error(fmt::format(
                "{}: its last row differs from the one that this program computes; remove it to start again",
                table.folder()));
        message(fmt::format("continuing with {}: {} of {} shots are done", table.folder(), from - range.first,
                            range.last - range.first));
    }
    const Clock::time_point start = Clock::now();
    SweepStatus status(args.status, args.output, range.first, range.last, from);
    try {
        write_rows(table, sweep, isa, jobs, range, status, totals);
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
    totals.plot.write();
    status.end("done");
    print(summary(totals, args, jobs, std::chrono::duration<double>(Clock::now() - start).count()));
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
    Option& vary = command.option(
        "--vary", &args.vary, "KEY=DISTRIBUTION",
        "Vary a key, once per key, by uniform(a,b), normal(sd) around the scene's value, normal(mean,sd), "
        "integer(a,b), list(v,...), or in steps by grid(a,b,n), n values from a to b, or grid(list(v,...)); "
        "several grids form their product, and the last varies fastest");
    vary.required = true;
    command.option("--measure", &args.measures, "EXPRESSION",
                   "Add a column and a summary line for a measure or expression (see carom describe "
                   "measures); may be repeated (default: none)");
    command.option("--game", &args.game, "GAME", "Rules for measures such as foul (default: none)")
        .one_of(game_names());
    command.option("--plot", &args.plot, "FILE",
                   "Draw the first measure as a map over the first two varied numbers, or as a histogram: "
                   ".svg, .pdf or .png (default: not drawn)");
    command.flag("--json", args.json, "Print the summary as JSON (default: off)");
    command.option("--count", &args.count, "N", "Number of shots (default: every point of the grids once)");
    command.option("--seed", &args.seed, "S", "Seed of all draws");
    command.option("--jobs", &args.jobs, "J", "Threads, 0 for one per core; the rows are always the same")
        .in(0, 256);
    command.option("--shard", &args.shard, "I/N",
                   "Play only part I of N; the files of all parts, concatenated, form the whole table "
                   "(default: all)");
    command.option("--status", &args.status, "FILE",
                   "Write the progress every second, as JSON (default: not written)");
    command.option("-o,--output", &args.output, "FILE.csv", "Table to write").required = true;
    command.footer =
        "To continue a sweep that was stopped or killed, run the same command again (docs/guide/sweep.md).";
}

}  // namespace carom::tools
