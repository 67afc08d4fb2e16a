// Options of the commands that measure: accuracy, bench.
#include <memory>
#include <string>

#include "accuracy/kernel.h"
#include "accuracy/scene.h"
#include "bench/kernel.h"
#include "bench/shot.h"
#include "carom/engine/scene.h"
#include "commands.h"
#include "console.h"
#include "options/options.h"

namespace carom::tools {

namespace {

void add_bench_kernel(CLI::App& bench, Action& action) {
    auto args = std::make_shared<BenchOptions>();
    CLI::App* sub = bench.add_subcommand(
        "kernel", "Every form of the ball-ball march, and every tolerance, against the plain march");
    sub->add_flag("--json", args->json, "Print JSON (default: off)");
    sub->add_option("--random", args->random, "Seeded random impacts beside the five states of the paper")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    sub->add_option("--seed", args->seed, "Seed of the random impacts")
        ->type_name("S")
        ->capture_default_str();
    sub->add_option("--repeat", args->repeats, "Interleaved rounds; minimum and median are over them")
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    sub->add_option("--cloth-slip", args->cloth_slip, "Sign of the cloth slip inside the impact")
        ->type_name("NAME")
        ->check(CLI::IsMember({"consistent", "as_published"}))
        ->capture_default_str();
    sub->add_flag("!--no-growth", args->growth, "Leave out N = 100 and 10000 (default: measured)");
    sub->add_option("--only", args->only,
                    "Time only this form, such as 'march reduced state', or all whose names begin with these "
                    "words, such as 'tolerance'; may be repeated (default: all)")
        ->type_name("NAME")
        ->allow_extra_args(false);
    sub->footer("Without CAROM_ISA all instruction sets that this processor has run in one call.");
    sub->callback([args, &action] { action = [args] { return run_bench_kernel(*args); }; });
}

void add_bench_render(CLI::App& bench, Action& action) {
    auto args = std::make_shared<BenchRenderArgs>();
    CLI::App* sub = bench.add_subcommand("render", "What drawing, reading back and encoding a frame costs");
    sub->add_option("SCENE", args->scene, "Scene file (TOML)")->capture_default_str();
    sub->add_option("--frames", args->frames, "Frames at each size, spread over the shot")
        ->type_name("N")
        ->check(CLI::Range(3, 100000))
        ->capture_default_str();
    add_gl(*sub, args->gl);
    sub->add_flag("--json", args->json, "Print JSON (default: off)");
    sub->callback([args, &action] { action = [args] { return run_bench_render(*args); }; });
}

void add_bench_shot(CLI::App& bench, Action& action) {
    auto args = std::make_shared<BenchShotOptions>();
    CLI::App* sub = bench.add_subcommand(
        "shot", "Whole breaks and shots in units of one baseline impact; growth with the number of balls");
    sub->add_flag("--json", args->json, "Print JSON (default: off)");
    sub->add_option("--seeds", args->seeds, "Seeds of every shot; a row is their median")
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    sub->add_option("--repeat", args->repeats,
                    "Interleaved rounds; a shot counts with its minimum (gases: a third of them)")
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    sub->add_option("--events", args->events, "Events of a gas at each size")
        ->type_name("N")
        ->check(CLI::Range(10, 10000000))
        ->capture_default_str();
    sub->add_flag("!--no-growth", args->growth,
                  "Leave out the gases of 16 to 10000 balls (default: measured)");
    sub->footer("One baseline impact is the plain double march at N = 1000, timed in the same run.");
    sub->callback([args, &action] { action = [args] { return run_bench_shot(*args); }; });
}

void add_accuracy_kernel(CLI::App& accuracy, Action& action) {
    auto args = std::make_shared<AccuracyKernelArgs>();
    CLI::App* sub = accuracy.add_subcommand(
        "kernel", "One impact: time and error of the march, of the tolerance kernel, of closed forms");
    sub->add_option("--count", args->count, "Seeded random impacts")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    sub->add_option("--seed", args->seed, "Seed of the random impacts")
        ->type_name("S")
        ->capture_default_str();
    sub->add_option("--repeat", args->repeat, "Interleaved rounds; minimum, median and maximum are over them")
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    sub->add_option("--most-substeps", args->most_substeps, "Largest N of the march")
        ->type_name("N")
        ->check(CLI::Range(10, 100000))
        ->capture_default_str();
    add_reports(*sub, args->csv, args->plot, args->json);
    sub->footer("Errors are shares of the approach speed, from a solution on which two methods agree.");
    sub->callback([args, &action] { action = [args] { return run_accuracy_kernel(*args); }; });
}

}  // namespace

void add_bench(CLI::App& app, Action& action) {
    CLI::App* bench = app.add_subcommand("bench", "Ratios measured side by side in one run");
    bench->require_subcommand(1);
    add_bench_kernel(*bench, action);
    add_bench_render(*bench, action);
    add_bench_shot(*bench, action);
}

void add_accuracy(CLI::App& app, Action& action) {
    auto args = std::make_shared<AccuracySceneArgs>();
    CLI::App* sub = app.add_subcommand(
        "accuracy", "What accuracy costs in time: of a shot (SCENE), or of one impact (kernel)");
    sub->add_option("SCENE", args->scene, "Scene file (TOML)");
    sub->add_option("--target", args->target, "Final error allowed, in m: what the recommendation aims at")
        ->type_name("M")
        ->capture_default_str();
    sub->add_option("--march", args->march, "Settings of the march to compare, N")
        ->type_name("N,...")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(1, 100000000))
        ->capture_default_str();
    sub->add_option("--tolerance", args->tolerances, "Tolerances to compare")
        ->type_name("E,...")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(kernel::kTightestTolerance, kernel::kLoosestTolerance))
        ->capture_default_str();
    sub->add_option("--repeat", args->repeat, "Interleaved rounds; minimum, median and maximum are over them")
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    sub->add_flag("--box2d", args->box2d,
                  "Also the same shot in a Box2D world stepped at 60 Hz to 10 kHz (default: off)");
    add_reports(*sub, args->csv, args->plot, args->json);
    sub->require_subcommand(0, 1);
    sub->callback([args, sub, &action] {
        if (!sub->get_subcommands().empty()) return;
        action = [args] {
            if (args->scene.empty())
                throw UsageError(
                    "accuracy: a scene file or the word kernel is required; see carom accuracy --help");
            return run_accuracy_scene(*args);
        };
    });
    add_accuracy_kernel(*sub, action);
}

}  // namespace carom::tools
