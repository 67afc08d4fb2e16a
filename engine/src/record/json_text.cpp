#include "record/json_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "base/as_number.h"
#include "carom/engine/printable.h"
#include "carom/engine/scene.h"

namespace carom::detail {
namespace {

using Json = nlohmann::json;

/// [bytes] Long enough for any id or method name, and short enough that a hostile file cannot fill messages.
constexpr std::size_t kLongestName = 256;
/// [bytes] Largest size of one byte of text as an escape: \u0000.
constexpr std::size_t kLongestEscape = 6;
/// The largest number in a record: far larger than scene values in any unit, and small enough that products
/// of a few such numbers, as in states and orientations, are finite.
constexpr double kLargestNumber = 1e25;

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

std::size_t after_space(std::string_view text, std::size_t at) {
    while (at < text.size() && is_space(text[at])) ++at;
    return at;
}

/// Returns the position after the string that begins at `at`.
std::size_t after_string(std::string_view text, std::size_t at) {
    for (++at; at < text.size() && text[at] != '"'; ++at)
        if (text[at] == '\\') ++at;
    return at < text.size() ? at + 1 : text.size();
}

/// Returns the position after a number, true, false or null.
std::size_t after_word(std::string_view text, std::size_t at) {
    const auto ends = [](char c) { return is_space(c) || c == ',' || c == ']' || c == '}'; };
    while (at < text.size() && !ends(text[at])) ++at;
    return at;
}

/// Returns the position after the value that begins at `at`.
std::size_t after_value(std::string_view text, std::size_t at) {
    if (at < text.size() && text[at] != '{' && text[at] != '[')
        return text[at] == '"' ? after_string(text, at) : after_word(text, at);
    std::size_t depth = 0;
    while (at < text.size()) {
        const char c = text[at];
        if (c == '"') {
            at = after_string(text, at);
            continue;
        }
        ++at;
        if (c == '{' || c == '[') ++depth;
        if ((c == '}' || c == ']') && --depth == 0) break;
    }
    return at;
}

/// Returns the text of a string token, or "" if it is too long to be any name.
std::string unescaped(std::string_view token) {
    if (token.size() > 2 + kLongestEscape * kLongestName) return "";
    return Json::parse(token).get<std::string>();
}

/// Returns line and column of a byte, for an editor, within one byte.
SourceLocation location(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, byte > 0 ? byte - 1 : 0);
    const std::size_t line_start = before.rfind('\n') + 1;  // 0 in the first line
    return {1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
            1 + static_cast<int>(before.size() - line_start)};
}

/// Accepts every value and keeps none.
class Checker final : public nlohmann::json_sax<Json> {
  public:
    Checker(std::string_view text, const std::string& file) : text_(text), file_(file) {}
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return true; }
    bool key(string_t&) override { return true; }
    bool end_object() override { return true; }
    bool start_array(std::size_t) override { return true; }
    bool end_array() override { return true; }
    bool parse_error(std::size_t byte, const std::string&, const Json::exception& error) override {
        constexpr int kNumberOverflow = 406;
        throw SceneError(file_, location(text_, byte),
                         error.id == kNumberOverflow ? "this JSON cannot be read: a number is too large"
                                                     : "this is not JSON, or the file was cut short");
    }

  private:
    std::string_view text_;
    const std::string& file_;
};

}  // namespace

JsonText::JsonText(std::string_view whole, const std::string& name) : text(whole), file(name) {
    Checker checker(text, file);
    Json::sax_parse(text, &checker);
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    root = after_space(text,
                       text.substr(0, kByteOrderMark.size()) == kByteOrderMark ? kByteOrderMark.size() : 0);
}

std::string JsonValue::where() const {
    if (parent_ == nullptr) return "";
    const std::string before = parent_->where();
    if (key_.empty()) return before + "[" + std::to_string(index_) + "]";
    return before.empty() ? std::string(key_) : before + "." + std::string(key_);
}

void JsonValue::fail(const std::string& message) const {
    const std::string path = where();
    throw SceneError(source_.file, {}, (path.empty() ? "" : path + ": ") + message);
}

void JsonValue::fail_unknown(const std::string& name) const {
    fail("unknown name " + in_quotes(name));
}

std::string_view JsonValue::token() const {
    return source_.text.substr(at_, after_value(source_.text, at_) - at_);
}

std::size_t JsonValue::first_item() const {
    const std::size_t at = after_space(source_.text, at_ + 1);
    return at >= source_.text.size() || source_.text[at] == ']' || source_.text[at] == '}' ? kNone : at;
}

std::size_t JsonValue::next_item(std::size_t item) const {
    const std::size_t comma = after_space(source_.text, after_value(source_.text, item));
    if (comma >= source_.text.size() || source_.text[comma] != ',') return kNone;
    return after_space(source_.text, comma + 1);
}

std::size_t JsonValue::size() const {
    std::size_t count = 0;
    each([&](const JsonValue&, std::size_t) { ++count; });
    return count;
}

double JsonValue::number() const {
    const char c = first();
    if (c != '-' && (c < '0' || c > '9')) fail("expected a number");
    const std::string_view digits = token();
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    // The check of the whole text refuses numbers that are too large, so this one is too close to 0 for a
    // double.
    if (error == std::errc::result_out_of_range) value = c == '-' ? -0.0 : 0.0;
    if (!(std::abs(value) <= kLargestNumber))
        fail("expected a number of at most 1e25, which no shot exceeds");
    return value;
}

double JsonValue::non_negative() const {
    const double value = number();
    if (value < 0.0) fail("expected a number of at least 0");
    return value;
}

double JsonValue::positive() const {
    const double value = number();
    if (!(value > 0.0)) fail("expected a number greater than 0");
    return value;
}

std::int64_t JsonValue::integer(std::int64_t least, std::int64_t most) const {
    if (most < least) fail("this index has nothing to refer to");
    const auto value = as_number<std::int64_t>(token());
    if (!value || *value < least || *value > most)
        fail("expected an integer from " + std::to_string(least) + " to " + std::to_string(most));
    return *value;
}

bool JsonValue::boolean() const {
    if (first() != 't' && first() != 'f') fail("expected true or false");
    return first() == 't';
}

std::string JsonValue::text() const {
    if (first() != '"') fail("expected a string");
    const std::string_view written = token();
    const std::string_view inside = written.substr(1, written.size() - 2);
    const bool plain = inside.find('\\') == std::string_view::npos;
    const bool far_too_long = inside.size() > (plain ? kLongestName : kLongestEscape * kLongestName);
    std::string value;
    if (!far_too_long) value = plain ? std::string(inside) : unescaped(written);
    if (far_too_long || value.size() > kLongestName)
        fail("the string is longer than " + std::to_string(kLongestName) + " bytes");
    return value;
}

JsonObject::JsonObject(const JsonValue& value, std::span<const std::string_view> keys) : value_(value) {
    if (!value.is_object()) value.fail("expected an object");
    if (keys.size() > kMost) throw std::logic_error("JsonObject: too many keys");
    for (const std::string_view key : keys) keys_[count_++] = key;
    at_.fill(JsonValue::kNone);
    const std::string_view text = value.source_.text;
    for (std::size_t at = value.first_item(); at != JsonValue::kNone;) {
        const std::size_t end = after_string(text, at);
        std::string_view key = text.substr(at + 1, end - at - 2);
        std::string other;  // the same key without escapes
        if (key.find('\\') != std::string_view::npos) key = other = unescaped(text.substr(at, end - at));
        const std::size_t member = after_space(text, after_space(text, end) + 1);  // past the colon
        std::size_t i = 0;
        while (i < count_ && keys_[i] != key) ++i;
        if (i == count_)
            note_unknown(key);
        else if (at_[i] != JsonValue::kNone)
            value.fail("the key " + in_quotes(key) + " appears twice");
        else
            at_[i] = member;
        at = value.next_item(member);
    }
}

std::size_t JsonObject::index(std::string_view key) const {
    for (std::size_t i = 0; i < count_; ++i)
        if (keys_[i] == key) return i;
    throw std::logic_error("JsonObject: asked for a key that is not in its list");
}

JsonValue JsonObject::at(std::string_view key) const {
    const std::size_t i = index(key);
    if (at_[i] == JsonValue::kNone) value_.fail("the key \"" + std::string(key) + "\" is missing");
    return {value_, keys_[i], 0, at_[i]};
}

void JsonObject::note_unknown(std::string_view key) const {
    JsonText& source = value_.source_;
    if (source.unknown_keys++ > 0) return;
    const std::string path = value_.where();
    source.first_unknown = (path.empty() ? "" : path + ".") + printable(key);
}

}  // namespace carom::detail
