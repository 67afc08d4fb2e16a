#include "carom/engine/variation.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <variant>

#include "base/draws.h"
#include "base/fnv.h"
#include "carom/engine/tolerances.h"
#include "scene/distribution.h"
#include "scene/keys.h"
#include "scene/rack.h"
#include "scene/reader.h"
#include "scene/sections.h"

namespace carom {

/// One rule of a variation. Not in an unnamed namespace, because Variation::Parts contains it.
struct VariationRule {
    std::string key;
    detail::KeyPath path;
    detail::Distribution distribution;
    std::string unit;  // "" if it is not a number of the scene
    // The number or rack value of this key, if it can be set without the file.
    std::optional<SceneNumber> number;
    const Field<Rack>* rack = nullptr;
    // Of a grid: number of consecutive shots with the same value.
    std::uint64_t stride = 1;

    DrawnValue draw(std::uint64_t seed, std::uint64_t index) const {
        if (distribution.steps > 0) return distribution.at(index / stride % distribution.steps);
        SplitMix64 random = draws_of(seed, index, key);
        return distribution.draw(random);
    }
};

namespace {

using detail::Distribution;
using detail::fail;
using detail::KeyPath;
using detail::ListItem;

const ListItem* listed(const DrawnValue& value) {
    const auto* const* item = std::get_if<const ListedValue*>(&value);
    return item != nullptr ? static_cast<const ListItem*>(*item) : nullptr;
}

using Node = toml::node_view<toml::node>;

/// The file's table that contains the value of a key, or no node.
Node holder_in(toml::table& file, const KeyPath& path) {
    Node at = file[path.section];
    if (!path.list.empty()) at = at[path.list];
    return path.index ? at[*path.index] : at;
}

Node value_in(toml::table& file, const KeyPath& path) {
    const Node at = holder_in(file, path)[path.name];
    return path.element ? at[*path.element] : at;
}

/// Sets the value of a key, whose containers must exist.
void put_value(toml::table& file, const KeyPath& path, const DrawnValue& value) {
    const Node holder = holder_in(file, path);
    const auto place = [&](const auto& v) {
        if (!path.element) {
            holder.as_table()->insert_or_assign(path.name, v);
        } else {
            toml::array& array = *holder[path.name].as_array();
            array.replace(array.cbegin() + static_cast<std::ptrdiff_t>(*path.element), v);
        }
    };
    if (const ListItem* item = listed(value))
        item->node->visit(place);
    else if (const auto* whole = std::get_if<std::int64_t>(&value))
        place(*whole);
    else
        place(std::get<double>(value));
}

/// The drawn number, if keys accept it.
std::optional<double> exact_number(const DrawnValue& value) {
    const ListItem* item = listed(value);
    return item != nullptr ? item->exact : number_of(value);
}

bool is_whole(const DrawnValue& value) {
    const ListItem* item = listed(value);
    return item != nullptr ? item->node->is_integer() : std::holds_alternative<std::int64_t>(value);
}

/// Writes a preset's fit into the file if one of its numbers is to be varied.
void write_fit(toml::table& balls, const std::string& name, const BallParams& params) {
    for (const Field<BallParams>& f : kBallFields) {
        if (f.options.instead_of == nullptr || name != f.key || balls.contains(name)) continue;
        const FieldValue value = f.get(params);
        const auto* numbers = std::get_if<std::vector<double>>(&value);
        if (numbers == nullptr) return;
        toml::array list;
        for (const double number : *numbers) list.push_back(number);
        balls.insert(name, std::move(list));
    }
}

/// The path that a key names in the file. If its section is missing and contains only settings, adds it,
/// empty.
KeyPath find_path(toml::table& file, std::string_view key, const Scene* base = nullptr) {
    std::vector<std::string> ids;
    for (std::size_t i = 0; const Node ball = file["ball"][i]; ++i)
        ids.push_back(ball["id"].value_or(std::string("cue")));
    KeyPath path = detail::parse_key(key, ids);
    if (!file.contains(path.section)) {
        // These two sections would put balls on the table, or strike one.
        if (path.section == "rack" || path.section == "cue")
            fail("the scene has no [{}]; add the section, then vary its values", path.section);
        file.insert(path.section, toml::table());
    }
    toml::table* table = file[path.section].as_table();
    if (table != nullptr && !path.list.empty() && !path.index && !table->contains(path.list))
        table->insert(path.list, toml::table());
    const Node holder = holder_in(file, path);
    if (!holder.is_table()) fail("the scene file does not contain this part");
    if (!path.element) return path;
    if (base != nullptr && path.section == "balls") write_fit(*holder.as_table(), path.name, base->balls);
    if (!holder[path.name].is_array())
        fail("the scene file does not contain this array; add it, then vary one of its numbers");
    if (!value_in(file, path)) fail("the array in the scene file is shorter");
    return path;
}

/// Refuses a key that no scene has. If the file has no value for it, this alone distinguishes it from an
/// omitted key.
void check_known(toml::table file, const std::string& name, const KeyPath& path) {
    put_value(file, path, 0.0);
    try {
        detail::scene_from(file, name);
    } catch (const detail::UnknownKey& error) {
        fail("{}", error.message());
    } catch (const SceneError&) {  // 0 is not allowed there
    }
}

VariationRule parse_rule(toml::table& file, const Scene& base, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos || equals == 0) fail("expected KEY=DISTRIBUTION, such as cue.speed=uniform(2,4)");
    VariationRule rule;
    rule.key = text.substr(0, equals);
    check_replaces_no_fit(base, rule.key);
    rule.path = find_path(file, rule.key, &base);
    const toml::node* const own = value_in(file, rule.path).node();
    if (own == nullptr) check_known(file, base.file, rule.path);
    rule.distribution = detail::parse_distribution(std::string_view(text).substr(equals + 1), own);
    return rule;
}

/// Whether a key of the file is a number of the scene on which nothing else depends. Noses, racks and balls
/// with their own size depend on the ball size, and the surface on the parts of the table.
bool is_number_alone(const KeyPath& path) {
    if (path.section == "cue" || path.section == "physics" || path.section == "stop") return true;
    return (path.section == "ball" || path.section == "balls") && path.name != "radius" &&
           path.name != "mass";
}

/// Finds the value of a rule in the scene itself.
void find_number(const Scene& scene, VariationRule& rule) {
    const std::string& name = rule.path.name;
    if (rule.path.section == "rack") {
        for (const Field<Rack>& f : kRackFields)
            if (name == f.key && (name == "gap" || name == "jitter" || name == "seed" || name == "angle_deg"))
                rule.rack = &f, rule.unit = f.range.unit;
        return;
    }
    try {
        const SceneNumber number(scene, rule.key);
        rule.unit = number.row().range.unit;
        if (is_number_alone(rule.path)) rule.number = number;
    } catch (const std::invalid_argument&) {  // a model, a list, or a mistake that shot() reports
    }
}

/// Sets a number of the rack; false if its section would refuse it.
bool put_in_rack(const Field<Rack>& row, const DrawnValue& value, Rack& rack) {
    const std::optional<double> number = exact_number(value);
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

double number_of(const DrawnValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return *number;
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    return std::get<const ListedValue*>(value)->number;
}

std::int64_t integer_of(const DrawnValue& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return *whole;
    const auto* const* item = std::get_if<const ListedValue*>(&value);
    return item != nullptr ? (*item)->integer : 0;
}

std::string text_of(const DrawnValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
    return std::get<const ListedValue*>(value)->text;
}

struct Variation::Parts {
    Parts(std::string file_name, toml::table content)
        : path(std::move(file_name)), file(std::move(content)) {}

    std::string path;
    toml::table file;
    Scene base;
    std::vector<VariationRule> rules;
    std::vector<std::string> keys;
    std::uint64_t seed = 0;
    std::uint64_t fingerprint = 0;
    std::uint64_t grid = 0;  // points of the product of all grids; 0: no grid
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
    // A rule that sets the aim or the speed replaces the player's words for it; otherwise they follow the
    // balls.
    const auto sets = [&rules](std::string_view key) {
        return std::any_of(rules.begin(), rules.end(),
                           [key](const std::string& rule) { return rule.starts_with(key); });
    };
    toml::table* cue = parts->file["cue"].as_table();
    const bool ball_speed = sets("cue.ball_speed=");
    if (cue != nullptr && ball_speed) cue->erase("speed");
    const bool words = cue != nullptr && std::any_of(detail::kAimKeys.begin(), detail::kAimKeys.end(),
                                                     [cue](auto key) { return cue->contains(key); });
    if (words && (sets("cue.aim_deg=") || sets("cue.speed=")))
        detail::write_aim(parts->file, *parts->base.cue, ball_speed);
    else if (words)
        parts->quick = false;
    Fnv print;
    print.add(content.str());
    print.add(seed);
    for (const std::string& text : rules) {
        try {
            VariationRule rule = parse_rule(parts->file, parts->base, text);
            for (const VariationRule& other : parts->rules)
                if (rule.path.overlaps(other.path)) fail("{} already varies this value", other.key);
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
            throw VariationError(rule->key + ": the grids have more than 2^53 points together; use fewer");
        parts->grid = rule->stride * steps;
    }
    parts_ = parts;
    // A mistyped key or a range without valid values spoils every shot: report it once, here.
    for (int i = 0; i < kVariationTrials; ++i)
        if (shot(static_cast<std::uint64_t>(i)).scene) return;
    throw VariationError(fmt::format("none of the first {} shots is a valid scene; shot 0: {}",
                                     kVariationTrials, shot(0).error));
}

std::string with_values(std::string_view text, const std::string& name, const std::vector<NewValue>& values) {
    toml::table file = detail::toml_from(text, name);
    for (const NewValue& value : values) {
        try {
            const KeyPath path = find_path(file, value.key);
            const toml::array list = detail::arguments("value", value.value);
            if (list.size() != 1) fail("expected one value, not {}", list.size());
            const ListItem item(list[0]);
            put_value(file, path, &item);
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

const std::string& Variation::unit(std::size_t key) const {
    return parts_->rules.at(key).unit;
}

std::uint64_t Variation::grid() const {
    return parts_->grid;
}

ValueKind Variation::kind(std::size_t key) const {
    return parts_->rules.at(key).distribution.kind;
}

std::uint64_t Variation::fingerprint() const {
    return parts_->fingerprint;
}

void Variation::draw(std::uint64_t index, std::span<DrawnValue> values) const {
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = parts_->rules[k].draw(parts_->seed, index);
}

VariedShot Variation::shot(std::uint64_t index) const {
    VariedShot shot;
    shot.values.resize(parts_->rules.size());
    draw(index, shot.values);
    toml::table file = parts_->file;
    for (std::size_t k = 0; k < shot.values.size(); ++k)
        put_value(file, parts_->rules[k].path, shot.values[k]);
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

std::optional<Change> Variation::put(std::span<const DrawnValue> values, Scene& scene) const {
    if (!parts_->quick) return std::nullopt;
    Change change = Change::kNumbers;
    std::optional<Rack> rack;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const VariationRule& rule = parts_->rules[k];
        if (rule.rack != nullptr) {
            if (!rack) rack = parts_->rack;
            if (!put_in_rack(*rule.rack, values[k], *rack)) return std::nullopt;
            continue;
        }
        const std::optional<double> number = exact_number(values[k]);
        if (!number || (rule.number->row().kind == Key::Kind::kInteger && !is_whole(values[k])))
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
