#include "bench/discs.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/console.h"
#include "base/machine.h"
#include "base/options.h"
#include "base/setup.h"
#include "bench/shot_cases.h"
#include "carom/engine/ball_ball.h"
#include "carom/engine/simulate.h"
#include "report/table.h"

namespace carom::tools {

HardDiscs hard_discs(const Plan& plan) {
    const Scene& scene = plan.scene;
    const double R = plan.balls.R, wall = R - plan.geometry.cushions.front().inset;
    std::vector<Vec2> places, velocities;
    for (const BallStart& ball : scene.ball) {
        places.emplace_back(ball.position.x() - wall, ball.position.y() - wall);
        velocities.emplace_back(ball.velocity.x(), ball.velocity.y());
    }
    return {std::move(places), std::move(velocities), contact_distance(R, R, false),
            Vec2(scene.table.width - 2.0 * wall, scene.table.length - 2.0 * wall)};
}

namespace {

struct BenchDiscsArgs {
    bool json = false;
    int repeats = 5;
    long events = 100000;
};

/// The cost of a run of one size.
struct DiscsRun {
    enum Kind { kReference, kOutcome, kRecord } kind;
    Plan plan;
    RunBuffers buffers{};
    Outcome outcome{};

    /// @returns ns per event, without the set-up
    double time() {
        const long events = *plan.scene.stop.events;
        if (kind == kReference) {
            HardDiscs discs = hard_discs(plan);
            const double start = thread_ns();
            discs.run(events);
            return (thread_ns() - start) / static_cast<double>(events);
        }
        SimulateOptions options;
        options.progress_rounds = 1;
        double start = 0.0;
        std::size_t first = 0;
        // The first call follows the first event. Later calls cost almost nothing.
        options.progress = [&](std::size_t done, double) {
            if (start != 0.0) return;
            first = done;
            start = thread_ns();
        };
        if (kind == kRecord)
            simulate(plan, options);
        else
            simulate(plan, buffers, outcome, options);
        return (thread_ns() - start) / static_cast<double>(events - static_cast<long>(first));
    }
};

int run(const BenchDiscsArgs& args) {
    std::vector<int> sizes{864, 2500, 10000};
    std::vector<DiscsRun> runs;
    for (const int n : sizes) {
        const Plan plan = make_plan(gas_scene(n, args.events, 1), chosen_isa());
        for (const auto kind : {DiscsRun::kReference, DiscsRun::kOutcome, DiscsRun::kRecord})
            runs.push_back({kind, plan});
    }
    const auto samples = interleaved("bench discs", runs.size(), args.repeats,
                                     [&runs](std::size_t i) { return runs[i].time(); });
    Table table(Column("discs", "discs", ">8"), Column("reference_ns", "hard discs", ">12.0f"),
                Column("outcome_ns", "carom", ">9.0f"), Column("record_ns", "record", ">9.0f"),
                Column("ratio", "ratio", ">8.2f"), Column("growth", "growth", ">8.2f"),
                Column("reference_growth", "of the discs", ">14.2f"));
    for (std::size_t k = 0; k < sizes.size(); ++k) {
        const auto least = [&](std::size_t row, std::size_t kind) {
            return minimum(samples[3 * row + kind]);
        };
        table.add({sizes[k], least(k, 0), least(k, 1), least(k, 2), least(k, 1) / least(k, 0),
                   least(k, 1) / least(0, 1), least(k, 0) / least(0, 0)});
    }
    if (args.json) {
        const nlohmann::ordered_json all = {{"cpu", processor()}, {"rows", table_json(table)}};
        print(all.dump(1) + "\n");
        return kOk;
    }
    print(fmt::format(
        "{}\n{} events of a gas without friction at equal density, ns per event after set-up, least of {} "
        "rounds; carom keeps the outcome only, or a record; ratio: carom to hard discs\n\n{}",
        processor(), args.events, args.repeats, table_text(table)));
    return kOk;
}

}  // namespace

void add_bench_discs(Options& bench) {
    auto [command, args] = bench.command<BenchDiscsArgs>(
        "discs", "Frictionless elastic balls beside a code for hard discs", run);
    command.flag("--json", args.json, "Print JSON (default: off)");
    add_repeat(command, args.repeats, "Interleaved rounds; the least time counts");
    command.option("--events", &args.events, "N", "Events of every run").in(10, 10000000);
}

}  // namespace carom::tools
