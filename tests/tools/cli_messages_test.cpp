// Command lines that the program refuses, and their messages: rows of tests/data/messages (a file per
// command). Each row must produce this status and this message alone, no output, and no new or changed file.
#include <gtest/gtest.h>

#include <toml++/toml.h>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "cli.h"
#include "support/files.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;

/// Words between spaces; '...' keeps its spaces.
std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    bool quoted = false, begun = false;
    for (const char c : line + " ") {
        if (c == '\'') quoted = !quoted;
        if (c == ' ' && !quoted) {
            begun = false;
            continue;
        }
        if (!begun) words.emplace_back();
        begun = true;
        if (c != '\'') words.back() += c;
    }
    return words;
}

/// A folder with a scene, its record, half of that record, a scene that stops with an error, one whose balls
/// overlap, the repository's scenes, and a substitute for ffmpeg; plus the table's own files.
class Folder {
  public:
    explicit Folder(const toml::table& table) {
        folder_.write("s.toml", kSmallScene);
        folder_.write("stuck.toml", kStuckScene);
        folder_.write("overlap.toml",
                      "[[ball]]\nid = \"cue\"\nposition = [0.5, 0.5]\n"
                      "[[ball]]\nid = \"1\"\nposition = [0.5, 0.55]\n");
        fs::create_directory_symlink(CAROM_SOURCE_DIR "/scenes", folder_.path() / "scenes");
        fs::create_directory(folder_.path() / "bin");
        fs::permissions(folder_.write("bin/ffmpeg", "#!/bin/sh\nexec cat > /dev/null\n"),
                        fs::perms::owner_all);
        if (const toml::table* files = table["files"].as_table())
            for (const auto& [name, text] : *files)
                folder_.write(std::string(name.str()), text.value_or(std::string()));
        EXPECT_EQ(run("simulate s.toml -o r.json").status, 0);
        const std::string record = read_file(folder_.file("r.json"));
        folder_.write("torn.json", record.substr(0, record.size() / 2));
    }

    ProcessResult run(const std::string& line) const {
        ProcessOptions options;
        options.folder = folder_.path().string();
        options.environment = {{"PATH", folder_.file("bin") + ":" + std::getenv("PATH")}};
        return carom(words_of(line), options);
    }

    std::string contents() const {
        std::string all;
        for (const std::string& file : folder_.names()) all += file + "\n";
        for (const char* name : {"s.toml", "r.json"}) all += read_file(folder_.file(name));
        return all;
    }

  private:
    TemporaryFolder folder_;
};

class CliMessages : public testing::TestWithParam<std::string> {};

TEST_P(CliMessages, MatchTheTableWithoutOtherEffects) {
    const toml::table table = toml::parse_file(CAROM_TEST_DATA "/messages/" + GetParam() + ".toml");
    const Folder folder(table);
    const std::string before = folder.contents();
    int rows = 0;
    for (const auto& [key, status] : {std::pair("refused", 2), {"failed", 1}}) {
        const toml::array* list = table[key].as_array();
        for (std::size_t i = 0; list != nullptr && i < list->size(); ++i, ++rows) {
            const std::string line = table[key][i][0].value<std::string>().value(),
                              says = table[key][i][1].value<std::string>().value();
            const ProcessResult result = folder.run(line);
            if (contains(result.err, "no diagrams")) continue;  // this build has no cairo
            EXPECT_EQ(result.status, status) << line << "\n" << result.err;
            EXPECT_EQ(result.out, "") << line;
            EXPECT_TRUE(matches("carom: " + says + "\n", result.err)) << line << "\n" << result.err;
            EXPECT_EQ(folder.contents(), before) << line;
        }
    }
    EXPECT_GE(rows, 2);
}

std::vector<std::string> commands() {
    std::vector<std::string> names;
    for (const fs::path& path : toml_files(CAROM_TEST_DATA "/messages"))
        names.push_back(path.stem().string());
    return names;
}

INSTANTIATE_TEST_SUITE_P(Of, CliMessages, testing::ValuesIn(commands()),
                         [](const auto& name) { return name.param; });

// The engine's message about a scene (scene_rules_test tests each), with the path as given.
TEST(CliScene, ABadSceneIsRefusedWithTheEnginesMessage) {
    const std::string path = CAROM_TEST_DATA "/bad_scenes/miscue.toml", text = read_file(path);
    const ProcessResult result = carom({"check", path});
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "carom: " CAROM_TEST_DATA "/bad_scenes/" + text.substr(2, text.find('\n') - 1));
}

}  // namespace
}  // namespace carom::test
