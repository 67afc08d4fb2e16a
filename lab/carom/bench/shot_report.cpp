// carom-lab bench shot: the tables, as text and as JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "bench/shot.h"
#include "report/table.h"

namespace carom::tools {
namespace {

Table shots_of(const ShotBench& bench) {
    Table table(Column("name", "", "<28"), Column("cost_in_impacts", "impacts", ">8.2f"),
                Column("cost_least", "least", ">7.2f"), Column("cost_most", "most", ">8.2f"),
                Column("ns_min"), Column("ns_median"), Column("events", "events", ">8.0f"),
                Column("clusters", "clusters", ">9.0f"), Column("ns_per_event", "ns/event", ">9.0f"),
                Column("detect_ns", "detect", ">8.0f"), Column("resolve_ns", "resolve", ">8.0f"),
                Column("kernel_ns", "kernel", ">8.0f"), Column("cluster_ns", "cluster", ">8.0f"),
                Column("queue_ns", "queue", ">8.0f"), Column("shots_per_cpu_s", "shots/s", ">9.0f"));
    for (const ShotRow& r : bench.rows) {
        // A batch is not profiled; a single shot has no batch figures.
        const bool many = r.shots_per_cpu_s > 0.0;
        const auto part = [many](double ns) { return many ? Cell() : Cell(ns); };
        table.add({r.name, r.cost_in_impacts, r.cost_least, r.cost_most, r.ns_min, r.ns_median, r.events,
                   r.clusters, r.ns_per_event, part(r.detect_ns), part(r.resolve_ns), part(r.kernel_ns),
                   part(r.cluster_ns), part(r.queue_ns), many ? Cell(r.shots_per_cpu_s) : Cell()});
    }
    return table;
}

Table growth_of(const ShotBench& bench) {
    Table table(Column("name", "", "<20"), Column("clusters"), Column("isa"), Column("n", "balls", ">8"),
                Column("search", "search", ">8"), Column("chosen"), Column("ns_min", "ns min", ">9.0f"),
                Column("ns_median", "median", ">9.0f"), Column("growth", "growth", ">9.2f"),
                Column("bytes_per_ball", "bytes/ball", ">12.0f"));
    for (const GasRow& g : bench.growth)
        table.add({g.name,
                   name(g.clusters),
                   bench.isa,
                   g.balls,
                   {name(g.search), std::string(name(g.search)) + (g.chosen ? "*" : " ")},
                   g.chosen,
                   g.ns_min,
                   g.ns_median,
                   g.growth,
                   g.bytes_per_ball});
    return table;
}

}  // namespace

std::string shot_bench_json(const ShotBench& bench) {
    const nlohmann::ordered_json all = {{"machine",
                                         {{"cpu", bench.cpu},
                                          {"compiler", bench.compiler},
                                          {"isa", bench.isa},
                                          {"baseline_isa", bench.baseline_isa},
                                          {"seeds", bench.seeds},
                                          {"repeats", bench.repeats}}},
                                        {"baseline_ns", bench.baseline_ns},
                                        {"rows", table_json(shots_of(bench))},
                                        {"growth", table_json(growth_of(bench))}};
    return all.dump(1) + "\n";
}

std::string shot_bench_text(const ShotBench& bench) {
    std::string text = fmt::format(
        "{}, {}; isa {}\nbaseline: the plain double march, N = 1000, {}: {:.0f} ns\n"
        "shots: median over {} seeds of the least time in {} rounds; ns per event, the parts from "
        "profiled runs (clock included)\n\n",
        bench.cpu, bench.compiler, bench.isa, bench.baseline_isa, bench.baseline_ns, bench.seeds,
        bench.repeats);
    text += table_text(shots_of(bench));
    if (bench.growth.empty()) return text;
    return text +
           "\ngrowth: a gas without friction at equal density, ns per event after set-up; clusters "
           "sequential, "
           "and compliant as by default; * what the plan chooses\n" +
           table_text(growth_of(bench));
}

}  // namespace carom::tools
