// Resting contacts: balls that stay in touch and push each other, or a cushion. Accelerations are constant over an
// interval, so the engine's polynomials stay. Source: docs/physics.md, docs/hard_cases.md H5, H7.
//
// Forces per contact (normal force N >= 0, n from the ball to the other one or into the cushion): -N n on the ball,
// +N n on the other, and the vertical share of the friction between two balls, which loads the cloth and brakes the
// spins. The friction along the cloth and a cushion's friction are left out.
#pragma once

#include <vector>

#include "carom/engine/motion.h"
#include "carom/engine/scene.h"
#include "contact/contact.h"

namespace carom {

/// Whether a contact that closes at v_n [m/s] while pressed together with a_c [m/s^2] is a resting one instead of a
/// bounce: the bounce would be over before the Hertz contact itself is.
bool holds(double v_n, double a_c, double restitution);

/// Speed that counts as none in a group [m/s]: what rounding makes of the velocities in a few sums of eight, or what
/// rolling friction stops at once.
double resting_noise(const Vec3& v, const Vec3& w, const MotionParams& motion);

struct RestingContact {
    Contact contact;  ///< with a ball, a cushion or a nose
    Vec2 n =
        Vec2::Zero();  ///< unit, from the ball to the other or into the table's part; kept over one interval
    double force = 0.0;     ///< N / m [m/s^2]
    bool released = false;  ///< result: its gap opens
};

struct RestingBall {
    int ball = -1;
    Vec3 r, v, w;
    Segment segment;  ///< result
};

/// All balls that are connected by resting contacts. Both lists are ordered by position, never by id.
struct RestingGroup {
    std::vector<RestingBall> balls;
    std::vector<RestingContact> contacts;
};

/// What a group touches and is made of.
struct RestingSurroundings {
    const Geometry& geometry;
    const BallParams& balls;
    double gravity;
};

/// Solves for forces and accelerations at `now` and writes the segments of all members, which end together at the
/// first transition, turn of a direction, opening of a gap, or end of a cushion. Contacts that open are marked
/// released; one without force that does not open stays.
void solve_resting(RestingGroup& group, const RestingSurroundings& around, const MotionParams& motion,
                   double now);

/// Time until the foot point of a ball that runs along a cushion passes the cushion's end; 0 if it is leaving it now.
double time_to_line_end(const CushionLine& line, const Segment& segment);

/// The state of a member at its own transition (slip gone, stopped, spin gone), in place.
void end_transition(RestingBall& member, MotionState state, double R);

}  // namespace carom
