#include "describe.h"

#include <CLI/CLI.hpp>

#include <vector>

namespace carom::tools {
namespace {

using Apps = std::vector<const CLI::App*>;

/// The commands of a program or of a command, in the order of its help.
Apps commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App* sub) { return !sub->get_name().empty(); });
}

struct Described {
    std::vector<std::string> names;  ///< "-o", "--output"; empty for a positional argument
    std::string positional;          ///< its name
    std::string text;
    std::string value;                 ///< what it takes, "" for a flag
    std::vector<std::string> choices;  ///< of its value, where there are few
    bool required = false;
};

/// "a", "b" of "NAME:{a,b}".
std::vector<std::string> choices_in(const std::string& type) {
    std::vector<std::string> found;
    const std::size_t open = type.find('{'), close = type.find('}');
    if (open == type.npos || close == type.npos) return found;
    std::string rest = type.substr(open + 1, close - open - 1) + ',';
    for (std::size_t comma; (comma = rest.find(',')) != rest.npos; rest.erase(0, comma + 1))
        found.push_back(rest.substr(0, comma));
    return found;
}

Described describe(const CLI::Option& option) {
    Described d;
    for (const std::string& name : option.get_snames()) d.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) d.names.push_back("--" + name);
    if (d.names.empty()) d.positional = option.get_name(true);
    d.text = option.get_description();
    d.required = option.get_required();
    if (option.get_items_expected_max() == 0) return d;
    const std::string type = option.get_type_name();
    d.choices = choices_in(type);
    d.value = type.substr(0, type.find(':'));
    // Checks stand behind the name: "N:INT in [0 - 256]".
    d.value = d.value.substr(0, d.value.find(' '));
    if (!option.get_default_str().empty()) d.text += " (default: " + option.get_default_str() + ")";
    return d;
}

std::vector<Described> options_of(const CLI::App& app, bool positional) {
    std::vector<Described> found;
    for (const CLI::Option* option : app.get_options()) {
        Described d = describe(*option);
        if (d.positional.empty() != positional) found.push_back(std::move(d));
    }
    return found;
}

bool takes_file(const Described& d) {
    for (const char* word : {"FILE", "SCENE", "PATTERN"})
        if ((d.value + " " + d.positional).find(word) != std::string::npos) return true;
    return false;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : between) + word;
    return out;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

// ---- man -------------------------------------------------------------------------------------------------

/// Text that troff prints as it is.
std::string roff(std::string text) {
    text = replaced(replaced(std::move(text), "\\", "\\e"), "-", "\\-");
    if (!text.empty() && (text[0] == '.' || text[0] == '\'')) text.insert(0, "\\&");
    return replaced(std::move(text), "\n", "\n.br\n");
}

void man_command(std::string& out, const CLI::App& command, const std::string& path,
                 const std::string& common_footer) {
    const Apps inner = commands_of(command);
    const std::string name = path + " " + command.get_name();
    for (const CLI::App* sub : inner) man_command(out, *sub, name, common_footer);
    if (!inner.empty()) return;
    std::string synopsis = name;
    for (const Described& d : options_of(command, true)) synopsis += " " + d.positional;
    for (const Described& d : options_of(command, false))
        if (d.required) synopsis += " " + d.names.back() + " " + d.value;
    out += ".SS \"" + roff(synopsis) + " [options]\"\n" + roff(command.get_description()) + ".\n";
    for (const bool positional : {true, false}) {
        for (const Described& d : options_of(command, positional)) {
            if (!positional && d.names.back() == "--help") continue;
            out += ".TP\n\\fB" + roff(positional ? d.positional : joined(d.names, ", ")) + "\\fR";
            if (!positional && !d.value.empty()) out += " \\fI" + roff(d.value) + "\\fR";
            out += "\n" + roff(d.text) + "\n";
            if (!d.choices.empty()) out += ".br\nOne of " + roff(joined(d.choices, ", ")) + ".\n";
        }
    }
    // A command without a footer of its own has the program's.
    if (command.get_footer() != common_footer) out += ".PP\n" + roff(command.get_footer()) + "\n";
}

}  // namespace

std::string man_page(const CLI::App& app, const std::string& version) {
    std::string out = ".TH CAROM 1 \"\" \"carom " + version + "\" \"User Commands\"\n";
    out +=
        ".SH NAME\ncarom \\- event\\-based billiards simulator\n.SH SYNOPSIS\n\\fBcarom\\fR \\fICOMMAND\\fR "
        "[options]\n";
    out +=
        ".SH DESCRIPTION\nReads a scene (TOML): a table, its balls, perhaps a shot. Simulates it from event "
        "to event, draws "
        "what happened without a display, and says what every frame cost.\n";
    out += ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(app)) man_command(out, *command, "carom", app.get_footer());
    out +=
        ".SH ENVIRONMENT\n.TP\n\\fBCAROM_ISA\\fR\nscalar, v3 or v4 forces the instruction set; all give the "
        "same bits. Left "
        "out, the widest one that the processor has.\n";
    out +=
        ".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n1\nfailed while running\n.TP\n2\nbad usage or bad "
        "scene\n.TP\n130\ninterrupted\n";
    out +=
        ".SH EXAMPLES\n.EX\ncarom simulate scenes/hello.toml\ncarom render scenes/eight_ball_break.toml "
        "\\-\\-to 2 \\-o "
        "frames/%05d.png\n.EE\n";
    return out;
}

// ---- bash ------------------------------------------------------------------------------------------------

namespace {

/// One case per command: the words that may follow, and what the value of an option may be.
void bash_cases(std::string& out, const CLI::App& app, const std::string& path) {
    const Apps inner = commands_of(app);
    std::vector<std::string> words, files;
    std::string values;
    for (const CLI::App* sub : inner) words.push_back(sub->get_name());
    for (const Described& d : options_of(app, false)) {
        words.insert(words.end(), d.names.begin(), d.names.end());
        if (d.value.empty()) continue;
        const std::string action = !d.choices.empty() ? "words='" + joined(d.choices, " ") + "'"
                                   : takes_file(d)    ? "files=1"
                                                      : ":";
        values += "            " + joined(d.names, "|") + ") " + action + " ;;\n";
    }
    bool positional_file = false;
    std::vector<std::string> choices;
    for (const Described& d : options_of(app, true)) {
        positional_file = positional_file || takes_file(d);
        choices.insert(choices.end(), d.choices.begin(), d.choices.end());
    }
    out += "    '" + path + "')\n        case \"$before\" in\n" + values + "        *) words='" +
           joined(words, " ") + (choices.empty() ? "" : " " + joined(choices, " ")) + "'" +
           (positional_file ? " files=1" : "") + " ;;\n        esac ;;\n";
    for (const CLI::App* sub : inner)
        bash_cases(out, *sub, path.empty() ? sub->get_name() : path + " " + sub->get_name());
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
    std::string groups;
    for (const CLI::App* command : commands_of(app))
        if (!commands_of(*command).empty()) groups += (groups.empty() ? "" : "|") + command->get_name();
    std::string out =
        "# Completion of carom for bash; made by: carom describe bash\n_carom() {\n"
        "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
        "    local command= words= files=\n"
        "    if [ \"$COMP_CWORD\" -gt 1 ]; then\n"
        "        command=${COMP_WORDS[1]}\n"
        "        case \"$command\" in\n        " +
        groups +
        ") [ \"$COMP_CWORD\" -gt 2 ] && command=\"$command ${COMP_WORDS[2]}\" ;;\n        esac\n    fi\n"
        "    case \"$command\" in\n";
    bash_cases(out, app, "");
    out +=
        "    esac\n"
        "    COMPREPLY=()\n"
        "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
        "    # Options only where one has been begun.\n"
        "    [[ $word == -* ]] || COMPREPLY=($(printf '%s\\n' \"${COMPREPLY[@]}\" | grep -v '^-'))\n"
        "    if [ -n \"$files\" ] && [[ $word != -* ]]; then\n"
        "        local file\n"
        "        while IFS= read -r file; do COMPREPLY+=(\"$file\"); done < <(compgen -f -- \"$word\")\n"
        "    fi\n}\ncomplete -o filenames -F _carom carom\n";
    return out;
}

// ---- zsh -------------------------------------------------------------------------------------------------

namespace {

/// Text inside '...[text]...' of _arguments.
std::string zsh_text(std::string text) {
    for (const char* c : {"\\", "[", "]", ":"}) text = replaced(std::move(text), c, std::string("\\") + c);
    return replaced(std::move(text), "'", "'\\''");
}

std::string zsh_value(const Described& d) {
    if (!d.choices.empty()) return "(" + joined(d.choices, " ") + ")";
    return takes_file(d) ? "_files" : " ";
}

void zsh_function(std::string& out, const CLI::App& app, const std::string& name) {
    const Apps inner = commands_of(app);
    for (const CLI::App* sub : inner) zsh_function(out, *sub, name + "_" + sub->get_name());
    out += name + "() {\n";
    if (!inner.empty()) out += "    local curcontext=\"$curcontext\" state line\n    local -a commands\n";
    out += inner.empty() ? "    _arguments" : "    _arguments -C";
    for (const Described& d : options_of(app, false)) {
        const std::string value = d.value.empty() ? "" : ":" + zsh_text(d.value) + ":" + zsh_value(d);
        const std::string body = "'[" + zsh_text(d.text) + "]" + value + "'";
        const std::string excluded =
            d.text.find("once per key") == d.text.npos ? "(" + joined(d.names, " ") + ")" : "*";
        out += " \\\n        '" + excluded + "'";
        out += d.names.size() == 1 ? d.names[0] + body : "{" + joined(d.names, ",") + "}" + body;
    }
    if (inner.empty()) {
        for (const Described& d : options_of(app, true))
            out += " \\\n        ':" + zsh_text(d.positional) + ":" + zsh_value(d) + "'";
        out += "\n}\n";
        return;
    }
    out +=
        " \\\n        '1:command:->command' '*::argument:->argument'\n    case $state in\n    command)\n     "
        "   commands=(";
    for (const CLI::App* sub : inner)
        out +=
            "\n            '" + sub->get_name() + ":" + replaced(sub->get_description(), "'", "'\\''") + "'";
    out += ")\n        _describe command commands ;;\n    argument)\n        case $words[1] in\n";
    for (const CLI::App* sub : inner)
        out += "        " + sub->get_name() + ") " + name + "_" + sub->get_name() + " ;;\n";
    out += "        esac ;;\n    esac\n}\n";
}

}  // namespace

std::string zsh_completion(const CLI::App& app) {
    std::string out = "#compdef carom\n# Completion of carom for zsh; made by: carom describe zsh\n";
    zsh_function(out, app, "_carom");
    return out + "_carom \"$@\"\n";
}

}  // namespace carom::tools
