// The command line as a whole: help, version, exit statuses, closed outputs, instruction sets.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "carom/kernel/isa.h"
#include "cli.h"

namespace carom::test {
namespace {

TEST(CliUsage, BadUsageExits2WithOneMessageAndNoOutput) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", kSmallScene);
    const struct {
        std::vector<std::string> arguments;
        const char* message;
    } kCases[] = {
        {{},
         "no command given: expected simulate, play, next, judge, view, render, diagram, export, compare, "
         "sweep, break, solve, sensitivity, fit, check, accuracy, margin, impact or describe; see carom "
         "--help"},
        {{"accuracy"}, "accuracy: no scene file given; see --help"},
        {{"fly"}, "fly"},
        {{"--fast"}, "--fast"},
        {{"simulate"}, "SCENE is required; see carom simulate --help"},
        {{"simulate", folder.file("none.toml")}, "none.toml: "},
        {{"simulate", "/"}, "/: "},
        {{"simulate", scene, "--verified"}, "--verified"},
        {{"simulate", scene, "--until", "soon"}, "soon"},
        {{"simulate", scene, "--until", "-1"}, "--until: expected a number of seconds of at least 0"},
        {{"simulate", scene, "--until", "nan"}, "--until: expected a number of seconds of at least 0"},
        {{"simulate", scene, "--samples", folder.file("x.csv")}, "--samples needs --sample-dt S"},
        {{"simulate", scene, "--sample-dt", "0.1"}, "--sample-dt needs --samples FILE"},
        {{"simulate", scene, "--samples", folder.file("x.csv"), "--sample-dt", "0"}, "--sample-dt: expected"},
        {{"simulate", scene, "--samples", folder.file("x.csv"), "--sample-dt", "1e-12"}, "rows"},
        {{"render", folder.file("none.json")}, "none.json: there is no such file"},
        {{"render", scene, "-o", folder.file("frame.png")}, "frame.png"},
        {{"render", scene, "--size", "1280"}, "--size 1280: expected WIDTHxHEIGHT"},
        {{"render", scene, "--size", "0x5"}, "--size 0x5: expected WIDTHxHEIGHT"},
        {{"render", scene, "--size", "10x10x10"}, "--size 10x10x10: expected WIDTHxHEIGHT"},
        {{"render", scene, "--size", "99999999999x1"}, "expected WIDTHxHEIGHT"},
        {{"render", scene, "--fps", "0"}, "--fps 0: expected a number greater than 0"},
        {{"render", scene, "--from", "2", "--to", "1"}, "--to is before --from"},
        {{"render", scene, "--from", "1e6"}, "--from 1000000: the shot ends at"},
        {{"render", scene, "--to", "1e9"}, "frames"},
        {{"render", scene, "--frame", "1000000"}, "--frame 1000000: the last frame is"},
        {{"render", scene, "--at", "1", "--to", "2"}, "--at shows one instant"},
        {{"render", scene, "--png-level", "1"}, "--png-level"},
        {{"render", scene, "--png-writer", "libpng"}, "--png-writer"},
        {{"render", scene, "--raw", "--y4m"}, "--raw"},
        {{"render", scene, "--y4m", "--sheet", "2x2"}, "--y4m cannot be combined"},
        {{"render", scene, "--camera", "from the moon"}, "from the moon"},
        {{"margin", scene, "--repeat", "0"}, "--repeat"},
        {{"margin", scene, "--sweep"}, "--sweep"},
        {{"compare", scene}, "B is required; see carom compare --help"},
        {{"compare", scene, scene, "more"}, "more"},
        {{"check", scene, "more"}, "more"},
        {{"impact", "--method", "magic"}, "magic"},
        {{"impact", "--substeps", "0"}, "--substeps"},
        {{"impact", "--cloth-slip", "wet"}, "wet"},
    };
    for (const auto& c : kCases) {
        const ProcessResult result = carom(c.arguments);
        std::string shown;
        for (const std::string& argument : c.arguments) shown += argument + " ";
        EXPECT_EQ(result.status, 2) << shown << result.err;
        EXPECT_EQ(result.out, "") << shown;
        EXPECT_EQ(lines_of(result.err).size(), 1u) << shown << result.err;
        EXPECT_EQ(result.err.substr(0, 7), "carom: ") << shown << result.err;
        EXPECT_TRUE(contains(result.err, c.message)) << shown << result.err;
    }
    EXPECT_EQ(folder.names(), std::vector<std::string>{"s.toml"});
}

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
        // Options begin with two spaces and a dash; their text may continue on the lines below.
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

TEST(CliUsage, OneIsNotMany) {
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

TEST(CliUsage, AClosedPipeEndsQuietly) {
    const TemporaryFolder folder;
    ProcessOptions options;
    options.close_output = true;
    const ProcessResult result = carom({"check", folder.write("s.toml", kSmallScene)}, options);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.err, "");
}

TEST(CliUsage, AClosedOutputIsAnErrorAndGetsNoFilesNumber) {
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
    // By default, every kernel has its own.
    const std::string free = carom_isa("", {"check", scene}).out;
    const std::string impacts = kernel::name(kernel::fastest_isa(kernel::KernelKind::kTolerance)),
                      clusters = kernel::name(kernel::fastest_isa(kernel::KernelKind::kContactPhase));
    EXPECT_TRUE(contains(free, "\nisa       impacts " + impacts + ", clusters " + clusters + ": ")) << free;
    for (const char* effect : {"sliding", "rolling", "spin_decay", "throw", "cloth_in_impact", "cushions",
                               "cushion_friction", "pockets", "squirt", "clusters", "airborne"}) {
        EXPECT_TRUE(contains(result.out, std::string("\n  ") + effect + " ")) << effect << "\n" << result.out;
    }
}

}  // namespace
}  // namespace carom::test
