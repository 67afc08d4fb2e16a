// Ball-cushion impact models.
#pragma once

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
    double height;  ///< of the nose above the cloth [m]
};

/// Velocities after the impact, in place. v_z is 0 afterwards (planar).
///
/// @param normal  unit, horizontal, from the cushion into the table.
/// A ball that does not approach (v . normal >= 0) is left alone.
/// Equations: docs/physics.md, "Cushion impact".
void resolve_cushion(CushionModel model, const CushionContact& contact, const Vec2& normal, Vec3& v, Vec3& w);

}  // namespace carom
