// Ball-ball model `elastic`: exchange of the normal velocities.
#include "carom/engine/ball_ball.h"
#include "carom/kernel/closed_forms.h"

namespace carom {
extern constinit const BallBallModelInfo kElastic = {
    .name = "elastic",
    .source = "exchange of the normal velocities",
    .collide = [](const BallBallSettings&, const kernel::Ball& ball1, const kernel::Ball& ball2,
                  const kernel::ImpactParams& params,
                  kernel::ImpactResult& result) { kernel::collide_elastic(ball1, ball2, params, result); },
};

}  // namespace carom
