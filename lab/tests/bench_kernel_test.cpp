// The forms of the kernel that carom-lab bench kernel times: all, or the requested ones. Nothing is timed
// here.
#include "bench/kernel.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "bench/timed_kernel.h"
#include "ladder/ladder.h"

namespace carom::tools {
namespace {

using Form = std::tuple<std::string, std::string, kernel::Isa>;  // name, kind, instruction set

class BenchKernel : public testing::Test {
  protected:
    // The tests choose the instruction set, not the calling shell.
    void SetUp() override { ::unsetenv("CAROM_ISA"); }
};

std::multiset<Form> forms(const std::vector<std::string>& only) {
    std::multiset<Form> all;
    for (const TimedKernel& s : timed_kernels(only)) all.insert({s.row.name, s.row.kind, s.row.isa});
    return all;
}

TEST_F(BenchKernel, TimesEveryVariantAndEveryTolerance) {
    std::multiset<Form> expected;
    for (const kernel::Variant& variant : kernel::ladder())
        if (kernel::available(variant.isa))
            expected.insert(
                {std::string("march ") + variant.name, variant.march ? "single" : "batch", variant.isa});
    for (const kernel::Isa isa : {kernel::Isa::kScalar, kernel::Isa::kV3, kernel::Isa::kV4})
        for (const char* name : {"tolerance 1e-3", "tolerance 1e-6", "tolerance 1e-10"})
            for (const char* kind : {"single", "batch"})
                if (kernel::available(isa)) expected.insert({name, kind, isa});
    EXPECT_EQ(forms({}), expected);
    for (const char* name : {"march baseline", "march summed", "march reduced state"})
        EXPECT_TRUE(expected.count({name, "single", kernel::Isa::kScalar})) << name;
}

TEST_F(BenchKernel, TimesTheRequestedForms) {
    const auto all = forms({});
    const auto those = [&all](auto wanted) {
        std::multiset<Form> some;
        for (const Form& form : all)
            if (wanted(std::get<0>(form))) some.insert(form);
        return some;
    };
    using Name = const std::string&;
    EXPECT_EQ(forms({"march packed"}), those([](Name n) { return n == "march packed"; }));
    EXPECT_EQ(forms({"march reduced"}), those([](Name n) { return n == "march reduced state"; }));
    EXPECT_EQ(forms({"tolerance"}), those([](Name n) { return n[0] == 't'; }));
    EXPECT_EQ(forms({"march"}), those([](Name n) { return n[0] == 'm'; }));
    EXPECT_EQ(forms({"tolerance 1e-6", "tolerance 1e-6", "tolerance"}), forms({"tolerance"}));
    EXPECT_EQ(forms({"march masks", "tolerance 1e-3"}),
              those([](Name n) { return n == "march masks" || n == "tolerance 1e-3"; }));
    ::setenv("CAROM_ISA", "scalar", 1);
    EXPECT_EQ(forms({"tolerance 1e-3"}).size(), 2u);
}

TEST_F(BenchKernel, ThePrintedFormsHaveNames) {
    KernelBench bench;
    for (const TimedKernel& s : timed_kernels({})) bench.rows.push_back(s.row);
    for (KernelRow& row : bench.rows) bench.growth.push_back({row.name, row.isa, 100, 1.0, 2.0});
    const auto json = nlohmann::json::parse(kernel_bench_json(bench));
    const std::string text = kernel_bench_text(bench);
    ASSERT_EQ(json.at("rows").size(), bench.rows.size());
    for (std::size_t i = 0; i < bench.rows.size(); ++i) {
        const KernelRow& row = bench.rows[i];
        const auto& printed = json.at("rows").at(i);
        EXPECT_EQ(printed.at("name"), row.name);
        EXPECT_EQ(printed.at("section"), row.section);
        EXPECT_EQ(printed.at("isa"), name(row.isa));
        EXPECT_EQ(printed.at("kind"), row.kind);
        EXPECT_EQ(printed.at("portable_bits"), row.portable_bits);
        EXPECT_EQ(json.at("growth").at(i).at("name"), row.name);
        EXPECT_NE(text.find("\n" + row.name + " "), std::string::npos) << row.name;
    }
}

}  // namespace
}  // namespace carom::tools
