// Search for contacts between balls.
#include <algorithm>
#include <cmath>

#include "loop/detector.h"
#include "physics/reach.h"

namespace carom {

namespace {

// Smallest and largest value of r + v t + a t^2 / 2 on [0, T], widened by `margin`.
void extend(double r, double v, double a, double T, double margin, double& low, double& high) {
    low = high = r;
    if (v != 0.0 || a != 0.0) {
        if (!(T < kNever)) {  // unlimited time: no bound
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

// Box that contains the ball from `from` to `from` + `duration`; the relative margin covers rounding.
Box Detector::swept(int ball, double from, double duration) const {
    const Segment& s = balls_.segment(ball);
    const bool whole = from == s.start;
    const Vec2 r = planar(whole ? s.r : position_at(s, from - s.start)),
               v = planar(whole ? s.v : velocity_at(s, from - s.start));
    const double R = flights_ && flies(s.state) ? kNoseReach * balls_.radius(ball) : balls_.radius(ball),
                 margin = R * (1.0 + kBoxShare) + kBoxShare * (std::abs(r.x()) + std::abs(r.y()));
    Box box{};
    extend(r.x(), v.x(), s.a.x(), duration, margin, box.low_x, box.high_x);
    extend(r.y(), v.y(), s.a.y(), duration, margin, box.low_y, box.high_y);
    return box;
}

// Whether a ball whose boxes cover short distances searches the table only once a box reaches a part of it:
// if there are many balls, most are far from the table's parts.
bool Detector::may_wait(int ball) const {
    const Segment& s = balls_.segment(ball);
    return plan_.pairs && !flights_ && translates(s.state) && s.state != MotionState::kFalling;
}

// Places the box of a ball. It is valid from `from` until the ball's state transition, its contact with the
// table, or until it may have moved by Mover::travel. `whole`: the box of its whole segment, if known.
void Detector::bound(int ball, double from, const RoundedBox* whole) {
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
    if (whole != nullptr && mover.until == mover.own && !mover.asks_table) {
        ball_boxes_.place(ball, *whole);
        return;
    }
    const RoundedBox box = BoxSearch::outward(swept(ball, from, mover.until - from));
    if (mover.asks_table) find_parts(box);
    if (mover.asks_table && !near_.empty()) {
        mover.asks_table = false;
        search_table(ball, BoxSearch::outward(swept(ball, s.start, s.duration)));
        bound(ball, from, whole);
        return;
    }
    ball_boxes_.place(ball, box);
}

// First contact of two balls. May return none if it is later than `latest`, or than the next own event of one
// of them, after which its contacts are searched again anyway. `mine` is ball a's path from the start of its
// segment.
PredictedEvent Detector::pair(int a, const Path& mine, int b, double latest) const {
    const Segment &s = balls_.segment(a), &q = balls_.segment(b);
    if (collide(s, q)) return {};
    const bool in_air = flights_ && balls_.in_space(a, b);
    const double from = std::max(s.start, q.start);
    const double until = std::min(std::min(mover_[a].until, mover_[b].until), latest);
    // Most pairs end here. The parabolas equal the paths up to rounding far below the margin of this test,
    // and the sum of the radii is at least the distance at which the balls touch.
    const double mine_for = from - s.start, other_for = from - q.start;
    const Vec2 r = (planar(q.r) + other_for * (planar(q.v) + 0.5 * other_for * q.a)) -
                   (planar(s.r) + mine_for * (planar(s.v) + 0.5 * mine_for * s.a));
    const Vec2 v = (planar(q.v) + other_for * q.a) - (planar(s.v) + mine_for * s.a);
    if (stays_apart(r, v, q.a - s.a, balls_.radius(a) + balls_.radius(b), span(from, until))) return {};
    const Contact contact{std::min(a, b), With::kBall, std::max(a, b)};
    if (in_air) return {from + time_to_flight(a, b, from), contact};
    const double reach = contact_distance(balls_.radius(a), balls_.radius(b), plan_.balls.discs());
    return {from + time_to_ball(from == s.start ? mine : path(a, from), path(b, from), reach), contact};
}

void Detector::offer(int ball, int partner, PredictedEvent c) {
    PredictedEvent& mine = mover_[ball].pair;
    if (!before(c, mine)) return;
    mine = c;
    mine.stamp = mover_[partner].stamp;
    requeue(ball);
}

// Finds the contacts of one ball with others, and offers each contact to both balls.
void Detector::search_pairs(int ball) {
    ball_boxes_.rebuild_if_due();
    const Path mine = path(ball, balls_.segment(ball).start);
    ball_boxes_.neighbours(ball, [this, ball, &mine](int other) {
        // If both balls have changed, the one with the smaller index has already searched this pair.
        if (mover_[other].round == round_ && other < ball) return;
        if (resting_.has({ball, With::kBall, other})) return;
        const double latest = std::max(mover_[ball].pair.time, mover_[other].pair.time);
        const PredictedEvent c = pair(ball, mine, other, latest);
        if (c.time == kNever) return;
        offer(ball, other, c);
        offer(other, ball, c);
    });
}

// Updates the upper bound of all speeds, for the cluster search. The speed in a segment is largest at one of
// its ends. The bound only increases, and no result depends on it.
void Detector::bound_speed(const Segment& s) {
    fastest_ = std::max(fastest_, length(planar(s.v)));
    if (flights_ && flies(s.state))
        fastest_ = std::max(fastest_, length3(s.v) + std::sqrt(2.0 * plan_.gravity * s.r.z()));
    if (s.a == Vec2::Zero()) return;
    fastest_ = std::max(fastest_, s.duration < kNever ? length(planar(velocity_at(s, s.duration))) : kNever);
}

// Searches again without an event: the ball's box has expired, or its predicted contact does not happen.
void Detector::search_again(int ball) {
    const Stopwatch watch(search_ns_);
    Mover& mover = mover_[ball];
    ++round_;
    const double refresh = mover.refresh;
    const bool expired = refresh <= queue_.time(ball);
    mover.pair = {};
    if (expired) {
        // The distance doubles each time, so that a ball without contacts needs finitely many searches.
        mover.travel *= 2.0;
        bound(ball, refresh);
    }
    search_pairs(ball);
    requeue(ball);
}

}  // namespace carom
