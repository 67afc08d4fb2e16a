#include "loop/resolver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "carom/engine/cushion.h"
#include "contact/resting_constants.h"
#include "contact/touch.h"
#include "physics/cushion/bounce.h"
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
            ball_ball(contact);
            break;
        case With::kCushion:
        case With::kNose:
            cushion(balls_.meet(contact));
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

// A ball so slow that it stops before rounding lets it move cannot hit another one. Stop it now: a cluster
// would preserve its speed, and the same hit would repeat.
// @return whether one of them was such a ball; it rests now
bool Resolver::stop_at_once(const Meeting& met) {
    bool stopped = false;
    for (const int ball : {met.contact.ball, met.contact.other}) {
        const Segment& s = balls_.segment(ball);
        const double left = s.start + s.duration - balls_.now();
        if (s.state != MotionState::kRolling || s.held || !(left <= resting::kStopNoise) ||
            !(met.touch.closing <= resting::kStopNoise * balls_.motion(ball).roll))
            continue;
        Segment after = after_transition(s, balls_.motion(ball));
        after.start = balls_.now();
        log_.event(transition_type(s, after), ball);
        log_.begin(ball, after);
        stopped = true;
    }
    return stopped;
}

void Resolver::ball_ball(const Contact& contact) {
    const int a = contact.ball, b = contact.other;
    if (flights_ && is_free(a, b)) {
        free_balls(a, b);
        return;
    }
    const bool swap = comes_first(balls_.position(b), balls_.position(a));
    const int one = swap ? b : a, two = swap ? a : b;
    const Meeting met = balls_.meet({one, With::kBall, two});
    const Vec3 &r1 = met.ball.r, &r2 = met.other.r;
    if (resting_.try_hold(met, plan_.balls.e_b)) return;
    if (stop_at_once(met)) return;
    if (plan_.clusters != ClusterModel::kSequential && cluster(a, b, met.touch.closing)) return;

    // In the plane, ignoring the height at which one of them began to fall.
    const bool sinks = balls_.sinks(one) || balls_.sinks(two);
    const double up = plan_.sizes[two].R - plan_.sizes[one].R;
    const Vec3 level2(r2.x(), r2.y(), sinks ? r1.z() + up : r2.z());
    const Velocities before1{met.ball.v, balls_.spin(one)}, before2{met.other.v, balls_.spin(two)};
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
        if (cluster(a, b, met.touch.closing, true)) return;
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
    resting_.strike(one, balls_.after_impact(one, r1, ball1));
    resting_.strike(two, balls_.after_impact(two, r2, ball2));
    resting_.go_on();
}

// In a slow cluster, a second contact may also be under pressure. Make it a resting contact: otherwise both
// would bounce, and collide again without end.
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
        Meeting met = balls_.meet({p.ball, With::kBall, q.ball});
        if (when == Pressed::kAfter) met.pressing = pressing(p, q);
        if (met.touch.closing > 0.0 && resting_.try_hold(met, plan_.balls.e_b)) return true;
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
            resting_.strike(ball.ball, balls_.after_impact(ball.ball, ball.r, {ball.v, ball.w}));
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
                             balls_.after_impact(m.ball, end, {m.v, m.w}, duration), other);
        other = m.ball;
        log_.watch(m.ball);
    }
}

void Resolver::end_cluster(int ball) {
    while (balls_.collides(ball)) {
        const int next = balls_.next_in_cluster(ball);
        log_.begin(ball, balls_.afterwards(ball));
        // The cluster may have moved it over a pocket.
        const int over = pocket_around(plan_.geometry, planar(balls_.position(ball)));
        if (over >= 0 && !is_off_cloth(balls_.segment(ball).state)) pocket({ball, With::kPocket, over});
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
        log_.begin(ball, balls_.after_impact(ball, balls_.position(ball), {after.v, after.w}));
        left = true;
    }
    return left;
}

// This contact and all simultaneous ones of its ball with noses: those within kTouchTolerance that close by
// more than rounding and are not resting contacts. Noses that join smoothly count as one.
Resolver::Noses Resolver::noses_with(const Meeting& met) const {
    Noses all;
    all.add(met);
    const BallAt& at = met.ball;
    const double noise = closing_noise(at.R, {at.v, balls_.spin(met.contact.ball)});
    const Box near = box_around(planar(at.r), at.R * (1.0 + kBoxShare) + kTouchTolerance);
    detector_.parts_near(near, [&](const Contact& part) {
        const Contact contact = part.of(met.contact.ball);
        if (!contact.is_nose() || contact == met.contact || !touches_part(plan_.geometry, contact, at))
            return;
        const Meeting another = balls_.meet(contact);
        const auto is_one = [&another](const Meeting& m) {
            return act_as_one(planar(m.touch.n), planar(another.touch.n));
        };
        if (another.touch.closing > noise && !resting_.has(contact) &&
            std::none_of(all.begin(), all.end(), is_one))
            all.add(another);
    });
    // A tree finds the parts in a different order.
    std::sort(all.begin() + 1, all.end(), [](const Meeting& p, const Meeting& q) {
        const Vec3 &m = p.touch.n, &n = q.touch.n;
        return m.x() > n.x() || (m.x() == n.x() && m.y() > n.y());
    });
    return all;
}

void Resolver::cushion(const Meeting& first) {
    if (first.ball.flies) {
        cushion_in_air(first);
        return;
    }
    const int ball = first.contact.ball;
    Noses noses = noses_with(first);
    const double e_c = plan_.balls.e_c;
    bool held = false;
    for (const Meeting& met : noses) held |= resting_.try_begin(met, e_c);
    if (held) {
        resting_.start(ball);
        return;
    }
    Velocities moves{first.ball.v, balls_.spin(ball)};
    std::array<NoseTouch, 4> touches;
    std::transform(noses.begin(), noses.end(), touches.begin(), [this](const Meeting& met) {
        return with_nose(plan_.geometry, met.contact, [&](const auto& nose) {
            return NoseTouch{-planar(met.touch.n), nose.height, &plan_.model_of(nose.partner)};
        });
    });
    const char* const model = touches[0].model->name;
    const MotionParams& motion = balls_.motion(ball);
    const bool hops = flights_ && balls_.segment(ball).state != MotionState::kFalling;
    if (!bounce(plan_.balls, plan_.sizes[ball], {touches.data(), noses.count},
                hops ? std::optional(motion.gravity) : std::nullopt, plan_.impact.tolerance, moves))
        log_.fail(
            fmt::format("the cushion model {} found no solution for the impact of ball {}; use another model",
                        model, log_.id(ball)));
    const Segment after = balls_.after_impact(ball, first.ball.r, moves);
    // A ball that rolls in slowly decelerates before the impact, but its remaining spin drives it back to the
    // cushion and ends the bounce. So the acceleration after the impact decides.
    for (Meeting& met : noses) {
        met.pressing = met.touch.pressing(after.a);
        held |= holds(met.touch.closing, motion.slide, e_c) && resting_.try_begin(met, e_c);
    }
    if (held) {
        resting_.start(ball);
        return;
    }
    if (cost_ != nullptr) cost_->method = model;
    for (const Meeting& met : noses) log_.event(EventPhase::kImpact, met.contact);
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
    log_.event(EventPhase::kTransition, contact);
}

// Whether another ball occupies the position where a ball would leave a pocket, having passed over while the
// ball was sunk.
bool Resolver::is_barred(int ball, const Vec3& place) const {
    const double R = balls_.radius(ball);
    bool barred = false;
    detector_.balls_near(box_around(planar(place), R * (1.0 + kBoxShare)), [&](int other) {
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
    const Meeting met = balls_.meet(contact);
    const Vec3& r = met.ball.r;
    const Vec2 n = planar(met.touch.n);
    const double v_n = met.touch.closing, falls = fall_speed(s, balls_.now() - s.start, motion.gravity);
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
    const Vec2 after = planar(met.ball.v) + (*away - v_n) * n;
    const bool high = sunk < 0.0;  // another ball has thrown it up
    const Vec3 place(edge.x(), edge.y(), high ? motion.R * (1.0 - sunk) : motion.R);
    if (flights_ && is_barred(ball, place)) {
        log_.fall(ball, contact.other);
        return;
    }
    const Vec3 leaves(after.x(), after.y(), high ? -falls : 0.0);
    log_.begin(ball, free_segment(balls_.now(), place, leaves, balls_.spin(ball), motion));
    log_.event(EventPhase::kTransition, contact);
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
