// Ball-ball model `inelastic`: one frictional impulse, in closed form.
#include "carom/engine/ball_ball.h"
#include "carom/kernel/closed_forms.h"

namespace carom {
extern constinit const BallBallModelInfo kInelastic = {
    .name = "inelastic",
    .source = "D. Alciatore, Technical Proof A.14",
    .collide = [](const BallBallSettings&, const kernel::Ball& ball1, const kernel::Ball& ball2,
                  const kernel::ImpactParams& params,
                  kernel::ImpactResult& result) { kernel::collide_inelastic(ball1, ball2, params, result); },
    .reads_friction = true,
    .reads_restitution = true,
};

}  // namespace carom
