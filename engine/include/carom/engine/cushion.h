// Ball-cushion impact models: one function each, behind one interface.
#pragma once

#include <span>
#include <string_view>

#include "carom/engine/vec.h"

namespace carom {

struct BallParams;
struct BallSize;

/// Input of an impact between one ball and a cushion or jaw.
struct CushionContact {
    double R;       ///< ball radius [m]
    double m;       ///< ball mass [kg]
    double mu_s;    ///< sliding friction, ball on cloth
    double e_c;     ///< restitution
    double f_c;     ///< friction
    double height;  ///< of the nose above the cloth [m], 0 < height < 2 R
    /// [of the approach speed] For models that integrate: physics.tolerance.
    double tolerance = 1e-6;
};

/// Input for a ball with velocity v and spin w: the friction at its slip at the nose, and the restitution at
/// its normal speed (BallParams::f_c_more, e_c_fall), both evaluated once, before the impact.
CushionContact cushion_contact(const BallParams& balls, const BallSize& size, double height,
                               const Vec2& normal, const Vec3& v, const Vec3& w);

/// Restitution at a speed [m/s] along the normal.
double cushion_restitution(const BallParams& balls, double speed);

/// Tangential impulse per mass [m/s] of a flying ball that touches only a nose.
/// @param e, f  restitution and friction
/// @param v_n, slip  [m/s] normal speed, and slip perpendicular to the normal at the nose
using GripFunction = double (*)(double e, double f, double v_n, double slip);

/// Coulomb friction over a whole impact: f (1 + e) v_n, or 2/7 of the slip if that suffices to end it.
double coulomb_grip(double e, double f, double v_n, double slip);

/// Replaces the velocities by those after the impact. v_z is 0 before and after it (planar). A ball that does
/// not approach (v . normal >= 0) is unchanged.
///
/// @param normal  unit, horizontal, from the cushion into the table
/// @return false if the model found no solution within its limit of iterations (only with friction larger
/// than any real cloth's); the velocities are then unchanged
using CushionFunction = bool (*)(const CushionContact& contact, const Vec2& normal, Vec3& v, Vec3& w);

/// One model: its function and its inputs. All models are homogeneous in the velocities and do not read the
/// mass (impulses are per mass). Equations and sources: docs/reference/physics.md, "Cushion impact".
struct CushionModelInfo {
    const char* name;
    const char* source;
    CushionFunction resolve;
    bool reads_friction = false;  ///< f_c, the height of the nose and the spin matter, and the spin changes
    bool reads_cloth = false;     ///< mu_s matters
    /// Without friction, and with the nose level with the centre, the result equals that of `smooth` bit for
    /// bit.
    bool reflects_when_level = false;
    /// Whether the model has a solution for all velocities; null: it does. In mathavan_2010 a ball can jam.
    bool (*accepts)(const CushionContact& contact) = nullptr;
    /// Friction of a ball in the air; null: none.
    GripFunction grip = coulomb_grip;
};

/// Models that other code names directly; for the rest, use cushion_model() and all_of().
extern const CushionModelInfo kHan2005, kMathavan2010, kSmooth;

/// All models, in the order in which messages list them.
std::span<const CushionModelInfo* const> all_of(const CushionModelInfo*);
/// The model of this name, or null.
const CushionModelInfo* cushion_model(std::string_view name);

}  // namespace carom
