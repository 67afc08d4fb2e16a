#include "base/setup.h"

#include <fmt/core.h>
#include <algorithm>
#include <exception>
#include <new>

#include <cmath>
#include <optional>
#include <vector>

#include "base/console.h"
#include "base/output_file.h"
#include "carom/engine/strike.h"
#include "carom/engine/tolerances.h"

namespace carom::tools {
namespace {

/// More frames than this (46 hours at 60 fps) are considered a typing error: they would fill any disk.
constexpr double kMostFrames = 1e7;
constexpr double kFastestFps = 1e6;

/// "16x9", both 1 to kMaxImageSize.
std::optional<FrameSize> two_numbers(const std::string& text) {
    const auto sides = numbers_in<int, 2>(text, 'x');
    if (!sides) return std::nullopt;
    for (const int side : *sides)
        if (side < 1 || side > kMaxImageSize) return std::nullopt;
    return FrameSize{(*sides)[0], (*sides)[1]};
}

}  // namespace

void add_gl(Options& command, std::string& gl) {
    command.option("--gl", &gl, "NAME", "Offscreen OpenGL; auto is osmesa if installed, else egl")
        .one_of({"auto", "osmesa", "egl"});
}

void add_picture(Options& command, std::optional<double>& fps, std::string& size) {
    command.option("--fps", &fps, "F", "Frames per second (default: the scene's, else 60)");
    command.option("--size", &size, "WxH", "Size in pixels (default: the scene's, else 1280x720)");
}

void add_repeat(Options& command, int& rounds, std::string description) {
    command.option("--repeat", &rounds, "N", std::move(description)).in(1, 1000);
}

void add_cloth_slip(Options& command, std::string& name, std::string description) {
    command.option("--cloth-slip", &name, "NAME", std::move(description))
        .one_of({"consistent", "as_published"});
}

void add_reports(Options& command, std::string& csv, bool& json) {
    command.option("--csv", &csv, "FILE.csv", "Write the table to a file (default: not written)");
    command.flag("--json", json, "Print JSON (default: off)");
}

int guarded(int (*run)(int argc, char** argv), int argc, char** argv) {
    try {
        const int status = run(argc, argv);
        flush_output();
        return status;
    } catch (const Interrupted&) {
        return interrupted_status();
    } catch (const BrokenPipe&) {
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

void check_page_path(const std::string& option, const std::string& path) {
    if (!path.empty() && path != "/dev/stdout" && !path.ends_with(".html") && !path.ends_with(".htm"))
        throw UsageError(option + " " + path + ": pages are HTML; give a name that ends in .html");
}

kernel::Isa chosen_isa() {
    const auto [isa, problem] = kernel::isa_from_environment();
    if (*problem != '\0') throw UsageError(problem);
    return isa;
}

Plan plan_scene(const std::string& path) {
    const kernel::Isa isa = chosen_isa();
    Plan plan = make_plan(read_scene(path), isa);
    for (const std::string& warning : plan.warnings) message("warning: " + warning);
    if (const std::string note = room_note(plan.scene); !note.empty()) message("note: " + note);
    return plan;
}

SimulateOptions interruptible() {
    SimulateOptions options;
    options.progress = [](std::size_t, double) { throw_if_interrupted(); };
    return options;
}

Record simulate_plan(const Plan& plan, SimulateOptions options, Outcome* outcome) {
    ProgressLine line("simulating:");
    options.progress = [&line](std::size_t events, double time) {
        throw_if_interrupted();
        if (line.due()) line.show_text(fmt::format("{}, {:.3f} s", counted(events, "event"), time));
    };
    Record record;
    Outcome ignored;
    RunBuffers buffers;
    simulate(plan, buffers, outcome != nullptr ? *outcome : ignored, record, options);
    throw_if_interrupted();
    return record;
}

Record read_shot(const std::string& path, SimulateOptions options) {
    if (!is_record(path)) return simulate_plan(plan_scene(path), std::move(options));
    std::vector<std::string> notes;
    Record record = read_record(path, &notes);
    for (const std::string& note : notes) message(fmt::format("note: {}: {}", path, note));
    return record;
}

FrameSize parse_size(const std::string& text) {
    if (const auto size = two_numbers(text)) return *size;
    throw UsageError(fmt::format("--size {}: expected WIDTHxHEIGHT in pixels, 1 to {} each, as in 1280x720",
                                 text, kMaxImageSize));
}

FrameSize parse_sheet(const std::string& text) {
    if (const auto grid = two_numbers(text)) return *grid;
    throw UsageError(fmt::format("--sheet {}: expected COLUMNSxROWS of pictures, as in 4x3", text));
}

double chosen_fps(std::optional<double> asked, const RenderSettings& settings) {
    const double fps = asked.value_or(settings.fps);
    if (!(fps > 0.0 && fps <= kFastestFps)) {
        throw UsageError(
            fmt::format("--fps {}: expected a number greater than 0, up to {}", fps, kFastestFps));
    }
    return fps;
}

long checked_frame_count(double from, double to, double fps) {
    const double estimate = (to - from) * fps;
    if (!(estimate <= kMostFrames)) {
        throw UsageError(fmt::format(
            "from {} s to {} s at {} fps is more than {:.0f} frames; lower the rate or shorten the time",
            from, to, fps, kMostFrames));
    }
    return render::frame_count(from, to, fps);
}

std::string scene_title(std::string_view scene) {
    if (!scene.starts_with('#')) return "";
    scene.remove_prefix(std::min(scene.find_first_not_of("# "), scene.size()));
    // A full stop ends a sentence, but "2.3 m" has none.
    std::size_t end = scene.find_first_of(":\n");
    end = std::min({end, scene.find(". "), scene.find(".\n"), scene.size()});
    return std::string(scene.substr(0, end));
}

}  // namespace carom::tools
