#include "carom/engine/variation.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <variant>

#include "base/fnv.h"
#include "carom/engine/tolerances.h"
#include "scene/distribution.h"
#include "scene/sections.h"

namespace carom {
namespace {

using detail::Distribution;
using detail::Drawn;
using detail::fail;
using detail::in_quotes;

/// One step of a path: into a table by its name, or, where the name is empty, into an array by its index.
struct Step {
    std::string name;
    std::size_t index = 0;
    bool operator==(const Step&) const = default;
};

struct Rule {
    std::string key;
    std::vector<Step> path;
    Distribution distribution;
};

toml::node* follow(toml::node& from, const Step& step) {
    if (!step.name.empty()) {
        toml::table* table = from.as_table();
        return table ? table->get(step.name) : nullptr;
    }
    toml::array* array = from.as_array();
    return array && step.index < array->size() ? array->get(step.index) : nullptr;
}

toml::node* follow(toml::node& from, const std::vector<Step>& path) {
    toml::node* at = &from;
    for (const Step& step : path) {
        if (at == nullptr) return nullptr;
        at = follow(*at, step);
    }
    return at;
}

/// Puts a value at the end of the path. All places before the last step exist.
void put(toml::table& file, const std::vector<Step>& path, const Drawn& value) {
    toml::node* parent = follow(file, std::vector<Step>(path.begin(), path.end() - 1));
    const auto place = [&](const auto& v) {
        const Step& last = path.back();
        if (!last.name.empty()) {
            parent->as_table()->insert_or_assign(last.name, v);
        } else {
            toml::array& array = *parent->as_array();
            array.replace(array.cbegin() + static_cast<std::ptrdiff_t>(last.index), v);
        }
    };
    if (const auto* node = std::get_if<const toml::node*>(&value))
        (*node)->visit(place);
    else if (const auto* whole = std::get_if<std::int64_t>(&value))
        place(*whole);
    else
        place(std::get<double>(value));
}

std::string text_of(const Drawn& value) {
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
    const toml::node& node = *std::get<const toml::node*>(value);
    if (node.is_string()) return *node.value<std::string>();
    if (node.is_floating_point()) return fmt::format("{}", *node.value<double>());
    std::ostringstream out;
    node.visit([&out](const auto& v) { out << v; });
    return out.str();
}

/// Takes "name." from the front of a key; false where the key does not begin so.
bool take(std::string_view& key, std::string_view name) {
    if (key.size() <= name.size() || key.substr(0, name.size()) != name || key[name.size()] != '.')
        return false;
    key.remove_prefix(name.size() + 1);
    return true;
}

/// Takes the id of a written ball from the front of a key, and returns its place in the list.
std::size_t take_ball(toml::table& file, std::string_view& key) {
    const toml::array* balls = file["ball"].as_array();
    std::string ids;
    for (std::size_t i = 0; balls && i < balls->size(); ++i) {
        const toml::table* ball = balls->get_as<toml::table>(i);
        const std::string id = ball ? (*ball)["id"].value_or(std::string("cue")) : "";
        if (take(key, id)) return i;
        ids += (ids.empty() ? "" : ", ") + id;
    }
    fail("it names no [[ball]] of the scene; write ball.ID.position.x with one of these ids: {}",
         ids.empty() ? "none is written" : ids);
}

/// Takes the name of a part of the table from the front of a key ("c2" in the list "cushion"), and returns its place in the
/// list.
std::size_t take_part(std::string_view& key, const std::string& list) {
    const char letter = list.front();
    std::size_t number = 0;
    const char* const end = key.data() + key.size();
    const bool lettered = !key.empty() && key[0] == letter;
    const auto [rest, error] = std::from_chars(key.data() + (lettered ? 1 : 0), end, number);
    if (!lettered || error != std::errc() || rest == end || *rest != '.' || number < 1)
        fail("name the part by its number, as in table.{}.{}1.radius", list, letter);
    key.remove_prefix(static_cast<std::size_t>(rest + 1 - key.data()));
    return number - 1;
}

/// Returns the place in an array that "x", "side" or "0" stands for; the names are those of docs/reference/scene_format.md.
std::size_t element_index(std::string_view name) {
    constexpr struct {
        const char* name;
        std::size_t index;
    } kNames[] = {{"x", 0}, {"y", 1}, {"z", 2}, {"side", 0}, {"height", 1}, {"width", 0}};
    for (const auto& known : kNames)
        if (name == known.name) return known.index;
    std::size_t index = 0;
    const auto [rest, error] = std::from_chars(name.data(), name.data() + name.size(), index);
    if (error != std::errc() || rest != name.data() + name.size())
        fail("{} is no element of an array; use x, y, z, side, height or its number from 0", in_quotes(name));
    return index;
}

/// Finds the section that a key begins with. A missing one that holds only settings is added without a key.
std::vector<Step> find_section(toml::table& file, std::string_view& key) {
    if (take(key, "ball")) return {{"ball"}, {"", take_ball(file, key)}};
    const std::size_t dot = key.find('.');
    if (dot == key.npos || dot == 0) fail("name a value in its section, such as cue.speed");
    const std::string section(key.substr(0, dot));
    key.remove_prefix(dot + 1);
    if (!file.contains(section)) {
        // These two would put balls on the table, or strike one.
        if (section == "rack" || section == "cue")
            fail("the scene has no [{}]; write the section, then vary what is in it", section);
        file.insert(section, toml::table());
    }
    std::vector<Step> path = {{section}};
    if (section != "table") return path;
    for (const std::string list : {"cushion", "jaw", "pocket"}) {
        if (!take(key, list)) continue;
        path.push_back({list});
        path.push_back({"", take_part(key, list)});
        break;
    }
    return path;
}

/// From a key to the place in the file that it names.
std::vector<Step> find_path(toml::table& file, std::string_view key) {
    std::vector<Step> path = find_section(file, key);
    const toml::node* holder = follow(file, path);
    if (holder == nullptr || !holder->is_table()) fail("the scene does not write this part");
    const std::size_t dot = key.find('.');
    if (key.empty() || dot == 0) fail("the name of the value is missing");
    path.push_back({std::string(key.substr(0, dot))});
    if (dot == key.npos) return path;
    const std::size_t index = element_index(key.substr(dot + 1));
    const toml::node* array = follow(file, path);
    if (array == nullptr || !array->is_array())
        fail("the scene does not write this array; write it there, then vary one of its numbers");
    path.push_back({"", index});
    if (follow(file, path) == nullptr) fail("the array in the scene is shorter");
    return path;
}

Rule parse_rule(toml::table& file, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos || equals == 0) fail("expected KEY=DISTRIBUTION, such as cue.speed=uniform(2,4)");
    Rule rule;
    rule.key = text.substr(0, equals);
    rule.path = find_path(file, rule.key);
    rule.distribution =
        detail::parse_distribution(std::string_view(text).substr(equals + 1), follow(file, rule.path));
    return rule;
}

bool overlap(const Rule& a, const Rule& b) {
    const std::size_t common = std::min(a.path.size(), b.path.size());
    return std::equal(a.path.begin(), a.path.begin() + static_cast<std::ptrdiff_t>(common), b.path.begin());
}

bool same_balls(const Scene& a, const Scene& b) {
    return std::equal(a.ball.begin(), a.ball.end(), b.ball.begin(), b.ball.end(),
                      [](const BallStart& x, const BallStart& y) { return x.id == y.id; });
}

}  // namespace

struct Variation::Parts {
    std::string path;
    toml::table file;
    Scene base;
    std::vector<Rule> rules;
    std::vector<std::string> keys;
    std::uint64_t seed = 0;
    std::uint64_t fingerprint = 0;
};

Variation::Variation(const std::string& path, const std::vector<std::string>& rules, std::uint64_t seed) {
    const auto parts = std::make_shared<Parts>();
    parts->path = path;
    parts->seed = seed;
    parts->file = detail::read_toml(path);
    parts->base = detail::scene_from(parts->file, path);
    std::ostringstream content;
    content << parts->file;
    Fnv print;
    print.add(content.str());
    print.add(seed);
    for (const std::string& text : rules) {
        try {
            Rule rule = parse_rule(parts->file, text);
            for (const Rule& other : parts->rules)
                if (overlap(rule, other)) fail("{} varies this value already", other.key);
            parts->keys.push_back(rule.key);
            parts->rules.push_back(std::move(rule));
        } catch (const std::invalid_argument& error) {
            throw VariationError(text + ": " + error.what());
        }
        print.add(static_cast<std::uint64_t>(text.size()));
        print.add(text);
    }
    parts->fingerprint = print.value();
    parts_ = parts;
    // A mistyped key or a range without valid values spoils every shot: it is reported here, once.
    for (int i = 0; i < kVariationTrials; ++i)
        if (shot(static_cast<std::uint64_t>(i)).scene) return;
    throw VariationError(fmt::format("none of the first {} shots is a valid scene; shot 0: {}",
                                     kVariationTrials, shot(0).error));
}

const Scene& Variation::base() const {
    return parts_->base;
}

const std::vector<std::string>& Variation::keys() const {
    return parts_->keys;
}

std::uint64_t Variation::fingerprint() const {
    return parts_->fingerprint;
}

VariedShot Variation::shot(std::uint64_t index) const {
    VariedShot shot;
    toml::table file = parts_->file;
    for (const Rule& rule : parts_->rules) {
        Fnv hash;
        hash.add(parts_->seed);
        hash.add(index);
        hash.add(rule.key);
        SplitMix64 random(hash.value());
        const Drawn value = rule.distribution(random);
        shot.values.push_back(text_of(value));
        put(file, rule.path, value);
    }
    try {
        shot.scene = detail::scene_from(file, parts_->path);
        if (same_balls(*shot.scene, parts_->base)) return shot;
        shot.error = "its balls are not those of the scene; sweep each kind of rack by itself";
        shot.scene.reset();
    } catch (const SceneError& error) {
        shot.error = error.message();
    }
    return shot;
}

}  // namespace carom
