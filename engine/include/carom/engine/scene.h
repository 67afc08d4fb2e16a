// Scene: what a scene file says, validated, with every default written out.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/frame_size.h"
#include "carom/engine/table.h"

namespace carom {

/// A place in a scene file; line 0 stands for the file as a whole.
struct SourceLocation {
    int line = 0;
    int column = 0;
    bool operator==(const SourceLocation&) const = default;
};

/// Bad input. what() is "file:line:col: what is wrong and what to do".
class SceneError : public std::runtime_error {
  public:
    SceneError(const std::string& file, SourceLocation where, const std::string& message);

    /// "what is wrong and what to do", without the place.
    const std::string& message() const noexcept { return message_; }

  private:
    std::string message_;
};

// The structs below compare all that they hold, so that a test which compares a whole one cannot forget a
// field that is added later.

/// What may differ from ball to ball.
struct BallSize {
    double R;  ///< radius [m]
    double m;  ///< mass [kg]
    bool operator==(const BallSize&) const = default;
};

/// Properties shared by all balls of a scene (SI; frictions and restitutions are numbers).
struct BallParams {
    double R;      ///< radius [m]
    double m;      ///< mass [kg]
    double mu_s;   ///< sliding friction, ball on cloth
    double mu_r;   ///< rolling friction
    double mu_sp;  ///< spinning friction: w_z decays at 5 mu_sp g / (2 R)
    double mu_b;   ///< ball-ball friction
    double e_b;    ///< ball-ball restitution
    double e_c;    ///< cushion restitution
    double f_c;    ///< cushion friction
    /// Ball-ball friction that falls with the slip u [m/s]:
    /// mu_b + mu_b_more exp(-mu_b_fall u). 0: mu_b at every speed.
    double mu_b_more = 0.0;
    double mu_b_fall = 0.0;  ///< [s/m]
    BallSize size() const { return {R, m}; }
    bool ball_friction() const { return mu_b != 0.0 || mu_b_more != 0.0; }
    bool operator==(const BallParams&) const = default;
};

/// Friction between two balls whose surfaces slip by `slip` [m/s] at the contact. Source of the form: D.
/// Alciatore, Technical Proof A.14: a + b exp(-c u) with 9.951e-3, 0.108 and 1.088 s/m. An impact takes it
/// once, at the slip before it.
double ball_friction(const BallParams& balls, double slip);

/// A ball at the start.
struct BallStart {
    std::string id;
    Vec3 position;                               ///< centre [m], z = its radius
    Vec3 velocity = Vec3::Zero();                ///< [m/s], z = 0
    Vec3 spin = Vec3::Zero();                    ///< [rad/s]
    SourceLocation where;                        ///< where the file puts it ([rack] for a racked ball)
    std::optional<BallSize> own = std::nullopt;  ///< radius and mass of its own; nothing: those of all balls
    bool operator==(const BallStart&) const = default;
};

/// What strikes the ball. Its defaults are those of a scene file with an empty [cue], and of the C interface.
struct Cue {
    std::string ball = "cue";
    double speed = 9.0;     ///< of the cue [m/s]
    double aim_deg = 90.0;  ///< 0 = +x, 90 = +y
    double elevation_deg = 0.0;
    double side = 0.0, height = 0.1;  ///< offset in ball radii: left +, up +; a little above the centre
    double mass = 0.567;              ///< [kg]
    double end_mass = 0.00567;        ///< [kg], for squirt
    SourceLocation where;
    bool operator==(const Cue&) const = default;
};

enum class BallBallModel : std::uint8_t { kMathavan, kInelastic, kElastic };
enum class CushionModel : std::uint8_t { kSmooth, kHan2005, kMathavan2010, kImpulse, kStronge };
enum class ClusterModel : std::uint8_t { kCompliant, kSequential, kRigid };
enum class ClothSlipSign : std::uint8_t { kConsistent, kAsPublished };

struct Physics {
    double gravity = 9.81;  ///< [m/s^2]
    BallBallModel ball_ball = BallBallModel::kMathavan;
    CushionModel cushion = CushionModel::kHan2005;  ///< straight noses
    std::optional<CushionModel> jaw;                ///< round jaws; nothing: as the straight noses
    CushionModel jaw_model() const { return jaw.value_or(cushion); }
    ClothSlipSign cloth_slip = ClothSlipSign::kConsistent;
    ClusterModel clusters = ClusterModel::kCompliant;
    double tolerance = 1e-6;      ///< of the impact (mathavan), relative to the approach speed
    std::optional<int> substeps;  ///< set: the published march with N of them, instead of the tolerance
    bool operator==(const Physics&) const = default;
};

/// [effects]: one effect forced in or out of the plan (plan.h).
struct EffectOverride {
    std::string keyword;
    bool in_force;
    SourceLocation where;
    bool operator==(const EffectOverride&) const = default;
};

/// The keywords of [effects], in the order of Plan::effects.
inline constexpr const char* kEffectKeywords[] = {
    "sliding",  "rolling",          "spin_decay", "throw",  "cloth_in_impact",
    "cushions", "cushion_friction", "pockets",    "squirt", "clusters"};

struct Stop {
    std::optional<double> time;  ///< [s]
    std::optional<std::int64_t> events;
    bool operator==(const Stop&) const = default;
};

struct RenderSettings {
    double fps = 60.0;
    int width = FrameSize().width, height = FrameSize().height;
    std::string camera = "top";  ///< top, rail, player or follow; not used where eye and target are set
    std::optional<Vec3> eye = std::nullopt, target = std::nullopt;  ///< [m]; both or neither
    FrameSize size() const { return {width, height}; }
    bool operator==(const RenderSettings&) const = default;
};

struct Scene {
    std::string file;  ///< stands in messages; a scene built in code may call itself what it likes
    Table table;
    std::string ball_preset = "pool";
    BallParams balls{};
    std::vector<BallStart> ball;  ///< as written, then the racked ones
    std::optional<Cue> cue;       ///< nothing: no ball is struck
    Physics physics;
    std::vector<EffectOverride> effects;
    Stop stop;
    RenderSettings render;
    BallSize size_of(const BallStart& start) const { return start.own.value_or(balls.size()); }
    /// Whether all balls have one radius and mass.
    bool alike() const;
    bool operator==(const Scene&) const = default;
};

/// Reads and validates a scene file. @throws SceneError
Scene read_scene(const std::string& path);

/// The same from text; `name` stands for the file in messages.
Scene parse_scene(std::string_view text, const std::string& name);

/// A scene as a scene file, every value written out: parse_scene reads the same scene back (racked balls as
/// written ones; names that only people read, and depths of pockets, are left out).
std::string scene_text(const Scene& scene);

/// For a scene that was built in code: all that parse_scene checks. @throws SceneError without a line
void validate(const Scene& scene);

/// A preset by name. @throws std::invalid_argument for an unknown one
Table make_table(std::string_view preset);
BallParams make_ball_params(std::string_view preset);

const char* name(BallBallModel model);
const char* name(CushionModel model);
const char* name(ClusterModel model);
const char* name(ClothSlipSign sign);

}  // namespace carom
