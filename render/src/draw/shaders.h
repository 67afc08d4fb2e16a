// The GLSL sources, shaders/*.vert and *.frag, which CMake embeds in the library (shaders/embed.cmake).
#pragma once

#include <string>

#include "gl/api.h"

namespace carom::render::shaders {

extern const char* const kTableVertex;
extern const char* const kTableFragment;

// Each of these lines, put before kTableFragment, selects one kind of surface. A software renderer executes
// both sides of every branch, so there is one program per kind. The floor has no discard, so hidden pixels
// cost nothing.
inline constexpr const char* kClothOnly = "#define CLOTH\n";
inline constexpr const char* kWoodOnly = "#define WOOD\n";
inline constexpr const char* kFloorOnly = "#define FLOOR\n";
inline constexpr const char* kWallOnly = "#define WALL\n";
inline constexpr const char* kChalkOnly = "#define CHALK\n";
inline constexpr const char* kShadeOnly = "#define SHADE\n";
inline constexpr const char* kTheRest = "#define REST\n";
/// Added to one of these for DrawList::less_detail.
inline constexpr const char* kLessDetail = "#define LESS_DETAIL\n";
/// Added to one of these if there may be a hole: pixels in a hole are not drawn.
inline constexpr const char* kHoles = "#define HOLES\n";

/// One stage of a program (gl::make_stage()): the source, preceded by the language version, the shared
/// numbers, `defines` (whole lines) and shaders/common.glsl. @throws RenderError with the compiler's log
GLuint make_stage(const gl::Api& api, GLenum stage, const char* source, const std::string& defines = "");

}  // namespace carom::render::shaders
