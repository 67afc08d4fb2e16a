// Draws the lines and boxes of a draw list.
#pragma once

#include <array>

#include "carom/render/draw_list.h"
#include "gl/api.h"

namespace carom::render {

class OverlayLayer {
  public:
    OverlayLayer(const gl::Api& api, GLuint glyphs);

    /// What may hide a line: StaticLayer::occluders(), and whether the table was drawn with one sample.
    struct Occluders {
        GLuint texture = 0;
        bool one_sample = false;
    };

    /// The lines of one layer.
    void draw_lines(const DrawList& list, Occluders occluders, LineLayer layer);
    void draw_boxes(const DrawList& list);

  private:
    const gl::Api& api_;
    GLuint glyphs_, box_program_;
    std::array<GLuint, 2> line_programs_;  ///< for a table with many samples, and with one
    GLuint line_array_ = 0, line_buffer_ = 0, box_array_ = 0, box_buffer_ = 0;
};

}  // namespace carom::render
