// Draws the lines and boxes of a draw list.
#pragma once

#include "carom/render/draw_list.h"
#include "gl/api.h"

namespace carom::render {

class OverlayLayer {
  public:
    OverlayLayer(const gl::Api& api, GLuint glyphs);

    /// The lines of one layer.
    void draw_lines(const DrawList& list, GLuint occluders, LineLayer layer);
    void draw_boxes(const DrawList& list);

  private:
    const gl::Api& api_;
    GLuint glyphs_, line_program_, box_program_;
    GLuint line_array_ = 0, line_buffer_ = 0, box_array_ = 0, box_buffer_ = 0;
};

}  // namespace carom::render
