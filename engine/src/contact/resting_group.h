// One solution of one group of resting contacts (resting.h) as plain data, and the steps that work on it: velocities
// that close no contact (resting_projection.cpp), forces and accelerations (resting_forces.cpp), states of motion
// that agree with the forces (resting_modes.cpp), how long the solution lasts (resting_intervals.cpp). The order of
// the steps stands in resting.cpp.
#pragma once

#include <vector>

#include "contact/resting.h"
#include "physics/motion.h"

namespace carom::resting {

/// [-] Times that a ball may change between rest, rolling and sliding in one solution.
inline constexpr int kModeChanges = 8;
/// [-] Rounding of the forces, relative.
inline constexpr double kForceRounding = 1e-9;
/// [s] Shortest interval over which a resting contact keeps the directions of its forces where they turn.
inline constexpr double kShortestInterval = 1e-5;
/// [m] and [s] An overlap deeper than this is taken back within the interval, but in no less time than this: what
/// rounding adds up in a long push would come near to 1e-12 m.
inline constexpr double kOverlapDepth = 2e-14;
inline constexpr double kRecoveryTime = 1e-3;
/// [s] A ball that its own rolling friction would stop within this time rests, or it would stop again and again.
inline constexpr double kRestTime = 1e-8;

enum class Mode : unsigned char { kSliding, kRolling, kResting };

/// A ball of the group with what the equations need. All forces are per mass.
struct Body {
    Mode mode = Mode::kResting;
    /// Sliding: of the slip; rolling: of the velocity, or of the force that starts it.
    Vec2 direction = Vec2::Zero();
    /// The direction is that of the forces: there is no slip, or no velocity, yet, or so little that friction
    /// would turn it over within the shortest interval.
    bool starts = false;
    Vec2 due = Vec2::Zero();     ///< rolling and slow: velocity / kShortestInterval
    bool lifted = false;         ///< its contacts carry its whole weight: no friction from the cloth
    int changes = 0;             ///< of mode, in one solution
    Vec2 push = Vec2::Zero();    ///< sum of contact forces
    Vec2 couple = Vec2::Zero();  ///< (T x z) / R of the contact torques
    double lift = 0.0;           ///< vertical contact force
    Vec2 a = Vec2::Zero();       ///< acceleration
    /// Acceleration by a horizontal force of 1 through the centre.
    double mobility() const {
        return mode == Mode::kSliding ? 1.0 : (mode == Mode::kRolling ? 5.0 / 7.0 : 0.0);
    }
};

/// A contact as the equations see it; i and j index the bodies, j = -1 for the table.
struct Link {
    int i, j;
    Vec2 n;
    double distance;                    ///< [m] over which the normal turns; 0: a straight cushion
    const CushionLine* line = nullptr;  ///< the straight cushion
    double friction_z = 0.0;            ///< f_z / N, on ball i
    double slip_z = 0.0, slip_x = 0.0;  ///< [m/s] between two balls: upward, and along the cloth
    double friction = 0.0;              ///< coefficient at that slip
    bool stuck = false;                 ///< friction_z is what ends slip_z within the interval
    double curving = 0.0;               ///< what turning normals add to the acceleration of the gap
    double depth = 0.0;                 ///< [m] by which the bodies overlap
    double stabilisation = 0.0;         ///< what the gap needs besides to end the interval at 0 or above
    double returning = 0.0;             ///< opening rate / h of a contact that would be closed again within h
    double diagonal = 0.0;              ///< relative acceleration by a force of 1
    double N = 0.0;
    bool walled = false;   ///< there is no room for a stabilisation
    bool open = false;     ///< the gap is opening by more than rounding
    bool pressed = false;  ///< by the forces at the start of the interval
};

struct Group {
    RestingGroup& group;
    const RestingSurroundings& around;
    const MotionParams& motion;
    double now;
    std::vector<Body> bodies;  ///< as group.balls
    std::vector<Link> links;   ///< as group.contacts
    double noise = 0.0;        ///< [m/s] what rounding makes of the group's speeds in a few sums of eight
};

/// What a solution for the contact forces takes into account.
struct SolveOptions {
    double compliance = 0.0;  ///< mobility of balls at rest; 0: they are fixed obstacles
    bool friction = true;     ///< the vertical friction between balls
    bool stabilise = true;    ///< Link::stabilisation
};

struct Solution {
    bool solved;      ///< the contacts have an answer
    bool stabilised;  ///< it has the stabilisation in it
};

/// Whether slow balls that friction stops within the shortest interval stop now.
enum class SlowBalls : unsigned char { kMove, kMayStop };
/// Whether an interval ends where a contact opens.
enum class Opening : unsigned char { kIgnored, kEnds };

// resting.cpp
Mode mode_of(const Group& g, const RestingBall& ball);
bool stop_slow_rolling(Group& g);
Vec2 velocity(const Group& g, int body);
/// [m/s] at which the gap opens
double gap_rate(const Group& g, const Link& link);

// resting_projection.cpp
void project_velocities(Group& g);

// resting_forces.cpp
void make_directions(Group& g);
/// @param interval  [s] over which the gaps are to stay closed; 0: at this instant
Solution solve_forces(Group& g, double interval, SlowBalls slow = SlowBalls::kMove);
bool any_stuck(const Group& g);
bool keep_returning(Group& g);
/// Share of the weight that the cloth carries.
double load(const Group& g, const Body& body);
/// [m/s^2] at which the gap opens, by the present forces
double gap_acceleration(const Group& g, const Link& link);

// resting_modes.cpp
bool modes_hold(Group& g, SlowBalls slow);

// resting_intervals.cpp
/// Relative motion across the normal (velocity, acceleration) and the distance over which the normal turns, 0 where
/// it does not (a straight cushion).
struct Across {
    double v, a, distance;
};
Across across(const Group& g, const Link& link);
Vec2 spin_rate(const Group& g, int body);
/// [s] How long normals may be taken as they are; kNever if none turns.
double normal_interval(const Group& g);
/// Takes the directions of friction at the middle of the segments. @return whether any turned
bool use_midpoint_directions(Group& g);
/// Writes the segments. @return how long they last [s], at most `longest`
double write_segments(Group& g, const Solution& solution, double longest, Opening opening);

}  // namespace carom::resting
