// The program carom-lab, which validates and measures carom.
#include <string>
#include <vector>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "page/page.h"

namespace carom::tools {

/// The scripts of pages used only by reports, embedded in the program by the build.
const std::vector<PageFile>& lab_page_files();

// Each command is a folder and adds itself to the table of options.
void add_bench_discs(Options& bench);
void add_bench_kernel(Options& bench);
void add_bench_render(Options& bench);
void add_bench_shot(Options& bench);
void add_validate(Options& program);
void add_lab_accuracy(Options& program);
void add_lab_margin(Options& program);
void add_lab_compare(Options& program);

namespace {

int run(int argc, char** argv) {
    Options program("carom-lab", "carom-lab, the measurements behind carom");
    program.version = CAROM_VERSION;
    program.option("-V,--version", {}, "", "Display program version information and exit");
    program.footer =
        "lab/README.md names the command behind every figure.\n"
        "CAROM_ISA=scalar|v3|v4 in the environment forces the instruction set (default: the fastest one for "
        "each kernel).\n"
        "Exit status: 0 success, 1 failed while running, 2 bad usage or bad scene, 130 or 143 interrupted.";
    Options& bench = program.command("bench", "Ratios measured side by side in one run");
    add_bench_discs(bench);
    add_bench_kernel(bench);
    add_bench_render(bench);
    add_bench_shot(bench);
    add_validate(program);
    add_lab_accuracy(program);
    add_lab_margin(program);
    add_lab_compare(program);
    return run_command_line(program, argc, argv);
}

}  // namespace
}  // namespace carom::tools

int main(int argc, char** argv) {
    carom::tools::prepare_process(argc, argv, CAROM_VERSION, "carom-lab");
    carom::tools::add_page_files(carom::tools::lab_page_files());
    return carom::tools::guarded(carom::tools::run, argc, argv);
}
