// carom export: a shot for 3D programs.
#include <fmt/core.h>

#include <cmath>
#include <string>

#include "base/console.h"
#include "base/options.h"
#include "base/setup.h"
#include "commands/export/gltf.h"
#include "report/table.h"

namespace carom::tools {
namespace {

struct ExportArgs {
    std::string input;
    std::string output = "shot.glb";
    std::string interpolation = "cubic";
    double fps = 120.0;
};

int run(const ExportArgs& args) {
    if (!args.output.ends_with(".glb"))
        throw UsageError(
            fmt::format("-o {}: the export is binary glTF; give a name that ends in .glb", args.output));
    GltfOptions options;
    options.linear = args.interpolation == "linear";
    options.fps = chosen_fps(args.fps, {});
    const Record record = read_shot(args.input, {});
    if (options.linear) checked_frame_count(0.0, record.duration, options.fps);
    const std::string bytes = shot_gltf(record, options);
    write_report(args.output, bytes);
    print(fmt::format("{}: {}, {:.3f} s, {} kB\n", args.output, counted(record.tracks.size(), "ball"),
                      record.duration, (bytes.size() + 500) / 1000));
    return kOk;
}

}  // namespace

void add_export(Options& program) {
    auto [command, args] =
        program.command<ExportArgs>("export", "Export a shot as glTF 2.0, for three.js, Godot, Blender", run);
    command.argument("SHOT", args.input, "Scene file (TOML) or record (.json)").required = true;
    command.option("-o,--output", &args.output, "FILE.glb", "File to write");
    command.option("--interpolation", &args.interpolation, "NAME", "cubic is exact; Blender needs linear")
        .one_of({"cubic", "linear"});
    command.option("--fps", &args.fps, "F", "Samples per second for linear");
}

}  // namespace carom::tools
