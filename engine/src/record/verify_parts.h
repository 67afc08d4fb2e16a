// The parts of the record checker: motions, events, hits of clusters, overlaps and energy, skipped effects,
// and the distances that they share.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "carom/engine/ball_ball.h"
#include "carom/engine/geometry.h"
#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "carom/engine/tolerances.h"
#include "carom/engine/vec.h"
#include "carom/engine/verify.h"
#include "contact/roots.h"
#include "physics/motion.h"

namespace carom {

// [m], [s] and [of the speeds] Places, times and rates that differ by less are equal; a program that writes
// records may round.
constexpr double kSamePlace = 1e-9, kSameTime = 1e-9, kSameShare = 1e-9;
inline double same_time(double t) {
    return kSameTime + 8.0 * kEpsilon * t;
}

/// Checks the order of times (law "U2"), and that every segment follows from its state (law "U7"). All
/// numbers of the record are finite.
std::optional<Violation> verify_motion(const Record& record, const Plan& plan);

/// Checks the rest, the duration and the pockets that the record states (law "U8").
std::optional<Violation> verify_end(const Record& record, const Plan& plan);

struct SeenBall {
    Vec3 r;
    double R;
    bool flies = false;     ///< or is out
    double fell = kNever;   ///< [s] when it began to fall into a pocket; kNever if it is not falling
    double flew = -kNever;  ///< [s] when its last flight ended
    double rounding = 0.0;  ///< [m] rounding_of()
    bool disc = false;
};

/// [m] How much too far a ball with these speeds may have moved in t [s]: closing speeds within rounding
/// (kClosingUlp) do not count as an approach, and times are rounded.
double rounding_of(const Vec3& v, const Vec3& w, double R, double t);
/// [m] Allowed overlap with another ball or the cloth, or with the wall at this position.
double allowed_depth(const SeenBall& ball);
double allowed_depth(const SeenBall& ball, const Vec2& wall);

/// A ball at the position `r`, in segment number `segment`.
/// @param flights  whether balls may leave the cloth
SeenBall see(const Record& record, std::size_t ball, std::size_t segment, const Vec3& r, double rounding,
             bool flights);

/// Whether two balls meet in space rather than in the plane: one flies, or has flown since the other began to
/// fall into a pocket.
bool in_space(const SeenBall& one, const SeenBall& two);
/// [m] Between two balls, in space or in the plane; negative if they overlap.
double gap_between(const SeenBall& one, const SeenBall& two);
/// [m] To the nose of a cushion; infinite if the ball is beyond its ends.
double gap_to(const CushionLine& line, const SeenBall& ball);
/// [m] To a jaw or the end of a cushion; infinite if the ball is not beside it.
double gap_to(const Nose& nose, const SeenBall& ball);
/// [m] To the cloth: 0 for a ball on it.
double gap_to_cloth(const SeenBall& ball);

/// Checks the impacts (law "U5"), and that every change has its event and every event its change ("U6"). The
/// motions are in order.
std::optional<Violation> verify_events(const Record& record, const Plan& plan);

/// Checks every segment: whether a ball hits a cushion or jaw, enters a pocket, or hits another ball for
/// which the plan has no detector; and whether it has vertical spin, slips or rolls although the plan skipped
/// that friction. Law "E".
std::optional<Violation> verify_skipped(const Record& record, const Plan& plan);

/// The state in which a ball enters a cluster: at the end of the segment before `colliding`, one of its own.
BallState entering(const Record& record, std::size_t ball, const Segment& colliding);

/// [J/kg] Energy of a ball, divided by the mass in [balls]; a ball in a pocket has none.
double ball_energy(const Record& record, int ball, const BallState& state);

/// [J/kg] Possible change of the total energy by the rounding of the heights.
double height_rounding(const Record& record);

/// [J/kg] Total energy that ball_energy() misses of balls that run along a round wall: between two instants
/// their velocity is interpolated linearly, while in truth it turns.
double chord_energy(const Record& record, double t);

/// Checks the start, the quarters and the middle of every piece of motion between two changes of any segment,
/// and so also inside the intervals of resting contacts. Laws "U3" and "U4". A centre that crosses a cushion
/// is found exactly, at any speed.
/// @param energy  whether energy must never rise
std::optional<Violation> verify_between(const Record& record, const Plan& plan, bool energy);

/// A ball of a cluster, just before it and at its end.
struct ClusterMove {
    int ball;
    Placed before, end;
    double spin;  ///< R |w| before [m/s]
};

struct HitFault {
    const char* law;
    std::string message;
};

/// Each impulse acts along the line of centres of its first touch, friction adds at most its share, and a
/// ball that nobody hit keeps its velocity. Together the balls keep their momentum, except for cushions and
/// the cloth (law "U5"). The hits are of these balls and this time ("U6").
/// @param lasts  [s] 0: only the sum over the balls is known, and balls that nobody hit
/// @param time  [s] in which the balls slide and pass each other
/// @param known  whether nothing else happens to these balls, and all stay on the cloth; false: only "U6"
std::optional<HitFault> verify_hits(const Record& record, const Plan& plan, const Event& cluster,
                                    std::span<const ClusterMove> moves, double lasts, double time,
                                    bool known);

}  // namespace carom
