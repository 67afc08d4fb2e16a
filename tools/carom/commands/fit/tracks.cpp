#include "commands/fit/tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>

#include "base/as_number.h"
#include "base/console.h"
#include "carom/engine/printable.h"
#include "carom/engine/tolerances.h"

namespace carom::tools {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"t", "ball", "x", "y"};

/// A value of a line, and the column of text at which it begins.
struct Word {
    std::string_view text;
    std::size_t column;
};

std::vector<Word> words_of(std::string_view line, char separator) {
    std::vector<Word> words;
    for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t end = std::min(line.find(separator, begin), line.size());
        std::size_t first = begin, last = end;
        while (first < last && (line[first] == ' ' || line[first] == '"')) ++first;
        while (last > first && (line[last - 1] == ' ' || line[last - 1] == '"')) --last;
        words.push_back({line.substr(first, last - first), first + 1});
        begin = end + 1;
    }
    return words;
}

std::string text_of(const std::string& path) {
    std::error_code error;
    std::ifstream in(path, std::ios::binary);
    const auto size = std::filesystem::file_size(path, error);
    if (!in || error)
        throw UsageError(harmless(path) + ": cannot be read; check the path and its permissions");
    if (size > kMaxRecordSize)
        throw UsageError(harmless(path) + ": the file is too large; split it by shots");
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

std::vector<games::TrackPoint> read_tracks(const std::string& path, const Scene& scene) {
    const std::string text = text_of(path);
    std::vector<games::TrackPoint> points;
    std::optional<std::array<std::size_t, kNames.size()>> places;
    std::size_t line_number = 0;
    char separator = ',';
    const auto fail = [&](std::size_t column, const std::string& what) {
        throw UsageError(fmt::format("{}:{}:{}: {}", harmless(path), line_number, column, what));
    };
    std::string_view rest = text;
    // Spreadsheets begin a file of UTF-8 with a byte-order mark.
    if (constexpr std::string_view kMark = "\xEF\xBB\xBF"; rest.starts_with(kMark))
        rest.remove_prefix(kMark.size());
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        ++line_number;
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line.empty() || line.front() == '#') continue;
        if (const std::size_t at = line.find_first_of(",;\t"); !places && at != line.npos)
            separator = line[at];
        std::string small(places ? "" : line);
        for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        const std::vector<Word> words = words_of(places ? line : small, separator);
        if (!places) {
            places.emplace();
            for (std::size_t k = 0; k < kNames.size(); ++k) {
                const auto found = std::find_if(words.begin(), words.end(), [&](const Word& word) {
                    return word.text == kNames[k] || (k == 0 && word.text == "time");
                });
                if (found == words.end())
                    fail(1,
                         fmt::format("there is no column {} in {}; name the columns t,ball,x,y in the first "
                                     "line, and separate them by commas, semicolons or tabs",
                                     kNames[k], in_quotes(line)));
                (*places)[k] = static_cast<std::size_t>(found - words.begin());
            }
            continue;
        }
        const auto word = [&](std::size_t k) {
            if ((*places)[k] >= words.size())
                fail(line.size() + 1, fmt::format("the line has no {}; add it", kNames[k]));
            return words[(*places)[k]];
        };
        const auto number = [&](std::size_t k) {
            const Word at = word(k);
            if (at.text.empty() && k >= 2) return std::nan("");
            const auto value = as_number<double>(at.text);
            if (!value || (k < 2 && !(*value >= 0.0)))
                fail(at.column,
                     fmt::format("{} is not a {}; write a number in {}{}", in_quotes(std::string(at.text)),
                                 k < 2 ? "time since the stroke" : "coordinate", k < 2 ? "s" : "m",
                                 at.text.find(',') == at.text.npos ? "" : ", with a decimal point"));
            if (std::isinf(*value))
                fail(at.column, "a position must be finite; leave it empty if the ball was not seen");
            return *value;
        };
        const double t = number(0), x = number(2), y = number(3);
        const Word id = word(1);
        const int ball = index_of(scene.ball, id.text);
        if (ball < 0)
            fail(id.column, fmt::format("the scene has no ball {}; name the tracks as the scene does",
                                        in_quotes(std::string(id.text))));
        if (std::isnan(x) || std::isnan(y)) continue;
        points.push_back({t, ball, Vec2(x, y)});
    }
    line_number = std::max<std::size_t>(line_number, 1);
    if (points.empty())
        fail(1, "there are no positions; add lines such as 0.05,cue,0.61,1.95 below t,ball,x,y");
    return points;
}

}  // namespace carom::tools
