// Contacts of balls: what an event touched is looked at anew.
#include <algorithm>
#include <cmath>

#include "loop/shot.h"

namespace carom {

namespace {

bool in_play(const Segment& segment) {
    return segment.state != MotionState::kPocketed;
}

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
Box Shot::swept(int ball, double from, double duration) const {
    const Segment& s = now_of(ball);
    const Vec3 r = position_at(s, from - s.start), v = velocity_at(s, from - s.start);
    const double R = radius(ball),
                 margin = R * (1.0 + kBoxShare) + kBoxShare * (std::abs(r.x()) + std::abs(r.y()));
    Box box{};
    extend(r.x(), v.x(), s.a.x(), duration, margin, box.low_x, box.high_x);
    extend(r.y(), v.y(), s.a.y(), duration, margin, box.low_y, box.high_y);
    return box;
}

// The box of a ball from the time `from` until its own next event with itself or the table, or until it has
// gone as far as its box is to cover.
void Shot::bound(int ball, double from) {
    const auto i = static_cast<std::size_t>(ball);
    Mover& mover = mover_[i];
    const Segment& s = now_of(ball);
    mover.until = std::min(mover.own, mover.feature.time);
    mover.refresh = kNever;
    if (mover.travel < kNever && translates(s.state)) {
        const Vec3 v = velocity_at(s, from - s.start);
        const double speed = length(Vec2(v.x(), v.y())), pull = length(s.a);
        const double end =
            std::max(from, now_) +
            2.0 * mover.travel / (speed + std::sqrt(speed * speed + 2.0 * pull * mover.travel));
        if (end < mover.until) mover.until = mover.refresh = end;
    }
    ball_boxes_.place(ball, swept(ball, from, mover.until - from));
}

// First contact of two balls, unless it comes later than `latest` or than what either does next: both will be
// looked at again then. `mine` is the path of ball a from the start of its segment.
Candidate Shot::pair(int a, const Path& mine, int b, double latest) const {
    const Segment &s = now_of(a), &q = now_of(b);
    if (!mine.moves && !translates(q.state)) return {};
    const double from = std::max(s.start, q.start);
    const double until = std::min(std::min(mover_[a].until, mover_[b].until), latest);
    const Path one = from == s.start ? mine : path(a, from), two = path(b, from);
    const double reach = contact_distance(radius(a), radius(b));
    if (stays_apart(two.r - one.r, two.v - one.v, two.a - one.a, reach, span(from, until))) return {};
    const double t = time_to_ball(one, two, reach);
    return {from + t, EventType::kBallBall, std::min(a, b), std::max(a, b), -1};
}

void Shot::offer(int ball, int partner, Candidate c) {
    Candidate& mine = mover_[ball].pair;
    if (!before(c, mine)) return;
    mine = c;
    mine.stamp = mover_[partner].stamp;
    changed(ball);
}

// All contacts of one ball, each offered to both.
void Shot::search_pairs(int ball) {
    ball_boxes_.settle();
    const Path mine = path(ball, now_of(ball).start);
    ball_boxes_.neighbours(ball, [this, ball, &mine](int other) {
        // Of two new balls the first one has done it.
        if (mover_[other].round == round_ && other < ball) return;
        if (held_together(ball, other)) return;
        const double latest = std::max(mover_[ball].pair.time, mover_[other].pair.time);
        const Candidate c = pair(ball, mine, other, latest);
        if (c.time == kNever) return;
        offer(ball, other, c);
        offer(other, ball, c);
    });
}

// A ball's own part after an event that touched it: its transition, the table, its box.
void Shot::renew(int ball) {
    const auto i = static_cast<std::size_t>(ball);
    const Segment& s = now_of(ball);
    const double R = radius(ball);
    Mover& mover = mover_[i];
    mover.surface = R * std::sqrt(s.w.x() * s.w.x() + s.w.y() * s.w.y() + s.w.z() * s.w.z());
    // A free ball rolls straight ahead; a held one is pushed aside.
    mover.straight =
        (s.state == MotionState::kRolling && !s.held) || s.v.x() * s.a.y() - s.v.y() * s.a.x() == 0.0;
    mover.travel = plan_.box_travel * R;
    mover.until = mover.refresh = kNever;
    mover.round = round_;
    ++mover.stamp;
    mover.own = s.start + s.duration;
    mover.pair = {};
    if (plan_.clusters == ClusterModel::kCompliant && translates(s.state)) bound_speed(s);
    detect_features(ball);
    if (plan_.pairs && in_play(s))
        bound(ball, s.start);
    else if (plan_.pairs)
        ball_boxes_.remove(ball);
    changed(ball);
}

void Shot::redetect() {
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    ++round_;
    for (const int i : touched_) renew(i);
    if (plan_.pairs)
        for (const int i : touched_) search_pairs(i);
    touched_.clear();
}

// Without an event: the ball's box has ended, or the contact that it was waiting for does not come.
void Shot::look_again(int ball) {
    Mover& mover = mover_[ball];
    ++round_;
    const double refresh = mover.refresh;
    const bool ended = refresh <= key_[ball];
    mover.pair = {};
    if (ended) {
        // Twice the way each time: a ball that meets nobody for ever is asked a finite number of times.
        mover.travel *= 2.0;
        bound(ball, refresh);
    }
    search_pairs(ball);
    changed(ball);
}

}  // namespace carom
