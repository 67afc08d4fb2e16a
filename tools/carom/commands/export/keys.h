// The motion of a ball as keys of an animation, in the axes of glTF:
// x to the right, y up, z towards the player (-y of the table).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "carom/engine/record.h"

namespace carom::tools {

/// (x, y, z) of the table in the axes of glTF.
inline std::array<float, 3> gltf_axes(const Vec3& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.z()), static_cast<float>(-p.y())};
}
/// x, y, z, w of the same rotation there.
inline std::array<float, 4> gltf_axes(const Eigen::Quaterniond& q) {
    return {static_cast<float>(q.x()), static_cast<float>(q.z()), static_cast<float>(-q.y()),
            static_cast<float>(q.w())};
}

struct PositionKey {
    float time = 0.0F;  ///< s, greater than that of the key before
    /// Place [m]; its rates [m/s] just before and just after.
    std::array<float, 3> before{}, place{}, after{};
};

/// Two keys bound each piece of motion, and a cubic Hermite curve between them is that
/// parabola. Pieces shorter than a float can tell are left out; a place that jumps, as
/// into a pocket, has a second key one float later. One key: the ball never moves.
std::vector<PositionKey> position_keys(const Record& record, int ball);

/// The same for programs that join keys by straight lines: `fps` keys a second while the ball moves.
std::vector<PositionKey> sampled_position_keys(const Record& record, int ball, double fps);

struct RotationKey {
    float time = 0.0F;
    std::array<float, 4> q{};
};

/// At the ends of every piece of motion, and so many between that the ball turns
/// by half a radian at most and a constant rate between two keys is off by 0.005.
std::vector<RotationKey> rotation_keys(const Record& record, int ball);

}  // namespace carom::tools
