// Size of an image.
#pragma once

namespace carom {

/// [pixels] per side, 1 to kMaxImageSize
struct FrameSize {
    int width = 1280, height = 720;
    bool operator==(const FrameSize&) const = default;
};

}  // namespace carom
