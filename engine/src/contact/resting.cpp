#include "contact/resting.h"

#include <algorithm>
#include <cmath>

#include "carom/engine/ball_ball.h"
#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "contact/resting_group.h"
#include "contact/touch.h"
#include "physics/motion.h"

namespace carom {

namespace resting {

namespace {

void read(Group& g, std::size_t k) {
    RestingBall& ball = g.group.balls[k];
    Body& b = g.bodies[k];
    const Segment s = start_segment(g.now, ball.r, ball.v, ball.w, *ball.motion);
    b.R = ball.motion->R;
    b.ease = 1.0 / ball.mass;
    ball.v = s.v;
    ball.w = s.w;  // exactly the spin of rolling
    b.v = planar(s.v);
    b.s = b.R * Vec2(s.w.y(), -s.w.x());
    b.u = s.state == MotionState::kSliding ? Vec2(b.v - b.s) : Vec2(Vec2::Zero());
    if (length(b.v) > g.noise || length(b.u) > g.noise) return;
    b.v = b.s = b.u = Vec2::Zero();
    ball.v = Vec3::Zero();
    ball.w.x() = ball.w.y() = 0.0;
}

void make_bodies(Group& g) {
    for (const RestingBall& ball : g.group.balls)
        g.noise = std::max(g.noise, resting_noise(ball.v, ball.w, *ball.motion));
    g.bodies.resize(g.group.balls.size());
    for (std::size_t k = 0; k < g.bodies.size(); ++k) read(g, k);
}

Link link_of(const Group& g, const RestingContact& c) {
    const auto body_of = [&](int ball) {
        const auto is_it = [ball](const RestingBall& b) { return b.ball == ball; };
        return static_cast<int>(std::find_if(g.group.balls.begin(), g.group.balls.end(), is_it) -
                                g.group.balls.begin());
    };
    const auto at = [&](int body) { return BallAt{g.group.balls[body].r, Vec3::Zero(), g.bodies[body].R}; };
    const bool discs = g.around.balls.discs();
    Link link{.i = body_of(c.contact.ball), .j = -1, .first = c.n, .n = c.n, .contact = c.contact};
    const BallAt ball = at(link.i);
    if (c.contact.with == With::kBall) {
        link.j = body_of(c.contact.other);
        const BallAt other = at(link.j);
        link.distance = contact_distance(ball.R, other.R, discs);
        link.tilt = discs ? 0.0 : (other.R - ball.R) / link.distance;
        link.gap = touch_level(ball, other, discs).gap;
    } else {
        link.distance = with_nose(g.around.geometry, c.contact,
                                  [&ball](const auto& nose) { return turn_around(nose, ball.R); });
        link.gap = touch_part(g.around.geometry, c.contact, ball).gap;
    }
    link.begins = c.began == g.now;
    return link;
}

// Makes the velocities after impulses at an instant the present ones.
void accept(Group& g) {
    const double gone = std::max(g.noise, 3.5 * g.motion.slide * kStopNoise);
    for (Body& b : g.bodies)
        if (b.impulses > 0.0 && !(length(b.slip_end()) > gone)) b.s_end = b.v_end;
    const bool all = keep_energy(g, 0.0);
    for (std::size_t k = 0; k < g.bodies.size(); ++k) {
        const Body& b = g.bodies[k];
        RestingBall& ball = g.group.balls[k];
        if (!all && !(b.impulses > 0.0)) continue;
        ball.v = Vec3(b.v_end.x(), b.v_end.y(), 0.0);
        ball.w.x() = -b.s_end.y() / b.R;
        ball.w.y() = b.s_end.x() / b.R;
        read(g, k);
    }
}

// A contact that opens so slowly that friction alone could close it again within the duration of a contact
// continues until its gap is noticeable.
void mark_open(Group& g) {
    for (Link& link : g.links) {
        const double rate = gap_rate(g, link), e = link.j >= 0 ? g.around.balls.e_b : g.around.balls.e_c;
        // A wall around a ball turns it, and so presses it.
        const double across = link.distance < 0.0 ? cross(link.first, g.bodies[link.i].v) : 0.0,
                     turns = across != 0.0 ? across * across / -link.distance : 0.0;
        const bool stays =
            link.begins || (link.gap < kGapLeft && holds(rate, 2.0 * g.motion.slide + turns, e));
        link.open = rate > g.noise && !stays;
    }
}

// [m/s] The fastest closing speed, by gap_rate() or end_rate().
template <class Rate>
double closing_speed(const Group& g, const Rate& rate) {
    double fastest = 0.0;
    for (const Link& link : g.links) fastest = std::max(fastest, -rate(g, link));
    return fastest;
}

// In flat wedges rounding can prevent a solution; a state with much lower closing speeds is then accepted. A
// contact with a gap may close slowly: the interval ends that.
void remove_closing_speeds(Group& g) {
    double fastest = 0.0;
    for (const Body& b : g.bodies) fastest = std::max(fastest, length(b.v));
    const double time = std::max(kShortestInterval, kSlackTime * g.group.last);
    for (Link& link : g.links) link.slack = !link.begins ? std::max(0.0, link.gap) / time : 0.0;
    const auto at_start = [](const Group& all, const Link& link) { return gap_rate(all, link) + link.slack; };
    const auto at_end = [](const Group& all, const Link& link) { return end_rate(all, link) + link.slack; };
    const double before = closing_speed(g, at_start);
    if (before > kClosingUlp * kEpsilon * fastest &&
        (strike(g) || closing_speed(g, at_end) < kNearer * before))
        accept(g);
    mark_open(g);
}

// A contact ends once its gap opens by more than rounding, but never at the instant at which it began;
// otherwise it could begin and end forever. A contact without force that does not open (resting balls, equal
// rolling) stays.
void mark_released(Group& g) {
    for (std::size_t c = 0; c < g.links.size(); ++c) g.group.contacts[c].released = g.links[c].open;
}

void solve(Group& g) {
    make_bodies(g);
    for (const RestingContact& c : g.group.contacts) g.links.push_back(link_of(g, c));
    remove_closing_speeds(g);
    solve_interval(g);
    mark_released(g);
}

}  // namespace

// Spurious energy arises from slips that count as zero, from gaps that open within their allowed range under
// an impulse, and in a flat wedge from the rounding of impulses a million times larger than the speeds. All
// motions are scaled equally, so that rates and slips of zero stay zero.
bool keep_energy(Group& g, double h) {
    double before = 0.0, after = 0.0;
    for (const Body& b : g.bodies) {
        before += kinetic_energy(b.v, b.s, 1.0) / b.ease;
        after += kinetic_energy(b.v_end, b.s_end, 1.0) / b.ease;
    }
    if (!(after > before)) return false;
    // Speeds that move no ball within the interval would stay for ever, because places are rounded.
    const bool rest = h > 0.0 && before > 0.0 && std::all_of(g.bodies.begin(), g.bodies.end(), [h](auto& b) {
                          return h * length(b.v) <= kNoGap && !moves(b.u);
                      });
    const double share = rest ? 0.0 : std::sqrt(before / after);
    for (Body& b : g.bodies) {
        b.v_end *= share;
        b.s_end *= share;
        if (rest) b.mode = Mode::kResting;
    }
    return true;
}

Vec2 relative(const Group& g, const Link& link, Vec2 Body::*velocity) {
    const Vec2 own = g.bodies[link.i].*velocity;
    return link.j >= 0 ? Vec2(g.bodies[link.j].*velocity - own) : Vec2(-own);
}

double gap_rate(const Group& g, const Link& link) {
    return dot(link.first, relative(g, link, &Body::v));
}

double end_rate(const Group& g, const Link& link) {
    return dot(link.n, relative(g, link, &Body::v_end));
}

GapCourse::GapCourse(const Group& g, const Link& link, double h)
    : gap_(link.gap),
      round_(link.distance == 0.0 ? 0.0 : std::copysign(1.0, link.distance)),
      far_(std::abs(link.distance + link.gap)),
      from_(round_ == 0.0 ? link.first : Vec2((link.distance + link.gap) * link.first)),
      v_(relative(g, link, &Body::v)),
      half_a_((0.5 / h) * (relative(g, link, &Body::v_end) - v_)) {}

// The squared distance has its extrema at the same times.
GapCourse::Range GapCourse::range(double h) const {
    const double round = std::abs(round_);
    const double c[5] = {0.0, 2.0 * dot(from_, v_), round * dot(v_, v_) + 2.0 * dot(from_, half_a_),
                         round * 2.0 * dot(v_, half_a_), round * dot(half_a_, half_a_)};
    double times[3];
    const int count = extrema(c, h, times);
    Range range = std::minmax(gap_, at(h));
    for (int k = 0; k < count; ++k)
        range = {std::min(range.first, at(times[k])), std::max(range.second, at(times[k]))};
    return range;
}

Vec2 contact_slip(const Group& g, const Link& link, bool at_end) {
    const Body &bi = g.bodies[link.i], &bj = g.bodies[link.j];
    const Vec2 t(link.n.y(), -link.n.x());
    const double wi = g.group.balls[link.i].w.z(), wj = g.group.balls[link.j].w.z();
    const double spin = bi.R == bj.R ? bi.R * (wi + wj) : bi.R * wi + bj.R * wj;
    if (at_end) return {-dot(bi.s_end + bj.s_end, link.n), dot(bi.v_end - bj.v_end, t) - spin};
    return {-dot(bi.s + bj.s, link.n), dot(bi.v - bj.v, t) - spin};
}

}  // namespace resting

bool holds(double v_n, double a_c, double restitution) {
    if (!(a_c > 0.0)) return false;
    const double x =
        2.0 * std::max(restitution, resting::kLeastRestitution) * v_n / a_c;  // duration of the rebound
    const double x2 = x * x, f2 = kContactTimeFactor * kContactTimeFactor;
    return x2 * x2 * x * v_n <= f2 * f2 * kContactTimeFactor / (kContactStiffness * kContactStiffness);
}

double resting_noise(const Vec3& v, const Vec3& w, const MotionParams& motion) {
    const double speed = length(planar(v)), spin = length(Vec2(length(planar(w)), w.z()));
    // Without rolling friction nothing stops such a ball, so sliding friction sets the scale.
    return std::max(
        motion.roll > 0.0 ? resting::kStopNoise * motion.roll : resting::kSlideNoise * motion.slide,
        8.0 * kClosingUlp * kEpsilon * (speed + motion.R * spin));
}

void solve_resting(RestingGroup& group, const RestingSurroundings& around, double now) {
    resting::Group g{group, around, *group.balls.front().motion, now};
    resting::solve(g);
}

void end_transition(RestingBall& member, MotionState state, double R) {
    switch (state) {
        case MotionState::kSliding: {
            const Vec2 u = cloth_slip(member.v, member.w, R);
            if (!member.motion->rolls) {
                member.v = Vec3::Zero();
                break;
            }
            member.v.x() -= u.x() * (2.0 / 7.0);
            member.v.y() -= u.y() * (2.0 / 7.0);
            member.w.x() = -member.v.y() / R;
            member.w.y() = member.v.x() / R;
            break;
        }
        case MotionState::kRolling:
            member.v = Vec3::Zero();
            member.w.x() = member.w.y() = 0.0;
            break;
        case MotionState::kSpinning:
            member.w.z() = 0.0;
            break;
        case MotionState::kStationary:
        case MotionState::kPocketed:
        case MotionState::kFalling:
        case MotionState::kAirborne:
        case MotionState::kOut:
        case MotionState::kColliding:
            break;
    }
}

}  // namespace carom
