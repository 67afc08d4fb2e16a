// A typed reader over toml++: every value is checked where it is read, and every error names its place in the file.
#pragma once

#include <toml++/toml.h>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/printable.h"
#include "carom/engine/scene.h"

namespace carom::detail {

/// The values a number may take. `unit` comes after a blank, "" for none.
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

/// One name that a key may take.
template <class T>
struct Choice {
    const char* name;
    T value;
};

using carom::in_quotes;

SourceLocation place(const toml::node& node);

/// Reads one table of the file. `path` names it in messages ("cue", "table.cushion"); the file as a whole is "".
class Section {
  public:
    /// @throws SceneError for a key that is not in `keys`
    Section(const toml::table& table, const std::string& file, std::string path,
            std::initializer_list<std::string_view> keys);

    SourceLocation where() const { return where_; }
    const std::string& file() const { return file_; }
    bool has(std::string_view key) const { return table_.contains(key); }
    /// Where a key's value stands, or the section if the key is absent.
    SourceLocation where(std::string_view key) const;

    double number(std::string_view key, double fallback, const Interval& allowed) const;
    std::optional<double> number(std::string_view key, const Interval& allowed) const;
    std::int64_t integer(std::string_view key, std::int64_t fallback, std::int64_t low,
                         std::int64_t high) const;
    std::optional<std::int64_t> integer(std::string_view key, std::int64_t low, std::int64_t high) const;
    std::optional<bool> boolean(std::string_view key) const;
    std::string text(std::string_view key, const std::string& fallback) const;
    /// `count` numbers in an array; nothing if the key is absent. `shape` shows how to write it: "[x, y]".
    std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count, const char* shape,
                                               const Interval& allowed) const;
    Vec2 vec2(std::string_view key, const Vec2& fallback, const char* shape, const Interval& allowed) const;
    /// As vec2, but the key has to be there.
    Vec2 need_vec2(std::string_view key, const char* shape, const Interval& allowed) const;
    double need_number(std::string_view key, const Interval& allowed) const;

    /// One of the names in `choices`; they are listed in the error for any other.
    template <class T, std::size_t N>
    T choice(std::string_view key, T fallback, const Choice<T> (&choices)[N]) const {
        if (!has(key)) return fallback;
        const std::string got = text(key, "");
        std::vector<const char*> names;
        for (const Choice<T>& c : choices) {
            if (got == c.name) return c.value;
            names.push_back(c.name);
        }
        fail_choice(key, got, names);
    }

    /// A section inside this one; null if absent.
    const toml::table* table(std::string_view key) const;
    /// The tables of an array of tables; nothing if the key is absent.
    std::optional<std::vector<const toml::table*>> tables(std::string_view key) const;

    [[noreturn]] void fail(std::string_view key, const std::string& message) const;
    [[noreturn]] void fail(SourceLocation where, const std::string& message) const;
    /// "cue.speed"
    std::string full(std::string_view key) const;

  private:
    double checked(const toml::node& node, const std::string& what, const Interval& allowed) const;
    [[noreturn]] void fail_choice(std::string_view key, const std::string& got,
                                  const std::vector<const char*>& names) const;

    const toml::table& table_;
    const std::string& file_;
    std::string path_;
    SourceLocation where_;
};

}  // namespace carom::detail
