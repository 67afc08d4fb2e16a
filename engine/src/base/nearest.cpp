#include "base/nearest.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <string>

namespace carom {
namespace {

// [bytes] No name is longer; the limit bounds the work for any file.
constexpr std::size_t kLongestWord = 40;
constexpr std::size_t kTooFar = 1000;  // [edits]

char small(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Number of letters to add, drop, change or swap with their neighbour, none of them twice, to turn one word
/// into the other.
std::size_t edits_between(std::string_view from, std::string_view to) {
    using Row = std::array<std::size_t, kLongestWord + 1>;
    Row before_last{}, last{}, row{};
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= from.size(); ++i) {
        row[0] = i;
        for (std::size_t k = 1; k <= to.size(); ++k) {
            const bool same = small(from[i - 1]) == small(to[k - 1]);
            row[k] = std::min({last[k - 1] + (same ? 0 : 1), last[k] + 1, row[k - 1] + 1});
            if (i > 1 && k > 1 && small(from[i - 1]) == small(to[k - 2]) &&
                small(from[i - 2]) == small(to[k - 1]))
                row[k] = std::min(row[k], before_last[k - 2] + 1);
        }
        before_last = last;
        last = row;
    }
    return last[to.size()];
}

/// A word in small letters, with its number spelled out: "8-Ball" and "eight_ball" are "eightball".
std::string spelled(std::string_view word) {
    constexpr std::string_view kNumbers[][2] = {{"10", "ten"},  {"8", "eight"}, {"9", "nine"},
                                                {"3", "three"}, {"4", "four"},  {"1", "one"}};
    std::string text;
    for (const auto& [digits, number] : kNumbers)
        if (text.empty() && word.starts_with(digits)) text = number, word.remove_prefix(digits.size());
    for (const char c : word)
        if (c != '_' && c != '-' && c != ' ') text += small(c);
    return text;
}

std::size_t steps_to(std::string_view word, std::string_view name) {
    constexpr std::size_t kMostEdits = 2, kLeastStem = 3;
    if (word != name && word.size() <= kLongestWord && spelled(word) == spelled(name)) return 0;
    if (word == name || word.size() > kLongestWord || name.size() > kLongestWord) return kTooFar;
    const std::size_t stem = std::min(word.size(), name.size());
    if (stem >= kLeastStem && edits_between(word.substr(0, stem), name.substr(0, stem)) == 0)
        return std::min(edits_between(word, name), kMostEdits);
    const std::size_t n = edits_between(word, name);
    return n <= kMostEdits && 2 * n < std::max(word.size(), name.size()) ? n : kTooFar;
}

}  // namespace

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& names) {
    std::size_t least = kTooFar;
    std::vector<std::string_view> nearest;
    for (const std::string_view name : names) {
        const std::size_t n = steps_to(word, name);
        if (n > least || n == kTooFar) continue;
        if (n < least) nearest.clear();
        least = n;
        nearest.push_back(name);
    }
    std::string out;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
        out += i == 0 ? "; did you mean " : i + 1 == nearest.size() ? " or " : ", ";
        out += nearest[i];
    }
    return nearest.empty() ? out : out + "?";
}

}  // namespace carom
