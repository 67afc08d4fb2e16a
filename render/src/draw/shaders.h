// The GLSL sources, shaders/*.vert and *.frag, which CMake embeds in the library (shaders/embed.cmake).
#pragma once

#include <initializer_list>
#include <string>

#include "gl/api.h"

namespace carom::render::shaders {

extern const char* const kTableVertex;
extern const char* const kTableFragment;
extern const char* const kFullscreenVertex;
extern const char* const kAddFragment;      ///< adds one jittered pass to the sum
extern const char* const kDepthFragment;    ///< converts four depth buffers to distances along the view
extern const char* const kResolveFragment;  ///< converts the sum to sRGB
extern const char* const kShadowVertex;
extern const char* const kShadowFragment;
extern const char* const kBallVertex;
extern const char* const kBallFragment;
extern const char* const kLineVertex;
extern const char* const kLineFragment;
extern const char* const kBoxVertex;
extern const char* const kBoxFragment;

/// Number of corners of the triangle strip (an octagon) around a ball or a shadow.
inline constexpr int kRoundCorners = 8;

// Numbers that C++ and GLSL share: every program defines them as SHADOW_REACH, MAX_HOLES, MAX_NEAR.
inline constexpr double kShadowReach = 2.5;  ///< [radii] where the shading of shadow.frag reaches zero
inline constexpr int kMaxHoles = 128;        ///< [-] largest number of holes that a program accepts
inline constexpr int kMaxNear = 6;           ///< [-] neighbours that darken a ball: as many as fit around it

// Each of these lines, put before kTableFragment, selects one kind of surface. A software renderer executes both
// sides of every branch, so there is one program per kind. The floor has no discard, so hidden pixels cost nothing.
inline constexpr const char* kClothOnly = "#define CLOTH\n";
inline constexpr const char* kWoodOnly = "#define WOOD\n";
inline constexpr const char* kFloorOnly = "#define FLOOR\n";
inline constexpr const char* kChalkOnly = "#define CHALK\n";
inline constexpr const char* kShadeOnly = "#define SHADE\n";
inline constexpr const char* kTheRest = "#define REST\n";
/// Added to one of these where a hole may be: what lies in a hole is not drawn.
inline constexpr const char* kHoles = "#define HOLES\n";
/// Added to one of these, it writes screen values instead of radiance.
inline constexpr const char* kScreen = "#define SCREEN\n";
/// Put before the sources of balls and shadows over cloth alone: it omits the lookups in the textures of the table.
inline constexpr const char* kPlain = "#define PLAIN\n";
/// Put before the sources of shadows, it draws those on cushions and wood instead of those on the cloth.
inline constexpr const char* kBeside = "#define BESIDE\n";
/// Put before the sources of whatever the table can hide: the table was drawn with several samples, or with one.
inline constexpr const char* kManySamples = "";
inline constexpr const char* kOneSample = "#define ONE_SAMPLE\n";

/// Compiles and links a program. Each source is preceded by the version of the language, the shared numbers, `defines`
/// (whole lines) and shaders/common.glsl. The first of `samplers` reads the texture of unit 0, and so on.
/// @throws RenderError with the compiler's log
GLuint make_program(const gl::Api& api, const char* vertex, const char* fragment,
                    std::initializer_list<const char*> samplers = {}, const std::string& defines = "");

}  // namespace carom::render::shaders
