// docs/reference/scene_format.md and docs/reference/scene.schema.json against the reader: the same keys and
// the same defaults.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/scene.h"
#include "support/pages.h"
#include "support/scene_errors.h"

namespace carom {
namespace {

using Json = nlohmann::json;
using test::code;
using test::error_of;

// A section as a file opens it, and as the reader's messages name it.
struct Place {
    const char* open;
    const char* name;
};
const Place kSections[] = {{"[table]", "table"},
                           {"[[table.cushion]]", "table.cushion"},
                           {"[[table.jaw]]", "table.jaw"},
                           {"[[table.pocket]]", "table.pocket"},
                           {"[balls]", "balls"},
                           {"[[ball]]", "ball"},
                           {"[rack]", "rack"},
                           {"[cue]", "cue"},
                           {"[physics]", "physics"},
                           {"[effects]", "effects"},
                           {"[stop]", "stop"},
                           {"[render]", "render"}};

// The reader's message about an unknown key.
std::set<std::string> keys_of_reader(const Place& place) {
    const std::string message = error_of(std::string(place.open) + "\nno_such_key = 1\n");
    const std::string before = "the keys there are ";
    const std::size_t at = message.find(before);
    EXPECT_NE(at, std::string::npos) << message;
    std::set<std::string> keys;
    std::istringstream list(message.substr(at + before.size()));
    for (std::string key; std::getline(list, key, ',');) keys.insert(key.substr(key.find_first_not_of(' ')));
    return keys;
}

struct Row {
    std::vector<std::string> cells;
};

// The document's table rows under each heading "## [name]" or "## [[name]]".
std::map<std::string, std::vector<Row>> rows_of_document() {
    std::map<std::string, std::vector<Row>> rows;
    for (auto& [heading, list] : test::table_rows(test::read_source("docs/reference/scene_format.md"))) {
        std::string section;
        for (const char c : heading)
            if (c != '[' && c != ']') section += c;
        for (auto& row : list) rows[section].push_back({row});
    }
    return rows;
}

TEST(SceneDocs, DescribeExactlyTheKeysOfTheReader) {
    const auto rows = rows_of_document();
    for (const Place& place : kSections) {
        std::set<std::string> described;
        const std::string name = place.name;
        if (name.rfind("table.", 0) == 0) {
            bool here = false;  // a list's first row names the list
            for (const Row& row : rows.at("table")) {
                const auto list = code(row.cells[0]);
                if (!list.empty() || row.cells[0].find("list") != std::string::npos)
                    here = !list.empty() && list[0] == "[[" + name + "]]";
                if (here)
                    for (const std::string& key : code(row.cells[1])) described.insert(key);
            }
        } else if (name == "table") {
            described = {"preset", "cloth",          "bed",         "cushion", "jaw", "arc",
                         "pocket", "corner_pockets", "side_pockets"};
            for (const Key& key : kMeasureFields) described.insert(key.key);
        } else {
            for (const Row& row : rows.at(name)) {
                const auto keys = code(row.cells[0]);
                for (const std::string& key : keys) described.insert(key);
            }
        }
        std::set<std::string> read = keys_of_reader(place);
        EXPECT_EQ(described, read) << name;
    }
}

// A scene from a text, without source locations, which an extra line would move.
Scene without_places(const std::string& text) {
    Scene scene = parse_scene(text, "s.toml");
    for (BallStart& ball : scene.ball) ball.where = {};
    if (scene.cue) scene.cue->where = {};
    for (EffectOverride& effect : scene.effects) effect.where = {};
    return scene;
}

// An empty section and one with a key at its stated default must be the same scene.
void expect_default(const std::string& section, const std::string& key, const std::string& value) {
    std::string before, after;
    if (section == "rack")
        before = "[[ball]]\n[rack]\n";
    else if (section == "ball")
        before = "[[ball]]\n";
    else
        before = "[[ball]]\n[" + section + "]\n";
    if (section == "rack" && key == "count") before += "game = \"line\"\n";
    if (section == "rack" && key == "rows") before += "game = \"triangle\"\n";
    const std::string with = before + key + " = " + value + "\n";
    ASSERT_EQ(error_of(with), "") << section << "." << key << " = " << value;
    EXPECT_TRUE(without_places(with) == without_places(before)) << section << "." << key << " = " << value;
}

TEST(SceneDocs, DefaultsMatchTheReader) {
    int checked = 0;
    for (const auto& [section, rows] : rows_of_document()) {
        if (section == "effects" || section == "table") continue;
        for (const Row& row : rows) {
            const auto keys = code(row.cells[0]);
            if (keys.empty() || row.cells.size() < 2) continue;
            const std::string& cell = row.cells[1];
            const auto quoted = code(cell);
            const std::string value = quoted.empty() ? cell : quoted[0];
            const bool stated =
                !quoted.empty() || value.find_first_not_of("0123456789.e-") == std::string::npos;
            if (!stated || value == "-" || cell.rfind("as ", 0) == 0) continue;
            expect_default(section, keys[0], value);
            ++checked;
        }
    }
    EXPECT_GE(checked, 30);
}

TEST(SceneDocs, BallPresetsMatchTheReader) {
    const auto all = rows_of_document();
    int checked = 0;
    for (const Row& row : all.at("balls")) {
        const auto keys = code(row.cells[0]);
        if (keys.empty() || keys[0] == "preset") continue;
        const char* presets[] = {"pool", "snooker", "carom"};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::string base = std::string("[balls]\npreset = \"") + presets[k] + "\"\n";
            const auto quoted = code(row.cells[k + 1]);
            std::string value = quoted.empty() ? row.cells[k + 1] : quoted[0];
            if (value == "-") continue;
            if (value == "ball") value = "\"ball\"";
            EXPECT_TRUE(without_places(base + keys[0] + " = " + value + "\n[[ball]]\n") ==
                        without_places(base + "[[ball]]\n"))
                << presets[k] << " " << keys[0];
            ++checked;
        }
    }
    // Fourteen keys of three presets; one of them, the friction between balls, in either form.
    EXPECT_EQ(checked, 42);
}

TEST(SceneDocs, EffectsNameExistingKeys) {
    std::set<std::string> known;
    for (const Place& place : kSections)
        for (const std::string& key : keys_of_reader(place)) known.insert(key);
    std::vector<std::string> keywords;
    const auto all = rows_of_document();
    for (const Row& row : all.at("effects")) {
        const auto keyword = code(row.cells[0]);
        if (keyword.empty()) continue;
        keywords.push_back(keyword[0]);
        EXPECT_FALSE(code(row.cells[2]).empty()) << keyword[0];
        for (const std::string& key : code(row.cells[2]))
            EXPECT_TRUE(known.count(key)) << keyword[0] << ": " << key;
    }
    std::vector<std::string> table;
    for (const EffectInfo& effect : effect_table()) table.push_back(effect.keyword);
    EXPECT_EQ(keywords, table);
}

// The reader's message about an unknown choice: "...; use a, b or c".
std::set<std::string> choices_of_reader(const std::string& section, const std::string& key) {
    const std::string message =
        error_of("[" + section + "]\n" + key + " = \"no such choice\"\n[[ball]]\nposition = [0.3, 0.3]\n");
    const std::string before = "; use ", last = " or ";
    const std::size_t at = message.find(before), end = message.rfind(last);
    EXPECT_TRUE(at != std::string::npos && end != std::string::npos) << message;
    if (at == std::string::npos || end == std::string::npos) return {};
    std::set<std::string> choices{message.substr(end + last.size())};
    std::istringstream list(message.substr(at + before.size(), end - at - before.size()));
    for (std::string name; std::getline(list, name, ',');)
        choices.insert(name.substr(name.find_first_not_of(' ')));
    return choices;
}

// The JSON Schema has the reader's keys, accepts every default and choice, and describes all scenes.
TEST(SceneSchema, HasTheKeysDefaultsAndChoicesOfTheReader) {
    const Json schema = Json::parse(test::read_source("docs/reference/scene.schema.json"));
    for (const Place& place : kSections) {
        std::string name = place.name;
        Json object = schema.at("properties");
        if (name.rfind("table.", 0) == 0)
            object = object.at("table").at("properties").at(name.substr(6));
        else
            object = object.at(name);
        if (object.at("type") == "array") object = object.at("items");
        EXPECT_EQ(object.at("additionalProperties"), false) << name;
        std::set<std::string> keys;
        for (const auto& [key, value] : object.at("properties").items()) {
            keys.insert(key);
            const bool custom = name.rfind("table", 0) == 0;
            if (value.contains("default") && !custom) expect_default(name, key, value.at("default").dump());
            // The other rules of arcs test their side.
            if (!value.contains("enum") || name == "table.jaw") continue;
            EXPECT_EQ(value.at("enum").get<std::set<std::string>>(), choices_of_reader(name, key))
                << name << "." << key;
            for (const Json& choice : value.at("enum")) {
                const std::string head = name == "ball" ? "" : "[" + name + "]\n";
                // One choice needs another key.
                const char* needs = key == "march" ? "substeps = 100\n" : "";
                const std::string line = head + needs + key + " = " + choice.dump() + "\n";
                EXPECT_EQ(error_of(line + (name == "ball" ? "" : "[[ball]]\nposition = [0.3, 0.3]\n")), "")
                    << line;
            }
        }
        EXPECT_EQ(keys, keys_of_reader(place)) << name;
    }
}

// A number as TOML, with all its digits.
std::string digits(double x, bool integer) {
    std::ostringstream out;
    if (integer) {
        out << static_cast<long long>(x);
        return out.str();
    }
    out.precision(17);
    out << x;
    const std::string text = out.str();
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

// Whether the value is in range; other rules may still refuse it.
bool in_range(const std::string& head, const std::string& key, const std::string& value) {
    const std::string message = error_of(head + key + " = " + value + "\n");
    EXPECT_EQ(message.find("not valid TOML"), std::string::npos) << message;
    EXPECT_EQ(message.find("must be a number"), std::string::npos) << message;
    return message.find("is out of range") == std::string::npos;
}

// The lines that must precede a key for the reader to reach it.
std::string opening(const std::string& name, const std::string& key) {
    for (const Place& place : kSections) {
        if (name != place.name) continue;
        std::string head = std::string(place.open) + "\n";
        if (name == "rack" && key == "count") head += "game = \"line\"\n";
        if (name == "rack" && key == "rows") head += "game = \"triangle\"\n";
        if (name == "table.cushion" && key != "from") head += "from = [0, 0]\n";
        if (name == "table.cushion" && key == "height") head += "to = [1, 0]\n";
        if (name == "table.jaw" && key != "center") head += "center = [0, 0]\n";
        if (name == "table.jaw" && key != "center" && key != "radius") head += "radius = 1\n";
        if (name == "table.pocket" && key != "center") head += "center = [0, 0]\n";
        return name == "ball" ? head : "[[ball]]\n" + head;
    }
    return "";
}

// The value at a bound is accepted, the next one beyond is not; without a bound any is accepted. `wrap` turns
// a number into the key's value (for an array, only one element varies).
template <class Wrap>
void expect_range(const std::string& head, const std::string& key, const Json& range, Wrap wrap) {
    const bool integer = range.at("type") == "integer";
    const auto try_side = [&](const char* inclusive, const char* exclusive, double outwards) {
        const double far = integer ? 9.0e18 : 1e300;
        if (range.contains(inclusive) || range.contains(exclusive)) {
            const bool closed = range.contains(inclusive);
            const double bound = range.at(closed ? inclusive : exclusive).get<double>();
            const double inside =
                closed ? bound : (integer ? bound - outwards : std::nextafter(bound, -outwards * far));
            const double outside =
                closed ? (integer ? bound + outwards : std::nextafter(bound, outwards * far)) : bound;
            EXPECT_TRUE(in_range(head, key, wrap(digits(inside, integer))))
                << key << " = " << digits(inside, integer);
            EXPECT_FALSE(in_range(head, key, wrap(digits(outside, integer))))
                << key << " = " << digits(outside, integer);
        } else {
            EXPECT_TRUE(in_range(head, key, wrap(digits(outwards * far, integer))))
                << head << key << " has a bound that the schema does not state";
        }
    };
    try_side("minimum", "exclusiveMinimum", -1.0);
    try_side("maximum", "exclusiveMaximum", 1.0);
}

TEST(SceneSchema, RangesMatchTheReader) {
    const Json schema = Json::parse(test::read_source("docs/reference/scene.schema.json"));
    int numbers = 0, arrays = 0;
    for (const Place& place : kSections) {
        const std::string name = place.name;
        Json object = schema.at("properties");
        if (name.rfind("table.", 0) == 0)
            object = object.at("table").at("properties").at(name.substr(6));
        else
            object = object.at(name);
        if (object.at("type") == "array") object = object.at("items");
        for (const auto& [key, value] : object.at("properties").items()) {
            // A number that may have a unit may also be a string.
            const nlohmann::json& types = value.at("type");
            const std::string head = opening(name, key), type = types.is_array() ? types[0] : types;
            if (type == "number" || type == "integer") {
                expect_range(head, key, value, [](const std::string& x) { return x; });
                ++numbers;
            }
            if (type != "array" || !value.at("items").contains("type") || name == "table") continue;
            const Json& item = value.at("items");
            // A velocity's last number may be omitted.
            const std::size_t count = value.at("maxItems"), least = value.at("minItems");
            EXPECT_EQ(least, count - (key == "velocity" ? 1 : 0)) << key;
            for (std::size_t k = 0; k < count; ++k) {
                expect_range(head, key, item, [&](const std::string& x) {
                    std::string text = "[";
                    for (std::size_t j = 0; j < count; ++j)
                        text += (j ? ", " : "") + (j == k ? x : std::string("1"));
                    return text + "]";
                });
            }
            for (const std::size_t wrong : {least - 1, count + 1}) {
                std::string text = "[";
                for (std::size_t j = 0; j < wrong; ++j) text += j ? ", 1" : "1";
                EXPECT_NE(error_of(head + key + " = " + text + "]\n").find(" values; write "),
                          std::string::npos)
                    << key;
            }
            ++arrays;
        }
    }
    EXPECT_GE(numbers, 31);
    EXPECT_GE(arrays, 12);
    const Json& id = schema.at("properties").at("ball").at("items").at("properties").at("id");
    const auto with_id = [](std::size_t length) {
        return error_of("[[ball]]\nid = \"" + std::string(length, 'x') + "\"\n");
    };
    EXPECT_EQ(with_id(id.at("minLength")), "");
    EXPECT_EQ(with_id(id.at("maxLength")), "");
    EXPECT_NE(with_id(id.at("minLength").get<std::size_t>() - 1), "");
    EXPECT_NE(with_id(id.at("maxLength").get<std::size_t>() + 1), "");
}

}  // namespace
}  // namespace carom
