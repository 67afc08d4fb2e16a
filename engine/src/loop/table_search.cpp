// Search for contacts of balls with the table: straight cushions, round noses, pockets.
#include <algorithm>
#include <cmath>

#include "contact/pocket_edge.h"
#include "contact/touch.h"
#include "loop/detector.h"

namespace carom {

namespace {

Box around(const Vec2& center, double reach) {
    return {center.x() - reach, center.y() - reach, center.x() + reach, center.y() + reach};
}

bool same_places(const Geometry& a, const Geometry& b) {
    const auto same = [](const auto& x, const auto& y, auto equal) {
        return std::equal(x.begin(), x.end(), y.begin(), y.end(), equal);
    };
    return same(a.cushions, b.cushions,
                [](const CushionLine& p, const CushionLine& q) {
                    return p.from == q.from && p.direction == q.direction && p.length == q.length;
                }) &&
           same(a.noses, b.noses,
                [](const Nose& p, const Nose& q) { return p.center == q.center && p.radius == q.radius; }) &&
           same(a.pockets, b.pockets, [](const Pocket& p, const Pocket& q) {
               return p.center == q.center && p.radius == q.radius;
           });
}

}  // namespace

// Most shots of a batch use the same table, so its boxes are kept.
void Detector::set_up_table() {
    const Geometry& g = plan_.geometry;
    if (table_search_ == plan_.table_search && same_places(g, table_)) return;
    table_ = g;
    table_search_ = plan_.table_search;
    const std::size_t count = g.cushions.size() + g.noses.size() + g.pockets.size();
    table_boxes_.set_up(static_cast<int>(count), plan_.table_search);
    parts_.clear();
    parts_.reserve(count);
    near_.reserve(count);
    const auto add = [this](With with, std::size_t index, const Box& box) {
        table_boxes_.place(static_cast<int>(parts_.size()), box);
        parts_.push_back({-1, with, static_cast<int>(index)});
    };
    for (std::size_t i = 0; i < g.cushions.size(); ++i) {
        const CushionLine& line = g.cushions[i];
        const Vec2 to = line.from + line.length * line.direction;
        add(With::kCushion, i,
            {std::min(line.from.x(), to.x()), std::min(line.from.y(), to.y()),
             std::max(line.from.x(), to.x()), std::max(line.from.y(), to.y())});
    }
    for (std::size_t i = 0; i < g.noses.size(); ++i)
        add(With::kNose, i, around(g.noses[i].center, std::abs(g.noses[i].radius)));
    for (std::size_t i = 0; i < g.pockets.size(); ++i)
        add(With::kPocket, i, around(g.pockets[i].center, g.pockets[i].radius));
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
        for (const int part : near_) {
            const Contact contact = parts_[part].of(ball);
            if (contact.with == With::kPocket &&
                is_inside(plan_.geometry.pockets[contact.other], planar(s.r)))
                first = {s.start, contact};
        }
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
        const double t = time_to(contact, p, std::min(p.horizon, span(s.start, first.time)));
        if (t < kNever) take_first({s.start + t, contact}, first);
    }
}

// [s] Time until the contact; kNever if the ball stays away for the whole window, or already has this
// contact.
double Detector::time_to(const Contact& contact, const Path& p, double window) const {
    const double R = balls_.radius(contact.ball);
    switch (contact.with) {
        case With::kCushion: {
            const CushionLine& c = plan_.geometry.cushions[contact.other];
            if (stays_off_line(p, c, R, window) || resting_.has(contact)) return kNever;
            return time_to_line(p, c, R);
        }
        case With::kNose: {
            const Nose& n = plan_.geometry.noses[contact.other];
            if (n.is_arc()) return resting_.has(contact) ? kNever : time_to_nose(p, n, R);
            const double reach = turn_around(n, R);
            if (stays_apart(p.r - n.center, p.v, p.a, reach, window) || resting_.has(contact)) return kNever;
            return time_to_circle(p, n.center, reach);
        }
        case With::kPocket: {
            const Pocket& k = plan_.geometry.pockets[contact.other];
            if (stays_apart(p.r - k.center, p.v, p.a, k.radius, window)) return kNever;
            return time_to_pocket(p, k.center, k.radius);
        }
        case With::kBall:
        case With::kNothing:
        case With::kOut:
            break;
    }
    return kNever;
}

}  // namespace carom
