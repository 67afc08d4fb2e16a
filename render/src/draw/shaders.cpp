#include "draw/shaders.h"

#include <fmt/core.h>

#include <array>

#include "draw/shader_numbers.h"
#include "gl/objects.h"

namespace carom::render::shaders {

extern const char* const kCommon;

namespace {
// A browser's GLSL has neither locations of varyings nor gl_PerVertex, so the sources write LOCATION(n).
constexpr const char* kVersion =
    "#version 330 core\n#extension GL_ARB_separate_shader_objects : require\n"
    "#define LOCATION(n) layout(location = n)\n";
}  // namespace

GLuint make_stage(const gl::Api& api, GLenum stage, const char* source, const std::string& defines) {
    const std::string numbers = fmt::format("#define MAX_HOLES {}\n", kMaxHoles);
    const std::array<const char*, 5> sources{kVersion, numbers.c_str(), defines.c_str(), kCommon, source};
    return gl::make_stage(api, stage, sources);
}

}  // namespace carom::render::shaders
