// carom bench shot: the tables, and the JSON.
#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/shot.h"

namespace carom::tools {

std::string shot_bench_json(const ShotBench& bench) {
    using Json = nlohmann::ordered_json;
    Json rows = Json::array(), growth = Json::array();
    for (const ShotRow& r : bench.rows)
        rows.push_back({{"name", r.name},
                        {"cost_in_impacts", r.cost_in_impacts},
                        {"cost_least", r.cost_least},
                        {"cost_most", r.cost_most},
                        {"ns_min", r.ns_min},
                        {"ns_median", r.ns_median},
                        {"events", r.events},
                        {"clusters", r.clusters},
                        {"ns_per_event", r.ns_per_event},
                        {"detect_ns", r.detect_ns},
                        {"resolve_ns", r.resolve_ns},
                        {"kernel_ns", r.kernel_ns},
                        {"cluster_ns", r.cluster_ns},
                        {"queue_ns", r.queue_ns}});
    for (const GasRow& g : bench.growth)
        growth.push_back({{"name", g.name},
                          {"clusters", name(g.clusters)},
                          {"isa", bench.isa},
                          {"n", g.balls},
                          {"search", name(g.search)},
                          {"chosen", g.chosen},
                          {"ns_min", g.ns_min},
                          {"ns_median", g.ns_median},
                          {"growth", g.growth},
                          {"bytes_per_ball", g.bytes_per_ball}});
    const Json all = {{"machine",
                       {{"cpu", bench.cpu},
                        {"compiler", bench.compiler},
                        {"isa", bench.isa},
                        {"baseline_isa", bench.baseline_isa},
                        {"seeds", bench.seeds},
                        {"repeats", bench.repeats}}},
                      {"baseline_ns", bench.baseline_ns},
                      {"rows", rows},
                      {"growth", growth}};
    return all.dump(1) + "\n";
}

std::string shot_bench_text(const ShotBench& bench) {
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    fmt::format_to(line,
                   "{}, {}; isa {}\nbaseline: the plain double march, N = 1000, {}: {:.0f} ns\n"
                   "shots: median over {} seeds of the least time in {} rounds; ns per event, the parts from "
                   "profiled runs (clock included)\n\n",
                   bench.cpu, bench.compiler, bench.isa, bench.baseline_isa, bench.baseline_ns, bench.seeds,
                   bench.repeats);
    fmt::format_to(line, "{:<28}{:>8}{:>7}{:>8}{:>8}{:>9}{:>9}{:>8}{:>8}{:>8}{:>8}{:>8}\n", "", "impacts",
                   "least", "most", "events", "clusters", "ns/event", "detect", "resolve", "kernel",
                   "cluster", "queue");
    for (const ShotRow& r : bench.rows)
        fmt::format_to(line,
                       "{:<28}{:>8.2f}{:>7.2f}{:>8.2f}{:>8.0f}{:>9.0f}{:>9.0f}{:>8.0f}{:>8.0f}{:>8.0f}{:>8."
                       "0f}{:>8.0f}\n",
                       r.name, r.cost_in_impacts, r.cost_least, r.cost_most, r.events, r.clusters,
                       r.ns_per_event, r.detect_ns, r.resolve_ns, r.kernel_ns, r.cluster_ns, r.queue_ns);
    if (bench.growth.empty()) return fmt::to_string(out);
    fmt::format_to(line,
                   "\ngrowth: a gas without friction at equal density, ns per event after set-up; clusters "
                   "sequential, and compliant as by default; * what the plan "
                   "chooses\n{:<20}{:>8}{:>8}{:>9}{:>9}{:>9}{:>12}\n",
                   "", "balls", "search", "ns min", "median", "growth", "bytes/ball");
    for (const GasRow& g : bench.growth)
        fmt::format_to(line, "{:<20}{:>8}{:>7}{}{:>9.0f}{:>9.0f}{:>9.2f}{:>12.0f}\n", g.name, g.balls,
                       name(g.search), g.chosen ? "*" : " ", g.ns_min, g.ns_median, g.growth,
                       g.bytes_per_ball);
    return fmt::to_string(out);
}

}  // namespace carom::tools
