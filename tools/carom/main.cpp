// The program carom and its commands.
#include <initializer_list>
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
void add_advise(Options& program);
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

int run(int argc, char** argv) {
    Options program("carom", "carom, a billiards simulator");
    program.version = CAROM_VERSION;
    program.option("-V,--version", {}, "", "Display program version information and exit");
    program.footer =
        "Scene files are TOML: see docs/reference/scene_format.md and the folder scenes.\n  carom simulate "
        "scenes/draw.toml            print what happens\n  carom view scenes/draw.toml -o shot.html   make a "
        "page that plays it\nA file named - is standard input or output.\nCAROM_ISA=scalar|v3|v4 in the "
        "environment forces the instruction set (default: "
        "the fastest one for each kernel).\nExit status: 0 success, 1 failed while running, 2 bad usage or "
        "bad scene, 130 or 143 interrupted.";
    const auto add = [&program](const char* group, std::initializer_list<void (*)(Options&)> commands) {
        for (const auto add_command : commands) {
            add_command(program);
            program.commands.back().group = group;
        }
    };
    add("Play", {add_simulate, add_play, add_next, add_judge, add_advise});
    add("Look", {add_view, add_render, add_diagram, add_export, add_compare});
    add("Many shots", {add_sweep, add_break, add_solve, add_sensitivity, add_fit});
    add("Ask", {add_check, add_accuracy, add_margin});
    add("For programs", {add_impact, add_describe});
    return run_command_line(program, argc, argv);
}

}  // namespace
}  // namespace carom::tools

int main(int argc, char** argv) {
    carom::tools::prepare_process(argc, argv, CAROM_VERSION);
    return carom::tools::guarded(carom::tools::run, argc, argv);
}
