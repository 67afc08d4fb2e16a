// Contacts of balls with each other.
#include <algorithm>
#include <cmath>

#include "loop/detector.h"

namespace carom {

namespace {

// Smallest and largest value of r + v t + a t^2 / 2 on [0, T], widened by `margin`.
void extend(double r, double v, double a, double T, double margin, double& low, double& high) {
    low = high = r;
    if (v != 0.0 || a != 0.0) {
        if (!(T < kNever)) {  // for ever, and then there is no telling
            low = -kNever;
            high = kNever;
            return;
        }
        const auto take = [&](double t) {
            const double x = r + t * (v + 0.5 * t * a);
            low = std::min(low, x);
            high = std::max(high, x);
        };
        take(T);
        const double turn = a != 0.0 ? -v / a : -1.0;
        if (turn > 0.0 && turn < T) take(turn);
    }
    low -= margin;
    high += margin;
}

}  // namespace

// Where the ball's surface can be from the time `from` until `duration` later; the share keeps rounding inside.
Box Detector::swept(int ball, double from, double duration) const {
    const Segment& s = balls_.segment(ball);
    const Vec3 r = position_at(s, from - s.start), v = velocity_at(s, from - s.start);
    const double R = balls_.radius(ball),
                 margin = R * (1.0 + kBoxShare) + kBoxShare * (std::abs(r.x()) + std::abs(r.y()));
    Box box{};
    extend(r.x(), v.x(), s.a.x(), duration, margin, box.low_x, box.high_x);
    extend(r.y(), v.y(), s.a.y(), duration, margin, box.low_y, box.high_y);
    return box;
}

// The box of a ball from the time `from` until its own transition or contact with the table, or until it has gone
// as far as its box is to cover.
void Detector::bound(int ball, double from) {
    Mover& mover = mover_[ball];
    const Segment& s = balls_.segment(ball);
    mover.until = std::min(mover.own, mover.table.time);
    mover.refresh = kNever;
    if (mover.travel < kNever && translates(s.state)) {
        const Vec3 v = velocity_at(s, from - s.start);
        const double speed = length(Vec2(v.x(), v.y())), pull = length(s.a);
        const double end =
            std::max(from, balls_.now()) +
            2.0 * mover.travel / (speed + std::sqrt(speed * speed + 2.0 * pull * mover.travel));
        if (end < mover.until) mover.until = mover.refresh = end;
    }
    ball_boxes_.place(ball, swept(ball, from, mover.until - from));
}

// First contact of two balls, unless it comes later than `latest` or than what either does next: their contacts are
// searched again then. `mine` is the path of ball a from the start of its segment.
Candidate Detector::pair(int a, const Path& mine, int b, double latest) const {
    const Segment &s = balls_.segment(a), &q = balls_.segment(b);
    if (!mine.moves && !translates(q.state)) return {};
    const double from = std::max(s.start, q.start);
    const double until = std::min(std::min(mover_[a].until, mover_[b].until), latest);
    const Path one = from == s.start ? mine : path(a, from), two = path(b, from);
    const double reach = contact_distance(balls_.radius(a), balls_.radius(b));
    if (stays_apart(two.r - one.r, two.v - one.v, two.a - one.a, reach, span(from, until))) return {};
    const double t = time_to_ball(one, two, reach);
    return {from + t, {std::min(a, b), With::kBall, std::max(a, b)}};
}

void Detector::offer(int ball, int partner, Candidate c) {
    Candidate& mine = mover_[ball].pair;
    if (!before(c, mine)) return;
    mine = c;
    mine.stamp = mover_[partner].stamp;
    mark_changed(ball);
}

// All contacts of one ball, each offered to both.
void Detector::search_pairs(int ball) {
    ball_boxes_.settle();
    const Path mine = path(ball, balls_.segment(ball).start);
    ball_boxes_.neighbours(ball, [this, ball, &mine](int other) {
        // Of two new balls the first one has done it.
        if (mover_[other].round == round_ && other < ball) return;
        if (resting_.has({ball, With::kBall, other})) return;
        const double latest = std::max(mover_[ball].pair.time, mover_[other].pair.time);
        const Candidate c = pair(ball, mine, other, latest);
        if (c.time == kNever) return;
        offer(ball, other, c);
        offer(other, ball, c);
    });
}

// A bound on the speed of every ball that the search for clusters asks for: speeds are largest at an end of a
// segment. It only grows, for it is no more than a bound; nothing that is computed depends on it.
void Detector::bound_speed(const Segment& s) {
    fastest_ = std::max(fastest_, length(planar(s.v)));
    if (s.a == Vec2::Zero()) return;
    fastest_ = std::max(fastest_, s.duration < kNever ? length(planar(velocity_at(s, s.duration))) : kNever);
}

// Without an event: the ball's box has expired, or the contact that it was waiting for does not come.
void Detector::search_again(int ball) {
    const Stopwatch watch(search_ns_);
    Mover& mover = mover_[ball];
    ++round_;
    const double refresh = mover.refresh;
    const bool expired = refresh <= key_[ball];
    mover.pair = {};
    if (expired) {
        // Twice the way each time: a ball that meets nobody for ever is asked a finite number of times.
        mover.travel *= 2.0;
        bound(ball, refresh);
    }
    search_pairs(ball);
    mark_changed(ball);
}

}  // namespace carom
