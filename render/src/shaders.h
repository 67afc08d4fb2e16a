// GLSL sources. One file per stage of a frame.
#pragma once

namespace carom::render::shaders {

extern const char* const kCommon;  ///< version line, camera, lamp, noise: put before every other source
extern const char* const kTableVertex;
extern const char* const kTableFragment;
extern const char* const kFullscreenVertex;
extern const char* const kAddFragment;      ///< one jittered pass added to the sum
extern const char* const kDepthFragment;    ///< depth buffer to distance along the view
extern const char* const kResolveFragment;  ///< sum to sRGB
extern const char* const kShadowVertex;
extern const char* const kShadowFragment;
extern const char* const kBallVertex;
extern const char* const kBallFragment;

}  // namespace carom::render::shaders
