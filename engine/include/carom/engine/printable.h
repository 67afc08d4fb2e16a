// Text from a file, made fit for a message.
#pragma once

#include <string>
#include <string_view>

namespace carom {

/// `text` as a terminal may have it: what could steer one (control characters,
/// marks that turn the direction of writing, bytes that are no UTF-8) becomes
/// "?", and what is longer than 60 bytes is cut and ends in "...".
std::string printable(std::string_view text);

/// printable() without the cut; line ends and tabs stay.
std::string harmless(std::string_view text);

/// Whether printable() would change nothing but the length.
bool is_plain(std::string_view text);

bool is_utf8(std::string_view text);

/// printable() between quotes.
std::string in_quotes(std::string_view text);

}  // namespace carom
