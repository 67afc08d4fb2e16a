// Numbered PNG frames of a record, without a display.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/render/backend.h"
#include "carom/render/error.h"
#include "carom/render/frame_size.h"

namespace carom::render {

struct SequenceOptions {
    std::string pattern =
        "frames/%05d.png";  ///< exactly one %d or %0Nd; empty: frames are encoded and thrown away
    double fps = 60.0;
    double from = 0.0;          ///< s
    std::optional<double> to;   ///< s; default: the record's duration
    std::optional<long> frame;  ///< only this k
    FrameSize size;
    std::string camera = "top";
    int table_samples = 16;  ///< per pixel of the table, which is drawn once per camera
    int png_level = 1;       ///< zlib level 0..9
    Backend backend = Backend::kOsmesa;
    std::function<void(long done, long total)> progress;  ///< called after every frame
};

/// What one frame cost. Frame k shows the time from + k / fps, computed from the integer k.
struct FrameTiming {
    long frame = 0;
    double time = 0.0;  ///< s of the shot
    double draw_ms = 0.0, readback_ms = 0.0, encode_ms = 0.0, write_ms = 0.0;
};

/// Time of frame k.
double frame_time(double from, long k, double fps);

/// Number of frames k with from + k / fps <= to; 0 when to < from. @throws RenderError unless fps > 0 and
/// both times are finite
long frame_count(double from, double to, double fps);

/// Renders and writes (temporary name, then renamed). Makes the folder of the pattern if its parent exists.
/// @throws RenderError
std::vector<FrameTiming> render_sequence(const Record& record, const SequenceOptions& options);

/// The file of frame k; @throws RenderError for a pattern without exactly one integer conversion.
std::string frame_path(const std::string& pattern, long k);

}  // namespace carom::render
