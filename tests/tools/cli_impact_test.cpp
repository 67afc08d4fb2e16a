// carom impact as an oracle: the published states, errors that do not stop it, immediate responses.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "carom/kernel/isa.h"
#include "cli.h"
#include "support/impact_cases.h"

namespace carom::test {
namespace {

using Json = nlohmann::json;

Json line_of(const ReferenceImpact& impact) {
    const auto list = [](const double(&v)[3]) { return Json::array({v[0], v[1], v[2]}); };
    const kernel::ImpactParams& p = impact.params;
    return {
        {"kind", "ball_ball"},
        {"params",
         {{"R", p.R}, {"m", p.m}, {"mu_s1", p.mu_s1}, {"mu_s2", p.mu_s2}, {"mu_b", p.mu_b}, {"e_b", p.e_b}}},
        {"r1", list(impact.ball1.r)},
        {"v1", list(impact.ball1.v)},
        {"w1", list(impact.ball1.w)},
        {"r2", list(impact.ball2.r)},
        {"v2", list(impact.ball2.v)},
        {"w2", list(impact.ball2.w)}};
}

/// All impacts of a file in one run of the program: the largest difference from the file's results.
double largest_difference(const std::string& file, const std::string& model, std::vector<std::string> options,
                          const std::string& isa) {
    const std::vector<ReferenceImpact> impacts = reference_impacts(file);
    ProcessOptions process;
    process.environment = {{"CAROM_ISA", isa}};
    std::vector<const ReferenceImpact*> asked;
    for (const ReferenceImpact& impact : impacts) {
        if (impact.outputs.count(model) == 0) continue;
        process.input += line_of(impact).dump() + "\n";
        asked.push_back(&impact);
    }
    options.insert(options.begin(), "impact");
    const ProcessResult result = carom(options, process);
    EXPECT_EQ(result.status, 0) << result.err << result.out;
    const std::vector<std::string> lines = lines_of(result.out);
    EXPECT_EQ(lines.size(), asked.size());
    EXPECT_FALSE(asked.empty());
    double most = 0.0;
    for (std::size_t i = 0; i < asked.size() && i < lines.size(); ++i) {
        const double off =
            difference(read_result(Json::parse(lines[i])), asked[i]->outputs.at(model), asked[i]->params.R);
        most = std::max(most, off);
    }
    return most;
}

TEST(CliImpact, ReproducesThePapersStates) {
    for (const char* isa : {"scalar", "v3"}) {
        kernel::Isa level{};
        ASSERT_TRUE(kernel::parse_isa(isa, level));
        if (!kernel::available(level)) continue;
        EXPECT_LE(largest_difference("paper_states.json", "frictional_mathavan_N1000",
                                     {"--substeps", "1000", "--cloth-slip", "as_published"}, isa),
                  1e-11)
            << isa;
    }
}

TEST(CliImpact, ReproducesPooltool) {
    EXPECT_LE(largest_difference("ball_ball.json", "frictional_mathavan_N1000",
                                 {"--substeps", "1000", "--cloth-slip", "as_published"}, ""),
              1e-9);
    EXPECT_LE(largest_difference("ball_ball.json", "frictional_mathavan_N100",
                                 {"--substeps", "100", "--cloth-slip", "as_published"}, ""),
              1e-9);
    // The two signs of the cloth slip are two models; the default differs from the published one.
    EXPECT_GT(largest_difference("ball_ball.json", "frictional_mathavan_N1000", {"--substeps", "1000"}, ""),
              1e-6);
}

TEST(CliImpact, AnErrorDoesNotStopTheRunAndExits1) {
    const std::string good = line_of(reference_impacts("paper_states.json").at(0)).dump();
    ProcessOptions options;
    // A blank line is skipped; the last line has no line end.
    options.input = good + "\nnonsense\n\n" + good;
    const ProcessResult result = carom({"impact"}, options);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.err, "");
    const std::vector<std::string> lines = lines_of(result.out);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_TRUE(Json::parse(lines[0]).contains("v1"));
    EXPECT_EQ(lines[1], "{\"error\":\"not valid JSON (at byte 2)\"}");
    EXPECT_TRUE(Json::parse(lines[2]).contains("v1"));
}

TEST(CliImpact, EmptyInputIsNoError) {
    const ProcessResult result = carom({"impact"});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out, "");
}

TEST(CliImpact, ALineOfAnyLengthIsAnsweredOnce) {
    ProcessOptions options;
    options.input = std::string(5 << 20, '[') + "\n{}\n";
    const ProcessResult result = carom({"impact"}, options);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.out,
              "{\"error\":\"the line is longer than 1048576 bytes\"}\n{\"error\":\"the key \\\"kind\\\" is "
              "missing\"}\n");
}

TEST(CliImpact, EveryLineIsAnsweredImmediately) {
    Process process({CAROM_PROGRAM, "impact"}, {});
    const std::string line = line_of(reference_impacts("paper_states.json").at(1)).dump() + "\n";
    for (int i = 0; i < 3; ++i) {
        const std::string answer = process.ask(line, 20000);
        ASSERT_FALSE(answer.empty()) << "no answer while the pipe stays open";
        EXPECT_TRUE(Json::parse(answer).contains("steps"));
    }
    EXPECT_EQ(process.finish("").status, 0);
}

TEST(CliImpact, AnInterruptWhileWaitingExits130) {
    Process process({CAROM_PROGRAM, "impact"}, {});
    // A response shows that the program is running with its handler installed.
    ASSERT_FALSE(process.ask("{}\n", 20000).empty());
    process.interrupt();
    EXPECT_EQ(process.finish("").status, 130);
}

}  // namespace
}  // namespace carom::test
