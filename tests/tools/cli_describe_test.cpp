// The man page and the completions that the program prints about itself.
#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli.h"
#include "support/pages.h"

namespace carom::test {
namespace {

ProcessResult shell(const std::string& program, const std::string& script, const std::string& folder) {
    ProcessOptions options;
    options.folder = folder;
    return run_process({program, "-c", script}, options);
}

std::string described(const std::string& format) {
    const ProcessResult result = carom({"describe", format});
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
}

/// Completions that bash offers for the last word of a line.
std::set<std::string> offered(const TemporaryFolder& folder, const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) line += " '" + word + "'";
    const ProcessResult result = shell("bash",
                                       "set -u; . ./completion; COMP_WORDS=(" + line +
                                           "); COMP_CWORD=" + std::to_string(words.size() - 1) +
                                           "; _carom; printf '%s\\n' \"${COMPREPLY[@]}\"",
                                       folder.path().string());
    EXPECT_EQ(result.status, 0) << result.err;
    std::istringstream lines(result.out);
    std::set<std::string> found;
    for (std::string one; std::getline(lines, one);)
        if (!one.empty()) found.insert(one);
    return found;
}

using Words = std::set<std::string>;

TEST(CliDescribe, BashOffersCommandsOptionsValuesAndFiles) {
    const TemporaryFolder folder;
    folder.write("completion", described("bash"));
    folder.write("a shot.toml", "");
    EXPECT_EQ(offered(folder, {"carom", "s"}), (Words{"sensitivity", "simulate", "solve", "sweep"}));
    EXPECT_EQ(offered(folder, {"carom", "co"}), Words{"compare"});
    EXPECT_EQ(offered(folder, {"carom", "compare", "--to"}), Words{"--tolerance"});
    EXPECT_EQ(offered(folder, {"carom", "compare", "a"}), Words{"a shot.toml"});
    EXPECT_EQ(offered(folder, {"carom", "compare", "a shot.toml", "a"}), Words{"a shot.toml"});
    EXPECT_EQ(offered(folder, {"carom", "export", "a"}), Words{"a shot.toml"});
    EXPECT_EQ(offered(folder, {"carom", "--v"}), Words{"--version"});
    EXPECT_EQ(offered(folder, {"carom", "render", "--camera", ""}),
              (Words{"top", "rail", "player", "follow"}));
    EXPECT_EQ(offered(folder, {"carom", "render", "--fr"}), (Words{"--from", "--frame"}));
    EXPECT_EQ(offered(folder, {"carom", "render", "--fps", ""}), Words{});
    EXPECT_EQ(offered(folder, {"carom", "check", "a"}), Words{"a shot.toml"});
    EXPECT_EQ(offered(folder, {"carom", "sweep", "-o", "a"}), Words{"a shot.toml"});
    EXPECT_EQ(offered(folder, {"carom", "describe", ""}),
              (Words{"man", "bash", "zsh", "command-line", "scene-schema", "record-schema", "scene-format",
                     "measures", "games", "events", "types", "types-python", "types-typescript"}));
}

TEST(CliDescribe, ZshReadsItsCompletion) {
    const TemporaryFolder folder;
    const std::string text = described("zsh");
    EXPECT_EQ(text.rfind("#compdef carom\n", 0), 0u);
    folder.write("_carom", text);
    if (run_process({"zsh", "--version"}).status != 0) GTEST_SKIP() << "zsh is not installed";
    const ProcessResult result = shell("zsh", "zsh -n _carom", folder.path().string());
    EXPECT_EQ(result.status, 0) << result.err;
    // Substitutes for _arguments and _describe print their arguments.
    const ProcessResult seen =
        shell("zsh",
              "_arguments() { print -l -- \"$@\"; }; _describe() { print -l -- ${(P)2}; }\n"
              "words=(x); state=command; source ./_carom; _carom_render; _carom_sweep",
              folder.path().string());
    EXPECT_EQ(seen.status, 0) << seen.err;
    for (const char* line : {"*--vary[Vary a key, once per key", ":SCENE:_files",
                             "(--camera)--camera[Camera (default", ":NAME:(top rail player follow)"})
        EXPECT_NE(seen.out.find(line), std::string::npos) << line << "\n" << seen.out;
}

TEST(CliDescribe, TheManPageHasEveryCommandAndIsCleanRoff) {
    const TemporaryFolder folder;
    const std::string page = described("man");
    EXPECT_EQ(page.rfind(".TH CAROM 1 ", 0), 0u);
    for (const char* text :
         {".SS \"carom simulate SCENE [RECORD] [options]\"", ".SS \"carom accuracy SCENE [options]\"",
          "\\fB\\-o, \\-\\-output\\fR \\fIPATTERN\\fR", "\\-\\-vary KEY=DISTRIBUTION",
          "One of top, rail, player, follow."})
        EXPECT_NE(page.find(text), std::string::npos) << text;
    folder.write("carom.1", page);
    if (run_process({"groff", "--version"}).status != 0) GTEST_SKIP() << "groff is not installed";
    const ProcessResult result =
        shell("bash", "groff -man -ww -z -Tascii carom.1 2>&1", folder.path().string());
    EXPECT_EQ(result.out, "");
}

TEST(Formats, TheCommandLinePageMatchesTheOptions) {
    const std::string page = described("command-line");
    EXPECT_TRUE(read_source("docs/reference/command_line.md") == page)
        << "docs/reference/command_line.md is stale; run tools/renew_formats.py";
    for (const char* text :
         {"\n## carom sweep\n", "\n`carom sweep SCENE --vary KEY=DISTRIBUTION --output FILE.csv`\n",
          "* `--jobs N`: Threads that encode and write, 0 for one per core (default: 0); 0 to 256\n",
          "; one of `top`, `rail`, `player`, `follow`\n", "143 terminated"})
        EXPECT_NE(page.find(text), std::string::npos) << text;
}

TEST(CliDescribe, MeasuresAndEventsAreListedWithTheirUnits) {
    const std::string measures = carom({"describe", "measures"}).out,
                      events = carom({"describe", "events"}).out;
    EXPECT_NE(measures.find("  travel(BALL)            m      "), std::string::npos) << measures;
    EXPECT_NE(events.find("  impulse       N s    "), std::string::npos) << events;
}

}  // namespace
}  // namespace carom::test
