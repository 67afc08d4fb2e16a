// The commands of the program and their options, as one table: it is parsed, shown by --help, and written as a man page and as
// completions. Only options.cpp knows CLI11, which takes seconds to compile.
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

/// The variable that an option sets; nothing for --help and --version. A list of strings is an option that may be repeated,
/// a list of numbers is written with commas.
using OptionTarget = std::variant<std::monostate, bool*, int*, long*, std::uint64_t*, double*, std::string*,
                                  std::optional<int>*, std::optional<long>*, std::optional<double>*,
                                  std::vector<int>*, std::vector<double>*, std::vector<std::string>*>;

/// One row of the table.
struct Option {
    std::vector<std::string> names;  ///< "-o", "--output"; of an argument that is known by its place "SCENE"
    OptionTarget target;
    std::string value;  ///< what it takes, "FILE.csv"; empty: it is a flag, or known by its place
    std::string text;
    std::vector<std::string> choices;                ///< the only values, if there are any
    std::optional<std::pair<double, double>> range;  ///< of the value, both ends included
    bool required = false;
    std::string needs, excludes;  ///< name of an option that stands before this one in the table

    Option& in(double least, double most);
    Option& one_of(std::vector<std::string> values);
    bool by_place() const { return names.front().front() != '-'; }
    bool may_be_repeated() const { return std::holds_alternative<std::vector<std::string>*>(target); }
    std::string default_text()
        const;  ///< of a variable that has a value before the command line is read, else ""
};

/// A command, or the whole program: its options and the commands below it.
struct Options {
    Options(std::string command_name, std::string description);

    std::string name, text;
    std::string footer;   ///< behind the options in --help; empty: that of the program
    std::string version;  ///< of the program
    std::vector<Option> rows;
    std::list<Options> commands;
    std::function<int()>
        run;  ///< does the work and returns the exit status; empty: one of `commands` must be named

    Options& command(std::string command_name, std::string description);

    /// A command that does `work`, and the variables of its options, which live as long as it.
    template <class Args>
    std::pair<Options&, Args&> command(std::string command_name, std::string description,
                                       int (*work)(const Args&)) {
        const auto args = std::make_shared<Args>();
        Options& added = command(std::move(command_name), std::move(description));
        added.run = [args, work] { return work(*args); };
        return {added, *args};
    }

    // Each returns the new row, for what is not said of every option. The next row may move it.
    Option& argument(std::string place, std::string& variable, std::string description);
    Option& flag(const std::string& names, bool& variable,
                 std::string description);  ///< turns its variable over
    Option& option(const std::string& names, OptionTarget variable, std::string value,
                   std::string description);
};

/// Reads the command line and runs the command that it names; prints help or version where they are asked for.
/// @returns the exit status  @throws UsageError
int run_command_line(Options& program, int argc, char** argv);

}  // namespace carom::tools
