// Makes text from a file safe to print in a message.
#pragma once

#include <string>
#include <string_view>

namespace carom {

/// `text`, safe for a terminal: control characters, writing-direction marks and bytes that are not UTF-8
/// become "?"; text longer than 60 bytes is cut and ends in "...".
std::string printable(std::string_view text);

/// printable() without the cut; keeps line ends and tabs.
std::string harmless(std::string_view text);

/// Whether printable() would change nothing except the length.
bool is_plain(std::string_view text);

bool is_utf8(std::string_view text);

/// printable() between quotes.
std::string in_quotes(std::string_view text);

}  // namespace carom
