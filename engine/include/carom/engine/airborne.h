// Impacts of balls that fly, bounce or are thrown up. Each impact is instantaneous and involves only two
// bodies. A ball on the cloth that an impact drives downwards hits the cloth next, at the same instant.
// Equations: docs/reference/physics.md, "Balls in the air".
#pragma once

#include <optional>

#include "carom/engine/cushion.h"
#include "carom/engine/motion.h"
#include "carom/engine/scene.h"
#include "carom/engine/vec.h"

namespace carom {

/// [m/s] Slowest rebound that leaves the cloth: sqrt(2 g 0.0045 R). A resting ball sinks in by 0.0045 R:
/// (9/8) (mu_sp/mu_s)^2 R with pool frictions, from the contact radius implied by the pivot friction.
double bounce_end(double R, double gravity);

/// [m/s] Separation speed of a slow contact in the air, and the lower limit of any separation speed there.
double parting_speed(double R, double gravity);

/// Restitution of a contact in the air that closes at v_n [m/s]; nothing if the contact is slow: if even the
/// larger of e and 1/2 would separate it more slowly than `parting`.
std::optional<double> restitution_in_air(double e, double v_n, double parting);

/// Restitution between ball and cloth at the speed V [m/s] towards the cloth.
double cloth_restitution(const BallParams& balls, double V);

/// A ball lands on the cloth: its centre is at height R, and v_z < 0. Coulomb friction opposes its slip and
/// its vertical spin during an impact with restitution, equations (A2) to (A4). Below bounce_end() the
/// rebound is 0.
/// @param balls  mu_s, mu_sp, e_t
void hit_cloth(const BallParams& balls, const MotionParams& motion, Velocities& ball);

/// Two colliding balls, with the friction and restitution that their model reads.
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

/// A contact so slow that bounces would never end: without friction, the balls separate at the
/// parting_speed() of the larger one, equation (A7).
void part_slowly(const FreePair& pair, const Vec3& n, const Lies& lies, double gravity, Velocities& ball1,
                 Velocities& ball2);

/// A flying ball hits a nose, equation (A6).
/// @param n  unit, from the nose to the ball's centre
/// @param parting  [m/s] the least speed at which the ball leaves
/// @return whether the contact is slow
bool hit_nose(const BallParams& balls, double R, const CushionModelInfo& model, const Vec3& n, double parting,
              Velocities& ball);

}  // namespace carom
