// The design's layers, and the rooms inside them, as a check of every file's includes.
#include "layers.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

namespace carom::test {
namespace {

namespace fs = std::filesystem;

/// From the bottom up: a layer may use itself and those before it.
constexpr std::array<std::string_view, 7> kLayers = {"kernel", "engine", "games", "interface",
                                                     "render", "tools",  "lab"};
constexpr int kNoLayer = -1;
/// The C interface is beside the interface's types, which it may use; no layer uses it.
constexpr std::string_view kCInterface = "capi";
constexpr int kCInterfaceLayer = 3;
/// The Python package is beside the program: it may use the same layers, and no layer uses it.
constexpr std::string_view kPython = "python";
constexpr int kPythonLayer = 5;
/// So is carom.wasm, which uses the program's table outlines and verdict texts.
constexpr std::string_view kWeb = "web";
constexpr int kWebLayer = 5;
/// The laboratory may include anything, and nothing includes it, not even tests of the product or examples.
constexpr std::string_view kLab = "lab";
constexpr std::array<std::string_view, 2> kBesideTheProduct = {"tests", "examples"};

/// The rooms of one layer. A toolbox includes toolboxes to its left; a station, one step on the data's path,
/// includes toolboxes. Stations never include each other: they share only public types. Files in the folder
/// itself are left of all.
struct Rooms {
    std::string_view folder;
    std::vector<std::string_view> toolboxes, stations;
    /// Whether a file in the folder itself is right of all rooms, as a main() is.
    bool top_uses_rooms = false;
};
const std::array<Rooms, 5> kRooms = {{
    {"kernel/src", {"unlike"}, {"march", "tolerance", "contact_phase"}},
    {"engine/src", {"base", "physics", "contact"}, {"scene", "plan", "loop", "record", "batch"}},
    {"render/src", {"font", "gl"}, {"stage", "draw", "frames"}},
    // Inner rooms precede the rooms that contain them.
    {"tools/carom/commands",
     {},
     {"simulate", "render", "view", "export", "compare", "sweep", "check", "impact", "describe", "accuracy",
      "diagram", "judge", "play", "fit", "sensitivity", "solve", "margin"}},
    {"tools/carom", {"base", "page", "report"}, {"commands"}, true},
}};
/// Public headers about products or work of an engine station. No toolbox of the engine includes them.
constexpr std::array<std::string_view, 4> kHeadersOfStations = {
    "carom/engine/plan.h", "carom/engine/simulate.h", "carom/engine/variation.h", "carom/engine/verify.h"};
/// Folders that some others may use although they are not public headers.
struct Door {
    std::string_view from, to;
};
constexpr std::array<Door, 8> kDoors = {{{"web", "tools/carom/base"},
                                         {"web", "tools/carom/page"},
                                         {"tools", "kernel/reference"},
                                         {"games", "engine/src/base"},
                                         {"render", "engine/src/base"},
                                         {"tools", "engine/src/base"},
                                         {"python", "engine/src/base"},
                                         {"python", "tools/carom/page"}}};

int layer_of(std::string_view name) {
    const auto it = std::find(kLayers.begin(), kLayers.end(), name);
    return it == kLayers.end() ? kNoLayer : static_cast<int>(it - kLayers.begin());
}

/// A file's path below `root`, with slashes.
std::string path_below(const fs::path& root, const fs::path& file) {
    return fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(root)).generic_string();
}

std::string top_folder(const std::string& path) {
    return path.substr(0, path.find('/'));
}

struct Include {
    std::string name;
    bool quoted = false;
    int line = 0;
};

/// Parses one line as an include, with any spacing; also #import and #include_next.
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
    return name.find_first_of("./") == name.npos || name == "immintrin.h" || name == "cpuid.h" ||
           name == "wasm_simd128.h";
}

/// Libraries that only the layers from `lowest` up may use.
std::string library_violation(int layer, std::string_view name) {
    if (layer == 0 && !is_standard(name)) return "the kernel uses the C++ standard library only";
    struct Rule {
        std::string_view start;
        int lowest;
    };
    constexpr Rule kRules[] = {{"GL/", 4},  {"EGL/", 4},   {"png.h", 4},     {"zlib.h", 4},
                               {"CLI/", 5}, {"gtest/", 6}, {"benchmark/", 5}};
    for (const Rule& rule : kRules) {
        if (starts_with(name, rule.start) && layer < rule.lowest) return "this library is not for this layer";
    }
    return "";
}

bool is_within(std::string_view path, std::string_view folder) {
    return starts_with(path, folder) && (path.size() == folder.size() || path[folder.size()] == '/');
}

/// The folder whose files include each other: kernel/src, engine/src, tools/carom ...
std::string house_of(const std::string& path) {
    const std::size_t first = path.find('/'), second = path.find('/', first + 1);
    return path.substr(0, second == path.npos ? first : second);
}

/// Position of a room from the left: -1 for the folder itself, then toolboxes, then stations; -2 for an
/// unknown room.
int place_of(const Rooms& rooms, std::string_view path) {
    const std::string_view rest = path.substr(rooms.folder.size() + 1);
    const std::size_t slash = rest.find('/');
    if (slash == rest.npos) return -1;
    int place = 0;
    for (const auto* list : {&rooms.toolboxes, &rooms.stations})
        for (const std::string_view room : *list) {
            if (room == rest.substr(0, slash)) return place;
            ++place;
        }
    return -2;
}

/// `from` and `to` are in the folder of these rooms.
std::string room_violation(const Rooms& rooms, const std::string& from, const std::string& to) {
    const int here = place_of(rooms, from), there = place_of(rooms, to);
    if (here == -1 && rooms.top_uses_rooms) return "";
    if (here == -2) return "stands in a file of no known room";
    if (there == -2) return "points to no known room";
    if (here == there) return "";
    const int stations = static_cast<int>(rooms.toolboxes.size());
    if (there >= stations && here >= stations) return "points to another station; meet in public types";
    if (there >= here) return "points to a room on the right";
    return "";
}

std::string target_violation(const fs::path& root, const std::string& from, int layer,
                             const std::string& to) {
    const std::string first = top_folder(to);
    const int target = layer_of(first);
    if (layer == kNoLayer) return first == kLab ? "points into the laboratory" : "";
    if (top_folder(from) == kLab) return "";
    if (house_of(from) == house_of(to)) {
        for (const Rooms& rooms : kRooms)
            if (is_within(from, rooms.folder) && is_within(to, rooms.folder))
                return room_violation(rooms, from, to);
        return "";
    }
    // A door overrides the order of layers: Python uses the pages, which are among the tools.
    for (const Door& door : kDoors)
        if (is_within(from, door.from) && is_within(to, door.to)) return "";
    if (target > layer) return "points upwards to " + first;
    if (target == kNoLayer)
        return "points outside the layers of " + fs::absolute(root).filename().string() + ": " + first;
    return "points into " + house_of(to) + ", which is not public";
}

/// For an include that names a public header.
std::string public_violation(const fs::path& root, const std::string& from, int layer,
                             std::string_view name) {
    const std::string first(name.substr(6, name.find('/', 6) - 6));
    const int target = layer_of(first);
    if (layer == kNoLayer || top_folder(from) == kLab) return "";
    if (target > layer) return "points upwards to " + first;
    if (target == kNoLayer)
        return "points outside the layers of " + fs::absolute(root).filename().string() + ": " + first;
    for (const Rooms& rooms : kRooms) {
        if (rooms.folder != "engine/src" || !is_within(from, rooms.folder)) continue;
        const int place = place_of(rooms, from);
        if (place >= static_cast<int>(rooms.toolboxes.size())) continue;
        for (const std::string_view header : kHeadersOfStations)
            if (name == header) return "points from a toolbox to what a station makes";
    }
    return "";
}

/// The file that a quoted include names, below `root`: beside the file, then by room. Empty if not found.
std::string included_file(const fs::path& root, const fs::path& file, std::string_view name) {
    std::vector<fs::path> folders = {file.parent_path(), root / house_of(path_below(root, file))};
    for (const std::string_view base : {"", "kernel", "kernel/src", "engine/src", "render/src", "games/src",
                                        "tools/carom", "tools", "tests", "lab/carom", "lab"})
        folders.push_back(root / base);
    for (const fs::path& folder : folders)
        if (fs::exists(folder / name)) return path_below(root, folder / name);
    return "";
}

/// The C interface's header, which is in no folder with a layer's name.
constexpr std::string_view kCHeader = "carom/carom.h";

std::string include_violation(const fs::path& root, const fs::path& file, int layer, const Include& include) {
    if (include.name.empty()) return "is not a literal name, so that its layer cannot be known";
    const std::string from = path_below(root, file);
    if (layer == kNoLayer && !include.quoted) return "";
    if ((starts_with(from, kCInterface) || starts_with(from, kPython) || starts_with(from, kWeb)) &&
        (include.name == kCHeader || include.name == "carom/version.h"))
        return "";
    if (starts_with(include.name, "carom/")) return public_violation(root, from, layer, include.name);
    if (!include.quoted) return library_violation(layer, include.name);
    const std::string to = included_file(root, file, include.name);
    if (!to.empty()) return target_violation(root, from, layer, to);
    return layer == kNoLayer ? "" : "cannot be resolved";
}

/// The top folder that an include points to; empty for a library.
std::string included_folder(const fs::path& root, const fs::path& file, const Include& include) {
    if (include.name == kCHeader) return std::string(kCInterface);
    if (!starts_with(include.name, "carom/"))
        return include.quoted ? top_folder(included_file(root, file, include.name)) : "";
    const std::string first = top_folder(include.name.substr(6));
    return layer_of(first) == kNoLayer ? "" : first;
}

/// A target named in a CMakeLists.txt is an include path: carom::render in engine/ points upwards.
std::vector<std::string> cmake_violations(const fs::path& file, int layer) {
    std::vector<std::string> found;
    std::ifstream stream(file);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        line = line.substr(0, line.find('#'));
        const bool of_product = layer != kNoLayer && layer < layer_of(kLab);
        if (of_product && line.find("/tests") != line.npos)
            found.push_back(file.string() + ":" + std::to_string(number) + ": reads tests/");
        for (const char* target : {"carom::ladder", "carom_ladder"})
            if (of_product && line.find(target) != line.npos)
                found.push_back(file.string() + ":" + std::to_string(number) + ": links " + target);
        for (int upper = layer + 1; layer != kNoLayer && upper < static_cast<int>(kLayers.size()); ++upper) {
            for (const std::string separator : {"::", "_"}) {
                const std::string target = "carom" + separator + std::string(kLayers[upper]);
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

/// The folders of the product with their layers.
std::vector<std::pair<std::string_view, int>> product_folders() {
    std::vector<std::pair<std::string_view, int>> folders = {
        {kCInterface, kCInterfaceLayer}, {kPython, kPythonLayer}, {kWeb, kWebLayer}};
    for (std::size_t i = 0; i < kLayers.size(); ++i)
        if (kLayers[i] != kLab) folders.emplace_back(kLayers[i], static_cast<int>(i));
    return folders;
}

/// Calls seen(file) for every file in a folder below `root`.
template <typename Seen>
void for_each_file(const fs::path& root, std::string_view folder, const Seen& seen) {
    if (!fs::exists(root / folder)) return;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
        if (entry.is_regular_file()) seen(entry.path());
}

}  // namespace

std::vector<std::string> layer_violations(const fs::path& root) {
    std::vector<std::string> found;
    std::vector<std::pair<std::string_view, int>> folders = product_folders();
    folders.emplace_back(kLab, layer_of(kLab));
    for (const std::string_view name : kBesideTheProduct) folders.emplace_back(name, kNoLayer);
    for (const auto& [name, layer] : folders)
        for_each_file(root, name, [&, at = layer](const fs::path& file) {
            if (file.filename() == "CMakeLists.txt") {
                const std::vector<std::string> more = cmake_violations(file, at);
                found.insert(found.end(), more.begin(), more.end());
            }
            if (!is_source(file)) return;
            for (const Include& include : includes_of(file)) {
                const std::string wrong = include_violation(root, file, at, include);
                if (wrong.empty()) continue;
                found.push_back(file.string() + ":" + std::to_string(include.line) + ": include of " +
                                include.name + " " + wrong);
            }
        });
    std::sort(found.begin(), found.end());
    return found;
}

std::set<std::string> layer_arrows(const fs::path& root) {
    std::set<std::string> arrows;
    for (const auto& [name, layer] : product_folders())
        for_each_file(root, name, [&, from = std::string(name)](const fs::path& file) {
            if (!is_source(file)) return;
            for (const Include& include : includes_of(file)) {
                const std::string to = included_folder(root, file, include);
                if (!to.empty() && to != from) arrows.insert(from + " -> " + to);
            }
        });
    return arrows;
}

std::set<std::string> described_arrows(std::string_view page) {
    std::set<std::string> names, arrows;
    for (const auto& [name, layer] : product_folders()) names.insert(std::string(name));
    const std::size_t start = std::min(page.find("## Layers"), page.size());
    std::istringstream lines(std::string(page.substr(start, page.find("\n## ", start) - start)));
    const std::regex arrow("([a-z]+) +-> (.*)"), word("[a-z]+");
    std::smatch match;
    for (std::string line; std::getline(lines, line);) {
        if (!std::regex_search(line, match, arrow) || names.count(match[1]) == 0) continue;
        const std::string from = match[1], to = match[2];
        for (std::sregex_iterator it(to.begin(), to.end(), word), end; it != end; ++it)
            if (names.count(it->str()) != 0) arrows.insert(from + " -> " + it->str());
    }
    return arrows;
}

}  // namespace carom::test
