// The costs of frames: the rows of `carom-lab bench render`.
#pragma once

#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/render/backend.h"

namespace carom::tools {

struct RenderBenchRow {
    std::string name;  ///< "720p", "1080p", "1080p follow", "2160p"
    /// Medians over the frames after the first, one frame at a time: CPU time of the whole process, including
    /// the driver's threads; write_ms is wall time.
    double draw_ms = 0.0, readback_ms = 0.0, encode_ms = 0.0, write_ms = 0.0;
    /// 95th percentile of draw plus readback: a frame in which most balls move
    double slow_ms = 0.0;
    /// Median share of the picture that is re-encoded, 0..1
    double encoded_share = 0.0;
    /// CPU time of a separate process from its first call to its first picture, without shaders cached by
    /// Mesa in an earlier process: the OpenGL library, the shaders, and the table once
    double setup_ms = 0.0;
    /// frames per second from the first to the last, written to files, with a thread per core
    double fps = 0.0;
    /// CPU time of the process per such frame, including the driver and the system
    double cpu_ms = 0.0;
};

/// Draws `frames` frames spread over the shot for every row; files go to a temporary folder. SIGINT ends it.
/// @throws RenderError
std::vector<RenderBenchRow> bench_render(const Record& record, int frames, render::Backend backend);

}  // namespace carom::tools
