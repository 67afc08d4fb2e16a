// The messages of the reader of scenes about a text.
#pragma once

#include <string>

#include "carom/engine/scene.h"

namespace carom::test {

/// The message of a scene that must fail, or "" if it does not; the file is called s.toml.
inline std::string error_of(const std::string& text) {
    try {
        parse_scene(text, "s.toml");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

}  // namespace carom::test
