// Text to number.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace carom {

/// The number that the whole text represents, in any locale; nothing if it is no number, or too large.
template <class Number>
std::optional<Number> as_number(std::string_view text) {
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || rest != end) return std::nullopt;
    return number;
}

}  // namespace carom
