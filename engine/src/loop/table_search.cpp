// Search for contacts of balls with the table, and of flying balls with anything.
#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/touch.h"
#include "loop/detector.h"

namespace carom {

namespace {

Box box_of(const CushionLine& line) {
    const Vec2 to = line.from + line.length * line.direction;
    return {std::min(line.from.x(), to.x()), std::min(line.from.y(), to.y()), std::max(line.from.x(), to.x()),
            std::max(line.from.y(), to.y())};
}
template <class Round>
Box box_of(const Round& part) {
    return box_around(part.center, std::abs(part.radius));
}

}  // namespace

// Most shots of a batch use the same table, so its boxes are kept.
void Detector::set_up_table() {
    const Geometry& g = plan_.geometry;
    if (table_search_ == plan_.table_search && g == table_) return;
    table_ = g;
    table_search_ = plan_.table_search;
    const std::size_t count = g.cushions.size() + g.noses.size() + g.pockets.size();
    table_boxes_.set_up(static_cast<int>(count), plan_.table_search);
    parts_.clear();
    parts_.reserve(count);
    near_.reserve(count);
    each_part(g, [this](const Contact& contact, const auto& part) {
        table_boxes_.place(static_cast<int>(parts_.size()), box_of(part));
        parts_.push_back(contact);
    });
    table_boxes_.rebuild_if_due();
}

// Finds the parts of the table that a ball can reach inside a box, in the order of parts_.
void Detector::find_parts(const RoundedBox& box) {
    near_.clear();
    table_boxes_.overlapping(box, [this](int part) { near_.push_back(part); });
    if (plan_.table_search == Search::kTree) std::sort(near_.begin(), near_.end());
}

// `whole`: the box of the ball during its segment.
void Detector::search_table(int ball, const RoundedBox& whole) {
    PredictedEvent& first = mover_[ball].table;
    first = {};
    const Segment& s = balls_.segment(ball);
    // The integration of a cluster has included the table.
    if (is_gone(s.state) || balls_.collides(ball) || (parts_.empty() && !plan_.scene.table.bed)) return;
    find_parts(whole);
    if (flights_ && flies(s.state)) {
        search_table_in_air(ball);
        return;
    }
    if (!translates(s.state)) {  // a resting ball inside a pocket's circle falls
        if (const int over = pocket_around(plan_.geometry, planar(s.r)); over >= 0)
            first = {s.start, {ball, With::kPocket, over}};
        return;
    }
    const Path p = path(ball, s.start);
    const bool falls = s.state == MotionState::kFalling;
    if (falls) {  // it may return over the edge
        const int under = pocket_under(plan_.geometry, p.r);
        const Pocket& pocket = plan_.geometry.pockets[under];
        const double t = time_to_edge(p.r, p.v, pocket.center, pocket.radius);
        if (t < s.duration) first = {s.start + t, {ball, With::kPocket, under}};
    }
    for (const int part : near_) {
        // Contacts after the first one found so far are not needed: that one limits the window of the quick
        // rejection.
        const Contact contact = parts_[part].of(ball);
        if (falls && contact.with == With::kPocket) continue;
        if (resting_.has(contact)) continue;
        const double window = std::min(p.horizon, span(s.start, first.time)), R = balls_.radius(ball);
        const double t =
            with_part(plan_.geometry, contact, [&](const auto& one) { return time_to(one, p, R, window); });
        if (t < kNever) take_first({s.start + t, contact}, first);
    }
}

// The motion of a ball from the time `from`, with its height.
Flight Detector::flight(int ball, double from) const {
    const Segment& s = balls_.segment(ball);
    const double tau = from - s.start;
    const Placed placed = placed_at(s, tau, plan_.gravity);
    return {placed.position, placed.velocity,
            Vec3(s.a.x(), s.a.y(), is_off_cloth(s.state) ? -plan_.gravity : 0.0),
            std::max(0.0, s.duration - tau),
            kClosingUlp * std::numeric_limits<double>::epsilon() *
                (length3(placed.velocity) + mover_[ball].surface)};
}

// [s] Time from `from` until two balls collide, at least one of which flies or falls into a pocket.
double Detector::time_to_flight(int a, int b, double from) const {
    const Flight one = flight(a, from), two = flight(b, from);
    const Flight relative{two.r - one.r, two.v - one.v, two.a - one.a, std::min(one.horizon, two.horizon),
                          one.noise + two.noise};
    return flight_to_ball(relative, balls_.radius(a) + balls_.radius(b));
}

// [s] Time until a ball flying over a pocket leaves its circle on the side without cloth.
double Detector::time_over_pocket(int index, const Path& path, double R) const {
    const Pocket& pocket = plan_.geometry.pockets[index];
    const double enters = time_to_pocket(path, pocket.center, pocket.radius);
    if (enters == kNever) return kNever;
    const double leaves =
        enters + time_to_edge(path.r + enters * path.v, path.v, pocket.center, pocket.radius);
    const bool back = is_bed(plan_.scene.table, pocket, path.r + leaves * path.v, R);
    return back || leaves > path.horizon ? kNever : leaves;
}

namespace {

// [s] Time until the centre is over the disc of a jaw, which ends the search for its nose. flight_over_disc()
// adds grazes that time_to_circle() skips, and a centre that is over it already.
double time_over_jaw(const Path& path, const Vec2& center, double radius) {
    const double over = time_to_circle(path, center, radius);
    return over < kNever ? over : flight_over_disc(path.r - center, path.v, radius, path.horizon);
}

}  // namespace

// A flying ball hits noses at their height. Once over them it is out; it meets a pocket only at its far side.
// Landing is a state transition. If the table has a bed, cloth may lie behind a cushion's line, but never
// inside a jaw.
void Detector::search_table_in_air(int ball) {
    PredictedEvent& first = mover_[ball].table;
    const double start = balls_.segment(ball).start, R = balls_.radius(ball);
    const Flight f = flight(ball, start);
    const Path p = path(ball, start);
    const Table& table = plan_.scene.table;
    const Contact out{ball, With::kOut, -1};
    const auto leaves = [&](double t) {
        if (t < kNever) take_first({start + t, out}, first);
    };
    if (table.bed) {
        const double t = flight_beyond(*table.bed, p.r, p.v);
        if (t <= p.horizon && pocket_around(plan_.geometry, p.r + t * p.v) < 0)
            take_first({start + t, out}, first);
    }
    for (const int part : near_) {
        const Contact contact = parts_[part].of(ball);
        double t = kNever;
        if (contact.with == With::kCushion) {
            const CushionLine& c = plan_.geometry.cushions[contact.other];
            t = flight_to_line(f, c, R);
            if (!table.bed) leaves(flight_over_line(f, c));
        } else if (contact.with == With::kNose) {
            const Nose& n = plan_.geometry.noses[contact.other];
            t = flight_to_nose(f, n, R);
            if (n.radius > 0.0) leaves(time_over_jaw(p, n.center, n.radius));
        } else {
            t = time_over_pocket(contact.other, p, R);
        }
        if (t < kNever) take_first({start + t, contact}, first);
    }
}

}  // namespace carom
