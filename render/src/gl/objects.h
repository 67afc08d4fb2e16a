// Thin helpers over the loaded OpenGL functions. Objects die with their context unless deleted here.
#pragma once

#include <cstddef>
#include <span>

#include "gl/api.h"

namespace carom::render::gl {

/// Compiles and links; the sources of `prologue` stand before each of the two. The first of `samplers` reads the texture of
/// unit 0, and so on. @throws RenderError with the compiler's log
GLuint make_program(const Api& api, std::span<const char* const> prologue, const char* vertex,
                    const char* fragment, std::span<const char* const> samplers);

/// A texture without mipmaps, read texel by texel (or linearly), clamped at the edges.
GLuint make_texture(const Api& api, int width, int height, GLenum internal_format, GLenum format, GLenum type,
                    const void* texels, bool linear = false);

/// A framebuffer object of a colour texture and, if not 0, a depth texture. @throws RenderError
GLuint make_framebuffer(const Api& api, GLuint color, GLuint depth);

/// An offset into a buffer, as VertexAttribPointer takes it: OpenGL passes the number as a pointer.
inline const void* buffer_offset(std::size_t bytes) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the interface of OpenGL wants it so
    return reinterpret_cast<const void*>(bytes);
}

/// For the sampler of that number of every program.
void bind_texture(const Api& api, int unit, GLuint texture);

}  // namespace carom::render::gl
