// Options that several commands have, and steps that several begin with.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <system_error>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "carom/engine/simulate.h"
#include "carom/render/sequence.h"
#include "options.h"

namespace carom::tools {

// Options: their variables hold the defaults, except in add_picture, where the scene has them.
void add_gl(Options& command, std::string& gl);
void add_picture(Options& command, std::optional<double>& fps, std::string& size);
void add_repeat(Options& command, int& rounds, std::string description);
void add_cloth_slip(Options& command, std::string& name, std::string description);
void add_reports(Options& command, std::string& csv, std::string& plot, bool& json);

/// CAROM_ISA, or the widest one. @throws UsageError for an unknown or unavailable name
kernel::Isa chosen_isa();

/// "scalar, v3": what this machine and build can run.
std::string available_isas();

/// Reads a scene and plans it; its warnings go to standard error. @throws SceneError
Plan plan_scene(const std::string& path);

/// For a run without a line of its own: SIGINT ends it.
SimulateOptions interruptible();

/// simulate() with a progress line; SIGINT ends it. @throws SimulationError, Interrupted
Record simulate_plan(const Plan& plan, SimulateOptions options);

/// Exactly kCount numbers with a separator between them, "1280x720"; nothing where the text is anything else.
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

/// "1280x720". @throws UsageError
FrameSize parse_size(const std::string& text);

/// "4x3": columns and rows of a contact sheet; @throws UsageError
FrameSize parse_sheet(const std::string& text);

/// Frames per second: the one asked for, else the scene's. @throws UsageError
double chosen_fps(std::optional<double> asked, const RenderSettings& settings);

/// Frames k with from + k / fps <= to; more than this program can number is a UsageError.
long checked_frame_count(double from, double to, double fps);

}  // namespace carom::tools
