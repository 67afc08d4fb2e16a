// The program: reads the command line, runs one sub-command, turns what it throws into an exit status.
// Only this file and describe.cpp include CLI11, which takes seconds to compile.
#include <CLI/CLI.hpp>

#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "accuracy/kernel.h"
#include "accuracy/scene.h"
#include "bench/kernel.h"
#include "bench/shot.h"
#include "carom/engine/scene.h"
#include "carom/kernel/tolerance.h"
#include "commands.h"
#include "console.h"
#include "describe.h"
#include "help_formatter.h"

namespace carom::tools {
namespace {

/// What the sub-command that was named will do.
using Action = std::function<int()>;

void add_simulate(CLI::App& app, Action& action) {
    auto args = std::make_shared<SimulateArgs>();
    CLI::App* sub =
        app.add_subcommand("simulate", "Run a scene: what happened, events, record, sampled states, hash");
    sub->add_option("SCENE", args->scene, "Scene file (TOML)")->required();
    sub->add_option("-o,--output", args->record, "Write the record, for carom render (default: not written)")
        ->type_name("FILE.json");
    sub->add_option("--events", args->events, "Write the events (default: not written)")
        ->type_name("FILE.csv");
    sub->add_option("--samples", args->samples,
                    "Write sampled states; needs --sample-dt (default: not written)")
        ->type_name("FILE.csv");
    sub->add_option("--sample-dt", args->sample_dt, "Time between samples in s (default: none)")
        ->type_name("S");
    sub->add_option("--until", args->until, "Stop at this time in s at the latest (default: the scene's end)")
        ->type_name("S");
    sub->add_flag("--hash", args->hash,
                  "Print the hash of all bits of the record instead of the summary (default: off)");
    sub->add_flag("--profile", args->profile,
                  "Time every event: cost by kind, kernel by ball-ball event, columns in the events file "
                  "(default: off)");
    sub->add_flag("--json", args->json, "Print JSON (default: off)");
    sub->add_flag(
        "--verify", args->verify,
        "Check the laws after every event; a broken one is named, and the exit status is 1 (default: off)");
    sub->callback([args, &action] { action = [args] { return run_simulate(*args); }; });
}

void add_gl(CLI::App& sub, std::string& gl) {
    sub.add_option("--gl", gl, "OpenGL without a display: osmesa, or egl (surfaceless)")
        ->type_name("NAME")
        ->check(CLI::IsMember({"osmesa", "egl"}))
        ->capture_default_str();
}

void add_reports(CLI::App& sub, std::string& csv, std::string& plot, bool& json) {
    sub.add_option("--csv", csv, "Write the table (default: not written)")->type_name("FILE.csv");
    sub.add_option("--plot", plot, "Draw it (default: not drawn)")->type_name("FILE.svg");
    sub.add_flag("--json", json, "Print JSON (default: off)");
}

void add_render(CLI::App& app, Action& action) {
    auto args = std::make_shared<RenderArgs>();
    CLI::App* sub = app.add_subcommand(
        "render", "Numbered PNG frames of a scene or a record; frame k shows from + k/fps");
    sub->add_option("SCENE", args->input, "Scene file (TOML), or a record (.json) of carom simulate -o")
        ->required();
    sub->add_option("-o,--output", args->pattern,
                    "Files to write, with one %d or %05d for the number of the frame")
        ->type_name("PATTERN")
        ->capture_default_str();
    sub->add_option("--fps", args->fps,
                    "Frames per second (default: the scene's, which is 60 unless it says otherwise)")
        ->type_name("F");
    sub->add_option("--size", args->size,
                    "Pixels (default: the scene's, which is 1280x720 unless it says otherwise)")
        ->type_name("WxH");
    sub->add_option("--from", args->from, "First instant in s")->type_name("S")->capture_default_str();
    sub->add_option("--to", args->to, "Last instant in s (default: the end of the shot)")->type_name("S");
    sub->add_option("--frame", args->frame, "Only frame K (default: all)")->type_name("K");
    sub->add_option("--at", args->at, "Only this instant in s, as frame 0 (default: all)")->type_name("S");
    sub->add_option("--camera", args->camera,
                    "Camera (default: the scene's, which is top unless it says otherwise)")
        ->type_name("NAME")
        ->check(CLI::IsMember({"top", "rail", "player", "follow"}));
    CLI::Option* eye =
        sub->add_option("--eye", args->eye, "Free camera: where the eye is, in m (default: a named camera)")
            ->type_name("X,Y,Z");
    sub->add_option("--target", args->target, "Free camera: what it looks at, in m (default: a named camera)")
        ->type_name("X,Y,Z")
        ->needs(eye);
    sub->add_option("--ball", args->ball,
                    "Ball that camera follow follows (default: the one that moves first)")
        ->type_name("ID");
    sub->add_option(
           "--overlay", args->overlay,
           "Drawn over the picture: trails, events, spin, ghost, clock, margin, or all (default: none)")
        ->type_name("LIST");
    sub->add_flag("--trails", args->trails, "The same as --overlay trails (default: off)");
    sub->add_option("--sheet", args->sheet,
                    "One contact sheet of columns x rows pictures instead of frames (default: off)")
        ->type_name("CxR");
    sub->add_option("--jobs", args->jobs, "Threads that encode and write; 0: one per core")
        ->type_name("N")
        ->check(CLI::Range(0, 256))
        ->capture_default_str();
    sub->add_flag("--resume", args->resume, "Leave out frames whose finished file is there (default: off)");
    sub->add_flag("--raw", args->raw,
                  "RGB bytes on standard output instead of PNG files, for ffmpeg (default: off)");
    add_gl(*sub, args->gl);
    sub->add_option("--png-level", args->png_level, "Compression, 0 (large, fast) to 9 (small, slow)")
        ->type_name("L")
        ->check(CLI::Range(0, 9))
        ->capture_default_str();
    sub->callback([args, &action] { action = [args] { return run_render(*args); }; });
}

void add_margin(CLI::App& app, Action& action) {
    auto args = std::make_shared<MarginArgs>();
    CLI::App* sub = app.add_subcommand("margin", "Real-time margin: what every frame costs against 1/fps");
    sub->add_option("SCENE", args->scene, "Scene file (TOML)")->required();
    sub->add_option("--fps", args->fps,
                    "Frames per second (default: the scene's, which is 60 unless it says otherwise)")
        ->type_name("F");
    sub->add_option("--size", args->size,
                    "Pixels (default: the scene's, which is 1280x720 unless it says otherwise)")
        ->type_name("WxH");
    sub->add_option("--repeat", args->repeat, "Runs; every frame's cost is the median over them")
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    sub->add_flag("--no-render", args->no_render, "Measure the simulation only (default: off)");
    sub->add_flag("--sweep", args->sweep,
                  "Every accuracy at every frame rate from 30 to 1000: where the scene stops being real time "
                  "(default: off)");
    add_gl(*sub, args->gl);
    sub->add_option("--trace", args->trace,
                    "Write the frames as Chrome trace events, for chrome://tracing or Perfetto (default: not "
                    "written)")
        ->type_name("FILE.json");
    add_reports(*sub, args->csv, args->plot, args->json);
    sub->footer(
        "simulate = detect + resolve + kernel + cluster. A frame costs simulate + draw + readback + encode + "
        "write,\nmeasured one after the other on one thread; frames go to a temporary folder and are "
        "removed.");
    sub->callback([args, &action] { action = [args] { return run_margin(*args); }; });
}

void add_sweep(CLI::App& app, Action& action) {
    auto args = std::make_shared<SweepArgs>();
    CLI::App* sub =
        app.add_subcommand("sweep", "Many shots of one scene with values that vary: a row a shot");
    sub->add_option("SCENE", args->scene, "Scene file (TOML)")->required();
    sub->add_option("--vary", args->vary,
                    "What varies and how, once per key: uniform(a,b), normal(sd) around the scene's value, "
                    "normal(mean,sd), integer(a,b) or list(v,...)")
        ->type_name("KEY=DISTRIBUTION")
        ->allow_extra_args(false)
        ->required();
    sub->add_option("--count", args->count, "Number of shots")->type_name("N")->required();
    sub->add_option("--seed", args->seed, "Seed of all draws")->type_name("S")->capture_default_str();
    sub->add_option("--jobs", args->jobs, "Threads; 0: one per core; the rows do not depend on it")
        ->type_name("J")
        ->check(CLI::Range(0, 256))
        ->capture_default_str();
    sub->add_option("--shard", args->shard,
                    "Only the I-th of N parts; the files of all parts, one behind the other, are the whole "
                    "(default: all)")
        ->type_name("I/N");
    sub->add_option("-o,--output", args->output, "Table to write")->type_name("FILE.csv")->required();
    sub->footer(
        "A sweep that was stopped or killed goes on when the same command is given again (docs/sweep.md).");
    sub->callback([args, &action] { action = [args] { return run_sweep(*args); }; });
}

void add_check(CLI::App& app, Action& action) {
    auto args = std::make_shared<CheckArgs>();
    CLI::App* sub =
        app.add_subcommand("check", "Validate a scene; print its plan: effects, models, kernel, names");
    sub->add_option("SCENE", args->scene, "Scene file (TOML)")->required();
    sub->callback([args, &action] { action = [args] { return run_check(*args); }; });
}

void add_impact(CLI::App& app, Action& action) {
    auto args = std::make_shared<ImpactArgs>();
    CLI::App* sub =
        app.add_subcommand("impact", "One impact per line of standard input, its result per line (JSON)");
    sub->add_option("--method", args->method, "Ball-ball model")
        ->type_name("NAME")
        ->check(CLI::IsMember({"mathavan", "inelastic", "elastic"}))
        ->capture_default_str();
    CLI::Option* substeps = sub->add_option("--substeps", args->substeps,
                                            "Use the published march with this N (mathavan; default: off)")
                                ->type_name("N")
                                ->check(CLI::Range(1, 100000000));
    sub->add_option("--tolerance", args->tolerance,
                    "Error allowed, relative to the approach speed (mathavan)")
        ->type_name("E")
        ->check(CLI::Range(kernel::kTightestTolerance, kernel::kLoosestTolerance))
        ->excludes(substeps)
        ->capture_default_str();
    sub->add_option("--cloth-slip", args->cloth_slip, "Sign of the cloth slip inside the impact (mathavan)")
        ->type_name("NAME")
        ->check(CLI::IsMember({"consistent", "as_published"}))
        ->capture_default_str();
    sub->callback([args, &action] { action = [args] { return run_impact(*args); }; });
}

void add_bench(CLI::App& app, Action& action) {
    CLI::App* bench = app.add_subcommand("bench", "Ratios measured side by side in one run");
    bench->require_subcommand(1);
    auto args = std::make_shared<BenchOptions>();
    CLI::App* sub = bench->add_subcommand(
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

void add_bench_render(CLI::App& app, Action& action) {
    auto args = std::make_shared<BenchRenderArgs>();
    CLI::App* sub = app.get_subcommand("bench")->add_subcommand(
        "render", "What drawing, reading back and encoding a frame costs");
    sub->add_option("SCENE", args->scene, "Scene file (TOML)")->capture_default_str();
    sub->add_option("--frames", args->frames, "Frames at each size, spread over the shot")
        ->type_name("N")
        ->check(CLI::Range(3, 100000))
        ->capture_default_str();
    add_gl(*sub, args->gl);
    sub->add_flag("--json", args->json, "Print JSON (default: off)");
    sub->callback([args, &action] { action = [args] { return run_bench_render(*args); }; });
}

void add_bench_shot(CLI::App& app, Action& action) {
    auto args = std::make_shared<BenchShotOptions>();
    CLI::App* sub = app.get_subcommand("bench")->add_subcommand(
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

void add_describe(CLI::App& app, Action& action) {
    auto format = std::make_shared<std::string>();
    CLI::App* sub =
        app.add_subcommand("describe", "This program as a man page, or as completions for a shell");
    sub->add_option("FORMAT", *format, "What to print")
        ->type_name("NAME")
        ->check(CLI::IsMember({"man", "bash", "zsh"}))
        ->required();
    sub->callback([format, &app, &action] {
        action = [format, &app] {
            print(*format == "man"    ? man_page(app, CAROM_VERSION)
                  : *format == "bash" ? bash_completion(app)
                                      : zsh_completion(app));
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
    add_bench_render(app, action);
    add_bench_shot(app, action);
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
