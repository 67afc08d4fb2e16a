// Scene: the content of a scene file, validated, with all defaults filled in.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "carom/engine/field.h"
#include "carom/engine/frame_size.h"
#include "carom/engine/table.h"
#include "carom/engine/tolerances.h"
#include "carom/kernel/impact.h"
#include "carom/kernel/tolerance.h"

namespace carom {

/// A position in a scene file; line 0 means the whole file.
struct SourceLocation {
    int line = 0;
    int column = 0;
    // NOLINTNEXTLINE(modernize-use-nullptr): an ordering is compared with 0, which is no pointer
    auto operator<=>(const SourceLocation&) const = default;
};

/// Bad input. what() is "file:line:col: what is wrong and what to do".
class SceneError : public std::runtime_error {
  public:
    SceneError(const std::string& file, SourceLocation where, const std::string& message);

    /// "what is wrong and what to do", without the position.
    const std::string& message() const noexcept { return message_; }
    const std::string& file() const noexcept { return file_; }
    SourceLocation where() const noexcept { return where_; }

  private:
    std::string file_, message_;
    SourceLocation where_;
};

// The structs below compare all their members, so that no test can miss a new one.

inline constexpr Interval kBallRadius = at_least(kMinLength, kMaxLength, "m");
inline constexpr Interval kMass = at_least(kMinMass, kMaxMass, "kg");
inline constexpr Interval kFriction = at_least(0.0, kMaxFriction);
inline constexpr Interval kRestitution = at_least(0.0, 1.0);

/// The properties that may differ from ball to ball.
struct BallSize {
    double R;  ///< radius [m]
    double m;  ///< mass [kg]
    bool operator==(const BallSize&) const = default;
};
inline constexpr Field<BallSize> kSizeFields[] = {
    field<&BallSize::R>("radius", kBallRadius, "of this ball", {.standard = "as `[balls]`"}),
    field<&BallSize::m>("mass", kMass, "of this ball", {.standard = "as `[balls]`"}),
};

/// A coefficient that falls with a speed u [m/s]: at_rest + more exp(-fall u); constant if `more` is 0.
struct Falling {
    double at_rest, more = 0.0, fall = 0.0;  // fall [s/m]
    double operator()(double u) const;
    bool constant() const { return more == 0.0; }
    bool any() const { return at_rest != 0.0 || more != 0.0; }
    double most() const { return at_rest + more; }
};

/// Properties shared by all balls of a scene (SI; frictions and restitutions are numbers).
struct BallParams {
    double R, m;
    double mu_s;
    double mu_r;
    double mu_sp;  ///< w_z decays at 5 mu_sp g / (2 R)
    double mu_b;
    double e_b;
    double e_c;
    double f_c;
    /// Ball-ball friction that falls with the slip u [m/s]: mu_b + mu_b_more exp(-mu_b_fall u).
    double mu_b_more = 0.0;
    double mu_b_fall = 0.0;  ///< [s/m]
    /// Cushion friction that falls with the slip u [m/s] at the nose: f_c + f_c_more exp(-f_c_fall u).
    double f_c_more = 0.0;
    double f_c_fall = 0.0;  ///< [s/m]
    /// Cushion restitution that falls with the speed v_n [m/s] towards the cushion: above e_c_above it
    /// decreases by e_c_fall per m/s, down to 0.
    double e_c_fall = 0.0;   ///< [s/m]
    double e_c_above = 0.0;  ///< [m/s]
    /// Restitution between ball and cloth, which may fall with the speed V [m/s]: e_t + e_t_more
    /// exp(-e_t_fall V). Source of 0.5: D. Alciatore, "Physical properties".
    double e_t = 0.5, e_t_more = 0.0;
    double e_t_fall = 0.0;  ///< [s/m]
    /// Share of the downward speed after a cushion that throws the ball up again. 0: the published planar
    /// cushions.
    double e_h = 0.0;
    bool disc = false;    ///< two touch at R1 + R2, level with the cloth, unlike balls
    bool slides = false;  ///< pucks: they never roll
    bool discs() const { return disc; }
    bool rolls() const { return !slides; }
    BallSize size() const { return {R, m}; }
    /// Between two balls, as a function of the slip at the contact. Source of the form: D. Alciatore,
    /// Technical Proof A.14: a + b exp(-c u) with 9.951e-3, 0.108 and 1.088 s/m. An impact uses the slip
    /// before it; in a compliant cluster, every contact uses its current slip.
    Falling ball_friction() const { return {mu_b, mu_b_more, mu_b_fall}; }
    /// At a cushion, as a function of the slip at the nose.
    Falling cushion_friction() const { return {f_c, f_c_more, f_c_fall}; }
    /// Between ball and cloth, as a function of the speed towards the cloth.
    Falling cloth_restitution() const { return {e_t, e_t_more, e_t_fall}; }
    bool operator==(const BallParams&) const = default;
};
inline constexpr const char* kBallShapes[] = {"ball", "disc"};
inline constexpr const char* kTrueOrFalse[] = {"true", "false"};
inline constexpr Field<BallParams> kBallFields[] = {
    field<&BallParams::R>("radius", kBallRadius, "radius", {.record_key = "R"}),
    field<&BallParams::m>("mass", kMass, "mass", {.record_key = "m"}),
    field<&BallParams::mu_s>("mu_s", kFriction, "sliding friction on the cloth"),
    field<&BallParams::mu_r>("mu_r", kFriction, "rolling friction"),
    field<&BallParams::mu_sp>("mu_sp", kFriction, "spinning friction"),
    // Records have separate rows for the other two numbers of a fit.
    number_or_fit<&BallParams::mu_b, &BallParams::mu_b_more, &BallParams::mu_b_fall>(
        "mu_b", kFriction, "ball-ball friction, at any slip; replaces the fit of a preset"),
    field<&BallParams::mu_b_more>(
        "mu_b_more", kFriction,
        "at a slip of u m/s the ball-ball friction is `mu_b` + `mu_b_more` exp(-`mu_b_fall` u)",
        {.files = Files::kRecord}),
    field<&BallParams::mu_b_fall>("mu_b_fall", at_least(0.0, kMaxFriction, "s/m"), "see `mu_b_more`",
                                  {.files = Files::kRecord}),
    fit<&BallParams::mu_b, &BallParams::mu_b_more, &BallParams::mu_b_fall>(
        "mu_b_fit", kFriction,
        "ball-ball friction a + b exp(-c u) at the slip u in m/s (for two balls, the slip before the "
        "impact); `[0.009951, 0.108, 1.088]` is the fit of Alciatore's TP A.14",
        "[a, b, c] for a + b exp(-c u)", "mu_b"),
    field<&BallParams::e_b>("e_b", kRestitution, "ball-ball restitution"),
    number_or_fit<&BallParams::e_c, &BallParams::e_c_fall, &BallParams::e_c_above>(
        "e_c", kRestitution, "cushion restitution, at any speed"),
    field<&BallParams::e_c_fall>(
        "e_c_fall", at_least(0.0, kMaxFriction, "s/m"),
        "above a speed of `e_c_above` towards the cushion the restitution is `e_c` - "
        "`e_c_fall` (speed - `e_c_above`), and not below 0",
        {.files = Files::kRecord}),
    field<&BallParams::e_c_above>("e_c_above", at_least(0.0, kMaxSpeed, "m/s"), "see `e_c_fall`",
                                  {.files = Files::kRecord}),
    fit<&BallParams::e_c, &BallParams::e_c_fall, &BallParams::e_c_above>(
        "e_c_fit", kFriction,
        "cushion restitution that falls with the speed v in m/s towards the cushion: e up to v0, e - c (v - "
        "v0) "
        "above, and not below 0; `[1, 0.08, 1.7]` with `mathavan_2010` reproduces the snooker cushion "
        "measured in 2009",
        "[e, c, v0] for e - c max(0, v - v0)", "e_c"),
    number_or_fit<&BallParams::f_c, &BallParams::f_c_more, &BallParams::f_c_fall>(
        "f_c", kFriction, "cushion friction, at any slip"),
    field<&BallParams::f_c_more>(
        "f_c_more", kFriction,
        "at a slip of u m/s at the nose the cushion friction is `f_c` + `f_c_more` exp(-`f_c_fall` u)",
        {.files = Files::kRecord}),
    field<&BallParams::f_c_fall>("f_c_fall", at_least(0.0, kMaxFriction, "s/m"), "see `f_c_more`",
                                 {.files = Files::kRecord}),
    fit<&BallParams::f_c, &BallParams::f_c_more, &BallParams::f_c_fall>(
        "f_c_fit", kFriction,
        "cushion friction a + b exp(-c u) at the slip u in m/s at the nose before the impact",
        "[a, b, c] for a + b exp(-c u)", "f_c"),
    number_or_fit<&BallParams::e_t, &BallParams::e_t_more, &BallParams::e_t_fall>(
        "e_t", kRestitution, "restitution of ball and cloth, at any speed", {.later = true}),
    field<&BallParams::e_t_more>(
        "e_t_more", kRestitution,
        "at a speed of V m/s towards the cloth its restitution is `e_t` + `e_t_more` exp(-`e_t_fall` V)",
        {.files = Files::kRecord, .later = true}),
    field<&BallParams::e_t_fall>("e_t_fall", at_least(0.0, kMaxFriction, "s/m"), "see `e_t_more`",
                                 {.files = Files::kRecord, .later = true}),
    fit<&BallParams::e_t, &BallParams::e_t_more, &BallParams::e_t_fall>(
        "e_t_fit", kFriction,
        "restitution of ball and cloth a + b exp(-c V) at the speed V in m/s towards the cloth",
        "[a, b, c] for a + b exp(-c V)", "e_t"),
    field<&BallParams::e_h>("e_h", kRestitution,
                            "fraction of the downward speed after a cushion that becomes upward speed (a "
                            "hop); about 0.2 on a real table",
                            {.later = true}),
    either<&BallParams::disc, kBallShapes>(
        "shape", "two discs touch at the sum of their radii, two balls of different size slightly nearer"),
    either<&BallParams::slides, kTrueOrFalse>(
        "rolls", "`false`: pucks, which slide until `mu_s` stops them, and never turn"),
};

struct BallStart {
    std::string id = "cue";
    Vec3 position = {0.635, 0.5, 0.0};           ///< centre [m], z = its radius + its height
    Vec3 velocity = Vec3::Zero();                ///< [m/s]
    Vec3 spin = Vec3::Zero();                    ///< [rad/s]
    double height = 0.0;                         ///< [m] between the ball and the cloth
    SourceLocation where;                        ///< its line in the file (of [rack] for a racked ball)
    std::optional<BallSize> own = std::nullopt;  ///< own radius and mass; nothing: as in [balls]
    /// Whether it starts in the air.
    bool flies() const { return height > 0.0 || velocity.z() != 0.0; }
    bool operator==(const BallStart&) const = default;
};
inline constexpr Field<BallStart> kBallStartFields[] = {
    field<&BallStart::id>("id", at_least(1.0, kMaxIdLength, "bytes"),
                          "unique; no commas, quotes or control characters"),
    field<&BallStart::position>("position", kCoordinate, "of the centre", {.shape = "[x, y]"}),
    field<&BallStart::height>("height", at_least(0.0, kMaxLength, "m"),
                              "of its lowest point above the cloth, to start in the air"),
    field<&BallStart::velocity>("velocity", at_least(-kMaxSpeed, kMaxSpeed, "m/s"),
                                "to start moving without a cue; vz, upward, may be left out",
                                {.shape = "[vx, vy, vz]", .last_may_lack = true}),
    field<&BallStart::spin>("spin", at_least(-kMaxSpin, kMaxSpin, "rad/s"), "angular velocity at the start",
                            {.shape = "[wx, wy, wz]"}),
};

enum class RackGame : std::uint8_t {
    kEightBall,
    kNineBall,
    kTenBall,
    kSnooker,
    kThreeCushion,
    kTriangle,
    kLine,
    kScatter,
    kPyramid,
    kFourBall
};
constexpr auto names_of(RackGame) {
    return std::array{"eight_ball", "nine_ball", "ten_ball", "snooker", "three_cushion",
                      "triangle",   "line",      "scatter",  "pyramid", "four_ball"};
}

/// How balls are racked: with gap and jitter; pressed together; or in a wooden triangle, which leaves every
/// contact open.
enum class RackMethod : std::uint8_t { kGap, kTemplate, kTriangle };
constexpr auto names_of(RackMethod) {
    return std::array{"gap", "template", "triangle"};
}

/// Balls that a scene does not place one by one.
struct Rack {
    RackGame game = RackGame::kEightBall;
    RackMethod method = RackMethod::kGap;
    double gap = 1e-4;
    double jitter = 0.0;  ///< each coordinate moves by a uniform draw from [-jitter, jitter] [m]
    std::uint64_t seed = 1;
    int count = 5;
    int rows = 5;
    double angle_deg = 0.0;                       ///< counter-clockwise; 0: rows towards +y
    double radius_sd = 0.0;                       ///< [m] of the balls' radii, from [balls]
    std::optional<int> spot_ball = std::nullopt;  ///< the ball at the position; nothing: the apex
    std::optional<Vec2> position = std::nullopt;  ///< nothing: the foot spot
};
inline constexpr Field<Rack> kRackFields[] = {
    field<&Rack::game>("game", "arrangement of the balls"),
    field<&Rack::method>("method", "spaced by `gap` and `jitter`, pressed together, or in a wooden triangle"),
    field<&Rack::gap>("gap", at_least(0.0, kMaxLength, "m"), "between neighbours, 0 = touching"),
    field<&Rack::jitter>("jitter", at_least(0.0, kMaxJitter, "m"),
                         "every ball moves by up to this much in x and in y"),
    field<&Rack::seed>("seed", at_least(0.0, kAnyInteger), "of the random numbers"),
    field<&Rack::count>("count", at_least(1.0, kMaxBalls), "balls of a `line` or a `scatter`"),
    field<&Rack::rows>("rows", at_least(1.0, kMaxRackRows), "rows of a `triangle`"),
    field<&Rack::position>("position", kCoordinate, "position of the rack",
                           {.shape = "[x, y]", .standard = "the foot spot"}),
    field<&Rack::spot_ball>(
        "spot_ball", at_least(1.0, kMaxBalls),
        "number of the ball at that position: 9 in a nine-ball rack with the 9 on the spot",
        {.standard = "the apex"}),
    field<&Rack::angle_deg>("angle_deg", at_least(-kMaxAngle, kMaxAngle, "degrees"),
                            "rotation of the rack about that ball; 0: rows towards +y"),
};
/// Positions of a rack without jitter, row by row from left to right. @param R  ball radius [m]
std::vector<Vec2> rack_slots(const Rack& rack, const Vec2& apex, double R);

/// A key of [balls] that affects only a rack.
inline constexpr Field<Rack> kRackedBallFields[] = {
    field<&Rack::radius_sd>("radius_sd", at_least(0.0, kMaxRadiusSd, "m"),
                            "standard deviation of the radii of racked balls, at most a 200th of the radius; "
                            "masses scale with its cube"),
};

/// The cue's stroke. The defaults are those of an empty [cue] and of the C interface.
struct Cue {
    std::string preset = "low_deflection";
    std::string ball = "cue";
    double speed = 9.0;
    double aim_deg = 90.0;
    double elevation_deg = 0.0;
    double side = 0.0, height = 0.1;  ///< offset in ball radii: left +, up +; a little above the centre
    double mass = 0.567;
    double end_mass = 0.00567;
    double restitution = 0.73;
    SourceLocation where;
    bool operator==(const Cue&) const = default;
};
inline constexpr const char* kCuePresets[] = {"low_deflection", "plain", "break", "lossless"};

/// Gives a cue the mass, end mass and tip of a preset. @throws std::invalid_argument for an unknown one
void use_cue(Cue& cue, std::string_view preset);

inline constexpr Field<Cue> kCueFields[] = {
    {field<&Cue::preset>("preset", "kind of cue: its `mass`, `end_mass` and `restitution`",
                         {.names = kCuePresets}),
     [](const Cue& cue) -> FieldValue { return cue.preset; },
     [](Cue& cue, const FieldValue& value) { use_cue(cue, std::get<std::string>(value)); }},
    field<&Cue::ball>("ball", "id of the ball that is struck"),
    field<&Cue::speed>("speed", at_least(0.0, kMaxSpeed, "m/s"), "of the cue"),
    field<&Cue::aim_deg>("aim_deg", at_least(-kMaxAngle, kMaxAngle, "degrees"), "0 is +x, 90 is +y"),
    field<&Cue::elevation_deg>(
        "elevation_deg", {0.0, false, 90.0, true, "degrees"},
        "of the butt; above 0 it lifts the ball; `\"auto\"`: the least that clears rails and balls"),
    field<&Cue::side, &Cue::height>(
        "offset", at_least(-1.0, 1.0, "ball radii"),
        "left and up positive, together at most 0.5: farther out the tip slips off",
        {.shape = "[side, height]"}),
    field<&Cue::mass>("mass", kMass, "of the cue"),
    field<&Cue::end_mass>("end_mass", at_least(0.0, kMaxMass, "kg"),
                          "of its end, for squirt; 0 for none, at most `mass`"),
    field<&Cue::restitution>("restitution", kRestitution, "of the tip; 1 loses nothing"),
};

namespace kernel {
constexpr auto names_of(ClothSlip) {
    return std::array{"consistent", "as_published"};
}
}  // namespace kernel
/// Where a ball touches a cushion.
enum class CushionTouch : std::uint8_t { kRadius, kNose };
constexpr auto names_of(CushionTouch) {
    return std::array{"radius", "nose"};
}
/// When a ball whose centre has crossed a pocket's circle is pocketed.
enum class PocketModel : std::uint8_t { kFall, kAtOnce };
constexpr auto names_of(PocketModel) {
    return std::array{"fall", "at_once"};
}
/// Whether balls leave the cloth. kDrop: a planar model, which ignores the vertical part of a stroke.
enum class Vertical : std::uint8_t { kKeep, kDrop };
constexpr auto names_of(Vertical) {
    return std::array{"keep", "drop"};
}
/// Integration with `substeps` (kernel/march.h): summed exactly over many steps, or step by step, as
/// published.
enum class March : std::uint8_t { kSummed, kPublished };
constexpr auto names_of(March) {
    return std::array{"summed", "published"};
}
enum class ClusterModel : std::uint8_t { kCompliant, kSequential, kRigid };
constexpr auto names_of(ClusterModel) {
    return std::array{"compliant", "sequential", "rigid"};
}

// The models of an impact are rows of tables, in ball_ball.h and cushion.h.
struct BallBallModelInfo;
struct CushionModelInfo;
const char* name(const BallBallModelInfo* model);
const char* name(const CushionModelInfo* model);
std::span<const BallBallModelInfo* const> all_of(const BallBallModelInfo*);
std::span<const CushionModelInfo* const> all_of(const CushionModelInfo*);
extern const BallBallModelInfo kMathavan;
extern const CushionModelInfo kHan2005;

struct Physics {
    double gravity = 9.81;
    const BallBallModelInfo* ball_ball = &kMathavan;
    /// Straight noses; a ball preset sets the model that suits its game.
    const CushionModelInfo* cushion = &kHan2005;
    const CushionModelInfo* jaw = nullptr;  ///< round jaws; null: as for straight noses
    const CushionModelInfo* jaw_model() const { return jaw != nullptr ? jaw : cushion; }
    kernel::ClothSlip cloth_slip = kernel::ClothSlip::kConsistent;
    ClusterModel clusters = ClusterModel::kCompliant;
    double tolerance = kDefaultTolerance;
    /// If set: the published integration with this many steps, instead of the tolerance.
    std::optional<int> substeps;
    March march = March::kSummed;
    CushionTouch cushion_touch = CushionTouch::kRadius;
    PocketModel pocket = PocketModel::kFall;
    Vertical vertical = Vertical::kKeep;
    bool operator==(const Physics&) const = default;
};
inline constexpr Field<Physics> kPhysicsFields[] = {
    field<&Physics::gravity>("gravity", at_least(0.0, kMaxGravity, "m/s^2"), "acceleration"),
    field<&Physics::ball_ball>("ball_ball", "impact of two balls"),
    field<&Physics::cushion>(
        "cushion",
        "impact with a straight cushion; `mathavan_2010` rejects a friction at which a ball could jam",
        {.standard = "from the balls' preset"}),
    field<&Physics::jaw>("jaw", "impact with a round jaw", {.standard = "as `cushion`"}),
    field<&Physics::cloth_slip>("cloth_slip",
                                "sign of the cloth slip during an impact: `as_published` is the sign of the "
                                "published code, to reproduce its numbers"),
    field<&Physics::clusters>(
        "clusters",
        "several contacts at once: Hertz contacts in one event, pair by pair with the deepest "
        "closing first, or a symmetric projection without friction"),
    field<&Physics::tolerance>("tolerance", at_least(kernel::kTightestTolerance, kernel::kLoosestTolerance),
                               "error allowed in a ball-ball impact (`mathavan`), relative to the approach "
                               "speed; frictions up to 1"),
    field<&Physics::substeps>("substeps", at_least(1.0, kMaxSubsteps), "the published march with this N",
                              {.instead_of = "tolerance"}),
    field<&Physics::march>("march",
                           "how `substeps` are computed: the same steps summed over many at once, or one by "
                           "one as published, bit for bit",
                           {.later = true}),
    field<&Physics::cushion_touch>(
        "cushion_touch",
        "distance of a ball's centre from a nose line that it touches: its `radius` R, as in most "
        "simulators, or sqrt(R^2 - (height - R)^2), where its sphere meets the `nose` (0.6 to 2.2 mm less)"),
    field<&Physics::pocket>("pocket",
                            "a ball whose centre crosses the circle of a pocket falls, and may come back "
                            "over the edge before it has sunk, or it "
                            "is pocketed `at_once`, as in planar simulators"),
    field<&Physics::vertical>(
        "vertical",
        "a ball that is struck or thrown up flies, or the vertical part is dropped, as in planar "
        "simulators"),
};

/// Effects that a plan computes or skips, in the order of effect_table() in plan.h, which lists the keywords
/// of [effects] and the conditions.
enum class Effect : std::uint8_t {
    kSliding,
    kRolling,
    kSpinDecay,
    kThrow,
    kClothInImpact,
    kCushions,
    kCushionFriction,
    kPockets,
    kSquirt,
    kClusters,
    kAirborne,
    kContactTime,
};
inline constexpr std::size_t kEffects = 12;

/// [effects]: one effect forced on or off.
struct EffectOverride {
    std::string keyword;
    bool in_force;
    SourceLocation where;
    bool operator==(const EffectOverride&) const = default;
};

struct Stop {
    std::optional<double> time;
    std::optional<std::int64_t> events;
    bool operator==(const Stop&) const = default;
};
inline constexpr Field<Stop> kStopFields[] = {
    field<&Stop::time>("time", at_least(0.0, kMaxTime, "s"), "end after this much time"),
    field<&Stop::events>("events", at_least(0.0, kAnyInteger),
                         "end after this many events; more than 10 million are an error",
                         {.standard = "more than 1 million are an error"}),
};

inline constexpr const char* kCameras[] = {"top", "rail", "player", "follow"};

struct RenderSettings {
    double fps = 60.0;
    int width = FrameSize().width, height = FrameSize().height;
    std::string camera = "top";  ///< ignored if eye and target are set
    bool hides_cue = false;
    std::optional<Vec3> eye = std::nullopt, target = std::nullopt;  ///< both or neither
    std::optional<std::string> cloth = std::nullopt;                ///< "#rrggbb"
    FrameSize size() const { return {width, height}; }
    bool operator==(const RenderSettings&) const = default;
};
inline constexpr Field<RenderSettings> kRenderFields[] = {
    field<&RenderSettings::fps>("fps", more_than(0.0, kMaxFps, "frames per second"), "frame rate"),
    field<&RenderSettings::width, &RenderSettings::height>("size", at_least(1.0, kMaxImageSize, "pixels"),
                                                           "of an image", {.shape = "[width, height]"}),
    field<&RenderSettings::camera>("camera", "view of the table", {.names = kCameras}),
    field<&RenderSettings::eye>("eye", kCoordinate, "position of a free camera, with `target`",
                                {.shape = "[x, y, z]", .instead_of = "camera"}),
    field<&RenderSettings::target>("target", kCoordinate, "point that a free camera looks at, with `eye`",
                                   {.shape = "[x, y, z]", .instead_of = "camera"}),
    field<&RenderSettings::cloth>("cloth", "colour of the cloth, `\"#rrggbb\"`",
                                  {.standard = "from the game"}),
    either<&RenderSettings::hides_cue, kTrueOrFalse>("cue", "draw the cue"),
};

/// The three channels, 0..1, of a colour such as "#1d6a54"; nothing if it is no colour.
std::optional<std::array<double, 3>> color_of(std::string_view text);

struct Scene {
    std::string file;  ///< the name in messages; free to choose for a scene built in code
    Table table;
    std::string ball_preset = "pool";
    BallParams balls{};
    /// The cue ball's size, if a preset or [balls.cue] sets it. In `ball` it is the ball's own size.
    std::optional<BallSize> cue_ball;
    std::vector<BallStart> ball;  ///< as written, then the racked ones
    std::optional<Cue> cue;       ///< nothing: no ball is struck
    Physics physics;
    std::vector<EffectOverride> effects;
    Stop stop;
    RenderSettings render;
    /// The ball to which `cue_ball` applies: the one that the cue strikes.
    std::string cue_ball_id() const { return cue ? cue->ball : Cue().ball; }
    BallSize size_of(const BallStart& start) const { return start.own.value_or(balls.size()); }
    /// Whether a ball may leave the cloth before its first impact: one starts in the air, or the cue is
    /// raised.
    bool lifts() const {
        const bool raised = cue && cue->elevation_deg > 0.0 && cue->speed > 0.0;
        return physics.vertical == Vertical::kKeep &&
               (raised ||
                std::any_of(ball.begin(), ball.end(), [](const BallStart& b) { return b.flies(); }));
    }
    /// Whether all balls have the same radius and mass.
    bool alike() const {
        return std::all_of(ball.begin(), ball.end(),
                           [&](const BallStart& b) { return size_of(b) == size_of(ball.front()); });
    }
    bool of_one_radius() const {
        return std::all_of(ball.begin(), ball.end(),
                           [&](const BallStart& b) { return size_of(b).R == size_of(ball.front()).R; });
    }
    bool operator==(const Scene&) const = default;
};
inline constexpr const char* kBallPresets[] = {
    "pool",         "snooker", "carom",        "bar_box_oversized", "bar_box_heavy",
    "english_pool", "pyramid", "pool_classic", "snooker_classic",   "carom_classic"};
/// The first key of [balls]; the others are kBallFields.
inline constexpr Field<Scene> kBallPresetFields[] = {
    field<&Scene::ball_preset>("preset", "ball properties, and the cushion model, to start from",
                               {.names = kBallPresets}),
};

/// Reads and validates a scene file. @throws SceneError
Scene read_scene(const std::string& path);

/// The text of a scene file, for parse_scene. @throws SceneError
std::string read_scene_text(const std::string& path);

/// The same from text; messages use `name` for the file.
Scene parse_scene(std::string_view text, const std::string& name);

/// Reads the [cue] of such a text, aimed at the balls of `scene`. @throws SceneError
Cue parse_cue(std::string_view text, const Scene& scene);

/// A scene as the text of a scene file, with every value: parse_scene reads back the same scene. Racked balls
/// are placed one by one; display names and pocket depths are omitted.
std::string scene_text(const Scene& scene);

/// For a scene built in code: all checks of parse_scene, with the same messages in the same order.
/// @throws SceneError without a line
void validate(const Scene& scene);

/// A preset by name, with changed measures. validate() checks whether they fit together.
/// @throws std::invalid_argument for an unknown preset
Table make_table(std::string_view preset, const Measures& changed = {});
/// All measures of such a table; no pocket measures if it has no pockets.
Measures measures_of(std::string_view preset, const Measures& changed = {});
/// The balls that such a table is for: "pool", "snooker", ...
const char* balls_for(std::string_view table_preset);
/// [degrees] The cut-off angle of a pocket: a ball on a straight path at a larger angle to the pocket's axis
/// cannot pass both ends of the mouth. 0 if the ball does not fit at all.
double cut_off_deg(double mouth, double R);
BallParams make_ball_params(std::string_view preset);
/// Gives a scene the balls of a preset, and the cushion model of their game.
void use_balls(Scene& scene, std::string_view preset);
/// Adds the balls of a rack to a scene whose table and balls are set. validate() checks their positions.
/// @throws SceneError for numbers outside the range of [rack]
void add_rack(Scene& scene, Rack rack);
/// Rolling friction of a cloth by name.
double cloth_mu_r(std::string_view cloth);

}  // namespace carom
