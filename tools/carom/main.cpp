// The program: reads the command line, runs one command, turns what it throws into an exit status.
#include <CLI/CLI.hpp>

#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "carom/engine/scene.h"
#include "commands.h"
#include "console.h"
#include "describe.h"
#include "formats.h"
#include "options/help_formatter.h"
#include "options/options.h"

namespace carom::tools {
namespace {

void add_describe(CLI::App& app, Action& action) {
    auto format = std::make_shared<std::string>();
    CLI::App* sub = app.add_subcommand(
        "describe", "This program and its file formats, for people and for other programs");
    sub->add_option("FORMAT", *format, "What to print")
        ->type_name("NAME")
        ->check(CLI::IsMember({"man", "bash", "zsh", "scene-schema", "record-schema", "scene-format"}))
        ->required();
    sub->callback([format, &app, &action] {
        action = [format, &app] {
            print(*format == "man"             ? man_page(app, CAROM_VERSION)
                  : *format == "bash"          ? bash_completion(app)
                  : *format == "zsh"           ? zsh_completion(app)
                  : *format == "scene-schema"  ? scene_schema()
                  : *format == "record-schema" ? record_schema()
                                               : scene_format());
            return kOk;
        };
    });
}

void add_commands(CLI::App& app, Action& action) {
    add_simulate(app, action);
    add_render(app, action);
    add_margin(app, action);
    add_accuracy(app, action);
    add_sweep(app, action);
    add_check(app, action);
    add_impact(app, action);
    add_bench(app, action);
    add_describe(app, action);
}

int run(int argc, char** argv) {
    CLI::App app("carom, a billiards table simulator", "carom");
    app.formatter(std::make_shared<HelpFormatter>());
    app.set_version_flag("--version", "carom " CAROM_VERSION);
    app.require_subcommand(0, 1);  // none is an error too, but one with a better message than CLI11's
    app.footer(
        "CAROM_ISA=scalar|v3|v4 in the environment forces the instruction set (default: the widest "
        "available).\n"
        "Exit status: 0, 1 failed while running, 2 bad usage or bad scene, 130 interrupted.");
    Action action;
    add_commands(app, action);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        print(app.help());
        return kOk;
    } catch (const CLI::CallForVersion& version) {
        print(std::string(version.what()) + "\n");
        return kOk;
    } catch (const CLI::ParseError& error) {
        const std::vector<CLI::App*> named = app.get_subcommands();
        const std::string command = named.empty() ? "" : " " + named.front()->get_name();
        throw UsageError(std::string(error.what()) + "; see carom" + command + " --help");
    }
    if (!action)
        throw UsageError(
            "a command is missing: simulate, render, margin, accuracy, sweep, check, impact, bench or "
            "describe; see carom "
            "--help");
    return action();
}

/// Runs, and turns what was thrown into a message and an exit status.
int guarded(int argc, char** argv) {
    try {
        const int status = run(argc, argv);
        flush_output();
        return status;
    } catch (const Interrupted&) {
        return interrupted_status();
    } catch (const OutputClosed&) {
        return kFailed;
    } catch (const UsageError& error) {
        message(error.what());
        return kBadUsage;
    } catch (const SceneError& error) {
        message(error.what());
        return kBadUsage;
    } catch (const std::bad_alloc&) {
        message("out of memory");
        return kFailed;
    } catch (const std::exception& error) {
        message(error.what());
        return kFailed;
    }
}

}  // namespace
}  // namespace carom::tools

int main(int argc, char** argv) {
    carom::tools::prepare_process();
    return carom::tools::guarded(argc, argv);
}
