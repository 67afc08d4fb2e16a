// Which event is next.
#include <algorithm>

#include "loop/shot.h"

namespace carom {

namespace {

// Written order of events at one and the same time: pocket, own transition, ball-ball, cushion.
int rank(EventType type) {
    switch (type) {
        case EventType::kBallPocket:
            return 0;
        case EventType::kBallBall:
        case EventType::kBallCluster:
            return 2;
        case EventType::kBallCushion:
        case EventType::kBallJaw:
            return 3;
        default:
            return 1;
    }
}

}  // namespace

// Closing speed of a contact at its time: at one instant the deepest closing goes first.
double Shot::closing(const Candidate& c) const {
    if (c.type != EventType::kBallBall) return 0.0;
    const Segment &s = now_of(c.a), &q = now_of(c.b);
    const Vec3 r = position_at(q, c.time - q.start) - position_at(s, c.time - s.start);
    const Vec3 v = velocity_at(q, c.time - q.start) - velocity_at(s, c.time - s.start);
    return -(r.x() * v.x() + r.y() * v.y());
}

Vec2 Shot::place(const Candidate& c) const {
    const Vec3 r = position_at(now_of(c.a), c.time - now_of(c.a).start);
    Vec2 here(r.x(), r.y());
    switch (c.type) {
        case EventType::kBallBall: {
            const Vec3 q = position_at(now_of(c.b), c.time - now_of(c.b).start);
            return 0.5 * (here + Vec2(q.x(), q.y()));
        }
        case EventType::kBallPocket:
            return plan_.geometry.pockets[c.b].center;
        case EventType::kBallCushion:
        case EventType::kBallJaw: {
            if (c.nose >= 0) return plan_.geometry.noses[c.nose].center;
            const CushionLine& line = plan_.geometry.cushions[c.b];
            return line.from + line.direction * line.direction.dot(here - line.from);
        }
        default:
            return here;
    }
}

// Order of candidates: time, then kind, then the deeper closing, then the place (x, then y). Never an id.
bool Shot::before_at_once(const Candidate& x, const Candidate& y) const {
    if (rank(x.type) != rank(y.type)) return rank(x.type) < rank(y.type);
    const double closing_x = closing(x), closing_y = closing(y);
    if (closing_x != closing_y) return closing_x > closing_y;
    const Vec2 place_x = place(x), place_y = place(y);
    if (place_x.x() != place_y.x()) return place_x.x() < place_y.x();
    return place_x.y() < place_y.y();
}

void Shot::changed(int ball) {
    Mover& mover = mover_[ball];
    if (mover.queued) return;
    mover.queued = true;
    changed_.push_back(ball);
}

// The first of a ball's transition, contact with the table and contact with another ball.
Candidate Shot::first_of(int ball) const {
    const Mover& mover = mover_[ball];
    Candidate first{mover.own, EventType::kSlideRoll, ball, -1, -1};
    take_first(mover.feature, first);
    take_first(mover.pair, first);
    return first;
}

// Finds the places of the balls whose candidates changed.
void Shot::requeue() {
    for (const int ball : changed_) {
        Mover& mover = mover_[ball];
        mover.queued = false;
        key_[ball] =
            std::min(std::min(mover.own, mover.feature.time), std::min(mover.pair.time, mover.refresh));
    }
    const auto earlier = [this](int x, int y) {
        const double p = key_[x], q = key_[y];
        return p != q ? p < q : p != kNever && before(first_of(x), first_of(y));
    };
    for (const int ball : changed_) queue_.update(ball, earlier);
    changed_.clear();
}

// The next event; its time is kNever if there is none. On the way, balls are looked at again whose box has
// ended or whose partner has changed since.
template <bool kProfile>
Candidate Shot::next() {
    for (;;) {
        const int ball = queue_.first();
        if (ball < 0) return {};
        const auto i = static_cast<std::size_t>(ball);
        if (key_[i] == kNever) return {};
        const Candidate c = first_of(ball);
        const bool ended = mover_[i].refresh <= c.time;
        const bool stale = c.type == EventType::kBallBall && c.stamp != mover_[c.a == ball ? c.b : c.a].stamp;
        if (!ended && !stale) return c;
        const auto start = kProfile ? Clock::now() : Clock::time_point{};
        look_again(ball);
        if constexpr (kProfile) search_ns_ += nanoseconds(start, Clock::now());
        requeue();
    }
}

template Candidate Shot::next<false>();
template Candidate Shot::next<true>();

}  // namespace carom
