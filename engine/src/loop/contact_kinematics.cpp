#include "loop/contact_kinematics.h"

namespace carom {

ContactKinematics kinematics_of(const Plan& plan, const Balls& balls, int one, int two) {
    const Vec3 r = balls.position(two) - balls.position(one), v = balls.velocity(one) - balls.velocity(two);
    const Vec2 apart(r.x(), r.y());
    const Vec2 n = apart / length(apart);
    const double v_t = cross(n, Vec2(v.x(), v.y()));
    return {.contact = {one, With::kBall, two},
            .n = n,
            .v_n = n.x() * v.x() + n.y() * v.y(),
            .a_c = dot(n, balls.segment(one).a - balls.segment(two).a) -
                   v_t * v_t / contact_distance(balls.radius(one), balls.radius(two), plan.balls.discs())};
}

double closing_acceleration(const Vec2& n, const Segment& one, const Segment& two) {
    const double v_t = cross(n, Vec2(one.v.x() - two.v.x(), one.v.y() - two.v.y()));
    const Vec3 apart = two.r - one.r;
    return dot(n, one.a - two.a) - v_t * v_t / length(Vec2(apart.x(), apart.y()));
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
