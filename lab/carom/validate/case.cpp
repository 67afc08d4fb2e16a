#include "validate/case.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <initializer_list>
#include <span>
#include <stdexcept>

#include "base/console.h"
#include "base/toml_number.h"
#include "carom/engine/scene.h"

namespace carom::tools {
namespace {

SourceLocation place_of(const toml::source_region& region) {
    return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

/// One table of a case file. Every key must be known and have the right type.
class Reader {
  public:
    Reader(const toml::table& table, const std::string& file, std::initializer_list<std::string_view> keys)
        : table_(table), file_(file) {
        for (auto&& [key, value] : table)
            if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
                fail(value,
                     fmt::format("unknown key {}; the keys here are {}", key.str(), fmt::join(keys, ", ")));
    }

    [[noreturn]] void fail(const toml::node& at, const std::string& what) const {
        throw SceneError(file_, place_of(at.source()), what);
    }
    [[noreturn]] void fail(const std::string& what) const { fail(table_, what); }
    bool has(std::string_view key) const { return table_.contains(key); }

    template <class T>
    T value(std::string_view key) const {
        const toml::node* node = table_.get(key);
        if (node == nullptr) fail(fmt::format("{} is missing", key));
        if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) return number<T>(*node, key);
        const auto found = node->value<T>();
        if (!found) fail(*node, fmt::format("{} has a value of another kind", key));
        return *found;
    }
    /// A number of this type; `what` names it in messages.
    template <class T>
    T number(const toml::node& node, std::string_view what) const {
        try {
            if constexpr (std::is_floating_point_v<T>) return detail::number_in(node);
            constexpr bool kLong = sizeof(T) >= sizeof(std::int64_t);
            return static_cast<T>(
                detail::integer_in(node, std::is_signed_v<T> ? INT32_MIN : 0, kLong ? INT64_MAX : INT32_MAX));
        } catch (const std::invalid_argument& error) {
            fail(node, fmt::format("{} {}", what, error.what()));
        }
    }
    template <class T>
    T value(std::string_view key, T otherwise) const {
        return has(key) ? value<T>(key) : std::move(otherwise);
    }
    /// The index of the value in an enumeration's names.
    template <class Enum>
    Enum one_of(std::string_view key, std::span<const char* const> names) const {
        const auto text = value<std::string>(key);
        const auto found = std::find(names.begin(), names.end(), text);
        if (found == names.end())
            fail(*table_.get(key), fmt::format("{} is none of {}", text, fmt::join(names, ", ")));
        return static_cast<Enum>(found - names.begin());
    }
    const toml::array& list(std::string_view key) const {
        const toml::array* array = table_[key].as_array();
        if (array == nullptr || array->empty())
            fail(fmt::format("{} has to be a list that is not empty", key));
        return *array;
    }
    std::vector<std::string> texts(std::string_view key) const {
        std::vector<std::string> all;
        if (!has(key)) return all;
        for (const toml::node& node : list(key)) {
            if (!node.is_string()) fail(node, fmt::format("{} is a list of texts", key));
            all.push_back(*node.value<std::string>());
        }
        return all;
    }
    /// Calls `each` with every table of a list.
    template <class Each>
    void tables(std::string_view key, const Each& each) const {
        for (const toml::node& node : list(key)) {
            if (!node.is_table()) fail(node, fmt::format("{} is a list of tables", key));
            each(*node.as_table());
        }
    }
    const toml::table* table(std::string_view key) const {
        if (has(key) && !table_[key].is_table()) fail(*table_.get(key), fmt::format("{} is a table", key));
        return table_[key].as_table();
    }

  private:
    const toml::table& table_;
    const std::string& file_;
};

Measured read_measured(const toml::table& table, const std::string& file) {
    std::vector<const char*> names;
    for (const QuantityInfo& quantity : kQuantities) names.push_back(quantity.name);
    const Reader in(table, file,
                    {"quantity", "when", "after", "ball", "value", "uncertainty", "place", "kind", "name",
                     "of", "among", "note"});
    Measured m;
    m.quantity = in.one_of<Quantity>("quantity", names);
    const bool many = is_of_many(m.quantity), place = m.quantity == Quantity::kPlace;
    if (!many) m.when = in.one_of<Instant>("when", kInstants);
    m.after = in.value("after", 0.0);
    m.ball = in.value("ball", std::string("cue"));
    m.uncertainty = in.value<double>("uncertainty");
    if (!(m.uncertainty > 0.0)) in.fail("uncertainty has to be greater than 0");
    if (place) {
        const toml::array& xy = in.list("place");
        if (xy.size() != 2) in.fail(xy, "place is [x, y]");
        m.place = {in.number<double>(xy[0], "x of a place"), in.number<double>(xy[1], "y of a place")};
    } else {
        m.value = in.value<double>("value");
    }
    if (in.has("kind")) m.kind = kKinds[in.one_of<std::size_t>("kind", kKinds)];
    m.name = in.value("name", std::string());
    if (many) m.of = in.value<std::string>("of");
    m.among = in.value("among", std::string());
    m.note = in.value("note", std::string());
    return m;
}

ValidationShot read_validation_shot(const toml::table& table, const std::string& file) {
    const Reader in(table, file, {"name", "group", "values", "measured"});
    ValidationShot shot;
    shot.name = in.value<std::string>("name");
    shot.group = in.value("group", std::string());
    if (const toml::table* values = in.table("values"))
        for (auto&& [key, node] : *values) {
            const auto text = node.value<std::string>();
            shot.values.emplace_back(key.str(),
                                     text ? *text : fmt::format("{}", in.number<double>(node, key.str())));
        }
    in.tables("measured",
              [&](const toml::table& each) { shot.measured.push_back(read_measured(each, file)); });
    return shot;
}

Variant read_variant(const toml::table& table, const std::string& file) {
    const Reader in(table, file, {"name", "preset", "keys", "physics", "free_of_fit", "claims"});
    Variant variant;
    variant.preset = in.value<std::string>("preset");
    variant.name = in.value("name", variant.preset);
    variant.keys = in.value("keys", std::string());
    variant.physics = in.value("physics", std::string());
    variant.free_of_fit = in.value<bool>("free_of_fit");
    for (const toml::node& node : in.list("claims")) {
        if (node.is_number())
            variant.claims.emplace_back(in.number<double>(node, "a claim"));
        else if (node.value_or(std::string()) == "within")
            variant.claims.emplace_back(std::nullopt);
        else
            in.fail(node, "a claim is \"within\" or the value that is computed");
    }
    return variant;
}

/// Every number needs a claim; for a share or a mean, the claim is a value.
void check_claims(const ValidationCase& c, const Variant& variant, const SourceLocation& where) {
    std::size_t at = 0;
    for (const ValidationShot& shot : c.shots)
        for (const Measured& m : shot.measured) {
            if (is_of_many(m.quantity) != c.sweep.has_value())
                throw SceneError(c.file, where,
                                 "a share or a mean needs [sweep], and other quantities are of one shot");
            if (at < variant.claims.size() && c.sweep && !variant.claims[at])
                throw SceneError(c.file, where,
                                 "the claim of a share or a mean is the value that is computed");
            ++at;
        }
    if (at != variant.claims.size())
        throw SceneError(c.file, where, fmt::format("{} claims for {} numbers", variant.claims.size(), at));
}

}  // namespace

std::string Variant::own_keys() const {
    std::string text;
    for (const std::string* lines : {&keys, &physics})
        for (std::size_t at = 0; at < lines->size();) {
            const std::size_t end = std::min(lines->find('\n', at), lines->size());
            if (end > at) text += (text.empty() ? "" : ", ") + lines->substr(at, end - at);
            at = end + 1;
        }
    return text;
}

ValidationCase read_case(const CaseFile& file) {
    toml::table root;
    const std::string name(file.name);
    try {
        root = toml::parse(file.text, name);
    } catch (const toml::parse_error& error) {
        throw SceneError(name, place_of(error.source()), std::string(error.description()));
    }
    ValidationCase c;
    c.file = name;
    const Reader in(
        root, c.file,
        {"id", "title", "source", "trust", "note", "about", "scene", "sweep", "plot", "shot", "variant"});
    c.id = in.value<std::string>("id");
    c.title = in.value<std::string>("title");
    c.source = in.value<std::string>("source");
    c.trust = kTrust[in.one_of<std::size_t>("trust", kTrust)];
    c.note = in.value("note", std::string());
    c.about = in.one_of<About>("about", kAbout);
    c.scene = in.value<std::string>("scene");
    if (const toml::table* table = in.table("sweep")) {
        const Reader sweep(*table, c.file, {"count", "seed", "vary"});
        c.sweep =
            CaseSweep{sweep.value<int>("count"), sweep.value<std::uint64_t>("seed"), sweep.texts("vary")};
    }
    if (const toml::table* table = in.table("plot")) {
        const Reader plot(*table, c.file, {"x", "over", "x_title", "y_title"});
        c.plot = CasePlot{plot.value("x", std::string()), plot.value("over", std::string()),
                          plot.value<std::string>("x_title"), plot.value<std::string>("y_title")};
    }
    in.tables("shot",
              [&](const toml::table& each) { c.shots.push_back(read_validation_shot(each, c.file)); });
    for (ValidationShot& shot : c.shots)
        for (Measured& m : shot.measured)
            if (m.kind.empty()) m.kind = kKinds[c.trust == kTrust[0] ? 0 : 1];
    in.tables("variant", [&](const toml::table& each) {
        c.variants.push_back(read_variant(each, c.file));
        check_claims(c, c.variants.back(), place_of(each.source()));
    });
    return c;
}

std::vector<ValidationCase> chosen_cases(const std::string& id) {
    std::vector<ValidationCase> all;
    for (const CaseFile& file : case_files()) all.push_back(read_case(file));
    if (id.empty()) return all;
    std::vector<std::string> ids;
    for (ValidationCase& c : all) {
        if (c.id == id) return {std::move(c)};
        ids.push_back(c.id);
    }
    throw UsageError(
        fmt::format("validate: there is no case {}; the cases are {}", id, fmt::join(ids, ", ")));
}

std::string filled_in(const ValidationCase& of, const ValidationShot& shot, const Variant& variant,
                      const std::string& text) {
    std::string out;
    for (std::size_t at = 0;;) {
        const std::size_t open = text.find('{', at), close = text.find('}', open);
        out += text.substr(at, open - at);
        if (open == text.npos || close == text.npos) return out;
        const std::string name = text.substr(open + 1, close - open - 1);
        const auto found = std::find_if(shot.values.begin(), shot.values.end(),
                                        [&name](const auto& value) { return value.first == name; });
        if (found != shot.values.end())
            out += found->second;
        else if (name == "preset")
            out += variant.preset;
        else if (name == "keys")
            out += variant.keys;
        else if (name == "physics")
            out += variant.physics;
        else
            throw SceneError(of.file, {}, fmt::format("{}: {{{}}} has no value", shot.name, name));
        at = close + 1;
    }
}

}  // namespace carom::tools
