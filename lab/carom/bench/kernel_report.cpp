// carom-lab bench kernel: the tables, as text and as JSON.
#include <fmt/format.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/kernel.h"
#include "report/table.h"

namespace carom::tools {
namespace {

Table rows_of(const KernelBench& bench) {
    Table table(Column("name", "", "<26"), Column("section", "section", "<9"), Column("isa", "isa", "<7"),
                Column("kind", "kind", "<7"), Column("portable_bits"), Column("ratio", "ratio", ">8.2f"),
                Column("ratio_random", "random", ">8.2f"), Column("ns_min", "ns min", ">9.0f"),
                Column("ns_median", "median", ">9.0f"), Column("ns_random_min"),
                Column("cycles_per_step", "cyc/st", ">7.1f"), Column("steps"),
                Column("same_steps", "same", ">6"), Column("diff_five", "diff 5", ">9.1e"),
                Column("diff_random_p99"), Column("diff_random_max", "diff max", ">9.1e"),
                Column("error_five", "error 5", ">9.1e"), Column("error_random_median"),
                Column("error_random_max", "err max", ">9.1e"));
    for (const KernelRow& r : bench.rows)
        table.add({r.name, r.section, name(r.isa), r.kind, r.portable_bits, r.ratio, r.ratio_random, r.ns_min,
                   r.ns_median, r.ns_random_min, r.cycles_per_step, r.steps_mean, r.same_steps, r.diff_five,
                   r.diff_random_p99, r.diff_random_max, r.error_five, r.error_random_median,
                   r.error_random_max});
    return table;
}

/// One row per N.
Table growth_of(const KernelBench& bench) {
    Table table(Column("name"), Column("isa"), Column("n"), Column("ns_min"), Column("ns_median"));
    for (const GrowthRow& g : bench.growth) table.add({g.name, name(g.isa), g.n, g.ns_min, g.ns_median});
    return table;
}

/// One row per kernel, one column per N; the measurements come kernel by kernel for each N.
Table growth_by_kernel(const KernelBench& bench) {
    Table table(Column("", "", "<26"), Column("", "isa", "<7"));
    std::size_t kernels = 0;
    while (kernels < bench.growth.size() && bench.growth[kernels].n == bench.growth[0].n) ++kernels;
    for (std::size_t i = 0; i < bench.growth.size(); i += kernels)
        table.columns.emplace_back("", fmt::format("{}", bench.growth[i].n), ">10.0f");
    for (std::size_t k = 0; k < kernels; ++k) {
        table.add({bench.growth[k].name, name(bench.growth[k].isa)});
        for (std::size_t i = k; i < bench.growth.size(); i += kernels)
            table.rows.back().cells.emplace_back(bench.growth[i].ns_min);
    }
    return table;
}

Table shares_of(const KernelBench& bench) {
    Table table(Column("name", "", "<26"), Column("isa", "isa", "<7"), Column("before_ns", "before", ">8.0f"),
                Column("loop_ns", "in", ">9.0f"), Column("after_ns", "after", ">8.0f"),
                Column("warm_ns", "warm", ">10.0f"), Column("cold_ns", "cold", ">9.0f"));
    for (const ShareRow& s : bench.shares)
        table.add({s.name, name(s.isa), s.before, s.loop, s.after, s.warm, s.cold});
    return table;
}

}  // namespace

std::string kernel_bench_json(const KernelBench& bench) {
    const nlohmann::ordered_json all = {{"machine",
                                         {{"cpu", bench.cpu},
                                          {"compiler", bench.compiler},
                                          {"cycle_ns", bench.cycle_ns},
                                          {"probe_ns", bench.probe_ns},
                                          {"baseline_isa", bench.baseline_isa},
                                          {"random", bench.random}}},
                                        {"baseline_ns", bench.baseline_ns},
                                        {"baseline_random_ns", bench.baseline_random_ns},
                                        {"rows", table_json(rows_of(bench))},
                                        {"growth", table_json(growth_of(bench))},
                                        {"shares", table_json(shares_of(bench))}};
    return all.dump(1) + "\n";
}

std::string kernel_bench_text(const KernelBench& bench) {
    std::string text = fmt::format(
        "{}, {}; cycle {:.4f} ns\nbaseline: the plain double march with the faster flags, N = 1000, {}: "
        "{:.0f} ns (five "
        "states), {:.0f} ns ({} random impacts)\n\n",
        bench.cpu, bench.compiler, bench.cycle_ns, bench.baseline_isa, bench.baseline_ns,
        bench.baseline_random_ns, bench.random);
    text += table_text(rows_of(bench));
    if (!bench.growth.empty())
        text +=
            "\ngrowth with N, ns per impact, minimum (five states)\n" + table_text(growth_by_kernel(bench));
    if (!bench.shares.empty())
        text += fmt::format(
            "\nns before, in and after the loop; warm and cold caches (a probe costs {:.0f} ns)\n{}",
            bench.probe_ns, table_text(shares_of(bench)));
    return text;
}

}  // namespace carom::tools
