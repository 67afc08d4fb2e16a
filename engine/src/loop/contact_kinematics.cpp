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

}  // namespace carom
