// Many scenes from one file: some values are replaced by random draws, shot by shot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/engine/scene_number.h"

namespace carom {

/// A rule that cannot be read (what() begins with it), or rules that give no valid scene.
class VariationError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// [-] The most shots of a sweep: the largest count that doubles, and programs that read numbers as doubles,
/// represent exactly.
inline constexpr std::uint64_t kMostShots = std::uint64_t{1} << 53;

/// The type of a column of values.
enum class ValueKind : std::uint8_t { kNumber, kWhole, kText };

/// A value of list(v,...).
struct ListedValue {
    std::string text;  ///< as written in tables
    double number = std::numeric_limits<double>::quiet_NaN();
    std::int64_t integer = 0;
};
/// A drawn value. The Variation owns listed values.
using DrawnValue = std::variant<double, std::int64_t, const ListedValue*>;
/// NaN for anything but a number.
double number_of(const DrawnValue& value);
/// 0 for anything but an integer.
std::int64_t integer_of(const DrawnValue& value);
/// As written in tables; numbers read back to the same bits.
std::string text_of(const DrawnValue& value);

struct VariedShot {
    std::vector<DrawnValue> values;  ///< one per key
    std::optional<Scene> scene;      ///< nothing if the values make no valid scene
    std::string error;               ///< why they make none
};

/// A scene file and the rules by which its values vary.
///
/// A rule is KEY=DISTRIBUTION. KEY is written as in the file, with dots: cue.speed, balls.mu_b, rack.seed. An
/// array element is named by its index from 0 or by its name (x, y, z; side, height): cue.offset.side. Balls
/// and parts of an outline are named by their ids: ball.cue.position.x, table.pocket.p1.radius.
///
///   uniform(a,b)                a <= x < b
///   normal(sd), normal(mean,sd) without a mean, around the number in the file
///   integer(a,b)                a, a + 1, ..., b, equally likely
///   list(v,...)                 TOML values, equally likely
///   grid(a,b,n)                 n values from a to b, evenly spaced, one after another
///   grid(list(v,...))           these values, one after another
///
/// Several grids form their product; the last grid varies fastest. After its last point it starts again.
///
/// Draws use SplitMix64, seeded by the seed, the shot's number and the text of the key, and no function of
/// the C library. So a shot is the same on every machine, whichever other keys vary and in any order of
/// shots.
class Variation {
  public:
    /// @throws SceneError for a bad file; VariationError for a bad rule, or if none of the first
    /// kVariationTrials shots is a valid scene
    Variation(const std::string& path, const std::vector<std::string>& rules, std::uint64_t seed);

    /// The same for a scene given as text; messages use `name` for the file.
    static Variation from_text(std::string_view text, const std::string& name,
                               const std::vector<std::string>& rules, std::uint64_t seed);

    const Scene& base() const;  ///< the file as it is
    const std::vector<std::string>& keys() const;
    /// The unit of rule `key`: "m/s", "degrees"; "" if it has none or is not a number of the scene.
    const std::string& unit(std::size_t key) const;

    /// Number of points of the product of all grids; 0 without a grid.
    std::uint64_t grid() const;

    /// The type of that rule's values; independent of the draws.
    ValueKind kind(std::size_t key) const;

    /// Shot 0, 1, ...; thread-safe. If its balls differ from those of the file (a rack of another size), the
    /// result is an error instead of a scene, because all shots share the columns of one table.
    VariedShot shot(std::uint64_t index) const;

    /// The values of shot(index) alone. @param values  one per key
    void draw(std::uint64_t index, std::span<DrawnValue> values) const;

    /// Writes drawn values into a scene that differs from base() only in these keys: a faster path to the
    /// scene of shot(). Allocates no memory unless the rack varies.
    /// @return the required checks; nothing if a key or value is not a number of the cue, the physics, the
    /// stop, the balls' material or state, or the rack's gap, jitter, seed or angle: then call shot()
    std::optional<Change> put(std::span<const DrawnValue> values, Scene& scene) const;

    /// Hash of the file's content, the rules and the seed: equal fingerprints mean equal shots.
    std::uint64_t fingerprint() const;

  private:
    struct Parts;
    Variation(const std::shared_ptr<Parts>& parts, const std::vector<std::string>& rules, std::uint64_t seed);
    std::shared_ptr<const Parts> parts_;
};

struct NewValue {
    std::string key, value;
};
/// A scene file with changed values: KEY as in a rule above, VALUE as in the file ("3.5", "[0.1, 0.2]",
/// "\"carom\"").
/// @return the new file, without comments; perhaps not a valid scene (parse_scene checks)
/// @throws SceneError for text that is not TOML, VariationError for an unreadable key or value
std::string with_values(std::string_view text, const std::string& name, const std::vector<NewValue>& values);

}  // namespace carom
