// What comes next: candidates per ball, their order, and re-detection of what an event touched.
#include <algorithm>
#include <cmath>

#include "carom/engine/tolerances.h"
#include "shot.h"

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

bool apart(const Box& a, const Box& b) {
    return a.low_x > b.high_x || b.low_x > a.high_x || a.low_y > b.high_y || b.low_y > a.high_y;
}

Box around(const Vec2& center, double reach) {
    return {center.x() - reach, center.y() - reach, center.x() + reach, center.y() + reach};
}

}  // namespace

// Motion of a ball from the time `from` on. Contacts are sought from the start of the segments concerned, not
// from now: the answer is then a function of the segments alone, whenever it is computed.
Path Shot::path(int ball, double from) const {
    const Segment& s = now_of(ball);
    const double tau = from - s.start;
    const Vec3 r = position_at(s, tau), v = velocity_at(s, tau);
    const bool moves = translates(s.state);
    // A free ball rolls straight ahead; a held one is pushed aside.
    const bool straight =
        (s.state == MotionState::kRolling && !s.held) || s.v.x() * s.a.y() - s.v.y() * s.a.x() == 0.0;
    return {Vec2(r.x(), r.y()),
            Vec2(v.x(), v.y()),
            s.a,
            std::max(0.0, s.duration - tau),
            straight,
            moves,
            radius(ball) * std::sqrt(s.w.x() * s.w.x() + s.w.y() * s.w.y() + s.w.z() * s.w.z())};
}

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
    const Vec2 here(r.x(), r.y());
    switch (c.type) {
        case EventType::kBallBall: {
            const Vec3 q = position_at(now_of(c.b), c.time - now_of(c.b).start);
            return 0.5 * (here + Vec2(q.x(), q.y()));
        }
        case EventType::kBallPocket:
            return plan_.pockets[static_cast<std::size_t>(c.b)].center;
        case EventType::kBallCushion:
        case EventType::kBallJaw: {
            if (c.nose >= 0) return plan_.noses[static_cast<std::size_t>(c.nose)].center;
            const CushionLine& line = plan_.cushions[static_cast<std::size_t>(c.b)];
            return line.from + line.direction * line.direction.dot(here - line.from);
        }
        default:
            return here;
    }
}

// Order of candidates: time, then kind, then the deeper closing, then the place (x, then y). Never an id.
bool Shot::before(const Candidate& x, const Candidate& y) const {
    if (x.time != y.time) return x.time < y.time;
    if (x.time == kNever) return false;
    if (rank(x.type) != rank(y.type)) return rank(x.type) < rank(y.type);
    const double closing_x = closing(x), closing_y = closing(y);
    if (closing_x != closing_y) return closing_x > closing_y;
    const Vec2 place_x = place(x), place_y = place(y);
    if (place_x.x() != place_y.x()) return place_x.x() < place_y.x();
    return place_x.y() < place_y.y();
}

Candidate Shot::next() const {
    Candidate first;
    for (std::size_t i = 0; i < own_.size(); ++i) {
        for (const Candidate* c : {&own_[i], &feature_[i], &pair_[i]}) {
            if (c->time <= first.time && before(*c, first)) first = *c;
        }
    }
    return first;
}

// Where the ball's surface can be from its segment's start until `duration` later; the share keeps rounding
// inside.
Box Shot::swept(int ball, double duration) const {
    const Segment& s = now_of(ball);
    const double R = radius(ball),
                 margin = R * (1.0 + kBoxShare) + kBoxShare * (std::abs(s.r.x()) + std::abs(s.r.y()));
    Box box{};
    extend(s.r.x(), s.v.x(), s.a.x(), duration, margin, box.low_x, box.high_x);
    extend(s.r.y(), s.v.y(), s.a.y(), duration, margin, box.low_y, box.high_y);
    return box;
}

Candidate Shot::pair(int a, int b) const {
    // Beyond what either does next there is nothing to know: both will be looked at again then.
    if (apart(box_[static_cast<std::size_t>(a)], box_[static_cast<std::size_t>(b)])) return {};
    const double from = std::max(now_of(a).start, now_of(b).start);
    const double t = time_to_ball(path(a, from), path(b, from), contact_distance(radius(a), radius(b)));
    return {from + t, EventType::kBallBall, std::min(a, b), std::max(a, b), -1};
}

void Shot::rescan(int ball) {
    Candidate first;
    for (int j = 0; plan_.pairs && j < balls_ && in_play(now_of(ball)); ++j) {
        if (j == ball || !in_play(now_of(j)) || held_together(ball, j)) continue;
        const Candidate c = pair(ball, j);
        if (before(c, first)) first = c;
    }
    pair_[static_cast<std::size_t>(ball)] = first;
}

void Shot::detect_features(int ball) {
    Candidate first;
    if (translates(now_of(ball).state)) {
        const double from = now_of(ball).start;
        const Path p = path(ball, from);
        const double R = radius(ball);
        const auto offer = [&](double t, EventType type, int index, int nose) {
            if (t == kNever) return;
            const Candidate c{from + t, type, ball, index, nose};
            if (before(c, first)) first = c;
        };
        const Box whole = swept(ball, now_of(ball).duration);
        for (std::size_t i = 0; i < plan_.cushions.size(); ++i) {
            const CushionLine& line = plan_.cushions[i];
            if (apart(whole, line_boxes_[i]) || held_to(ball, static_cast<int>(i), -1)) continue;
            offer(time_to_line(p, line.from, line.direction, line.length, R), EventType::kBallCushion,
                  static_cast<int>(i), -1);
        }
        // What lies beyond the first straight cushion cannot come before it.
        const Box near = first.time < kNever ? swept(ball, first.time - from) : whole;
        for (std::size_t i = 0; i < plan_.noses.size(); ++i) {
            const Nose& nose = plan_.noses[i];
            if (apart(near, around(nose.center, nose.radius)) || held_to(ball, -1, static_cast<int>(i)))
                continue;
            offer(time_to_circle(p, nose.center, R + nose.radius), nose.type, nose.index,
                  static_cast<int>(i));
        }
        for (std::size_t i = 0; i < plan_.pockets.size(); ++i) {
            if (apart(near, around(plan_.pockets[i].center, plan_.pockets[i].radius))) continue;
            offer(time_to_pocket(p, plan_.pockets[i].center, plan_.pockets[i].radius), EventType::kBallPocket,
                  static_cast<int>(i), -1);
        }
    } else if (now_of(ball).state != MotionState::kPocketed) {
        // A ball that rests inside a pocket's circle falls.
        const Vec3& r = now_of(ball).r;
        for (std::size_t i = 0; i < plan_.pockets.size(); ++i) {
            if (length(Vec2(r.x(), r.y()) - plan_.pockets[i].center) < plan_.pockets[i].radius)
                first = {now_of(ball).start, EventType::kBallPocket, ball, static_cast<int>(i), -1};
        }
    }
    feature_[static_cast<std::size_t>(ball)] = first;
}

// The box of a ball until its own next event with itself or the table.
void Shot::bound(int ball) {
    const auto i = static_cast<std::size_t>(ball);
    box_[i] = swept(ball, std::min(own_[i].time, feature_[i].time) - now_of(ball).start);
}

// After an event: the candidates of the balls that it touched anew, and those of balls whose next contact was
// with them.
void Shot::redetect() {
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    const auto is_touched = [this](int ball) {
        return std::binary_search(touched_.begin(), touched_.end(), ball);
    };
    for (const int i : touched_) {
        const Segment& s = now_of(i);
        own_[static_cast<std::size_t>(i)] = {s.start + s.duration, EventType::kSlideRoll, i, -1, -1};
        detect_features(i);
        bound(i);
    }
    for (const int i : touched_) rescan(i);
    for (int j = 0; plan_.pairs && j < balls_; ++j) {
        if (is_touched(j) || !in_play(now_of(j))) continue;
        Candidate& mine = pair_[static_cast<std::size_t>(j)];
        if (mine.time != kNever && (is_touched(mine.a) || is_touched(mine.b))) {
            rescan(j);
            continue;
        }
        for (const int i : touched_) {
            if (!in_play(now_of(i)) || held_together(i, j)) continue;
            const Candidate c = pair(i, j);
            if (before(c, mine)) mine = c;
        }
    }
    touched_.clear();
}

}  // namespace carom
