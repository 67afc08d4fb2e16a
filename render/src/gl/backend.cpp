#include "carom/render/backend.h"

#include <memory>
#include <string>

#include "carom/render/error.h"
#include "gl/context.h"

namespace carom::render {

Backend backend_from_name(std::string_view text) {
    if (text == "osmesa") return Backend::kOsmesa;
    if (text == "egl") return Backend::kEgl;
    throw RenderError("unknown OpenGL back end '" + std::string(text) + "'; use osmesa or egl");
}

const char* name(Backend backend) {
    return backend == Backend::kOsmesa ? "osmesa" : "egl";
}

std::unique_ptr<gl::Context> gl::make_context(Backend backend) {
    return backend == Backend::kOsmesa ? make_osmesa_context() : make_egl_context();
}

}  // namespace carom::render
