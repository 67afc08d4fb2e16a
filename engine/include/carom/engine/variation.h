// Many scenes from one file: single values replaced by draws, shot by shot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/engine/scene_number.h"

namespace carom {

/// A rule that cannot be read; what() begins with it. Or rules that give no valid scene.
class VariationError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What a column of values holds.
enum class ValueKind : std::uint8_t { kNumber, kWhole, kText };

/// One shot: the values drawn, and the scene that they make.
struct VariedShot {
    std::vector<std::string> values;  ///< one per key; numbers read back to the same bits
    std::optional<Scene> scene;       ///< nothing where the values make no valid scene;
    std::string error;                ///< then why
};

/// A scene file and the rules by which its values vary.
///
/// A rule is KEY=DISTRIBUTION. KEY is written as in the file, with dots: cue.speed, balls.mu_b, rack.seed.
/// One element of an array is named by its number from 0 or by its name (x, y, z; side, height):
/// cue.offset.side. Balls go by their ids, parts of an outline by their names: ball.cue.position.x,
/// table.pocket.p1.radius.
///
///   uniform(a,b)                a <= x < b
///   normal(sd), normal(mean,sd) without a mean, around the number in the file
///   integer(a,b)                a, a + 1, ..., b, equally likely
///   list(v,...)                 TOML values, equally likely
///
/// Draws come from SplitMix64, seeded by the seed, the number of the shot and the text of the key, and use no
/// function of the C library: a shot is the same on every machine, whatever other keys vary and in whatever
/// order shots are asked for.
class Variation {
  public:
    /// @throws SceneError for a bad file, VariationError for a bad rule, and when none of the first shots
    /// makes a valid scene
    Variation(const std::string& path, const std::vector<std::string>& rules, std::uint64_t seed);

    /// The same of a scene given as text; `name` stands for the file in messages.
    static Variation from_text(std::string_view text, const std::string& name,
                               const std::vector<std::string>& rules, std::uint64_t seed);

    const Scene& base() const;  ///< the file as it is
    const std::vector<std::string>& keys() const;
    /// The unit of what the rule number `key` draws: "m/s",
    /// "degrees"; "" where it has none, or is no number of the scene.
    std::string unit(std::size_t key) const;

    /// What that rule draws: it goes by the rule and not by what happens to come.
    ValueKind kind(std::size_t key) const;

    /// Shot 0, 1, ...; any thread may ask. Where the balls are not those of the file (a rack of another
    /// size), there is no scene but an error: all shots share the columns of one table.
    VariedShot shot(std::uint64_t index) const;

    /// The quick way to the same shot: puts its numbers into a scene that differs from base() in nothing but
    /// the values of these keys. Takes no memory once `values` has its size, unless the rack varies.
    /// @param values  receives those of VariedShot
    /// @return what has to be checked; or nothing, and then shot() has to make this shot: a key or a value of
    /// it is no number of
    ///         the cue, the physics, the stop, the balls' material or their state, nor gap, jitter, seed or
    ///         angle of the rack
    std::optional<Change> put(std::uint64_t index, Scene& scene, std::vector<std::string>& values) const;

    /// Of the file's content, the rules and the seed: the same number, the same shots.
    std::uint64_t fingerprint() const;

  private:
    struct Parts;
    Variation(const std::shared_ptr<Parts>& parts, const std::vector<std::string>& rules, std::uint64_t seed);
    std::shared_ptr<const Parts> parts_;
};

/// A scene file with other values: KEY is written as in a rule above, and its VALUE as in the file ("3.5",
/// "[0.1, 0.2]", "\"carom\"").
/// @return the new file, without its comments; whether it is a valid scene is for parse_scene to say
/// @throws SceneError for text that is no TOML, VariationError for a key or a value that cannot be read
struct NewValue {
    std::string key, value;
};
std::string with_values(std::string_view text, const std::string& name, const std::vector<NewValue>& values);

}  // namespace carom
