// The program's commands and their options as one table. The command line is parsed from it, and --help, the
// man page and the completions are written from it. Only options.cpp includes CLI11, which takes seconds to
// compile.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace carom::tools {

/// The variable that an option sets; nothing for --help and --version. A list of strings comes from a
/// repeated option; a list of numbers is separated by commas.
using OptionTarget =
    std::variant<std::monostate, bool*, int*, std::int64_t*, std::uint64_t*, double*, std::string*,
                 std::optional<int>*, std::optional<std::int64_t>*, std::optional<double>*, std::vector<int>*,
                 std::vector<double>*, std::vector<std::string>*>;

/// One row of the table: an option, a flag, or a positional argument.
struct Option {
    std::vector<std::string> names;  ///< "-o", "--output"; "SCENE" for an argument
    OptionTarget target;
    std::string value;  ///< the value of the option, "FILE.csv"; empty for flags and arguments
    std::string text;
    std::vector<std::string> choices;                ///< all allowed values; empty: any
    std::optional<std::pair<double, double>> range;  ///< allowed values, both ends included
    bool required = false;
    std::string needs, excludes;  ///< names of other options, whose rows come before this one

    Option& in(double least, double most);
    Option& one_of(std::vector<std::string> values);
    bool by_place() const { return names.front().front() != '-'; }
    bool may_be_repeated() const { return std::holds_alternative<std::vector<std::string>*>(target); }
    /// The value of the variable before the command line is read; "" if it has none.
    std::string default_text() const;
};

/// A command, or the whole program: its options and the commands below it.
struct Options {
    Options(std::string command_name, std::string description);

    std::string name, text;
    std::string footer;   ///< printed after the options in --help; empty: the program's
    std::string version;  ///< of the program
    std::string group;    ///< of a command in the program's --help
    std::vector<Option> rows;
    std::list<Options> commands;
    /// Does the work and returns the exit status; empty: one of `commands` must be named.
    std::function<int()> run;

    Options& command(std::string command_name, std::string description);

    /// Adds a command that does `work`. Returns it, and the
    /// variables of its options, which live as long as the command.
    template <class Args>
    std::pair<Options&, Args&> command(std::string command_name, std::string description,
                                       int (*work)(const Args&)) {
        const auto args = std::make_shared<Args>();
        Options& added = command(std::move(command_name), std::move(description));
        added.run = [args, work] { return work(*args); };
        return {added, *args};
    }

    // Each adds a row and returns it, so that its rarely used members can be set; the next call may move it.
    // A flag negates its variable.
    Option& argument(const std::string& place, std::string& variable, std::string description);
    Option& flag(const std::string& names, bool& variable, std::string description);
    Option& option(const std::string& names, OptionTarget variable, std::string value,
                   std::string description);
};

/// Reads the command line and runs the command that it names, or prints the help or the version.
/// @returns the exit status  @throws UsageError
int run_command_line(Options& program, int argc, char** argv);

}  // namespace carom::tools
