// Every command that README.md, CONTRIBUTING.md and docs/ print works as printed, and prints what they say.
//
// A ```sh block runs as it is, in a folder like a clone after its build; the blocks of one page run in order
// in one folder. The lines of a ```text block right after it must appear in the output, in this order; "..."
// stands for any lines. Two comments before a block change that:
//   <!-- not run by the tests: WHY -->
//   <!-- run by the tests where this succeeds: COMMAND --> Such a command tests for a package of kConditions;
//   if that is installed, the block must run. A page with a block that did not run is skipped, with the
//   reason, after all others have run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "cli.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;

struct Block {
    std::size_t line = 0;  ///< of its fence, from 1
    std::string language, text, comment;
};

bool starts_with(const std::string& text, const std::string& start) {
    return text.compare(0, start.size(), start) == 0;
}

/// Whether a line is a comment with the source of a number.
bool is_checked_number(const std::string& line) {
    return starts_with(line, "<!-- figure: ") || starts_with(line, "<!-- constant: ");
}

std::vector<Block> blocks_of(const std::string& page) {
    std::vector<Block> blocks;
    bool inside = false;
    std::string comment;
    const std::vector<std::string> lines = lines_of(page);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string& line = lines[i];
        if (starts_with(line, "```")) {
            if (!inside) blocks.push_back({i + 1, line.substr(3), "", comment});
            inside = !inside;
            comment.clear();
        } else if (inside) {
            blocks.back().text += line + '\n';
        } else if (starts_with(line, "<!-- ") && !is_checked_number(line)) {
            comment = line;
        } else if (!line.empty()) {
            comment.clear();
        }
    }
    EXPECT_FALSE(inside) << "a fence is not closed";
    return blocks;
}

/// The text of a comment after `start`, or "".
std::string comment_value(const std::string& comment, const std::string& start) {
    const std::string whole = "<!-- " + start + ": ";
    const std::size_t end = comment.rfind(" -->");
    if (!starts_with(comment, whole) || end == comment.npos || end <= whole.size()) return "";
    return comment.substr(whole.size(), end - whole.size());
}

/// The first line of `expected` that does not appear in order in `output`, or "".
std::string missing_line(const std::string& expected, const std::string& output) {
    const std::vector<std::string> got = lines_of(output);
    std::size_t at = 0;
    for (const std::string& line : lines_of(expected)) {
        if (line == "...") continue;
        while (at < got.size() && got[at] != line) ++at;
        if (at == got.size()) return line.empty() ? "(an empty line)" : line;
        ++at;
    }
    return "";
}

/// A folder like a clone after its build, so that nothing is written into the real one.
class Clone {
  public:
    Clone() {
        for (const auto& entry : fs::directory_iterator(CAROM_SOURCE_DIR)) {
            const std::string name = entry.path().filename().string();
            if (name == "build" || name == "out" || name == ".git") continue;
            fs::create_symlink(entry.path(), folder_.path() / name);
        }
        fs::create_directory(folder_.path() / "build");
        fs::create_directory(folder_.path() / "home");
        fs::create_directory_symlink(CAROM_BUILD_DIR, folder_.path() / "build/release");
    }

    ProcessResult run(const std::string& script) const {
        ProcessOptions options;
        options.folder = folder_.path().string();
        options.environment = {{"CAROM_ISA", ""}, {"HOME", folder_.file("home")}};
        // The system's own tools first: another Python without packages might precede them.
        options.environment.emplace_back("PATH", std::string("/usr/bin:/bin:") + std::getenv("PATH"));
        return run_process({"/bin/bash", "-euo", "pipefail", "-c", script}, options);
    }

  private:
    TemporaryFolder folder_;
};

std::vector<std::string> pages() {
    std::vector<std::string> names = {"README.md", "CONTRIBUTING.md"};
    for (const char* folder : {"/docs", "/lab"})
        for (const auto& entry : fs::recursive_directory_iterator(CAROM_SOURCE_DIR + std::string(folder)))
            if (entry.path().extension() == ".md")
                names.push_back(fs::relative(entry.path(), CAROM_SOURCE_DIR).string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string read_page(const std::string& name) {
    return read_file(std::string(CAROM_SOURCE_DIR "/") + name);
}

// Programs that a machine may lack, and their Debian packages: without the package, the command fails.
const std::map<std::string, std::string> kConditions = {
    {"python3 -c 'import numpy'", "python3-numpy"},
    {"python3 -c 'import matplotlib'", "python3-matplotlib"},
    {"ffmpeg -version && ffmpeg -encoders | grep libwebp_anim", "ffmpeg"},
};

/// Why a block does not run here, or "" if it does. A comment that only resembles a reason is a failure.
std::string reason_not_to_run(const Clone& clone, const std::string& condition) {
    if (condition.empty()) return "";
    const auto known = kConditions.find(condition);
    if (known == kConditions.end()) {
        ADD_FAILURE() << condition << ": no package is known to make it succeed; add one to kConditions";
        return "";
    }
    const ProcessResult result = clone.run(condition);
    if (result.status == 0) return "";
    const std::string& package = known->second;
    const bool installed = clone.run("dpkg-query -W -f='${db:Status-Status}' " + package).out == "installed";
    EXPECT_FALSE(installed) << package << " is installed, and still fails: " << condition << "\n"
                            << result.err;
    return package + " is not installed";
}

/// A paragraph of a page with the comments before it that state the sources of its numbers:
///     <!-- figure: TEXT ; COMMAND -->         COMMAND prints TEXT
///     <!-- constant: TEXT ; NAME FILE -->     TEXT begins with the value of NAME in FILE
struct Paragraph {
    std::vector<std::string> comments;
    std::string text;
    bool sentences = true;  ///< neither a heading, a table nor code
};

std::vector<Paragraph> paragraphs_of(const std::string& page) {
    std::vector<Paragraph> all(1);
    const auto begin = [&all] {
        if (!all.back().text.empty()) all.emplace_back();
    };
    bool fenced = false;
    for (const std::string& line : lines_of(page)) {
        const bool fence = starts_with(line, "```"), code = fence || fenced;
        fenced = fenced != fence;
        if (!code && (line.empty() || starts_with(line, "<!-- "))) {
            begin();
            if (is_checked_number(line)) all.back().comments.push_back(line);
            continue;
        }
        const bool sentences = !code && line.find_first_of("#|") != 0;
        if (all.back().sentences != sentences) begin();
        all.back().sentences = sentences;
        all.back().text += line + " ";
    }
    return all;
}

/// The value of a constant in a source, NaN if there is none.
double constant_of(const std::string& name, const std::string& file) {
    const std::string source = read_file(std::string(CAROM_SOURCE_DIR "/") + file);
    std::smatch value;
    const bool found = std::regex_search(source, value, std::regex("\\b" + name + " = ([0-9.e+-]+)[;,]"));
    return found ? std::stod(value.str(1)) : std::nan("");
}

/// The wrong figures of a page. @param run  returns a command's output
std::vector<std::string> figure_faults(const std::string& page,
                                       const std::function<std::string(const std::string&)>& run) {
    std::vector<std::string> faults;
    for (const Paragraph& paragraph : paragraphs_of(page))
        for (const std::string& comment : paragraph.comments) {
            const std::string figure = comment_value(comment, "figure"),
                              value = figure.empty() ? comment_value(comment, "constant") : figure;
            const std::size_t semicolon = value.find(" ; ");
            const std::string text = value.substr(0, semicolon);
            if (semicolon == value.npos) {
                faults.push_back(comment + ": expected <!-- figure: TEXT ; COMMAND -->");
                continue;
            }
            const std::string source = value.substr(semicolon + 3);
            if (!contains(paragraph.text, text)) {
                faults.push_back(text + " does not stand in the paragraph behind its comment");
            } else if (!figure.empty() && !contains(run(source), text)) {
                faults.push_back(text + " is not what the command prints: " + source);
            } else if (figure.empty()) {
                const std::size_t space = source.find(' ');
                if (std::stod(text) != constant_of(source.substr(0, space), source.substr(space + 1)))
                    faults.push_back(text + " is not the constant " + source);
            }
        }
    return faults;
}

/// Matches of `claim` in a page's sentences that no comment of their paragraph mentions. Headings, tables,
/// code and link targets do not count.
std::vector<std::string> unchecked(const std::string& page, const std::regex& claim) {
    static const std::regex left_out("`[^`]*`|\\]\\([^)]*\\)");
    std::vector<std::string> found;
    for (const Paragraph& paragraph : paragraphs_of(page)) {
        if (!paragraph.sentences) continue;
        std::string said;
        for (const std::string& comment : paragraph.comments) said += comment;
        const std::string text = std::regex_replace(paragraph.text, left_out, "");
        for (std::sregex_iterator it(text.begin(), text.end(), claim), end; it != end; ++it)
            if (!contains(said, it->str().substr(0, it->str().find_last_not_of('.') + 1)))
                found.push_back(it->str() + " in: " + text);
    }
    return found;
}

std::vector<std::string> unchecked_numbers(const std::string& page) {
    static const std::regex number("[0-9][0-9.]*(e-?[0-9]+)?");
    return unchecked(page, number);
}

/// Shares and counts stated in sentences: "four of five", "81 %", "6 scripts".
std::vector<std::string> unchecked_promises(const std::string& page) {
    static const std::string number =
        "(one|two|three|four|five|six|seven|eight|nine|ten|eleven|twelve|[0-9][0-9.]*)";
    static const std::regex promise("\\b" + number + " (of|in) " + number + "\\b|[0-9][0-9.]* %|\\b" +
                                        number + " (lessons|scripts|presets|games|environments)\\b",
                                    std::regex::icase);
    return unchecked(page, promise);
}

TEST(Figures, AFalseOneIsDetected) {
    const auto run = [](const std::string& command) { return command == "c" ? "gain 2.02" : "nothing"; };
    EXPECT_EQ(figure_faults("<!-- figure: 2.02 ; c -->\n\nA gain of 2.02\nis small.\n", run).size(), 0u);
    EXPECT_EQ(figure_faults("<!-- figure: 2.02 ; c -->\nA gain of 2.03.\n\n2.02\n", run).size(), 1u);
    EXPECT_EQ(figure_faults("<!-- figure: 2.03 ; c -->\nA gain of 2.03.\n", run).size(), 1u);
    EXPECT_EQ(figure_faults("<!-- figure: 2.03 -->\nA gain of 2.03.\n", run).size(), 1u);
    const auto constant = [&](const std::string& text) {
        return figure_faults("<!-- constant: " + text +
                                 " ; kEventCap engine/include/carom/engine/tolerances.h -->\n" + text +
                                 " is the limit.\n",
                             run);
    };
    EXPECT_EQ(constant("10000 events").size(), 0u);
    EXPECT_EQ(constant("1000 events").size(), 1u);
    EXPECT_EQ(
        unchecked_numbers("# 3\n\nNone.\n\n```\n7\n```\n\n<!-- figure: 2 s ; c -->\n`x 9` 2 s.\n").size(),
        0u);
    EXPECT_EQ(unchecked_numbers("<!-- figure: 2 s ; c -->\nIn 2 s, 3 balls.\n").size(), 1u);
    EXPECT_EQ(unchecked_promises("It pots four of five.\n\nFive lessons, in `81 %`, within 3 s.\n").size(),
              2u);
    EXPECT_EQ(unchecked_promises("<!-- figure: 81 % ; c -->\nIt pots 81 %, not 82 %.\n").size(), 1u);
    // A sentence directly below another element also counts.
    for (const char* above : {"```\n81 %\n```", "```sh\na\n\n# 81 %\n```", "# Title", "| 81 % |", "- 3 s"})
        EXPECT_EQ(unchecked_promises(above + std::string("\nIt pots four of five.\n")).size(), 1u) << above;
}

TEST(Figures, EveryShareAndCountInAGuideHasItsSource) {
    for (const std::string& name : pages())
        if (name == "README.md" || starts_with(name, "docs/guide/"))
            for (const std::string& text : unchecked_promises(read_page(name)))
                ADD_FAILURE() << name << ": " << text;
}

TEST(Figures, EveryNumberOfTheHardCasesHasItsSource) {
    for (const std::string& number : unchecked_numbers(read_page("docs/design/hard_cases.md")))
        ADD_FAILURE() << number;
}

class Docs : public testing::TestWithParam<std::string> {};

TEST_P(Docs, FiguresMatchTheProgramsOutput) {
    const Clone clone;
    for (const std::string& fault :
         figure_faults(read_page(GetParam()), [&clone](const std::string& command) {
             const ProcessResult result = clone.run(command);
             EXPECT_EQ(result.status, 0) << command << "\n" << result.err;
             return result.out;
         }))
        ADD_FAILURE() << fault;
}

TEST_P(Docs, CommandsWorkAsPrinted) {
    const std::vector<Block> blocks = blocks_of(read_page(GetParam()));
    const Clone clone;
    std::string not_run;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const Block& block = blocks[i];
        if (block.language != "sh") continue;
        if (!comment_value(block.comment, "not run by the tests").empty()) continue;
        const std::string condition = comment_value(block.comment, "run by the tests where this succeeds");
        EXPECT_TRUE(block.comment.empty() || !condition.empty()) << "unknown comment " << block.comment;
        const std::string reason = reason_not_to_run(clone, condition);
        if (!reason.empty()) {
            not_run += GetParam() + ":" + std::to_string(block.line) + " was not run: " + reason + "\n";
            continue;
        }
        const ProcessResult result = clone.run(block.text);
        ASSERT_EQ(result.status, 0) << GetParam() << ":" << block.line << "\n" << block.text << result.err;
        EXPECT_NE(result.out, "") << GetParam() << ":" << block.line << ": says nothing";
        if (i + 1 < blocks.size() && blocks[i + 1].language == "text") {
            const std::string missing = missing_line(blocks[i + 1].text, result.out);
            EXPECT_EQ(missing, "") << GetParam() << ":" << blocks[i + 1].line << ": not in the output:\n"
                                   << result.out;
        }
    }
    if (!not_run.empty()) GTEST_SKIP() << not_run;
}

// A command with a file belongs in a block, where it runs; a mention may only name existing options.
TEST_P(Docs, MentionsOfTheProgramAreCorrect) {
    static std::map<std::string, std::string> helps;
    const std::regex span("`(?:build/release/)?carom ([a-z]+)([^`]*)`"), option("--[a-z][a-z-]*");
    const std::string page = read_page(GetParam());
    for (std::sregex_iterator it(page.begin(), page.end(), span), end; it != end; ++it) {
        const std::string whole = it->str(0), command = it->str(1), rest = it->str(2);
        EXPECT_EQ(rest.find(".toml"), rest.npos) << whole << " is not run: make it a ```sh block";
        // "bench kernel": both have options.
        std::smatch word;
        const std::string inner = std::regex_search(rest, word, std::regex("^ ([a-z]+)")) ? word.str(1) : "";
        const std::string key = command + " " + inner;
        if (helps.count(key) == 0) {
            helps[key] = carom({command, "--help"}).out;
            EXPECT_NE(helps[key], "") << whole << ": there is no such command";
            if (!inner.empty()) helps[key] += carom({command, inner, "--help"}).out;
        }
        const std::string& help = helps[key];
        for (std::sregex_iterator o(rest.begin(), rest.end(), option), none; o != none; ++o)
            EXPECT_NE(help.find(o->str()), help.npos) << whole << ": there is no option " << o->str();
    }
}

INSTANTIATE_TEST_SUITE_P(Pages, Docs, testing::ValuesIn(pages()), [](const auto& page) {
    std::string name = page.param;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
});

TEST(DocsReader, FindsBlocksCommentsAndMissingLines) {
    const auto blocks =
        blocks_of("<!-- not run by the tests: slow -->\n\n```sh\na\nb\n```\n```text\nx\n```\n");
    ASSERT_EQ(blocks.size(), 2u);
    EXPECT_EQ(blocks[0].text, "a\nb\n");
    EXPECT_EQ(comment_value(blocks[0].comment, "not run by the tests"), "slow");
    EXPECT_EQ(blocks[1].comment, "");
    EXPECT_EQ(comment_value("<!-- not run by the tests:  -->", "not run by the tests"), "");
    EXPECT_EQ(missing_line("a\n...\nc\n", "a\nb\nc\n"), "");
    EXPECT_EQ(missing_line("c\na\n", "a\nb\nc\n"), "a");
}

TEST(Readme, PrintsCommandsAndNamesEveryFolder) {
    std::size_t commands = 0;
    for (const Block& block : blocks_of(read_page("README.md"))) commands += block.language == "sh" ? 1 : 0;
    EXPECT_GE(commands, 2u);
    const std::string readme = read_page("README.md");
    for (const auto& entry : fs::directory_iterator(CAROM_SOURCE_DIR)) {
        const std::string folder = entry.path().filename().string();
        if (!entry.is_directory() || folder[0] == '.' || folder == "build" || folder == "out") continue;
        if (folder == "frames") continue;  // left by a reader who tried README.md
        EXPECT_NE(readme.find("`" + folder + "/`"), std::string::npos) << folder;
    }
}

}  // namespace
}  // namespace carom::test
