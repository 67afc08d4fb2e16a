// Shared by the tests of the command line.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "support/process.h"

namespace carom::test {

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// Runs a built program. The tests choose the instruction set, not the calling shell.
inline ProcessResult run_built(const char* program, std::vector<std::string> arguments,
                               ProcessOptions options) {
    arguments.insert(arguments.begin(), program);
    options.environment.insert(options.environment.begin(), {"CAROM_ISA", ""});
    return run_process(arguments, options);
}

inline ProcessResult carom(std::vector<std::string> arguments, ProcessOptions options = {}) {
    return run_built(CAROM_PROGRAM, std::move(arguments), std::move(options));
}

inline ProcessResult carom_isa(const std::string& isa, const std::vector<std::string>& arguments) {
    ProcessOptions options;
    options.environment = {{"CAROM_ISA", isa}};
    return carom(arguments, options);
}

/// A shot with ball-ball, cushion and pocket events that takes milliseconds.
inline constexpr char kSmallScene[] = R"(# a cut shot with side
[table]
preset = "nine_foot"
[[ball]]
id = "cue"
position = [0.635, 0.50]
[[ball]]
id = "1"
position = [0.66, 1.9]
[[ball]]
id = "ball 2"
position = [0.60, 2.1]
[cue]
ball = "cue"
speed = 4.0
aim_deg = 90.0
offset = [0.2, 0.1]
[render]
fps = 60
size = [320, 180]
)";

/// A valid scene whose one impact does not end: friction and spin lock the balls together, and the march
/// gives up.
inline constexpr char kStuckScene[] = R"([balls]
mu_s = 0.6
mu_b = 4.0
[physics]
substeps = 10
[[ball]]
id = "a"
position = [0.6, 1]
velocity = [0, 1]
spin = [-1e6, 0, 0]
[[ball]]
id = "b"
position = [0.6, 1.06]
[stop]
time = 1
)";

inline std::vector<std::string> shipped_scenes() {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(CAROM_SOURCE_DIR "/scenes"))
        files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

inline std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::size_t start = 0;
    for (std::size_t end; (end = text.find('\n', start)) != std::string::npos; start = end + 1) {
        lines.push_back(text.substr(start, end - start));
    }
    if (start < text.size()) lines.push_back(text.substr(start));
    return lines;
}

}  // namespace carom::test
