// Sustained contacts: balls that stay in touch and push each other, or a cushion. Accelerations are constant
// over an interval, so the engine's polynomials stay. Source: docs/physics.md, docs/hard_cases.md H5, H7.
//
// Forces per contact (normal force N >= 0, n from ball i to ball j or into the cushion): -N n on i, +N n on
// j, and the vertical share of the friction between two balls, which loads the cloth and brakes the spins.
// The friction along the cloth and a cushion's friction are left out.
#pragma once

#include <vector>

#include "carom/engine/geometry.h"
#include "carom/engine/motion.h"
#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom {

/// Whether a contact that closes at v_n [m/s] while pressed together with a_c [m/s^2] is held instead of bouncing.
bool holds(double v_n, double a_c, double restitution);

/// Speed that counts as none in a held group [m/s]: what rounding makes of the velocities in a few sums of
/// eight, or what rolling friction stops within kHoldNoise.
double held_noise(const Vec3& v, const Vec3& w, const MotionParams& motion);

struct HeldContact {
    int i = -1, j = -1;  ///< balls (engine indices); j = -1 for the table
    int cushion = -1,
        nose = -1;     ///< the straight cushion (Geometry::cushions), or the round nose (Geometry::noses)
    bool jaw = false;  ///< the nose is a jaw
    Vec2 n = Vec2::Zero();  ///< unit, from i to j or into the table's part; kept over one interval
    double force = 0.0;     ///< N / m [m/s^2]
    bool released = false;  ///< result: its gap opens
    EventType hold_type() const;
    EventType release_type() const;
    int partner = -1;  ///< what an event calls b
};

struct HeldBall {
    int ball = -1;
    Vec3 r, v, w;
    Segment segment;  ///< result
};

/// One connected group. Both lists are ordered by position, never by id.
struct HeldGroup {
    std::vector<HeldBall> balls;
    std::vector<HeldContact> contacts;
};

/// What a held group touches and is made of.
struct HeldSurroundings {
    const Geometry& geometry;
    const BallParams& balls;
    double gravity;
};

/// Solves for forces and accelerations at `now` and writes the segments of all members, which end together at
/// the first transition, turn of a direction, opening of a gap, or end of a cushion. Contacts that open are
/// marked released; one without force that does not open stays.
void solve_held(HeldGroup& group, const HeldSurroundings& around, const MotionParams& motion, double now);

/// Time until the foot point of a ball that runs along a cushion passes the cushion's end; 0 if it is leaving it now.
double time_to_line_end(const CushionLine& line, const Segment& segment);

/// The state of a member at its own transition (slip gone, stopped, spin gone), in place.
void end_transition(HeldBall& member, MotionState state, double R);

}  // namespace carom
