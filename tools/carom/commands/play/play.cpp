// carom play: an interactive page, with carom in it.
#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/plan.h"
#include "carom/engine/printable.h"
#include "carom/engine/table.h"
#include "carom/games/rules.h"
#include "carom/interface/shape.h"
#include "commands/play/play_files.h"
#include "page/page.h"
#include "report/table.h"

namespace carom::tools {

/// carom.wasm, compressed by gzip, as base64. The npm package has its own page_wasm.cpp.
/// @throws UsageError if carom was built without it
std::string page_wasm();

namespace {

using Json = nlohmann::ordered_json;

struct PlayArgs {
    std::string scene, output = "play.html", lock;
};

/// "cue.speed,balls" as a list of keys. @throws UsageError
Json locked_keys(const std::string& list) {
    Json keys = Json::array();
    std::istringstream in(list);
    for (std::string key; std::getline(in, key, ',');) {
        const std::string part = key.substr(0, key.find('.'));
        if (part != "cue" && part != "ball" && part != "balls" && part != "table" && part != "physics")
            throw UsageError(
                fmt::format("--lock {}: expected keys of [cue], [[ball]], [balls], [table] or [physics], "
                            "such as cue.speed,ball",
                            harmless(list)));
        keys.push_back(key);
    }
    return keys;
}

/// The scenes that come with carom: a list of {name, text}.
Json shipped_scenes() {
    Json scenes = Json::array();
    for (const PageFile& file : play_files()) {
        const std::string_view name = file.name;
        if (name.ends_with(".toml")) scenes.push_back({{"name", name}, {"text", file.text}});
    }
    return scenes;
}

/// The keys that a page can set, by section: numbers, names and lists of numbers.
Json keys_to_set() {
    const Json sections = Json::parse(play_file("scene.schema.json")).at("properties");
    Json keys;
    for (const char* section : {"table", "balls", "physics"}) {
        for (const auto& [key, about] : sections.at(section).at("properties").items()) {
            const bool list = about.at("type") == "array";
            if (list && about.at("items").at("type") != "number") continue;
            keys[section][key] = {{"type", about.at("type")},
                                  {"description", about.value("description", "")}};
            if (about.contains("enum")) keys[section][key]["enum"] = about.at("enum");
        }
    }
    return keys;
}

/// The shaders of the view behind the cue ball, by file name.
Json shaders() {
    Json sources;
    for (const PageFile& file : play_files()) {
        const std::string_view name = file.name;
        if (name.ends_with(".vert") || name.ends_with(".frag") || name.ends_with(".glsl"))
            sources[file.name] = file.text;
    }
    return sources;
}

/// Data for the page's script: the scene, the locked keys, and the choices. @throws
/// UsageError
Json start_of(const PlayArgs& args) {
    Json page = page_json("carom", "an interactive table", harmless(command_line()), program_version());
    page["lock"] = locked_keys(args.lock);
    page["scenes"] = shipped_scenes();
    page["tables"] = kTablePresets;
    page["games"] = interface::value_of(games::all_games());
    page["keys"] = keys_to_set();
    page["shaders"] = shaders();
    page["scene"] = "";
    if (!args.scene.empty()) {
        if (is_record(args.scene))
            throw UsageError(
                fmt::format("{}: expected a scene file (TOML), not a record", harmless(args.scene)));
        plan_scene(args.scene);  // rejects a bad scene here and not in the browser
        page["scene"] = read_scene_text(args.scene);
        page["lead"] = harmless(args.scene);
    }
    return page;
}

int run(const PlayArgs& args) {
    check_page_path("-o", args.output);
    const Json page = start_of(args);
    const std::string wasm = page_wasm();
    add_page_files(play_files());
    const std::vector<PageData> data = {{"wasm", '"' + wasm + '"'},
                                        {"page", page.dump(-1, ' ', false, Json::error_handler_t::replace)}};
    const std::string html = page_html("carom", "play.js", data, {{"play.css", "extras.css"}, true});
    write_report(args.output, html);
    print(fmt::format("{}: open it in a browser; {} kB\n", args.output, (html.size() + 500) / 1000));
    return kOk;
}

}  // namespace

void add_play(Options& program) {
    auto [command, args] =
        program.command<PlayArgs>("play", "Write an interactive page: aim, shoot, play against carom", run);
    command.argument("SCENE", args.scene, "Scene file (TOML) to begin with (default: a practice table)");
    command.option("-o,--output", &args.output, "FILE.html", "Page to write");
    command.option("--lock", &args.lock, "KEYS",
                   "Lock these keys on the page, such as cue.speed,ball (default: none)");
}

}  // namespace carom::tools
