// Cushion model `mathavan_2010`: Mathavan, Jackson, Parkin, "A theoretical analysis of billiard ball dynamics
// under cushion impacts", Proc. IMechE C 224 (2010). The published code integrates by explicit Euler steps in
// the normal impulse; here the error per step is controlled.
//
// Frame: y points into the cushion, z up, and x = y x z. a = R w. s and c are the sine and cosine of the
// nose's height angle. q is the friction of the nose (|q| <= f) against the slip I there, p that of the cloth
// (|p| <= mu_s N) against the slip C, and N = max(0, s + c q_y) is the load on the cloth. Per unit of normal
// impulse over mass:
//   dv_x = -(q_x + p_x)          da_x = -(5/2) (q_y + p_y)       I = (v_x + s a_y - c a_z, -s v_y + a_x)
//   dv_y = -(c - s q_y + p_y)    da_y = -(5/2) (s q_x - p_x)     C = (v_x - a_y, v_y + a_x)
//                                da_z =  (5/2) c q_x
// A slip gives q = f I/|I| and p = mu_s N C/|C|. If a slip vanishes, the contact sticks if static friction
// can hold it (the limit of ever smaller explicit Euler steps). Otherwise it continues to slip in the
// direction in which it is driven. The two contacts never stick at the same time, because that would stop the
// ball.
//
// The independent variable is the decrease of v_y, from the approach speed (1; all velocities are relative to
// it) to 0 and beyond, until the work of restitution is e^2 times that of compression. The method is Dormand
// and Prince 5(4), with the step length controlled by the last error. Steps end where a slip vanishes or a
// stuck contact breaks away.
#include <algorithm>
#include <cmath>

#include "physics/cushion/dormand_prince.h"
#include "physics/cushion/mathavan_laws.h"
#include "physics/cushion/nose.h"

namespace carom {
namespace detail {
namespace {

// [of the tolerance] Error allowed in each step. The error of a result, after about ten steps, is about the
// same.
constexpr double kCushionStep = 0.1;
// [of the approach speed] A nose that can stick is treated as sticking below this slip. The error is of
// second order (docs/reference/physics.md, "Cushion impact").
constexpr double kCushionStick = 3e-5;
// [of the approach speed] A nose that has stopped sticking slips by less than this for a while. Its slip
// direction then follows the drive without delay, which makes the equations stiff, so it is set to the
// drive's direction. The error is of second order: about the square root of this constant times its square.
constexpr double kCushionCreep = 1e-4;
constexpr int kCushionSteps = 5000;  // [-] limit of steps; an impact needs 3 to 300

using State = MathavanState;
using Forces = MathavanForces;

// All relative to the approach speed.
constexpr double kWorkShare = 1e-10;     // tolerance of the work of restitution
constexpr double kStill = 1e-15;         // v_y at the end of compression
constexpr double kFirstStep = 0.35;      // decrease of v_y
constexpr double kSmallestStep = 1e-13;  // accepted whatever its error
constexpr double kNoSlip = 1e-9;         // slip without a direction
// slip below which a contact sticks, if sticking is only of first order
constexpr double kLateStick = 1e-6;
// margin of static friction by which a stuck contact breaks away early
constexpr double kLetGo = 1e-9;
// squared turn below which the iteration for a direction has converged
constexpr double kTurned = 1e-26;
constexpr int kTurns = 40;       // largest number of iterations
constexpr int kLateSteps = 100;  // after this many, larger slips count as zero

class Impact {
  public:
    Impact(const CushionContact& p, const State& start, double tolerance)
        : laws_(p), tolerance_(tolerance), e_(p.e_c), y_(start) {
        noise_ = 0x1p-48 * (1.0 + std::abs(y_.v_x) + std::abs(y_.a_x) + std::abs(y_.a_y) + std::abs(y_.a_z));
    }

    /// Returns false if the limit of steps was reached; `end` is then unchanged.
    bool run(State& end) {
        update_stick_state();
        while (y_.v_y > kStill && !out_of_steps()) advance(y_.v_y, 0.0);
        const double target = e_ * e_ * y_.work;
        y_.work = 0.0;
        y_.v_y = 0.0;
        known_ = false;
        restoring_ = true;
        while (target - y_.work > kWorkShare * target && !out_of_steps()) advance(0.0, target);
        end = y_;
        return !out_of_steps();
    }

  private:
    bool is_zero_slip(double slip) const { return slip <= kNoSlip + noise_; }
    double zero_slip() const { return kNoSlip + noise_; }
    bool no_cloth_slip(double slip) const {
        return slip <= (steps_ < kLateSteps ? zero_slip() : late_stick());
    }
    bool out_of_steps() const { return steps_ >= kCushionSteps; }

    Forces forces(const Vec2& nose_direction, const Vec2& cloth_direction) const {
        Forces f;
        f.q = nose_stuck_ ? laws_.nose_hold(laws_.mu * cloth_direction) : Vec2(laws_.f * nose_direction);
        f.load = laws_.load(f.q);
        f.p = cloth_stuck_ ? laws_.cloth_hold(f.q) : Vec2(laws_.mu * f.load * cloth_direction);
        return f;
    }
    Forces forces(const State& y) const {
        const Vec2 nose = laws_.nose_slip(y), cloth = laws_.cloth_slip(y);
        // A slip of rounding size has no direction; the contact moves in the direction found by
        // update_stick_state().
        const double nose_size = norm(nose), cloth_size = norm(cloth);
        const Vec2 cloth_direction = no_cloth_slip(cloth_size) ? cloth_direction_ : Vec2(cloth / cloth_size);
        if (nose_creeps_) return forces(driven_nose(cloth_direction), cloth_direction);
        return forces(nose_size <= zero_slip() ? nose_direction_ : Vec2(nose / nose_size), cloth_direction);
    }

    // Direction of a nose that static friction no longer holds: the drive minus the friction points along the
    // slip. The iteration is a contraction, because friction acts similarly in all directions.
    Vec2 driven_nose(const Vec2& cloth_direction) const {
        Vec2 direction = nose_direction_;
        turn(direction, laws_.nose_hold(laws_.mu * cloth_direction));
        for (int i = 0; i < kTurns; ++i) {
            const Forces f = forces(direction, cloth_direction);
            if (turn(direction, laws_.nose_slip(laws_.change(f)) + 3.5 * f.q) < kTurned) break;
        }
        return direction;
    }

    // Change per unit of decrease of v_y.
    State slope(const State& y) const {
        const State k = laws_.change(forces(y));
        const double scale = -1.0 / k.v_y;
        return {k.v_x * scale, -1.0, k.a_x * scale, k.a_y * scale, k.a_z * scale, std::abs(y.v_y) * scale};
    }

    // Required static friction, divided by the largest possible: above 1 the contact slips.
    double nose_strain() const { return norm(laws_.nose_hold(laws_.mu * cloth_direction_)) / laws_.f; }
    double cloth_strain(const Forces& f) const { return norm(laws_.cloth_hold(f.q)) / (laws_.mu * f.load); }

    // Decides for both contacts whether they stick, and in which direction a vanished slip continues. A stuck
    // contact breaks away slightly early, because the steps end just before that point.
    void update_stick_state() {
        // A slip has its own direction; a vanished one keeps its last (at first: none).
        const Vec2 nose = laws_.nose_slip(y_), cloth = laws_.cloth_slip(y_);
        const double nose_size = norm(nose), cloth_size = norm(cloth);
        const bool nose_gone = is_zero_slip(nose_size), cloth_gone = no_cloth_slip(cloth_size);
        if (!nose_gone) nose_direction_ = nose / nose_size;
        if (!cloth_gone) cloth_direction_ = cloth / cloth_size;
        const bool was_stuck = nose_stuck_;
        const double strain = laws_.f > 0.0 ? nose_strain() : 2.0;
        const bool near = nose_gone || nose_size <= ends_below(nose_direction_.y(), cloth_size, strain);
        nose_stuck_ = near && strain <= (was_stuck ? 1.0 - 2.0 * kLetGo : 1.0);
        const bool cloth_was_stuck = cloth_stuck_;
        cloth_stuck_ = false;
        if (cloth_size <= late_stick() && laws_.mu > 0.0 && !nose_stuck_) {
            const Forces f = forces(nose_direction_, cloth_direction_);
            cloth_stuck_ = cloth_strain(f) <= (cloth_was_stuck ? 1.0 - 2.0 * kLetGo : 1.0);
        }
        // As in driven_nose(), for both contacts.
        const bool nose_turns = nose_gone && !nose_stuck_, cloth_turns = cloth_gone && !cloth_stuck_;
        for (int i = 0; i < kTurns && (nose_turns || cloth_turns); ++i) {
            const Forces f = forces(nose_direction_, cloth_direction_);
            const State k = laws_.change(f);
            double turned = 0.0;
            if (nose_turns) turned = turn(nose_direction_, laws_.nose_slip(k) + 3.5 * f.q);
            if (cloth_turns)
                turned = std::max(turned, turn(cloth_direction_, laws_.cloth_slip(k) + 3.5 * f.p));
            if (turned < kTurned) break;
        }
        nose_creeps_ = !nose_stuck_ && laws_.f > 0.0 && nose_strain() > 1.0 - 2.0 * kLetGo &&
                       (was_stuck || nose_gone || (near && steps_ >= kLateSteps) ||
                        (nose_creeps_ && nose_size < kCushionCreep));
        if (nose_stuck_ && !was_stuck) end_slip(nose);
        if (cloth_stuck_ && !cloth_was_stuck) end_cloth_slip(cloth);
        if (nose_stuck_ != was_stuck || cloth_stuck_ != cloth_was_stuck) step_ = kFirstStep;
    }

    // Slip below which a nose sticks if it can. If that takes long, or switches the cloth's load on or off,
    // end_slip() is of first order only, and the slip must be smaller.
    double ends_below(double nose_y, double cloth, double strain) const {
        const bool clamped = !(laws_.s + laws_.c * laws_.f * nose_y > 0.0);
        const bool soon = strain < 0.9 && clamped == nose_hold_clamped();
        return soon ? std::max(late_stick(), kCushionStick * std::min(1.0, cloth)) : late_stick();
    }

    // If friction and drive nearly balance, a slip can linger. The longer the impact lasts, the larger the
    // slip that counts as none, so that every impact ends.
    double late_stick() const {
        return steps_ < kLateSteps ? kLateStick : kLateStick * (1 << std::min(10, steps_ / kLateSteps));
    }

    // Removes the remaining slip of a nose that sticks from now on, by the friction that would end it. To
    // first order the time is irrelevant, because a stuck nose compensates the drive in between.
    void end_slip(const Vec2& slip) {
        const Vec2 mu = nose_hold_clamped() ? Vec2(0.0, 0.0) : Vec2(laws_.mu * laws_.c * cloth_direction_);
        const double q_y = slip.y() / (laws_.s * laws_.s + 2.5 + (2.5 - laws_.s) * mu.y());
        const double q_x = (slip.x() - (1.0 - 2.5 * laws_.s) * mu.x() * q_y) / 3.5;
        const Vec2 q(q_x, q_y), p = q_y * mu;
        y_.v_x -= q.x() + p.x();
        move_v_y(laws_.s * q.y() - p.y());
        y_.a_x -= 2.5 * (q.y() + p.y());
        y_.a_y -= 2.5 * (laws_.s * q.x() - p.x());
        y_.a_z += 2.5 * laws_.c * q.x();
    }
    // The same for the cloth.
    void end_cloth_slip(const Vec2& slip) {
        const Vec2 p = slip / 3.5;
        y_.v_x -= p.x();
        move_v_y(-p.y());
        y_.a_x -= 2.5 * p.y();
        y_.a_y += 2.5 * p.x();
    }
    // Compression stays compression.
    void move_v_y(double change) {
        const double v_y = y_.v_y + change;
        y_.v_y = restoring_ ? std::min(v_y, 0.0) : std::max(v_y, 0.0);
    }
    bool nose_hold_clamped() const { return laws_.nose_hold_lifts(laws_.mu * cloth_direction_); }

    // Returns the square of the angle turned.
    static double turn(Vec2& direction, const Vec2& towards) {
        const double size = norm(towards);
        if (!(size > 0.0)) return 0.0;
        const Vec2 was = direction;
        direction = towards / size;
        return (direction - was).squaredNorm();
    }

    // Largest decrease of v_y before a slip vanishes, slightly reduced so that the slip still has a direction
    // at the end.
    double until_gone(const Vec2& slip, const Vec2& rate) const {
        const double size = norm(slip);
        const double closing = size > zero_slip() ? -(slip.x() * rate.x() + slip.y() * rate.y()) / size : 0.0;
        return closing > 0.0 ? 0.95 * size / closing : 2.0;
    }

    // One accepted step: v_y decreases by at most `most` (0: no limit), and the work stays at or below
    // `target` (0: no limit).
    void advance(double most, double target) {
        if (!known_) slope_ = slope(y_);
        double h = std::min(step_, 1.0);
        if (most > 0.0) h = std::min(h, most);
        if (!nose_stuck_ && laws_.f > 0.0)
            h = std::min(h, until_gone(laws_.nose_slip(y_), laws_.nose_slip(slope_)));
        if (!cloth_stuck_ && laws_.mu > 0.0)
            h = std::min(h, until_gone(laws_.cloth_slip(y_), laws_.cloth_slip(slope_)));
        double force = target > 0.0 ? -laws_.change(forces(y_)).v_y : 0.0;  // decrease per impulse
        const double allowed = tolerance_ + noise_;
        const bool stuck = nose_stuck_ || cloth_stuck_;
        const double before = stuck ? strain(y_) : 0.0;
        for (;;) {
            if (target > 0.0)
                h = std::min(h, std::sqrt(y_.v_y * y_.v_y + 2.0 * force * (target - y_.work)) + y_.v_y);
            const auto step = dormand_prince(y_, h, slope_, [this](const State& y) { return slope(y); });
            const State& next = step.next;
            const double error = largest(step.error);
            if (++steps_ > kCushionSteps) return;
            const bool smallest = h < kSmallestStep;
            if (stuck && !smallest) {
                const double after = strain(next);
                if (after > 1.0 - kLetGo && before < 1.0 - kLetGo) {
                    h *= (1.0 - kLetGo - before) / (after - before);
                    continue;
                }
            }
            if (error > allowed && !smallest) {
                h *= scaled(error / allowed);
                step_ = h;
                continue;
            }
            if (target > 0.0 && next.work > target * (1.0 + kWorkShare) && !smallest) {
                // Too far: repeat with the force found in this step.
                const double fell = h * (h - 2.0 * y_.v_y) / 2.0;
                force = fell / (next.work - y_.work);
                continue;
            }
            const bool ends = most > 0.0 && h == most;
            // Steps shrink with a vanishing slip.
            double shrinking = 1.0;
            if (!nose_stuck_ && laws_.f > 0.0) shrinking = shrunk(laws_.nose_slip(y_), laws_.nose_slip(next));
            if (!cloth_stuck_ && laws_.mu > 0.0)
                shrinking = std::min(shrinking, shrunk(laws_.cloth_slip(y_), laws_.cloth_slip(next)));
            y_ = next;
            if (ends) y_.v_y = 0.0;
            slope_ = step.slope;
            known_ = true;
            const double wish = h * scaled(error / allowed) * shrinking;
            step_ = h < step_ ? std::min(step_, wish) : wish;
            update_stick_state_near_zero_slip();
            return;
        }
    }

    // Error of a step; v_y is exact by construction.
    static double largest(const State& error) {
        return std::max({std::abs(error.v_x), std::abs(error.a_x), std::abs(error.a_y), std::abs(error.a_z),
                         std::abs(error.work)});
    }

    double shrunk(const Vec2& before, const Vec2& after) const {
        const double size = norm(before);
        return size > zero_slip() ? std::min(1.0, norm(after) / size) : 1.0;
    }

    // Factor for the step length if the error is `x` times the allowed one: x^(-1/5) with a margin, from
    // square roots (no libm), within [1/5, 4].
    static double scaled(double x) {
        const double root = std::sqrt(std::sqrt(x));  // x^(1/4), and x^(1/5) = x^(1/4) x^(-1/20)
        return root > 4.0 ? 0.2 : (root > 0.2 ? 0.8 / root : 4.0);
    }

    double strain(const State& y) const {
        const Forces f = forces(y);
        return nose_stuck_ ? norm(f.q) / laws_.f : norm(f.p) / (laws_.mu * f.load);
    }

    void update_stick_state_near_zero_slip() {
        const double nose = norm(laws_.nose_slip(y_)), cloth = norm(laws_.cloth_slip(y_));
        const bool nose_ends =
            laws_.f > 0.0 &&
            (is_zero_slip(nose) || nose <= ends_below(laws_.nose_slip(y_).y() / nose, cloth, nose_strain()));
        const bool cloth_ends = laws_.mu > 0.0 && cloth <= late_stick();
        if (!(nose_ends || cloth_ends || nose_stuck_ || cloth_stuck_ || nose_creeps_)) return;
        update_stick_state();
        known_ = false;
    }

    MathavanLaws laws_;
    double tolerance_;
    double e_;
    State y_;
    double noise_ = 0.0;
    double step_ = kFirstStep;
    int steps_ = 0;
    State slope_{};  // at y_, if computed
    bool known_ = false;
    bool restoring_ = false;
    bool nose_stuck_ = false, cloth_stuck_ = false, nose_creeps_ = false;
    Vec2 nose_direction_ = Vec2::Zero(), cloth_direction_ = Vec2::Zero();
};

}  // namespace

bool cushion_mathavan_2010(const CushionContact& p, const Vec2& normal, Vec3& v, Vec3& w) {
    return cushion_mathavan_2010_to(p, normal, v, w, kCushionStep * p.tolerance);
}

bool cushion_mathavan_2010_to(const CushionContact& p, const Vec2& normal, Vec3& v, Vec3& w,
                              double tolerance) {
    const double approach = approach_speed(normal, v);
    if (!(approach > 0.0)) return true;
    const Vec2 y = -normal, x(y.y(), -y.x());
    const auto along = [](const Vec3& a, const Vec2& axis) { return a.x() * axis.x() + a.y() * axis.y(); };
    const double spin = p.R / approach;
    const State start{along(v, x) / approach, 1.0, along(w, x) * spin, along(w, y) * spin, w.z() * spin, 0.0};
    State end{};
    if (!Impact(p, start, tolerance).run(end)) return false;
    const double v_x = end.v_x * approach, v_y = end.v_y * approach, w_x = end.a_x / spin,
                 w_y = end.a_y / spin;
    v = Vec3(v_x * x.x() + v_y * y.x(), v_x * x.y() + v_y * y.y(), 0.0);
    w = Vec3(w_x * x.x() + w_y * y.x(), w_x * x.y() + w_y * y.y(), end.a_z / spin);
    return true;
}

// A ball cannot jam if the normal velocity decreases throughout, f_c s + mu_s (s + f_c c) < c, and the cloth
// cannot hold the ball for any friction of the nose.
bool mathavan_2010_ends(const CushionContact& p) {
    const double s = (p.height - p.R) / p.R, c = std::sqrt((1.0 - s) * (1.0 + s)), f = p.f_c;
    if (!(f * std::abs(s) + p.mu_s * (std::abs(s) + f * c) < c)) return false;
    // The cloth friction required to hold the ball, minus the largest possible, is linear in the nose's
    // friction q_y wherever there is a load N = s + c q_y, so testing the ends of that interval suffices.
    const auto slips = [&](double q_y) { return (c + (2.5 - s) * q_y) / 3.5 > p.mu_s * (s + c * q_y); };
    const double low = std::max(-f, -s / c);
    return low > f || (slips(low) && slips(f));
}

}  // namespace detail

constinit const CushionModelInfo kMathavan2010 = {
    .name = "mathavan_2010",
    .source = "Mathavan, Jackson, Parkin, Proc. IMechE C 224 (2010)",
    .resolve = detail::cushion_mathavan_2010,
    .reads_friction = true,
    .reads_cloth = true,
    .accepts = detail::mathavan_2010_ends,
};

}  // namespace carom
