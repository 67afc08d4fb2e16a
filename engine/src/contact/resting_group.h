// One solution of one group of resting contacts (resting.h) as plain data, and the steps that compute it: velocities
// that close no contact (resting_projection.cpp), forces and accelerations (resting_forces.cpp), states of motion
// consistent with the forces (resting_modes.cpp), and the duration of the solution (resting_intervals.cpp). resting.cpp
// defines the order of the steps.
#pragma once

#include <vector>

#include "contact/resting.h"
#include "physics/motion.h"

namespace carom::resting {

/// [-] Most changes of a ball between rest, rolling and sliding in one solution (docs/design/hard_cases.md, "Where the model has no answer").
inline constexpr int kModeChanges = 8;
/// [-] Relative rounding error of the forces.
inline constexpr double kForceRounding = 1e-9;
/// [s] Shortest interval over which the forces of a resting contact keep their directions if these turn.
inline constexpr double kShortestInterval = 1e-5;
/// [m] and [s] A deeper overlap is removed within the interval, but not in less than this time: otherwise the rounding
/// errors of a long push would add up to nearly 1e-12 m.
inline constexpr double kOverlapDepth = 2e-14;
inline constexpr double kRecoveryTime = 1e-3;
/// [s] A ball that its rolling friction would stop within this time is put to rest; it would otherwise stop repeatedly.
inline constexpr double kRestTime = 1e-8;

enum class Mode : unsigned char { kSliding, kRolling, kResting };

/// A ball of the group in the equations. All forces are per mass.
struct Body {
    Mode mode = Mode::kResting;
    /// Unit vector. Sliding: of the slip; rolling: of the velocity, or of the force that starts it.
    Vec2 direction = Vec2::Zero();
    /// The forces determine the direction: slip or velocity are still zero, or so small that friction would
    /// reverse them within the shortest interval.
    bool starts = false;
    Vec2 due = Vec2::Zero();     ///< rolling and slow: velocity / kShortestInterval
    bool lifted = false;         ///< its contacts carry its whole weight: there is no friction of the cloth
    int changes = 0;             ///< number of changes of the mode in one solution
    Vec2 push = Vec2::Zero();    ///< sum of contact forces
    Vec2 couple = Vec2::Zero();  ///< (T x z) / R of the contact torques
    double lift = 0.0;           ///< vertical contact force
    Vec2 a = Vec2::Zero();       ///< acceleration
    /// Acceleration by a horizontal unit force through the centre.
    double mobility() const {
        return mode == Mode::kSliding ? 1.0 : (mode == Mode::kRolling ? 5.0 / 7.0 : 0.0);
    }
};

/// A contact in the equations; i and j index the bodies, j = -1 for the table.
struct Link {
    int i, j;
    Vec2 n;
    double distance;                    ///< [m] of the centres, as the normal turns; 0: a straight cushion
    const CushionLine* line = nullptr;  ///< the straight cushion, if it is one
    double friction_z = 0.0;            ///< f_z / N, on ball i
    double slip_z = 0.0, slip_x = 0.0;  ///< [m/s] between two balls: upward, and parallel to the cloth
    double friction = 0.0;              ///< coefficient at this slip
    bool stuck = false;                 ///< friction_z has the value that ends slip_z within the interval
    double curving = 0.0;               ///< part of the gap's acceleration that comes from the turning normal
    double depth = 0.0;                 ///< [m] overlap of the bodies
    double stabilisation = 0.0;         ///< acceleration added so that the interval ends with a gap >= 0
    double returning = 0.0;             ///< opening rate / h of a contact that would close again within h
    double diagonal = 0.0;              ///< relative acceleration by a unit force
    double N = 0.0;                     ///< [m/s^2] normal force per mass
    bool walled = false;                ///< cannot be stabilised (between opposing fixed normals)
    bool open = false;                  ///< the gap opens by more than rounding
    bool pressed = false;               ///< N > 0 at the start of the interval
};

struct Group {
    RestingGroup& group;
    const RestingSurroundings& around;
    const MotionParams& motion;
    double now;
    std::vector<Body> bodies;  ///< as group.balls
    std::vector<Link> links;   ///< as group.contacts
    double noise = 0.0;        ///< [m/s] rounding of the group's speeds in a few sums of eight terms
};

/// The terms that a solution for the contact forces includes.
struct SolveOptions {
    double compliance = 0.0;  ///< mobility of balls at rest; 0: they are fixed obstacles
    bool friction = true;     ///< the vertical friction between balls
    bool stabilise = true;    ///< Link::stabilisation
};

struct Solution {
    bool solved;      ///< there is a solution
    bool stabilised;  ///< it includes the stabilisation
};

/// Whether slow balls that friction stops within the shortest interval are stopped now.
enum class SlowBalls : unsigned char { kMove, kMayStop };
/// Whether an interval ends where a contact opens.
enum class Opening : unsigned char { kIgnored, kEnds };

// resting.cpp
Mode mode_of(const Group& g, const RestingBall& ball);
bool stop_slow_rolling(Group& g);
Vec2 velocity(const Group& g, int body);
/// [m/s] rate at which the gap opens
double gap_rate(const Group& g, const Link& link);

// resting_projection.cpp
void project_velocities(Group& g);

// resting_forces.cpp
void make_directions(Group& g);
/// @param interval  [s] during which the gaps must stay closed; 0: only at this instant
Solution solve_forces(Group& g, double interval, SlowBalls slow = SlowBalls::kMove);
bool any_stuck(const Group& g);
bool keep_returning(Group& g);
/// Share of the weight that the cloth supports.
double load(const Group& g, const Body& body);
/// [m/s^2] acceleration at which the gap opens, from the present forces
double gap_acceleration(const Group& g, const Link& link);

// resting_modes.cpp
bool modes_hold(Group& g, SlowBalls slow);

// resting_intervals.cpp
/// Relative motion perpendicular to the normal (velocity, acceleration), and Link::distance.
struct Across {
    double v, a, distance;
};
Across across(const Group& g, const Link& link);
Vec2 spin_rate(const Group& g, int body);
/// [s] Time for which the normals may be treated as constant; kNever if none turns.
double normal_interval(const Group& g);
/// Sets the directions of friction to those at the middle of the segments. @return whether any turned
bool use_midpoint_directions(Group& g);
/// Writes the segments. @return their duration [s], at most `longest`
double write_segments(Group& g, const Solution& solution, double longest, Opening opening);

}  // namespace carom::resting
