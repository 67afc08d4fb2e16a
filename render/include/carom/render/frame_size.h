// Size of an image in pixels.
#pragma once

namespace carom::render {

struct FrameSize {
    int width = 1280, height = 720;
    bool operator==(const FrameSize&) const = default;
};

}  // namespace carom::render
