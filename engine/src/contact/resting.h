// Resting contacts: balls that stay in contact and push each other or a cushion. Accelerations are constant
// over an interval, so that motions remain polynomials. Source: docs/reference/physics.md, tests/README.md
// H5, H7.
//
// Forces per contact (normal force N >= 0, n from the ball to the other one or into the cushion): -N n on the
// ball, +N n on the other, and between two balls the vertical part of the friction, which loads the cloth and
// slows the spins. Friction parallel to the cloth and friction of cushions are neglected.
#pragma once

#include <vector>

#include "carom/engine/motion.h"
#include "carom/engine/scene.h"
#include "contact/contact.h"
#include "contact/detect.h"

namespace carom {

/// Whether a contact that closes at v_n [m/s] while pressed together with a_c [m/s^2] becomes a resting
/// contact instead of a bounce: the rebound would be shorter than the Hertz contact time.
bool holds(double v_n, double a_c, double restitution);

/// [m/s] Speed that counts as zero in a group: the rounding of the velocities in a few sums of eight terms,
/// or a speed that rolling friction stops at once.
double resting_noise(const Vec3& v, const Vec3& w, const MotionParams& motion);

struct RestingContact {
    Contact contact;  ///< with a ball, a cushion or a nose
    /// unit, from the ball to the other or into the part; fixed over one interval
    Vec2 n = Vec2::Zero();
    double began = 0.0;     ///< [s] when the resting contact began
    bool released = false;  ///< result: the gap opens
};

struct RestingBall {
    int ball = -1;
    Vec3 r, v, w;
    Segment segment;  ///< result
    const MotionParams* motion = nullptr;
    double mass = 1.0;  ///< over that of the lightest ball of the group
};

/// All balls that are connected by resting contacts. Both lists are ordered by position, never by id.
struct RestingGroup {
    std::vector<RestingBall> balls;
    std::vector<RestingContact> contacts;
    double last = kNever;  ///< [s] shortest interval of its balls until now
};

/// The table that a group touches, and the parameters of its balls.
struct RestingSurroundings {
    const Geometry& geometry;
    const BallParams& balls;
    double gravity;
    /// physics.tolerance over the default, from 1e-4 to 1: scales the errors of places and frictions.
    double precision = 1.0;
};

/// Solves the group from `now` [s] on and writes the segments of all members (resting_group.h). They end
/// together: at the first state transition, at the end of a cushion, or when constant accelerations become
/// too inaccurate. Contacts that open are marked released; a contact without force that does not open stays.
void solve_resting(RestingGroup& group, const RestingSurroundings& around, double now);

/// Sets the state of a member after its state transition (its slip, velocity or spin has become zero).
void end_transition(RestingBall& member, MotionState state, double R);

}  // namespace carom
