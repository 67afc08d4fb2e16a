// The library that creates the OpenGL context. Both are loaded at run time.
#pragma once

#include <cstdint>
#include <string_view>

namespace carom::render {

enum class Backend : std::uint8_t {
    kAuto,    ///< default_backend(), chosen when it is needed
    kOsmesa,  ///< libOSMesa.so.8 (Debian package libosmesa6)
    kEgl,     ///< libEGL.so.1, surfaceless platform of Mesa (Debian packages libegl1 and libegl-mesa0)
};

/// OSMesa if the system has it, else EGL: the default of the library, the program and Python.
Backend default_backend();

/// "auto", "osmesa" or "egl"; @throws RenderError for another name
Backend backend_from_name(std::string_view name);
const char* name(Backend backend);

}  // namespace carom::render
