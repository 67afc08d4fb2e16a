#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <type_traits>

#include "console.h"

namespace carom::tools {
namespace {

template <class T>
constexpr bool kIsList = false;
template <class T>
constexpr bool kIsList<std::vector<T>> = true;

/// Shows options in --help in one form with every release of CLI11, whose own forms differ (2.1: "S=0", 2.4: "S [0]").
class HelpFormatter : public CLI::Formatter {
  public:
    /// The text after the name: type and choices, default, whether it may be repeated, which options it needs or excludes.
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

void restrict(CLI::Option& option, CLI::App& app, const Option& row) {
    if (!row.value.empty()) option.type_name(row.value);
    if (!row.choices.empty()) option.check(CLI::IsMember(row.choices));
    if (!row.needs.empty()) option.needs(app.get_option(row.needs));
    if (!row.excludes.empty()) option.excludes(app.get_option(row.excludes));
    option.required(row.required);
    option.default_str(row.default_text());
}

template <class T>
void add_option(CLI::App& app, const Option& row, const std::string& names, T& variable) {
    CLI::Option* option = app.add_option(names, variable, row.text);
    if constexpr (kIsList<T>) option->allow_extra_args(false);
    if constexpr (std::is_same_v<T, std::vector<int>> || std::is_same_v<T, std::vector<double>>)
        option->delimiter(',');
    if (row.range) {
        const auto [least, most] = *row.range;
        constexpr bool kReal = std::is_same_v<T, double> || std::is_same_v<T, std::vector<double>>;
        if constexpr (kReal)
            option->check(CLI::Range(least, most));
        else
            option->check(CLI::Range(static_cast<long>(least), static_cast<long>(most)));
    }
    restrict(*option, app, row);
}

/// Gives a command's table to CLI11. `named` becomes the command that the command line names.
void fill(CLI::App& app, const Options& command, const Options*& named) {
    if (!command.footer.empty()) app.footer(command.footer);
    app.require_subcommand(
        0, 1);  // if none is named, run_command_line reports it with a better message than that of CLI11
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
    for (const Options& inner : command.commands)
        fill(*app.add_subcommand(inner.name, inner.text), inner, named);
}

/// "simulate, render or check".
std::string listed(const std::list<Options>& commands) {
    std::string text;
    for (const Options& command : commands)
        text += (text.empty() ? "" : &command == &commands.back() ? " or " : ", ") + command.name;
    return text;
}

/// The program and the commands that the command line names: "carom bench".
std::string path_of(const CLI::App& app) {
    const std::vector<CLI::App*> named = app.get_subcommands();
    return app.get_name() + (named.empty() ? "" : " " + path_of(*named.front()));
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
    app.set_version_flag("--version", program.name + " " + program.version);
    const Options* named = nullptr;
    fill(app, program, named);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        print(app.help());
        return kOk;
    } catch (const CLI::CallForVersion& version) {
        print(std::string(version.what()) + "\n");
        return kOk;
    } catch (const CLI::ParseError& error) {
        throw UsageError(std::string(error.what()) + "; see " + path_of(app) + " --help");
    }
    if (named->run) return named->run();
    throw UsageError(
        fmt::format("a command is missing: {}; see {} --help", listed(named->commands), path_of(app)));
}

}  // namespace carom::tools
