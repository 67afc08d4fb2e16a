// Ball-ball model `mathavan`: friction between the balls and with the cloth, integrated by the kernel.
#include "carom/engine/ball_ball.h"

namespace carom {
namespace {

void mathavan(const BallBallSettings& settings, const kernel::Ball& ball1, const kernel::Ball& ball2,
              const kernel::ImpactParams& params, kernel::ImpactResult& result) {
    if (settings.march != nullptr)
        settings.march(ball1, ball2, params, settings.substeps, result);
    else
        settings.by_tolerance(ball1, ball2, params, settings.tolerance, result);
}

}  // namespace

constinit const BallBallModelInfo kMathavan = {
    .name = "mathavan",
    .source = "Mathavan, Jackson, Parkin, Sports Engineering 17 (2014)",
    .collide = mathavan,
    .reads_friction = true,
    .reads_restitution = true,
    .reads_cloth = true,
    .reads_tolerance = true,
};

}  // namespace carom
