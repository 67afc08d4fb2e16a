// The command line as a whole: help, version, exit statuses, closed outputs, instruction sets.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "carom/kernel/isa.h"
#include "cli.h"

namespace carom::test {
namespace {

TEST(CliUsage, VersionAndHelpExit0) {
    EXPECT_EQ(carom({"--version"}).out, "carom " CAROM_VERSION "\n");
    const ProcessResult help = carom({"--help"});
    EXPECT_EQ(help.status, 0);
    for (const char* command :
         {"simulate", "render", "compare", "margin", "accuracy", "sweep", "check", "impact", "describe"}) {
        EXPECT_TRUE(contains(help.out, command)) << command;
        const ProcessResult result = carom({command, "--help"});
        EXPECT_EQ(result.status, 0) << command;
        EXPECT_EQ(result.err, "") << command;
    }
    for (const char* group : {"\nPlay:\n  simulate", "\nLook:\n  view", "\nMany shots:\n  sweep",
                              "\nAsk:\n  check", "\nFor programs:\n  impact"})
        EXPECT_TRUE(contains(help.out, group)) << group;
}

TEST(CliUsage, HelpNamesEveryDefault) {
    for (const char* command :
         {"simulate", "render", "compare", "margin", "accuracy", "sweep", "check", "impact", "describe"}) {
        // Options begin with two spaces and a dash; their text may continue on the following lines.
        std::string option;
        const auto has_default = [&option] {
            return option.empty() || contains(option, "--help") || contains(option, "default:") ||
                   contains(option, "=") || contains(option, "REQUIRED");
        };
        for (const std::string& line : lines_of(carom({command, "--help"}).out)) {
            const bool starts = line.substr(0, 3) == "  -";
            if (starts || line.empty()) {
                EXPECT_TRUE(has_default()) << command << ": " << option;
                option = starts ? line : "";
            } else if (!option.empty()) {
                option += line;
            }
        }
        EXPECT_TRUE(has_default()) << command << ": " << option;
    }
}

TEST(CliUsage, SingularAndPluralAgree) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", "[[ball]]\n[cue]\n[stop]\nevents = 1\n");
    EXPECT_TRUE(contains(carom({"simulate", scene}).out, ": 1 ball, 0.0000 s, 1 event; "));
    EXPECT_TRUE(contains(carom({"check", scene}).out, "or after 1 event\n"));
    const std::string margin = carom({"margin", scene, "--no-render"}).out;
    EXPECT_TRUE(contains(margin, ": 1 frame of 16.667 ms")) << margin;
    EXPECT_TRUE(contains(margin, " ms, 1 event\n")) << margin;
}

TEST(CliUsage, AFullDiskIsAnError) {
    ProcessOptions options;
    options.output_to = "/dev/full";
    const ProcessResult result = carom({"--help"}, options);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.err, "carom: standard output: No space left on device\n");
}

TEST(CliUsage, AClosedOutputIsAnErrorAndIsNotReusedForAFile) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", kSmallScene);
    const std::string record = folder.file("r.json");
    const ProcessResult result = run_process(
        {"/bin/sh", "-c", "exec \"$0\" simulate \"$1\" -o \"$2\" >&-", CAROM_PROGRAM, scene, record});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(read_file(record).substr(0, 10), "{\"format\":");
    EXPECT_FALSE(contains(read_file(record), "final positions"));
}

TEST(CliIsa, UnknownAndUnavailableAreErrors) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", kSmallScene);
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"simulate", scene},
                                                      {"check", scene},
                                                      {"margin", scene, "--no-render"},
                                                      {"impact"}}) {
        const ProcessResult unknown = carom_isa("sse9", arguments);
        EXPECT_EQ(unknown.status, 2) << arguments[0];
        EXPECT_EQ(unknown.out, "");
        EXPECT_EQ(unknown.err.find("carom: CAROM_ISA=sse9: no such instruction set; available here: scalar"),
                  0u)
            << unknown.err;
        for (const kernel::Isa isa : {kernel::Isa::kScalar, kernel::Isa::kV3, kernel::Isa::kV4}) {
            const ProcessResult result = carom_isa(kernel::name(isa), arguments);
            EXPECT_EQ(result.status, kernel::available(isa) ? 0 : 2) << kernel::name(isa) << result.err;
            EXPECT_EQ(contains(result.err, "cannot run it"), !kernel::available(isa)) << result.err;
        }
    }
}

TEST(CliCheck, PrintsThePlan) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", kSmallScene);
    const ProcessResult result = carom_isa("scalar", {"check", scene});
    ASSERT_EQ(result.status, 0) << result.err;
    for (const char* part :
         {": valid\n", "nine_foot", "3: cue 1 ball 2\n", "mathavan", "han_2005", "clusters compliant",
          "by tolerance 1e-06: closed forms, else collocation; cloth slip consistent",
          "isa       scalar (available: scalar", "\ncushions  ", "\njaws      ", "\npockets   "}) {
        EXPECT_TRUE(contains(result.out, part)) << part << "\n" << result.out;
    }
    // By default, every kernel has its own instruction set.
    const std::string free = carom_isa("", {"check", scene}).out;
    const std::string impacts = kernel::name(kernel::fastest_isa(kernel::KernelKind::kTolerance)),
                      clusters = kernel::name(kernel::fastest_isa(kernel::KernelKind::kContactPhase));
    EXPECT_TRUE(contains(free, "\nisa       impacts " + impacts + ", clusters " + clusters + ": ")) << free;
    for (const char* effect : {"sliding", "rolling", "spin_decay", "throw", "cloth_in_impact", "cushions",
                               "cushion_friction", "pockets", "squirt", "clusters", "airborne"}) {
        EXPECT_TRUE(contains(result.out, std::string("\n  ") + effect + " ")) << effect << "\n" << result.out;
    }
}

TEST(CliCheck, ShowsFrictionBySlipAndUnlikeBalls) {
    const TemporaryFolder folder;
    const std::string scene =
        folder.write("s.toml",
                     "[balls]\nmu_b_fit = [0.01, 0.1, 1.5]\n[physics]\nball_ball = \"inelastic\"\n"
                     "clusters = \"sequential\"\n[[ball]]\nid = \"a\"\nposition = [0.5, 0.5]\n"
                     "[[ball]]\nid = \"b\"\nposition = [0.9, 0.5]\nmass = 0.2\n");
    const ProcessResult result = carom({"check", scene});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("mu_b at slip u: 0.01 + 0.1 exp(-1.5 u)\n"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("ball b differs: R 0.028575 m, mass 0.2 kg\n"), std::string::npos);
    EXPECT_NE(result.out.find("closed form"), std::string::npos);
}

}  // namespace
}  // namespace carom::test
