// Ball-ball model `two_step`: the free impact of two balls, then that of the cloth on those that it presses
// down (physics/airborne.h). If no ball can leave the cloth, it is the planar impact of balls without
// friction or of equal height.
#include "carom/engine/ball_ball.h"
#include "carom/kernel/closed_forms.h"

namespace carom {
extern constinit const BallBallModelInfo kTwoStep = {
    .name = "two_step",
    .source = "A. Domenech, Int. J. Mech. Sci. 50 (2008): ball on ball, then ball on cloth",
    .collide = [](const BallBallSettings&, const kernel::Ball& ball1, const kernel::Ball& ball2,
                  const kernel::ImpactParams& params,
                  kernel::ImpactResult& result) { kernel::collide_inelastic(ball1, ball2, params, result); },
    .reads_friction = true,
    .reads_restitution = true,
    .free = true,
};

}  // namespace carom
