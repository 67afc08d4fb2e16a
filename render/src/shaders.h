// GLSL sources. One file per stage of a frame.
#pragma once

namespace carom::render::shaders {

extern const char* const kVersion;
extern const char* const kCommon;     ///< camera and lamp: put before every other source
extern const char* const kClothOnly;  ///< a line before kTableFragment that leaves its other materials out
extern const char* const kWoodOnly;
extern const char* const kFloorOnly;
extern const char* const kTheRest;
extern const char* const kTableVertex;
extern const char* const kTableFragment;
extern const char* const kFullscreenVertex;
extern const char* const kAddFragment;      ///< one jittered pass added to the sum
extern const char* const kDepthFragment;    ///< four depth buffers to distances along the view
extern const char* const kResolveFragment;  ///< sum to sRGB
/// Corners of the strip around a ball or a shadow.
inline constexpr int kRoundCorners = 8;
extern const char* const kPlain;  ///< a line before the next four: nothing but cloth is near, so do not look
extern const char* const kShadowVertex;
extern const char* const kShadowFragment;
extern const char* const kBallVertex;
extern const char* const kBallFragment;
extern const char* const kLineVertex;
extern const char* const kLineFragment;
extern const char* const kBoxVertex;
extern const char* const kBoxFragment;

}  // namespace carom::render::shaders
