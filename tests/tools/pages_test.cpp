// The documents are consistent: links lead somewhere, guide pages are short and state their purpose, lab
// notes state their sources, and everything can be read in an afternoon.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/pages.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;
using Pages = std::map<std::string, std::string>;  // path from the top folder, text

/// The pages of a folder, in the order of their names.
Pages pages_of(const std::string& folder) {
    Pages pages;
    for (const auto& entry : fs::recursive_directory_iterator(CAROM_SOURCE_DIR "/" + folder)) {
        if (entry.path().extension() != ".md") continue;
        const std::string name = fs::relative(entry.path(), CAROM_SOURCE_DIR).string();
        pages[name] = read_source(name);
    }
    return pages;
}

Pages all_pages() {
    Pages pages = pages_of("docs");
    pages.merge(pages_of("lab"));
    for (const char* name : {"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md",
                             ".github/CODE_OF_CONDUCT.md", "tests/README.md"})
        pages[name] = read_source(name);
    return pages;
}

/// The page without fenced text, where "](" is code.
std::string prose(const std::string& page) {
    std::istringstream in(page);
    std::string text;
    bool code = false;
    for (std::string line; std::getline(in, line);) {
        const bool fence = line.rfind("```", 0) == 0;
        if (fence) code = !code;
        if (!fence && !code) text += line + '\n';
    }
    return text;
}

std::vector<std::string> links_of(const std::string& page) {
    static const std::regex link(R"(\]\(([^)\s]+)\))");
    const std::string text = prose(page);
    std::vector<std::string> found;
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it)
        found.push_back(it->str(1));
    return found;
}

/// The anchors of the headings, made as on GitHub and the site: lower case, dashes for spaces, no
/// punctuation.
std::set<std::string> anchors_of(const std::string& page) {
    std::set<std::string> anchors;
    std::istringstream in(prose(page));
    for (std::string line; std::getline(in, line);) {
        if (line.rfind('#', 0) != 0) continue;
        std::string anchor;
        for (const char c : line.substr(line.find_first_not_of("# "))) {
            if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_')
                anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            else if (c == ' ')
                anchor += '-';
        }
        anchors.insert(anchor);
    }
    return anchors;
}

/// The dead links of a page. `exists` checks files and folders by their paths from the top folder.
std::vector<std::string> dead_links(const Pages& pages, const std::string& name,
                                    const std::function<bool(const std::string&)>& exists) {
    std::vector<std::string> dead;
    for (const std::string& link : links_of(pages.at(name))) {
        if (link.find("://") != link.npos || link.rfind("mailto:", 0) == 0) continue;
        const std::size_t hash = link.find('#');
        const std::string file = link.substr(0, hash);
        const std::string path =
            file.empty() ? name : (fs::path(name).parent_path() / file).lexically_normal().string();
        const bool there = pages.count(path) != 0 || exists(path);
        if (!there) dead.push_back(name + ": " + link + ": there is no such file");
        if (!there || hash == link.npos) continue;
        const auto page = pages.find(path);
        if (page == pages.end() || anchors_of(page->second).count(link.substr(hash + 1)) == 0)
            dead.push_back(name + ": " + link + ": there is no such heading");
    }
    return dead;
}

std::size_t words_of(const std::string& page) {
    static const std::regex comment("<!-- [^\n]*-->");
    std::istringstream in(std::regex_replace(page, comment, ""));
    std::size_t words = 0;
    for (std::string word; in >> word;)
        words += std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
    return words;
}

TEST(Pages, EveryLinkLeadsToAFileAndAHeading) {
    const Pages pages = all_pages();
    std::size_t links = 0;
    const auto exists = [](const std::string& path) { return fs::exists(fs::path(CAROM_SOURCE_DIR) / path); };
    for (const auto& [name, text] : pages) {
        links += links_of(text).size();
        for (const std::string& fault : dead_links(pages, name, exists)) ADD_FAILURE() << fault;
    }
    EXPECT_GE(links, 100u);
}

TEST(Pages, DeadLinksAreDetected) {
    const Pages pages = {{"docs/a.md",
                          "# A b, c\n[x](b.md) [x](#a-b-c) [x](../README.md) [x](https://no.where)\n"
                          "```\n[x](code.md)\n```\n"},
                         {"docs/b.md", "[x](a.md#a-b-c) [x](a.md#d) [x](#e) [x](c.md)\n"},
                         {"README.md", "[x](docs/a.md#a) [x](docs/) [x](tools/run)\n"}};
    const auto exists = [](const std::string& path) { return path == "docs/"; };
    EXPECT_EQ(dead_links(pages, "docs/a.md", exists), std::vector<std::string>{});
    EXPECT_EQ(dead_links(pages, "docs/b.md", exists),
              (std::vector<std::string>{"docs/b.md: a.md#d: there is no such heading",
                                        "docs/b.md: #e: there is no such heading",
                                        "docs/b.md: c.md: there is no such file"}));
    EXPECT_EQ(dead_links(pages, "README.md", exists),
              (std::vector<std::string>{"README.md: docs/a.md#a: there is no such heading",
                                        "README.md: tools/run: there is no such file"}));
}

TEST(Pages, TheIndexNamesEveryPage) {
    for (const std::string folder : {"docs", "lab"}) {
        const std::vector<std::string> links = links_of(read_source(folder + "/README.md"));
        for (const auto& [name, text] : pages_of(folder)) {
            const std::string path = name.substr(folder.size() + 1);
            if (path == "README.md") continue;
            EXPECT_NE(std::find(links.begin(), links.end(), path), links.end())
                << folder << "/README.md has no link to " << path;
        }
    }
}

// A file or folder is named by the end of its path.
TEST(Pages, ArchitectureNamesWhatExists) {
    std::set<std::string> ends;
    for (const char* top : {"kernel", "engine", "games", "interface", "render", "capi", "python", "tools",
                            "web", "tests", "lab", "examples"})
        for (const auto& entry : fs::recursive_directory_iterator(CAROM_SOURCE_DIR "/" + std::string(top))) {
            std::string path = "/" + fs::relative(entry.path(), CAROM_SOURCE_DIR).generic_string();
            for (std::size_t at = 0; at != path.npos; at = path.find('/', at + 1))
                ends.insert(path.substr(at + 1));
            if (entry.path().parent_path() == fs::path(CAROM_SOURCE_DIR "/") / top) ends.insert(top);
        }
    const std::string page = read_source("docs/design/architecture.md");
    const std::regex name("`([a-z0-9_/]+(/|\\.(h|cpp|js|cmake)))`");
    std::size_t names = 0;
    for (std::sregex_iterator it(page.begin(), page.end(), name), end; it != end; ++it, ++names) {
        std::string wanted = (*it)[1];
        if (wanted.back() == '/') wanted.pop_back();
        EXPECT_TRUE(ends.count(wanted) > 0) << "there is no " << wanted;
    }
    EXPECT_GE(names, 40u);
}

TEST(Pages, GuidePagesAreShortAndBeginWithTheirPurpose) {
    const Pages guide = pages_of("docs/guide");
    EXPECT_GE(guide.size(), 7u);
    for (const auto& [name, text] : guide) {
        EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 150) << name;
        EXPECT_TRUE(std::regex_search(text, std::regex("^# [^\n]+\n\nAt the end of this page ")))
            << name << " does not begin with a title and \"At the end of this page ...\"";
    }
}

TEST(Pages, LabNotesStateDateMachineAndCommit) {
    const Pages notes = pages_of("lab/notes");
    EXPECT_GE(notes.size(), 12u);
    for (const auto& [name, text] : notes) {
        EXPECT_TRUE(std::regex_search(name, std::regex("/20[0-9]{2}-[0-9]{2}-[a-z_]+\\.md$")))
            << name << ": a note is called YEAR-MONTH-subject.md";
        for (const char* row : {"\n| measured | 20", "\n| machine | ", "\n| commit | ", "\n| today | ["})
            EXPECT_NE(text.find(row), text.npos) << name << " has no row " << row + 1;
    }
}

// An option that no page, example or script names has no user.
TEST(Pages, EveryOptionStandsInAPageOrAScript) {
    std::string text;
    Pages pages = pages_of("docs/guide");
    pages.merge(pages_of("docs/design"));
    pages["README.md"] = read_source("README.md");
    for (const auto& [name, page] : pages) text += page;
    for (const char* folder : {"examples", "scenes", "tools", "lab", "packaging"})
        for (const auto& entry : fs::recursive_directory_iterator(CAROM_SOURCE_DIR "/" + std::string(folder)))
            if (entry.is_regular_file() && entry.path().extension() != ".cpp")
                text += read_source(fs::relative(entry.path(), CAROM_SOURCE_DIR).string());
    const std::string list = read_source("docs/reference/command_line.md");
    const std::regex option(R"(--[a-z][a-z0-9-]*)");
    std::size_t options = 0;
    for (std::sregex_iterator it(list.begin(), list.end(), option), end; it != end; ++it, ++options)
        EXPECT_TRUE(std::regex_search(text, std::regex(it->str() + "(?![a-z0-9-])")))
            << it->str() << ": show it in docs/guide, or remove it";
    EXPECT_GT(options, 80u);
}

// A word contains a letter or a digit; table rules and comments do not count. The generated command line page
// does, but not the page of types, which grows with them.
TEST(Pages, GuideReferenceAndDesignCanBeReadInAnAfternoon) {
    EXPECT_EQ(words_of("| a | 1.5 m |\n|---|---|\n<!-- figure: 1.5 m ; c -->\n"), 3u);
    std::size_t words = 0;
    for (const char* folder : {"docs/guide", "docs/reference", "docs/design"})
        for (const auto& [name, text] : pages_of(folder))
            if (name != "docs/reference/types.md") words += words_of(text);
    EXPECT_LE(words, 27450u) << "cut, or move what was measured to a note in lab/notes";
}

}  // namespace
}  // namespace carom::test
