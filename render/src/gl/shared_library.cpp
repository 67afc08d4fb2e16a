#include "gl/shared_library.h"

#include <dlfcn.h>

#include <utility>

#include "carom/render/error.h"

namespace carom::render {

SharedLibrary::SharedLibrary(std::initializer_list<const char*> names, std::string package)
    : package_(std::move(package)) {
    std::string reason;
    for (const char* name : names) {
        library_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (library_ != nullptr) return;
        if (reason.empty()) reason = dlerror();
    }
    throw RenderError(std::string("cannot load ") + *names.begin() + " (" + reason +
                      "); install the Debian package " + package_);
}

SharedLibrary::Function SharedLibrary::operator[](const char* symbol) const {
    if (void* address = dlsym(library_, symbol)) return {address};
    throw RenderError("the library of the Debian package " + package_ + " lacks " + symbol);
}

}  // namespace carom::render
