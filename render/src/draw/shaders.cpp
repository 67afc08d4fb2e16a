#include "draw/shaders.h"

#include <array>

#include "gl/objects.h"

namespace carom::render::shaders {

extern const char* const kCommon;

namespace {
constexpr const char* kVersion = "#version 330 core\n";
}

GLuint make_program(const gl::Api& api, const char* vertex, const char* fragment, const char* defines) {
    const std::array<const char*, 3> prologue{kVersion, defines, kCommon};
    return gl::make_program(api, prologue, vertex, fragment);
}

}  // namespace carom::render::shaders
