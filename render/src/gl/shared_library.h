// A shared library that is opened at run time and never closed: drivers register thread-exit handlers, so closing
// one is not safe.
#pragma once

#include <string>

namespace carom::render {

/// Tries the names in order. @throws RenderError "cannot load NAME (reason); install the package PACKAGE"
void* open_library(const char* const* names, int count, const std::string& package);

/// A function of an opened library. @throws RenderError that names the function if it is missing
void* find_symbol(void* library, const char* symbol, const std::string& package);

}  // namespace carom::render
