// Every member of a struct that a scene describes has a row, or is listed here as absent from files: a new
// member breaks the build until it is one or the other.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "carom/engine/scene.h"
#include "scene/sections.h"

namespace carom {

/// Converts to any type in an initializer.
struct Anything {
    template <class T>
    requires(!detail::kIsOptional<T>) operator T() const;  // NOLINT: an implicit conversion is the purpose
};

namespace {

template <class T, std::size_t... kFirst, std::size_t... kOptional>
constexpr bool has_members(std::index_sequence<kFirst...>, std::index_sequence<kOptional...>) {
    return requires {
        T{(void(kFirst), Anything())..., (void(kOptional), std::nullopt)...};
    };
}

/// Number of members of an aggregate. Optional Eigen vectors and texts must come last, and their number must
/// be given.
template <class T, std::size_t kOptional = 0, std::size_t kMost = 24>
constexpr std::size_t members() {
    if constexpr (has_members<T>(std::make_index_sequence<kMost>(), std::make_index_sequence<kOptional>()))
        return kMost + kOptional;
    else
        return members<T, kOptional, kMost - 1>();
}

template <class T, std::size_t kRows>
constexpr std::size_t in_rows(const Field<T> (&fields)[kRows]) {
    std::size_t count = 0;
    for (const Field<T>& f : fields) count += static_cast<std::size_t>(f.members);
    return count;
}

static_assert(members<BallSize>() == in_rows(kSizeFields));
static_assert(members<BallParams>() == in_rows(kBallFields));
static_assert(members<BallStart>() == in_rows(kBallStartFields) + 2);  // where; own: kSizeFields
static_assert(members<Rack, 2>() == in_rows(kRackFields) + in_rows(kRackedBallFields));
static_assert(members<Cue>() == in_rows(kCueFields) + 1);  // where
static_assert(members<Physics>() == in_rows(kPhysicsFields));
static_assert(members<Stop>() == in_rows(kStopFields));
static_assert(members<RenderSettings, 3>() == in_rows(kRenderFields));
static_assert(members<Cushion>() == in_rows(kCushionFields));
static_assert(members<Jaw>() == in_rows(kJawFields));
static_assert(members<Pocket>() == in_rows(kPocketFields));
static_assert(members<Table, 1>() == in_rows(kTableFields) + 4);  // the lists; measures
static_assert(members<PocketMeasures>() == in_rows(kPocketMeasureFields));
static_assert(members<Measures, 1>() == in_rows(kMeasureFields) + 2);  // both kinds of pocket

TEST(Rows, KeysOfASectionDiffer) {
    const auto expect_distinct = [](const auto& fields) {
        for (const Files files : {Files::kScene, Files::kRecord}) {
            const auto keys = keys_of(fields, files);
            EXPECT_EQ(std::set(keys.begin(), keys.end()).size(), keys.size());
        }
    };
    expect_distinct(kBallFields);
    expect_distinct(kBallStartFields);
    expect_distinct(kRackFields);
    expect_distinct(kCueFields);
    expect_distinct(kPhysicsFields);
    expect_distinct(kRenderFields);
    expect_distinct(kTableFields);
    expect_distinct(kPocketMeasureFields);
}

/// Values to try for a key: the first allowed one that is not the default shows that the key is read.
std::vector<FieldValue> values_for(const Key& row) {
    std::vector<FieldValue> values;
    for (const char* name : row.names()) values.emplace_back(std::string(name));
    if (row.kind == Key::Kind::kText) values.insert(values.end(), {std::string("1"), std::string("#1d6a54")});
    for (const double x : {0.3, 0.031, 0.9, 0.01, 1e-4, 1e-7, 0.11, 3.0, 30.0, 140.0, 640.0}) {
        std::vector<double> list(*row.options.shape != '\0' ? row.count() : 0);
        for (std::size_t k = 0; k < list.size(); ++k) list[k] = x * static_cast<double>(1 + k);
        if (row.kind == Key::Kind::kNumber) values.emplace_back(x);
        if (row.kind == Key::Kind::kInteger && x >= 1.0) values.emplace_back(static_cast<std::int64_t>(x));
        if (row.kind == Key::Kind::kNumbers || (row.kind == Key::Kind::kIntegers && x >= 1.0))
            values.emplace_back(list);
    }
    return values;
}

std::string toml_of(const FieldValue& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return '"' + *text + '"';
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
    return fmt::format("[{}]", fmt::join(std::get<std::vector<double>>(value), ", "));
}

/// Lines that a key also needs.
std::string beside(const std::string& key) {
    if (key == "[rack] count") return "game = \"line\"\n";
    if (key == "[rack] rows") return "game = \"triangle\"\n";
    if (key == "[physics] march") return "substeps = 1000\n";
    if (key == "[render] eye") return "target = [0, 0, 0]\n";
    if (key == "[render] target") return "eye = [5, 5, 5]\n";
    if (key == "[balls] rolls") return "mu_b = 0\nf_c = 0\ne_h = 0\n";
    if (key == "[[table.arc]] side") return "from_deg = 180\nto_deg = 190\n";
    return "";
}

/// Every row of a section is read from a file. @param of  returns the object with the rows, given the file
template <class T, std::size_t kRows, class Of>
void expect_read(const Field<T> (&rows)[kRows], const std::string& section, Of of,
                 const std::string& before = "[[ball]]\n") {
    for (const Field<T>& row : rows) {
        if (!row.in(Files::kScene)) continue;
        std::string text = before + section + "\n", why;
        for (std::size_t k = 0; k < kRows; ++k)
            if (rows[k].options.needed && rows[k].key != row.key)
                text += std::string(rows[k].key) + " = " + toml_of(values_for(rows[k])[k]) + "\n";
        const auto is_read = [&](const FieldValue& value) {
            const std::string line = row.key + (" = " + toml_of(value)) + "\n";
            try {
                if (row.value(of(text + beside(section + " " + row.key) + line)) != value) return false;
                return row.options.needed || row.value(of(text)) != value;
            } catch (const SceneError& error) {
                why = error.what() + ("\n" + text + line);
                return false;
            }
        };
        const std::vector<FieldValue> values = values_for(row);
        EXPECT_TRUE(std::any_of(values.begin(), values.end(), is_read)) << section << row.key << why;
    }
}

TEST(Rows, EveryKeyIsRead) {
    const auto scene = [](const std::string& text) { return parse_scene(text, "s.toml"); };
    expect_read(kBallPresetFields, "[balls]", scene);
    expect_read(kBallFields, "[balls]", [&](const auto& text) { return scene(text).balls; });
    const auto ball = [&](const auto& text) { return scene(text).ball.back(); };
    expect_read(kBallStartFields, "[[ball]]", ball, "");
    const auto size = [&](const auto& text) { return scene(text).size_of(ball(text)); };
    expect_read(kSizeFields, "[[ball]]", size, "");
    const auto rack = [](const auto& text) {
        const std::string name = "s.toml";
        const toml::table file = detail::toml_from(text, name);
        Rack found;
        detail::read_rack_keys(detail::top_of(file, name), found);
        return found;
    };
    expect_read(kRackFields, "[rack]", rack);
    expect_read(kRackedBallFields, "[balls]", rack, "[rack]\n");
    expect_read(
        kCueFields, "[cue]", [&](const auto& text) { return *scene(text).cue; },
        "[[ball]]\n[[ball]]\nid = \"1\"\nposition = [0.3, 1]\n");
    expect_read(kPhysicsFields, "[physics]", [&](const auto& text) { return scene(text).physics; });
    expect_read(kStopFields, "[stop]", [&](const auto& text) { return scene(text).stop; });
    expect_read(kRenderFields, "[render]", [&](const auto& text) { return scene(text).render; });
    const auto table = [&](const auto& text) { return scene(text).table; };
    expect_read(kTableFields, "[table]", table);
    expect_read(kMeasureFields, "[table]", [&](const auto& text) { return table(text).measures; });
    for (const PocketSection& of : kPocketSections)
        expect_read(kPocketMeasureFields, fmt::format("[{}]", of.path),
                    [&](const auto& text) { return table(text).measures.*of.pockets; });
    expect_read(kCushionFields, "[[table.cushion]]",
                [&](const auto& text) { return table(text).cushions.back(); });
    // A jaw has fewer of these keys than an arc.
    expect_read(kJawFields, "[[table.arc]]", [&](const auto& text) { return table(text).jaws.back(); });
    expect_read(kPocketFields, "[[table.pocket]]",
                [&](const auto& text) { return table(text).pockets.back(); });
}

}  // namespace
}  // namespace carom
