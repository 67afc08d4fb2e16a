#include "loop/resolver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "carom/engine/cushion.h"
#include "contact/pocket_edge.h"
#include "contact/resting_constants.h"
#include "contact/touch.h"
#include "loop/bounce.h"
#include "physics/motion.h"

namespace carom {

namespace {

// [-] An impact with at least this many steps is slow (about 20 us): report progress after it.
constexpr int kLongImpact = 1000;

}  // namespace

Resolver::Resolver(const Plan& plan, const Balls& balls, Log& log, RestingContacts& resting,
                   const Detector& detector, ClustersMemory& memory)
    : plan_(plan),
      flights_(plan.in_force(Effect::kAirborne)),
      balls_(balls),
      log_(log),
      resting_(resting),
      detector_(detector),
      clusters_(plan, balls, detector, memory),
      cost_(log.costs() != nullptr ? &log.costs()->event : nullptr),
      resolve_ns_(cost_ != nullptr ? &cost_->resolve_ns : nullptr),
      kernel_ns_(cost_ != nullptr ? &cost_->kernel_ns : nullptr) {}

void Resolver::resolve(const Contact& contact) {
    const Stopwatch watch(resolve_ns_);
    if (leave_cluster(contact)) return;
    switch (contact.with) {
        case With::kBall:
            ball_ball(contact.ball, contact.other);
            break;
        case With::kCushion:
        case With::kNose:
            cushion(contact);
            break;
        case With::kPocket:
            pocket(contact);
            break;
        case With::kNothing:
            transition(contact.ball);
            break;
        case With::kOut:
            leave_table(contact.ball);
            break;
    }
}

// The motion of a ball after an impact. A falling ball continues to fall.
Segment Resolver::after_impact(double time, int ball, const Vec3& r, const Vec3& v, const Vec3& w) const {
    const Segment& before = balls_.segment(ball);
    const MotionParams& motion = balls_.motion(ball);
    if (before.state != MotionState::kFalling) {
        if (flights_) return free_segment(time, r, v, w, motion);
        return start_segment(time, r, v, w, motion);
    }
    const double falls = fall_speed(before, time - before.start, motion.gravity);
    return falling_segment(time, r, v, w, falls, motion);
}

void Resolver::begin(int ball, const Vec3& r, const Vec3& v, const Vec3& w) {
    log_.begin(ball, after_impact(ball, r, v, w));
}

// A ball that rolls so slowly that it stops before it has moved, by rounding, meets no other ball: as part of
// a cluster it would keep that speed, and meet the same ball again and again.
// @return whether one of them was such a ball; it rests now
bool Resolver::stop_at_once(int one, int two, double v_n) {
    bool stopped = false;
    for (const int ball : {one, two}) {
        const Segment& s = balls_.segment(ball);
        const double left = s.start + s.duration - balls_.now();
        if (s.state != MotionState::kRolling || s.held || !(left <= resting::kStopNoise) ||
            !(v_n <= resting::kStopNoise * balls_.motion(ball).roll))
            continue;
        Segment after = after_transition(s, balls_.motion(ball));
        after.start = balls_.now();
        log_.event(transition_type(s, after), ball);
        log_.begin(ball, after);
        stopped = true;
    }
    return stopped;
}

void Resolver::ball_ball(int a, int b) {
    if (flights_ && is_free(a, b)) {
        free_balls(a, b);
        return;
    }
    const Vec3 ra = balls_.position(a), rb = balls_.position(b);
    const bool swap = comes_first(rb, ra);
    const int one = swap ? b : a, two = swap ? a : b;
    const Vec3 &r1 = swap ? rb : ra, &r2 = swap ? ra : rb;

    const ContactKinematics approach = kinematics_of(plan_, balls_, one, two);
    if (resting_.try_hold(approach, plan_.balls.e_b)) return;
    if (stop_at_once(one, two, approach.v_n)) return;
    if (plan_.clusters != ClusterModel::kSequential && cluster(a, b, approach.v_n)) return;

    // In the plane, ignoring the height at which one of them began to fall.
    const bool sinks = balls_.sinks(one) || balls_.sinks(two);
    const double up = plan_.sizes[two].R - plan_.sizes[one].R;
    const Vec3 level2(r2.x(), r2.y(), sinks ? r1.z() + up : r2.z());
    const Velocities before1{balls_.velocity(one), balls_.spin(one)},
        before2{balls_.velocity(two), balls_.spin(two)};
    Velocities ball1 = before1, ball2 = before2;
    PairImpact impact{};
    const auto hit = [&](bool contact_time) {
        const Stopwatch watch(kernel_ns_);
        ball1 = before1;
        ball2 = before2;
        impact = collide({*plan_.ball_ball, plan_.impact, plan_.balls, contact_time}, plan_.sizes[one],
                         plan_.sizes[two], r1, level2, ball1, ball2);
    };
    hit(plan_.contact_time);
    if (impact.grazes) {
        if (cluster(a, b, approach.v_n, true)) return;
        hit(false);
    }
    if (cost_ != nullptr) {
        cost_->steps = impact.steps;
        cost_->method = impact.method;
    }
    if (impact.steps >= kLongImpact) log_.note_long_round();
    if (impact.status == kernel::ImpactStatus::kOk)
        log_.event(EventType::kBallBall, a, b);
    else if (impact.status != kernel::ImpactStatus::kNotApproaching)
        log_.fail(fmt::format("the impact of {} and {} could not be computed: {}", log_.id(one), log_.id(two),
                              kernel::describe(impact.status)));
    resting_.strike(one, after_impact(one, r1, ball1.v, ball1.w));
    resting_.strike(two, after_impact(two, r2, ball2.v, ball2.w));
    resting_.go_on();
}

// A slow cluster may contain another pressed contact besides the first one. As a resting contact it drives
// that one too; after a common bounce the two would collide again and again.
bool Resolver::hold_in_cluster(Pressed when) {
    // Before an impact, slowly rolling balls decelerate and seem to separate; their motion after it shows
    // whether the bounce ends.
    const auto pressing = [this](const ClusterBall& p, const ClusterBall& q) {
        const auto segment = [this](const ClusterBall& b) {
            return start_segment(balls_.now(), b.r, b.v, b.w, balls_.motion(b.ball));
        };
        const Segment one = segment(p), two = segment(q);
        return touch_level({one.r, one.v, p.R}, {two.r, two.v, q.R}, plan_.balls.discs())
            .pressing(one.a - two.a);
    };
    for (const ClusterContact& c : clusters_.contacts()) {
        const ClusterBall &p = clusters_.balls()[c.i], &q = clusters_.balls()[c.j];
        if (c.gap > 0.0 || resting_.has({p.ball, With::kBall, q.ball})) continue;
        ContactKinematics approach = kinematics_of(plan_, balls_, p.ball, q.ball);
        if (when == Pressed::kAfter) approach.a_c = pressing(p, q);
        if (approach.v_n > 0.0 && resting_.try_hold(approach, plan_.balls.e_b)) return true;
    }
    return false;
}

// @return true if a cluster was resolved, or one of its contacts became a resting contact; false: use the
// pair kernel
bool Resolver::cluster(int a, int b, double v_n, bool pair) {
    const bool parts_slowly =
        !restitution_in_air(plan_.e_b(), v_n, parting_speed(balls_.radius(a), plan_.gravity));
    v_n = clusters_.collect(a, b, v_n, pair);
    if (clusters_.balls().size() < 3 && !pair) return false;
    const bool in_space = clusters_.in_space();
    // Slow contacts of flying balls separate pair by pair, however fast other contacts are: otherwise the
    // cloth would press them together again and again.
    if (in_space && parts_slowly) return false;
    // Whether the balls approach so slowly that friction alone could end the rebound within the Hertz contact
    // time.
    const bool slow = !in_space && holds(v_n, 2.0 * plan_.motion.front().slide, plan_.balls.e_b);
    if (slow && hold_in_cluster(Pressed::kBefore)) return true;
    log_.note_long_round();
    const bool compliant = plan_.clusters == ClusterModel::kCompliant;
    const bool friction = compliant && plan_.in_force(Effect::kThrow) && plan_.ball_ball->reads_friction;
    std::int64_t steps;
    {
        const Stopwatch watch(kernel_ns_);
        steps = clusters_.resolve(v_n, friction, !slow);
    }
    if (cost_ != nullptr) {
        cost_->steps = steps;
        cost_->method = name(plan_.clusters);
    }
    if (slow && hold_in_cluster(Pressed::kAfter)) return true;
    if (pair && !(clusters_.duration() > 0.0)) return false;
    if (clusters_.duration() > 0.0) {
        begin_cluster(a, b);
        return true;
    }
    const std::vector<ClusterBall>& members = clusters_.balls();
    if (in_space)
        for (const ClusterBall& ball : members) resting_.release(ball.ball);
    log_.cluster(a, b, members, clusters_.hits());
    for (const ClusterBall& ball : members) {
        if (in_space)
            go_on(ball.ball, ball.r, {ball.v, ball.w});
        else
            resting_.strike(ball.ball, after_impact(ball.ball, ball.r, ball.v, ball.w));
    }
    if (!in_space) resting_.go_on();
    return true;
}

// Every ball moves straight to its position at the end of the cluster, and freely from there.
void Resolver::begin_cluster(int a, int b) {
    const std::vector<ClusterBall>& members = clusters_.balls();
    for (const ClusterBall& ball : members) resting_.release(ball.ball);
    log_.cluster(a, b, members, clusters_.hits());
    const double now = balls_.now(), duration = clusters_.duration();
    int other = members.front().ball;
    for (std::size_t k = 0; k < members.size(); ++k) {
        const ClusterBall& m = members[k];
        const Vec3& path = clusters_.path(k);
        const Vec3 end = m.r + path;
        log_.begin_colliding(m.ball, colliding_segment(now, m.r, path, m.w, duration),
                             after_impact(now + duration, m.ball, end, m.v, m.w), other);
        other = m.ball;
        log_.watch(m.ball);
    }
}

void Resolver::end_cluster(int ball) {
    while (balls_.collides(ball)) {
        const int next = balls_.next_in_cluster(ball);
        log_.begin(ball, balls_.afterwards(ball));
        // The cluster may have moved it over a pocket.
        const std::vector<Pocket>& pockets = plan_.geometry.pockets;
        for (std::size_t k = 0; k < pockets.size() && !is_off_cloth(balls_.segment(ball).state); ++k)
            if (is_inside(pockets[k], planar(balls_.position(ball))))
                pocket({ball, With::kPocket, static_cast<int>(k)});
        ball = next;
    }
}

// A ball that hits something else during a cluster leaves it, with its velocity after the cluster. The search
// then decides again whether the two collide.
bool Resolver::leave_cluster(const Contact& contact) {
    if (contact.with == With::kNothing) return false;
    bool left = false;
    for (const int ball : {contact.ball, contact.partner()}) {
        if (ball < 0 || !balls_.collides(ball)) continue;
        const Segment& after = balls_.afterwards(ball);
        begin(ball, balls_.position(ball), after.v, after.w);
        left = true;
    }
    return left;
}

void Resolver::cushion(const Contact& contact) {
    const int ball = contact.ball;
    if (flies(balls_.segment(ball).state)) {
        cushion_in_air(contact);
        return;
    }
    TableTouches touches = table_touches(plan_, balls_, detector_, resting_, contact);
    const double e_c = plan_.balls.e_c;
    bool held = false;
    for (const TableTouch& touch : touches) held |= resting_.try_begin(touch.approach, e_c);
    if (held) {
        resting_.start(ball);
        return;
    }
    const Vec3 r = balls_.position(ball);
    Velocities moves{balls_.velocity(ball), balls_.spin(ball)};
    const char* const model = touches[0].model->name;
    const MotionParams& motion = balls_.motion(ball);
    const bool hops = flights_ && balls_.segment(ball).state != MotionState::kFalling;
    if (!bounce(plan_.balls, plan_.sizes[ball], touches.noses(),
                hops ? std::optional(motion.gravity) : std::nullopt, plan_.impact.tolerance, moves))
        log_.fail(
            fmt::format("the cushion model {} found no solution for the impact of ball {}; use another model",
                        model, log_.id(ball)));
    const Segment after = after_impact(ball, r, moves.v, moves.w);
    // A ball that rolls in slowly decelerates before the impact, but its remaining spin drives it back to the
    // cushion and ends the bounce. So the acceleration after the impact decides.
    for (TableTouch& touch : touches) {
        touch.approach.a_c = touch.pressing(after.a);
        held |= holds(touch.approach.v_n, motion.slide, e_c) && resting_.try_begin(touch.approach, e_c);
    }
    if (held) {
        resting_.start(ball);
        return;
    }
    if (cost_ != nullptr) cost_->method = model;
    for (const TableTouch& touch : touches) {
        const Contact& met = touch.approach.contact;
        log_.event(is_jaw(met, plan_.geometry) ? EventType::kBallJaw : EventType::kBallCushion, met);
    }
    resting_.strike(ball, after);
    resting_.go_on();
}

void Resolver::pocket(const Contact& contact) {
    const int ball = contact.ball;
    if (flies(balls_.segment(ball).state)) {
        pocket_in_air(contact);
        return;
    }
    if (balls_.segment(ball).state == MotionState::kFalling) {
        leave_pocket(contact);
        return;
    }
    const MotionParams& motion = balls_.motion(ball);
    resting_.release(ball);
    if (plan_.scene.physics.pocket == PocketModel::kAtOnce || motion.gravity == 0.0) {
        log_.fall(ball, contact.other);
        return;
    }
    log_.begin(ball, falling_segment(balls_.now(), balls_.position(ball), balls_.velocity(ball),
                                     balls_.spin(ball), 0.0, motion));
    log_.event(EventType::kBallEdge, contact);
}

// Whether another ball occupies the position where a ball would leave a pocket, having passed over while the
// ball was sunk.
bool Resolver::is_barred(int ball, const Vec3& place) const {
    const double R = balls_.radius(ball), reach = R * (1.0 + kBoxShare);
    bool barred = false;
    detector_.balls_near({place.x() - reach, place.y() - reach, place.x() + reach, place.y() + reach},
                         [&](int other) {
                             const double apart = length3(balls_.placed(other).position - place);
                             barred |= other != ball && !is_gone(balls_.segment(other).state) &&
                                       apart < R + balls_.radius(other) - kTouchTolerance;
                         });
    return barred;
}

// A falling ball reaches the edge from inside.
void Resolver::leave_pocket(const Contact& contact) {
    const int ball = contact.ball;
    const Pocket& pocket = plan_.geometry.pockets[contact.other];
    const Segment& s = balls_.segment(ball);
    const MotionParams& motion = balls_.motion(ball);
    const Vec3 r = balls_.position(ball), v = balls_.velocity(ball);
    const Vec2 out = planar(r) - pocket.center, n = out / length(out);
    const double v_n = dot(n, planar(v)), falls = fall_speed(s, balls_.now() - s.start, motion.gravity);
    // The fall began at the height of a ball on the cloth, unless another ball has hit this one since.
    const double sunk = falls * falls / (2.0 * motion.gravity * motion.R) - (r.z() - motion.R) / motion.R;
    const auto away = climbs(v_n, std::max(0.0, sunk), motion.R, motion.gravity);
    if (!away || !is_bed(plan_.scene.table, pocket, planar(r), motion.R)) {
        log_.fall(ball, contact.other);
        return;
    }
    // Beyond the edge by a few roundings of the coordinates; inside, it would fall again at once.
    const double rounding =
        0x1p-50 * (pocket.radius + std::abs(pocket.center.x()) + std::abs(pocket.center.y()));
    const Vec2 edge = pocket.center + (pocket.radius + rounding) * n;
    const Vec2 after = planar(v) + (*away - v_n) * n;
    const bool high = sunk < 0.0;  // another ball has thrown it up
    const Vec3 place(edge.x(), edge.y(), high ? motion.R * (1.0 - sunk) : motion.R);
    if (flights_ && is_barred(ball, place)) {
        log_.fall(ball, contact.other);
        return;
    }
    const Vec3 leaves(after.x(), after.y(), high ? -falls : 0.0);
    log_.begin(ball, high ? airborne_segment(balls_.now(), place, leaves, balls_.spin(ball), motion)
                          : start_segment(balls_.now(), place, leaves, balls_.spin(ball), motion));
    log_.event(EventType::kBallEdge, contact);
}

void Resolver::transition(int ball) {
    const Segment& segment = balls_.segment(ball);
    if (segment.state == MotionState::kFalling) {
        log_.fall(ball, pocket_under(plan_.geometry, planar(balls_.position(ball))));
        return;
    }
    if (segment.held) {
        resting_.advance(ball);
        return;
    }
    if (segment.state == MotionState::kColliding) {
        end_cluster(ball);
        return;
    }
    if (flies(segment.state)) {
        land(ball);
        return;
    }
    const Segment after = after_transition(segment, balls_.motion(ball));
    log_.event(transition_type(segment, after), ball);
    log_.begin(ball, after);
}

}  // namespace carom
