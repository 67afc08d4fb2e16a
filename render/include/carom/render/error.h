// The only exception that the renderer throws.
#pragma once

#include <stdexcept>

namespace carom::render {

/// The renderer cannot start, or a file cannot be written. what() names the missing package or the file.
class RenderError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace carom::render
