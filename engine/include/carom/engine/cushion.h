// Ball-cushion impact models: one function each, behind one interface.
#pragma once

#include <span>

#include "carom/engine/scene.h"
#include "carom/engine/vec.h"

namespace carom {

/// What an impact of one ball with a cushion or jaw reads.
struct CushionContact {
    double R;       ///< ball radius [m]
    double m;       ///< ball mass [kg]
    double mu_s;    ///< sliding friction, ball on cloth
    double e_c;     ///< restitution
    double f_c;     ///< friction
    double height;  ///< of the nose above the cloth [m], 0 < height < 2 R
};

/// Velocities after the impact, in place. v_z is 0 before and afterwards (planar).
///
/// @param normal  unit, horizontal, from the cushion into the table.
/// A ball that does not approach (v . normal >= 0) is left alone.
/// @return false where the model found no solution (mathavan_2010 beyond its bound on steps, which takes
/// frictions that no cloth has); the velocities are then as they came
using CushionFunction = bool (*)(const CushionContact& contact, const Vec2& normal, Vec3& v, Vec3& w);

/// One model: its function and what it looks at. All models are homogeneous in the velocities and do not read
/// the mass (all impulses are per mass).
struct CushionModelInfo {
    CushionModel model;
    const char* name;
    CushionFunction resolve;
    bool reads_spin = false;      ///< the spin before matters, and the spin changes
    bool reads_friction = false;  ///< f_c matters
    bool reads_cloth = false;     ///< mu_s matters
    bool reads_height = false;    ///< the height of the nose matters
    const char* source = "";
};

/// All models, as messages list them; equations and sources in docs/physics.md, "Cushion impact".
std::span<const CushionModelInfo> cushion_models();
const CushionModelInfo& cushion_model(CushionModel model);

/// Shorthand for cushion_model(model).resolve(...).
bool resolve_cushion(CushionModel model, const CushionContact& contact, const Vec2& normal, Vec3& v, Vec3& w);

/// Whether a ball can jam in mathavan_2010. It cannot while the normal velocity falls all along,
/// f_c s + mu_s (s + f_c c) < c with (s, c) sine and cosine of the nose's height angle, and while the cloth
/// cannot hold the ball at any friction of the nose.
bool mathavan_2010_ends(const CushionContact& contact);

}  // namespace carom
