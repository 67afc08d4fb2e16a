#include "scene/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

#include "carom/engine/tolerances.h"

namespace carom::detail {
namespace {

// End of the string that begins at `at`. A string must be closed on its line unless it has three quotes.
std::size_t string_end(std::string_view toml, std::size_t at) {
    const char quote = toml[at];
    const auto marks = [&] { return std::min(toml.find_first_not_of(quote, at), toml.size()) - at; };
    const bool many_lines = marks() >= 3;
    for (at += many_lines ? 3 : 1; at < toml.size(); ++at) {
        if (toml[at] == '\n' && !many_lines) return at;
        // Up to two quotation marks may precede the closing three.
        if (toml[at] == quote && (!many_lines || marks() >= 3))
            return at + (many_lines ? std::min<std::size_t>(marks(), 5) : 1);
        if (toml[at] == '\\' && quote == '"') ++at;
    }
    return toml.size();
}

SourceLocation location(std::string_view before) {
    const std::string_view line = before.substr(before.rfind('\n') + 1);  // from 0 if there is none
    const auto characters =
        std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
    return {1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
            1 + static_cast<int>(characters)};
}

}  // namespace

std::optional<TooDeep> too_deep(std::string_view toml) {
    int parts = 1, depth = 0;
    bool in_value = false;
    for (std::size_t at = 0; at < toml.size(); ++at) {
        const char c = toml[at];
        if (c == '"' || c == '\'')
            at = string_end(toml, at) - 1;
        else if (c == '#')
            at = std::min(toml.find('\n', at), toml.size()) - 1;
        else if (c == '.' && ++parts > kMaxKeyParts)
            return TooDeep{location(toml.substr(0, at)),
                           fmt::format("this key has more than {} parts; remove some dots", kMaxKeyParts)};
        if (std::string_view("=,[]{}\n").find(c) == std::string_view::npos) continue;
        parts = 1;
        if (c == '=') in_value = true;
        if (c == ']' || c == '}') depth = std::max(0, depth - 1);
        if ((c == '[' || c == '{') && ++depth > kMaxNesting)
            return TooDeep{
                location(toml.substr(0, at)),
                fmt::format("brackets are nested more than {} deep here; close some above, or nest fewer",
                            kMaxNesting)};
        if (c == '\n') {
            // Only a value may continue on the next line. toml++ describes an unclosed bracket of a section
            // better.
            if (!in_value) depth = 0;
            in_value = depth > 0;
        }
    }
    return std::nullopt;
}

}  // namespace carom::detail
