// Owning pointers for objects of the C interface, and functions that create them and read values.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <string>

#include "carom/carom.h"

namespace carom::test {

using ScenePtr = std::unique_ptr<carom_scene, void (*)(carom_scene*)>;
using RecordPtr = std::unique_ptr<carom_record, void (*)(carom_record*)>;
using ValuePtr = std::unique_ptr<carom_value, void (*)(carom_value*)>;

/// The one falls into p3.
inline const char* const kPot =
    "[[ball]]\nid = \"cue\"\nposition = [0.60, 1.94]\n[[ball]]\nid = \"1\"\nposition = [0.30, 2.24]\n"
    "[cue]\nspeed = 2.25\naim_deg = 135\n";

inline ScenePtr parsed(const std::string& text) {
    carom_scene* scene = nullptr;
    EXPECT_EQ(carom_scene_parse(text.c_str(), "scene", &scene), CAROM_OK) << carom_last_error();
    return {scene, carom_scene_free};
}

inline ScenePtr shipped_scene(const std::string& name) {
    carom_scene* scene = nullptr;
    const std::string path = CAROM_SOURCE_DIR "/scenes/" + name + ".toml";
    EXPECT_EQ(carom_scene_read(path.c_str(), &scene), CAROM_OK) << carom_last_error();
    return {scene, carom_scene_free};
}

inline RecordPtr played(const carom_scene* scene, double until = -1.0) {
    carom_record* record = nullptr;
    EXPECT_EQ(carom_simulate(scene, until, &record), CAROM_OK) << carom_last_error();
    return {record, carom_record_free};
}

/// The value that a function of the C interface gives.
template <class Function, class... Arguments>
ValuePtr made(Function function, const Arguments&... arguments) {
    carom_value* value = nullptr;
    EXPECT_EQ(function(arguments..., &value), CAROM_OK) << carom_last_error();
    return {value, carom_value_free};
}

/// The message of a function that gives no value.
template <class Function, class... Arguments>
std::string refused(Function function, const Arguments&... arguments) {
    carom_value* value = nullptr;
    EXPECT_EQ(function(arguments..., &value), CAROM_BAD_ARGUMENT);
    EXPECT_EQ(value, nullptr);
    return carom_last_error();
}

inline double number(const ValuePtr& value, const char* path) {
    double found = -999.0;
    EXPECT_EQ(carom_value_number(value.get(), path, &found), CAROM_OK) << carom_last_error();
    return found;
}

inline std::string text(const ValuePtr& value, const char* path) {
    const char* found = "";
    EXPECT_EQ(carom_value_text(value.get(), path, &found), CAROM_OK) << carom_last_error();
    return found;
}

inline std::string json(const ValuePtr& value) {
    std::string text(carom_value_json(value.get(), nullptr, 0), '\0');
    carom_value_json(value.get(), text.data(), text.size() + 1);
    return text;
}

}  // namespace carom::test
