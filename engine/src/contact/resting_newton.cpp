// Newton's method for the impulses of a group of resting contacts over an interval (resting_group.h).
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "contact/complementarity.h"
#include "contact/resting_group.h"
#include "physics/motion.h"

namespace carom::resting {

namespace {

// [-] Most Newton steps of one solution. A few are usual; a step is exact once every ball's kind of motion is
// right.
constexpr int kNewtonSteps = 40;
// [-] Up to this step, the effect of load changes on the friction of the cloth is part of the linear problem.
// That saves steps, but has no solution if balls lock each other.
constexpr int kLoadSteps = 12;
// [-] From this step on, every second one treats balls that hardly move as stopped: close to rest, Newton's
// method only halves their speed again and again.
constexpr int kStopsFrom = 5;
// [of the interval] Give the interval up if a Newton step shows that its solution is accurate for less than
// this.
constexpr double kTooLong = 0.95;
// [of the wrong rates] A step that leaves more of them makes no progress.
constexpr double kStandsStill = 0.9;
// [-] A gap whose normal turns further than this is not examined in detail: the interval is shortened anyway.
constexpr double kLongestTurn = 0.1;
// [m] Overlap that the turning of a normal may cause within an interval.
constexpr double kOverlapLeft = 4e-15;
// [m] and [of the gap] Tolerance of a gap after an interval if it opens, and share of a gap by which it may
// close; the turning of its normal may use the rest. An existing overlap reduces the tolerance. A gap that
// opens under an impulse gains energy; this share [of the group's] is rounding.
constexpr double kOpensUnnoticed = 1e-10, kGapUsed = 0.1, kEnergyUnnoticed = 1e-13;
// [m] Smaller changes of a gap are ignored.
constexpr double kNoGap = 4e-15;
// [-] Most trials of a line search, and the share of its first slope that may remain.
constexpr int kSearches = 8;
constexpr double kSlopeLeft = 0.25;
// [of its coefficient] Accuracy of the friction between balls; or [m] its tolerance in a position, as long as
// it is at most this share in a speed [of the fastest]. The first two double in each step, this many times at
// most, for contacts that hold each other's slip.
constexpr double kFrictionAccuracy = 1e-9, kFrictionPlace = 1e-11, kFrictionSpeed = 1e-6;
constexpr int kLooser = 20, kLooserPlace = 10;

// Change of the upward slip of two balls per unit of impulse between them.
double ease_of(const Group& g, const Link& link) {
    const auto ease = [](const Body& b) {
        return b.ease * (b.mode == Mode::kSliding ? 2.5 : (b.mode == Mode::kRolling ? 5.0 / 7.0 : 0.0));
    };
    return ease(g.bodies[link.i]) + ease(g.bodies[link.j]);
}

// The rate that must not be negative: that of a gap at the end, with the turning of its normal.
double wanted_rate(const Group& g, const Link& link, double h, const StepOptions& options) {
    return end_rate(g, link) + (options.stabilise ? h * link.turning : 0.0);
}

// The friction between two balls opposes their slip at the end. With the upward slip X without it, and the
// impulse's effect on it, f = -X / (effect + |slip| / mu), where |slip| follows from a few iterations of the
// secant method.
double vertical_friction(const Group& g, const Link& link) {
    // A friction that holds two balls at rest may have any size.
    if (g.bodies[link.i].mode == Mode::kResting && g.bodies[link.j].mode == Mode::kResting)
        return link.friction_z;
    const Vec2 slip = contact_slip(g, link, true);
    const double effect = ease_of(g, link) * link.J;
    const double without = slip.x() - effect * link.friction_z;
    double size = length(slip), f = 0.0, size_before = 0.0, change_before = 0.0;
    for (int turn = 0; turn < 30; ++turn) {
        const double mu = g.around.balls.ball_friction()(size);
        const double whole = effect + (mu > 0.0 ? size / mu : 0.0);
        if (mu == 0.0 || !(whole > 0.0)) return 0.0;
        f = -without / whole;
        const double next = length(Vec2(without + effect * f, slip.y())), change = next - size;
        if (std::abs(change) <= 1e-12 * size) break;
        const double secant = size - change * (size - size_before) / (change - change_before);
        size_before = size;
        change_before = change;
        size = turn > 0 && secant > 0.0 ? secant : next;
    }
    const double most = g.around.balls.ball_friction()(size);
    return std::clamp(f, -most, most);
}

// [m/s^2] Correction to the acceleration of a gap along its first normal. With the tangential velocity v and
// acceleration a and the distance D, the gap opens by 1/2 (v^2 t^2 + v a t^3 + 1/4 a^2 t^4) / D as the normal
// turns, and its rate ends at 0 for (v^2 + 3/2 v a h + 1/2 a^2 h^2) / D. If the gap would become negative
// meanwhile, let it open instead. Overlaps end within the interval.
double turning_of(const Link& link, const Across& t, double h) {
    const double time = std::max(h, kRecoveryTime);
    const double recovery = link.gap < -kOverlapDepth ? 2.0 * link.gap / (time * time) : 0.0;
    if (t.distance == 0.0) return recovery;
    const double c = t.v * t.v / t.distance, k = t.v * t.a / t.distance, kk = t.a * t.a / t.distance;
    // A change that rounds to no gap would only stop balls at rest from leaning on each other.
    if (h * h * (std::abs(c) + h * (std::abs(k) + std::abs(kk) * h)) <= kNoGap) return recovery;
    const double taylor = c + h * (1.5 * k + 0.5 * kk * h);
    // The distance along the first normal is somewhat shorter by then.
    const double level = taylor / std::max(0.5, 1.0 - 0.5 * taylor * h * h / t.distance);
    double least = c;
    bool free = std::abs(level) * h * h < kLongestTurn * std::abs(t.distance);
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
        const double x = share * h, n = -0.5 * level * x * x, across = x * (t.v + 0.5 * x * t.a),
                     D = t.distance;
        const double apart = length(Vec2(D + n, across));
        const double change = (n * (2.0 * D + n) + across * across) / (D + (D < 0.0 ? -apart : apart));
        free = free && (1.0 - kGapUsed) * std::max(0.0, link.gap) + change >= -kOverlapLeft;
        least = std::min(least, c + x * (k + 0.25 * kk * x));
    }
    if (k < 0.0 && -2.0 * k < kk * h) least = c - k * k / kk;
    return (free ? level : std::min(level, least)) + recovery;
}

// Takes from a solution the starting values of the next one, except frictions that are right already, so that
// the impulses that belong to them stay right.
// @return whether anything changed
bool update(Group& g, double h, const StepOptions& options, int times) {
    const double accuracy = kFrictionAccuracy * static_cast<double>(1 << std::min(times, kLooser)) *
                            g.around.balls.ball_friction()(0.0);
    double fastest = 0.0;
    for (const Body& b : g.bodies) fastest = std::max(fastest, length(b.v_end));
    const double place = kFrictionPlace * static_cast<double>(1 << std::min(times, kLooserPlace)),
                 left = std::min(place / std::max(h, kShortestInterval), kFrictionSpeed * fastest);
    bool changed = false;
    for (Link& link : g.links) {
        if (options.stabilise && !link.open && !link.walled) {
            const double wanted = turning_of(link, across(g, link, h), h);
            changed = changed || std::abs(wanted - link.turning) * h * h > kNoGap;
            link.turning = wanted;
        }
        if (link.j < 0 || link.open || !options.friction) continue;
        const double f = link.J > 0.0 ? vertical_friction(g, link) : friction_at_start(g, link);
        const double wrong = std::abs(f - link.friction_z);
        if (link.J > 0.0 && (wrong <= accuracy || wrong * link.J <= left)) continue;
        changed = changed || link.J > 0.0;
        // The next contact of these balls already uses it.
        const Vec2 change = (f - link.friction_z) * link.J * link.n;
        for (const int k : {link.i, link.j}) {
            Body& b = g.bodies[k];
            if (b.mode == Mode::kSliding) b.s_end -= (2.5 * b.ease) * change;
            if (b.mode == Mode::kRolling) b.s_end -= (5.0 / 7.0 * b.ease) * change;
        }
        link.friction_z = f;
    }
    return changed;
}

/// Frictions between balls follow from a solution and change the next one. Two successive changes predict the
/// limit (D. G. Anderson, "Iterative procedures for nonlinear integral equations", J. ACM 12, 1965, with one
/// step back). Without that, balls that hold each other's spin would approach it by a few percent per step.
class Extrapolation {
  public:
    void note(const Group& g) {
        before_.clear();
        for (const Link& link : g.links) before_.push_back(link.friction_z);
    }
    void forget() { last_.clear(); }
    /// @param g  with the frictions that follow from those passed to note()
    void extrapolate(Group& g) {
        const bool known = !last_.empty();
        now_.clear();
        change_.resize(g.links.size());
        double both = 0.0, square = 0.0;
        for (std::size_t c = 0; c < g.links.size(); ++c) {
            const Link& link = g.links[c];
            const double change = link.J * (link.friction_z - before_[c]), more = change - change_[c];
            both += change * more;
            square += more * more;
            change_[c] = change;
            now_.push_back(link.friction_z);
        }
        if (known && square > 0.0) {
            const double back = std::clamp(both / square, -kFarthest, 1.0),
                         most = g.around.balls.ball_friction()(0.0);
            for (std::size_t c = 0; c < g.links.size(); ++c) {
                Link& link = g.links[c];
                if (link.j >= 0 && link.J > 0.0)
                    link.friction_z = std::clamp(now_[c] - back * (now_[c] - last_[c]), -most, most);
            }
        }
        last_.swap(now_);
    }

  private:
    static constexpr double kFarthest = 50.0;  // [changes]
    std::vector<double> before_, now_, last_;  // frictions
    std::vector<double> change_;               // of the vertical impulses
};

/// The impulses of the contacts that do not open, by Newton's method on J >= 0, rate >= 0, J rate = 0. The
/// problem is piecewise smooth and, except for the friction between balls, monotone.
class Newton {
  public:
    Newton(Group& g, double h, const StepOptions& options)
        : g_(g), h_(h), options_(options), problem_(g.problem) {
        for (std::size_t c = 0; c < g.links.size(); ++c) {
            if (g.links[c].open)
                g.links[c].J = 0.0;
            else
                active_.push_back(c);
        }
        problem_.resize(active_.size());
        before_.resize(active_.size());
        rates_.resize(active_.size());
        list_contacts();
    }

    /// @return whether there is a solution; if Group::cut is set, the search was given up
    bool run() {
        for (int newton = 0;; ++newton) {
            const bool stops = newton >= kStopsFrom && newton % 2 == 1;
            respond(g_, h_, options_.friction, stops);
            // Values that depend on the last solution: friction between balls, turning of normals.
            frictions_.note(g_);
            const bool changed = update(g_, h_, options_, newton);
            if (changed) {
                frictions_.extrapolate(g_);
                respond(g_, h_, options_.friction, stops);
            } else {
                frictions_.forget();
            }
            bool harmless = !changed;
            if (is_solved(harmless) && !changed) return true;
            if (newton >= kStopsFrom && harmless) return true;
            if (newton == kNewtonSteps || (newton > kStopsFrom && !changed && stands_still())) return false;
            worst_before_ = worst_;
            if (!solve(newton < kLoadSteps ? 1.0 : 0.0)) return harmless;
            search();
            if (options_.may_cut && newton > 0 && is_too_long()) return false;
        }
    }

  private:
    // Whether a whole step of the same linear problem has not improved the rates: rounding decides.
    bool stands_still() const {
        bool same = whole_ && worst_ > kStandsStill * worst_before_ && modes_.size() == g_.bodies.size();
        for (std::size_t b = 0; b < modes_.size(); ++b) same = same && modes_[b] == g_.bodies[b].mode;
        return same;
    }

    bool is_too_long() {
        const double holds = accurate_interval(g_, h_);
        if (holds < kTooLong * h_) g_.cut = holds;
        return g_.cut > 0.0;
    }

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

    double rate(std::size_t k) const { return wanted_rate(g_, g_.links[active_[k]], h_, options_); }

    // [m] Tolerance of a gap after the interval, beyond that of a touch without a gap.
    double room_of(const Link& link, double rate, double energy) const {
        if (h_ == 0.0) return 0.0;
        if (rate > 0.0) return link.J * rate <= kEnergyUnnoticed * energy ? kOpensUnnoticed : 0.0;
        return link.gap > 0.0 ? kGapUsed * link.gap : std::max(-kOverlapGrowth, link.gap);
    }

    // Stores the rates. If balls alternate between rest and rolling, a share of kRestCompliance remains,
    // which is harmless unless a gap notices it.
    bool is_solved(bool& harmless) {
        const double rounding = rate_rounding(g_), time = std::max(h_, kShortestInterval);
        double energy = 0.0;
        for (const Body& b : g_.bodies) energy += (dot(b.v, b.v) + kInertia * dot(b.s, b.s)) / b.ease;
        bool solved = true;
        worst_ = 0.0;
        for (std::size_t k = 0; k < active_.size(); ++k) {
            const double now = rates_[k] = rate(k);
            const Link& link = g_.links[active_[k]];
            const double wrong = link.J > 0.0 ? std::abs(now) : -now;
            solved = solved && wrong <= rounding;
            worst_ = std::max(worst_, wrong);
            harmless =
                harmless && wrong <= std::max(rounding, (kOverlapGrowth + room_of(link, now, energy)) / time);
        }
        return solved;
    }

    // With friction there may be no solution, so do not search long.
    bool solve(double lifts) {
        linearise(lifts);
        if (problem_.solve(!options_.friction)) return true;
        if (lifts == 0.0) return false;
        linearise(0.0);
        return problem_.solve(!options_.friction);
    }

    // rate + A (J - J now) for the present kinds of motion.
    void linearise(double lifts) {
        modes_.clear();
        for (const Body& b : g_.bodies) modes_.push_back(b.mode);
        problem_.q = rates_;
        problem_.clear();
        for (std::size_t k = 0; k < active_.size(); ++k) {
            const Link& column = g_.links[active_[k]];
            problem_.z[k] = column.J;
            problem_.begin_column();
            const Body& bi = g_.bodies[column.i];
            Vec2 dvi =
                -(bi.by_push * column.n) - column.friction_z * (bi.by_couple * column.n - lifts * bi.by_lift);
            if (column.tilt != 0.0) dvi -= (lifts * column.tilt) * bi.by_lift;
            double own = -dot(column.n, dvi);
            add(k, column.i, dvi);
            if (column.j >= 0) {
                const Body& bj = g_.bodies[column.j];
                Vec2 dvj = bj.by_push * column.n -
                           column.friction_z * (bj.by_couple * column.n + lifts * bj.by_lift);
                if (column.tilt != 0.0) dvj += (lifts * column.tilt) * bj.by_lift;
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

    // Without friction between balls, the rates are the gradient of a convex function of the impulses. A line
    // search towards the solution of the linear problem takes its minimum, so that two kinds of motion do not
    // alternate.
    void search() {
        const double first = slope();
        double low = 0.0, at_low = first, high = 1.0;
        go(1.0);
        whole_ = true;
        double at_high = slope();
        for (int turn = 0; turn < kSearches && at_high > kSlopeLeft * std::abs(first) && at_low < 0.0;
             ++turn) {
            const double share = std::clamp(low + (high - low) * at_low / (at_low - at_high),
                                            low + 0.1 * (high - low), high - 0.1 * (high - low));
            go(share);
            whole_ = false;
            const double here = slope();
            if (std::abs(here) <= kSlopeLeft * std::abs(first)) break;
            (here > 0.0 ? high : low) = share;
            (here > 0.0 ? at_high : at_low) = here;
        }
    }

    void go(double share) {
        for (std::size_t k = 0; k < active_.size(); ++k)
            g_.links[active_[k]].J = before_[k] + share * (problem_.z[k] - before_[k]);
        respond(g_, h_, options_.friction);
    }

    double slope() const {
        double sum = 0.0;
        for (std::size_t k = 0; k < active_.size(); ++k) sum += rate(k) * (problem_.z[k] - before_[k]);
        return sum;
    }

    Group& g_;
    const double h_;
    const StepOptions options_;
    std::vector<std::size_t> active_;  // links
    Complementarity& problem_;
    Extrapolation frictions_;
    std::vector<Mode> modes_;                  // at the last linear problem
    bool whole_ = false;                       // whether its solution was taken in full
    double worst_ = 0.0, worst_before_ = 0.0;  // [m/s] largest wrong rate, now and before the last step
    std::vector<double> before_, rates_;       // impulses and rates before the step, as active_
    // The contacts of each ball, as indices into active_, and where those of each ball begin.
    std::vector<std::size_t> of_body_, first_;
};

}  // namespace

double slip_ended(const Group& g, const Link& link) {
    return ease_of(g, link) * g.around.balls.ball_friction()(length(contact_slip(g, link, false))) * link.J;
}

bool solve_newton(Group& g, double h, const StepOptions& options) {
    return Newton(g, h, options).run();
}

}  // namespace carom::resting
