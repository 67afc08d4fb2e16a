// A binary glTF 2.0 file in memory (Khronos, "glTF 2.0 Specification"): one JSON part, one part of bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace carom::tools {

class Gltf {
  public:
    using Json = nlohmann::ordered_json;

    explicit Gltf(const std::string& generator);

    /// Appends an object to one of the file's lists ("nodes", "meshes", ...) and returns its index.
    std::size_t add(const char* list, Json object);

    /// Appends numbers as an accessor with minimum and maximum. `type`: "SCALAR", "VEC2", "VEC3", "VEC4";
    /// `target`: how a GPU uses them (34962: vertices), or 0. @returns its index
    std::size_t add_floats(const std::vector<float>& values, const char* type, int target = 0);
    std::size_t add_indices(const std::vector<std::uint32_t>& indices);
    /// Appends a PNG file as an image. @returns the index of a texture that shows it
    std::size_t add_png(const std::vector<std::uint8_t>& png);

    Json& json() { return json_; }

    /// The whole file.
    std::string bytes() const;

  private:
    std::size_t add_view(const void* data, std::size_t size, int target);

    Json json_;
    std::string binary_;
};

}  // namespace carom::tools
