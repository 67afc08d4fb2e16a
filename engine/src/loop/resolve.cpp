// What an event does to its balls.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "carom/engine/cushion.h"
#include "carom/engine/tolerances.h"
#include "loop/shot.h"

namespace carom {

namespace {

// [-] Rounds of the loop in a row that changed directions of sustained contacts but brought no event: as bad.
constexpr int kQuietCap = 1000000;

}  // namespace

void Shot::record_event(EventType type, int a, int b, int detail) {
    record_.events.push_back({now_, type, a, b, detail});
    quiet_ = 0;
}

// Friction of the two at the slip that they have now.
[[gnu::noinline]] double Shot::pair_friction(int one, int two) const {
    const BallParams& p = plan_.balls;
    if (p.mu_b_more == 0.0) return p.mu_b;
    const Vec3 apart = position_now(two) - position_now(one);
    const Vec2 y = Vec2(apart.x(), apart.y()) / length(Vec2(apart.x(), apart.y())), x(y.y(), -y.x());
    const Vec3 v = velocity_now(one) - velocity_now(two), w = spin_now(one) + spin_now(two);
    const double along = x.x() * v.x() + x.y() * v.y() - radius(one) * w.z();
    const double upward = radius(one) * (x.x() * w.x() + x.y() * w.y());
    return ball_friction(p, length(Vec2(along, upward)));
}

// Two balls in touch: how fast they close, and how hard they are driven together.
[[gnu::noinline]] Shot::Nearing Shot::nearing(int one, int two) const {
    const Vec3 r = position_now(two) - position_now(one), v = velocity_now(one) - velocity_now(two);
    const Vec2 apart(r.x(), r.y());
    Nearing pair;
    pair.contact.i = one;
    pair.contact.j = two;
    pair.contact.partner = two;
    const Vec2 n = apart / length(apart);
    pair.contact.n = n;
    pair.v_n = n.x() * v.x() + n.y() * v.y();
    const double v_t = cross(n, Vec2(v.x(), v.y()));
    pair.a_c = n.dot(now_of(one).a - now_of(two).a) - v_t * v_t / contact_distance(radius(one), radius(two));
    return pair;
}

// Whether two balls close so slowly that friction alone might end their bounce before the contact has ended.
[[gnu::noinline]] bool Shot::is_slow(double v_n) const {
    return holds(v_n, 2.0 * plan_.motion.front().slide, plan_.balls.e_b);
}

// How hard two balls would be driven together after an impact: by what ends its bounce. Before it, slow balls
// that roll are braked, and seem to part.
[[gnu::noinline]] double Shot::pressing(const Vec2& n, const Segment& one, const Segment& two) {
    const double v_t = cross(n, Vec2(one.v.x() - two.v.x(), one.v.y() - two.v.y()));
    const Vec3 apart = two.r - one.r;
    return n.dot(one.a - two.a) - v_t * v_t / length(Vec2(apart.x(), apart.y()));
}

template <bool kProfile>
void Shot::resolve_ball_ball(const Candidate& c) {
    // Ball 1 is the one further left, then nearer: relabelling the balls changes no bit.
    const Vec3 ra = position_now(c.a), rb = position_now(c.b);
    const bool swap = rb.x() < ra.x() || (rb.x() == ra.x() && rb.y() < ra.y());
    const int one = swap ? c.b : c.a, two = swap ? c.a : c.b;
    const Vec3 &r1 = swap ? rb : ra, &r2 = swap ? ra : rb;
    const Vec3 v1 = velocity_now(one), v2 = velocity_now(two), w1 = spin_now(one), w2 = spin_now(two);

    const Nearing pair = nearing(one, two);
    if (hold_instead(pair.contact, pair.v_n, pair.a_c, plan_.balls.e_b)) return;
    if (plan_.clusters != ClusterModel::kSequential && resolve_cluster<kProfile>(c, pair.v_n)) return;

    const kernel::Ball b1{{r1.x(), r1.y(), r1.z()}, {v1.x(), v1.y(), v1.z()}, {w1.x(), w1.y(), w1.z()}};
    const kernel::Ball b2{{r2.x(), r2.y(), r2.z()}, {v2.x(), v2.y(), v2.z()}, {w2.x(), w2.y(), w2.z()}};
    const BallParams& p = plan_.balls;
    const Physics& physics = plan_.scene.physics;
    const double mu_s = plan_.in_force(Effect::kClothInImpact) ? p.mu_s : 0.0;
    const BallSize &size1 = plan_.sizes[one], &size2 = plan_.sizes[two];
    const BallBallModelInfo& model = *plan_.ball_ball;
    const kernel::ImpactParams params{.R = size1.R,
                                      .m = size1.m,
                                      .mu_s1 = mu_s,
                                      .mu_s2 = mu_s,
                                      .mu_b = plan_.in_force(Effect::kThrow) ? pair_friction(one, two) : 0.0,
                                      .e_b = model.reads_restitution ? p.e_b : 1.0,
                                      .cloth_slip = physics.cloth_slip == ClothSlipSign::kAsPublished
                                                        ? kernel::ClothSlip::kAsPublished
                                                        : kernel::ClothSlip::kConsistent};
    kernel::ImpactResult result;
    const bool equal = size1 == size2;
    const auto start = kProfile ? Clock::now() : Clock::time_point{};
    if (equal)
        model.collide(plan_.impact, b1, b2, params, result);
    else
        collide_unequal(size1, size2, b1, b2, params, result);
    if constexpr (kProfile) {
        cost_.kernel_ns = nanoseconds(start, Clock::now());
        cost_.steps = result.steps;
        const bool integrated = equal && model.reads_tolerance;
        cost_.method = !integrated                     ? model.name
                       : plan_.impact.march != nullptr ? "march"
                                                       : kernel::name(result.method);
    }
    if (result.steps >= kLongImpact) long_round_ = true;
    const auto id = [this](int ball) { return record_.tracks[ball].id; };
    if (result.status != kernel::ImpactStatus::kOk && result.status != kernel::ImpactStatus::kNotApproaching)
        fail(fmt::format("the impact of {} and {} could not be computed: {}", id(one), id(two),
                         kernel::describe(result.status)));
    const auto vec = [](const double(&x)[3]) { return Vec3(x[0], x[1], x[2]); };
    free_ball(one);
    free_ball(two);
    begin(one, start_segment(now_, r1, vec(result.v1), vec(result.w1), motion_of(one)));
    begin(two, start_segment(now_, r2, vec(result.v2), vec(result.w2), motion_of(two)));
    if (result.status == kernel::ImpactStatus::kOk) record_event(EventType::kBallBall, c.a, c.b);
}

template <bool kProfile>
void Shot::resolve_nose(const Candidate& c) {
    const Vec3 r = position_now(c.a);
    Vec3 v = velocity_now(c.a), w = spin_now(c.a);
    const Vec2 here(r.x(), r.y());
    Vec2 normal;  // into the table
    double height, curving = 0.0;
    if (c.nose >= 0) {
        const Nose& nose = plan_.geometry.noses[c.nose];
        const Vec2 out = here - nose.center;
        normal = out / length(out);
        height = nose.height;
        const double v_t = cross(normal, Vec2(v.x(), v.y()));
        curving = v_t * v_t / (radius(c.a) + nose.radius);
    } else {
        const CushionLine& line = plan_.geometry.cushions[c.b];
        normal = Vec2(-line.direction.y(), line.direction.x());
        if (normal.dot(here - line.from) < 0.0) normal = -normal;
        height = line.height;
    }
    HeldContact contact;
    contact.i = c.a;
    contact.cushion = c.nose >= 0 ? -1 : c.b;
    contact.nose = c.nose;
    contact.jaw = c.type == EventType::kBallJaw;
    contact.partner = c.b;
    contact.n = -normal;
    const double v_n = -(normal.x() * v.x() + normal.y() * v.y());
    const auto pressing = [&](const Vec2& pull) {
        return -(normal.x() * pull.x() + normal.y() * pull.y()) - curving;
    };
    if (hold_instead(contact, v_n, pressing(now_of(c.a).a), plan_.balls.e_c)) return;

    const BallParams& p = plan_.balls;
    const BallSize& size = plan_.sizes[c.a];
    const CushionModelInfo& model = contact.jaw ? *plan_.jaw : *plan_.cushion;
    const CushionContact nose{
        .R = size.R, .m = size.m, .mu_s = p.mu_s, .e_c = p.e_c, .f_c = p.f_c, .height = height};
    if (!model.resolve(nose, normal, v, w))
        fail(fmt::format("the cushion model {} found no solution for the impact of ball {}; use another one",
                         model.name, record_.tracks[c.a].id));
    const Segment after = start_segment(now_, r, v, w, motion_of(c.a));
    // A ball that rolls in slowly is braked; what brings it back, and ends the bounce, is the spin that it keeps.
    if (holds(v_n, motion_of(c.a).slide, p.e_c) && hold_instead(contact, v_n, pressing(after.a), p.e_c))
        return;
    if constexpr (kProfile) cost_.method = model.name;
    free_ball(c.a);
    begin(c.a, after);
    record_event(c.type, c.a, c.b, c.nose);
}

void Shot::resolve_pocket(const Candidate& c) {
    free_ball(c.a);
    begin(c.a, pocketed_segment(now_, plan_.geometry.pockets[c.b]));
    record_.tracks[c.a].pocket = c.b;
    record_event(EventType::kBallPocket, c.a, c.b);
}

void Shot::resolve_transition(const Candidate& c) {
    if (is_held(c.a)) {
        solve_group(c.a, Transitions::kDue);
        return;
    }
    const Segment segment = now_of(c.a), after = after_transition(segment, motion_of(c.a));
    begin(c.a, after);
    record_event(transition_type(segment, after), c.a, -1);
}

template <bool kProfile>
void Shot::apply(const Candidate& c) {
    ++quiet_;
    switch (c.type) {
        case EventType::kBallBall:
            resolve_ball_ball<kProfile>(c);
            break;
        case EventType::kBallCushion:
        case EventType::kBallJaw:
            resolve_nose<kProfile>(c);
            break;
        case EventType::kBallPocket:
            resolve_pocket(c);
            break;
        default:
            resolve_transition(c);
            break;
    }
    guard_cap();
}

template void Shot::apply<false>(const Candidate&);
#ifndef CAROM_WITHOUT_PROFILE
template void Shot::apply<true>(const Candidate&);
#endif

void Shot::guard_cap() const {
    const std::size_t count = record_.events.size(), cap = static_cast<std::size_t>(kEventCap);
    const bool crowded = count > cap && now_ - record_.events[count - 1 - cap].time < kEventCapSpan;
    if (crowded)
        fail(fmt::format("more than {} events within {:g} s of simulated time", kEventCap, kEventCapSpan));
    if (quiet_ > kQuietCap) fail(fmt::format("{} rounds without an event", kQuietCap));
}

void Shot::fail(const std::string& why) const {
    std::string text = fmt::format("simulation stopped at t = {:.17g} s after {} events: {}\n", now_,
                                   record_.events.size(), why);
    const std::size_t count = record_.events.size();
    text += "last events:\n";
    for (std::size_t i = count > 8 ? count - 8 : 0; i < count; ++i) {
        const Event& e = record_.events[i];
        text += fmt::format("  {:.17g} {} {} {}\n", e.time, name(e.type), record_.tracks[e.a].id,
                            record_.partner_id(e));
    }
    text += "balls that move (id state x y vx vy wx wy wz):\n";
    for (int i = 0; i < balls_; ++i) {
        const Segment& s = now_of(i);
        if (s.state == MotionState::kStationary || s.state == MotionState::kPocketed) continue;
        const double tau = std::max(0.0, now_ - s.start);
        const Vec3 r = position_at(s, tau), v = velocity_at(s, tau), w = spin_at(s, tau, radius(i));
        text +=
            fmt::format("  {} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n",
                        record_.tracks[i].id, name(s.state), r.x(), r.y(), v.x(), v.y(), w.x(), w.y(), w.z());
    }
    text.pop_back();  // a message ends without a line end
    throw SimulationError(text);
}

}  // namespace carom
