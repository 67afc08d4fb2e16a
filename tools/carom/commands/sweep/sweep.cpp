// carom sweep: simulates many shots of one scene and writes one row for each shot.
//
// A row depends only on the scene, the rules, the seed and its number. The engine
// plays a block of shots on all threads, and their rows are written in order.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <future>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "commands/sweep/rows.h"
#include "commands/sweep/status.h"
#include "commands/sweep/table_in_parts.h"

namespace carom::tools {
namespace {

struct SweepArgs {
    std::string scene;
    std::vector<std::string> vary;  ///< "KEY=DISTRIBUTION"
    std::uint64_t count = 0;
    std::uint64_t seed = 1;
    int jobs = 0;
    std::string shard;  ///< "2/4"; empty: all
    std::string output;
    std::string status;  ///< a file; empty: none
};

using Clock = std::chrono::steady_clock;

/// Doubles, and what reads tables as doubles, count to there.
constexpr std::uint64_t kMostShots = std::uint64_t{1} << 53;
constexpr std::uint64_t kMostShards = 1000000;
/// A block of shots grows until it takes this long: how often the progress moves.
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
        // count * k / n, without the product of the two, which may be too large.
        const auto begin = [count, n = n](std::uint64_t k) { return count / n * k + count % n * k / n; };
        if (i >= 1 && i <= n && n <= kMostShards) return {begin(i - 1), begin(i), i == 1};
    }
    throw UsageError(fmt::format("--shard {}: expected I/N with 1 <= I <= N, as in 2/4", text));
}

/// What makes the rows.
struct Sweep {
    const Variation& variation;
    kernel::Isa isa;
    int threads;
};

std::uint64_t failures(const Outcomes& outcomes) {
    return outcomes[static_cast<std::size_t>(ShotStatus::kFailed)];
}

/// Runs the shots that the table lacks, block by block, and writes their rows. The next block is played while
/// one is waited for and written, so that no thread stands idle.
Outcomes write_rows(TableInParts& table, const Sweep& sweep, const ShotRange& range, SweepStatus& status) {
    Outcomes outcomes{};
    ProgressLine line("sweep");
    auto block = 2 * static_cast<std::uint64_t>(sweep.threads);
    std::uint64_t begun = table.next();
    std::future<SweepRows> next;
    const auto begin_next = [&] {
        const std::uint64_t first = begun, shots = std::min(block, range.last - begun);
        begun += shots;
        next = std::async(std::launch::async, [&sweep, first, shots] {
            return play_rows(sweep.variation, first, static_cast<std::size_t>(shots), sweep.isa,
                             sweep.threads);
        });
    };
    if (begun < range.last) begin_next();
    while (table.next() < range.last) {
        const Clock::time_point start = Clock::now();
        const std::uint64_t shots = begun - table.next();
        std::future<SweepRows> ready = std::exchange(next, {});
        if (begun < range.last) begin_next();
        const SweepRows rows = ready.get();
        table.add(rows.text, shots, failures(rows.outcomes));
        for (std::size_t i = 0; i < outcomes.size(); ++i) outcomes[i] += rows.outcomes[i];
        if (Clock::now() - start < kBlockTime && block < kLargestBlock) block *= 2;
        status.show(table.next(), outcomes);
        line.show_bar(static_cast<long>(table.next() - range.first),
                      static_cast<long>(range.last - range.first));
    }
    return outcomes;
}

std::string summary(const Outcomes& outcomes, const SweepArgs& args, int jobs, double seconds) {
    std::uint64_t shots = 0;
    for (const std::uint64_t n : outcomes) shots += n;
    std::string text =
        fmt::format("{}: {} in {:.2f} s on {}, {:.0f} a second\n", args.output, counted(shots, "shot"),
                    seconds, counted(static_cast<std::size_t>(jobs), "thread"),
                    static_cast<double>(shots) / std::max(seconds, 1e-9));
    for (int i = 0; i < kShotStatuses; ++i) {
        const std::uint64_t n = outcomes[i];
        if (n > 0) text += fmt::format("  {:<8}{:>10}\n", name(static_cast<ShotStatus>(i)), n);
    }
    return text;
}

Variation read_variation(const SweepArgs& args) {
    try {
        return Variation(args.scene, args.vary, args.seed);
    } catch (const VariationError& error) {
        throw UsageError(fmt::format("--vary: {}", error.what()));
    }
}

int run(const SweepArgs& args) {
    if (args.count < 1 || args.count > kMostShots)
        throw UsageError(fmt::format("--count: expected 1 to {} shots", kMostShots));
    const ShotRange range = shard_range(args.shard, args.count);
    const kernel::Isa isa = chosen_isa();
    const Variation variation = read_variation(args);
    for (const std::string& warning : make_plan(variation.base(), isa).warnings)
        message("warning: " + warning);
    // Each range of shots has parts of its own.
    const std::uint64_t id =
        variation.fingerprint() ^ (range.first * 0x9e3779b97f4a7c15u) ^ (range.last * 0xbf58476d1ce4e5b9u);
    if (!args.shard.empty() && std::filesystem::is_regular_file(args.output))
        throw UsageError(fmt::format(
            "-o {}: this file is there, perhaps of another shard; give each its own, or remove it",
            args.output));
    const int jobs =
        args.jobs > 0 ? args.jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const Sweep sweep{variation, isa, jobs};
    TableInParts table(args.output, id, range.header ? sweep_header(variation) : "", range.first);
    const std::uint64_t from = table.next();
    if (from > range.first) {
        // Another build may have other bits.
        if (!table.ends_with(play_rows(variation, from - 1, 1, isa).text))
            throw std::runtime_error(
                fmt::format("{}: its last row is not what this program computes; remove it to begin anew",
                            table.folder()));
        message(fmt::format("going on with {}: {} of {} shots are there", table.folder(), from - range.first,
                            range.last - range.first));
    }
    const Clock::time_point start = Clock::now();
    Outcomes outcomes{};
    SweepStatus status(args.status, args.output, range.first, range.last, from);
    try {
        outcomes = write_rows(table, sweep, range, status);
    } catch (const std::system_error& error) {
        throw std::runtime_error(fmt::format("not all of {} could be started ({}); use fewer with --jobs",
                                             counted(static_cast<std::size_t>(jobs), "thread"),
                                             error.what()));
    } catch (const Interrupted&) {
        table.keep();
        status.end("stopped");
        if (!table.folder().empty())
            message(fmt::format("stopped; the same command goes on with {}", table.folder()));
        throw;
    }
    table.commit();
    status.end("done");
    print(summary(outcomes, args, jobs, std::chrono::duration<double>(Clock::now() - start).count()));
    if (table.failed() == 0) return kOk;
    message(fmt::format("{} failed while running; {} why", counted(table.failed(), "shot"),
                        table.failed() == 1 ? "its row says" : "their rows say"));
    return kFailed;
}

}  // namespace

void add_sweep(Options& program) {
    auto [command, args] = program.command<SweepArgs>(
        "sweep", "Many shots of one scene with values that vary: a row a shot", run);
    command.argument("SCENE", args.scene, "Scene file (TOML)").required = true;
    Option& vary = command.option(
        "--vary", &args.vary, "KEY=DISTRIBUTION",
        "What varies and how, once per key: uniform(a,b), normal(sd) around the scene's value, "
        "normal(mean,sd), integer(a,b) or list(v,...)");
    vary.required = true;
    command.option("--count", &args.count, "N", "Number of shots").required = true;
    command.option("--seed", &args.seed, "S", "Seed of all draws");
    command.option("--jobs", &args.jobs, "J", "Threads; 0: one per core; the rows do not depend on it")
        .in(0, 256);
    command.option("--shard", &args.shard, "I/N",
                   "Only the I-th of N parts; the files of all parts, one behind the other, are the whole "
                   "(default: all)");
    command.option("--status", &args.status, "FILE",
                   "How far it is, every second, as JSON (default: not written)");
    command.option("-o,--output", &args.output, "FILE.csv", "Table to write").required = true;
    command.footer =
        "A sweep that was stopped or killed goes on when the same command is given again "
        "(docs/guide/sweep.md).";
}

}  // namespace carom::tools
