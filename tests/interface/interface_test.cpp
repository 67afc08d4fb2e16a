// Types of the interface: each value survives JSON, and a wrong one is refused with its path.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "carom/engine/math.h"
#include "carom/games/aim.h"
#include "carom/games/player.h"
#include "carom/games/rules.h"
#include "carom/interface/shape.h"

namespace carom::interface {

/// A type with members that no type of the games has.
struct Sample {
    int any = 0;
    std::int8_t small = 0;
    double missing = 0.0, number = 0.0;
    std::optional<Vec2> place;
    std::vector<std::array<bool, 2>> nested{};
    bool operator==(const Sample&) const = default;
};
constexpr auto rows_of(const Sample*) {
    return described("Sample", "", row<&Sample::any>("any", ""), row<&Sample::small>("small", ""),
                     row<&Sample::missing>("missing", "").or_nan(),
                     row<&Sample::number>("number", "").needed(), row<&Sample::place>("place", ""),
                     row<&Sample::nested>("nested", ""));
}

namespace {

using Kind = Shape::Kind;

Value random_value(const Shape& shape, const Shape::Limits& limits, std::mt19937& random) {
    const auto up_to = [&](int most) { return std::uniform_int_distribution(0, most)(random); };
    switch (shape.kind) {
        case Kind::kTruth:
            return up_to(1) == 1;
        case Kind::kWhole: {
            const Whole range = limits.range.least == limits.range.most ? Whole{-9, 9} : limits.range;
            return std::uniform_int_distribution(range.least, range.most)(random);
        }
        case Kind::kNumber:
            return std::uniform_real_distribution(-1e3, 1e3)(random);
        case Kind::kText:
            return std::string(static_cast<std::size_t>(up_to(3)), 'a');
        case Kind::kChoice:
            return shape.names[static_cast<std::size_t>(up_to(static_cast<int>(shape.names.size()) - 1))];
        case Kind::kOptional:
            return up_to(1) == 0 ? Value() : random_value(shape.item(), limits, random);
        case Kind::kList:
        case Kind::kArray: {
            Value list = Value::array();
            const auto count = shape.kind == Kind::kArray ? shape.count : static_cast<std::size_t>(up_to(3));
            for (std::size_t i = 0; i < count; ++i)
                list.push_back(random_value(shape.item(), limits, random));
            return list;
        }
        case Kind::kType:
            break;
    }
    Value all = Value::object();
    for (const Shape::Member& row : shape.rows) {
        if (row.is_computed()) continue;
        // The rules of a state are not any texts, and no preset has any mass.
        all[row.key] = std::string(row.key) == "rules"    ? Value::array()
                       : std::string(row.key) == "preset" ? Value("plain")
                                                          : random_value(row.shape(), row.limits, random);
    }
    return all;
}

/// Whether a value is the other one, or has more keys, which are computed.
bool contains(const Value& all, const Value& part) {
    if (!part.is_structured()) return all == part;
    return std::all_of(part.items().begin(), part.items().end(), [&](const auto& item) {
        return part.is_object() ? all.contains(item.key()) && contains(all[item.key()], item.value())
                                : contains(all.at(std::stoul(item.key())), item.value());
    });
}

template <class T>
void expect_round_trips() {
    std::mt19937 random(1);
    for (int i = 0; i < 100; ++i) {
        const Value value = random_value(shape_of<T>(), {}, random);
        const T read = read_as<T>(Value::parse(value.dump()));
        ASSERT_TRUE(contains(value_of(read), value)) << value_of(read) << " for " << value;
        ASSERT_EQ(read_as<T>(value_of(read)), read);
    }
}

TEST(Interface, EveryTypeSurvivesJson) {
    expect_round_trips<Sample>();
    expect_round_trips<games::Verdict>();
    expect_round_trips<games::Legal>();
    expect_round_trips<games::Call>();
    expect_round_trips<games::GameInfo>();
    expect_round_trips<games::Advice>();
    expect_round_trips<games::Aim>();
    expect_round_trips<games::PocketLine>();
}

TEST(Interface, ASceneIsItsText) {
    const Value text = scene_text(read_scene(CAROM_SOURCE_DIR "/scenes/draw.toml"));
    EXPECT_EQ(value_of(read_as<Scene>(text)), text);
}

TEST(Interface, KeysDifferAndHideNoMethodOfATuple) {
    for (const Shape* type : types()) {
        std::set<std::string> keys{"count", "index"};
        for (const Shape::Member& row : type->rows) {
            EXPECT_TRUE(keys.insert(row.key).second) << type->name << "." << row.key;
            EXPECT_FALSE(row.meaning.empty()) << type->name << "." << row.key;
        }
    }
}

template <class T>
std::string refused(const char* json, const char* name) {
    try {
        read_as<T>(Value::parse(json, nullptr, false), name);
    } catch (const ValueError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Interface, AWrongValueIsRefusedByItsPath) {
    const auto state = [](const char* json) { return refused<games::State>(json, "state"); };
    EXPECT_EQ(state(R"({"game": "snooker", "turn": 2})"), "state.turn: expected a whole number from 0 to 1");
    EXPECT_EQ(state(R"({"game": "snooker", "turn": 0.0})"),
              "state.turn: expected a whole number from 0 to 1");
    EXPECT_EQ(state(R"({"game": "snooker", "points": [0, 2000000000]})"),
              "state.points[1]: expected a whole number from -1000000000 to 1000000000");
    EXPECT_EQ(state(R"({"game": "snooker", "points": 3})"),
              "state.points: expected a list of 2 whole numbers");
    EXPECT_EQ(state(R"({"game": "snooker", "over": 1})"), "state.over: expected true or false");
    EXPECT_EQ(state(R"({"game": "snooker", "on": "orange"})"),
              "state.on: expected one of colour, red, yellow, green, brown, blue, pink, black");
    EXPECT_EQ(state(R"({"game": "snooker", "rules": ["call=all"]})"),
              "state.rules: snooker has no option \"call\"; it has miss");
    EXPECT_EQ(state(R"({"game": "snooker", "pionts": 1})").substr(0, 55),
              "state: unknown key \"pionts\"; expected one of game, turn");
    const auto cue = [](const char* json) { return refused<Cue>(json, "cue"); };
    EXPECT_EQ(cue(R"({"speed": "2"})"), "cue.speed: expected a number");
    EXPECT_EQ(cue(R"({"offset": [0]})"), "cue.offset: expected a list of 2 numbers");
    EXPECT_EQ(cue(R"({"preset": "iron"})"),
              "cue.preset: expected one of low_deflection, plain, break, lossless");
    EXPECT_EQ(state("{}").substr(0, 40), "state.game: expected one of eight_ball, ");
    EXPECT_EQ(state("nothing").substr(0, 42), "state: expected an object with game, turn,");
    EXPECT_EQ(
        refused<games::Verdict>(R"({"options": [{"state": {"game": "snooker", "turn": -1}}]})", nullptr),
        "options[0].state.turn: expected a whole number from 0 to 1");
}

TEST(Interface, NumbersAreNotNarrowed) {
    const auto sample = [](const char* json) { return refused<Sample>(json, nullptr); };
    EXPECT_EQ(sample(R"({"number": 1, "any": 2147483648})"),
              "any: expected a whole number from -2147483648 to 2147483647");
    EXPECT_EQ(sample(R"({"number": 1, "any": 18446744073709551615})"),
              "any: expected a whole number from -2147483648 to 2147483647");
    EXPECT_EQ(sample(R"({"number": 1, "small": 128})"), "small: expected a whole number from -128 to 127");
    EXPECT_EQ(sample(R"({"number": null})"), "number: expected a number");
    EXPECT_EQ(sample(R"({"number": 1, "missing": "1"})"), "missing: expected a number or null");
    EXPECT_EQ(sample(R"({"number": 1, "place": [0]})"), "place: expected a list of 2 numbers");
    EXPECT_EQ(sample(R"({"number": 1, "nested": [[true, true], [true, 0]]})"),
              "nested[1][1]: expected true or false");
    EXPECT_EQ(sample("{}"), "number: expected a number");
    // Python and C++ have such numbers, JSON has not.
    EXPECT_THROW(read_as<Sample>({{"number", std::nan("")}}), ValueError);
    EXPECT_THROW(read_as<Sample>({{"number", HUGE_VAL}}), ValueError);
    EXPECT_TRUE(std::isnan(read_as<Sample>(Value::parse(R"({"number": 1, "missing": null})")).missing));
}

}  // namespace
}  // namespace carom::interface
