// Ball-cushion impact models: one function each, behind one interface.
#pragma once

#include <span>
#include <string_view>

#include "carom/engine/vec.h"

namespace carom {

struct BallParams;
struct BallSize;

/// What an impact of one ball with a cushion or jaw reads.
struct CushionContact {
    double R;       ///< ball radius [m]
    double m;       ///< ball mass [kg]
    double mu_s;    ///< sliding friction, ball on cloth
    double e_c;     ///< restitution
    double f_c;     ///< friction
    double height;  ///< of the nose above the cloth [m], 0 < height < 2 R
};

/// What an impact of a ball that comes with v and w reads: the friction is that
/// of its slip at the nose, and the restitution that of its speed along the
/// normal (BallParams::f_c_more, e_c_fall), both taken once, before the impact.
CushionContact cushion_contact(const BallParams& balls, const BallSize& size, double height,
                               const Vec2& normal, const Vec3& v, const Vec3& w);

/// The restitution at a speed [m/s] along the normal.
double cushion_restitution(const BallParams& balls, double speed);

/// Tangential impulse per mass [m/s] of a ball in the air at a nose, where nothing but the nose acts on it.
/// @param e, f  restitution and friction
/// @param v_n, slip  [m/s] speed along the normal, and at right angles to it at the nose
using GripFunction = double (*)(double e, double f, double v_n, double slip);

/// Coulomb's friction of a whole impact, f (1 + e) v_n, or what ends the slip (2/7 of it).
double coulomb_grip(double e, double f, double v_n, double slip);

/// Velocities after the impact, in place. v_z is 0 before and afterwards (planar).
///
/// @param normal  unit, horizontal, from the cushion into the table.
/// A ball that does not approach (v . normal >= 0) is left alone.
/// @return false where the model found no solution (an iteration beyond its bound on steps, which takes
/// frictions that no cloth has); the velocities are then as they came
using CushionFunction = bool (*)(const CushionContact& contact, const Vec2& normal, Vec3& v, Vec3& w);

/// One model: its function and what it looks at. All models are homogeneous in the velocities and do not read
/// the mass (all impulses are per mass). Equations and sources: docs/reference/physics.md, "Cushion impact".
struct CushionModelInfo {
    const char* name;
    const char* source;
    CushionFunction resolve;
    bool reads_friction = false;  ///< f_c, the height of the nose and the spin matter, and the spin changes
    bool reads_cloth = false;     ///< mu_s matters
    /// Without friction, and with the nose at the height of the centre, the result has the bits of `smooth`.
    bool reflects_when_level = false;
    /// Whether the model has a solution for all velocities; null:
    /// for every contact. In mathavan_2010 a ball can jam.
    bool (*accepts)(const CushionContact& contact) = nullptr;
    /// Friction of a ball in the air; null: none.
    GripFunction grip = coulomb_grip;
};

/// The models that others refer to; cushion_model("stronge") and all_of() find the rest.
extern const CushionModelInfo kHan2005, kMathavan2010, kSmooth;

/// All models, as messages list them.
std::span<const CushionModelInfo* const> all_of(const CushionModelInfo*);
/// The model of this name, or null.
const CushionModelInfo* cushion_model(std::string_view name);

}  // namespace carom
