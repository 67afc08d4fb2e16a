// Numbered PNG frames of a record, without a display.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/frame_size.h"
#include "carom/engine/record.h"
#include "carom/render/backend.h"
#include "carom/render/camera_path.h"
#include "carom/render/error.h"
#include "carom/render/overlay.h"

namespace carom::render {

/// Receives one frame without compression. Frames come in order, from one thread (not the caller's).
using RawSink = std::function<void(const std::uint8_t* bytes, std::size_t count)>;

/// The layout of a frame without compression.
enum class RawFormat : std::uint8_t {
    kRgb,  ///< packed rows, top row first
    kY4m,  ///< a frame of a Y4M stream, which begins with y4m_header(): 4:2:0, colours as in ITU-R BT.709
};

/// The first line of a Y4M stream. @throws RenderError for a frame rate that it cannot express to 9 digits
std::string y4m_header(FrameSize size, double fps);

struct SequenceOptions {
    /// Contains exactly one %d or %0Nd. Empty: frames are encoded, but not written
    std::string pattern = "frames/%05d.png";
    double fps = 60.0;
    double from = 0.0;          ///< s
    std::optional<double> to;   ///< s; default: the record's duration
    std::optional<long> frame;  ///< render only this frame k
    FrameSize size;
    std::string camera = "top";  ///< top, rail, player or follow
    FreeCamera view;             ///< eye and target that replace the named camera; id of the ball to follow
    Overlay overlay;
    /// For the margin bar: time that the simulation of frame k took [ms]; default: 0. The times of drawing,
    /// reading back and encoding are added, each from the latest frame for which it is known while frame k is
    /// drawn (one to a few frames earlier).
    std::function<double(long k)> simulate_ms;
    /// If set, the bar shows this time for frame k instead [ms].
    std::function<double(long k)> frame_cost_ms;
    /// Samples per pixel of the table, which is drawn once per camera, as in StageOptions; not used if the
    /// camera moves
    int table_samples = 16;
    /// Encode every frame as a whole with libpng. Default: only what changed is encoded (kept_png.h)
    bool libpng = false;
    Backend backend = Backend::kAuto;
    /// Number of threads that encode and write. 1: everything runs on the
    /// calling thread, so that the timings do not disturb each other. 0: one
    /// per core, or 1 with an empty pattern, which is used for measurements.
    int jobs = 0;
    RawSink raw;  ///< instead of PNG files; the pattern is not used
    RawFormat raw_format = RawFormat::kRgb;
    std::function<void(long done, long total)> progress;  ///< called on the calling thread; may throw to stop
    /// The same for the passes over the table, which is drawn before the first frame.
    std::function<void(int done, int total)> table_progress;
};

/// Computing times of one frame. Frame k shows the time from + k / fps, computed from the integer k.
struct FrameTiming {
    long frame = 0;
    double time = 0.0;  ///< s of the shot
    double draw_ms = 0.0, readback_ms = 0.0, encode_ms = 0.0, write_ms = 0.0;
    double encoded_share = 0.0;  ///< share of the picture that was encoded anew, 0..1
};

/// Time of frame k.
double frame_time(double from, long k, double fps);

/// Number of frames k with from + k / fps <= to; 0 when to < from.
/// @throws RenderError unless fps > 0 and both times are finite
long frame_count(double from, double to, double fps);

/// Renders and writes the frames (to a temporary name, then renamed). Creates the folder of the pattern if
/// its parent exists. Existing frames with these numbers are removed first; a single frame leaves the others
/// alone. Meanwhile another run with the same pattern is refused. Memory does not grow with the number of
/// frames.
/// @throws RenderError naming the file; finished frames stay, and no incomplete file is left
std::vector<FrameTiming> render_sequence(const Record& record, const SequenceOptions& options);

/// The file of frame k; a name without an integer conversion is the only frame's.
/// @throws RenderError for a pattern with another conversion, or with two
std::string frame_path(const std::string& pattern, long k);

/// Whether the pattern contains the number of a frame.
bool is_numbered(const std::string& pattern);

/// Whether a frame of this pattern would replace this file, also through a link.
/// @throws RenderError as frame_path()
bool writes_over(const std::string& pattern, const std::string& path);

/// Writes a contact sheet: columns x rows pictures of the shot, row by row, each with its clock. Their times
/// are evenly spaced from `from` to `to`, both included. The sheet is as wide as options.size, and each
/// picture has its shape; the height of the sheet follows. pattern, frame, jobs and raw are not used.
/// @throws RenderError
void render_sheet(const Record& record, const SequenceOptions& options, int columns, int rows,
                  const std::string& path);

}  // namespace carom::render
