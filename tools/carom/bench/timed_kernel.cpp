#include "bench/timed_kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "carom/kernel/tolerance.h"
#include "console.h"
#include "ladder/ladder.h"
#include "setup.h"

namespace carom::tools {
namespace {

using namespace kernel;

std::vector<TimedKernel> subjects(const std::vector<Isa>& isas) {
    std::vector<TimedKernel> list;
    for (const Rung& rung : ladder()) {
        if (std::find(isas.begin(), isas.end(), rung.isa) == isas.end()) continue;
        TimedKernel s;
        s.row = {std::string("march ") + rung.name, rung.section, rung.march ? "single" : "batch", rung.isa,
                 rung.portable_bits};
        if (rung.march)
            s.one = [f = rung.march](const Impact& i, int n, ImpactResult& out) {
                f(i.ball1, i.ball2, i.params, n, out);
            };
        else
            s.many = [f = rung.batch](const BatchArrays& a, int n) { f(a.batch, n, a.result); };
        list.push_back(std::move(s));
    }
    const struct {
        const char* name;
        double tolerance;
    } asked[] = {{"tolerance 1e-3", 1e-3}, {"tolerance 1e-6", 1e-6}, {"tolerance 1e-10", 1e-10}};
    for (Isa isa : isas) {
        for (const auto& a : asked) {
            list.emplace_back().row = {a.name, "past it", "single", isa, true};
            list.back().one = [f = tolerance_function(isa), t = a.tolerance](const Impact& i, int,
                                                                             ImpactResult& out) {
                f(i.ball1, i.ball2, i.params, t, out);
            };
            list.emplace_back().row = {a.name, "past it", "batch", isa, true};
            list.back().many = [f = tolerance_batch_function(isa), t = a.tolerance](
                                   const BatchArrays& arrays, int) { f(arrays.batch, t, arrays.result); };
        }
    }
    return list;
}

/// Whether `wanted` is the name itself (exact), or consists of its first words.
bool is_meant(const std::string& name, const std::string& wanted, bool exact) {
    return exact ? name == wanted : name.rfind(wanted + " ", 0) == 0;
}

/// Keeps the rows that are asked for.
void choose(std::vector<TimedKernel>& list, const std::vector<std::string>& only) {
    if (only.empty()) return;
    std::vector<bool> keep(list.size(), false);
    for (const std::string& wanted : only) {
        bool found = false;
        for (const bool exact : {true, false}) {
            if (found) break;
            for (std::size_t i = 0; i < list.size(); ++i) {
                if (!is_meant(list[i].row.name, wanted, exact)) continue;
                keep[i] = found = true;
            }
        }
        if (found) continue;
        std::string names;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string& name = list[i].row.name;
            const auto same = [&name](const TimedKernel& s) { return s.row.name == name; };
            if (std::none_of(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(i), same))
                names += (names.empty() ? "" : ", ") + name;
        }
        throw UsageError(
            fmt::format("--only: there is no form \"{}\" on the instruction sets of this run; name one "
                        "of these, or first words of some: {}",
                        wanted, names));
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
        if (keep[i]) std::swap(list[kept++], list[i]);
    list.resize(kept);
}

std::vector<Isa> chosen_isas() {
    const Isa isa = chosen_isa();
    const char* forced = std::getenv("CAROM_ISA");
    if (forced != nullptr && *forced != '\0') return {isa};
    std::vector<Isa> list;
    for (Isa candidate : {Isa::kScalar, Isa::kV3, Isa::kV4})
        if (available(candidate)) list.push_back(candidate);
    return list;
}

}  // namespace

std::vector<TimedKernel> timed_kernels(const std::vector<std::string>& only) {
    std::vector<TimedKernel> list = subjects(chosen_isas());
    choose(list, only);
    return list;
}

std::vector<ImpactResult> results_of(const TimedKernel& kernel, const ImpactSet& set, int n) {
    std::vector<ImpactResult> results(set.impacts.size());
    kernel.run(set, n, results);
    if (kernel.many)
        for (std::size_t i = 0; i < results.size(); ++i) results[i] = set.arrays->get(i);
    return results;
}

std::vector<KernelRow> kernel_rows(const BenchKernelArgs& options) {
    const std::vector<TimedKernel> list = timed_kernels(options.only);
    std::vector<KernelRow> rows;
    rows.reserve(list.size());
    for (const TimedKernel& s : list) rows.push_back(s.row);
    return rows;
}

}  // namespace carom::tools
