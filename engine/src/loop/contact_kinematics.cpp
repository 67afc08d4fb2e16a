#include "loop/contact_kinematics.h"

#include "contact/touch.h"

namespace carom {

ContactKinematics kinematics_of(const Plan& plan, const Balls& balls, int one, int two) {
    const Touch touch = touch_level(balls.at(one), balls.at(two), plan.balls.discs());
    return {{one, With::kBall, two},
            planar(touch.n),
            touch.closing,
            touch.pressing(balls.segment(one).a - balls.segment(two).a)};
}

}  // namespace carom
