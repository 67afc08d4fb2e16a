// Whether anything in a plan dissipates energy.
#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/plan.h"

namespace carom {

bool loses_nothing(const Plan& plan) {
    for (const Effect effect : {Effect::kSliding, Effect::kRolling, Effect::kSpinDecay, Effect::kThrow,
                                Effect::kClothInImpact, Effect::kPockets, Effect::kAirborne})
        if (plan.in_force(effect)) return false;
    const BallParams& p = plan.balls;
    const bool balls = !plan.pairs || !plan.ball_ball->reads_restitution || p.e_b == 1.0;
    const bool smooth = plan.cushion == &kSmooth && plan.jaw == &kSmooth;
    const bool cushions = !plan.in_force(Effect::kCushions) || (smooth && p.e_c == 1.0 && p.e_c_fall == 0.0);
    return balls && cushions;
}

}  // namespace carom
