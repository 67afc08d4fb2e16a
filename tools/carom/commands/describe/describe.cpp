// carom describe: the man page, the command-line page of the documents, and completions for bash and zsh. All
// are written from the table of options that is parsed, so that they cannot differ from it.
#include <fmt/format.h>

#include <list>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "carom/engine/event_details.h"
#include "carom/games/measures.h"
#include "carom/interface/shape.h"
#include "commands/describe/formats.h"

namespace carom::tools {
namespace {

/// The positional arguments of a command, or its other rows.
std::vector<Option> rows_of(const Options& command, bool by_place) {
    std::vector<Option> found;
    for (const Option& row : command.rows)
        if (row.by_place() == by_place) found.push_back(row);
    return found;
}

/// The description of an option, with its default.
std::string meaning(const Option& row) {
    const std::string initial = row.default_text();
    return initial.empty() ? row.text : row.text + " (default: " + initial + ")";
}

/// Whether every command has it.
bool is_common(const Option& row) {
    return row.names.back() == "--help" || row.names.back() == "--quiet";
}

bool takes_file(const Option& row) {
    // A positional argument is a scene or a record.
    if (row.by_place()) return row.choices.empty();
    return row.value.find("FILE") != std::string::npos || row.value.find("PATTERN") != std::string::npos;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
    return fmt::format("{}", fmt::join(words, between));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

/// "carom sweep SCENE --vary KEY=DISTRIBUTION": the call of a command, with all its required options.
std::string synopsis_of(const Options& command, const std::string& name) {
    std::string synopsis = name;
    for (const Option& row : rows_of(command, true)) {
        const bool has_default = !row.default_text().empty() || row.text.find("(default:") != row.text.npos;
        synopsis += has_default ? " [" + row.names.front() + "]" : " " + row.names.front();
    }
    for (const Option& row : rows_of(command, false))
        if (row.required) synopsis += " " + row.names.back() + " " + row.value;
    return synopsis;
}

constexpr const char* kIsaText =
    "scalar, v3 or v4 forces the instruction set; all give the same bits. By default, every kernel uses the "
    "one measured fastest on this processor, or else the widest; `carom check` prints it.";
constexpr struct {
    int status;
    const char* meaning;
} kStatuses[] = {{kOk, "done"},
                 {kFailed, "failed while running"},
                 {kBadUsage, "bad usage or bad scene"},
                 {130, "interrupted"},
                 {143, "terminated"}};

// ---- man -------------------------------------------------------------------------------------------------

/// Escapes text so that troff prints it unchanged.
std::string roff(std::string text) {
    text = replaced(replaced(std::move(text), "\\", "\\e"), "-", "\\-");
    if (!text.empty() && (text[0] == '.' || text[0] == '\'')) text.insert(0, "\\&");
    return replaced(std::move(text), "\n", "\n.br\n");
}

void man_command(std::string& out, const Options& command, const std::string& path) {
    const std::string name = path + " " + command.name;
    for (const Options& inner : command.commands) man_command(out, inner, name);
    if (!command.run) return;
    out += ".SS \"" + roff(synopsis_of(command, name)) + " [options]\"\n" + roff(command.text) + ".\n";
    for (const bool by_place : {true, false}) {
        for (const Option& row : rows_of(command, by_place)) {
            if (is_common(row)) continue;
            out += fmt::format(".TP\n\\fB{}\\fR", roff(joined(row.names, ", ")));
            if (!row.value.empty()) out += fmt::format(" \\fI{}\\fR", roff(row.value));
            out += fmt::format("\n{}\n", roff(meaning(row)));
            if (!row.choices.empty()) out += ".br\nOne of " + roff(joined(row.choices, ", ")) + ".\n";
        }
    }
    if (!command.footer.empty()) out += ".PP\n" + roff(command.footer) + "\n";
}

std::string man_page(const Options& program) {
    std::string commands, statuses;
    for (const Options& command : program.commands) man_command(commands, command, program.name);
    for (const auto& [status, text] : kStatuses) statuses += fmt::format(".TP\n{}\n{}\n", status, text);
    return ".TH CAROM 1 \"\" \"carom " + program.version +
           "\" \"User Commands\"\n"
           ".SH NAME\ncarom \\- event\\-based billiards simulator\n"
           ".SH SYNOPSIS\n\\fBcarom\\fR \\fICOMMAND\\fR [options]\n"
           ".SH DESCRIPTION\nReads a scene (TOML): a table, its balls and perhaps a shot. Simulates it event "
           "by event, "
           "renders it without a display, and reports the cost of every frame.\n"
           ".SH COMMANDS\n" +
           commands + ".SH ENVIRONMENT\n.TP\n\\fBCAROM_ISA\\fR\n" + kIsaText + "\n.SH EXIT STATUS\n" +
           statuses +
           ".SH EXAMPLES\n.EX\ncarom simulate scenes/hello.toml\n"
           "carom render scenes/eight_ball_break.toml \\-\\-to 2 \\-o frames/%05d.png\n.EE\n";
}

// ---- the page of the documents ---------------------------------------------------------------------------

/// Escapes text so that Markdown prints it unchanged.
std::string markdown(std::string text) {
    for (const char* c : {"*", "_", "<"}) text = replaced(std::move(text), c, std::string("\\") + c);
    return text;
}

std::string code_list(const std::vector<std::string>& words) {
    return fmt::format("`{}`", fmt::join(words, "`, `"));
}

/// The description of an option, without the facts about all flags and files at the top of the page.
std::string page_meaning(const Option& row) {
    std::string text = meaning(row);
    for (const char* known : {" (default: off)", " (default: not written)", " (default: not drawn)"})
        text = replaced(std::move(text), known, "");
    return markdown(text);
}

/// The list item of an option. @param before  the page up to here: a long list of choices appears once on it
std::string page_item(const Option& row, const std::string& before) {
    std::string item = fmt::format("* `{}{}{}`: {}", joined(row.names, ", "), row.value.empty() ? "" : " ",
                                   row.value, page_meaning(row));
    const std::string choices = code_list(row.choices);
    if (row.choices.size() > 5 && before.find(choices) != before.npos)
        item += "; values as above";
    else if (!row.choices.empty())
        item += "; one of " + choices;
    if (row.range) item += fmt::format("; {:g} to {:g}", row.range->first, row.range->second);
    if (!row.needs.empty()) item += fmt::format("; needs `{}`", row.needs);
    if (!row.excludes.empty()) item += fmt::format("; not with `{}`", row.excludes);
    return item + "\n";
}

void page_command(std::string& out, const Options& command, const std::string& path) {
    const std::string name = path + " " + command.name;
    for (const Options& inner : command.commands) page_command(out, inner, name);
    if (!command.run) return;
    out +=
        fmt::format("\n## {}\n\n`{}`\n\n{}.\n\n", name, synopsis_of(command, name), markdown(command.text));
    std::vector<std::string> again;
    for (const bool by_place : {true, false}) {
        for (const Option& row : rows_of(command, by_place)) {
            if (is_common(row) || row.text == "Scene file (TOML)") continue;
            const std::string item = page_item(row, out);
            if (out.find(item) == out.npos)
                out += item;
            else
                again.push_back(joined(row.names, ", "));
        }
    }
    if (!again.empty()) out += fmt::format("* As above: {}\n", code_list(again));
    if (command.footer.empty()) return;
    std::string footer = replaced(markdown(command.footer), "\n  ", "\n* ");
    if (const std::size_t list = footer.find("\n* "); list != footer.npos) footer.insert(list, "\n");
    out += fmt::format("\n{}\n", footer);
}

/// The page with lines of at most 110 columns; the further lines of a list item are indented.
std::string wrapped(const std::string& page) {
    constexpr std::size_t kWidth = 110;
    std::string out;
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        const std::string indent = line.starts_with("* ") ? "  " : "";
        while (line.size() > kWidth) {
            std::size_t space = line.rfind(' ', kWidth);
            // A line that begins with a dash would be a list item.
            while (space != line.npos && line.compare(space, 3, " - ") == 0)
                space = line.rfind(' ', space - 1);
            if (space == line.npos || space <= indent.size()) break;
            out += line.substr(0, space) + "\n";
            line.replace(0, space + 1, indent);
        }
        out += line + "\n";
    }
    return out;
}

std::string command_line_page(const Options& program) {
    std::string commands, statuses;
    for (const Options& command : program.commands) page_command(commands, command, program.name);
    for (const auto& [status, text] : kStatuses)
        statuses += fmt::format("{}{} {}", statuses.empty() ? "" : ", ", status, text);
    return wrapped(
        "# The command line\n\n"
        "Every command and option, as in `carom COMMAND --help`; `carom describe command-line` prints this "
        "page. SCENE is a scene file (TOML). Flags are off and no file is written unless named. `-q` or "
        "`--quiet` "
        "leaves out summaries, warnings and notes.\n\n"
        "* Exit status: " +
        statuses + ".\n* `CAROM_ISA` in the environment: " + kIsaText + "\n" + commands);
}

// ---- bash ------------------------------------------------------------------------------------------------

/// One case per command: the words that may follow, and the values of its options.
void bash_cases(std::string& out, const Options& command, const std::string& path) {
    std::vector<std::string> words;
    std::string values;
    for (const Options& inner : command.commands) words.push_back(inner.name);
    for (const Option& row : rows_of(command, false)) {
        words.insert(words.end(), row.names.begin(), row.names.end());
        if (row.value.empty()) continue;
        const std::string action = !row.choices.empty() ? "words='" + joined(row.choices, " ") + "'"
                                   : takes_file(row)    ? "files=1"
                                                        : ":";
        values += "            " + joined(row.names, "|") + ") " + action + " ;;\n";
    }
    bool any_file = false;
    for (const Option& row : rows_of(command, true)) {
        any_file = any_file || takes_file(row);
        words.insert(words.end(), row.choices.begin(), row.choices.end());
    }
    out += "    '" + path + "')\n        case \"$before\" in\n" + values + "        *) words='" +
           joined(words, " ") + "'" + (any_file ? " files=1" : "") + " ;;\n        esac ;;\n";
    for (const Options& inner : command.commands) bash_cases(out, inner, inner.name);
}

std::string bash_completion(const Options& program) {
    std::string out =
        "# Completion of carom for bash; made by: carom describe bash\n_carom() {\n"
        "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
        "    local command= words= files=\n"
        "    [ \"$COMP_CWORD\" -gt 1 ] && command=${COMP_WORDS[1]}\n"
        "    case \"$command\" in\n";
    bash_cases(out, program, "");
    out +=
        "    esac\n"
        "    COMPREPLY=()\n"
        "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
        "    # Offer options only after a dash.\n"
        "    [[ $word == -* ]] || COMPREPLY=($(printf '%s\\n' \"${COMPREPLY[@]}\" | grep -v '^-'))\n"
        "    if [ -n \"$files\" ] && [[ $word != -* ]]; then\n"
        "        local file\n"
        "        while IFS= read -r file; do COMPREPLY+=(\"$file\"); done < <(compgen -f -- \"$word\")\n"
        "    fi\n}\ncomplete -o filenames -F _carom carom\n";
    return out;
}

// ---- zsh -------------------------------------------------------------------------------------------------

/// Text inside '...[text]...' of _arguments.
std::string zsh_text(std::string text) {
    for (const char* c : {"\\", "[", "]", ":"}) text = replaced(std::move(text), c, std::string("\\") + c);
    return replaced(std::move(text), "'", "'\\''");
}

std::string zsh_value(const Option& row) {
    if (!row.choices.empty()) return fmt::format("({})", joined(row.choices, " "));
    return takes_file(row) ? "_files" : " ";
}

/// A command's options and positional arguments, in the form that _arguments accepts.
std::string zsh_arguments(const Options& command) {
    std::string out;
    for (const Option& row : rows_of(command, false)) {
        const std::string names = joined(row.names, ",");
        out +=
            fmt::format(" \\\n        '{}'{}'[{}]",
                        row.may_be_repeated() ? "*" : fmt::format("({})", joined(row.names, " ")),
                        row.names.size() == 1 ? names : fmt::format("{{{}}}", names), zsh_text(meaning(row)));
        if (!row.value.empty()) out += fmt::format(":{}:{}", zsh_text(row.value), zsh_value(row));
        out += "'";
    }
    for (const Option& row : rows_of(command, true))
        out += fmt::format(" \\\n        ':{}:{}'", zsh_text(row.names.front()), zsh_value(row));
    return out;
}

std::string zsh_completion(const Options& program) {
    std::string functions, names, cases;
    for (const Options& command : program.commands) {
        functions +=
            fmt::format("_carom_{}() {{\n    _arguments{}\n}}\n", command.name, zsh_arguments(command));
        names += fmt::format("\n            '{}:{}'", command.name, replaced(command.text, "'", "'\\''"));
        cases += fmt::format("        {0}) _carom_{0} ;;\n", command.name);
    }
    return fmt::format(
        "#compdef carom\n# Completion of carom for zsh; made by: carom describe zsh\n{}"
        "_carom() {{\n    local curcontext=\"$curcontext\" state line\n    local -a commands\n"
        "    _arguments -C{} \\\n        '1:command:->command' '*::argument:->argument'\n    case $state in\n"
        "    command)\n        commands=({})\n        _describe command commands ;;\n"
        "    argument)\n        case $words[1] in\n{}        esac ;;\n    esac\n}}\n_carom \"$@\"\n",
        functions, zsh_arguments(program), names, cases);
}

// ---- measures and columns --------------------------------------------------------------------------------

std::string measures_text() {
    std::string out =
        "Measures of a shot, for carom sweep --measure. An expression joins them with numbers, texts "
        "in\nquotes, and, or, not, == != < <= > >=, in, near, + - * /, as in\n  \"9\" in pocketed and not "
        "scratch\n  cue near (0.6, 1.2, 0.05)      at rest within 5 cm of this place\n\n";
    for (const games::MeasureInfo& m : games::measures()) {
        const std::string call =
            *m.arguments == 0 ? std::string(m.name) : fmt::format("{}({})", m.name, m.arguments);
        out += fmt::format("  {:<24}{:<7}{}\n", call, m.unit, m.what);
    }
    return out + "\nBALL is an id, K counts from 1, X and Y are in m, GAME is a game of carom judge.\n";
}

std::string games_text() {
    std::string out =
        "Games of carom judge --game, with the options of --rules. The first value is the default.\n";
    for (const games::Game game : games::all_of(games::Game{})) {
        const games::GameInfo& info = games::info_of(game);
        out += fmt::format("\n{:<16}{}\n", info.name, info.book);
        if (!info.calls.empty()) out += fmt::format("  calls: {}\n", info.calls);
        for (const games::RuleOption& option : info.options)
            out += fmt::format("  {} = {}\n      {}\n", option.key, fmt::join(option.values, " | "),
                               option.what);
    }
    return out;
}

std::string events_text() {
    std::string out =
        "Columns of carom simulate --events, after time, type, a, b and the columns of --profile. A "
        "column\nis empty if the event has no such number.\n\n";
    for (const EventColumn& column : event_columns())
        out += fmt::format("  {:<14}{:<7}{}\n", column.name, column.unit, column.what);
    return out + fmt::format("  {:<21}{}\n  {:<21}{}\n", "met", "name of the ball or part that ball a meets",
                             "cluster", "all balls of a cluster, separated by ;");
}

// ---- the command -----------------------------------------------------------------------------------------

/// The formats of the command, one row each.
constexpr struct {
    const char* name;
    std::string (*text)(const Options& program);
} kFormats[] = {{"man", man_page},
                {"bash", bash_completion},
                {"zsh", zsh_completion},
                {"command-line", command_line_page},
                {"scene-schema", [](const Options&) { return scene_schema(); }},
                {"record-schema", [](const Options&) { return record_schema(); }},
                {"scene-format", [](const Options&) { return scene_format(); }},
                {"measures", [](const Options&) { return measures_text(); }},
                {"games", [](const Options&) { return games_text(); }},
                {"types", [](const Options&) { return interface::types_page(); }},
                {"types-python", [](const Options&) { return interface::types_for_python(); }},
                {"types-typescript", [](const Options&) { return interface::types_for_typescript(); }},
                {"events", [](const Options&) { return events_text(); }}};

struct DescribeArgs {
    std::string format;
};

int run(const DescribeArgs& args, const Options& program) {
    for (const auto& format : kFormats)
        if (args.format == format.name) print(format.text(program));
    if (args.format.empty())
        for (const auto& format : kFormats) print(fmt::format("carom describe {}\n", format.name));
    return kOk;
}

}  // namespace

void add_describe(Options& program) {
    auto args = std::make_shared<DescribeArgs>();
    Options& command =
        program.command("describe", "Print a description of this program or of its file formats");
    Option& format =
        command.argument("FORMAT", args->format, "Description to print (default: the list of these)");
    for (const auto& known : kFormats) format.choices.emplace_back(known.name);
    command.run = [args, &program] { return run(std::exchange(*args, {}), program); };
}

}  // namespace carom::tools
