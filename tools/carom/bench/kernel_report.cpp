// carom bench kernel: the table, and the JSON of docs/cli.
#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/kernel.h"

namespace carom::tools {

std::string kernel_bench_json(const KernelBench& bench) {
    using Json = nlohmann::ordered_json;
    Json rows = Json::array(), growth = Json::array(), shares = Json::array();
    for (const KernelRow& r : bench.rows)
        rows.push_back({{"name", r.name},
                        {"section", r.section},
                        {"isa", name(r.isa)},
                        {"kind", r.kind},
                        {"portable_bits", r.portable_bits},
                        {"ratio", r.ratio},
                        {"ratio_random", r.ratio_random},
                        {"ns_min", r.ns_min},
                        {"ns_median", r.ns_median},
                        {"ns_random_min", r.ns_random_min},
                        {"cycles_per_step", r.cycles_per_step},
                        {"steps", r.steps_mean},
                        {"same_steps", r.same_steps},
                        {"diff_five", r.diff_five},
                        {"diff_random_p99", r.diff_random_p99},
                        {"diff_random_max", r.diff_random_max},
                        {"error_five", r.error_five},
                        {"error_random_median", r.error_random_median},
                        {"error_random_max", r.error_random_max}});
    for (const GrowthRow& g : bench.growth)
        growth.push_back({{"name", g.name},
                          {"isa", name(g.isa)},
                          {"n", g.n},
                          {"ns_min", g.ns_min},
                          {"ns_median", g.ns_median}});
    for (const ShareRow& s : bench.shares)
        shares.push_back({{"name", s.name},
                          {"isa", name(s.isa)},
                          {"before_ns", s.before},
                          {"loop_ns", s.loop},
                          {"after_ns", s.after},
                          {"warm_ns", s.warm},
                          {"cold_ns", s.cold}});
    const Json all = {{"machine",
                       {{"cpu", bench.cpu},
                        {"compiler", bench.compiler},
                        {"cycle_ns", bench.cycle_ns},
                        {"probe_ns", bench.probe_ns},
                        {"baseline_isa", bench.baseline_isa},
                        {"random", bench.random}}},
                      {"baseline_ns", bench.baseline_ns},
                      {"baseline_random_ns", bench.baseline_random_ns},
                      {"rows", rows},
                      {"growth", growth},
                      {"shares", shares}};
    return all.dump(1) + "\n";
}

std::string kernel_bench_text(const KernelBench& bench) {
    fmt::memory_buffer out;
    const auto line = std::back_inserter(out);
    fmt::format_to(line,
                   "{}, {}; cycle {:.4f} ns\nbaseline: the plain double march, N = 1000, {}: {:.0f} ns (five "
                   "states), {:.0f} ns ({} random impacts)\n\n",
                   bench.cpu, bench.compiler, bench.cycle_ns, bench.baseline_isa, bench.baseline_ns,
                   bench.baseline_random_ns, bench.random);
    fmt::format_to(line, "{:<26}{:<9}{:<7}{:<7}{:>8}{:>8}{:>9}{:>9}{:>7}{:>6}{:>9}{:>9}{:>9}{:>9}\n", "",
                   "section", "isa", "kind", "ratio", "random", "ns min", "median", "cyc/st", "same",
                   "diff 5", "diff max", "error 5", "err max");
    for (const KernelRow& r : bench.rows)
        fmt::format_to(line,
                       "{:<26}{:<9}{:<7}{:<7}{:>8.2f}{:>8.2f}{:>9.0f}{:>9.0f}{:>7.1f}{:>6}{:>9.1e}{:>9.1e}{:>"
                       "9.1e}{:>9.1e}\n",
                       r.name, r.section, name(r.isa), r.kind, r.ratio, r.ratio_random, r.ns_min, r.ns_median,
                       r.cycles_per_step, r.same_steps, r.diff_five, r.diff_random_max, r.error_five,
                       r.error_random_max);
    if (!bench.growth.empty()) {
        fmt::format_to(
            line, "\ngrowth with N, ns per impact, minimum (five states)\n{:<26}{:<7}{:>10}{:>10}{:>10}\n",
            "", "isa", "100", "1000", "10000");
        for (const GrowthRow& a : bench.growth) {
            if (a.n != 100) continue;
            fmt::format_to(line, "{:<26}{:<7}{:>10.0f}", a.name, name(a.isa), a.ns_min);
            for (int n : {1000, 10000})
                for (const GrowthRow& b : bench.growth)
                    if (b.n == n && b.name == a.name && b.isa == a.isa) {
                        fmt::format_to(line, "{:>10.0f}", b.ns_min);
                        break;
                    }
            fmt::format_to(line, "\n");
        }
    }
    if (bench.shares.empty()) return fmt::to_string(out);
    fmt::format_to(line,
                   "\nns before, in and after the loop; warm and cold caches (a probe costs {:.0f} ns)\n",
                   bench.probe_ns);
    for (const ShareRow& s : bench.shares)
        fmt::format_to(line, "{:<26}{:<7}{:>8.0f}{:>9.0f}{:>8.0f}{:>10.0f}{:>9.0f}\n", s.name, name(s.isa),
                       s.before, s.loop, s.after, s.warm, s.cold);
    return fmt::to_string(out);
}

}  // namespace carom::tools
