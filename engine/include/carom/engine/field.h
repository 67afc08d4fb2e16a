// Fields: the keys of a section as rows of a table. The readers and writers of scenes and records, the
// schemas, the tables of docs/reference/scene_format.md and the C interface all use these rows, so a new row
// reaches all of them. The rows of each section follow its struct, in scene.h and table.h.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace carom {

/// The range of a number. `unit` is written after a space; "" for none.
struct Interval {
    double low;
    bool low_open;
    double high;
    bool high_open;
    const char* unit;
};

constexpr Interval at_least(double low, double high, const char* unit = "") {
    return {low, false, high, false, unit};
}
constexpr Interval more_than(double low, double high, const char* unit = "") {
    return {low, true, high, false, unit};
}
/// Upper bound of integers without their own limit.
inline constexpr double kAnyInteger = 0x1p63;

/// The value of a field: nothing for an unset optional, a list for a vector.
using FieldValue = std::variant<std::monostate, double, std::int64_t, std::string, std::vector<double>>;

/// The files that contain the key.
enum class Files : std::uint8_t { kBoth, kScene, kRecord };

struct KeyOptions {
    const char* shape = "";            ///< of a list: "[x, y]"
    const char* record_key = nullptr;  ///< the key in record files, if it differs
    Files files = Files::kBoth;
    bool later = false;  ///< added within a version of record files: older files of that version lack the key
    bool needed = false;                      ///< the scene must set it
    bool last_may_lack = false;               ///< the last number of a list may be omitted if it is 0
    const char* standard = nullptr;           ///< the default in words, if it is not a value
    const char* instead_of = nullptr;         ///< the key that this one replaces if it is set
    std::span<const char* const> names = {};  ///< the texts allowed; empty: all
};

/// One row without its type: everything about a key.
struct Key {
    enum class Kind : std::uint8_t { kNumber, kInteger, kText, kNumbers, kIntegers };

    const char* key;
    Kind kind;
    Interval range;       ///< of a number, or of every number in a list
    const char* meaning;  ///< for people, without the unit
    KeyOptions options;
    bool optional;                          ///< the scene may omit it
    int members;                            ///< how many members of the struct it represents
    std::vector<const char*> (*choices)();  ///< the texts allowed; null: options.names

    bool in(Files files) const { return options.files == Files::kBoth || options.files == files; }
    const char* record_key() const { return options.record_key ? options.record_key : key; }
    std::int64_t least() const { return static_cast<std::int64_t>(range.low); }
    std::int64_t most() const {
        return range.high < kAnyInteger ? static_cast<std::int64_t>(range.high) : INT64_MAX;
    }
    /// Length of the list, from its shape.
    std::size_t count() const {
        const std::string_view shape = options.shape;
        return 1 + static_cast<std::size_t>(std::count(shape.begin(), shape.begin() + shape.find(']'), ','));
    }
    std::vector<const char*> names() const {
        return choices ? choices() : std::vector<const char*>(options.names.begin(), options.names.end());
    }
};

template <class T>
struct Field : Key {
    FieldValue (*get)(const T&);
    void (*set)(T&, const FieldValue&);  ///< the value is of this kind, and one of the choices
    /// Whether files may have this value, determined without allocating memory; false also if that is
    /// unknown.
    bool (*fits)(const T&, const Key&) = nullptr;
    /// The k-th number of a list in the struct itself; null if the struct does not store the list.
    double* (*element)(T&, std::size_t k) = nullptr;

    FieldValue value(const T& object) const {
        FieldValue value = get(object);
        // A position omits the height of the ball.
        if (auto* list = std::get_if<std::vector<double>>(&value)) {
            list->resize(count());
            if (options.last_may_lack && list->back() == 0.0) list->pop_back();
        }
        return value;
    }
};

/// Whether a scene file that writes all of `object` has this row: it has a value, and no other key replaces
/// it.
template <class T, std::size_t kRows>
bool is_written(const Field<T> (&fields)[kRows], const Field<T>& field, const T& object) {
    const bool replaced = std::any_of(fields, fields + kRows, [&](const Field<T>& other) {
        const char* key = other.options.instead_of;
        return key != nullptr && key == std::string_view(field.key) && other.value(object).index() != 0;
    });
    return field.in(Files::kScene) && !replaced && field.value(object).index() != 0;
}

/// Smallest magnitude of a nonzero number: powers of smaller ones underflow.
inline constexpr double kLeastSize = 1e-60;

/// Whether a number is nonzero but too small to compute with.
constexpr bool is_tiny(double x) {
    return x != 0.0 && x > -kLeastSize && x < kLeastSize;
}

/// Whether a number is finite, not tiny, and in its interval.
constexpr bool contains(const Interval& range, double x) {
    const bool high_enough = range.low_open ? x > range.low : x >= range.low;
    const bool low_enough = range.high_open ? x < range.high : x <= range.high;
    return x - x == 0.0 && !is_tiny(x) && high_enough && low_enough;
}

/// The name of an enumeration's value in files.
template <class E>
auto name(E e) -> typename decltype(names_of(e))::value_type {
    return names_of(e)[static_cast<std::size_t>(e)];
}

namespace detail {

template <class V>
constexpr bool kIsOptional = false;
template <class V>
constexpr bool kIsOptional<std::optional<V>> = true;
template <class V>
constexpr bool kIsChoice = std::is_enum_v<V> || std::is_pointer_v<V>;

template <class Member>
struct MemberOf;
template <class T, class V>
struct MemberOf<V T::*> {
    using Class = T;
    using Value = V;
};
template <auto kMember>
using ClassOf = typename MemberOf<decltype(kMember)>::Class;
template <auto kMember>
using ValueOf = typename MemberOf<decltype(kMember)>::Value;

template <class V>
constexpr Key::Kind kind_of() {
    if constexpr (kIsOptional<V>) return kind_of<typename V::value_type>();
    if constexpr (std::is_floating_point_v<V>) return Key::Kind::kNumber;
    if constexpr (std::is_integral_v<V>) return Key::Kind::kInteger;
    if constexpr (requires(V v) { v.data() + v.rows(); }) return Key::Kind::kNumbers;
    return Key::Kind::kText;
}

template <class V>
FieldValue get(const V& v) {
    if constexpr (kIsOptional<V>)
        return v ? get(*v) : FieldValue();
    else if constexpr (std::is_pointer_v<V>)
        return v ? FieldValue(std::string(name(v))) : FieldValue();
    else if constexpr (std::is_enum_v<V>)
        return std::string(name(v));
    else if constexpr (std::is_integral_v<V>)
        return static_cast<std::int64_t>(v);
    else if constexpr (kind_of<V>() == Key::Kind::kNumbers)
        return std::vector<double>(v.data(), v.data() + v.size());
    else
        return v;
}

template <class V>
std::vector<const char*> choice_names() {
    std::vector<const char*> names;
    if constexpr (std::is_enum_v<V>)
        for (const char* choice : names_of(V{})) names.push_back(choice);
    else
        for (const V choice : all_of(V{})) names.push_back(name(choice));
    return names;
}

/// Whether a value is certainly allowed; unknown for texts.
template <class V>
bool fits(const V& v, const Key& key) {
    if constexpr (kIsOptional<V>)
        return !v || fits(*v, key);
    else if constexpr (std::is_pointer_v<V>)
        return std::find(all_of(V{}).begin(), all_of(V{}).end(), v) != all_of(V{}).end();
    else if constexpr (std::is_enum_v<V>)
        return static_cast<std::size_t>(v) < names_of(V{}).size();
    else if constexpr (std::is_floating_point_v<V>)
        return contains(key.range, v);
    else if constexpr (std::is_integral_v<V>)
        return false;
    else if constexpr (kind_of<V>() == Key::Kind::kNumbers)
        return std::all_of(v.data(), v.data() + key.count(),
                           [&](double x) { return contains(key.range, x); });
    else
        return false;
}

/// The k-th number of a vector.
template <auto kMember>
double* element(ClassOf<kMember>& object, std::size_t k) {
    using V = ValueOf<kMember>;
    if constexpr (!kIsOptional<V> && kind_of<V>() == Key::Kind::kNumbers)
        return (object.*kMember).data() + k;
    else
        return nullptr;
}

template <class V>
void put(V& v, const FieldValue& value) {
    if constexpr (kIsOptional<V>) {
        put(v.emplace(), value);
    } else if constexpr (kIsChoice<V>) {
        const std::vector<const char*> names = choice_names<V>();
        const auto at = std::find(names.begin(), names.end(), std::get<std::string>(value)) - names.begin();
        if constexpr (std::is_enum_v<V>)
            v = static_cast<V>(at);
        else
            v = all_of(V{})[at];
    } else if constexpr (std::is_integral_v<V>) {
        v = static_cast<V>(std::get<std::int64_t>(value));
    } else if constexpr (kind_of<V>() == Key::Kind::kNumbers) {
        const auto& list = std::get<std::vector<double>>(value);
        std::copy(list.begin(), list.end(), v.data());
    } else {
        v = std::get<V>(value);
    }
}

}  // namespace detail

/// A row of one member: a number, an integer, a text, a vector, or a choice. A choice is an enumeration whose
/// names are `names_of(V)`, in the order of its values, or a pointer to one of the models `all_of(V)`, named
/// `name(v)`.
template <auto kMember>
constexpr Field<detail::ClassOf<kMember>> field(const char* key, const Interval& range, const char* meaning,
                                                const KeyOptions& options = {}) {
    using T = detail::ClassOf<kMember>;
    using V = detail::ValueOf<kMember>;
    const bool optional = detail::kIsOptional<V> || std::is_pointer_v<V>;
    std::vector<const char*> (*choices)() = nullptr;
    if constexpr (detail::kIsChoice<V>) choices = detail::choice_names<V>;
    return {{key, detail::kind_of<V>(), range, meaning, options, optional, 1, choices},
            [](const T& object) { return detail::get(object.*kMember); },
            [](T& object, const FieldValue& value) { detail::put(object.*kMember, value); },
            [](const T& object, const Key& row) { return detail::fits(object.*kMember, row); },
            detail::element<kMember>};
}
template <auto kMember>
constexpr Field<detail::ClassOf<kMember>> field(const char* key, const char* meaning,
                                                const KeyOptions& options = {}) {
    return field<kMember>(key, at_least(0.0, 0.0), meaning, options);
}

/// A row of two numbers, which files write as one list.
template <auto kFirst, auto kSecond>
constexpr Field<detail::ClassOf<kFirst>> field(const char* key, const Interval& range, const char* meaning,
                                               const KeyOptions& options) {
    using T = detail::ClassOf<kFirst>;
    using V = detail::ValueOf<kFirst>;
    const Key::Kind kind = std::is_integral_v<V> ? Key::Kind::kIntegers : Key::Kind::kNumbers;
    return {{key, kind, range, meaning, options, false, 2, nullptr},
            [](const T& object) -> FieldValue {
                return std::vector<double>{static_cast<double>(object.*kFirst),
                                           static_cast<double>(object.*kSecond)};
            },
            [](T& object, const FieldValue& value) {
                const auto& list = std::get<std::vector<double>>(value);
                object.*kFirst = static_cast<V>(list[0]);
                object.*kSecond = static_cast<V>(list[1]);
            },
            [](const T& object, const Key& row) {
                return contains(row.range, static_cast<double>(object.*kFirst)) &&
                       contains(row.range, static_cast<double>(object.*kSecond));
            },
            [](T& object, std::size_t k) -> double* {
                if constexpr (std::is_floating_point_v<V>)
                    return k == 0 ? &(object.*kFirst) : &(object.*kSecond);
                else
                    return nullptr;
            }};
}

/// A row of a flag: files write the first word for false, the second for true. Files omit false, the default.
template <auto kMember, const auto& kWords>
constexpr Field<detail::ClassOf<kMember>> either(const char* key, const char* meaning) {
    using T = detail::ClassOf<kMember>;
    return {
        {key,
         Key::Kind::kText,
         at_least(0.0, 0.0),
         meaning,
         {.later = true, .standard = kWords[0], .names = kWords},
         true,
         1,
         nullptr},
        [](const T& object) { return object.*kMember ? FieldValue(std::string(kWords[1])) : FieldValue(); },
        [](T& object, const FieldValue& value) {
            object.*kMember = std::get<std::string>(value) == kWords[1];
        }};
}

/// The rows of a coefficient that may be a number or a fit of three. `number` sets the first number alone and
/// replaces a fit. `fit` is the list of all three, in scene files, if either of the other two is not 0.
template <auto kFirst, auto... kOthers>
constexpr Field<detail::ClassOf<kFirst>> number_or_fit(const char* key, const Interval& range,
                                                       const char* meaning, const KeyOptions& options = {}) {
    using T = detail::ClassOf<kFirst>;
    return {{key, Key::Kind::kNumber, range, meaning, options, false, 1, nullptr},
            [](const T& object) -> FieldValue { return object.*kFirst; },
            [](T& object, const FieldValue& value) {
                object.*kFirst = std::get<double>(value);
                ((object.*kOthers = 0.0), ...);
            }};
}
template <auto kFirst, auto kSecond, auto kThird>
constexpr Field<detail::ClassOf<kFirst>> fit(const char* key, const Interval& range, const char* meaning,
                                             const char* shape, const char* instead_of) {
    using T = detail::ClassOf<kFirst>;
    return {{key,
             Key::Kind::kNumbers,
             range,
             meaning,
             {.shape = shape, .files = Files::kScene, .instead_of = instead_of},
             true,
             0,
             nullptr},
            [](const T& object) {
                return object.*kSecond == 0.0 && object.*kThird == 0.0
                           ? FieldValue()
                           : std::vector<double>{object.*kFirst, object.*kSecond, object.*kThird};
            },
            [](T& object, const FieldValue& value) {
                const auto& list = std::get<std::vector<double>>(value);
                object.*kFirst = list[0], object.*kSecond = list[1], object.*kThird = list[2];
            },
            nullptr,
            [](T& object, std::size_t k) -> double* {
                return k == 0 ? &(object.*kFirst) : k == 1 ? &(object.*kSecond) : &(object.*kThird);
            }};
}

/// The keys of some rows that occur in these files.
template <class T, std::size_t kRows>
std::vector<std::string_view> keys_of(const Field<T> (&fields)[kRows], Files files) {
    std::vector<std::string_view> keys;
    for (const Field<T>& f : fields)
        if (f.in(files)) keys.push_back(files == Files::kRecord ? f.record_key() : f.key);
    return keys;
}

}  // namespace carom
