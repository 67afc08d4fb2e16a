// An OpenGL 3.3 core context without a window. The interface is small, so that any library can implement it.
// Includes no OpenGL header, because the headers of OSMesa and of the loader are incompatible.
#pragma once

#include <memory>

#include "carom/render/backend.h"

namespace carom::render::gl {

/// Finds an OpenGL function by its full name.
using Lookup = void* (*)(const char* name);

class Context {
  public:
    explicit Context(Lookup finder) : lookup_(finder) {}
    virtual ~Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes the context current on the calling thread. @throws RenderError
    virtual void make_current() = 0;

    /// The function that looks up the OpenGL functions of this context.
    Lookup lookup() const { return lookup_; }

  private:
    Lookup lookup_;
};

/// @throws RenderError naming the Debian package when the library is missing
std::unique_ptr<Context> make_osmesa_context();
std::unique_ptr<Context> make_egl_context();
std::unique_ptr<Context> make_context(Backend backend);
/// Whether the OSMesa library is installed and complete.
bool has_osmesa();

}  // namespace carom::render::gl
