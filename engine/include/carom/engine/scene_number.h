// A number of a scene, found by its key: what a batch changes from shot to shot.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "carom/engine/field.h"
#include "carom/engine/scene.h"

namespace carom {

/// The checks that a change of a scene needs, from the least to the most.
enum class Change : std::uint8_t {
    kNumbers,   ///< of the cue, of velocities, of the balls' material and of the physics, within their ranges
    kPlaces,    ///< also where balls are
    kTable,     ///< also parts of the table, or the size of balls
    kAnything,  ///< a value out of its range, or more than numbers
};

/// Access to a number in one scene, and in all scenes with the same balls and parts of the table. The key is
/// written as in a scene file, with dots: cue.speed, cue.offset.side, balls.mu_b, physics.gravity, stop.time,
/// ball.cue.position.x, ball.1.velocity.y, table.pocket.p1.radius. An element of a list has a name (x, y, z;
/// side, height) or its index from 0.
class SceneNumber {
  public:
    /// @throws std::invalid_argument for a bad key, with a message that says why
    SceneNumber(const Scene& scene, std::string_view key);

    /// Sets the number, even to a value outside its range. balls.radius moves the centres of balls without a
    /// size of their own; nothing else moves.
    /// @return what must be checked
    /// @throws SceneError if the value is of the wrong kind: a fraction for an integer
    Change put(Scene& scene, double value) const { return put_(scene, value); }

    /// The number in a scene; NaN if the scene does not set it, or if it is an integer.
    double value(Scene scene) const { return get_(scene); }

    /// The row of the key, for its range and whether it is an integer.
    const Key& row() const { return *row_; }

  private:
    const Key* row_ = nullptr;
    std::function<Change(Scene&, double)> put_;
    std::function<double(Scene&)> get_;
};

/// Checks a key whose number a search, a fit or a sweep varies.
/// @throws std::invalid_argument for a key of SceneNumber's, and for one such as balls.e_c while
/// balls.e_c_fit is in force: to vary it would replace the fit, and the shot would become another one. The
/// message names the key that works.
SceneNumber check_varies(const Scene& scene, std::string_view key);
/// The second part of that: for keys that may name other things than numbers, too.
void check_replaces_no_fit(const Scene& scene, std::string_view key);

/// Validates a scene that was valid before this change of its numbers: checks only the rules that the change
/// can break. Allocates no memory unless it throws.
/// @throws SceneError, perhaps another one than validate() would
void validate_change(const Scene& scene, Change change);

}  // namespace carom
