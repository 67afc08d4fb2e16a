// Impacts of flying balls, and impacts after which balls leave the cloth.
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "contact/pocket_edge.h"
#include "contact/touch.h"
#include "loop/resolver.h"

namespace carom {

namespace {

// [R] A ball that has flown over a pocket falls into it if it is no higher than this at the far side. Value
// of pooltool.
constexpr double kCatchHeight = 1.4;

}  // namespace

/// Whether two balls collide as free bodies: in space, or because the model treats them so.
bool Resolver::is_free(int a, int b) const {
    return plan_.ball_ball->free || balls_.in_space(a, b);
}

/// Begins the motion of a ball after an impact. A ball on the cloth that is pressed down hits the cloth now.
void Resolver::go_on(int ball, const Vec3& r, Velocities after) {
    const MotionParams& motion = balls_.motion(ball);
    const bool lies = !(r.z() > motion.R);
    if (lies && after.v.z() < 0.0 && !balls_.sinks(ball)) {
        hit_cloth(plan_.balls, motion, after);
        log_.event(EventType::kBallCloth, ball);
    }
    begin(ball, r, after.v, after.w);
    log_.watch(ball);
}

/// Continues the fall of a ball into a pocket after a collision in space.
void Resolver::fall_on(int ball, const Vec3& r, const Velocities& after) {
    const MotionParams& motion = balls_.motion(ball);
    const double falls = -after.v.z(), fallen = falls * falls / (2.0 * motion.gravity);
    log_.begin(
        ball, falling_segment(balls_.now(), {r.x(), r.y(), r.z() + fallen}, after.v, after.w, falls, motion));
}

void Resolver::free_balls(int a, int b) {
    // Ball 1 has the smaller x, then y, then z.
    const Placed pa = balls_.placed(a), pb = balls_.placed(b);
    const auto before = [](const Vec3& p, const Vec3& q) {
        if (p.x() != q.x()) return p.x() < q.x();
        return p.y() != q.y() ? p.y() < q.y() : p.z() < q.z();
    };
    const bool swap = before(pb.position, pa.position);
    const int one = swap ? b : a, two = swap ? a : b;
    Placed p1 = swap ? pb : pa, p2 = swap ? pa : pb;
    const bool in_space = balls_.in_space(one, two), sinks = balls_.sinks(one) || balls_.sinks(two);
    if (sinks && !in_space) {
        p1 = {balls_.position(one), balls_.velocity(one)};
        p2 = {balls_.position(two), balls_.velocity(two)};
        p1.position.z() = p2.position.z() = 0.0;
    }
    const auto lies = [&](int ball) {
        return !flies(balls_.segment(ball).state) && !(in_space && balls_.sinks(ball));
    };

    if (lies(one) && lies(two)) {
        const ContactKinematics approach = kinematics_of(plan_, balls_, one, two);
        if (resting_.try_hold(approach, plan_.balls.e_b)) return;
    }
    FreePair pair{plan_.sizes[one], plan_.sizes[two], plan_.ball_ball->friction(plan_.balls), plan_.e_b()};
    const Touch touch =
        touch_ball({p1.position, p1.velocity, pair.size1.R}, {p2.position, p2.velocity, pair.size2.R});
    const Vec3& n = touch.n;
    const double v_n = touch.closing;
    Velocities ball1{p1.velocity, balls_.spin(one)}, ball2{p2.velocity, balls_.spin(two)};
    if (plan_.clusters != ClusterModel::kSequential && !sinks && cluster(a, b, v_n)) return;
    const std::optional<double> e_b =
        restitution_in_air(pair.e_b, v_n, parting_speed(std::max(pair.size1.R, pair.size2.R), plan_.gravity));
    const bool slow = !e_b;
    pair.e_b = e_b.value_or(0.0);
    {
        const Stopwatch watch(kernel_ns_);
        if (slow)
            part_slowly(pair, n, {lies(one), lies(two)}, plan_.gravity, ball1, ball2);
        else
            hit_ball(pair, n, ball1, ball2);
    }
    if (cost_ != nullptr) {
        cost_->steps = 1;
        cost_->method = "free";
    }
    resting_.release(one);
    resting_.release(two);
    log_.event(EventType::kBallBall, a, b);
    if (slow) log_.mark_slow();
    for (const auto& [ball, after] : {std::pair{one, ball1}, std::pair{two, ball2}}) {
        if (in_space && balls_.sinks(ball))
            fall_on(ball, balls_.placed(ball).position, after);
        else
            go_on(ball, lies(ball) ? balls_.position(ball) : balls_.placed(ball).position, after);
    }
}

void Resolver::cushion_in_air(const Contact& contact) {
    const int ball = contact.ball;
    const Placed at = balls_.placed(ball);
    const bool jaw = is_jaw(contact, plan_.geometry);
    const CushionModelInfo& model = jaw ? *plan_.jaw : *plan_.cushion;
    const double R = balls_.radius(ball);
    const Vec3 n = -touch_part(plan_.geometry, contact, BallAt{at.position, at.velocity, R, true}).n;
    Velocities after{at.velocity, balls_.spin(ball)};
    const bool slow = hit_nose(plan_.balls, R, model, n, parting_speed(R, plan_.gravity), after);
    if (cost_ != nullptr) cost_->method = model.name;
    log_.event(jaw ? EventType::kBallJaw : EventType::kBallCushion, contact);
    if (slow) log_.mark_slow();
    go_on(ball, at.position, after);
}

void Resolver::pocket_in_air(const Contact& contact) {
    const double z = balls_.placed(contact.ball).position.z();
    if (z <= kCatchHeight * balls_.radius(contact.ball))
        log_.fall(contact.ball, contact.other);
    else
        leave_table(contact.ball);
}

void Resolver::land(int ball) {
    const Segment& s = balls_.segment(ball);
    const MotionParams& motion = balls_.motion(ball);
    Vec3 r = balls_.position(ball);
    r.z() = motion.R;
    const std::vector<Pocket>& pockets = plan_.geometry.pockets;
    for (std::size_t k = 0; k < pockets.size(); ++k) {
        if (!is_inside(pockets[k], planar(r))) continue;
        log_.fall(ball, static_cast<int>(k));
        return;
    }
    go_on(ball, r, {landing_velocity(s, motion), balls_.spin(ball)});
}

void Resolver::leave_table(int ball) {
    const Placed at = balls_.placed(ball);
    Segment gone =
        airborne_segment(balls_.now(), at.position, at.velocity, balls_.spin(ball), balls_.motion(ball));
    gone.state = MotionState::kOut;
    gone.duration = kNever;
    log_.begin(ball, gone);
    log_.event(EventType::kBallOut, ball);
}

}  // namespace carom
