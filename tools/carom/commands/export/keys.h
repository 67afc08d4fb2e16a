// The motion of a ball as keys of an animation, in the axes of glTF:
// x to the right, y up, z towards the player (-y of the table).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "carom/engine/record.h"

namespace carom::tools {

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

}  // namespace carom::tools
