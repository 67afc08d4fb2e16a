#include "bench/hard_discs.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom::tools {

HardDiscs::HardDiscs(std::vector<Vec2> places, std::vector<Vec2> velocities, double reach, const Vec2& size)
    : reach_(reach), size_(size), discs_(places.size()) {
    // A cell contains about one disc, and is at least as wide as the collision distance.
    const double side = std::max(
        reach, std::sqrt(size.x() * size.y() / static_cast<double>(std::max<std::size_t>(1, places.size()))));
    columns_ = std::max(1, static_cast<int>(size.x() / side));
    rows_ = std::max(1, static_cast<int>(size.y() / side));
    cell_ = Vec2(size.x() / columns_, size.y() / rows_);
    heads_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNothing);
    for (std::size_t i = 0; i < discs_.size(); ++i) {
        Disc& disc = discs_[i];
        disc.r = places[i];
        disc.v = velocities[i];
        disc.time = 0.0;
        disc.event = kNever;
        disc.partner = kNothing;
        disc.column = std::clamp(static_cast<int>(disc.r.x() / cell_.x()), 0, columns_ - 1);
        disc.row = std::clamp(static_cast<int>(disc.r.y() / cell_.y()), 0, rows_ - 1);
        disc.place = i;
        heap_.push_back(static_cast<int>(i));
        enter(static_cast<int>(i));
    }
    for (std::size_t i = 0; i < discs_.size(); ++i) predict(static_cast<int>(i), 0.0);
}

double HardDiscs::run(long collisions) {
    double now = 0.0;
    while (collisions_ < collisions) {
        const int i = heap_.front();
        Disc& disc = discs_[i];
        now = disc.event;
        if (now == kNever) break;
        move(disc, now);
        if (disc.partner == kCell) {
            leave(i);
            (disc.axis == 0 ? disc.column : disc.row) += disc.way;
            enter(i);
        } else if (disc.partner == kBorder) {
            double& v = disc.axis == 0 ? disc.v.x() : disc.v.y();
            v = -v;
            ++collisions_;
        } else if (disc.partner >= 0) {
            const int j = disc.partner;
            Disc& other = discs_[j];
            // Otherwise another disc has hit the partner, and this disc only predicts again.
            if (other.partner == i && other.event == now) {
                move(other, now);
                collide(disc, other);
                ++collisions_;
                other.partner = kNothing;
                set(j, kNever);
                predict(i, now);
                predict(j, now);
                continue;
            }
        }
        predict(i, now);
    }
    return now;
}

void HardDiscs::enter(int i) {
    Disc& disc = discs_[i];
    int& first = head(disc.column, disc.row);
    disc.previous = kNothing;
    disc.next = first;
    if (first >= 0) discs_[first].previous = i;
    first = i;
}

void HardDiscs::leave(int i) {
    const Disc& disc = discs_[i];
    if (disc.previous >= 0)
        discs_[disc.previous].next = disc.next;
    else
        head(disc.column, disc.row) = disc.next;
    if (disc.next >= 0) discs_[disc.next].previous = disc.previous;
}

void HardDiscs::move(Disc& disc, double time) {
    disc.r += (time - disc.time) * disc.v;
    disc.time = time;
}

// Predicts the next event of disc i, whose position is current.
void HardDiscs::predict(int i, double now) {
    Disc& disc = discs_[i];
    double first = kNever;
    int partner = kNothing;
    // The time when it leaves its cell; at the border of the box, the time when it hits the border.
    for (int axis = 0; axis < 2; ++axis) {
        const double v = disc.v[axis];
        if (v == 0.0) continue;
        const int cell = axis == 0 ? disc.column : disc.row, count = axis == 0 ? columns_ : rows_;
        const int way = v > 0.0 ? 1 : -1, next = cell + way;
        const bool border = next < 0 || next >= count;
        const double edge = border && way > 0 ? size_[axis] : (cell + (way > 0)) * cell_[axis];
        const double time = now + std::max(0.0, (edge - disc.r[axis]) / v);
        if (time >= first) continue;
        first = time;
        partner = border ? kBorder : kCell;
        disc.axis = axis;
        disc.way = way;
    }
    for (int row = std::max(0, disc.row - 1); row <= std::min(rows_ - 1, disc.row + 1); ++row) {
        for (int column = std::max(0, disc.column - 1); column <= std::min(columns_ - 1, disc.column + 1);
             ++column) {
            for (int j = head(column, row); j >= 0; j = discs_[j].next) {
                if (j == i) continue;
                const double time = time_to(disc, discs_[j], now);
                // A partner with an earlier event is found again after that event.
                if (time >= first || time >= discs_[j].event) continue;
                first = time;
                partner = j;
            }
        }
    }
    disc.partner = partner;
    set(i, first);
    if (partner < 0) return;
    // The partner's former partner, if any, learns of it at its own event.
    discs_[partner].partner = i;
    set(partner, first);
}

// When two discs touch. The position of the first is current.
double HardDiscs::time_to(const Disc& a, const Disc& b, double now) const {
    const Vec2 r = b.r + (now - b.time) * b.v - a.r, v = b.v - a.v;
    const double closing = r.dot(v);
    if (closing >= 0.0) return kNever;
    const double speed2 = v.squaredNorm(), gap = r.squaredNorm() - reach_ * reach_;
    const double root2 = closing * closing - speed2 * gap;
    if (root2 < 0.0) return kNever;
    return now + std::max(0.0, gap / (std::sqrt(root2) - closing));
}

void HardDiscs::collide(Disc& a, Disc& b) {
    const Vec2 r = b.r - a.r;
    const Vec2 exchanged = r * (r.dot(b.v - a.v) / r.squaredNorm());
    a.v += exchanged;
    b.v -= exchanged;
}

void HardDiscs::set(int i, double time) {
    Disc& disc = discs_[i];
    const bool earlier = time < disc.event;
    disc.event = time;
    earlier ? rise(disc.place, i) : sink(disc.place, i);
}

void HardDiscs::rise(std::size_t place, int i) {
    const double time = discs_[i].event;
    while (place > 0) {
        const std::size_t above = (place - 1) / 2;
        const int other = heap_[above];
        if (discs_[other].event <= time) break;
        heap_[place] = other;
        discs_[other].place = place;
        place = above;
    }
    heap_[place] = i;
    discs_[i].place = place;
}

void HardDiscs::sink(std::size_t place, int i) {
    const double time = discs_[i].event;
    for (;;) {
        std::size_t below = 2 * place + 1;
        if (below >= heap_.size()) break;
        if (below + 1 < heap_.size() && discs_[heap_[below + 1]].event < discs_[heap_[below]].event) ++below;
        const int other = heap_[below];
        if (discs_[other].event >= time) break;
        heap_[place] = other;
        discs_[other].place = place;
        place = below;
    }
    heap_[place] = i;
    discs_[i].place = place;
}

}  // namespace carom::tools
