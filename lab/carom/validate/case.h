// Validation cases: shots on real tables, their measured numbers, and claims about carom's results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/vec.h"

namespace carom::tools {

/// The measured quantity, of one ball or, for a share or a mean, of many shots.
enum class Quantity : std::uint8_t {
    kSpeed,
    kSpeedRatio,
    kVelocityX,
    kVelocityY,
    kDirection,
    kDeceleration,
    kPlace,
    kWay,
    kTime,
    kShare,
    kMean
};
struct QuantityInfo {
    const char* name;  ///< in case files
    const char* unit;
    const char* meaning;
};
inline constexpr QuantityInfo kQuantities[] = {
    {"speed", "m/s", "speed"},
    {"speed_ratio", "", "speed over that before the first impact"},
    {"velocity_x", "m/s", "velocity along x"},
    {"velocity_y", "m/s", "velocity along y"},
    {"direction", "deg", "direction, 0 is +x and 90 is +y"},
    {"deceleration", "m/s2", "deceleration"},
    {"place", "m", "distance from the measured place"},
    {"way", "m", "distance from the start"},
    {"time", "s", "time since the start"},
    {"share", "", "share of the shots"},
    {"mean", "", "mean over the shots"},
};
inline const QuantityInfo& info(Quantity quantity) {
    return kQuantities[static_cast<std::size_t>(quantity)];
}
inline bool is_of_many(Quantity quantity) {
    return quantity == Quantity::kShare || quantity == Quantity::kMean;
}

/// When it is measured.
enum class Instant : std::uint8_t { kStart, kHit, kCushion, kRolled, kRest };
/// Names in case files and reports: right after the ball's first impact with another ball, right after its
/// first impact with a cushion, when it rolls (again) after its first impact, and when everything is at rest.
inline constexpr const char* kInstants[] = {"start", "hit", "cushion", "rolled", "rest"};

/// How a number came about: only the first two count as measured.
inline constexpr const char* kKinds[] = {"measured", "published", "words"};

struct Measured {
    Quantity quantity = Quantity::kSpeed;
    Instant when = Instant::kStart;
    double after = 0.0;  ///< [s] after that instant
    std::string ball = "cue";
    double value = 0.0;  ///< in the unit of the quantity; 0 for a place
    /// in the same unit; uncertainty of the number, including unknowns of the shot
    double uncertainty = 0.0;
    Vec2 place = Vec2::Zero();
    std::string kind;   ///< of kKinds; by default, measured if the case is, and published if not
    std::string name;   ///< in reports; empty: the quantity
    std::string of;     ///< of many shots: a truth or a number of each (carom/games/measures.h)
    std::string among;  ///< the same: only shots for which this holds; empty: all
    std::string note;
};

/// One instance of the template: the values of its {name}s, and the measured numbers.
struct ValidationShot {
    std::string name;
    std::string group;  ///< shots joined by one curve
    std::vector<std::pair<std::string, std::string>> values;
    std::vector<Measured> measured;
};

/// The claim about a variant for one number. Empty: within the uncertainty; otherwise the value itself.
using Claim = std::optional<double>;

/// Preset and models with which all shots of a case are played.
struct Variant {
    std::string name;              ///< short, for tables and figures; default: the preset
    std::string preset;            ///< of the balls
    std::string keys;              ///< more lines of [balls]
    std::string physics;           ///< lines of [physics]
    bool free_of_fit = false;      ///< no parameter was fitted to these measurements or to their like
    std::vector<Claim> claims;     ///< one per number, in the order of the shots
    std::string own_keys() const;  ///< keys and physics on one line
    bool is_shipped() const { return own_keys().empty() && !preset.ends_with("_classic"); }
};

/// The model that a case is about, for the reports.
enum class About : std::uint8_t { kCushion, kBallBall, kClusters, kCloth, kCue };
inline constexpr const char* kAbout[] = {"cushion", "ball_ball", "clusters", "cloth", "cue"};

/// Reliability of the numbers.
inline constexpr const char* kTrust[] = {"measured", "published", "second hand", "forum"};

/// The figure of a case: the first number of each shot over one of the template's values, or over the shots.
/// Shots whose first quantity differs from the first shot's are omitted.
struct CasePlot {
    std::string x;        ///< a value of the template; empty: the shots side by side
    std::string over;     ///< a value by which the quantity is divided; empty: none
    std::string x_title;  ///< with the unit
    std::string y_title;
};

/// Seeded shots instead of one, for shares.
struct CaseSweep {
    int count = 0;
    std::uint64_t seed = 1;
    std::vector<std::string> vary;  ///< rules of a Variation
};

struct ValidationCase {
    std::string file, id, title, source, trust, note;
    About about = About::kCushion;
    std::string scene;  ///< the template
    std::optional<CaseSweep> sweep;
    std::optional<CasePlot> plot;
    std::vector<ValidationShot> shots;
    std::vector<Variant> variants;
};

/// A file of lab/data/validation, embedded in the program by the build, so that an installed program also has
/// it.
struct CaseFile {
    std::string_view name, text;
};
const std::vector<CaseFile>& case_files();

/// @throws SceneError naming the place in the file
ValidationCase read_case(const CaseFile& file);

/// The case with this id, or all if it is empty, in their order. @throws UsageError listing the cases
std::vector<ValidationCase> chosen_cases(const std::string& id);

/// A template with its {name}s replaced by the shot's values, and {preset}, {keys} and {physics} by the
/// variant's.
/// @throws SceneError for a name without a value
std::string filled_in(const ValidationCase& of, const ValidationShot& shot, const Variant& variant,
                      const std::string& text);

}  // namespace carom::tools
