#include "loop/contact_kinematics.h"

#include "contact/touch.h"

namespace carom {

ContactKinematics kinematics_of(const Plan& plan, const Balls& balls, int one, int two) {
    const Touch<Vec3> touch = touch_level(balls.at(one), balls.at(two), plan.balls.discs());
    return {{one, With::kBall, two},
            planar(touch.n),
            touch.closing,
            touch.pressing(balls.segment(one).a - balls.segment(two).a)};
}

double pair_friction(const Plan& plan, const Balls& balls, int one, int two) {
    const BallParams& p = plan.balls;
    if (p.ball_friction().constant()) return p.mu_b;
    const Vec3 apart = balls.position(two) - balls.position(one);
    const Vec2 y = Vec2(apart.x(), apart.y()) / length(Vec2(apart.x(), apart.y())), x(y.y(), -y.x());
    const Vec3 v = balls.velocity(one) - balls.velocity(two), w = balls.spin(one) + balls.spin(two);
    const double along = x.x() * v.x() + x.y() * v.y() - balls.radius(one) * w.z();
    const double upward = balls.radius(one) * (x.x() * w.x() + x.y() * w.y());
    return p.ball_friction()(length(Vec2(along, upward)));
}

}  // namespace carom
