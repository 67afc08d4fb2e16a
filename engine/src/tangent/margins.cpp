// How far the inputs may move before the order of events changes: the margin of every event, and of every
// near miss.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/tangents.h"
#include "contact/roots.h"
#include "tangent/replay.h"

namespace carom::tangent {
namespace {

// [-] Points of a leg at which a gap is evaluated, and bisections that then refine the smallest.
constexpr int kPlaces = 12, kHalvings = 40;
// [m] A gap below this is a contact; the record has its event.
constexpr double kTouching = 1e-9;

// [s] Around an event: the gap is smallest at the event only if it is larger before and after it.
constexpr double kAround = 1e-6;

template <class GapAt>
double nearest_time(const GapAt& gap, double from, double to) {
    double best = from, least = std::numeric_limits<double>::infinity();
    const double step = (to - from) / kPlaces;
    for (int k = 0; k <= kPlaces; ++k) {
        const double t = k == kPlaces ? to : from + k * step, g = gap(t).x;
        if (!(g < least)) continue;
        least = g;
        best = t;
    }
    double low = std::max(from, best - step), high = std::min(to, best + step);
    for (int k = 0; k < kHalvings; ++k) {
        const double third = (high - low) / 3.0;
        if (gap(low + third).x < gap(high - third).x)
            high -= third;
        else
            low += third;
    }
    const double t = 0.5 * (low + high);
    return gap(t).x < least ? t : best;
}

BallAt<Vec3> numbers_at(const State& s, const Dual& R) {
    return {{s.r[0].x, s.r[1].x, s.r[2].x}, {s.v[0].x, s.v[1].x, s.v[2].x}, R.x};
}

}  // namespace

// Adds the smallest gap of two bodies between two times, unless they touch there.
void Replay::add_near(std::vector<Room>& rooms, const Pair& pair, const GapOf& gap, const Dual& from,
                      const Dual& to, const std::string& what) const {
    if (!(to.x > from.x)) return;
    const auto at = [&](const Dual& t) {
        return gap(pair.leg->at(t), pair.other_leg != nullptr ? pair.other_leg->at(t) : State());
    };
    const auto any_time = [&](double t) {
        return gap(leg_at(pair.ball, t).at(t), pair.other >= 0 ? leg_at(pair.other, t).at(t) : State()).x;
    };
    const double t = nearest_time(at, from.x, to.x), close = 1e-9 * (to.x - from.x);
    const bool first = t - from.x <= close, last = to.x - t <= close;
    // If the gap is smallest when an event changes the motion, that instant moves with the event.
    const Dual left = at(first ? from : last ? to : Dual(t));
    if (!(left.x > kTouching)) return;
    if ((first || last) && ((t > kAround && any_time(t - kAround) < left.x) ||
                            (t + kAround < until_ && any_time(t + kAround) < left.x)))
        return;
    rooms.push_back({left, fmt::format("{} at {:.3f} s", what, t)});
}

std::vector<Room> Replay::rooms() const {
    std::vector<Room> rooms = rooms_;
    const double end = until_;
    const auto ends = [end](const std::vector<Leg>& legs, std::size_t k) {
        return k + 1 < legs.size() ? legs[k + 1].start : Dual(end);
    };
    const auto moves = [](const Leg& leg) {
        return leg.from.v[0].x != 0.0 || leg.from.v[1].x != 0.0 || flies(leg.state);
    };
    for (std::size_t i = 0; i < balls_.size(); ++i) {
        const std::vector<Leg>& legs = balls_[i].legs;
        const int ball = static_cast<int>(i);
        for (std::size_t k = 0; k < legs.size(); ++k) {
            const Leg& leg = legs[k];
            if (is_gone(leg.state)) continue;
            const Dual to = ends(legs, k);
            // Consecutive events of the ball swap their order.
            if (k + 1 < legs.size() && to.x > leg.start.x) {
                const double at = to.x;
                rooms.push_back({to - leg.start,
                                 fmt::format("two events of {} change places at {:.3f} s", who(ball), at)});
                const Dual left = leg.start + leg.duration - to;
                if (left.x > 1e-9 && left.x < kNever)
                    rooms.push_back(
                        {left, fmt::format("{} changes its motion before its next event at {:.3f} s",
                                           who(ball), at)});
            }
            if (is_off_cloth(leg.state)) continue;
            const Dual& R = leg.R;
            const auto near_part = [&](const Contact& part, const std::string& name) {
                const auto gap = [&](const State& s, const State&) {
                    if (!beside(plan_.geometry, part, numbers_at(s, R))) return Dual(kNever);
                    return touch_part(numbers_, part, BallAt<Dual3>{s.r, s.v, R}).gap;
                };
                if (moves(leg))
                    add_near(rooms, {ball, &leg}, gap, leg.start, to, who(ball) + " meets " + name);
            };
            const Table& table = plan_.scene.table;
            for (int j = 0; j < static_cast<int>(numbers_.cushions.size()); ++j)
                near_part({ball, With::kCushion, j}, table.cushions[j].id);
            for (int j = 0; j < static_cast<int>(numbers_.noses.size()); ++j) {
                const Nose& nose = plan_.geometry.noses[j];
                near_part({ball, With::kNose, j}, nose.type == EventType::kBallJaw
                                                      ? table.jaws[nose.index].id
                                                      : "the end of " + table.cushions[nose.index].id);
            }
            for (std::size_t j = 0; moves(leg) && j < numbers_.pockets.size(); ++j) {
                const auto gap = [&pocket = numbers_.pockets[j]](const State& s, const State&) {
                    return length(planar(s.r) - pocket.center) - pocket.radius;
                };
                add_near(rooms, {ball, &leg}, gap, leg.start, to,
                         who(ball) + " falls into " + table.pockets[j].id);
            }
            for (std::size_t j = 0; j < balls_.size(); ++j) {
                const std::vector<Leg>& others = balls_[j].legs;
                for (std::size_t l = 0; j != i && l < others.size(); ++l) {
                    const Leg& other = others[l];
                    // Consider two moving balls only once.
                    if (!moves(leg) || (moves(other) && j < i) || is_off_cloth(other.state) ||
                        is_gone(other.state))
                        continue;
                    const Dual from = other.start.x > leg.start.x ? other.start : leg.start;
                    const Dual stop = ends(others, l);
                    add_near(
                        rooms, {ball, &leg, static_cast<int>(j), &other},
                        [&](const State& s, const State& o) {
                            return touch_level(BallAt<Dual3>{s.r, s.v, R}, {o.r, o.v, other.R},
                                               plan_.balls.discs())
                                .gap;
                        },
                        from, stop.x < to.x ? stop : to, who(ball) + " meets " + who(static_cast<int>(j)));
                }
            }
        }
    }
    return rooms;
}

}  // namespace carom::tangent

namespace carom {

std::vector<Margin> Tangents::margins() const {
    std::vector<Margin> margins(inputs_.size(), {kNever, kNever, "", ""});
    for (std::size_t first = 0; first < inputs_.size(); first += tangent::kLanes) {
        for (const tangent::Room& room : parts_->of(first).rooms()) {
            for (std::size_t i = first; i < std::min(inputs_.size(), first + tangent::kLanes); ++i) {
                const double rate = room.left.d[i - first],
                             move = std::max(0.0, room.left.x) / std::abs(rate);
                Margin& margin = margins[i];
                double& bound = rate < 0.0 ? margin.up : margin.down;
                if (!(move < bound)) continue;
                bound = move;
                (rate < 0.0 ? margin.up_why : margin.down_why) = room.what;
            }
        }
    }
    return margins;
}

}  // namespace carom
