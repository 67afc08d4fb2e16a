#include "carom/engine/printable.h"

#include <cstddef>
#include <cstdint>

namespace carom {
namespace {

constexpr std::size_t kLongest = 60;  // [bytes] longer texts are cut

/// Length in bytes of the UTF-8 character at the start of `text`, and its code point in `code`; 0 if invalid.
std::size_t character(std::string_view text, std::uint32_t& code) {
    const auto byte = [&](std::size_t i) {
        return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
    };
    const std::uint32_t first = byte(0);
    const std::size_t size = first < 0x80   ? 1
                             : first < 0xc2 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
    if (size == 0 || size > text.size()) return 0;
    constexpr std::uint32_t kBitsOfFirst[] = {0, 0x7f, 0x1f, 0x0f, 0x07};
    code = first & kBitsOfFirst[size];
    for (std::size_t i = 1; i < size; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return 0;
        code = code << 6 | (byte(i) & 0x3f);
    }
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    return code < kLeast[size] || code > 0x10ffff || surrogate ? 0 : size;
}

bool steers(std::uint32_t code) {
    return code < 0x20 || (code >= 0x7f && code <= 0x9f) ||       // control characters
           code == 0x061c || code == 0x200e || code == 0x200f ||  // direction marks
           (code >= 0x2028 && code <= 0x202e) ||                  // line ends, embeddings, overrides
           (code >= 0x2066 && code <= 0x2069) || code == 0xfeff;  // isolates, byte order mark
}

/// Calls take(character, whether it is safe for a terminal) for every character until it returns false.
template <class Take>
void each_character(std::string_view text, Take&& take) {
    for (std::size_t at = 0, length = 0; at < text.size(); at += length) {
        std::uint32_t code = 0;
        const std::size_t size = character(text.substr(at), code);
        length = size == 0 ? 1 : size;
        if (!take(text.substr(at, length), size != 0 && !steers(code))) return;
    }
}

}  // namespace

std::string printable(std::string_view text) {
    std::string out;
    std::size_t taken = 0;
    each_character(text, [&](std::string_view one, bool plain) {
        taken += one.size();
        if (taken > kLongest) {
            out += "...";
            return false;
        }
        out += plain ? one : "?";
        return true;
    });
    return out;
}

std::string harmless(std::string_view text) {
    std::string out;
    each_character(text, [&](std::string_view one, bool plain) {
        out += plain || one == "\n" || one == "\t" ? one : "?";
        return true;
    });
    return out;
}

bool is_plain(std::string_view text) {
    bool all = true;
    each_character(text, [&](std::string_view, bool plain) { return all = all && plain; });
    return all;
}

bool is_utf8(std::string_view text) {
    for (std::size_t at = 0, size = 0; at < text.size(); at += size) {
        std::uint32_t code = 0;
        size = character(text.substr(at), code);
        if (size == 0) return false;
    }
    return true;
}

std::string in_quotes(std::string_view text) {
    std::string out = "\"";
    out += printable(text);
    return out += '"';
}

}  // namespace carom
