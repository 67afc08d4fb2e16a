// The program carom and its commands.
#include <fmt/core.h>

#include <string>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"

namespace carom::tools {

// Each command has a folder in commands/ and adds itself to the table of options.
void add_simulate(Options& program);
void add_render(Options& program);
void add_view(Options& program);
void add_play(Options& program);
void add_diagram(Options& program);
void add_judge(Options& program);
void add_next(Options& program);
void add_export(Options& program);
void add_compare(Options& program);
void add_margin(Options& program);
void add_accuracy(Options& program);
void add_sweep(Options& program);
void add_sensitivity(Options& program);
void add_fit(Options& program);
void add_solve(Options& program);
void add_break(Options& program);
void add_check(Options& program);
void add_impact(Options& program);
void add_describe(Options& program);

namespace {

/// Refuses commands that moved to the laboratory. @throws UsageError with the new name
void refuse_moved(int argc, char** argv) {
    std::string command = argc > 1 ? argv[1] : "";
    if (command == "accuracy" && argc > 2 && std::string(argv[2]) == "kernel") command += " kernel";
    if (command != "bench" && command != "validate" && command != "accuracy kernel") return;
    throw UsageError(fmt::format(
        "{0} is now part of carom-lab; build carom's sources with -DCAROM_BUILD_LAB=ON and run carom-lab {0}",
        command));
}

int run(int argc, char** argv) {
    refuse_moved(argc, argv);
    Options program("carom", "carom, a billiards simulator");
    program.version = CAROM_VERSION;
    program.option("-V,--version", {}, "", "Display program version information and exit");
    program.footer =
        "Scene files are TOML: see docs/reference/scene_format.md and the folder scenes.\n  carom simulate "
        "scenes/draw.toml            print what happens\n  carom view scenes/draw.toml -o shot.html   make a "
        "page that plays it\nCAROM_ISA=scalar|v3|v4 in the environment forces the instruction set (default: "
        "the fastest one for each kernel).\nExit status: 0 success, 1 failed while running, 2 bad usage or "
        "bad scene, 130 or 143 interrupted.";
    add_simulate(program);
    add_render(program);
    add_view(program);
    add_play(program);
    add_diagram(program);
    add_next(program);
    add_judge(program);
    add_export(program);
    add_compare(program);
    add_margin(program);
    add_accuracy(program);
    add_sweep(program);
    add_break(program);
    add_solve(program);
    add_sensitivity(program);
    add_fit(program);
    add_check(program);
    add_impact(program);
    add_describe(program);
    return run_command_line(program, argc, argv);
}

}  // namespace
}  // namespace carom::tools

int main(int argc, char** argv) {
    carom::tools::prepare_process(argc, argv, CAROM_VERSION);
    return carom::tools::guarded(carom::tools::run, argc, argv);
}
