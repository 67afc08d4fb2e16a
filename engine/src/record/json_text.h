// Reads JSON in place: the whole text is checked once, and then searched. No tree is built, so reading needs
// no memory beyond the text and the result, and a huge empty list costs only its size. Nesting is followed by
// loops, never by recursion.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace carom::detail {

/// A JSON text, and the state that its readers share.
struct JsonText {
    /// Checks the whole text. `file` is its name in messages. @throws SceneError
    JsonText(std::string_view text, const std::string& file);

    std::string_view text;
    const std::string& file;
    std::size_t root = 0;  ///< byte at which the value begins
    // Keys that no reader requested.
    std::size_t unknown_keys = 0;
    std::string first_unknown;  ///< the path to the first of them
};

/// One value of the text, and the path to it ("tracks[3].segments[2].duration"), for messages. Refers to the
/// containing value, which must outlive it.
class JsonValue {
  public:
    explicit JsonValue(JsonText& source) : source_(source), at_(source.root) {}

    [[noreturn]] void fail(const std::string& message) const;

    bool is_object() const { return first() == '{'; }
    bool is_null() const { return first() == 'n'; }
    double number() const;  ///< finite
    double non_negative() const;
    double positive() const;
    std::int64_t integer(std::int64_t least, std::int64_t most) const;
    bool boolean() const;
    std::string text() const;  ///< of at most 256 bytes

    /// Calls `visit(item, index)` for each item of a list.
    template <class Visit>
    void each(Visit&& visit) const {
        if (first() != '[') fail("expected a list");
        std::size_t index = 0;
        for (std::size_t at = first_item(); at != kNone; at = next_item(at), ++index)
            visit(JsonValue(*this, {}, index, at), index);
    }
    std::size_t size() const;  ///< items of a list; counts them

    template <int kSize>
    Eigen::Matrix<double, kSize, 1> vector() const {
        if (first() != '[' || size() != kSize) fail(fmt::format("expected a list of {} numbers", kSize));
        Eigen::Matrix<double, kSize, 1> v;
        each([&](const JsonValue& item, std::size_t i) { v[static_cast<Eigen::Index>(i)] = item.number(); });
        return v;
    }

    /// One value of an enumeration whose values 0..count-1 all have a name().
    template <class Enum>
    Enum one_of(std::size_t count) const {
        const std::string value = text();
        for (std::size_t i = 0; i < count; ++i)
            if (value == name(static_cast<Enum>(i))) return static_cast<Enum>(i);
        fail_unknown(value);
    }

  private:
    friend class JsonObject;
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

    JsonValue(const JsonValue& parent, std::string_view key, std::size_t index, std::size_t at)
        : source_(parent.source_), parent_(&parent), key_(key), index_(index), at_(at) {}

    char first() const { return at_ < source_.text.size() ? source_.text[at_] : '\0'; }
    std::string where() const;
    std::string_view token() const;                 ///< a number or a string, as written
    std::size_t first_item() const;                 ///< of a list or an object; kNone if it is empty
    std::size_t next_item(std::size_t item) const;  ///< kNone after the last
    [[noreturn]] void fail_unknown(const std::string& name) const;

    JsonText& source_;
    const JsonValue* parent_ = nullptr;
    std::string_view key_;  ///< in an object; otherwise the index applies
    std::size_t index_ = 0;
    std::size_t at_;
};

/// The members of an object by name. A key that is not in `keys` is counted as unknown and ignored; a
/// repeated key is an error.
class JsonObject {
  public:
    JsonObject(const JsonValue& value, std::span<const std::string_view> keys);
    JsonObject(const JsonValue& value, std::initializer_list<std::string_view> keys)
        : JsonObject(value, std::span(keys.begin(), keys.size())) {}
    JsonObject(JsonValue&&, std::initializer_list<std::string_view>) = delete;

    bool has(std::string_view key) const { return at_[index(key)] != JsonValue::kNone; }
    JsonValue at(std::string_view key) const;  ///< an error if it is missing

  private:
    static constexpr std::size_t kMost = 24;
    std::size_t index(std::string_view key) const;
    void note_unknown(std::string_view key) const;

    const JsonValue& value_;
    std::size_t count_ = 0;
    std::array<std::string_view, kMost> keys_;
    std::array<std::size_t, kMost> at_;
};

}  // namespace carom::detail
