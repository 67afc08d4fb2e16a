// Options that several commands share, and their common first steps.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "base/options.h"
#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "carom/engine/simulate.h"
#include "carom/render/sequence.h"

namespace carom::tools {

// Each of these adds options, whose variables hold the defaults. The variables of add_picture are empty: the
// scene has the defaults.
void add_gl(Options& command, std::string& gl);
void add_picture(Options& command, std::optional<double>& fps, std::string& size);
void add_repeat(Options& command, int& rounds, std::string description);
void add_cloth_slip(Options& command, std::string& name, std::string description);
void add_reports(Options& command, std::string& csv, bool& json);

/// Runs a program, and turns exceptions into a message and an exit status.
int guarded(int (*run)(int argc, char** argv), int argc, char** argv);

/// Checks the name of a page before any work is done; an empty name is valid. @throws UsageError
void check_page_path(const std::string& option, const std::string& path);

/// The instruction set in CAROM_ISA, else the fastest one here for every kernel.
/// @throws UsageError for an unknown or unavailable name
kernel::Isa chosen_isa();

/// Reads a scene and plans it; its warnings go to standard error. @throws SceneError
Plan plan_scene(const std::string& path);

/// Options of a run without a progress line. SIGINT ends the run.
SimulateOptions interruptible();

/// Calls simulate() and shows a progress line. SIGINT ends the run. @throws SimulationError, Interrupted
Record simulate_plan(const Plan& plan, SimulateOptions options, Outcome* outcome = nullptr);

/// Reads a record from a file (.json), whose notes go to standard error, or simulates a scene.
/// @throws SceneError, SimulationError, Interrupted
Record read_shot(const std::string& path, SimulateOptions options);

/// The first comment at the beginning of a scene file, up to its first full stop or colon.
std::string scene_title(std::string_view scene);

/// Whether a file name is the name of a record.
inline bool is_record(const std::string& path) {
    return path.ends_with(".json");
}

/// Reads exactly kCount numbers with a separator between them: "1280x720". Returns nothing for any other
/// text.
template <class Number, std::size_t kCount>
std::optional<std::array<Number, kCount>> numbers_in(const std::string& text, char separator) {
    std::array<Number, kCount> list{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < kCount; ++i) {
        if (i > 0 && (at == end || *at++ != separator)) return std::nullopt;
        const auto [rest, error] = std::from_chars(at, end, list[i]);
        if (error != std::errc()) return std::nullopt;
        at = rest;
    }
    if (at != end) return std::nullopt;
    return list;
}

/// Reads width and height, "1280x720". @throws UsageError
FrameSize parse_size(const std::string& text);

/// Reads the columns and rows of a contact sheet, "4x3". @throws UsageError
FrameSize parse_sheet(const std::string& text);

/// The requested frames per second, else the scene's. @throws UsageError
double chosen_fps(std::optional<double> asked, const RenderSettings& settings);

/// The number of frames k with from + k / fps <= to. @throws UsageError if there are too many
long checked_frame_count(double from, double to, double fps);

}  // namespace carom::tools
