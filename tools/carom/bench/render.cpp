// carom bench render: what a frame costs, stage by stage.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include <memory>
#include <string>
#include "bench/render_stages.h"
#include "console.h"
#include "options.h"
#include "report/table.h"
#include "setup.h"

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
    Table table(Column("name", "size", "<8"), Column("draw_ms", "draw", ">9.2f"),
                Column("readback_ms", "readback", ">10.2f"),
                Column("draw_readback_p95_ms", "both p95", ">10.2f"), Column("encode_ms", "encode", ">9.2f"),
                Column("write_ms", "write", ">9.2f"), Column("setup_ms", "set-up", ">10.0f"),
                Column("fps", "frames/s", ">12.1f"));
    for (const RenderBenchRow& r : rows)
        table.add({r.name, r.draw_ms, r.readback_ms, r.slow_ms, r.encode_ms, r.write_ms, r.setup_ms, r.fps});
    if (args.json) {
        const nlohmann::ordered_json all = {
            {"gl", args.gl}, {"frames", args.frames}, {"rows", table_json(table)}};
        print(all.dump(2) + "\n");
        return kOk;
    }
    print(fmt::format(
        "{}: {} frames at each size; CPU ms a frame, medians after the first; write is wall time\n\n{}",
        args.scene, args.frames, table_text(table)));
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
