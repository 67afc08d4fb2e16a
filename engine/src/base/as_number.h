// A text that is a number.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace carom {

/// The number that the whole text is, however the locale writes numbers; nothing if it is none, or too large.
template <class Number>
std::optional<Number> as_number(std::string_view text) {
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || rest != end) return std::nullopt;
    return number;
}

}  // namespace carom
