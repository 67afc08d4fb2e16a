// Contacts with the table: straight cushions, round noses, pockets; numbered in this order as parts.
#include <algorithm>

#include "loop/shot.h"

namespace carom {

namespace {

Box around(const Vec2& center, double reach) {
    return {center.x() - reach, center.y() - reach, center.x() + reach, center.y() + reach};
}

}  // namespace

void Shot::set_up_table() {
    const std::size_t lines = plan_.geometry.cushions.size(), round = lines + plan_.geometry.noses.size();
    table_boxes_.set_up(static_cast<int>(round + plan_.geometry.pockets.size()), plan_.table_search);
    parts_.reserve(round + plan_.geometry.pockets.size());
    for (std::size_t i = 0; i < lines; ++i) {
        const CushionLine& line = plan_.geometry.cushions[i];
        const Vec2 to = line.from + line.length * line.direction;
        table_boxes_.place(static_cast<int>(i),
                           {std::min(line.from.x(), to.x()), std::min(line.from.y(), to.y()),
                            std::max(line.from.x(), to.x()), std::max(line.from.y(), to.y())});
    }
    for (std::size_t i = 0; i < plan_.geometry.noses.size(); ++i)
        table_boxes_.place(static_cast<int>(lines + i),
                           around(plan_.geometry.noses[i].center, plan_.geometry.noses[i].radius));
    for (std::size_t i = 0; i < plan_.geometry.pockets.size(); ++i)
        table_boxes_.place(static_cast<int>(round + i),
                           around(plan_.geometry.pockets[i].center, plan_.geometry.pockets[i].radius));
    table_boxes_.settle();
}

// The parts of the table that the ball's surface can come to during its segment, in their order.
void Shot::find_parts(int ball) {
    parts_.clear();
    table_boxes_.overlapping(swept(ball, now_of(ball).start, now_of(ball).duration),
                             [this](int part) { parts_.push_back(part); });
    if (plan_.table_search == Search::kTree) std::sort(parts_.begin(), parts_.end());
}

void Shot::detect_features(int ball) {
    Candidate& first = mover_[ball].feature;
    first = {};
    const Segment& s = now_of(ball);
    const int lines = static_cast<int>(plan_.geometry.cushions.size()),
              round = lines + static_cast<int>(plan_.geometry.noses.size());
    if (s.state == MotionState::kPocketed || round + static_cast<int>(plan_.geometry.pockets.size()) == 0)
        return;
    find_parts(ball);
    if (!translates(s.state)) {
        for (const int part : parts_)
            if (part >= round) offer_rest(ball, part - round, first);
        return;
    }
    const Path p = path(ball, s.start);
    for (const int part : parts_) {
        if (part < lines)
            offer_line(ball, p, part, first);
        else if (part < round)
            offer_nose(ball, p, part - lines, first);
        else
            offer_pocket(ball, p, part - round, first);
    }
}

// What lies beyond the first contact found so far cannot come before it: the window of the rejects.
void Shot::offer_line(int ball, const Path& p, int line, Candidate& first) const {
    const CushionLine& c = plan_.geometry.cushions[line];
    const double from = now_of(ball).start, R = radius(ball);
    if (stays_off_line(p, c.from, c.direction, R, std::min(p.horizon, span(from, first.time)))) return;
    if (held_to(ball, line, -1)) return;
    const double t = time_to_line(p, c.from, c.direction, c.length, R);
    take_first({.time = from + t, .type = EventType::kBallCushion, .a = ball, .b = line}, first);
}

void Shot::offer_nose(int ball, const Path& p, int nose, Candidate& first) const {
    const Nose& n = plan_.geometry.noses[nose];
    const double from = now_of(ball).start, reach = radius(ball) + n.radius;
    if (stays_apart(p.r - n.center, p.v, p.a, reach, std::min(p.horizon, span(from, first.time)))) return;
    if (held_to(ball, -1, nose)) return;
    const double t = time_to_circle(p, n.center, reach);
    take_first({.time = from + t, .type = n.type, .a = ball, .b = n.index, .nose = nose}, first);
}

void Shot::offer_pocket(int ball, const Path& p, int pocket, Candidate& first) const {
    const Pocket& k = plan_.geometry.pockets[pocket];
    const double from = now_of(ball).start;
    if (stays_apart(p.r - k.center, p.v, p.a, k.radius, std::min(p.horizon, span(from, first.time)))) return;
    const double t = time_to_pocket(p, k.center, k.radius);
    take_first({.time = from + t, .type = EventType::kBallPocket, .a = ball, .b = pocket}, first);
}

// A ball that rests inside a pocket's circle falls.
void Shot::offer_rest(int ball, int pocket, Candidate& first) const {
    const Pocket& k = plan_.geometry.pockets[pocket];
    const Segment& s = now_of(ball);
    if (length(Vec2(s.r.x(), s.r.y()) - k.center) < k.radius)
        first = {.time = s.start, .type = EventType::kBallPocket, .a = ball, .b = pocket};
}

}  // namespace carom
