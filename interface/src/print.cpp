// The types of the interface as a reference page, Python classes and TypeScript interfaces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <string>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/games/rules.h"
#include "carom/games/solve.h"
#include "carom/interface/shape.h"

namespace carom::interface {
namespace {

using Kind = Shape::Kind;

std::string quoted_names(const Shape& choice, const char* between = ", ") {
    return fmt::format("\"{}\"", fmt::join(choice.names, fmt::format("\"{}\"", between)));
}

/// A type in words: "2: 0 to 9".
std::string in_words(const Shape& shape, const Shape::Limits& limits) {
    const Whole& range = limits.range;
    switch (shape.kind) {
        case Kind::kTruth:
            return "truth";
        case Kind::kWhole:
            return range.least == range.most ? "whole number"
                                             : fmt::format("{} to {}", range.least, range.most);
        case Kind::kNumber:
            return limits.may_be_nan ? "number or null" : "number";
        case Kind::kText:
            return "text";
        case Kind::kChoice:
            if (&shape == &shape_of<games::Game>()) return "game";
            return quoted_names(shape);
        case Kind::kList:
            return "list: " + in_words(shape.item(), limits);
        case Kind::kArray:
            return fmt::format("{}: {}", shape.count, in_words(shape.item(), limits));
        case Kind::kOptional:
            return in_words(shape.item(), limits) + " or null";
        case Kind::kType:
            break;
    }
    return fmt::format("[{0}](#{1})", shape.name, [&] {
        std::string anchor = shape.name;
        for (char& c : anchor) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
        return anchor;
    }());
}

/// How a language writes types; {} is the inner type.
struct Language {
    const char *truth, *whole, *number, *text, *scene, *null, *game, *choice, *between, *numbers, *list,
        *array;
};
constexpr Language kPython{"bool",     "int",      "float",       "str", "Scene",
                           "None",     "GameName", "Literal[{}]", ", ",  "NDArray[np.float64]",
                           "list[{}]", "tuple[{}]"};
/// Of values that callers make, which can be hashed.
constexpr Language kFixedPython = [] {
    Language fixed = kPython;
    fixed.list = "tuple[{}, ...]";
    return fixed;
}();
constexpr Language kTypeScript{"boolean", "number", "number", "string", "string", "null",
                               "Game",    "{}",     " | ",    "{}[]",   "{}[]",   "[{}]"};

std::string in_code(const Shape& shape, const Language& of) {
    switch (shape.kind) {
        case Kind::kTruth:
            return of.truth;
        case Kind::kWhole:
            return of.whole;
        case Kind::kNumber:
            return of.number;
        case Kind::kText:
            return *shape.name == '\0' ? of.text : of.scene;
        case Kind::kChoice:
            if (&shape == &shape_of<games::Game>()) return of.game;
            return fmt::format(fmt::runtime(of.choice), quoted_names(shape, of.between));
        case Kind::kList:
            return fmt::format(fmt::runtime(shapes::is_numbers(shape) ? of.numbers : of.list),
                               in_code(shape.item(), of));
        case Kind::kOptional:
            return in_code(shape.item(), of) + " | " + of.null;
        case Kind::kType:
            return shape.name;
        case Kind::kArray:
            break;
    }
    const std::vector<std::string> items(shape.count, in_code(shape.item(), of));
    return fmt::format(fmt::runtime(of.array), fmt::join(items, ", "));
}

std::string python_default(const Value& value) {
    if (value.is_null()) return "None";
    if (value.is_boolean()) return value.get<bool>() ? "True" : "False";
    if (!value.is_array()) return value.dump();
    std::vector<std::string> items;
    for (const Value& each : value) items.push_back(python_default(each));
    return fmt::format("({}{})", fmt::join(items, ", "), items.size() == 1 ? "," : "");
}

/// Lines of at most 110 columns; later ones begin with `indent`. @param between  where a line may end
std::string wrapped(std::string text, const std::string& between, const std::string& indent) {
    constexpr std::size_t kWidth = 110;
    std::string lines;
    while (text.size() > kWidth) {
        const std::size_t end = text.rfind(between, kWidth - between.size());
        if (end == text.npos || end <= indent.size()) break;
        const std::size_t past = end + between.size();
        lines += text.substr(0, past);
        while (lines.back() == ' ') lines.pop_back();
        lines += "\n";
        text = indent + text.substr(past);
    }
    return lines + text + "\n";
}

/// An outcome of n shots of b balls: "(n, b) [s] its meaning".
std::string in_words(const OutcomeColumn& column) {
    return fmt::format("(n{}) {}{}{}",
                       column.per_ball == 0   ? ""
                       : column.per_ball == 1 ? ", b"
                                              : fmt::format(", b, {}", column.per_ball),
                       kind_of(column) == ValueKind::kText ? fmt::format("index of the {} ", column.unit)
                       : *column.unit != '\0'              ? fmt::format("[{}] ", column.unit)
                                                           : "",
                       column.meaning, column.on_request ? ", on request" : "");
}

}  // namespace

std::string types_page() {
    std::string text =
        "# Types of the interface\n\nIn JSON (`carom judge --json`, `--state`), C (`carom_value`), "
        "JavaScript, and Python's `carom` and `carom.games`. Missing keys have defaults.\n";
    const std::array kElsewhere = {&shape_of<games::Hand>(), &shape_of<games::Unknown>(),
                                   &shape_of<games::Fall>(), &shape_of<games::Cost>()};
    for (const Shape* type : types()) {
        // For Python; people read the options of a search.
        if (std::find(kElsewhere.begin(), kElsewhere.end(), type) != kElsewhere.end()) continue;
        text += fmt::format("\n## {}\n\n{}\n", type->name, type->meaning);
        if (type->rows.front().set != nullptr) {
            text += "Its keys are [those of the file](scene_format.md).\n";
            continue;
        }
        text += "\n| key | value | meaning |\n|---|---|---|\n";
        for (const Shape::Member& row : type->rows)
            text +=
                fmt::format("| `{}` | {} | {} |\n", row.key, in_words(row.shape(), row.limits), row.meaning);
    }
    text +=
        "\n## Outcomes\n\nOf n shots of b balls: arrays in C (`carom_batch_column`), Python (`Shots`) and "
        "JavaScript "
        "(`Batch`). Sweeps and data frames have `ID.x`, ..., and names for indices. No result: NaN, 0, "
        "-1.\n\n"
        "| name | meaning |\n|---|---|\n";
    for (const OutcomeColumn& column : kOutcomeColumns)
        text += fmt::format("| `{}` | {} |\n", column.name, in_words(column));
    return text;
}

std::string types_for_python() {
    std::string text = "# begin GameName\n" +
                       wrapped("GameName: TypeAlias = Literal[" + quoted_names(shape_of<games::Game>()) + "]",
                               ", ", std::string(30, ' ')) +
                       "# end GameName\n";
    for (const Shape* type : types()) {
        text += fmt::format("\n\n# begin {0}\nclass {0}(NamedTuple):\n", type->name) +
                wrapped(fmt::format("    \"\"\"{}\"\"\"", type->meaning), " ", "    ") + "\n";
        // Texts and computed members at the end have defaults: a caller need not give them.
        const auto required = std::find_if(type->rows.rbegin(), type->rows.rend(), [](const auto& row) {
            return !row.is_computed() && row.shape().kind != Kind::kText;
        });
        for (const Shape::Member& row : type->rows) {
            std::string member =
                fmt::format("    {}: {}", row.key,
                            in_code(row.shape(), type->is_made_by_callers ? kFixedPython : kPython));
            if (type->is_made_by_callers && !row.is_needed)
                member += " = " + python_default(type->default_value().at(row.key));
            else if (!type->is_made_by_callers && &row > &*required)
                member += row.shape().kind == Kind::kTruth ? " = False" : " = \"\"";
            text += wrapped(fmt::format("    #: {}", row.meaning), " ", "    #: ") +
                    wrapped(member, ", ", "        ");
        }
        text += fmt::format("# end {}\n", type->name);
    }
    text += "    # begin outcomes\n";
    for (const OutcomeColumn& column : kOutcomeColumns)
        text += wrapped(fmt::format("    #: {}", in_words(column)), " ", "    #: ") +
                fmt::format("    {}: NDArray[np.{}]{}\n", column.name, name(column.type),
                            column.on_request ? " | None" : "");
    return text + "    # end outcomes\n";
}

std::string types_for_typescript() {
    std::string many, shot, ball;
    for (const OutcomeColumn& column : kOutcomeColumns) {
        std::string array = name(column.type);
        array.front() = static_cast<char>(std::toupper(array.front()));
        if (array.starts_with("Int64") || array.starts_with("Uint64")) array = "Big" + array;
        many += wrapped(fmt::format("  /** {} */", in_words(column)), " ", "   * ") +
                fmt::format("  {}{}: {}Array;\n", column.name, column.on_request ? "?" : "", array);
        if (!column.on_request && column.per_ball < 2)
            (column.per_ball == 0 ? shot : ball) +=
                fmt::format("{}{}: {};\n", column.per_ball == 0 ? "  " : "    ", column.name,
                            kind_of(column) == ValueKind::kText ? "string" : "number");
    }
    std::string text =
        "// begin types\n" +
        wrapped("export type Game = " + quoted_names(shape_of<games::Game>(), " | ") + ";", " | ", "  ");
    for (const Shape* type : types()) {
        text += "\n" + wrapped(fmt::format("/** {} */", type->meaning), " ", " * ") +
                fmt::format("export interface {} {{\n", type->name);
        for (const Shape::Member& row : type->rows)
            text +=
                wrapped(fmt::format("  /** {} */", row.meaning), " ", "   * ") +
                wrapped(fmt::format("  {}: {};", row.key, in_code(row.shape(), kTypeScript)), " | ", "    ");
        text += "}\n";
    }
    return text + "// end types\n" +
           fmt::format(
               "  // begin outcomes\n{}  // end outcomes\n  // begin outcome\n{}  // end outcome\n    // "
               "begin "
               "ball_outcome\n{}    // end ball_outcome\n",
               many, shot, ball);
}

}  // namespace carom::interface
