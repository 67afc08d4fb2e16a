// The one error that the renderer throws.
#pragma once

#include <stdexcept>

namespace carom::render {

/// A renderer that cannot start, or a file that cannot be written. what() names the package or the file.
class RenderError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace carom::render
