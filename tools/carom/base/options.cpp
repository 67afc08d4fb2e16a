#include "base/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "base/as_number.h"
#include "base/console.h"
#include "base/nearest.h"
#include "base/output_file.h"
#include "carom/engine/printable.h"

namespace carom::tools {
namespace {

template <class T>
constexpr bool kIsList = false;
template <class T>
constexpr bool kIsList<std::vector<T>> = true;

/// Formats options in --help the same with every release of CLI11, whose own formats differ (2.1: "S=0", 2.4:
/// "S [0]").
class HelpFormatter : public CLI::Formatter {
  public:
    /// The text after the name: type and choices, default, whether it may be repeated, and which options it
    /// needs or excludes.
    std::string make_option_opts(const CLI::Option* option) const override {
        if (option->get_type_size() == 0) return "";
        std::string text;
        if (!option->get_type_name().empty()) text += " " + option->get_type_name();
        if (!option->get_default_str().empty()) text += "=" + option->get_default_str();
        if (option->get_expected_max() == CLI::detail::expected_max_vector_size) text += " ...";
        if (option->get_required()) text += " REQUIRED";
        for (const CLI::Option* other : option->get_needs()) text += " Needs: " + other->get_name();
        for (const CLI::Option* other : option->get_excludes()) text += " Excludes: " + other->get_name();
        return text;
    }
};

/// CLI::IsMember, but the message suggests the nearest choice.
CLI::Validator is_choice(const std::vector<std::string>& choices) {
    const std::string all = fmt::format("{{{}}}", fmt::join(choices, ","));
    const auto problem = [choices, all](const std::string& text) {
        if (std::find(choices.begin(), choices.end(), text) != choices.end()) return std::string();
        return fmt::format("{}: expected one of {}{}", printable(text), all,
                           did_you_mean(text, {choices.begin(), choices.end()}));
    };
    return {problem, all};
}

void restrict(CLI::Option& option, CLI::App& app, const Option& row) {
    if (!row.value.empty()) option.type_name(row.value);
    if (!row.choices.empty()) option.check(is_choice(row.choices));
    if (!row.needs.empty()) option.needs(app.get_option(row.needs));
    if (!row.excludes.empty()) option.excludes(app.get_option(row.excludes));
    option.required(row.required);
    option.default_str(row.default_text());
}

/// Checks for a whole, non-negative number; CLI11 would read -1 as the largest one.
std::string is_count(const std::string& text) {
    return as_number<std::uint64_t>(text) ? "" : text + ": expected 0 to 18446744073709551615";
}

template <class T>
void add_option(CLI::App& app, const Option& row, const std::string& names, T& variable) {
    CLI::Option* option = app.add_option(names, variable, row.text);
    if constexpr (kIsList<T>) option->allow_extra_args(row.by_place());
    if constexpr (std::is_same_v<T, std::vector<int>> || std::is_same_v<T, std::vector<double>>)
        option->delimiter(',');
    if constexpr (std::is_same_v<T, std::uint64_t>) option->check(is_count);
    if (row.range) {
        const auto [least, most] = *row.range;
        constexpr bool kReal = std::is_same_v<T, double> || std::is_same_v<T, std::vector<double>>;
        if constexpr (kReal)
            option->check(CLI::Range(least, most));
        else
            option->check(CLI::Range(static_cast<std::int64_t>(least), static_cast<std::int64_t>(most)));
    }
    restrict(*option, app, row);
}

/// Passes a command's table to CLI11. `named` becomes the command named on the command line.
void fill(CLI::App& app, const Options& command, const Options*& named) {
    if (!command.footer.empty()) app.footer(command.footer);
    // if no command is named, run_command_line reports it better than CLI11
    app.require_subcommand(0, 1);
    for (const Option& row : command.rows) {
        const auto names = fmt::format("{}", fmt::join(row.names, ","));
        std::visit(
            [&](auto variable) {
                using T = std::remove_pointer_t<decltype(variable)>;
                if constexpr (std::is_same_v<T, bool>)
                    app.add_flag((*variable ? "!" : "") + names, *variable, row.text);
                else if constexpr (!std::is_same_v<T, std::monostate>)
                    add_option(app, row, names, *variable);
            },
            row.target);
    }
    app.callback([&app, &command, &named] {
        if (app.get_subcommands().empty()) named = &command;
    });
    for (const Options& inner : command.commands) {
        CLI::App& below = *app.add_subcommand(inner.name, inner.text);
        if (!inner.group.empty()) below.group(inner.group);
        fill(below, inner, named);
    }
}

/// "simulate, render or check".
std::string listed(const std::list<Options>& commands) {
    std::string text;
    for (const Options& command : commands)
        text += (text.empty() ? "" : &command == &commands.back() ? " or " : ", ") + command.name;
    return text;
}

/// The program and the commands named on the command line: "carom-lab bench".
std::string path_of(const CLI::App& app) {
    const std::vector<CLI::App*> named = app.get_subcommands();
    return app.get_name() + (named.empty() ? "" : " " + path_of(*named.front()));
}

/// The arguments in CLI11's order, last first. Turns `carom help [COMMAND]` and `carom version` into `--help`
/// and `--version`, and reports a first word that is neither a command nor an option. @throws UsageError
std::vector<std::string> with_spelled_help(const Options& program, int argc, char** argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    const auto named = [&program](const std::string& word) {
        return std::any_of(program.commands.begin(), program.commands.end(),
                           [&word](const Options& command) { return command.name == word; });
    };
    if (!words.empty() && words[0] == "help") {
        words.erase(words.begin());
        words.emplace_back("--help");
    } else if (!words.empty() && words[0] == "version") {
        words[0] = "--version";
    } else if (!words.empty() && !words[0].starts_with('-') && !named(words[0])) {
        if (std::filesystem::exists(words[0]))
            throw UsageError(
                fmt::format("{}: no command before the file; try carom simulate {}", words[0], words[0]));
        std::vector<std::string_view> names;
        for (const Options& command : program.commands) names.emplace_back(command.name);
        const std::string near = did_you_mean(words[0], names);
        throw UsageError(fmt::format("unknown command {}{}", in_quotes(words[0]),
                                     near.empty() ? "; expected " + listed(program.commands) : near));
    }
    std::reverse(words.begin(), words.end());
    return words;
}

/// The program's message about a bad command line, from CLI11's.
std::string explained(const CLI::ParseError& error, const Options& program, int argc, char** argv) {
    std::string what = error.what();
    if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
        const std::size_t colon = what.find(": "), equals = what.find(" = ");
        if (colon != what.npos && equals != what.npos)
            what = fmt::format("{} {}: expected a number, without a unit",
                               what.substr(colon + 2, equals - colon - 2), what.substr(equals + 3));
    }
    const auto named =
        std::find_if(program.commands.begin(), program.commands.end(),
                     [&](const Options& command) { return argc > 1 && command.name == argv[1]; });
    if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || named == program.commands.end())
        return what;
    std::vector<std::string_view> names;
    for (const Option& row : named->rows) names.insert(names.end(), row.names.begin(), row.names.end());
    for (int i = 1; i < argc; ++i) {
        const std::string_view word =
            std::string_view(argv[i]).substr(0, std::string_view(argv[i]).find('='));
        if (word.starts_with("--") && std::find(names.begin(), names.end(), word) == names.end())
            return fmt::format("unknown option {}{}", printable(word), did_you_mean(word, names));
    }
    return what;
}

/// Rejects empty file names, and a file that is named twice: the last write would replace the others.
void check_files(const Options& command, const CLI::App& app) {
    struct Used {
        std::string option, path;
        bool written;
    };
    const CLI::App* asked = &app;
    while (!asked->get_subcommands().empty()) asked = asked->get_subcommands().front();
    std::vector<Used> files;
    std::vector<std::string*> outputs;  // that are -
    for (const Option& row : command.rows) {
        auto* const* const path = std::get_if<std::string*>(&row.target);
        const bool written = row.value.starts_with("FILE") || row.value == "PATTERN";
        if (path == nullptr || !(written || row.by_place())) continue;
        if (written && (*path)->empty() && asked->get_option(row.names.back())->count() > 0)
            throw UsageError(row.names.front() + ": empty file name; name a file");
        // The summary would be in the way of a file on standard output.
        const bool dash = **path == "-" && row.value != "PATTERN";
        if (dash && written) quiet() = true, outputs.push_back(*path);
        if (dash && !written) **path = "/dev/stdin";
        if (!(*path)->empty()) files.push_back({row.names.front(), **path, written});
    }
    const auto same = [](const std::string& a, const std::string& b) {
        std::error_code none;
        return file_of(a) == file_of(b) || std::filesystem::equivalent(a, b, none);
    };
    // A terminal, a pipe or /dev/null may be named twice, and so may a stream that the shell has opened.
    const auto is_stream = [](const std::string& path) {
        const bool opened = path == "/dev/stdout" || path == "/dev/stderr" || path.starts_with("/dev/fd/");
        std::error_code none;
        return opened ||
               (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none));
    };
    for (std::size_t i = 0; i < files.size(); ++i) {
        for (std::size_t k = i + 1; k < files.size(); ++k) {
            const Used &one = files[i], &two = files[k];
            if (!(one.written || two.written) || (is_stream(one.path) && is_stream(two.path)) ||
                !same(one.path, two.path))
                continue;
            if (one.written && two.written)
                throw UsageError(
                    fmt::format("{} and {} name the same file; give each its own", one.option, two.option));
            const Used& out = one.written ? one : two;
            throw UsageError(fmt::format("{} {} would overwrite the input; choose another name", out.option,
                                         in_quotes(out.path)));
        }
    }
    for (std::string* output : outputs) *output = "/dev/stdout";
}

}  // namespace

std::string Option::default_text() const {
    if (required) return "";
    return std::visit(
        [](auto variable) -> std::string {
            using T = std::remove_pointer_t<decltype(variable)>;
            if constexpr (std::is_same_v<T, std::string>)
                return *variable;
            else if constexpr (kIsList<T>)
                return variable->empty() ? "" : fmt::format("[{}]", fmt::join(*variable, ","));
            else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>)
                return fmt::format("{}", *variable);
            else
                return "";
        },
        target);
}

Option& Option::in(double least, double most) {
    range = {least, most};
    return *this;
}

Option& Option::one_of(std::vector<std::string> values) {
    choices = std::move(values);
    return *this;
}

Options::Options(std::string command_name, std::string description)
    : name(std::move(command_name)), text(std::move(description)) {
    option("-h,--help", {}, "", "Print this help message and exit");
    flag("-q,--quiet", quiet(), "Print no summary, warnings or notes (default: off)");
}

Options& Options::command(std::string command_name, std::string description) {
    return commands.emplace_back(std::move(command_name), std::move(description));
}

Option& Options::argument(const std::string& place, std::string& variable, std::string description) {
    return option(place, &variable, "", std::move(description));
}

Option& Options::flag(const std::string& names, bool& variable, std::string description) {
    return option(names, &variable, "", std::move(description));
}

Option& Options::option(const std::string& names, OptionTarget variable, std::string value,
                        std::string description) {
    Option& row = rows.emplace_back();
    row.target = variable;
    row.value = std::move(value);
    row.text = std::move(description);
    const std::size_t comma = names.find(',');
    row.names.push_back(names.substr(0, comma));
    if (comma != names.npos) row.names.push_back(names.substr(comma + 1));
    return row;
}

int run_command_line(Options& program, int argc, char** argv) {
    CLI::App app(program.text, program.name);
    app.formatter(std::make_shared<HelpFormatter>());
    app.set_version_flag("-V,--version", program.name + " " + program.version);
    const Options* named = nullptr;
    fill(app, program, named);
    try {
        app.parse(with_spelled_help(program, argc, argv));
    } catch (const CLI::CallForHelp&) {
        print(app.help());
        return kOk;
    } catch (const CLI::CallForVersion& version) {
        print(std::string(version.what()) + "\n");
        return kOk;
    } catch (const CLI::ParseError& error) {
        const std::string what = explained(error, program, argc, argv);
        throw UsageError(what + (what.ends_with('?') ? " See " : "; see ") + path_of(app) + " --help");
    }
    if (named->run) {
        check_files(*named, app);
        return named->run();
    }
    print(app.help());
    throw UsageError(fmt::format("no command given: expected {}", listed(named->commands)));
}

}  // namespace carom::tools
