// The table seen by one camera, as pixels in memory.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "carom/engine/frame_size.h"

namespace carom::render {

struct TablePicture {
    FrameSize size{0, 0};
    /// Four bytes per pixel. Alpha: the share of the pixel that is cloth or, with a moving camera, the mark
    /// of the face (table_edges.h).
    std::vector<std::uint8_t> rgba;
    /// Depth buffers, from 0 at the near clip plane to 1 at the far one: for four positions in the pixel or,
    /// with a moving camera, for one.
    std::array<std::vector<float>, 4> depths;
    int depth_count = 0;
};

}  // namespace carom::render
