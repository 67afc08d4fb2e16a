// A typed reader over toml++: every value is checked when read, and every error states its position in the
// file.
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/printable.h"
#include "carom/engine/scene.h"

namespace carom::detail {

using carom::in_quotes;

SourceLocation place(const toml::source_region& region);

/// A key that a section does not allow, or a section that does not exist (`section` is "").
class UnknownKey : public SceneError {
  public:
    UnknownKey(const std::string& file, SourceLocation where, std::string_view key,
               const std::string& section, const std::vector<std::string_view>& keys);
};

/// Reads one table of the file. `path` is its name in messages ("cue", "table.cushion"); "" for the whole
/// file. A section of a scene built in code has no table: it only checks, and its errors have no location.
class Section {
  public:
    Section(const std::string& file, std::string path) : file_(file), path_(std::move(path)) {}

    /// @throws UnknownKey for a key that is not in `keys`
    Section(const toml::table& table, const std::string& file, std::string path,
            const std::vector<std::string_view>& keys);

    SourceLocation where() const { return where_; }
    const std::string& file() const { return file_; }
    bool path_is(std::string_view path) const { return path_ == path; }
    bool has(std::string_view key) const { return table_ != nullptr && table_->contains(key); }
    /// Location of a key's value, or of the section if the key is absent.
    SourceLocation where(std::string_view key) const;
    /// The same for a key in a section inside this one.
    bool has(std::string_view section, std::string_view key) const {
        return table_ != nullptr && bool((*table_)[section][key]);
    }
    SourceLocation where(std::string_view section, std::string_view key) const {
        return has(section, key) ? where(*(*table_)[section][key].node()) : where(section);
    }
    static SourceLocation where(const toml::node& node) { return place(node.source()); }
    static SourceLocation where(SourceLocation known) { return known; }

    /// Reads the values present in the section; the rest of the object is unchanged.
    template <class T, std::size_t kRows>
    void read(const Field<T> (&fields)[kRows], T& object, std::string_view except = {}) const {
        for (const Field<T>& f : fields) {
            if (!f.in(Files::kScene) || f.key == except) continue;
            const FieldValue found = value(f);
            if (found.index() != 0) f.set(object, found);
        }
    }
    std::optional<bool> boolean(std::string_view key) const;
    /// The value of a key for which has() is true.
    const toml::node* node(std::string_view key) const { return table_->get(key); }
    /// A number inside a value; `what` is its name in messages.
    double number_of(const toml::node& node, const std::string& what, const Interval& allowed) const {
        return number(node, what, allowed);
    }
    /// A text in an inner section that is read and checked later; nothing if absent.
    std::optional<std::string> peek(std::string_view section, std::string_view key) const {
        return table_ != nullptr ? (*table_)[section][key].value<std::string>() : std::nullopt;
    }

    /// Refuses values that a file could not have, in the order of the rows.
    template <class T, std::size_t kRows>
    void check(const Field<T> (&fields)[kRows], const T& object) const {
        for (const Field<T>& f : fields) {
            if (f.fits != nullptr && f.fits(object, f)) continue;
            if (is_written(fields, f, object)) check(f, f.value(object));
        }
    }
    /// The same for one value.
    void check(const Key& key, const FieldValue& value) const;

    /// A section inside this one, if it exists.
    std::optional<Section> section(const char* key, const std::vector<std::string_view>& keys) const;
    /// The same, and reads its values into the object.
    template <class T, std::size_t kRows>
    std::optional<Section> read(const char* key, const Field<T> (&fields)[kRows], T& object) const {
        std::optional<Section> inner = section(key, keys_of(fields, Files::kScene));
        if (inner) inner->read(fields, object);
        return inner;
    }
    /// The tables of an array of tables; nothing if the key is absent.
    std::optional<std::vector<const toml::table*>> tables(std::string_view key) const;

    /// Throws a SceneError at a key, a node or a location; message and values as for fmt::format.
    template <class At, class... Values>
    [[noreturn]] void fail(const At& at, fmt::format_string<Values...> message, Values&&... values) const {
        throw SceneError(file_, where(at), fmt::format(message, std::forward<Values>(values)...));
    }
    /// "cue.speed"
    std::string full(std::string_view key) const;

  private:
    FieldValue value(const Key& key) const;
    double number(const toml::node& node, const std::string& what, const Interval& allowed) const;
    std::int64_t integer(const toml::node& node, const Key& key) const;
    std::string text(const toml::node& node, const Key& key) const;
    std::vector<double> numbers(const toml::node& node, const Key& key) const;
    std::string element(const Key& key, std::size_t k) const;
    void refuse(SourceLocation at, const std::string& what, const std::string& objection) const;
    void check_text(SourceLocation at, const std::string& x, const Key& key) const;
    void check_whole(SourceLocation at, const std::vector<double>& list, const Key& key) const;

    const toml::table* table_ = nullptr;
    const std::string& file_;
    std::string path_;
    SourceLocation where_;
};

// toml++ limits how deep values nest, but recurses for each part of a dotted key: a few kilobytes of text
// would overflow a thread's stack. So anything deeper than any scene is found before toml++ reads the text.

struct TooDeep {
    SourceLocation where;
    std::string what;  ///< what is wrong and what to do
};

/// The first key with more than kMaxKeyParts parts, or the first array or inline table inside kMaxNesting
/// others. For text that is not TOML, the result is right up to its first mistake.
std::optional<TooDeep> too_deep(std::string_view toml);

}  // namespace carom::detail
