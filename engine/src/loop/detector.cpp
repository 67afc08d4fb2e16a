#include "loop/detector.h"

#include <algorithm>
#include <cmath>

#include "contact/touch.h"

namespace carom {

namespace {

// Order of simultaneous events. The round end of a cushion counts as the cushion.
int rank(With with) {
    return static_cast<int>(with == With::kNose ? With::kCushion : with);
}

}  // namespace

// Allocates all memory for the search that earlier runs have not allocated.
Detector::Detector(const Plan& plan, const Balls& balls, const RestingContacts& resting, Costs* costs,
                   DetectorMemory& memory)
    : Borrowed(memory),
      plan_(plan),
      flights_(plan.in_force(Effect::kAirborne)),
      balls_(balls),
      resting_(resting),
      detect_ns_(costs != nullptr ? &costs->event.detect_ns : nullptr),
      search_ns_(costs != nullptr ? &costs->search_ns : nullptr) {
    const auto count = static_cast<std::size_t>(balls_.count());
    mover_.assign(count, Mover());
    tied_.clear();
    tied_.reserve(count);
    queue_.set_up(balls_.count());
    ball_boxes_.set_up(plan_.pairs ? balls_.count() : 0, plan_.ball_search);
    set_up_table();
}

// The closing speed of a contact at its time: the fastest of simultaneous contacts comes first.
double Detector::closing(const PredictedEvent& c) const {
    if (c.contact.with != With::kBall) return 0.0;
    const Segment &s = balls_.segment(c.contact.ball), &q = balls_.segment(c.contact.other);
    if (flights_ && balls_.in_space(c.contact.ball, c.contact.other)) {
        const Placed one = placed_at(s, c.time - s.start, plan_.gravity),
                     two = placed_at(q, c.time - q.start, plan_.gravity);
        return -dot3(two.position - one.position, two.velocity - one.velocity);
    }
    const Vec3 r = position_at(q, c.time - q.start) - position_at(s, c.time - s.start);
    const Vec3 v = velocity_at(q, c.time - q.start) - velocity_at(s, c.time - s.start);
    return -(r.x() * v.x() + r.y() * v.y());
}

Vec2 Detector::place(const PredictedEvent& c) const {
    const Segment& s = balls_.segment(c.contact.ball);
    Vec2 here = planar(position_at(s, c.time - s.start));
    if (c.contact.with == With::kBall) {
        const Segment& q = balls_.segment(c.contact.other);
        return 0.5 * (here + planar(position_at(q, c.time - q.start)));
    }
    if (!c.contact.is_part()) return here;
    return with_part(plan_.geometry, c.contact, [&here](const auto& part) {
        if constexpr (requires { part.center; })
            return part.center;
        else
            return nearest_point(part, here);
    });
}

// Order of simultaneous predicted events: kind, then larger closing(), then position (x, then y); never an
// id.
bool Detector::before_at_once(const PredictedEvent& x, const PredictedEvent& y) const {
    const int rank_x = rank(x.contact.with), rank_y = rank(y.contact.with);
    if (rank_x != rank_y) return rank_x < rank_y;
    const double closing_x = closing(x), closing_y = closing(y);
    if (closing_x != closing_y) return closing_x > closing_y;
    const Vec2 place_x = place(x), place_y = place(y);
    if (place_x.x() != place_y.x()) return place_x.x() < place_y.x();
    return place_x.y() < place_y.y();
}

// Call after any change to a predicted event of the ball or to the expiry of its box.
void Detector::requeue(int ball) {
    const Mover& mover = mover_[ball];
    queue_.set(ball,
               std::min(std::min(mover.own, mover.table.time), std::min(mover.pair.time, mover.refresh)));
}

PredictedEvent Detector::first_of(int ball) const {
    const Mover& mover = mover_[ball];
    PredictedEvent first{mover.own, {ball, With::kNothing, -1}};
    take_first(mover.table, first);
    take_first(mover.pair, first);
    return first;
}

bool Detector::must_search_again(int ball) const {
    const PredictedEvent c = first_of(ball);
    if (mover_[ball].refresh <= c.time) return true;
    if (c.contact.with != With::kBall) return false;
    const int partner = c.contact.ball == ball ? c.contact.other : c.contact.ball;
    return c.stamp != mover_[partner].stamp;
}

// Repeats the search for balls whose box has expired or whose partner has changed its motion, then chooses
// among simultaneous events by the present motions.
PredictedEvent Detector::next() {
    const Stopwatch watch(detect_ns_);
    for (;;) {
        const double time = queue_.first();
        if (time == kNever) return {};
        tied_.clear();
        queue_.all_at(time, [this](int ball) { tied_.push_back(ball); });
        bool again = false;
        for (const int ball : tied_) {
            if (!must_search_again(ball)) continue;
            search_again(ball);
            again = true;
        }
        if (again) continue;
        PredictedEvent first;
        for (const int ball : tied_) take_first(first_of(ball), first);
        return first;
    }
}

// Updates the data of a ball after an event changed its motion: its transition, table contact and box.
void Detector::renew(int ball) {
    const Segment& s = balls_.segment(ball);
    const double R = balls_.radius(ball);
    Mover& mover = mover_[ball];
    mover.surface = R * std::sqrt(s.w.x() * s.w.x() + s.w.y() * s.w.y() + s.w.z() * s.w.z());
    // A free ball rolls along a straight line; a ball in a resting contact may be pushed sideways.
    mover.straight =
        (s.state == MotionState::kRolling && !s.held) || s.v.x() * s.a.y() - s.v.y() * s.a.x() == 0.0;
    mover.travel = plan_.box_travel * R;
    mover.until = mover.refresh = kNever;
    mover.round = round_;
    ++mover.stamp;
    mover.own = s.start + s.duration;
    mover.pair = {};
    if (plan_.clusters == ClusterModel::kCompliant && translates(s.state)) bound_speed(s);
    const RoundedBox whole = BoxSearch::outward(swept(ball, s.start, s.duration));
    mover.asks_table = mover.travel < kNever && may_wait(ball);
    if (mover.asks_table)
        mover.table = {};
    else
        search_table(ball, whole);
    if (plan_.pairs) {
        if (!is_gone(s.state))
            bound(ball, s.start, &whole);
        else
            ball_boxes_.remove(ball);
    }
    requeue(ball);
}

void Detector::update(std::vector<int>& touched) {
    const Stopwatch watch(detect_ns_);
    const Stopwatch search(search_ns_);
    if (touched.size() > 1) {  // most events change one ball
        std::sort(touched.begin(), touched.end());
        touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    }
    ++round_;
    for (const int ball : touched) renew(ball);
    if (plan_.pairs)
        for (const int ball : touched) search_pairs(ball);
    touched.clear();
}

}  // namespace carom
