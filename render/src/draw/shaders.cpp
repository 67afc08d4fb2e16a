#include "draw/shaders.h"

#include <fmt/core.h>

#include <array>

#include "gl/objects.h"

namespace carom::render::shaders {

extern const char* const kCommon;

namespace {
constexpr const char* kVersion = "#version 330 core\n";
}

GLuint make_program(const gl::Api& api, const char* vertex, const char* fragment,
                    std::initializer_list<const char*> samplers, const std::string& defines) {
    const std::string numbers = fmt::format("#define MAX_HOLES {}\n", kMaxHoles);
    const std::array<const char*, 4> prologue{kVersion, numbers.c_str(), defines.c_str(), kCommon};
    return gl::make_program(api, prologue, vertex, fragment, samplers);
}

}  // namespace carom::render::shaders
