// Numbered PNG frames of a record, without a display.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/render/backend.h"
#include "carom/render/camera_path.h"
#include "carom/render/error.h"
#include "carom/engine/frame_size.h"
#include "carom/render/overlay.h"

namespace carom::render {

/// Receives one frame as packed RGB rows, top row first. Frames come in order, from one thread (not the caller's).
using RawSink = std::function<void(const std::uint8_t* rgb, std::size_t bytes)>;

struct SequenceOptions {
    /// Exactly one %d or %0Nd; empty: frames are encoded, thrown away
    std::string pattern = "frames/%05d.png";
    double fps = 60.0;
    double from = 0.0;          ///< s
    std::optional<double> to;   ///< s; default: the record's duration
    std::optional<long> frame;  ///< only this k
    FrameSize size;
    std::string camera = "top";  ///< top, rail, player or follow
    FreeCamera view;             ///< eye and target instead of a named camera; which ball to follow
    Overlay overlay;
    /// For the margin bar [ms]: what simulating frame k cost; default: 0. Added to it is what drawing,
    /// reading back and encoding took for the last frames of which it is known while frame k is drawn (one to
    /// a few before it).
    std::function<double(long k)> simulate_ms;
    /// Instead of all that: what the bar shows for frame k.
    std::function<double(long k)> frame_cost_ms;
    /// Per pixel of the table, drawn once per camera; a camera that moves takes at most 4
    int table_samples = 16;
    int png_level = 1;  ///< zlib level 0..9
    Backend backend = Backend::kOsmesa;
    /// Threads that encode and write. 1: no thread but the caller's, so that the timings do not disturb each
    /// other. 0: one per core, and 1 with an empty pattern, which is for measuring.
    int jobs = 0;
    bool resume = false;  ///< leave out frames whose finished file is there; it must be a PNG of this size
    RawSink raw;          ///< instead of PNG files; the pattern is not used
    std::function<void(long done, long total)> progress;  ///< on the calling thread; may throw to stop
    /// The same while the table is drawn, which comes before the first frame: passes of it.
    std::function<void(int done, int total)> table_progress;
};

/// What one frame cost. Frame k shows the time from + k / fps, computed from the integer k.
struct FrameTiming {
    long frame = 0;
    double time = 0.0;  ///< s of the shot
    double draw_ms = 0.0, readback_ms = 0.0, encode_ms = 0.0, write_ms = 0.0;
};

/// Time of frame k.
double frame_time(double from, long k, double fps);

/// Number of frames k with from + k / fps <= to; 0 when to < from.
/// @throws RenderError unless fps > 0 and both times are finite
long frame_count(double from, double to, double fps);

/// Renders and writes (temporary name, then renamed). Makes the folder of the pattern if its parent exists.
/// Frames that --resume leaves out have no timing. Memory does not grow with the number of frames.
/// @throws RenderError naming the file; frames finished before stay, nothing half-written does
std::vector<FrameTiming> render_sequence(const Record& record, const SequenceOptions& options);

/// The file of frame k; @throws RenderError for a pattern without exactly one integer conversion.
std::string frame_path(const std::string& pattern, long k);

/// A contact sheet: columns x rows pictures of the shot, evenly spread from `from` to `to` with both ends,
/// row by row, each with its clock. options.size is the size of the whole sheet; pattern, frame, jobs and raw
/// are not used.
/// @throws RenderError
void render_sheet(const Record& record, const SequenceOptions& options, int columns, int rows,
                  const std::string& path);

}  // namespace carom::render
