// Functions that create OpenGL objects. An object exists until it is deleted or its context is destroyed.
#pragma once

#include <cstddef>
#include <span>

#include "gl/api.h"

namespace carom::render::gl {

/// Compiles and links a program of one stage (GL_VERTEX_SHADER or GL_FRAGMENT_SHADER), which make_pipeline()
/// joins with one of the other stage. Several pipelines may share it, so that the driver translates it once.
/// @throws RenderError with the compiler's log
GLuint make_stage(const Api& api, GLenum stage, std::span<const char* const> sources);

/// Joins two stages. It takes effect when no program is in use.
GLuint make_pipeline(const Api& api, GLuint vertex, GLuint fragment);

/// A texture without mipmaps, with nearest (or linear) filtering, clamped at the edges.
GLuint make_texture(const Api& api, int width, int height, GLenum internal_format, GLenum format, GLenum type,
                    const void* texels, bool linear = false);

/// A framebuffer object with a colour texture and, if `depth` is not 0, a depth texture. @throws RenderError
GLuint make_framebuffer(const Api& api, GLuint color, GLuint depth);

/// An offset into a buffer for VertexAttribPointer: OpenGL passes the number as a pointer.
inline const void* buffer_offset(std::size_t bytes) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): required by the interface of OpenGL
    return reinterpret_cast<const void*>(bytes);
}

/// Binds the texture to a unit; the sampler with the same number reads it in every program.
void bind_texture(const Api& api, int unit, GLuint texture);

}  // namespace carom::render::gl
