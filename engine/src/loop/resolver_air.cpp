// Impacts of flying balls, and impacts after which balls leave the cloth.
#include <algorithm>
#include <optional>
#include <utility>

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
    log_.begin(ball, balls_.after_impact(ball, r, after));
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
    const bool swap = comes_first(balls_.placed(b).position, balls_.placed(a).position);
    const int one = swap ? b : a, two = swap ? a : b;
    const bool in_space = balls_.in_space(one, two), sinks = balls_.sinks(one) || balls_.sinks(two);
    const auto at = [&](int ball) {
        const Placed there = balls_.placed(ball);
        if (!sinks || in_space) return BallAt{there.position, there.velocity, balls_.radius(ball)};
        BallAt level = balls_.at(ball);
        level.r.z() = 0.0;
        return level;
    };
    const BallAt p1 = at(one), p2 = at(two);
    const auto lies = [&](int ball) {
        return !flies(balls_.segment(ball).state) && !(in_space && balls_.sinks(ball));
    };

    if (lies(one) && lies(two) && resting_.try_hold(balls_.meet({one, With::kBall, two}), plan_.balls.e_b))
        return;
    FreePair pair{plan_.sizes[one], plan_.sizes[two], plan_.ball_ball->friction(plan_.balls), plan_.e_b()};
    const Touch touch = touch_ball(p1, p2);
    const Vec3& n = touch.n;
    const double v_n = touch.closing;
    Velocities ball1{p1.v, balls_.spin(one)}, ball2{p2.v, balls_.spin(two)};
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

void Resolver::cushion_in_air(const Meeting& met) {
    const int ball = met.contact.ball;
    const CushionModelInfo& model = plan_.model_of(partner_of(met.contact, plan_.geometry));
    Velocities after{met.ball.v, balls_.spin(ball)};
    const double R = met.ball.R;
    const bool slow = hit_nose(plan_.balls, R, model, -met.touch.n, parting_speed(R, plan_.gravity), after);
    if (cost_ != nullptr) cost_->method = model.name;
    log_.event(EventPhase::kImpact, met.contact);
    if (slow) log_.mark_slow();
    go_on(ball, met.ball.r, after);
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
    const int pocket = pocket_around(plan_.geometry, planar(r));
    if (pocket >= 0)
        log_.fall(ball, pocket);
    else
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
