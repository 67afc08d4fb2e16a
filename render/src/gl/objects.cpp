#include "gl/objects.h"

#include <array>
#include <string>
#include <vector>

#include "carom/render/error.h"
#include "gl/api.h"

namespace carom::render::gl {

GLuint make_stage(const Api& api, GLenum stage, std::span<const char* const> sources) {
    const GLuint program =
        api.CreateShaderProgramv(stage, static_cast<GLsizei>(sources.size()), sources.data());
    GLint linked = 0;
    api.GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == 0) {
        // This also holds the compiler's log.
        std::string log(2048, '\0');
        GLsizei length = 0;
        api.GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), &length, log.data());
        log.resize(static_cast<std::size_t>(length));
        throw RenderError("the OpenGL driver rejects a shader of carom: " + log);
    }
    return program;
}

GLuint make_pipeline(const Api& api, GLuint vertex, GLuint fragment) {
    GLuint pipeline = 0;
    api.GenProgramPipelines(1, &pipeline);
    api.UseProgramStages(pipeline, GL_VERTEX_SHADER_BIT, vertex);
    api.UseProgramStages(pipeline, GL_FRAGMENT_SHADER_BIT, fragment);
    return pipeline;
}

GLuint make_texture(const Api& api, int width, int height, GLenum internal_format, GLenum format, GLenum type,
                    const void* texels, bool linear) {
    GLuint texture = 0;
    api.GenTextures(1, &texture);
    api.BindTexture(GL_TEXTURE_2D, texture);
    const GLint filter = linear ? GL_LINEAR : GL_NEAREST;
    api.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    api.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    api.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    api.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    api.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    api.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal_format), width, height, 0, format, type,
                   texels);
    return texture;
}

GLuint make_framebuffer(const Api& api, GLuint color, GLuint depth) {
    GLuint framebuffer = 0;
    api.GenFramebuffers(1, &framebuffer);
    api.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    api.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
    if (depth != 0) api.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    if (api.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw RenderError("the OpenGL driver refuses an image of this size; use a smaller --size");
    }
    return framebuffer;
}

void bind_texture(const Api& api, int unit, GLuint texture) {
    api.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    api.BindTexture(GL_TEXTURE_2D, texture);
}

Api load_api(Lookup lookup) {
    Api api;
#define CAROM_GL_LOAD(type, fn)                        \
    api.fn = reinterpret_cast<type>(lookup("gl" #fn)); \
    if (api.fn == nullptr) throw RenderError("the OpenGL driver lacks gl" #fn "; carom needs OpenGL 3.3");
    CAROM_GL_FUNCTIONS(CAROM_GL_LOAD)
#undef CAROM_GL_LOAD
    return api;
}

}  // namespace carom::render::gl
