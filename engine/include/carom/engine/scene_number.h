// A number of a scene by its key: what a batch changes from shot to shot.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "carom/engine/field.h"
#include "carom/engine/scene.h"

namespace carom {

/// What the check of a scene has to look at after a change, from the least to the most.
enum class Change : std::uint8_t {
    kNumbers,   ///< of the cue, of velocities, of the balls' material and of the physics, within their ranges
    kPlaces,    ///< also where balls are
    kTable,     ///< also parts of the table, or the size of balls
    kAnything,  ///< a value out of its range, or more than numbers
};

/// A number of one scene and of all scenes with the same balls and the same parts of the table. The key is
/// written as in a scene file, with dots: cue.speed, cue.offset.side, balls.mu_b, physics.gravity, stop.time,
/// ball.cue.position.x, ball.1.velocity.y, table.pocket.p1.radius. An element of a list has a name (x, y, z;
/// side, height) or its number from 0.
class SceneNumber {
  public:
    /// @throws std::invalid_argument that says what is wrong with the key
    SceneNumber(const Scene& scene, std::string_view key);

    /// Sets the number, also to a value that is out of its range. balls.radius moves the centres of balls
    /// without a size of their own; everything else stays where it is.
    /// @return what has to be checked
    /// @throws SceneError where the value is of the wrong kind: a fraction for an integer
    Change put(Scene& scene, double value) const { return put_(scene, value); }

    /// The row of the key, for its range and whether it is an integer.
    const Key& row() const { return *row_; }

  private:
    const Key* row_ = nullptr;
    std::function<Change(Scene&, double)> put_;
};

/// validate() for a scene that was valid before this change of its numbers:
/// only the rules that the change can break. Takes no memory unless it throws.
/// @throws SceneError, not always the one that validate() would find first
void validate_change(const Scene& scene, Change change);

}  // namespace carom
