// The program: the list of its commands, and what becomes of an error.
#include <exception>
#include <new>
#include <string>

#include "carom/engine/scene.h"
#include "console.h"
#include "options.h"

namespace carom::tools {

// A command is one file, which adds itself to the table of options; those that measure stand in folders.
void add_simulate(Options& program);
void add_render(Options& program);
void add_view(Options& program);
void add_export(Options& program);
void add_compare(Options& program);
void add_margin(Options& program);
void add_accuracy(Options& program);
void add_sweep(Options& program);
void add_validate(Options& program);
void add_check(Options& program);
void add_impact(Options& program);
void add_bench_kernel(Options& bench);
void add_bench_render(Options& bench);
void add_bench_shot(Options& bench);
void add_describe(Options& program);

namespace {

int run(int argc, char** argv) {
    Options program("carom", "carom, a billiards table simulator");
    program.version = CAROM_VERSION;
    program.option("-V,--version", {}, "", "Display program version information and exit");
    program.footer =
        "Scenes are TOML files: docs/reference/scene_format.md and the folder scenes.\n"
        "  carom simulate scenes/draw.toml            what happens\n"
        "  carom view scenes/draw.toml -o shot.html   a page that plays it\n"
        "CAROM_ISA=scalar|v3|v4 in the environment forces the instruction set (default: for each "
        "kernel the fastest one).\n"
        "Exit status: 0, 1 failed while running, 2 bad usage or bad scene, 130 or 143 interrupted.";
    add_simulate(program);
    add_render(program);
    add_view(program);
    add_export(program);
    add_compare(program);
    add_margin(program);
    add_accuracy(program);
    add_sweep(program);
    add_validate(program);
    add_check(program);
    add_impact(program);
    Options& bench = program.command("bench", "Ratios measured side by side in one run");
    add_bench_kernel(bench);
    add_bench_render(bench);
    add_bench_shot(bench);
    add_describe(program);
    return run_command_line(program, argc, argv);
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
    carom::tools::prepare_process(argc, argv, CAROM_VERSION);
    return carom::tools::guarded(argc, argv);
}
