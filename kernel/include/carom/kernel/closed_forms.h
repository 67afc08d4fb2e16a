// Impact models with one closed formula.
#pragma once

#include "carom/kernel/impact.h"

namespace carom::kernel {

/// Frictionless exchange with restitution 1; spins unchanged. Ignores mu_b, e_b and the cloth.
void collide_elastic(const Ball& ball1, const Ball& ball2, const ImpactParams& params,
                     ImpactResult& result) noexcept;

/// One impulse with kinematic restitution e_b and Coulomb friction mu_b, limited by the impulse that ends the
/// slip (J_t <= m |slip| / 7). Ignores the cloth. Source: D. Alciatore, Technical Proof A.14, "The effects of
/// cut angle, speed, and spin on object ball throw".
void collide_inelastic(const Ball& ball1, const Ball& ball2, const ImpactParams& params,
                       ImpactResult& result) noexcept;

}  // namespace carom::kernel
