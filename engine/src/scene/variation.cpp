#include "carom/engine/variation.h"

#include <fmt/compile.h>
#include <fmt/format.h>
#include <iterator>

#include <algorithm>
#include <charconv>
#include <span>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <variant>

#include "base/draws.h"
#include "base/fnv.h"
#include "base/toml_number.h"
#include "carom/engine/tolerances.h"
#include "scene/aim.h"
#include "scene/distribution.h"
#include "scene/keys.h"
#include "scene/rack.h"
#include "scene/reader.h"
#include "scene/sections.h"

namespace carom {
namespace {

using detail::Distribution;
using detail::Drawn;
using detail::element_index;
using detail::fail;
using detail::take;
using detail::take_part;

/// One step of a path: into a table by its name, or, if the name is empty, into an array by its index.
struct Step {
    std::string name;
    std::size_t index = 0;
    bool operator==(const Step&) const = default;
};

struct Rule {
    std::string key;
    std::vector<Step> path;
    Distribution distribution;
    ValueKind kind = ValueKind::kNumber;
    // The number or rack value of this key, if it can be set without the file.
    std::optional<SceneNumber> number;
    const Field<Rack>* rack = nullptr;
    // Of a grid: how many shots share a value before the next one comes.
    std::uint64_t stride = 1;

    Drawn draw(std::uint64_t seed, std::uint64_t index) const {
        if (distribution.steps > 0) return distribution.at(index / stride % distribution.steps);
        SplitMix64 random = draws_of(seed, index, key);
        return distribution.draw(random);
    }
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

/// Sets a value at the end of the path. All steps before the last one exist.
void put_value(toml::table& file, const std::vector<Step>& path, const Drawn& value) {
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

void write(const Drawn& value, std::string& text) {
    text.clear();
    const auto add = [&text](const auto& x) { fmt::format_to(std::back_inserter(text), "{}", x); };
    if (const auto* number = std::get_if<double>(&value)) {
        char digits[40];  // a double takes 24
        text.append(digits, fmt::format_to(digits, FMT_COMPILE("{}"), *number));
        return;
    }
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return add(*whole);
    const toml::node& node = *std::get<const toml::node*>(value);
    if (const auto* words = node.as_string()) return add(words->get());
    if (const auto* x = node.as_floating_point()) return add(x->get());
    std::ostringstream out;
    node.visit([&out](const auto& v) { out << v; });
    text = out.str();
}

/// The drawn number, if a double can hold it.
std::optional<double> number_of(const Drawn& value) {
    if (const auto* number = std::get_if<double>(&value)) return *number;
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    const toml::node& node = *std::get<const toml::node*>(value);
    try {
        return detail::number_in(node);
    } catch (const std::invalid_argument&) {
        return std::nullopt;
    }
}

bool is_whole(const Drawn& value) {
    const auto* const* node = std::get_if<const toml::node*>(&value);
    return std::holds_alternative<std::int64_t>(value) || (node != nullptr && (*node)->is_integer());
}

/// Removes the id of a ball from the front of a key, and returns its index in the list.
std::size_t take_ball(toml::table& file, std::string_view& key) {
    const toml::array* balls = file["ball"].as_array();
    std::string ids;
    for (std::size_t i = 0; balls && i < balls->size(); ++i) {
        const toml::table* ball = balls->get_as<toml::table>(i);
        const std::string id = ball ? (*ball)["id"].value_or(std::string("cue")) : "";
        if (take(key, id)) return i;
        ids += (ids.empty() ? "" : ", ") + id;
    }
    fail("the scene has no such [[ball]]; write ball.ID.position.x with one of these ids: {}",
         ids.empty() ? "none is written" : ids);
}

/// Finds the section that a key begins with. If it is missing and holds only settings, adds it, empty.
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
    for (const PocketSection& of : kPocketSections) {
        if (!take(key, of.key)) continue;
        toml::table* table = file["table"].as_table();
        if (table != nullptr && !table->contains(of.key)) table->insert(of.key, toml::table());
        path.push_back({of.key});
        return path;
    }
    for (const std::string list : {"cushion", "jaw", "arc", "pocket"}) {
        if (!take(key, list)) continue;
        path.push_back({list});
        path.push_back({"", take_part(key, list)});
        break;
    }
    return path;
}

/// The path in the file that a key names.
std::vector<Step> find_path(toml::table& file, std::string_view key) {
    std::vector<Step> path = find_section(file, key);
    const toml::node* holder = follow(file, path);
    if (holder == nullptr || !holder->is_table()) fail("the scene file does not contain this part");
    const std::size_t dot = key.find('.');
    if (key.empty() || dot == 0) fail("the name of the value is missing");
    path.push_back({std::string(key.substr(0, dot))});
    if (dot == key.npos) return path;
    const std::size_t index = element_index(key.substr(dot + 1));
    const toml::node* array = follow(file, path);
    if (array == nullptr || !array->is_array())
        fail("the scene file does not contain this array; add it, then vary one of its numbers");
    path.push_back({"", index});
    if (follow(file, path) == nullptr) fail("the array in the scene file is shorter");
    return path;
}

/// Refuses a key that no scene has. If the file has no value for it, nothing else distinguishes it from a key
/// that was left out.
void check_known(toml::table file, const std::string& name, const std::vector<Step>& path) {
    put_value(file, path, 0.0);
    try {
        detail::scene_from(file, name);
    } catch (const detail::UnknownKey& error) {
        fail("{}", error.message());
    } catch (const SceneError&) {  // 0 is not allowed there
    }
}

Rule parse_rule(toml::table& file, const std::string& name, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos || equals == 0) fail("expected KEY=DISTRIBUTION, such as cue.speed=uniform(2,4)");
    Rule rule;
    rule.key = text.substr(0, equals);
    rule.path = find_path(file, rule.key);
    const toml::node* const own = follow(file, rule.path);
    if (own == nullptr) check_known(file, name, rule.path);
    rule.distribution = detail::parse_distribution(std::string_view(text).substr(equals + 1), own);
    rule.kind = detail::kind_of(std::string_view(text).substr(equals + 1));
    return rule;
}

bool overlap(const Rule& a, const Rule& b) {
    const std::size_t common = std::min(a.path.size(), b.path.size());
    return std::equal(a.path.begin(), a.path.begin() + static_cast<std::ptrdiff_t>(common), b.path.begin());
}

/// Whether a key of the file is a number of the scene on which nothing else depends. Noses, racks and balls
/// with their own size depend on the size of the balls, and the surface on the parts of the table.
bool is_number_alone(std::string_view key) {
    const std::string_view section = key.substr(0, key.find('.')), last = key.substr(key.rfind('.') + 1);
    if (section == "cue" || section == "physics" || section == "stop") return true;
    return (section == "ball" || section == "balls") && last != "radius" && last != "mass";
}

/// Finds what a rule varies in the scene itself.
void find_number(const Scene& scene, Rule& rule) {
    std::string_view key = rule.key;
    try {
        if (is_number_alone(key)) rule.number.emplace(scene, key);
    } catch (const std::invalid_argument&) {  // a model, a list, or a mistake that shot() reports
    }
    if (!take(key, "rack")) return;
    for (const Field<Rack>& f : kRackFields)
        if (key == f.key && (key == "gap" || key == "jitter" || key == "seed" || key == "angle_deg"))
            rule.rack = &f;
}

/// Sets a number of the rack; false if its section would refuse it.
bool put_in_rack(const Field<Rack>& row, const Drawn& value, Rack& rack) {
    const std::optional<double> number = number_of(value);
    if (!number || !contains(row.range, *number)) return false;
    if (row.kind == Key::Kind::kNumber)
        row.set(rack, *number);
    else if (is_whole(value))
        row.set(rack, static_cast<std::int64_t>(*number));
    else
        return false;
    return true;
}

bool same_balls(const Scene& a, const Scene& b) {
    return std::equal(a.ball.begin(), a.ball.end(), b.ball.begin(), b.ball.end(),
                      [](const BallStart& x, const BallStart& y) { return x.id == y.id; });
}

}  // namespace

struct Variation::Parts {
    Parts(std::string file_name, toml::table content)
        : path(std::move(file_name)), file(std::move(content)) {}

    std::string path;
    toml::table file;
    Scene base;
    std::vector<Rule> rules;
    std::vector<std::string> keys;
    std::uint64_t seed = 0;
    std::uint64_t fingerprint = 0;
    std::uint64_t grid = 0;  // points of the product of all grids; 0: there is none
    bool quick = true;       // every rule is a number of the scene or of its rack
    Rack rack;               // as in the file
};

Variation::Variation(const std::string& path, const std::vector<std::string>& rules, std::uint64_t seed)
    : Variation(std::make_shared<Parts>(path, detail::read_toml(path)), rules, seed) {}

Variation Variation::from_text(std::string_view text, const std::string& name,
                               const std::vector<std::string>& rules, std::uint64_t seed) {
    return {std::make_shared<Parts>(name, detail::toml_from(text, name)), rules, seed};
}

Variation::Variation(const std::shared_ptr<Parts>& parts, const std::vector<std::string>& rules,
                     std::uint64_t seed) {
    parts->seed = seed;
    parts->base = detail::scene_from(parts->file, parts->path);
    detail::read_rack_keys(detail::top_of(parts->file, parts->path), parts->rack);
    // Such a rack changes the balls themselves.
    parts->quick = parts->rack.radius_sd == 0.0;
    std::ostringstream content;
    content << parts->file;
    // A rule that sets the aim or the speed replaces the words for it; otherwise they follow the balls.
    const auto sets = [&rules](std::string_view key) {
        return std::any_of(rules.begin(), rules.end(),
                           [key](const std::string& rule) { return rule.starts_with(key); });
    };
    const toml::table* cue = parts->file["cue"].as_table();
    const bool words = cue != nullptr && std::any_of(detail::kAimKeys.begin(), detail::kAimKeys.end(),
                                                     [cue](auto key) { return cue->contains(key); });
    if (words && (sets("cue.aim_deg=") || sets("cue.speed=")))
        detail::write_aim(parts->file, *parts->base.cue);
    else if (words)
        parts->quick = false;
    Fnv print;
    print.add(content.str());
    print.add(seed);
    for (const std::string& text : rules) {
        try {
            Rule rule = parse_rule(parts->file, parts->path, text);
            for (const Rule& other : parts->rules)
                if (overlap(rule, other)) fail("{} already varies this value", other.key);
            find_number(parts->base, rule);
            parts->quick = parts->quick && (rule.number || rule.rack != nullptr);
            parts->keys.push_back(rule.key);
            parts->rules.push_back(std::move(rule));
        } catch (const std::invalid_argument& error) {
            throw VariationError(text + ": " + error.what());
        }
        print.add(static_cast<std::uint64_t>(text.size()));
        print.add(text);
    }
    parts->fingerprint = print.value();
    // The last grid varies fastest.
    for (auto rule = parts->rules.rbegin(); rule != parts->rules.rend(); ++rule) {
        const std::uint64_t steps = rule->distribution.steps;
        if (steps == 0) continue;
        rule->stride = std::max<std::uint64_t>(parts->grid, 1);
        if (steps > kMostShots / rule->stride)
            throw VariationError(rule->key + ": the grids have more than 2^53 points together; take fewer");
        parts->grid = rule->stride * steps;
    }
    parts_ = parts;
    // A mistyped key or a range without valid values spoils every shot: report it here, once.
    for (int i = 0; i < kVariationTrials; ++i)
        if (shot(static_cast<std::uint64_t>(i)).scene) return;
    throw VariationError(fmt::format("none of the first {} shots is a valid scene; shot 0: {}",
                                     kVariationTrials, shot(0).error));
}

std::string with_values(std::string_view text, const std::string& name, const std::vector<NewValue>& values) {
    toml::table file = detail::toml_from(text, name);
    for (const NewValue& value : values) {
        try {
            const std::vector<Step> path = find_path(file, value.key);
            const toml::array list = detail::arguments("value", value.value);
            if (list.size() != 1) fail("expected one value, not {}", list.size());
            put_value(file, path, list.get(0));
        } catch (const std::invalid_argument& error) {
            throw VariationError(value.key + ": " + error.what());
        }
    }
    std::ostringstream out;
    out << file;
    return out.str();
}

const Scene& Variation::base() const {
    return parts_->base;
}

const std::vector<std::string>& Variation::keys() const {
    return parts_->keys;
}

std::string Variation::unit(std::size_t key) const {
    const Rule& rule = parts_->rules.at(key);
    if (rule.rack != nullptr) return rule.rack->range.unit;
    try {
        return SceneNumber(parts_->base, rule.key).row().range.unit;
    } catch (const std::invalid_argument&) {
        return "";
    }
}

std::uint64_t Variation::grid() const {
    return parts_->grid;
}

ValueKind Variation::kind(std::size_t key) const {
    return parts_->rules.at(key).kind;
}

std::uint64_t Variation::fingerprint() const {
    return parts_->fingerprint;
}

VariedShot Variation::shot(std::uint64_t index) const {
    VariedShot shot;
    toml::table file = parts_->file;
    for (const Rule& rule : parts_->rules) {
        const Drawn value = rule.draw(parts_->seed, index);
        write(value, shot.values.emplace_back());
        put_value(file, rule.path, value);
    }
    try {
        shot.scene = detail::scene_from(file, parts_->path);
        if (same_balls(*shot.scene, parts_->base)) return shot;
        shot.error = "its balls differ from those of the scene file; sweep each kind of rack separately";
        shot.scene.reset();
    } catch (const SceneError& error) {
        shot.error = error.message();
    }
    return shot;
}

std::optional<Change> Variation::put(std::uint64_t index, Scene& scene,
                                     std::vector<std::string>& values) const {
    if (!parts_->quick) return std::nullopt;
    values.resize(parts_->rules.size());
    Change change = Change::kNumbers;
    std::optional<Rack> rack;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Rule& rule = parts_->rules[k];
        const Drawn value = rule.draw(parts_->seed, index);
        write(value, values[k]);
        if (rule.rack != nullptr) {
            if (!rack) rack = parts_->rack;
            if (!put_in_rack(*rule.rack, value, *rack)) return std::nullopt;
            continue;
        }
        const std::optional<double> number = number_of(value);
        if (!number || (rule.number->row().kind == Key::Kind::kInteger && !is_whole(value)))
            return std::nullopt;
        try {
            change = std::max(change, rule.number->put(scene, *number));
        } catch (const SceneError&) {
            return std::nullopt;
        }
    }
    if (rack) {
        const std::size_t placed = scene.ball.size() - static_cast<std::size_t>(balls_of(*rack));
        std::vector<RackedBall> racked;
        try {
            racked = make_rack(*rack, scene.table, scene.balls.R, std::span(scene.ball).first(placed));
        } catch (const std::invalid_argument&) {
            return std::nullopt;
        }
        std::size_t ball = scene.ball.size() - racked.size();
        for (const RackedBall& place : racked) place.put(scene.ball[ball++], scene.balls.size());
        change = std::max(change, Change::kPlaces);
    }
    return change;
}

}  // namespace carom
