// The commands printed in README.md work as printed.
#include <gtest/gtest.h>

#include "cli.h"

namespace carom::test {
namespace {

namespace fs = std::filesystem;

/// Lines of the ```sh blocks that run the program.
std::vector<std::string> readme_commands() {
    std::vector<std::string> commands;
    bool inside = false;
    for (const std::string& line : lines_of(read_file(CAROM_SOURCE_DIR "/README.md"))) {
        if (line.substr(0, 3) == "```")
            inside = line == "```sh";
        else if (inside && line.find("build/release/carom ") != std::string::npos)
            commands.push_back(line);
    }
    return commands;
}

TEST(Readme, EveryCommandWorksAsPrinted) {
    const std::vector<std::string> commands = readme_commands();
    ASSERT_GE(commands.size(), 5u);
    // A folder like a fresh clone after its build, so that nothing is written into the real one.
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "build/release");
    fs::create_symlink(CAROM_PROGRAM, folder.path() / "build/release/carom");
    fs::create_directory_symlink(fs::path(CAROM_SOURCE_DIR) / "scenes", folder.path() / "scenes");
    ProcessOptions options;
    options.folder = folder.path().string();
    for (const std::string& command : commands) {
        const ProcessResult result = run_process({"/bin/bash", "-euc", command}, options);
        EXPECT_EQ(result.status, 0) << command << "\n" << result.err;
        EXPECT_NE(result.out, "") << command;
    }
}

TEST(Readme, NamesEveryTopLevelFolder) {
    const std::string readme = read_file(CAROM_SOURCE_DIR "/README.md");
    for (const char* folder : {"kernel", "engine", "render", "tools", "scenes", "tests", "docs", "cmake"}) {
        if (!fs::exists(fs::path(CAROM_SOURCE_DIR) / folder)) continue;
        EXPECT_NE(readme.find("| `" + std::string(folder) + "/` |"), std::string::npos) << folder;
    }
}

}  // namespace
}  // namespace carom::test
