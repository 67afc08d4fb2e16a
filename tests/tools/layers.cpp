// The layers of the design as a check of what every file includes.
#include "layers.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <string_view>

namespace carom::test {
namespace {

namespace fs = std::filesystem;

/// From the bottom up: a layer may use itself and those in front of it.
constexpr std::array<std::string_view, 4> kLayers = {"kernel", "engine", "render", "tools"};
constexpr int kNoLayer = -1;
/// The C interface stands beside the renderer: it uses what the engine may use, and nobody uses it.
constexpr std::string_view kCInterface = "capi";
constexpr int kCInterfaceLayer = 1;

int layer_of(std::string_view name) {
    const auto it = std::find(kLayers.begin(), kLayers.end(), name);
    return it == kLayers.end() ? kNoLayer : static_cast<int>(it - kLayers.begin());
}

/// The layer that holds a file, or kNoLayer; `first` gets the top folder.
int layer_of_path(const fs::path& root, const fs::path& file, std::string& first) {
    const fs::path relative = fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(root));
    first = relative.empty() ? ".." : relative.begin()->string();
    return layer_of(first);
}

struct Include {
    std::string name;
    bool quoted = false;
    int line = 0;
};

/// The directive of one line, if it is an include: with any spacing, and #import and #include_next as well.
bool parse_include(std::string_view line, Include& include) {
    const auto skip_space = [&line] {
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    };
    skip_space();
    if (line.empty() || line.front() != '#') return false;
    line.remove_prefix(1);
    skip_space();
    bool directive = false;
    for (const std::string_view word : {"include_next", "include", "import"}) {
        if (!directive && line.substr(0, word.size()) == word) {
            line.remove_prefix(word.size());
            directive = true;
        }
    }
    if (!directive) return false;
    skip_space();
    include.quoted = !line.empty() && line.front() == '"';
    const char end = include.quoted ? '"' : '>';
    const std::size_t close = line.find(end, 1);
    const bool literal = !line.empty() && (line.front() == '"' || line.front() == '<') && close != line.npos;
    include.name = literal ? std::string(line.substr(1, close - 1)) : "";
    return true;
}

std::vector<Include> includes_of(const fs::path& file) {
    std::vector<Include> found;
    std::ifstream stream(file);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        Include include;
        if (!parse_include(line, include)) continue;
        include.line = number;
        found.push_back(include);
    }
    return found;
}

bool starts_with(std::string_view text, std::string_view start) {
    return text.substr(0, start.size()) == start;
}

/// Headers without a folder or an ending are the C++ standard library's; intrinsics belong to the compiler.
bool is_standard(std::string_view name) {
    return name.find_first_of("./") == name.npos || name == "immintrin.h" || name == "cpuid.h";
}

/// Libraries that only the layers from `lowest` up may use.
std::string library_violation(int layer, std::string_view name) {
    if (layer == 0 && !is_standard(name)) return "the kernel uses the C++ standard library only";
    struct Rule {
        std::string_view start;
        int lowest;
    };
    constexpr Rule kRules[] = {{"GL/", 2},  {"EGL/", 2},   {"png.h", 2},     {"libdeflate.h", 2},
                               {"CLI/", 3}, {"gtest/", 4}, {"benchmark/", 3}};
    for (const Rule& rule : kRules) {
        if (starts_with(name, rule.start) && layer < rule.lowest) return "this library is not for this layer";
    }
    return "";
}

std::string target_violation(const fs::path& root, int layer, const std::string& first) {
    const int target = layer_of(first);
    if (target != kNoLayer) return target > layer ? "points upwards to " + first : "";
    // What the tests and the benchmarks share may be used by the top layer.
    if (first == "tests" && layer == 3) return "";
    return "points outside the layers of " + fs::absolute(root).filename().string() + ": " + first;
}

std::string include_violation(const fs::path& root, const fs::path& file, int layer, const Include& include) {
    if (include.name.empty()) return "is not a literal name, so that its layer cannot be known";
    const fs::path beside = file.parent_path() / include.name;
    std::string first, own;
    layer_of_path(root, file, own);
    if (own == kCInterface) {
        layer_of_path(root, beside, first);
        if (include.quoted && fs::exists(beside) && first == own) return "";
        if (include.name == "carom/carom.h" || include.name == "carom/version.h") return "";
    }
    if (include.quoted && fs::exists(beside)) {
        layer_of_path(root, beside, first);
        return target_violation(root, layer, first);
    }
    if (starts_with(include.name, "carom/")) {
        const std::string_view rest = std::string_view(include.name).substr(6);
        return target_violation(root, layer, std::string(rest.substr(0, rest.find('/'))));
    }
    for (const std::string_view base : {"", "tests", "tools"}) {
        const fs::path candidate = root / base / include.name;
        if (!include.quoted || !fs::exists(candidate)) continue;
        layer_of_path(root, candidate, first);
        return target_violation(root, layer, first);
    }
    if (include.quoted) return "cannot be resolved";
    return library_violation(layer, include.name);
}

/// A target named in a CMakeLists.txt is an include path: carom::render in engine/ points upwards.
std::vector<std::string> cmake_violations(const fs::path& file, int layer) {
    std::vector<std::string> found;
    std::ifstream stream(file);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        line = line.substr(0, line.find('#'));
        for (int upper = layer + 1; upper < static_cast<int>(kLayers.size()); ++upper) {
            for (const std::string separator : {"::", "_"}) {
                const std::string target =
                    "carom" + separator + std::string(kLayers[static_cast<std::size_t>(upper)]);
                if (line.find(target) == line.npos) continue;
                found.push_back(file.string() + ":" + std::to_string(number) + ": links " + target);
            }
        }
    }
    return found;
}

bool is_source(const fs::path& file) {
    static const std::set<std::string> kEndings = {".h",   ".hpp", ".hh",  ".c",   ".cc",
                                                   ".cpp", ".cxx", ".inl", ".inc", ".ipp"};
    return kEndings.count(file.extension().string()) != 0;
}

}  // namespace

std::vector<std::string> layer_violations(const fs::path& root) {
    std::vector<std::string> found;
    std::vector<std::pair<std::string_view, int>> folders = {{kCInterface, kCInterfaceLayer}};
    for (std::size_t i = 0; i < kLayers.size(); ++i) folders.emplace_back(kLayers[i], static_cast<int>(i));
    for (const auto& [name, layer] : folders) {
        const fs::path folder = root / name;
        if (!fs::exists(folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            const fs::path& file = entry.path();
            if (file.filename() == "CMakeLists.txt") {
                const std::vector<std::string> more = cmake_violations(file, layer);
                found.insert(found.end(), more.begin(), more.end());
            }
            if (!entry.is_regular_file() || !is_source(file)) continue;
            for (const Include& include : includes_of(file)) {
                const std::string wrong = include_violation(root, file, layer, include);
                if (wrong.empty()) continue;
                found.push_back(file.string() + ":" + std::to_string(include.line) + ": include of " +
                                include.name + " " + wrong);
            }
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace carom::test
