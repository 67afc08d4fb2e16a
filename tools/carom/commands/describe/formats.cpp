#include "commands/describe/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom::tools {
namespace {

using Json = nlohmann::ordered_json;

/// [bytes] Longest text in a record file.
constexpr int kLongestText = 256;

bool is_list(const Key& key) {
    return key.kind == Key::Kind::kNumbers || key.kind == Key::Kind::kIntegers;
}

bool is_whole(const Key& key) {
    return key.kind == Key::Kind::kInteger || key.kind == Key::Kind::kIntegers;
}

/// Removes the marks of Markdown.
std::string plain(std::string text) {
    text.erase(std::remove(text.begin(), text.end(), '`'), text.end());
    return text;
}

std::string description(const Key& key) {
    std::string text = is_list(key) ? fmt::format("{}: {}", key.options.shape, key.meaning) : key.meaning;
    if (*key.range.unit) text += fmt::format(", {}", key.range.unit);
    if (key.options.instead_of) text += fmt::format("; instead of {}", key.options.instead_of);
    if (key.options.standard) text += fmt::format("; default: {}", key.options.standard);
    return plain(text);
}

/// A bound of integers as an integer.
Json bound(const Key& key, double x) {
    return is_whole(key) ? Json(static_cast<std::int64_t>(x)) : Json(x);
}

/// Only the sign of a record's numbers is checked, except for integers.
Json number_schema(const Key& key, Files files) {
    Json schema = {{"type", is_whole(key) ? "integer" : "number"}};
    // "57.15 mm" is a number, too.
    const std::string_view unit = key.range.unit;
    const bool has_units = unit == "m" || unit == "m/s" || unit == "kg" || unit == "s" || unit == "degrees";
    if (files == Files::kScene && !is_whole(key) && has_units) schema["type"] = {"number", "string"};
    const Interval& range = key.range;
    const bool signs_only = files == Files::kRecord && !is_whole(key);
    const bool open = signs_only ? range.low > 0.0 || range.low_open : range.low_open;
    if (!signs_only || range.low >= 0.0)
        schema[open ? "exclusiveMinimum" : "minimum"] = bound(key, signs_only ? 0.0 : range.low);
    if (!signs_only && range.high < kAnyInteger)
        schema[range.high_open ? "exclusiveMaximum" : "maximum"] = bound(key, range.high);
    return schema;
}

Json value_schema(const Key& key, Files files) {
    if (is_list(key))
        return {{"type", "array"},
                {"items", number_schema(key, files)},
                {"minItems", key.count() - (key.options.last_may_lack ? 1 : 0)},
                {"maxItems", key.count()}};
    if (key.kind != Key::Kind::kText) return number_schema(key, files);
    if (files == Files::kRecord) return {{"type", "string"}, {"maxLength", kLongestText}};
    if (!key.names().empty() && key.names()[0] == std::string_view("true")) return {{"type", "boolean"}};
    if (!key.names().empty()) return {{"type", "string"}, {"enum", key.names()}};
    if (key.range.high == 0.0) return {{"type", "string"}};
    return {{"type", "string"}, {"minLength", key.range.low}, {"maxLength", key.range.high}};
}

Json json_of(const FieldValue& value) {
    return std::visit(
        [](const auto& v) {
            if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
                return Json();
            else
                return Json(v);
        },
        value);
}

/// The properties of some rows; in a scene file, with the defaults in `standard`.
template <class T, std::size_t kRows>
void add_properties(Json& object, const Field<T> (&fields)[kRows], const T& standard, Files files) {
    for (const Field<T>& f : fields) {
        if (!f.in(files)) continue;
        const char* key = files == Files::kRecord ? f.record_key() : f.key;
        Json schema = value_schema(f, files);
        const FieldValue value = f.value(standard);
        const bool stated = files == Files::kScene && !f.options.needed && !f.options.standard;
        if (stated && is_written(fields, f, standard)) schema["default"] = json_of(value);
        schema["description"] = description(f);
        object["properties"][key] = schema;
        if (files == Files::kRecord ? !f.optional : f.options.needed) object["required"].push_back(key);
    }
}

Json object_schema() {
    return {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
}

template <class T, std::size_t kRows>
Json object_of(const Field<T> (&fields)[kRows], const T& standard, Files files) {
    Json object = object_schema();
    add_properties(object, fields, standard, files);
    return object;
}

Json list_of(const Json& items, int most) {
    return {{"type", "array"}, {"items", items}, {"maxItems", most}};
}

/// The shortest text. Powers of ten from 10 000 up, and numbers that fmt writes with an exponent, have one
/// without zeros.
std::string text_of(double x) {
    std::string text = fmt::format("{}", x);
    const std::size_t zeros = text.find("0000"), one = text.find('1');
    if (zeros != text.npos && zeros == one + 1 && x == std::floor(x))
        return fmt::format("{}e{}", text.substr(0, zeros), text.size() - zeros);
    const std::size_t at = text.find("e-0");
    return at == text.npos ? text : text.erase(at + 2, 1);
}

std::string code(const std::string& text) {
    return "`" + text + "`";
}

std::string default_text(const Key& key, const FieldValue& value) {
    if (key.options.needed) return "needed";
    if (key.options.standard) return key.options.standard;
    if (value.index() == 0) return "-";
    if (const auto* number = std::get_if<double>(&value)) return text_of(*number);
    const auto* list = std::get_if<std::vector<double>>(&value);
    if (!list) return key.kind == Key::Kind::kText ? code(json_of(value).dump()) : json_of(value).dump();
    std::string text;
    for (const double x : *list) text += (text.empty() ? "" : ", ") + text_of(x);
    return code("[" + text + "]");
}

/// The values a key accepts: the names of a choice, or a range.
std::string values_text(const Key& key) {
    std::string text;
    const std::vector<const char*> names = key.names();
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + code(names[i]);
    const Interval& range = key.range;
    if (range.low == range.high) return text;
    if (is_list(key)) text = code(key.options.shape) + ", each ";
    if (!(range.high < kAnyInteger)) return text + "integer from " + text_of(range.low);
    text += fmt::format("{}{} to {}{}", range.low_open ? "more than " : "", text_of(range.low),
                        range.high_open ? "less than " : "", text_of(range.high));
    return *range.unit ? fmt::format("{} {}", text, range.unit) : text;
}

std::string meaning_text(const Key& key) {
    return key.options.instead_of
               ? fmt::format("{}; instead of {}", key.meaning, code(key.options.instead_of))
               : key.meaning;
}

std::string line_of(const Key& key, const std::string& standard) {
    return fmt::format("| {} | {} | {} | {} |\n", code(key.key), standard, values_text(key),
                       meaning_text(key));
}

/// The rows of a table, one line each; the first of a list's parts is preceded by the list's name.
template <class T, std::size_t kRows>
std::string lines_of(const Field<T> (&fields)[kRows], const T& standard, const char* list = nullptr) {
    std::string text;
    for (const Field<T>& f : fields) {
        if (!f.in(Files::kScene)) continue;
        if (list) text += fmt::format("| {} ", text.empty() ? list : "");
        text += line_of(f, default_text(f, list ? FieldValue() : f.value(standard)));
    }
    return text;
}

std::string balls_lines() {
    std::string text = line_of(kBallPresetFields[0], "`\"pool\"` | `\"snooker\"` | `\"carom\"`");
    for (const Field<BallParams>& f : kBallFields) {
        if (!f.in(Files::kScene)) continue;
        std::vector<std::string> standards;
        for (const char* preset : {"pool", "snooker", "carom"}) {
            const BallParams balls = make_ball_params(preset);
            standards.push_back(
                default_text(f, is_written(kBallFields, f, balls) ? f.value(balls) : FieldValue()));
        }
        text += line_of(f, fmt::format("{}", fmt::join(standards, " | ")));
    }
    text += line_of(kRackedBallFields[0], "0 | 0 | 0");
    text += "| `cue` | - | - | - | `radius`, `mass` as of a ball | `[balls.cue]`: size of the cue ball |\n";
    return text;
}

std::string effects_lines() {
    std::string text;
    for (const EffectInfo& effect : effect_table())
        text += fmt::format("| {} | {} | {} |\n", code(effect.keyword), effect.skipped_when, effect.keys);
    return text;
}

/// A file that the build embedded in the program.
std::string built_in(std::string_view name) {
    for (const PageFile& file : describe_files())
        if (file.name == name) return file.text;
    throw std::logic_error(fmt::format("{} is not in the program", name));
}

/// Replaces the table between the marks of this name in a page.
void put_table(std::string& page, const char* name, const char* header, const std::string& lines) {
    const std::string begin = fmt::format("<!-- begin {} -->\n", name),
                      end = fmt::format("<!-- end {} -->", name);
    const std::size_t from = page.find(begin), to = page.find(end);
    if (from == page.npos || to == page.npos || to < from)
        throw std::logic_error(fmt::format("the page has no marks for the table {}", name));
    std::string rule = "|";
    for (std::size_t i = 1; header[i] != '\0'; ++i)
        if (header[i] == '|') rule += "---|";
    const std::size_t first = from + begin.size();
    page.replace(first, to - first, fmt::format("{}\n{}\n{}", header, rule, lines));
}

}  // namespace

std::string scene_schema() {
    constexpr Files kScene = Files::kScene;
    Json table = object_of(kTableFields, make_table(kStandardTable), kScene);
    table["properties"]["cushion"] = list_of(object_of(kCushionFields, {}, kScene), kMaxTableParts);
    table["properties"]["jaw"] = list_of(object_of(kJawFields, {}, kScene), kMaxTableParts);
    table["properties"]["arc"] = list_of(object_of(kJawFields, {}, kScene), kMaxTableParts);
    table["properties"]["pocket"] = list_of(object_of(kPocketFields, {}, kScene), kMaxTableParts);
    add_properties(table, kMeasureFields, Measures{}, kScene);
    for (const PocketSection& of : kPocketSections)
        table["properties"][of.key] = object_of(kPocketMeasureFields, PocketMeasures{}, kScene);
    Json balls = object_of(kBallPresetFields, Scene{}, kScene);
    add_properties(balls, kBallFields, make_ball_params(Scene{}.ball_preset), kScene);
    add_properties(balls, kRackedBallFields, Rack{}, kScene);
    balls["properties"]["cue"] = object_of(kSizeFields, {}, kScene);
    Json ball = object_of(kBallStartFields, BallStart{}, kScene);
    add_properties(ball, kSizeFields, {}, kScene);
    Json effects = object_schema();
    for (const EffectInfo& effect : effect_table())
        effects["properties"][effect.keyword] = {
            {"type", "boolean"}, {"description", "force it into the plan (true) or out of it (false)"}};
    Json cue = object_of(kCueFields, Cue{}, kScene);
    const Json pair = {{"type", "array"}, {"items", Json::object()}, {"minItems", 2}, {"maxItems", 2}};
    const auto described = [](Json value, const char* what) {
        value["description"] = what;
        return value;
    };
    Json& aims = cue["properties"];
    aims["aim_at"] =
        described(Json{{"type", {"string", "array"}}}, "a ball's id, or [x, y] in m, in place of aim_deg");
    aims["aim_hit"] = described(pair, "[\"1\", 0.75]: how full ball 1 is hit, negative for its right half");
    aims["ghost"] = described(pair, "[\"1\", \"p3\"]: ball 1 towards the middle of the pocket");
    aims["aim_diamond"] = described(pair, "[\"foot\", 2.5]: a place on the head, foot, left or right rail");
    aims["ball_speed"] =
        described(Json{{"type", {"number", "string"}}, {"minimum", 0}, {"maximum", kMaxSpeed}},
                  "of the struck ball, in place of speed [m/s]");
    Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "carom scene"}};
    schema.update(object_schema());
    schema["properties"] = {{"table", table},
                            {"balls", balls},
                            {"rack", object_of(kRackFields, Rack{}, kScene)},
                            {"ball", list_of(ball, kMaxBalls)},
                            {"cue", cue},
                            {"physics", object_of(kPhysicsFields, Physics{}, kScene)},
                            {"effects", effects},
                            {"stop", object_of(kStopFields, Stop{}, kScene)},
                            {"render", object_of(kRenderFields, RenderSettings{}, kScene)}};
    return schema.dump(2) + "\n";
}

std::string record_schema() {
    constexpr Files kRecord = Files::kRecord;
    Json table = object_of(kTableFields, carom::Table{}, kRecord);
    add_properties(table, kMeasureFields, Measures{}, kRecord);
    for (const PocketSection& of : kPocketSections)
        table["properties"][of.key] = object_of(kPocketMeasureFields, PocketMeasures{}, kRecord);
    for (const auto& [list, part, meaning] : {std::array{"cushions", "cushion", "straight noses"},
                                              {"jaws", "jaw", "round noses"},
                                              {"pockets", "pocket", "where balls fall"}}) {
        table["properties"][list] = {{"type", "array"},
                                     {"items", {{"$ref", fmt::format("#/definitions/{}", part)}}},
                                     {"description", meaning}};
        table["required"].push_back(list);
    }
    Json render = object_of(kRenderFields, RenderSettings{}, kRecord);
    render["dependencies"] = {{"eye", {"target"}}, {"target", {"eye"}}};
    const Json size = object_of(kSizeFields, BallSize{}, kRecord)["properties"];
    const Json parts = {{"/properties/render", render},
                        {"/properties/table", table},
                        {"/properties/balls", object_of(kBallFields, BallParams{}, kRecord)},
                        {"/definitions/cushion", object_of(kCushionFields, {}, kRecord)},
                        {"/definitions/jaw", object_of(kJawFields, {}, kRecord)},
                        {"/definitions/pocket", object_of(kPocketFields, {}, kRecord)},
                        {"/definitions/track/properties/radius", size["radius"]},
                        {"/definitions/track/properties/mass", size["mass"]}};
    Json schema = Json::parse(built_in("record.schema.json"));
    for (const auto& [pointer, part] : parts.items()) schema.at(Json::json_pointer(pointer)) = part;
    return schema.dump(2) + "\n";
}

std::string scene_format() {
    constexpr const char* kHeader = "| key | default | values | meaning |";
    std::string page = built_in("scene_format.md");
    put_table(page, "table", kHeader,
              lines_of(kTableFields, make_table(kStandardTable)) + lines_of(kMeasureFields, Measures{}));
    put_table(page, "measures", kHeader, lines_of(kPocketMeasureFields, PocketMeasures{}));
    put_table(page, "outline", "| list | key | default | values | meaning |",
              lines_of(kCushionFields, {}, "`[[table.cushion]]`") +
                  lines_of(kJawFields, {}, "`[[table.jaw]]`, `[[table.arc]]`") +
                  lines_of(kPocketFields, {}, "`[[table.pocket]]`"));
    put_table(page, "balls", "| key | pool (default) | snooker | carom | values | meaning |", balls_lines());
    put_table(page, "ball", kHeader,
              lines_of(kBallStartFields, BallStart{}) + lines_of(kSizeFields, BallSize{}));
    put_table(page, "rack", kHeader, lines_of(kRackFields, Rack{}));
    put_table(page, "cue", kHeader, lines_of(kCueFields, Cue{}));
    put_table(page, "physics", kHeader, lines_of(kPhysicsFields, Physics{}));
    put_table(page, "effects", "| key | skipped when | keys it belongs to |", effects_lines());
    put_table(page, "stop", kHeader, lines_of(kStopFields, Stop{}));
    put_table(page, "render", kHeader, lines_of(kRenderFields, RenderSettings{}));
    return page;
}

}  // namespace carom::tools
