// Impacts of balls in the air, and those after which balls leave the cloth.
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "contact/pocket_edge.h"
#include "loop/resolver.h"
#include "physics/nose_reach.h"

namespace carom {

namespace {

// [R] A ball that has flown over a pocket falls into it if it is no higher than this at the far side.
// pooltool's value.
constexpr double kCatchHeight = 1.4;

}  // namespace

/// Whether two balls meet as free bodies: in space, or because the model treats them so.
bool Resolver::is_free(int a, int b) const {
    return plan_.ball_ball->free || balls_.in_space(a, b);
}

/// Begins the motion of a ball after an impact. A ball that lies on the cloth and is pressed down hits the
/// cloth now.
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

/// Continues the fall of a ball into a pocket after a hit in space.
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
    FreePair pair{plan_.sizes[one], plan_.sizes[two], plan_.balls};
    pair.balls.e_b = plan_.e_b();
    if (!plan_.ball_ball->reads_friction || !plan_.in_force(Effect::kThrow))
        pair.balls.mu_b = pair.balls.mu_b_more = 0.0;
    const Vec3 apart = p2.position - p1.position, n = apart / length3(apart);
    Velocities ball1{p1.velocity, balls_.spin(one)}, ball2{p2.velocity, balls_.spin(two)};
    const double v_n = dot3(ball1.v - ball2.v, n);
    if (plan_.clusters != ClusterModel::kSequential && !sinks && cluster(a, b, v_n)) return;
    const double parting = parting_speed(std::max(pair.size1.R, pair.size2.R), plan_.gravity);
    const std::optional<double> e_b = restitution_in_air(pair.balls.e_b, v_n, parting);
    const bool slow = !e_b;
    pair.balls.e_b = e_b.value_or(0.0);
    {
        const Stopwatch watch(kernel_ns_);
        if (slow)
            part_slowly(pair, n, lies(one), lies(two), parting, ball1, ball2);
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
    Vec2 foot;
    double height = 0.0, radius = 0.0;
    if (contact.with == With::kNose) {
        const Nose& nose = plan_.geometry.noses[contact.other];
        foot = nose.center;
        height = nose.height;
        radius = nose.radius;
    } else {
        const CushionLine& line = plan_.geometry.cushions[contact.other];
        foot = line.from + line.direction * dot(line.direction, planar(at.position) - line.from);
        height = line.height;
    }
    const Vec2 out = planar(at.position) - foot;
    const double distance = length(out), level = distance - radius;
    const Vec2 away = distance > 0.0 ? Vec2(out / distance) : Vec2(0.0, 0.0);
    Vec3 n(level * away.x(), level * away.y(), at.position.z() - height);
    n /= length3(n);
    Velocities after{at.velocity, balls_.spin(ball)};
    const bool slow = hit_nose(plan_.balls, balls_.radius(ball), model, n,
                               parting_speed(balls_.radius(ball), plan_.gravity), after);
    if (cost_ != nullptr) cost_->method = model.name;
    log_.event(jaw ? EventType::kBallJaw : EventType::kBallCushion, contact);
    if (slow) log_.mark_slow();
    go_on(ball, at.position, after);
}

/// [m/s] The speed at which a cushion throws up a ball that lay on the cloth.
double Resolver::hop(const TableTouch& touch, const Velocities& before) const {
    const int ball = touch.approach.contact.ball;
    const MotionParams& motion = balls_.motion(ball);
    if (balls_.segment(ball).state == MotionState::kFalling || touch.model->grip == nullptr) return 0.0;
    const double up = motion.R - touch.height, reach = nose_reach(motion.R, touch.height, 0.0);
    const Vec3 n(motion.R / reach * touch.normal.x(), motion.R / reach * touch.normal.y(), up / reach);
    return hop_speed(plan_.balls, motion, *touch.model, n, before);
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
        if (!(length(planar(r) - pockets[k].center) < pockets[k].radius)) continue;
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
