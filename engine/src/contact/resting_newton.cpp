// Newton's method for the impulses of a group of resting contacts over an interval (resting_group.h).
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "carom/engine/tolerances.h"
#include "contact/complementarity.h"
#include "contact/resting_group.h"
#include "physics/motion.h"

namespace carom::resting {

namespace {

// Change of the upward slip of two balls per unit of impulse between them.
double ease_of(const Group& g, const Link& link) {
    const auto ease = [](const Body& b) {
        return b.ease * (b.mode == Mode::kSliding ? 2.5 : (b.mode == Mode::kRolling ? 5.0 / 7.0 : 0.0));
    };
    return ease(g.bodies[link.i]) + ease(g.bodies[link.j]);
}

// The rate that must not be negative: at an instant, the gap's rate plus the allowed closing rate; over an
// interval, the rate that leads to the gap which the contact keeps.
double wanted_rate(const Group& g, const Link& link, double h, bool stabilise) {
    return end_rate(g, link) + (h == 0.0 ? link.slack : stabilise ? h * link.turning : 0.0);
}

// The friction impulse between two balls opposes their slip at the end. With X the upward slip without it,
// and `effect` its effect on the slip, Z = -X / (effect + |slip| / (mu J)); a few secant iterations give
// |slip|.
double vertical_impulse(const Group& g, const Link& link) {
    const double most = g.around.balls.ball_friction()(0.0) * link.J;
    // Friction that holds two resting balls may have any size up to its limit.
    if (g.bodies[link.i].mode == Mode::kResting && g.bodies[link.j].mode == Mode::kResting)
        return std::clamp(link.Z, -most, most);
    const Vec2 slip = contact_slip(g, link, true);
    const double effect = ease_of(g, link), without = slip.x() - effect * link.Z;
    double size = length(slip), Z = 0.0, size_before = 0.0, change_before = 0.0;
    for (int turn = 0; turn < 30; ++turn) {
        const double mu = g.around.balls.ball_friction()(size);
        const double whole = effect + (mu > 0.0 ? size / (mu * link.J) : 0.0);
        if (mu == 0.0 || !(whole > 0.0)) return 0.0;
        Z = -without / whole;
        const double next = length(Vec2(without + effect * Z, slip.y())), change = next - size;
        if (std::abs(change) <= 1e-12 * size) break;
        const double secant = size - change * (size - size_before) / (change - change_before);
        size_before = size;
        change_before = change;
        size = turn > 0 && secant > 0.0 ? secant : next;
    }
    const double now = g.around.balls.ball_friction()(size) * link.J;
    return std::clamp(Z, -now, now);
}

// The normal in the middle of the interval, and Link::turning.
struct Turn {
    Vec2 n;
    double turning;
};

// A contact ends the interval where gap + h/2 rate equals the gap that it keeps, so that an error has
// disappeared after two intervals. It keeps the gap at which its present rate would end uniformly, within
// limits: a normal that turns needs room on both sides, because the gap's acceleration changes. Overlaps are
// removed, and the other gaps of the group may close by the same amount: otherwise the whole row would be
// pressed, and would push out balls at its side.
Turn turn_of(const Group& g, const Link& link, double h) {
    const Vec2 v = relative(g, link, &Body::v), v_end = relative(g, link, &Body::v_end);
    const double rate = dot(link.first, v), D = link.distance;
    // room [m] for the turning; the gap and its rate at the end; the part of the rate that is not along n
    const auto correction = [&](double room, double gap_end, double rate_end, double turned) {
        double least = link.gap < -kOverlapDepth ? 0.0 : std::min(link.gap, 0.0);
        if (room > kNoGap) least = std::max(least, std::min(kGapKept, room));
        const double even = std::clamp(link.gap + 0.5 * h * rate, least, std::max(least, kGapKept));
        const double kept = even - std::clamp(link.gap, 0.0, g.overlap);
        return (0.5 * (turned - rate_end) + (gap_end - kept) / h) / h;
    };
    const double level_end = dot(link.first, v_end);
    Turn level{link.first, correction(0.0, link.gap + 0.5 * h * (rate + level_end), level_end, 0.0)};
    if (D == 0.0) return level;
    const Vec2 moved = (0.5 * h) * (v + v_end);
    // Far from a solution.
    if (length(moved) > kLongestTurn * std::abs(D)) {
        const double across = cross(link.first, v);
        return {link.first, level.turning + across * across / D};
    }
    const Vec2 from = (D + link.gap) * link.first, middle = from + 0.5 * moved, to = from + moved;
    const double sign = std::copysign(1.0, D), far = length(middle), far_end = length(to);
    const Vec2 n = (sign / far) * middle, n_end = (sign / far_end) * to;
    const double turn = cross(moved, n) / D, turn_squared = turn * turn;
    const double room =
        2.0 * h * std::abs(turn * cross(v_end - v, n)) + std::abs(D) * turn_squared * turn_squared / 32.0;
    const double gap_end = link.gap + 2.0 * dot(moved, n) * far / (length(from) + far_end);
    const double turning = correction(room, gap_end, dot(n, v_end), dot(n_end - n, v_end));
    // A change that rounds to no gap would only make resting balls stop leaning on each other.
    return {n, std::abs(turning - level.turning) * h * h <= kNoGap ? level.turning : turning};
}

// Computes from one solution the vertical impulses and normals of the next. They lag by one step, so that the
// rates are the gradient of a convex function of the level impulses.
// @return whether anything changed
bool update(Group& g, double h, bool stabilise, int times) {
    if (h == 0.0) return false;
    const double left = kFrictionPlace / std::max(h, kShortestInterval);
    bool changed = false;
    g.smooth = times >= kFallsFrom;
    for (Body& b : g.bodies) {
        const double slid = std::min(1.0, slip_gone(g, b, h) / h);
        if (!moves(b.u) || std::abs(slid - b.slid) * g.motion.roll * h <= left) continue;
        changed = true;
        b.slid = slid;
    }
    for (Link& link : g.links) {
        if (stabilise && !link.open) {
            const Turn wanted = turn_of(g, link, h);
            if ((times == 0 && length(wanted.n - link.n) > kRateUlp * kEpsilon) ||
                std::abs(wanted.turning - link.turning) * h * h > kNoGap ||
                link.J * h * length(wanted.n - link.n) > kFrictionPlace) {
                changed = true;
                link.turning = wanted.turning;
                link.n = wanted.n;
            }
        }
        if (link.j < 0) continue;
        double Z = !(link.J > 0.0) || times >= kNoneFrom ? 0.0
                   : link.guide                          ? *link.guide * link.J
                                                         : vertical_impulse(g, link);
        if (times >= kFallsFrom)
            Z = Z * link.Z > 0.0 ? std::copysign(std::min(std::abs(Z), std::abs(link.Z)), Z) : 0.0;
        const double lift = Z - link.tilt * link.J;
        const double wrong = std::max(std::abs(Z - link.Z), std::abs(lift - link.lift));
        if (wrong <= left) continue;
        changed = true;
        // The next contact of these balls already uses it.
        const Vec2 change = (Z - link.Z) * link.n;
        for (const int k : {link.i, link.j}) {
            Body& b = g.bodies[k];
            if (b.mode == Mode::kSliding) b.s_end -= (2.5 * b.ease) * change;
            if (b.mode == Mode::kRolling) b.s_end -= (5.0 / 7.0 * b.ease) * change;
        }
        link.Z = Z;
        link.lift = lift;
        link.friction_z = link.J > 0.0 ? Z / link.J : 0.0;
    }
    return changed;
}

/// [m/s] Rounding of the gap rates.
double rate_rounding(const Group& g) {
    double size = 0.0;
    for (const Body& b : g.bodies) size = std::max(size, length(b.v) + length(b.v_end) + b.impulses);
    return kRateUlp * kEpsilon * size;
}

/// Solves for the impulses of the contacts that do not open, by Newton's method on J >= 0, rate >= 0, J rate
/// = 0, which is piecewise smooth and monotone.
class Newton {
  public:
    Newton(Group& g, double h, bool stabilise) : g_(g), h_(h), stabilise_(stabilise), problem_(g.problem) {
        g.overlap = 0.0;
        for (std::size_t c = 0; c < g.links.size(); ++c) {
            if (g.links[c].open) {
                g.links[c].J = 0.0;
                continue;
            }
            active_.push_back(c);
            if (g.links[c].gap < -kOverlapDepth) g.overlap = std::max(g.overlap, -g.links[c].gap);
        }
        problem_.resize(active_.size());
        before_.resize(active_.size());
        rates_.resize(active_.size());
        list_contacts();
    }

    /// @return whether there is a solution
    bool run() {
        for (int newton = 0;; ++newton) {
            respond(g_, h_);
            const bool changed = update(g_, h_, stabilise_, newton);
            if (changed) respond(g_, h_);
            bool harmless = !changed;
            if (is_solved(harmless) && !changed) return true;
            if (newton >= kHarmlessFrom && harmless) return true;
            if (newton == kNewtonSteps) return false;
            linearise();
            if (!problem_.solve()) return harmless;
            search();
        }
    }

  private:
    void list_contacts() {
        first_.assign(g_.bodies.size() + 1, 0);
        const auto each = [this](auto&& take) {
            for (std::size_t k = active_.size(); k-- > 0;) {
                const Link& link = g_.links[active_[k]];
                take(k, link.i);
                if (link.j >= 0) take(k, link.j);
            }
        };
        each([this](std::size_t, int body) { ++first_[body]; });
        for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
        of_body_.resize(first_.back());
        each([this](std::size_t k, int body) { of_body_[--first_[body]] = k; });
    }

    double rate(std::size_t k) const { return wanted_rate(g_, g_.links[active_[k]], h_, stabilise_); }

    // Stores the rates. If balls alternate between rest and rolling, errors of the order of kRestCompliance
    // remain, which are harmless unless they change a gap noticeably.
    bool is_solved(bool& harmless) {
        const double rounding = rate_rounding(g_), time = std::max(h_, kShortestInterval);
        bool solved = true;
        for (std::size_t k = 0; k < active_.size(); ++k) {
            const double now = rates_[k] = rate(k);
            const Link& link = g_.links[active_[k]];
            const double wrong = link.J > 0.0 ? std::abs(now) : -now;
            solved = solved && wrong <= rounding;
            harmless = harmless && wrong <= std::max(rounding, kOverlapGrowth / time);
        }
        return solved;
    }

    // rate + A (J - J now) for the present modes of motion.
    void linearise() {
        problem_.q = rates_;
        problem_.clear();
        for (std::size_t k = 0; k < active_.size(); ++k) {
            const Link& column = g_.links[active_[k]];
            problem_.z[k] = column.J;
            problem_.begin_column();
            const Body& bi = g_.bodies[column.i];
            const Vec2 dvi = -(bi.by_push * column.n);
            double own = -dot(column.n, dvi);
            add(k, column.i, dvi);
            if (column.j >= 0) {
                const Vec2 dvj = g_.bodies[column.j].by_push * column.n;
                own += dot(column.n, dvj);
                add(k, column.j, dvj);
            }
            problem_.add(k, own);
        }
        before_ = problem_.z;
        problem_.multiply_add(-1.0, before_, problem_.q);
    }

    // Adds the effect of a change dv of a ball's velocity on the rates of its contacts, except number k.
    void add(std::size_t k, int body, const Vec2& dv) {
        for (std::size_t n = first_[body]; n < first_[body + 1]; ++n) {
            const std::size_t r = of_body_[n];
            if (r == k) continue;
            const Link& row = g_.links[active_[r]];
            problem_.add(r, row.i == body ? -dot(row.n, dv) : dot(row.n, dv));
        }
    }

    // The rates are the gradient of a convex function of the impulses. A line search towards the solution of
    // the linear problem finds its minimum, so that two modes of motion do not alternate.
    void search() {
        const double first = slope();
        double low = 0.0, at_low = first, high = 1.0;
        go(1.0);
        double at_high = slope();
        for (int turn = 0; turn < kSearches && at_high > kSlopeLeft * std::abs(first) && at_low < 0.0;
             ++turn) {
            const double share = std::clamp(low + (high - low) * at_low / (at_low - at_high),
                                            low + 0.1 * (high - low), high - 0.1 * (high - low));
            go(share);
            const double here = slope();
            if (std::abs(here) <= kSlopeLeft * std::abs(first)) break;
            (here > 0.0 ? high : low) = share;
            (here > 0.0 ? at_high : at_low) = here;
        }
    }

    void go(double share) {
        for (std::size_t k = 0; k < active_.size(); ++k)
            g_.links[active_[k]].J = before_[k] + share * (problem_.z[k] - before_[k]);
        respond(g_, h_);
    }

    double slope() const {
        double sum = 0.0;
        for (std::size_t k = 0; k < active_.size(); ++k) sum += rate(k) * (problem_.z[k] - before_[k]);
        return sum;
    }

    Group& g_;
    const double h_;
    const bool stabilise_;
    std::vector<std::size_t> active_;  // links
    Complementarity& problem_;
    std::vector<double> before_, rates_;  // impulses and rates before the step, indexed as active_
    // The contacts of each ball, as indices into active_, and the start of each ball's list.
    std::vector<std::size_t> of_body_, first_;
};

}  // namespace

double slip_ended(const Group& g, const Link& link) {
    return ease_of(g, link) * g.around.balls.ball_friction()(length(contact_slip(g, link, false))) * link.J;
}

double friction_at_start(const Group& g, const Link& link) {
    const Vec2 slip = contact_slip(g, link, false);
    const double size = length(slip);
    return size > 0.0 ? -g.around.balls.ball_friction()(size) * slip.x() / size : 0.0;
}

bool step(Group& g, double h) {
    // Warm start: scale the last solution by the ratio of the interval lengths.
    const double share = g.solved > 0.0 ? h / g.solved : 0.0;
    for (Link& link : g.links) {
        link.J *= share;
        link.Z *= share;
        link.lift *= share;
        if (share == 0.0) {
            link.turning = 0.0;
            link.n = link.first;
        }
    }
    for (Body& b : g.bodies) {
        b.v_end = b.v + share * (b.v_end - b.v);
        b.s_end = b.s + share * (b.s_end - b.s);
    }
    bool solved = Newton(g, h, h > 0.0).run();
    // Two opposing normals that turn may make the problem infeasible: then keep the first normals.
    if (!solved && h > 0.0) {
        for (Link& link : g.links) {
            link.J = link.Z = link.lift = link.turning = 0.0;
            link.n = link.first;
        }
        solved = Newton(g, h, false).run();
    }
    g.solved = solved ? h : 0.0;
    return solved;
}

bool strike(Group& g) {
    g.solved = 0.0;
    const bool solved = step(g, 0.0);
    g.solved = 0.0;
    return solved;
}

}  // namespace carom::resting
