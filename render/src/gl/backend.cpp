#include "carom/render/backend.h"

#include <memory>
#include <string>

#include "carom/render/error.h"
#include "gl/context.h"

namespace carom::render {

Backend default_backend() {
    static const Backend found = gl::has_osmesa() ? Backend::kOsmesa : Backend::kEgl;
    return found;
}

Backend backend_from_name(std::string_view text) {
    for (const Backend backend : {Backend::kAuto, Backend::kOsmesa, Backend::kEgl})
        if (text == name(backend)) return backend;
    throw RenderError("unknown OpenGL back end '" + std::string(text) + "'; use auto, osmesa or egl");
}

const char* name(Backend backend) {
    if (backend == Backend::kAuto) return "auto";
    return backend == Backend::kOsmesa ? "osmesa" : "egl";
}

std::unique_ptr<gl::Context> gl::make_context(Backend backend) {
    if (backend == Backend::kAuto) backend = default_backend();
    return backend == Backend::kOsmesa ? make_osmesa_context() : make_egl_context();
}

}  // namespace carom::render
