#include "gl/shared_library.h"

#include <dlfcn.h>

#include "carom/render/error.h"

namespace carom::render {

void* open_library(const char* const* names, int count, const std::string& package) {
    std::string reason;
    for (int i = 0; i < count; ++i) {
        if (void* library = dlopen(names[i], RTLD_NOW | RTLD_LOCAL)) return library;
        if (reason.empty()) reason = dlerror();
    }
    throw RenderError(std::string("cannot load ") + names[0] + " (" + reason +
                      "); install the Debian package " + package);
}

void* find_symbol(void* library, const char* symbol, const std::string& package) {
    if (void* address = dlsym(library, symbol)) return address;
    throw RenderError(std::string("the library of the Debian package ") + package + " has no " + symbol);
}

}  // namespace carom::render
