// A shared library that is opened at run time and never closed:
// drivers register thread-exit handlers, so closing one is not safe.
#pragma once

#include <initializer_list>
#include <string>

namespace carom::render {

class SharedLibrary {
  public:
    /// Tries the names in order. @throws RenderError "cannot load NAME (reason); install the package PACKAGE"
    SharedLibrary(std::initializer_list<const char*> names, std::string package);

    /// A function of the library, which converts to the pointer type it is assigned to.
    struct Function {
        void* address;
        template <class F>
        operator F*() const {  // NOLINT: the conversion is what it is for
            return reinterpret_cast<F*>(address);
        }
    };
    /// @throws RenderError naming the function if it is missing
    Function operator[](const char* symbol) const;

  private:
    void* library_ = nullptr;
    std::string package_;
};

}  // namespace carom::render
