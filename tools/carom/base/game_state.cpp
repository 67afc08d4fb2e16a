#include "base/game_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/console.h"
#include "carom/engine/printable.h"

namespace carom::tools {

using Json = nlohmann::ordered_json;
using games::State;

namespace {

// [bytes] A state takes about three hundred.
constexpr std::uintmax_t kLargestState = 1 << 16;

/// Reads one key; its message names the expected value.
struct Reader {
    const std::string& path;
    const Json& json;

    [[noreturn]] void fail(const char* key, const std::string& expected) const {
        throw UsageError(fmt::format("{}: {}: expected {}", path, key, expected));
    }
    void truth(const char* key, bool& value) const {
        if (!json.contains(key)) return;
        if (!json[key].is_boolean()) fail(key, "true or false");
        value = json[key].get<bool>();
    }
    int whole(const Json& of, const char* key, int least, int most) const {
        const auto expected = fmt::format("a whole number from {} to {}", least, most);
        if (!of.is_number_integer()) fail(key, expected);
        const auto value = of.get<std::int64_t>();
        if (value < least || value > most) fail(key, expected);
        return static_cast<int>(value);
    }
    void whole(const char* key, int& value, int least, int most) const {
        if (json.contains(key)) value = whole(json[key], key, least, most);
    }
    void pair(const char* key, std::array<int, 2>& value, int least, int most) const {
        if (!json.contains(key)) return;
        if (!json[key].is_array() || json[key].size() != 2) fail(key, "one whole number for each player");
        for (std::size_t i = 0; i < 2; ++i) value[i] = whole(json[key][i], key, least, most);
    }
    void rules(State& state) const {
        if (!json.contains("rules")) return;
        const char* const expected = "a list of options, such as [\"call=eight\"]";
        if (!json["rules"].is_array()) fail("rules", expected);
        for (const Json& option : json["rules"]) {
            if (!option.is_string()) fail("rules", expected);
            try {
                games::set_rule(state, option.get<std::string>());
            } catch (const std::invalid_argument& refused) {
                throw UsageError(fmt::format("{}: rules: {}", path, refused.what()));
            }
        }
    }
    template <class Enum>
    Enum named(const Json& of, const char* key) const {
        const auto names = names_of(Enum{});
        for (std::size_t i = 0; i < names.size(); ++i)
            if (of.is_string() && of.get<std::string>() == names[i]) return static_cast<Enum>(i);
        fail(key, fmt::format("one of {}", fmt::join(names, ", ")));
    }
    template <class Enum>
    void named(const char* key, Enum& value) const {
        if (json.contains(key)) value = named<Enum>(json[key], key);
    }
};

constexpr const char* kKeys[] = {"game",   "turn", "opening",   "in_hand", "points",
                                 "target", "over", "winner",    "group",   "may_push_out",
                                 "fouls",  "on",   "free_ball", "rules"};

}  // namespace

std::vector<std::string> game_names() {
    const auto names = games::names_of(games::Game{});
    return {names.begin(), names.end()};
}

games::Game game_of(const std::string& name) {
    const std::vector<std::string> names = game_names();
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return static_cast<games::Game>(i);
    throw UsageError(fmt::format("--game {}: expected one of {}", name, fmt::join(names, ", ")));
}

Json state_json(const State& state) {
    return {{"game", name(state.game)},
            {"turn", state.turn},
            {"opening", state.opening},
            {"in_hand", name(state.in_hand)},
            {"points", state.points},
            {"target", state.target},
            {"over", state.over},
            {"winner", state.winner},
            {"group", {name(state.group[0]), name(state.group[1])}},
            {"may_push_out", state.may_push_out},
            {"fouls", state.fouls},
            {"on", carom::name(state.on)},
            {"free_ball", state.free_ball},
            {"rules", games::chosen_rules(state)}};
}

State read_state(const std::string& path) {
    const std::string shown = harmless(path);
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw UsageError(shown + ": there is no such file");
    if (std::filesystem::file_size(path, error) > kLargestState)
        throw UsageError(fmt::format("{}: expected a game state of less than 64 kB", shown));
    std::ifstream stream(path);
    std::stringstream text;
    text << stream.rdbuf();
    return parse_state(text.str(), shown);
}

State parse_state(const std::string& text, const std::string& shown) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object())
        throw UsageError(shown + ": expected a game state as written by carom judge --state-out");
    for (const auto& [key, value] : json.items()) {
        if (std::find(std::begin(kKeys), std::end(kKeys), key) == std::end(kKeys))
            throw UsageError(fmt::format("{}: unknown key {}; expected one of {}", shown, in_quotes(key),
                                         fmt::join(kKeys, ", ")));
    }
    const Reader read{shown, json};
    if (!json.contains("game")) read.fail("game", "the name of the game");
    State state;
    read.named("game", state.game);
    read.whole("turn", state.turn, 0, 1);
    read.truth("opening", state.opening);
    read.named("in_hand", state.in_hand);
    read.pair("points", state.points, -games::kMostPoints, games::kMostPoints);
    read.whole("target", state.target, 0, games::kMostPoints);
    read.truth("over", state.over);
    read.whole("winner", state.winner, -1, 1);
    if (json.contains("group")) {
        if (!json["group"].is_array() || json["group"].size() != 2)
            read.fail("group", "one group for each player");
        for (std::size_t i = 0; i < 2; ++i)
            state.group[i] = read.named<games::Group>(json["group"][i], "group");
    }
    read.truth("may_push_out", state.may_push_out);
    read.pair("fouls", state.fouls, 0, games::kMostPoints);
    read.named("on", state.on);
    read.truth("free_ball", state.free_ball);
    read.rules(state);
    return state;
}

}  // namespace carom::tools
