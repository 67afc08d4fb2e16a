// carom bench render: what a frame costs, stage by stage.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bench/render_stages.h"
#include "console.h"
#include "setup.h"
#include "options.h"
#include <string>
#include <memory>

namespace carom::tools {
namespace {

struct BenchRenderArgs {
    std::string scene = "scenes/eight_ball_break.toml";
    int frames = 120;
    std::string gl = "osmesa";
    bool json = false;
};

int run(const BenchRenderArgs& args) {
    const Record record = simulate_plan(plan_scene(args.scene), {});
    ProgressLine line("bench render");
    const auto rows =
        bench_render(record, args.frames, render::backend_from_name(args.gl), [&line](long done, long total) {
            throw_if_interrupted();
            line.show_bar(done, total);
        });
    if (args.json) {
        nlohmann::ordered_json list = nlohmann::ordered_json::array();
        for (const RenderBenchRow& row : rows) {
            list.push_back({{"name", row.name},
                            {"draw_ms", row.draw_ms},
                            {"readback_ms", row.readback_ms},
                            {"draw_readback_p95_ms", row.slow_ms},
                            {"encode_ms", row.encode_ms},
                            {"write_ms", row.write_ms},
                            {"setup_ms", row.setup_ms},
                            {"fps", row.fps}});
        }
        print(nlohmann::ordered_json{{"gl", args.gl}, {"frames", args.frames}, {"rows", list}}.dump(2) +
              "\n");
        return kOk;
    }
    print(fmt::format(
        "{}: {} frames at each size; CPU ms a frame, medians after the first; write is wall time\n\n",
        args.scene, args.frames));
    print(fmt::format("{:8}{:>9}{:>10}{:>10}{:>9}{:>9}{:>10}{:>12}\n", "size", "draw", "readback", "both p95",
                      "encode", "write", "set-up", "frames/s"));
    for (const RenderBenchRow& row : rows) {
        print(fmt::format("{:8}{:>9.2f}{:>10.2f}{:>10.2f}{:>9.2f}{:>9.2f}{:>10.0f}{:>12.1f}\n", row.name,
                          row.draw_ms, row.readback_ms, row.slow_ms, row.encode_ms, row.write_ms,
                          row.setup_ms, row.fps));
    }
    return kOk;
}

}  // namespace

void add_bench_render(Options& bench) {
    auto args = std::make_shared<BenchRenderArgs>();
    Options& command = bench.command("render", "What drawing, reading back and encoding a frame costs");
    command.argument("SCENE", args->scene, "Scene file (TOML)");
    Option& frames =
        command.option("--frames", &args->frames, "N", "Frames at each size, spread over the shot");
    frames.range = {3, 100000};
    add_gl(command, args->gl);
    command.flag("--json", args->json, "Print JSON (default: off)");
    command.run = [args] { return run(*args); };
}

}  // namespace carom::tools
