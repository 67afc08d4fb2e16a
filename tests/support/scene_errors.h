// The scene reader's error messages for a text.
#pragma once

#include <string>

#include "carom/engine/scene.h"

namespace carom::test {

/// The error message of a scene, or "" if it is valid; the file is called s.toml.
inline std::string error_of(const std::string& text) {
    try {
        parse_scene(text, "s.toml");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

}  // namespace carom::test
