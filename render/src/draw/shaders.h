// The GLSL sources, shaders/*.vert and *.frag, which CMake embeds in the library (shaders/embed.cmake).
#pragma once

#include <initializer_list>
#include <string>

#include "gl/api.h"

namespace carom::render::shaders {

extern const char* const kTableVertex;
extern const char* const kTableFragment;

inline constexpr double kShadowReach = 2.5;  ///< [radii] where the shading of shadow.frag reaches zero
inline constexpr int kMaxHoles = 128;  ///< [-] largest number of holes that a program accepts: MAX_HOLES
inline constexpr int kMaxNear = 6;     ///< [-] neighbours that darken a ball: as many as fit around it

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

/// Compiles and links a program. Each source is preceded by the version of the language, the shared numbers, `defines`
/// (whole lines) and shaders/common.glsl. The first of `samplers` reads the texture of unit 0, and so on.
/// @throws RenderError with the compiler's log
GLuint make_program(const gl::Api& api, const char* vertex, const char* fragment,
                    std::initializer_list<const char*> samplers = {}, const std::string& defines = "");

}  // namespace carom::render::shaders
