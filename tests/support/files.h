// Files of the tests, and patterns for expected messages.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace carom::test {

/// @throws std::runtime_error
inline std::string read_file(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + path.string());
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// `*` in the pattern matches any text.
inline bool matches(const std::string& pattern, const std::string& text, std::size_t p = 0,
                    std::size_t t = 0) {
    for (; p < pattern.size(); ++p, ++t) {
        if (pattern[p] == '*') {
            for (std::size_t rest = t; rest <= text.size(); ++rest) {
                if (matches(pattern, text, p + 1, rest)) return true;
            }
            return false;
        }
        if (t >= text.size() || pattern[p] != text[t]) return false;
    }
    return t == text.size();
}

inline std::vector<std::filesystem::path> toml_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".toml") out.push_back(entry.path());
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace carom::test
