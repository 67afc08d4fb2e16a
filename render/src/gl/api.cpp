#include "gl/api.h"

#include <string>

#include "carom/render/error.h"

namespace carom::render::gl {

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
