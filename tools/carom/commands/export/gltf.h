// A binary glTF 2.0 file in memory (Khronos, "glTF 2.0 Specification"): one JSON part, one part of bytes.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/record.h"
#include "carom/render/table_mesh.h"

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

// The motion of a ball as keys of an animation, in the axes of glTF:
// x to the right, y up, z towards the player (-y of the table).

/// (x, y, z) of the table in glTF axes.
inline std::array<float, 3> gltf_axes(const Vec3& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.z()), static_cast<float>(-p.y())};
}
/// The same rotation in glTF axes, as x, y, z, w.
inline std::array<float, 4> gltf_axes(const Eigen::Quaterniond& q) {
    return {static_cast<float>(q.x()), static_cast<float>(q.z()), static_cast<float>(-q.y()),
            static_cast<float>(q.w())};
}

struct PositionKey {
    float time = 0.0F;  ///< s, greater than the previous key's
    /// Position [m], and its rates [m/s] just before and just after.
    std::array<float, 3> before{}, place{}, after{};
};

/// Two keys bound each piece of motion; the cubic Hermite curve between them is exactly its parabola. Pieces
/// too short for a float are skipped. A position that jumps, as into a pocket, has a second key one float
/// later. A single key means that the ball never moves.
std::vector<PositionKey> position_keys(const Record& record, int ball);

/// The same for programs that join keys by straight lines: `fps` keys per second while the ball moves.
std::vector<PositionKey> sampled_position_keys(const Record& record, int ball, double fps);

struct RotationKey {
    float time = 0.0F;
    std::array<float, 4> q{};
};

/// Keys at the ends of every piece of motion, and enough between them that the ball turns by at most 0.4 rad
/// and a constant rate is off by at most 0.005.
std::vector<RotationKey> rotation_keys(const Record& record, int ball);

struct TablePart {
    std::vector<float> positions,
        normals;  ///< three numbers per vertex, in glTF axes, relative to the mesh's origin
    std::vector<std::uint32_t> indices;  ///< three per triangle
};

/// The solid parts except the floor, and the marks on the cloth. Pocket holes are cut out of cloth and wood,
/// which the renderer leaves to its shaders.
std::map<render::Material, TablePart> table_parts(const render::TableMesh& mesh);

struct GltfOptions {
    bool linear = false;  ///< join sampled positions by straight lines instead of cubics between events
    double fps = 120.0;   ///< of the samples
};

/// The bytes of a .glb file.
std::string shot_gltf(const Record& record, const GltfOptions& options);

}  // namespace carom::tools
