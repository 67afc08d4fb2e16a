// Rows: the members of a type of the interface, each with its key and meaning. JSON, Python and the reference
// page are made from them (interface/shape.h). The rows of a type follow its struct. Scene files have the
// fields of field.h instead: numbers and texts with units and defaults, which do not nest.
#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace carom {

/// The whole numbers that a member, or each number of a list, may be; equal limits: any that fits its type.
struct Whole {
    int least = 0, most = 0;
};

template <auto kMember>
struct Row {
    const char* key;
    const char* meaning;  ///< for people, with the unit
    Whole range{};
    bool is_needed = false;   ///< a reader refuses a value without this key
    bool may_be_nan = false;  ///< the number may be missing: NaN, and null in JSON
    constexpr Row needed() const {
        Row row = *this;
        row.is_needed = true;
        return row;
    }
    constexpr Row or_nan() const {
        Row row = *this;
        row.may_be_nan = true;
        return row;
    }
};

/// A member function: its value is written, and ignored by a reader.
template <auto kMember>
constexpr bool kIsComputed = std::is_member_function_pointer_v<decltype(kMember)>;

/// A member: a number, a truth, a text, a choice (field.h), a described type, or a list, an array or an
/// optional of these.
template <auto kMember>
constexpr Row<kMember> row(const char* key, const char* meaning, Whole range = {}) {
    return {key, meaning, range};
}

/// A type and its rows, as rows_of(const T*) returns them. If reading needs more than the rows say, there is
/// also a `void complete(T&)`, which throws std::invalid_argument("key: the fault").
template <class... Rows>
struct Described {
    const char* name;
    const char* meaning;
    std::tuple<Rows...> rows;
    /// Callers make values of this type: in Python its members have defaults, and its lists are tuples.
    bool is_made_by_callers = false;
    constexpr Described made_by_callers() const {
        Described described = *this;
        described.is_made_by_callers = true;
        return described;
    }
};
template <class... Rows>
constexpr Described<Rows...> described(const char* name, const char* meaning, Rows... rows) {
    return {name, meaning, {rows...}};
}

template <class T>
concept HasRows = requires(const T* t) {
    rows_of(t).rows;
};

/// Calls `f(row)` for each row of T.
template <HasRows T, class F>
constexpr void each_row(F&& f) {
    constexpr auto kRows = rows_of(static_cast<const T*>(nullptr)).rows;
    [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
        (f(std::get<kIndex>(kRows)), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(kRows)>>());
}

}  // namespace carom
