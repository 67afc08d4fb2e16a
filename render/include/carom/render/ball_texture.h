// The surface of a ball as a picture, for other programs.
#pragma once

#include "carom/render/draw_list.h"
#include "carom/render/image.h"

namespace carom::render {

/// The colours of a ball without light, as the renderer has them: twice as wide as high. Column and row are
/// the angles phi and theta of the direction (cos theta, sin theta cos phi, sin theta sin phi) in the ball's
/// own frame, phi from 0 to 2 pi, theta from 0 to pi. This keeps the numbers far from the poles.
Image ball_texture(const BallStyle& style, int width);

}  // namespace carom::render
