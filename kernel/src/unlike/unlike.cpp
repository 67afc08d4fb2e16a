// Impacts of two balls that differ in mass or radius: by tolerance, and marched.
//
// By tolerance: Gauss collocation of 8 nodes over stretches of the normal impulse, solved by Picard sweeps.
// Three events end a stretch early, because they bend the forces: the slip between the balls ends, after
// which they stick; the pressed ball changes; the slip on the cloth passes near zero. A stretch that does not
// converge, or that its nodes do not resolve, is repeated with 0.4 of its length. Alike balls have a faster
// kernel.
#include "unlike/unlike.h"

#include <cstdint>

#include "carom/kernel/march.h"
#include "carom/kernel/tolerance.h"
#include "gauss.h"
#include "simd.h"
#include "unlike/tilted.h"

namespace carom::kernel {
namespace {

using Table = Gauss<8>;
constexpr int kNodes = 8;
constexpr int kSweeps = 24;
// If a slip between the balls grows slowly from zero, the forces are stiff and stretches short. After this
// many stretches the rest is solved to ten times the tolerance, and so on; after the last, without friction.
constexpr int kManyStretches = 1500, kStretches = 10000;
// [tolerances] Error allowed to one stretch, by its sweeps and by its nodes.
constexpr double kSweepsLeave = 0.02, kNodesLeave = 0.1;
// [tolerances] A slip between the balls below this has ended.
constexpr double kStuck = 0.1;
// A looser tolerance is solved as this one.
constexpr double kLoosestSolved = 1e-3;
// Largest remaining error, relative to the friction: more could raise the energy.
constexpr double kOfFriction = 0.03;
// Fractions of the slips' rounding, and of the tolerance, below which a slip on the cloth is zero.
constexpr double kNoise = 0x1p-49, kSlight = 0.01;
// Largest fraction that friction may take of the force that separates the balls, and that the cloth may take
// of the force along a slip on it: with these limits neither can stop the motion.
constexpr double kMostTaken = 0.9;

bool finite_forces(const Forces& f) {
    return finite((f.xi + f.zeta) + ((f.gx[0] + f.gx[1]) + (f.gy[0] + f.gy[1])));
}

CAROM_INLINE Forces times(double a, const Forces& f) {
    return {a * f.xi, a * f.zeta, {a * f.gx[0], a * f.gx[1]}, {a * f.gy[0], a * f.gy[1]}};
}

CAROM_INLINE void add(Forces& to, double a, const Forces& f) {
    to.xi += a * f.xi;
    to.zeta += a * f.zeta;
    for (int b = 0; b < 2; ++b) {
        to.gx[b] += a * f.gx[b];
        to.gy[b] += a * f.gy[b];
    }
}

double largest_of(const Forces& f) {
    return largest(largest(absolute(f.xi), absolute(f.zeta)),
                   largest(largest(absolute(f.gx[0]), absolute(f.gx[1])),
                           largest(absolute(f.gy[0]), absolute(f.gy[1]))));
}

double size(double a, double b) {
    return square_root(a * a + b * b);
}

// The loss of closing speed per normal impulse.
double parting(const Tilt& t, const Forces& f) {
    return t.C * ((t.C - t.S * f.zeta) + t.share[0] * f.gy[0] - t.share[1] * f.gy[1]);
}

// The impulse of an impact, over the reduced mass times the approach speed.
struct Impulses {
    double p = 0.0;  // along the normal
    Forces total{};
    std::int64_t steps = 0;  // or sweeps
};

enum class Until : unsigned char { kGiven, kParted, kWorked };

struct Stretch {
    Until until;
    double h;     // a guess, then the impulse
    double work;  // to be done, then done
};

class Solver {
  public:
    Solver(const Tilt& tilt, const Slips& start, double tolerance)
        : t_(tilt),
          s_(start),
          tolerance_(smallest(tolerance, tilt.mu_b > 0.0 ? kOfFriction * tilt.mu_b : tolerance)) {}

    void run() {
        double next = kFar;
        sticks_ = t_.mu_b > 0.0 && try_stick();
        for (int n = 1; n < kStretches; ++n) {
            if (n % kManyStretches == 0) tolerance_ = smallest(10.0 * tolerance_, kLoosestSolved);
            const double end =
                compressing_ ? s_.v / (t_.C * t_.C)
                             : 2.0 * left_ / (-s_.v + square_root(s_.v * s_.v + 2.0 * t_.C * t_.C * left_));
            const double most = smallest(next, sticks_ ? kFar : turning_room());
            const bool last = most >= 0.9 * end;
            Stretch stretch{last ? (compressing_ ? Until::kParted : Until::kWorked) : Until::kGiven,
                            last ? end : smallest(most, 0.6 * end), left_};
            const double asked = stretch.h, shortest = 1e-3 * tolerance_ / (t_.mu_b + t_.S);
            Slips after;
            Forces more;
            if (collocate(stretch, after, more)) {
                next = stretch.h * (sweeps_of_last_ < 10 ? 2.5 : 1.3);
            } else if (asked > shortest) {
                next = 0.4 * asked;
                continue;
            } else {
                // The last resort, which always makes progress: a negligible stretch.
                stretch.until = Until::kGiven;
                stretch.h = smallest(asked, shortest);
                const Forces f = forces(s_);
                more = times(stretch.h, f);
                after = moved(t_, s_, stretch.h, more);
                stretch.work = stretch.h * 0.5 * (s_.v + after.v);
                next = 2.0 * shortest;
            }
            done.p += stretch.h;
            add(done.total, 1.0, more);
            s_ = after;
            if (compressing_) {
                compressed_ += stretch.work;
                if (stretch.until == Until::kParted || s_.v <= 0.0) {
                    compressing_ = false;
                    s_.v = 0.0;
                    left_ = t_.e_b * t_.e_b * compressed_;
                    next = kFar;
                }
            } else {
                left_ += stretch.work;
                if (stretch.until == Until::kWorked) return;
            }
            if (!compressing_ && !(left_ > 0.0)) return;
            if (sticks_ && !can_stick(sticking_forces(t_, s_))) slip();
            if (!sticks_ && t_.mu_b > 0.0) sticks_ = try_stick();
        }
        finish_frictionless();
    }

    Impulses done;

  private:
    static constexpr double kFar = 1e300;

    Forces forces(const Slips& s) const { return sticks_ ? sticking_forces(t_, s) : sliding_forces(t_, s); }
    bool can_stick(const Forces& f) const { return f.xi * f.xi + f.zeta * f.zeta <= t_.mu_b * t_.mu_b; }

    void finish_frictionless() {
        const double r = t_.C * t_.C;
        if (compressing_) {
            done.p += s_.v / r;
            left_ = t_.e_b * t_.e_b * (compressed_ + 0.5 * s_.v * s_.v / r);
            s_.v = 0.0;
        }
        done.p += 2.0 * left_ / (-s_.v + square_root(s_.v * s_.v + 2.0 * r * left_));
    }

    // Whether the slip between the balls has ended and friction can hold them.
    bool try_stick() {
        if (!(size(s_.cx, s_.cz) <= kStuck * tolerance_)) return false;
        if (!can_stick(sticking_forces(t_, s_))) {
            slip();
            return false;
        }
        s_.cx = s_.cz = 0.0;
        return true;
    }

    // Friction cannot hold the balls: the slip starts along its own change.
    void slip() {
        sticks_ = false;
        Slips s = s_;
        s.cx = 0.0;
        s.cz = 1.0;
        for (int k = 0; k < 12; ++k) {
            const Slips one = moved(t_, s, 1.0, sliding_forces(t_, s));
            const double x = one.cx - s.cx, z = one.cz - s.cz, by = size(x, z);
            if (!(by > 0.0)) break;
            // Only half of the change, to prevent oscillation.
            const double mx = 0.5 * (s.cx + x / by), mz = 0.5 * (s.cz + z / by), m = size(mx, mz);
            if (!(m > 0.0)) break;
            s.cx = mx / m;
            s.cz = mz / m;
        }
        s_.cx = 2.0 * kStuck * tolerance_ * s.cx;
        s_.cz = 2.0 * kStuck * tolerance_ * s.cz;
    }

    // The impulse in which the slip between the balls changes by most of its size.
    double turning_room() const {
        const Slips one = moved(t_, s_, 1.0, sliding_forces(t_, s_));
        const double change = size(one.cx - s_.cx, one.cz - s_.cz);
        return change > 0.0 ? 0.6 * size(s_.cx, s_.cz) / change : kFar;
    }

    // Solves one stretch. Returns false if the sweeps do not converge, or the nodes do not resolve the
    // forces.
    bool collocate(Stretch& stretch, Slips& after, Forces& more) {
        Slips at[kNodes];
        Forces f[kNodes], mean{};
        const Forces first = forces(s_);
        for (Forces& each : f) each = first;
        bool converged = false;
        int k = 0;
        double h = stretch.h;
        for (; k < kSweeps && !converged; ++k) {
            for (int i = 0; i < kNodes; ++i) {
                Forces integral{};
                for (int j = 0; j < kNodes; ++j) add(integral, h * Table::integral[j][i], f[j]);
                at[i] = moved(t_, s_, h * Table::nodes[i], integral);
            }
            double change = 0.0;
            for (int i = 0; i < kNodes; ++i) {
                const Forces now = forces(at[i]);
                Forces other = now;
                add(other, -1.0, f[i]);
                change = largest(change, largest_of(other));
                f[i] = now;
            }
            const double before = h;
            h = end_of(stretch, f);
            if (!finite(h) || !finite_forces(f[kNodes - 1])) break;
            converged = h * change + absolute(h - before) <= kSweepsLeave * tolerance_ + 0x1p-50 * h;
        }
        done.steps += k;
        sweeps_of_last_ = k;
        if (!converged) return false;
        Forces top{};
        bool one = false, two = false;
        mean = {};
        double late = 0.0;
        for (int i = 0; i < kNodes; ++i) {
            add(mean, Table::weights[i], f[i]);
            add(top, Table::top[i], f[i]);
            late += Table::weights[i] * (1.0 - Table::nodes[i]) * parting(t_, f[i]);
            const bool second = t_.S + t_.C * f[i].zeta < 0.0;
            one |= !second;
            two |= second;
            if (sticks_ && !can_stick(f[i])) return false;
        }
        // For smooth forces, the error of the sums is of the order of the square of their highest mode; a
        // change of the pressed ball bends them.
        const double rough = largest_of(top), friction = t_.mu_b + t_.S;
        const double error = h * (one && two ? rough : smallest(rough, 8.0 * rough * rough / friction));
        if (!(error <= kNodesLeave * tolerance_ + 0x1p-50 * h)) return false;
        more = times(h, mean);
        after = moved(t_, s_, h, more);
        if (turns_round(at, after)) {
            double most = sticks_ ? 0.0 : t_.mu_b;
            for (const Forces& each : f)
                most = largest(most, size(each.gx[0] + each.gx[1], each.gy[0] + each.gy[1]));
            if (!(2.0 * h * most <= kNodesLeave * tolerance_ + 0x1p-50 * h)) return false;
        }
        stretch.h = h;
        stretch.work = s_.v * h - h * h * late;
        return true;
    }

    // Whether a slip with friction reverses between two nodes, which then resolve little of it.
    bool turns_round(const Slips* at, const Slips& after) const {
        const Slips* before = &s_;
        for (int i = 0; i <= kNodes; ++i) {
            const Slips& now = i < kNodes ? at[i] : after;
            if (!sticks_ && before->cx * now.cx + before->cz * now.cz < 0.0) return true;
            for (int ball = 0; ball < 2; ++ball)
                if (before->ux[ball] * now.ux[ball] + before->uy[ball] * now.uy[ball] < 0.0) return true;
            before = &now;
        }
        return false;
    }

    double end_of(const Stretch& stretch, const Forces* f) const {
        if (stretch.until == Until::kGiven) return stretch.h;
        double mean = 0.0, late = 0.0;
        for (int i = 0; i < kNodes; ++i) {
            const double w = Table::weights[i] * parting(t_, f[i]);
            mean += w;
            late += (1.0 - Table::nodes[i]) * w;
        }
        if (stretch.until == Until::kParted) return s_.v / mean;
        return 2.0 * left_ / (-s_.v + square_root(s_.v * s_.v + 4.0 * late * left_));
    }

    const Tilt t_;
    Slips s_;
    double tolerance_;
    bool compressing_ = true, sticks_ = false;
    double compressed_ = 0.0, left_ = 0.0;
    int sweeps_of_last_ = 0;
};

// Whether, with this friction, every impact of these balls has a solution in which they separate, and slip on
// the cloth.
bool friction_in_range(const Tilt& t) {
    if (!(t.mu_b <= kLargestFriction)) return false;
    for (int ball = 0; ball < 2; ++ball) {
        if (!(t.mu_s[ball] <= kLargestFriction)) return false;
        const double down = t.S + t.C * t.mu_b;
        if (!(t.S * t.mu_b + t.share[ball] * t.mu_s[ball] * down <= kMostTaken * t.C)) return false;
        if (t.drag < 0.0) continue;
        // Along the force that moves a ball's slip, which is smallest at one end of the friction's range.
        const double still = 3.5 * t.mu_s[ball] * t.S, most = 3.5 * t.mu_s[ball] * down;
        if (!(still <= kMostTaken * t.C && most <= kMostTaken * (t.C + (2.5 - t.S) * t.mu_b))) return false;
    }
    // Upward friction on ball 1 reduces its load, and turns it with the force.
    if (t.drag > 0.0) {
        const double up = smallest(t.mu_b, t.S / t.C);
        const double force = t.C - (2.5 - t.S) * up, load = t.S - t.C * up;
        if (!(3.5 * t.mu_s[0] * load <= kMostTaken * force)) return false;
    }
    return true;
}

bool sizes_in_range(const ImpactParams& p) {
    return p.radius_ratio >= 1.0 / kLargestRadiusRatio && p.radius_ratio <= kLargestRadiusRatio &&
           p.mass_ratio >= 1.0 / kLargestMassRatio && p.mass_ratio <= kLargestMassRatio;
}

// Checks the input and projects it into the contact frame. `params` has R of ball 1.
ImpactStatus enter(const Ball& b1, const Ball& b2, const ImpactParams& p, Frame& f, FrameState& s,
                   ImpactResult& out) {
    // The heights differ by the difference of the radii; the frame is that of centres at one height.
    Ball level = b2;
    const double up = p.R * (p.radius_ratio - 1.0);
    level.r[2] -= up;
    ImpactParams alike = p;
    alike.mass_ratio = alike.radius_ratio = 1.0;
    return enter_frame(b1, level, alike, f, s, out);
}

void swap_balls(ImpactParams& p) {
    const double mu = p.mu_s1;
    p.mu_s1 = p.mu_s2;
    p.mu_s2 = mu;
    p.R *= p.radius_ratio;
    p.m *= p.mass_ratio;
    p.radius_ratio = 1.0 / p.radius_ratio;
    p.mass_ratio = 1.0 / p.mass_ratio;
}

void swap_results(ImpactResult& r) {
    for (int k = 0; k < 3; ++k) {
        const double v = r.v1[k], w = r.w1[k];
        r.v1[k] = r.v2[k];
        r.w1[k] = r.w2[k];
        r.v2[k] = v;
        r.w2[k] = w;
    }
}

// Sets slips on the cloth to zero if they are rounding.
void drop_noise(const Ball& b1, const Ball& b2, double R1, double R2, double n, double slight, Slips& s) {
    const Ball* const balls[2] = {&b1, &b2};
    const double radius[2] = {R1, R2};
    for (int ball = 0; ball < 2; ++ball) {
        const Ball& b = *balls[ball];
        const double noise = kNoise * ((absolute(b.v[0]) + absolute(b.v[1])) +
                                       radius[ball] * (absolute(b.w[0]) + absolute(b.w[1])));
        if (size(s.ux[ball], s.uy[ball]) <= largest(noise / n, slight)) s.ux[ball] = s.uy[ball] = 0.0;
    }
}

// The impact of two unlike balls. `run` gets its constants and the slips (on the cloth, zero below a given
// size), and returns the impulses; steps < 0: it reached its limit.
template <class Run>
void impact(const Ball& ball1, const Ball& ball2, const ImpactParams& params, bool in_range,
            ImpactResult& result, const Run& run) {
    if (params.radius_ratio < 1.0) {
        ImpactParams swapped = params;
        swap_balls(swapped);
        impact(ball2, ball1, swapped, in_range, result, run);
        swap_results(result);
        return;
    }
    const Tilt tilt = tilt_of(params);
    if (!in_range || !sizes_in_range(params) || !friction_in_range(tilt)) {
        copy_input(ball1, ball2, ImpactStatus::kBadParameter, result);
        return;
    }
    Frame frame;
    FrameState state;
    if (enter(ball1, ball2, params, frame, state, result) != ImpactStatus::kOk) return;
    const double n = state.v1y - state.v2y, R1 = params.R, R2 = params.R * params.radius_ratio;
    const Impulses done = run(tilt, [&](double slight) {
        Slips slips = slips_of(tilt, state, R1, R2, n);
        drop_noise(ball1, ball2, R1, R2, n, slight, slips);
        return slips;
    });
    if (done.steps < 0) {
        copy_input(ball1, ball2, ImpactStatus::kStepLimit, result);
        return;
    }
    add_impulses(tilt, done.p, done.total, n, R1, R2, state);
    leave_frame(ball1, ball2, frame, state, done.steps, result);
}

}  // namespace

bool sizes_have_solution(const ImpactParams& params) noexcept {
    if (!sizes_in_range(params)) return false;
    if (alike(params))
        return params.mu_b <= kLargestFriction && params.mu_s1 <= kLargestFriction &&
               params.mu_s2 <= kLargestFriction;
    ImpactParams first = params;
    if (first.radius_ratio < 1.0) swap_balls(first);
    return friction_in_range(tilt_of(first));
}

void solve_unlike(const Ball& ball1, const Ball& ball2, const ImpactParams& params, double tolerance,
                  ImpactResult& result) noexcept {
    const bool in_range = tolerance >= kTightestTolerance && tolerance <= kLoosestTolerance;
    impact(ball1, ball2, params, in_range, result, [&](const Tilt& tilt, const auto& slips) {
        // A ball gets up to twice the error that the same impulse causes between equal balls, and the errors
        // of stretches add up.
        const double solved =
            0.25 * smallest(tolerance, kLoosestSolved) / largest(tilt.share[0], tilt.share[1]);
        Solver solver(tilt, slips(kSlight * solved), solved);
        solver.run();
        return solver.done;
    });
    if (result.status != ImpactStatus::kOk) return;
    result.method = ToleranceMethod::kAdaptive;
    if (!(finite(result.v1) && finite(result.v2) && finite(result.w1) && finite(result.w2)))
        copy_input(ball1, ball2, ImpactStatus::kBadState, result);
}

void march_unlike(const Ball& ball1, const Ball& ball2, const ImpactParams& params, int n,
                  ImpactResult& result) noexcept {
    impact(ball1, ball2, params, n >= 1, result, [&](const Tilt& tilt, const auto& slips) {
        Slips s = slips(0.0);
        const double h = (1.0 + tilt.e_b) * s.v / (tilt.C * tilt.C) / n;
        const std::int64_t limit = kMarchStepLimit * static_cast<std::int64_t>(n);
        double work = 0.0, goal = 0.0;
        Impulses done;
        bool compressing = true;
        while (s.v > 0.0 || compressing || work < goal) {
            if (++done.steps > limit) return Impulses{.steps = -1};
            // A slip that this step would reverse has ended: otherwise the steps would oscillate, and press
            // the two balls alternately.
            const bool ends = size(s.cx, s.cz) <= 3.5 * tilt.mu_b * h;
            const Forces stick = sticking_forces(tilt, s);
            const bool sticks =
                ends && stick.xi * stick.xi + stick.zeta * stick.zeta <= tilt.mu_b * tilt.mu_b;
            if (sticks) s.cx = s.cz = 0.0;
            const Forces f = times(h, sticks ? stick : sliding_forces(tilt, s));
            const double before = s.v;
            s = moved(tilt, s, h, f);
            done.p += h;
            add(done.total, 1.0, f);
            work += 0.5 * h * absolute(before + s.v);
            if (compressing && s.v < 0.0) {
                compressing = false;
                goal = (1.0 + tilt.e_b * tilt.e_b) * work;
            }
        }
        return done;
    });
}

}  // namespace carom::kernel
