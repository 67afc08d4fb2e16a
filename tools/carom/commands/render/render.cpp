// carom render: numbered PNG frames, or a film, of a scene or of a record.
#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/console.h"
#include "base/margin.h"
#include "base/options.h"
#include "base/setup.h"
#include "carom/engine/printable.h"
#include "carom/render/sequence.h"
#include "commands/render/film.h"

namespace carom::tools {
namespace {

struct RenderArgs {
    std::string input;  ///< a scene, or a record (.json)
    std::string pattern = "frames/%05d.png";
    std::optional<double> fps;
    std::string size;  ///< "1280x720"; empty: the scene's
    double from = 0.0;
    std::optional<double> to;
    std::optional<std::int64_t> frame;
    std::optional<double> at;
    std::string camera;  ///< empty: the scene's
    std::string gl = "auto";
    std::string png_writer = "changes";
    std::string eye, target;  ///< "x,y,z"; empty: a named camera
    std::string ball;         ///< ball for camera "follow"; empty: the first that moves
    std::string overlay;      ///< list of names
    std::string sheet;        ///< "4x3"; empty: frames
    int jobs = 0;
    bool raw = false;
    bool y4m = false;
    const FilmKind* film() const { return raw || y4m || !sheet.empty() ? nullptr : film_kind(pattern); }
};

/// Other programs recognise a file by its name.
void check_png_name(const std::string& path) {
    if (!path.ends_with(".png") && !path.ends_with(".PNG"))
        throw UsageError(fmt::format("-o {}: pictures are PNG files; give a name that ends in .png", path));
}

std::string sheet_path(const RenderArgs& args) {
    return args.pattern.find('%') == std::string::npos ? args.pattern : "sheet.png";
}

/// check_files() has rejected options that name one file; this also covers the names from a pattern.
void check_input(const RenderArgs& args, bool replaces, const std::string& output) {
    if (replaces)
        throw UsageError(fmt::format("-o {} would overwrite the input {}; choose another name",
                                     in_quotes(output), in_quotes(args.input)));
}

void check_args(const RenderArgs& args) {
    constexpr double kAiming = -2.0;  // [s] before the strike at 0, the cue aims
    const auto second = [](const char* option, std::optional<double> value, double least) {
        if (value && !(*value >= least && std::isfinite(*value))) {
            throw UsageError(fmt::format("{}: expected a number of seconds of at least {:g}", option, least));
        }
    };
    second("--from", args.from, kAiming);
    second("--to", args.to, 0.0);
    second("--at", args.at, kAiming);
    if (args.to && *args.to < args.from)
        throw UsageError("--to is before --from, so there are no frames; swap them");
    if (args.at && (args.from != 0.0 || args.to || args.frame)) {
        throw UsageError("--at shows one instant; use it without --from, --to and --frame");
    }
    if (args.frame && *args.frame < 0) throw UsageError("--frame: frames are numbered from 0");
    if (!args.sheet.empty()) {
        parse_sheet(args.sheet);
        const std::string path = sheet_path(args);
        std::error_code none;
        check_input(args, std::filesystem::equivalent(path, args.input, none), path);
        check_png_name(path);
        return;
    }
    if (const FilmKind* const film = args.film()) {
        const std::string what = fmt::format("-o {}", args.pattern);
        if (args.frame || args.at)
            throw UsageError(what + ": a film needs more than one frame; use --from and --to");
        if (args.png_writer != "changes")
            throw UsageError(what + ": --png-writer applies only to PNG files; leave it out");
        require_ffmpeg(args.pattern);
        return;
    }
    if (args.raw || args.y4m) return;
    const bool one = args.at || args.frame;
    try {
        check_input(args, render::writes_over(args.pattern, args.input), args.pattern);
        if (!one && !render::is_numbered(args.pattern))
            throw UsageError(fmt::format(
                "-o {}: frames need a number in their names; write one %d or %05d, as in "
                "frames/%05d.png, name a film, as in shot.mp4 (.webm, .gif, .webp), or choose one "
                "frame with --at S",
                args.pattern));
    } catch (const render::RenderError& error) {
        throw UsageError(error.what());
    }
    check_png_name(args.pattern);
}

/// The option that makes ffmpeg add a column or row to an odd size, which yuv420p does not have.
std::string even_sides(const FrameSize& size) {
    return size.width % 2 + size.height % 2 == 0 ? "" : "-vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2' ";
}

/// "x,y,z" in m.
Vec3 parse_point(const char* option, const std::string& text) {
    const auto x = numbers_in<double, 3>(text, ',');
    if (x && std::isfinite((*x)[0]) && std::isfinite((*x)[1]) && std::isfinite((*x)[2]))
        return Vec3(x->data());
    throw UsageError(fmt::format("{}: expected three numbers in m, such as 0.6,-0.5,0.8", option));
}

render::Overlay overlay_of(const RenderArgs& args) {
    try {
        return render::parse_overlay(args.overlay);
    } catch (const render::RenderError& error) {
        throw UsageError(fmt::format("--overlay: {}", error.what()));
    }
}

void set_view(const RenderArgs& args, const RenderSettings& settings, render::SequenceOptions& options) {
    if (!args.eye.empty() && args.target.empty()) throw UsageError("--eye needs --target X,Y,Z");
    if (!args.eye.empty() && !args.camera.empty())
        throw UsageError("--camera and --eye cannot be combined; use one of them");
    options.camera = args.camera.empty() ? settings.camera : args.camera;
    options.view.ball = args.ball;
    if (!args.eye.empty()) {
        options.view.eye = parse_point("--eye", args.eye);
        options.view.target = parse_point("--target", args.target);
        if (*options.view.eye == *options.view.target)
            throw UsageError("--target and --eye are the same point; move one of them");
    } else if (args.camera.empty()) {
        options.view.eye = settings.eye;
        options.view.target = settings.target;
    }
    options.overlay = overlay_of(args);
}

/// Lowers the scene's rate to the film's limit, but not a requested rate.
double film_fps(const RenderArgs& args, const RenderSettings& settings) {
    const double fps = chosen_fps(args.fps, settings), fastest = args.film()->fastest;
    if (fastest == 0.0 || fps <= fastest) return fps;
    if (args.fps)
        throw UsageError(fmt::format("--fps {}: {} allows at most {} frames per second", fps,
                                     args.film()->ending, fastest));
    message(fmt::format("note: {} allows at most {} frames per second; the scene has {}", args.film()->ending,
                        fastest, fps));
    return fastest;
}

render::SequenceOptions sequence_options(const RenderArgs& args, const Record& record) {
    const RenderSettings& settings = record.render;
    render::SequenceOptions options;
    options.pattern = args.pattern;
    options.fps = args.film() ? film_fps(args, settings) : chosen_fps(args.fps, settings);
    options.from = args.at.value_or(args.from);
    options.to = args.at ? args.at : args.to;
    options.frame = args.frame;
    options.size = args.size.empty() ? settings.size() : parse_size(args.size);
    set_view(args, settings, options);
    options.libpng = args.png_writer == "libpng";
    options.jobs = args.jobs;
    if (args.raw || args.y4m) {
        if (args.y4m) options.raw_format = render::RawFormat::kY4m;
        options.raw = [](const std::uint8_t* bytes, std::size_t count) {
            print_bytes(std::string_view(reinterpret_cast<const char*>(bytes), count));
        };
    }
    options.backend = render::backend_from_name(args.gl);
    if (options.from > record.duration && !args.to) {
        throw UsageError(fmt::format("{} {}: the shot ends at {:.3f} s", args.at ? "--at" : "--from",
                                     options.from, record.duration));
    }
    const long frames = checked_frame_count(options.from, options.to.value_or(record.duration), options.fps);
    if (args.frame && *args.frame >= frames) {
        throw UsageError(fmt::format("--frame {}: the last frame is {}", *args.frame, frames - 1));
    }
    return options;
}

/// Gives the margin bar the simulation cost of each frame: the sum over the events up to the next frame. A
/// record that was not profiled has no costs; its bar shows only drawing, reading back and encoding.
void set_simulation_costs(const Record& record, render::SequenceOptions& options) {
    if (record.costs.empty()) return;
    // Events before the first and after the last shown frame belong to frames that are not shown. All of the
    // earlier ones are in one such frame.
    const long first = options.from > 0.0 ? 1 : 0;
    const double before = options.from > 0.0 ? 1.0 / options.fps : 0.0;
    const long frames = render::frame_count(options.from, options.to.value_or(record.duration), options.fps);
    auto costs = costs_by_frame(record, options.from - before, options.fps, first + frames + 1);
    options.simulate_ms = [costs = std::move(costs), first](long k) {
        return costs[first + k].simulate_ms();
    };
}

int write_sheet(const RenderArgs& args, const Record& record, const render::SequenceOptions& options) {
    const FrameSize grid = parse_sheet(args.sheet);
    const std::string path = sheet_path(args);
    render::render_sheet(record, options, grid.width, grid.height, path);
    print(fmt::format(
        "{}: {}\n",
        counted(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height), "picture"),
        path));
    return kOk;
}

int write_film(const RenderArgs& args, const Record& record, render::SequenceOptions& options) {
    const FilmKind& kind = *args.film();
    if (kind.even && (options.size.width % 2 != 0 || options.size.height % 2 != 0)) {
        throw UsageError(fmt::format("--size {}x{}: {} needs an even width and height", options.size.width,
                                     options.size.height, kind.ending));
    }
    Film film(args.pattern, kind, options.size, options.fps);
    options.raw_format = kind.input;
    options.raw = [&film](const std::uint8_t* bytes, std::size_t count) { film.write(bytes, count); };
    const std::size_t frames = render::render_sequence(record, options).size();
    film.commit();
    print(fmt::format("{}, {}x{} at {} fps: {}\n", counted(frames, "frame"), options.size.width,
                      options.size.height, options.fps, args.pattern));
    return kOk;
}

int run(const RenderArgs& args) {
    render::backend_from_name(args.gl);  // fails in a build without OpenGL
    check_args(args);
    if (args.raw && args.y4m) throw UsageError("--raw and --y4m cannot be combined; use one of them");
    const char* const stream = args.raw ? "--raw" : "--y4m";
    if ((args.raw || args.y4m) && !args.sheet.empty())
        throw UsageError(fmt::format("{} cannot be combined with --sheet", stream));
    if (!args.size.empty()) parse_size(args.size);
    SimulateOptions simulation;
    simulation.profile = overlay_of(args).margin;
    const Record record = read_shot(args.input, simulation);
    render::SequenceOptions options = sequence_options(args, record);
    if (options.overlay.margin) set_simulation_costs(record, options);
    ProgressLine line("rendering:");
    options.progress = [&line](long done, long total) {
        throw_if_interrupted();
        line.show_bar(done, total);
    };
    options.table_progress = [&line](int done, int total) {
        throw_if_interrupted();
        if (line.due()) line.show_text(fmt::format("the table, {} of {}", done, total));
    };
    if (!args.sheet.empty()) return write_sheet(args, record, options);
    if (args.film() != nullptr) return write_film(args, record, options);
    if (args.y4m) print(render::y4m_header(options.size, options.fps));
    const std::vector<render::FrameTiming> timings = render::render_sequence(record, options);
    throw_if_interrupted();
    if (args.raw || args.y4m) {
        flush_output();
        const std::string input =
            args.y4m
                ? std::string(
                      "-f yuv4mpegpipe -i - -colorspace bt709 -color_primaries bt709 -color_trc bt709")
                : fmt::format("-f rawvideo -pix_fmt rgb24 -s {}x{} -framerate {} -i - {}-pix_fmt yuv420p",
                              options.size.width, options.size.height, options.fps, even_sides(options.size));
        message(fmt::format("{} of {}; to make a film of them, pipe them into: ffmpeg {} shot.mp4",
                            counted(timings.size(), "frame"), args.y4m ? "Y4M" : "RGB", input));
        return kOk;
    }
    if (timings.size() == 1) {
        print(fmt::format("1 frame: {}\n", render::frame_path(options.pattern, timings.front().frame)));
        return kOk;
    }
    print(fmt::format("{}, {}x{} at {} fps: {}\n", counted(timings.size(), "frame"), options.size.width,
                      options.size.height, options.fps, options.pattern));
    // With the number of frames, so that older files with higher numbers stay out of the film.
    print(fmt::format(
        "to make a film of them: ffmpeg -y -framerate {} -i {} -frames:v {} {}-pix_fmt yuv420p shot.mp4\n",
        options.fps, shell_word(options.pattern), timings.back().frame + 1, even_sides(options.size)));
    return kOk;
}

}  // namespace

void add_render(Options& program) {
    auto [command, args] = program.command<RenderArgs>(
        "render",
        "Render a scene or a record as numbered PNG frames, or as a film; frame k shows from + k/fps", run);
    command.argument("SCENE", args.input, "Scene file (TOML) or record (.json)").required = true;
    command.option("-o,--output", &args.pattern, "PATTERN",
                   "Frames, with one %d or %05d for the number, or a film (.mp4, .webm, .gif, .webp), which "
                   "needs ffmpeg");
    add_picture(command, args.fps, args.size);
    command.option("--from", &args.from, "S", "Start time in s, from -2; the cue strikes at 0");
    command.option("--to", &args.to, "S", "End time in s (default: the end of the shot)");
    command.option("--frame", &args.frame, "K", "Render only frame K (default: all)");
    command.option("--at", &args.at, "S", "Render only this time in s, as frame 0 (default: all)");
    command.option("--camera", &args.camera, "NAME", "Camera (default: the scene's, else top)")
        .one_of({"top", "rail", "player", "follow"});
    command.option("--eye", &args.eye, "X,Y,Z",
                   "Free camera: position of the eye in m (default: a named camera)");
    Option& target = command.option("--target", &args.target, "X,Y,Z",
                                    "Free camera: point it looks at, in m (default: a named camera)");
    target.needs = "--eye";
    command.option("--ball", &args.ball, "ID", "Ball for camera follow (default: the first that moves)");
    command.option("--overlay", &args.overlay, "LIST",
                   "Draw trails (trails=ball: in the balls' colours), events, spin, ghost, clock, margin, or "
                   "all of these; diamonds: number the diamonds (default: none)");
    command.option("--sheet", &args.sheet, "CxR",
                   "Write one contact sheet with C columns and R rows, as wide as --size (default: off)");
    command.option("--jobs", &args.jobs, "N", "Threads that encode and write, 0 for one per core").in(0, 256);
    command.flag("--raw", args.raw,
                 "Write RGB bytes to standard output, for ffmpeg, instead of PNG files (default: off)");
    command.flag(
        "--y4m", args.y4m,
        "Write a Y4M stream (4:2:0) to standard output instead: half the bytes of --raw (default: off)");
    add_gl(command, args.gl);
    command
        .option(
            "--png-writer", &args.png_writer, "NAME",
            "changes: encode only what changed since the previous frame; libpng: encode every frame whole")
        .one_of({"changes", "libpng"});
}

}  // namespace carom::tools
