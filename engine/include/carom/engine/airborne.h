// Impacts in which the vertical counts: of a ball that flies, bounces or is thrown up. All are instantaneous
// and free: nothing but the two that meet takes part, and a ball on the cloth that comes out of one with a
// speed downwards hits the cloth next, at the same instant. Equations: docs/reference/physics.md, "Balls in
// the air".
#pragma once

#include "carom/engine/cushion.h"
#include "carom/engine/motion.h"
#include "carom/engine/scene.h"
#include "carom/engine/vec.h"

namespace carom {

/// Of one ball: its centre's velocity [m/s] and its angular velocity [rad/s].
struct Velocities {
    Vec3 v, w;
};

/// [m/s] A rebound slower than this does not leave the cloth: sqrt(2 g 0.0045 R).
/// By 0.0045 R a ball that lies there sinks in: (9/8) (mu_sp/mu_s)^2 R with the
/// frictions of pool, from the radius of the contact that the pivot friction tells.
double bounce_end(double R, double gravity);

/// [m/s] The speed at which a slow contact in the air parts;
/// a contact is slow where its restitution would give less.
double parting_speed(double R, double gravity);

/// Restitution of ball and cloth at the speed V [m/s] towards the cloth.
double cloth_restitution(const BallParams& balls, double V);

/// A ball at the height of its radius comes down on the cloth (v_z < 0): Coulomb friction on its slip and on
/// its vertical spin during an impact with restitution, equations (A2) to (A4). Below bounce_end() the
/// rebound is 0.
/// @param balls  mu_s, mu_sp, e_t
void hit_cloth(const BallParams& balls, const MotionParams& motion, Velocities& ball);

/// How two balls meet: the friction and restitution that the model and the plan leave in force.
struct FreePair {
    BallSize size1, size2;
    BallParams balls;  ///< mu_b, mu_b_more, mu_b_fall, e_b
};

/// Two free balls: one impulse with friction, equation (A5). It moves nothing if they do not approach.
/// @param n  unit, from the centre of ball 1 to that of ball 2
void hit_ball(const FreePair& pair, const Vec3& n, Velocities& ball1, Velocities& ball2);

/// A contact so slow that bounces would follow each other without end: no friction, and the balls part at
/// `parting` [m/s], equation (A7). A ball that lies on the cloth is held vertically by it.
void part_slowly(const FreePair& pair, const Vec3& n, bool lies1, bool lies2, double parting,
                 Velocities& ball1, Velocities& ball2);

/// A ball in the air at a nose, equation (A6).
/// @param n  unit, from the nose to the ball's centre
/// @param parting  [m/s] speed at which it parts where its restitution would give less
/// @return whether it would
bool hit_nose(const BallParams& balls, double R, const CushionModelInfo& model, const Vec3& n, double parting,
              Velocities& ball);

/// [m/s] Upward speed of a ball that lay on the cloth when it met a nose: what (A6) gives, or the share e_h
/// of it where that points down; 0 where it is below bounce_end().
/// @param ball  as it came
double hop_speed(const BallParams& balls, const MotionParams& motion, const CushionModelInfo& model,
                 const Vec3& n, Velocities ball);

}  // namespace carom
