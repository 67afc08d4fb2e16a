// carom render: numbered PNG frames of a scene or of a record.
#include <fmt/core.h>

#include <cmath>

#include "carom/render/sequence.h"
#include "commands.h"
#include "console.h"
#include "setup.h"

namespace carom::tools {
namespace {

bool is_record_file(const std::string& path) {
    constexpr std::string_view kEnding = ".json";
    return path.size() >= kEnding.size() &&
           path.compare(path.size() - kEnding.size(), kEnding.size(), kEnding) == 0;
}

void check_args(const RenderArgs& args) {
    const auto second = [](const char* option, std::optional<double> value) {
        if (value && !(*value >= 0.0 && std::isfinite(*value))) {
            throw UsageError(fmt::format("{}: expected a number of seconds of at least 0", option));
        }
    };
    second("--from", args.from);
    second("--to", args.to);
    second("--at", args.at);
    if (args.to && *args.to < args.from) throw UsageError("--to is before --from: there would be no frame");
    if (args.at && (args.from != 0.0 || args.to || args.frame)) {
        throw UsageError("--at is one instant: it cannot be combined with --from, --to or --frame");
    }
    if (args.frame && *args.frame < 0) throw UsageError("--frame: frames are numbered from 0");
    try {
        render::frame_path(args.pattern, 0);
    } catch (const render::RenderError& error) {
        throw UsageError(error.what());
    }
}

render::SequenceOptions sequence_options(const RenderArgs& args, const Record& record) {
    const RenderSettings& settings = record.render;
    render::SequenceOptions options;
    options.pattern = args.pattern;
    options.fps = chosen_fps(args.fps, settings);
    options.from = args.at.value_or(args.from);
    options.to = args.at ? args.at : args.to;
    options.frame = args.frame;
    options.size =
        args.size.empty() ? render::FrameSize{settings.width, settings.height} : parse_size(args.size);
    options.camera = args.camera.empty() ? settings.camera : args.camera;
    options.png_level = args.png_level;
    options.backend = render::backend_from_name(args.gl);
    const long frames = checked_frame_count(options.from, options.to.value_or(record.duration), options.fps);
    if (frames < 1) {
        throw UsageError(
            fmt::format("--from {}: the shot is over after {} s", options.from, record.duration));
    }
    if (args.frame && *args.frame >= frames) {
        throw UsageError(fmt::format("--frame {}: the last frame is {}", *args.frame, frames - 1));
    }
    return options;
}

}  // namespace

int run_render(const RenderArgs& args) {
    check_args(args);
    if (!args.size.empty()) parse_size(args.size);
    const Record record =
        is_record_file(args.input) ? read_record(args.input) : simulate_plan(plan_scene(args.input), {});
    render::SequenceOptions options = sequence_options(args, record);
    ProgressLine line("rendering:");
    options.progress = [&line](long done, long total) {
        throw_if_interrupted();
        line.show_bar(done, total);
    };
    const std::vector<render::FrameTiming> timings = render::render_sequence(record, options);
    throw_if_interrupted();
    if (timings.size() == 1) {
        print(fmt::format("1 frame: {}\n", render::frame_path(options.pattern, timings.front().frame)));
        return kOk;
    }
    print(fmt::format("{} frames, {}x{} at {} fps: {}\n", timings.size(), options.size.width,
                      options.size.height, options.fps, options.pattern));
    print(fmt::format("to make a film of them: ffmpeg -framerate {} -i {} -pix_fmt yuv420p shot.mp4\n",
                      options.fps, options.pattern));
    return kOk;
}

}  // namespace carom::tools
