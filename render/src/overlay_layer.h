// Draws the lines and boxes of a draw list.
#pragma once

#include "gl_api.h"
#include "view.h"

namespace carom::render {

class OverlayLayer {
  public:
    OverlayLayer(const gl::Api& api, GLuint glyphs);

    /// Those over the balls, or those under them.
    void draw_lines(const DrawList& list, const View& view, GLuint occluders, bool over_balls);
    void draw_boxes(const DrawList& list, const View& view);

  private:
    const gl::Api& api_;
    GLuint glyphs_, line_program_, box_program_;
    GLuint line_array_ = 0, line_buffer_ = 0, box_array_ = 0, box_buffer_ = 0;
};

}  // namespace carom::render
