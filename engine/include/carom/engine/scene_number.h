// A number of a scene, addressed by its key: the inputs that a batch changes from shot to shot.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "carom/engine/field.h"
#include "carom/engine/scene.h"

namespace carom {

/// The checks that a change of a scene requires, from fewest to most.
enum class Change : std::uint8_t {
    kNumbers,   ///< of the cue, velocities, ball material and physics, within their ranges
    kPlaces,    ///< also positions of balls
    kTable,     ///< also parts of the table, or ball sizes
    kAnything,  ///< a value outside its range, or more than numbers
};

/// Access to a number in one scene, and in all scenes with the same balls and table parts. The key is written
/// as in a scene file, with dots: cue.speed, cue.offset.side, balls.mu_b, physics.gravity, stop.time,
/// ball.cue.position.x, ball.1.velocity.y, table.pocket.p1.radius. A list element has a name (x, y, z; side,
/// height) or its index from 0.
class SceneNumber {
  public:
    /// @throws std::invalid_argument for a bad key, with the reason
    SceneNumber(const Scene& scene, std::string_view key);

    /// Sets the number, even to a value outside its range. balls.radius also moves the centres of balls
    /// without their own size, and nothing else.
    /// @return the checks that the change requires
    /// @throws SceneError if the value is of the wrong kind: a fraction for an integer
    Change put(Scene& scene, double value) const { return put_(scene, value); }

    /// The number in a scene; NaN if the scene does not set it, or if it is an integer.
    double value(Scene scene) const { return get_(scene); }

    /// The row of the key, for its range and kind.
    const Key& row() const { return *row_; }

  private:
    const Key* row_ = nullptr;
    std::function<Change(Scene&, double)> put_;
    std::function<double(Scene&)> get_;
};

/// Checks a key that a search, a fit or a sweep is to vary.
/// @throws std::invalid_argument for a bad key, and for one such as balls.e_c while balls.e_c_fit is in
/// force: varying it would replace the fit, and so change the shot. The message names the right key.
SceneNumber check_varies(const Scene& scene, std::string_view key);
/// The second of these checks: for keys that need not name numbers.
void check_replaces_no_fit(const Scene& scene, std::string_view key);

/// Validates a scene that was valid before this change of its numbers: checks only the rules that the change
/// can break. Allocates no memory unless it throws.
/// @throws SceneError, perhaps a different one than validate() would
void validate_change(const Scene& scene, Change change);

}  // namespace carom
