// The numbers that shaders share with the code that prepares their data.
#pragma once

namespace carom::render::shaders {

inline constexpr double kShadowReach = 2.0;  ///< [radii] where the shading by the room ends
inline constexpr int kMaxHoles = 128;  ///< [-] largest number of holes that a program accepts: MAX_HOLES
inline constexpr int kMaxNear = 6;     ///< [-] neighbours that darken a ball: as many as fit around it

}  // namespace carom::render::shaders
