#include "bench/timed_kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "base/console.h"
#include "base/setup.h"
#include "carom/kernel/tolerance.h"

namespace carom::tools {
namespace {

using namespace kernel;

std::vector<TimedKernel> subjects(const std::vector<Isa>& isas) {
    std::vector<TimedKernel> list;
    for (const Variant& variant : ladder()) {
        if (std::find(isas.begin(), isas.end(), variant.isa) == isas.end()) continue;
        TimedKernel& s = list.emplace_back(call_of(variant));
        s.row = {std::string("march ") + variant.name, variant.section, s.kind(), variant.isa,
                 variant.portable_bits};
    }
    const std::pair<const char*, double> asked[] = {
        {"tolerance 1e-3", 1e-3}, {"tolerance 1e-6", 1e-6}, {"tolerance 1e-10", 1e-10}};
    for (Isa isa : isas) {
        for (const auto& [name, tolerance] : asked) {
            for (const bool batch : {false, true}) {
                TimedKernel& s = list.emplace_back(tolerance_call(isa, tolerance, batch));
                s.row = {name, "past it", s.kind(), isa, true};
            }
        }
    }
    return list;
}

/// Whether `wanted` is the whole name (exact), or its first words.
bool is_meant(const std::string& name, const std::string& wanted, bool exact) {
    return exact ? name == wanted : name.rfind(wanted + " ", 0) == 0;
}

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
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(kept), list.end());
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

KernelCall call_of(const Variant& variant) {
    if (variant.march == nullptr)
        return {{}, [f = variant.batch](const BatchArrays& a, int n) { f(a.batch, n, a.result); }};
    return {[f = variant.march](const Impact& i, int n, ImpactResult& out) {
                f(i.ball1, i.ball2, i.params, n, out);
            },
            {}};
}

KernelCall tolerance_call(Isa isa, double tolerance, bool batch) {
    if (batch)
        return {{}, [f = tolerance_batch_function(isa), tolerance](const BatchArrays& a, int) {
                    f(a.batch, tolerance, a.result);
                }};
    return {[f = tolerance_function(isa), tolerance](const Impact& i, int, ImpactResult& out) {
                f(i.ball1, i.ball2, i.params, tolerance, out);
            },
            {}};
}

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

}  // namespace carom::tools
