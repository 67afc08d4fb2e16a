// Types of the interface: how each is written, read and described. There is one Shape for each C++ type that
// rows use (carom/engine/row.h), and for sections of scene files, whose fields are their rows. The program,
// carom.wasm, Python, C and the reference page work from it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "carom/engine/row.h"
#include "carom/engine/scene.h"
#include "carom/engine/simulate.h"

namespace carom::interface {

/// A value of the interface. Its numbers may be NaN; JSON then has null.
using Value = nlohmann::ordered_json;

/// A value that does not fit its type. what() names the part: "points[1]: expected ...".
class ValueError : public std::invalid_argument {
  public:
    using std::invalid_argument::invalid_argument;
};

/// The part of a value that is being read: a key, or an item of a list, inside another part.
struct Part {
    const Part* whole = nullptr;
    const char* key = nullptr;  ///< null: an item
    std::size_t item = 0;
};

struct Shape {
    enum class Kind : std::uint8_t {
        kTruth,
        kWhole,
        kNumber,
        kText,
        kChoice,
        kList,
        kArray,
        kOptional,
        kType
    };
    /// The limits of a row, for the values inside it.
    struct Limits {
        Whole range{};
        bool may_be_nan = false;
    };
    struct Member {
        const char* key;
        std::string meaning;
        Limits limits;
        bool is_needed;
        const Shape& (*shape)();
        void* (*in)(void* object);                                        ///< null: it has the next two
        Value (*get)(const void* object);                                 ///< or null
        void (*set)(void* object, const Value& value, const Part& part);  ///< or null: computed
        bool is_computed() const { return in == nullptr && set == nullptr; }
    };

    Kind kind;
    Value (*write)(const Shape& shape, const void* from);
    void (*read)(const Shape& shape, const Value& value, const Part& part, const Limits& limits, void* to);
    const char *name = "", *meaning = "";      ///< of a described type; "Scene" of the text of one
    bool is_made_by_callers = false;           ///< the same
    Value (*default_value)() = nullptr;        ///< the same
    std::vector<Member> rows{};                ///< the same
    void (*complete)(void* object) = nullptr;  ///< the same, or null
    std::vector<const char*> names{};          ///< of a choice
    const Shape& (*item)() = nullptr;          ///< of a list, an array or an optional
    std::size_t count = 0;                     ///< items of an array
};

template <class T>
const Shape& shape_of();

template <class T>
Value value_of(const T& of) {
    const Shape& shape = shape_of<T>();
    return shape.write(shape, &of);
}

/// Keys that are missing keep their defaults. @param name  of the value, for messages; null: none
/// @throws ValueError
template <class T>
T read_as(const Value& value, const char* name = nullptr) {
    T out{};
    const Shape& shape = shape_of<T>();
    shape.read(shape, value, {nullptr, name}, {}, &out);
    return out;
}

/// A shot of a scene: its outcomes by name, and the state of each ball at the end.
Value value_of(const Outcome& outcome, const Record& record, const Scene& scene);
/// The state before the first shot. @param options  keys of a state that are not defaults
/// @throws std::invalid_argument
Value new_state(const std::string& game, const Value& options);

/// The described types, each after those that it contains.
std::span<const Shape* const> types();
/// The reference page of the types.
std::string types_page();
/// Blocks of Python, between "# begin NAME" and "# end NAME": of python/carom/_types.py and _simulate.py.
std::string types_for_python();
/// The same of TypeScript, with "//": of web/npm/index.d.ts.
std::string types_for_typescript();

/// A section of scene files, as an object with its keys.
template <class T, std::size_t kCount>
struct Section {
    const char *name, *meaning;
    const Field<T> (&fields)[kCount];
};
template <class T, std::size_t kCount>
constexpr Section<T, kCount> section(const char* name, const Field<T> (&fields)[kCount],
                                     const char* meaning = "") {
    return {name, meaning, fields};
}
constexpr auto section_of(const Cue*) {
    return section("Cue", kCueFields, "A strike: [cue] of a scene file.");
}
constexpr auto section_of(const BallStart*) {
    return section("Ball", kBallStartFields);
}
constexpr auto section_of(const Table*) {
    return section("Table", kTableFields);
}
constexpr auto section_of(const Cushion*) {
    return section("Cushion", kCushionFields);
}
constexpr auto section_of(const Jaw*) {
    return section("Jaw", kJawFields);
}
constexpr auto section_of(const Pocket*) {
    return section("Pocket", kPocketFields);
}
template <class T>
concept HasSection = requires(const T* t) {
    section_of(t).fields;
};

namespace shapes {

[[noreturn]] void refuse(const Part& part, const std::string& fault);
/// Whether a value is a list of numbers, or of such lists.
bool is_numbers(const Shape& shape);
/// The expected items of a list: "whole numbers".
const char* plural_of(const Shape& shape);
Value write_rows(const Shape& shape, const void* from);
void read_rows(const Shape& shape, const Value& value, const Part& part, const Shape::Limits& limits,
               void* to);
std::size_t choice_of(const Shape& shape, const Value& value, const Part& part);
/// @param most, least  of the C++ type
std::int64_t whole_of(const Value& value, const Part& part, Whole range, std::int64_t least,
                      std::int64_t most);
bool truth_of(const Value& value, const Part& part);
double number_of(const Value& value, const Part& part, bool may_be_nan = false);
std::string text_of(const Value& value, const Part& part);
/// With its unit.
std::string meaning_of(const Key& key);
Value value_of_field(const FieldValue& field);
FieldValue field_of(const Key& key, const Value& value, const Part& part);
/// Whose function is Shape::Member::shape of a field.
const Shape& (*shape_of_field(const Key& key))();

template <class T>
constexpr bool kIsArray = requires(const T& v) {
    v.data() + v.rows();
};  // Vec2, Vec3
template <class T, std::size_t kCount>
constexpr bool kIsArray<std::array<T, kCount>> = true;
template <class T>
constexpr bool kIsList = false;
template <class T>
constexpr bool kIsList<std::vector<T>> = true;
template <class T>
constexpr bool kIsOptional = false;
template <class T>
constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
constexpr bool kIsChoice = std::is_enum_v<T> || std::is_pointer_v<T>;
template <class T>
constexpr bool kIsPlain = std::is_arithmetic_v<T> || std::is_same_v<T, std::string>;

/// Converts to any member in an initializer.
struct Anything {
    template <class T>
    operator T() const;  // NOLINT: an implicit conversion is the purpose
};
template <class T, auto kMember>
auto value_in(const T& object) {
    if constexpr (kIsComputed<kMember>)
        return (object.*kMember)();
    else
        return object.*kMember;
}
template <class T, auto kMember>
using MemberOf = decltype(value_in<T, kMember>(std::declval<const T&>()));
template <class T, class... Members>
constexpr bool are_all(std::type_identity<std::tuple<Members...>>) {
    return requires {
        T{std::declval<Members>()...};
    }
    &&!requires {
        T{std::declval<Members>()..., Anything()};
    };
}
/// Whether the rows, except computed ones, are the members of an aggregate in their order, without one more.
template <class T, auto... kMembers>
constexpr bool are_all_members(const std::tuple<Row<kMembers>...>&) {
    using Members =
        decltype(std::tuple_cat(std::declval<std::conditional_t<kIsComputed<kMembers>, std::tuple<>,
                                                                std::tuple<MemberOf<T, kMembers>>>>()...));
    return are_all<T>(std::type_identity<Members>());
}

template <class T>
const T& at(const void* from) {
    return *static_cast<const T*>(from);
}
template <class T>
T& at(void* to) {
    return *static_cast<T*>(to);
}

template <HasRows T>
Shape make_shape() {
    constexpr auto kAll = rows_of(static_cast<const T*>(nullptr));
    static_assert(are_all_members<T>(kAll.rows),
                  "every member needs a row, in the order of the members: add row<&T::member>(\"key\", "
                  "\"meaning\") to rows_of(const T*)");
    Shape shape{.kind = Shape::Kind::kType,
                .write = write_rows,
                .read = read_rows,
                .name = kAll.name,
                .meaning = kAll.meaning,
                .is_made_by_callers = kAll.is_made_by_callers,
                .default_value = [] { return value_of(T{}); }};
    each_row<T>([&]<auto kMember>(const Row<kMember>& row) {
        Shape::Member member{.key = row.key,
                             .meaning = row.meaning,
                             .limits = {row.range, row.may_be_nan},
                             .is_needed = row.is_needed,
                             .shape = shape_of<MemberOf<T, kMember>>,
                             .in = nullptr,
                             .get = nullptr,
                             .set = nullptr};
        if constexpr (kIsComputed<kMember>)
            member.get = [](const void* object) { return value_of((at<T>(object).*kMember)()); };
        else
            member.in = [](void* object) -> void* { return &(at<T>(object).*kMember); };
        shape.rows.push_back(member);
    });
    if constexpr (requires(T & t) { complete(t); })
        shape.complete = [](void* object) { complete(at<T>(object)); };
    return shape;
}

template <HasSection T>
Shape make_shape() {
    static constexpr auto kSection = section_of(static_cast<const T*>(nullptr));
    Shape shape{.kind = Shape::Kind::kType,
                .write = write_rows,
                .read = read_rows,
                .name = kSection.name,
                .meaning = kSection.meaning};
    [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
        (shape.rows.push_back(
             {.key = kSection.fields[kIndex].key,
              .meaning = meaning_of(kSection.fields[kIndex]),
              .limits = {},
              .is_needed = false,
              .shape = shape_of_field(kSection.fields[kIndex]),
              .in = nullptr,
              .get =
                  [](const void* from) { return value_of_field(kSection.fields[kIndex].value(at<T>(from))); },
              .set =
                  [](void* to, const Value& value, const Part& part) {
                      const auto& field = kSection.fields[kIndex];
                      field.set(at<T>(to), field_of(field, value, part));
                  }}),
         ...);
    }
    (std::make_index_sequence<std::size(kSection.fields)>());
    return shape;
}

template <class T>
requires kIsChoice<T> Shape make_shape() {
    Shape shape{
        .kind = Shape::Kind::kChoice,
        .write = [](const Shape&, const void* from) -> Value { return name(at<T>(from)); },
        .read =
            [](const Shape& of, const Value& value, const Part& part, const Shape::Limits&, void* to) {
                const std::size_t index = choice_of(of, value, part);
                if constexpr (std::is_enum_v<T>)
                    at<T>(to) = static_cast<T>(index);
                else
                    at<T>(to) = all_of(T{})[index];
            }};
    if constexpr (std::is_enum_v<T>)
        for (const char* each : names_of(T{})) shape.names.push_back(each);
    else
        for (const T each : all_of(T{})) shape.names.push_back(name(each));
    return shape;
}

template <class T>
requires kIsOptional<T> Shape make_shape() {
    return {
        .kind = Shape::Kind::kOptional,
        .write = [](const Shape&, const void* from) -> Value {
            return at<T>(from) ? value_of(*at<T>(from)) : Value();
        },
        .read =
            [](const Shape& of, const Value& value, const Part& part, const Shape::Limits& limits, void* to) {
                at<T>(to).reset();
                if (!value.is_null()) of.item().read(of.item(), value, part, limits, &at<T>(to).emplace());
            },
        .item = shape_of<typename T::value_type>};
}

template <class T>
requires(kIsList<T> || kIsArray<T>) Shape make_shape() {
    using Item = std::remove_cvref_t<decltype(std::declval<T&>()[0])>;
    Shape shape{
        .kind = kIsList<T> ? Shape::Kind::kList : Shape::Kind::kArray,
        .write = [](const Shape&, const void* from) -> Value {
            Value list = Value::array();
            for (const auto& each : at<T>(from)) list.push_back(value_of<Item>(each));
            return list;
        },
        .read =
            [](const Shape& of, const Value& value, const Part& part, const Shape::Limits& limits, void* to) {
                T& list = at<T>(to);
                const bool fits = value.is_array() && (kIsList<T> || value.size() == of.count);
                if (!fits)
                    refuse(part, "expected a list of " + (kIsList<T> ? "" : std::to_string(of.count) + " ") +
                                     plural_of(of.item()));
                if constexpr (kIsList<T>) list.resize(value.size());
                for (std::size_t i = 0; i < value.size(); ++i)
                    of.item().read(of.item(), value[i], {&part, nullptr, i}, limits, &list[i]);
            },
        .item = shape_of<Item>};
    if constexpr (kIsArray<T>) shape.count = static_cast<std::size_t>(T{}.size());
    return shape;
}

/// The text of a scene file.
template <class T>
requires std::is_same_v<T, Scene> Shape make_shape() {
    return {.kind = Shape::Kind::kText,
            .write = [](const Shape&, const void* from) -> Value { return scene_text(at<T>(from)); },
            .read = [](const Shape&, const Value& value, const Part& part, const Shape::Limits&,
                       void* to) { at<T>(to) = parse_scene(text_of(value, part), "scene"); },
            .name = "Scene"};
}

template <class T>
Shape make_shape() {
    static_assert(kIsPlain<T>, "give this type rows: constexpr auto rows_of(const T*) after its struct");
    using Kind = Shape::Kind;
    static_assert(!std::is_integral_v<T> || std::is_signed_v<T> || sizeof(T) < 8,
                  "numbers of 64 bits without a sign are texts in the interface");
    constexpr Kind kKind = std::is_same_v<T, bool>       ? Kind::kTruth
                           : std::is_integral_v<T>       ? Kind::kWhole
                           : std::is_floating_point_v<T> ? Kind::kNumber
                                                         : Kind::kText;
    return {
        .kind = kKind,
        .write = [](const Shape&, const void* from) -> Value { return at<T>(from); },
        .read =
            [](const Shape&, const Value& value, const Part& part, const Shape::Limits& limits, void* to) {
                if constexpr (kKind == Kind::kTruth)
                    at<T>(to) = truth_of(value, part);
                else if constexpr (kKind == Kind::kWhole)
                    at<T>(to) =
                        static_cast<T>(whole_of(value, part, limits.range, std::numeric_limits<T>::min(),
                                                std::numeric_limits<T>::max()));
                else if constexpr (kKind == Kind::kNumber)
                    at<T>(to) = static_cast<T>(number_of(value, part, limits.may_be_nan));
                else
                    at<T>(to) = text_of(value, part);
            }};
}

}  // namespace shapes

template <class T>
const Shape& shape_of() {
    static const Shape kShape = shapes::make_shape<T>();
    return kShape;
}

}  // namespace carom::interface
