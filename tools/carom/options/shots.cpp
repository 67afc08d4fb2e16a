// Options of the commands on a scene or record: simulate, render, margin, sweep, check, impact.
#include <memory>
#include <string>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/kernel/tolerance.h"
#include "commands.h"
#include "options/options.h"

namespace carom::tools {

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

}  // namespace carom::tools
