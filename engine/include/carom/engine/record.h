// Record: the result of a simulation: closed-form motion segments for each ball, and the ordered events.
// Immutable once made.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/engine/scene.h"
#include "carom/engine/vec.h"

namespace carom {

/// kFalling: over a pocket, not yet in it. kOut: flew over the cushions, out of play. kColliding: in a
/// cluster, which lasts a while; the ball moves straight to its position at the end of the cluster.
enum class MotionState : std::uint8_t {
    kStationary,
    kSpinning,
    kSliding,
    kRolling,
    kPocketed,
    kFalling,
    kAirborne,
    kOut,
    kColliding
};
constexpr auto names_of(MotionState) {
    return std::array{"stationary", "spinning", "sliding", "rolling",  "pocketed",
                      "falling",    "airborne", "out",     "colliding"};
}
/// Whether a ball in this state is out of play.
constexpr bool is_gone(MotionState state) {
    return state == MotionState::kPocketed || state == MotionState::kOut;
}
/// Whether a ball moves on a parabola, without touching the cloth.
constexpr bool flies(MotionState state) {
    return state == MotionState::kAirborne || state == MotionState::kOut;
}
/// Whether the centre moves up or down: in flight, or falling into a pocket.
constexpr bool is_off_cloth(MotionState state) {
    return flies(state) || state == MotionState::kFalling;
}

/// The motion of one ball between two of its events, or in a cluster. Times inside are relative to `start`.
struct Segment {
    double start = 0.0;  ///< s since the start of the shot
    /// Centre, velocity and angular velocity at the start. For a ball that falls into a pocket, r_z remains
    /// the height where the fall began, and v_z is its vertical velocity at the start: after tau it is (v_z
    /// - g tau)^2 / 2g below r_z. A flying ball is at the height r_z + v_z tau - g tau^2 / 2. For a colliding
    /// ball, v is its mean velocity, and w that after the cluster.
    Vec3 r, v, w;
    Vec2 a;                   ///< acceleration [m/s^2], constant
    Vec2 dw;                  ///< d(w_x, w_y)/dt [rad/s^2], constant
    double spin_decay = 0.0;  ///< |dw_z/dt| [rad/s^2], >= 0; w_z never passes 0
    double duration = 0.0;    ///< until the ball's own next transition [s]; infinite if there is none
    MotionState state = MotionState::kStationary;
    bool held = false;  ///< in a resting contact: `a` includes the contact forces
    /// A transition follows at the end of the duration (for a held ball, perhaps only its forces change).
    bool ends = true;
    bool operator==(const Segment&) const = default;
};

enum class EventType : std::uint8_t {
    kCueStrike,
    kBallBall,
    kBallCluster,
    kBallCushion,
    kBallJaw,
    kBallPocket,
    kSlideRoll,
    kRollSpin,
    kRollStop,
    kSpinStop,
    // Resting contacts: from hold to release, the two stay in contact and push each other.
    kBallBallHold,
    kBallBallRelease,
    kBallCushionHold,
    kBallCushionRelease,
    kBallJawHold,
    kBallJawRelease,
    /// The centre crosses the edge of a pocket: the ball begins to fall, or returns to the cloth.
    kBallEdge,
    kBallCloth,  ///< a flying or pressed-down ball hits the cloth
    kBallOut,    ///< a flying ball's centre passes over a cushion: it has left the table
};
inline constexpr int kEventTypes = 19;

/// The list that Event::b indexes.
enum class Partner : std::uint8_t { kNone, kBall, kCushion, kJaw, kPocket };
/// In record files: with whom a ball of a cluster collided.
constexpr auto names_of(Partner) {
    return std::array{"cloth", "ball", "cushion", "jaw", "pocket"};
}

/// Calls f with the list of the table's parts that Event::b indexes. @param partner  not kNone or kBall
template <class F>
auto with_parts(const Table& table, Partner partner, const F& f) {
    if (partner == Partner::kJaw) return f(table.jaws);
    return partner == Partner::kPocket ? f(table.pockets) : f(table.cushions);
}

/// The kind of change for the ball.
enum class EventPhase : std::uint8_t {
    kStrike,      ///< the cue hits it
    kImpact,      ///< it meets another ball, a cushion, a jaw, a pocket or the cloth
    kTransition,  ///< it changes its state of motion by itself
    kHold,        ///< a resting contact begins
    kRelease      ///< a resting contact ends
};

/// Everything that follows from the type of an event.
struct EventKind {
    EventType type;
    const char* name;  ///< in files
    EventPhase phase;
    Partner partner = Partner::kNone;
};

/// One row per type, in the order of the enumeration.
inline constexpr EventKind kEventKinds[kEventTypes] = {
    {EventType::kCueStrike, "cue_strike", EventPhase::kStrike},
    {EventType::kBallBall, "ball_ball", EventPhase::kImpact, Partner::kBall},
    {EventType::kBallCluster, "ball_cluster", EventPhase::kImpact, Partner::kBall},
    {EventType::kBallCushion, "ball_cushion", EventPhase::kImpact, Partner::kCushion},
    {EventType::kBallJaw, "ball_jaw", EventPhase::kImpact, Partner::kJaw},
    {EventType::kBallPocket, "ball_pocket", EventPhase::kImpact, Partner::kPocket},
    {EventType::kSlideRoll, "slide_roll", EventPhase::kTransition},
    {EventType::kRollSpin, "roll_spin", EventPhase::kTransition},
    {EventType::kRollStop, "roll_stop", EventPhase::kTransition},
    {EventType::kSpinStop, "spin_stop", EventPhase::kTransition},
    {EventType::kBallBallHold, "ball_ball_hold", EventPhase::kHold, Partner::kBall},
    {EventType::kBallBallRelease, "ball_ball_release", EventPhase::kRelease, Partner::kBall},
    {EventType::kBallCushionHold, "ball_cushion_hold", EventPhase::kHold, Partner::kCushion},
    {EventType::kBallCushionRelease, "ball_cushion_release", EventPhase::kRelease, Partner::kCushion},
    {EventType::kBallJawHold, "ball_jaw_hold", EventPhase::kHold, Partner::kJaw},
    {EventType::kBallJawRelease, "ball_jaw_release", EventPhase::kRelease, Partner::kJaw},
    {EventType::kBallEdge, "ball_edge", EventPhase::kTransition, Partner::kPocket},
    {EventType::kBallCloth, "ball_cloth", EventPhase::kImpact},
    {EventType::kBallOut, "ball_out", EventPhase::kTransition},
};

constexpr const EventKind& kind(EventType type) {
    return kEventKinds[static_cast<int>(type)];
}
constexpr const char* name(EventType type) {
    return kind(type).name;
}
/// The first type of this kind of change with this partner.
constexpr EventType event_type(EventPhase phase, Partner partner) {
    for (const EventKind& of : kEventKinds)
        if (of.phase == phase && of.partner == partner) return of.type;
    return EventType::kCueStrike;
}
/// Whether two balls, or a cluster of balls, collide.
constexpr bool balls_collide(EventType type) {
    return kind(type).phase == EventPhase::kImpact && kind(type).partner == Partner::kBall;
}

struct Event {
    double time = 0.0;  ///< s since the start of the shot
    EventType type = EventType::kCueStrike;
    int a = -1;  ///< ball (index)
    int b = -1;  ///< the other ball, or the index of the cushion, jaw or pocket; -1 if none
    /// kBallCluster: index into Record::clusters; cushions and jaws: index into the plan's noses, or -1
    int detail = -1;
    /// The contact, in the air, was so slow that it separated at a fixed speed: the energy may rise.
    bool slow = false;
    bool operator==(const Event&) const = default;
};

/// Two bodies that pushed each other: one contact of an impact.
struct Hit {
    double time = 0.0;  ///< s since the start of the shot: they touched for the first time
    int a = -1;         ///< ball
    Partner partner = Partner::kBall;
    int b = -1;            ///< ball, cushion or jaw; -1: the cloth
    double impulse = 0.0;  ///< N s, along the normal
    bool operator==(const Hit&) const = default;
};

/// The balls and contacts that a ball_cluster event resolved.
struct Cluster {
    std::vector<int> balls;  ///< ordered by position
    std::vector<Hit> hits;   ///< ordered by time
    bool operator==(const Cluster&) const = default;
};

/// Calls f(const Hit&) for everything that touched in this event, so that nobody has to ask whether it is a
/// cluster. The hit of a single pair has no impulse.
/// @param of_cluster  the hits of a ball_cluster event
template <class F>
void each_hit(const Event& event, std::span<const Hit> of_cluster, F&& f) {
    const EventKind& of = kind(event.type);
    if (event.type == EventType::kBallCluster)
        for (const Hit& hit : of_cluster) f(hit);
    else if ((of.phase == EventPhase::kImpact && of.partner != Partner::kPocket) ||
             of.phase == EventPhase::kHold)
        f(Hit{event.time, event.a, of.partner, event.b});
}

/// Cost of one event; only in a profiled run.
struct EventCost {
    double detect_ns = 0.0;   ///< finding the next event, and detecting again after this one
    double resolve_ns = 0.0;  ///< advancing and resolving, kernel included
    double kernel_ns = 0.0;   ///< inside the impact kernel
    std::int64_t steps = 0;   ///< of the kernel
    std::string method{};     ///< "march", "elastic", "han_2005", ...
    double queue_ns = 0.0;    ///< part of detect_ns: choosing the next event
    bool operator==(const EventCost&) const = default;
};

/// kEndless: balls move forever without another event, and no stop time was set; the record ends after its
/// last event.
enum class StopReason : std::uint8_t { kAtRest, kTime, kEvents, kEndless };

struct StopWords {
    const char* word;       ///< in tables, Python and C
    const char* in_record;  ///< in record files
    const char* sentence;   ///< for people
};
inline constexpr std::array<StopWords, 4> kStopWords = {{
    {"at_rest", "at rest", "everything is at rest"},
    {"time", "stop time", "stopped at the time limit"},
    {"events", "number of events", "stopped at the event limit"},
    {"endless", "endless motion", "no more events, but balls move forever"},
}};
constexpr const StopWords& words(StopReason why) {
    return kStopWords[static_cast<std::size_t>(why)];
}
/// As written in record files.
constexpr auto names_of(StopReason) {
    std::array<const char*, kStopWords.size()> names{};
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = kStopWords[i].in_record;
    return names;
}

struct BallState {
    MotionState state = MotionState::kStationary;
    Vec3 position, velocity, spin;
    int pocket = -1;  ///< index of its pocket, or -1
    bool operator==(const BallState&) const = default;
};

struct BallTrack {
    std::string id;
    /// Ordered by start; of two with the same start, the later one counts. A record that ends during a
    /// cluster also has the motion after the cluster, which starts after the record's end.
    std::vector<Segment> segments;
    int pocket = -1;
    std::optional<BallSize> own = std::nullopt;  ///< as BallStart::own
    bool operator==(const BallTrack&) const = default;
    /// Index of the segment in force at time t: the last one that starts at or before t.
    std::size_t segment_at(double t) const;
};

class Record {
  public:
    bool operator==(const Record&) const = default;

    Table table;
    BallParams balls{};
    double gravity = 9.81;
    RenderSettings render;
    std::vector<BallTrack> tracks;
    std::vector<Event> events;
    /// Of every ball_cluster event; Event::a and b are the pair that met first.
    std::vector<Cluster> clusters;
    std::vector<EventCost> costs;  ///< empty, or one per event
    double setup_detect_ns = 0.0;  ///< profiled: the first detection, of all pairs
    double duration = 0.0;         ///< s
    double start_time = 0.0;       ///< s: SimulateOptions::start_time; all times here are relative to it
    StopReason stopped = StopReason::kAtRest;

    /// Removes the result, for another shot. Keeps the memory of segments and events.
    void clear();

    BallSize size(int ball) const { return tracks[ball].own.value_or(balls.size()); }

    /// State of a ball at time t, in closed form from the last segment that starts at or before t. Before 0
    /// it is the start, after the duration the end.
    BallState state_at(int ball, double t) const;

    /// The same for every ball at many times: for each time, nine numbers per ball (position, velocity,
    /// spin), and its state of motion. Null arrays are not filled.
    void states_at(std::span<const double> times, double* rvw, std::uint8_t* kinds) const;

    /// Orientation (body to table) at time t, starting from the identity: the integral of the angular
    /// velocity. Exact if the axis is fixed, otherwise by fourth-order Magnus steps of at most 0.2 rad (error
    /// 1e-7 rad over a shot).
    Eigen::Quaterniond orientation_at(int ball, double t) const;

    /// 64-bit FNV-1a over the bits of the segments (except `ends`), the events (except `detail`) and the
    /// duration, as 16 hex digits.
    std::string hash() const;

    /// The hits of a ball_cluster event; empty for another one.
    std::span<const Hit> hits(const Event& event) const {
        if (event.type != EventType::kBallCluster) return {};
        return clusters[static_cast<std::size_t>(event.detail)].hits;
    }

    /// Id of an event's b: a ball, cushion, jaw or pocket, or "".
    std::string partner_id(const Event& event) const { return partner_id(kind(event.type).partner, event.b); }
    std::string partner_id(Partner partner, int index) const;

  private:
    struct Orientations;
    /// A cache, not part of the value: any two compare equal.
    struct Aside {
        Aside();
        // A copy may be changed, so it computes its own orientations.
        Aside(const Aside&) : Aside() {}
        Aside(Aside&&) noexcept = default;
        ~Aside() = default;
        Aside& operator=(Aside other) noexcept {
            orientations = std::move(other.orientations);
            return *this;
        }
        bool operator==(const Aside&) const { return true; }
        std::shared_ptr<Orientations> orientations;  // made on first use, by any thread
    };
    Aside aside_;
};

/// Position, velocity and spin of a segment `tau` seconds after its start (tau >= 0), without the height of a
/// ball that flies or falls into a pocket.
inline Vec3 position_at(const Segment& s, double tau) {
    return {s.r.x() + tau * (s.v.x() + 0.5 * tau * s.a.x()), s.r.y() + tau * (s.v.y() + 0.5 * tau * s.a.y()),
            s.state == MotionState::kColliding ? s.r.z() + tau * s.v.z() : s.r.z()};
}
inline Vec3 velocity_at(const Segment& s, double tau) {
    if (s.state == MotionState::kColliding) return s.v;
    if (s.state == MotionState::kRolling && s.duration < std::numeric_limits<double>::infinity() && !s.held) {
        // v + a tau, written so that the direction is kept and the end is exactly 0.
        const double left = std::max(0.0, 1.0 - tau / s.duration);
        return {s.v.x() * left, s.v.y() * left, 0.0};
    }
    return {s.v.x() + tau * s.a.x(), s.v.y() + tau * s.a.y(), 0.0};
}
Vec3 spin_at(const Segment& segment, double tau, double R);

/// [m] Depth of the floor below the cloth, where a ball that left the table comes to rest. A table bed is
/// 29 1/4 to 31 inches high (WPA Tournament Table & Equipment Specifications, 2), 0.743 to 0.787 m.
inline constexpr double kFloorDepth = 0.76;

/// Time from the start of a segment until a ball of radius R lies on the floor [s]; infinite if it has not
/// left the table.
inline double until_floor(const Segment& s, double R, double gravity) {
    if (s.state != MotionState::kOut || !(gravity > 0.0)) return std::numeric_limits<double>::infinity();
    const double v = s.v.z(), height = std::max(0.0, s.r.z() + (kFloorDepth - R));
    return (v + std::sqrt(v * v + 2.0 * gravity * height)) / gravity;
}

/// Whether a record can belong to this scene: it has the same balls in the same order.
bool same_balls(const Scene& scene, const Record& record);

/// The scene for the next shot: every ball of the record in its final state, without pocketed balls and
/// without a cue. The caller chooses the ball to strike and respots balls. A ball that is still falling
/// starts its fall again. The result may need other [effects].
/// @param scene  of the record: the same balls in the same order
Scene scene_after(const Scene& scene, const Record& record);

/// Writes a record as JSON to `path`, via a temporary file. Doubles read back to the same bits.
/// @throws std::runtime_error naming the file
void write_record(const Record& record, const std::string& path);

/// The text that write_record writes. @throws std::runtime_error as write_record does, except for the file
std::string record_json(const Record& record);

/// Reads the output of write_record, in this version of the format (docs/reference/record_format.md). `notes`
/// receives a sentence for everything that the file lacks or this version does not support.
/// @throws SceneError
Record read_record(const std::string& path, std::vector<std::string>* notes = nullptr);

/// The same from text; messages use `name` for the file.
Record parse_record(std::string_view text, const std::string& name,
                    std::vector<std::string>* notes = nullptr);

}  // namespace carom
