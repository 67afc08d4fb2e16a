// Search for contacts of balls with the table: straight cushions, round noses, pockets.
#include <algorithm>
#include <cmath>

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

}  // namespace carom
