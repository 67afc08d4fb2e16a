// Impacts with vertical motion: a ball flies, bounces or is thrown up. Each impact is instantaneous and
// involves only the two bodies that meet. If it drives a ball on the cloth downwards, the ball hits the cloth
// next, at the same instant. Equations: docs/reference/physics.md, "Balls in the air".
#pragma once

#include <optional>

#include "carom/engine/cushion.h"
#include "carom/engine/motion.h"
#include "carom/engine/scene.h"
#include "carom/engine/vec.h"

namespace carom {

/// [m/s] The slowest rebound that leaves the cloth: sqrt(2 g 0.0045 R). A resting ball sinks in by 0.0045 R:
/// (9/8) (mu_sp/mu_s)^2 R with the frictions of pool, from the contact radius that the pivot friction
/// implies.
double bounce_end(double R, double gravity);

/// [m/s] The speed at which a slow contact in the air separates, and the least speed at which any does.
double parting_speed(double R, double gravity);

/// The restitution of a contact in the air that closes at v_n [m/s], or none if the contact is slow: with its
/// restitution, or with half of the speed if that is more, it would separate more slowly than at `parting`.
std::optional<double> restitution_in_air(double e, double v_n, double parting);

/// Restitution between ball and cloth at the speed V [m/s] towards the cloth.
double cloth_restitution(const BallParams& balls, double V);

/// A ball lands on the cloth: its centre is at the height R, and v_z < 0. Coulomb friction acts on its slip
/// and on its vertical spin during an impact with restitution, equations (A2) to (A4). Below bounce_end() the
/// rebound is 0.
/// @param balls  mu_s, mu_sp, e_t
void hit_cloth(const BallParams& balls, const MotionParams& motion, Velocities& ball);

/// Two balls that meet, with the friction and restitution that their model reads.
struct FreePair {
    BallSize size1, size2;
    Falling friction;
    double e_b;
};

/// Two free balls: one impulse with friction, equation (A5). Does nothing if they do not approach.
/// @param n  unit, from the centre of ball 1 to that of ball 2
void hit_ball(const FreePair& pair, const Vec3& n, Velocities& ball1, Velocities& ball2);

/// Which of two balls the cloth supports.
struct Lies {
    bool one, two;
};

/// A contact so slow that bounces would never end: no friction, and the balls separate at the parting_speed()
/// of the larger one, equation (A7).
void part_slowly(const FreePair& pair, const Vec3& n, const Lies& lies, double gravity, Velocities& ball1,
                 Velocities& ball2);

/// A ball in the air at a nose, equation (A6).
/// @param n  unit, from the nose to the ball's centre
/// @param parting  [m/s] the least speed at which the ball leaves
/// @return whether the contact is slow
bool hit_nose(const BallParams& balls, double R, const CushionModelInfo& model, const Vec3& n, double parting,
              Velocities& ball);

}  // namespace carom
