// Owning pointers for scenes and records of the C interface, and functions that create them.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "carom/carom.h"

namespace carom::test {

using ScenePtr = std::unique_ptr<carom_scene, void (*)(carom_scene*)>;
using RecordPtr = std::unique_ptr<carom_record, void (*)(carom_record*)>;

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

}  // namespace carom::test
