// The GLSL sources, shaders/*.vert and *.frag, which CMake puts into the library (shaders/embed.cmake).
#pragma once

#include <initializer_list>
#include <string>

#include "gl/api.h"

namespace carom::render::shaders {

extern const char* const kTableVertex;
extern const char* const kTableFragment;
extern const char* const kFullscreenVertex;
extern const char* const kAddFragment;      ///< one jittered pass added to the sum
extern const char* const kDepthFragment;    ///< four depth buffers to distances along the view
extern const char* const kResolveFragment;  ///< sum to sRGB
extern const char* const kShadowVertex;
extern const char* const kShadowFragment;
extern const char* const kBallVertex;
extern const char* const kBallFragment;
extern const char* const kLineVertex;
extern const char* const kLineFragment;
extern const char* const kBoxVertex;
extern const char* const kBoxFragment;

/// Corners of the strip around a ball or a shadow.
inline constexpr int kRoundCorners = 8;

// Numbers that C++ and GLSL share: every program has them as #define SHADOW_REACH and MAX_HOLES.
inline constexpr double kShadowReach = 2.5;  ///< of a shadow's quad from below the ball [radii]
inline constexpr int kMaxHoles = 128;        ///< holes of the table that a program can be given

// Lines before kTableFragment that leave its other materials out. A software renderer runs both sides of every branch: so
// there is one program per kind of surface. The floor's has no discard, so that what the table hides of it costs nothing.
inline constexpr const char* kClothOnly = "#define CLOTH\n";
inline constexpr const char* kWoodOnly = "#define WOOD\n";
inline constexpr const char* kFloorOnly = "#define FLOOR\n";
inline constexpr const char* kTheRest = "#define REST\n";
/// A line before the sources of balls and shadows: nothing but cloth is near, so they do not look.
inline constexpr const char* kPlain = "#define PLAIN\n";

/// Compiles and links a program: the version of the language, the shared numbers, `defines` (whole lines), the camera and the
/// lamp (shaders/common.glsl), then each source. The first of `samplers` reads the texture of unit 0, and so on.
/// @throws RenderError with the compiler's log
GLuint make_program(const gl::Api& api, const char* vertex, const char* fragment,
                    std::initializer_list<const char*> samplers = {}, const std::string& defines = "");

}  // namespace carom::render::shaders
