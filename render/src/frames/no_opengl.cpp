// Stands in for OpenGL, libpng and the sequence of frames in a build without them.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "carom/render/backend.h"
#include "carom/render/png.h"
#include "carom/render/sequence.h"
#include "frames/png_pieces.h"

namespace carom::render {
namespace {

[[noreturn]] void refuse() {
    throw RenderError(
        "this build of carom has no OpenGL, so it draws no frames; use carom on Linux (packaging/), or make "
        "a page with carom view");
}

}  // namespace

Backend backend_from_name(std::string_view) {
    refuse();
}

std::string y4m_header(FrameSize, double) {
    refuse();
}

std::vector<FrameTiming> render_sequence(const Record&, const SequenceOptions&) {
    refuse();
}

bool writes_over(const std::string&, const std::string&) {
    refuse();
}

void render_sheet(const Record&, const SequenceOptions&, int, int, const std::string&) {
    refuse();
}

void encode_png(const Image& image, int, std::vector<std::uint8_t>& bytes) {
    PngPieces().encode(image, {{0, 0, image.size.width, image.size.height}}, bytes);
}

}  // namespace carom::render
