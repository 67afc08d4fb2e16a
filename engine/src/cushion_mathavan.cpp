// Cushion model `mathavan_2010`: Mathavan, Jackson, Parkin, "A theoretical analysis of billiard ball dynamics
// under cushion impacts", Proc. IMechE C 224 (2010). The published code marches it by Euler steps in the
// normal impulse; here it is integrated to a tolerance.
//
// Frame: y into the cushion, z up, x = y x z. a = R w. s, c: sine and cosine of the nose's height angle. Per
// unit of normal impulse over mass, with the nose's friction q (|q| <= f) against the slip I at the nose and
// the cloth's friction p
// (|p| <= mu_s N) against the slip C at the cloth, N = max(0, s + c q_y) the load on the cloth:
//   dv_x = -(q_x + p_x)          da_x = -(5/2) (q_y + p_y)       I = (v_x + s a_y - c a_z, -s v_y + a_x)
//   dv_y = -(c - s q_y + p_y)    da_y = -(5/2) (s q_x - p_x)     C = (v_x - a_y, v_y + a_x)
//                                da_z =  (5/2) c q_x
// Slip gives q = f I/|I|, p = mu_s N C/|C|. Where a slip vanishes, the contact sticks if static friction can
// hold it (the limit of the march for ever smaller steps), else it slips on in the direction in which it is
// driven. The two never stick together: that would stop the ball.
//
// The independent variable is the fall of v_y, from the approach speed (1, all velocities are relative to it)
// to 0 and on until the work of restitution is e^2 times that of compression. Method: Dormand and Prince
// 5(4), steps halved and doubled; they end where a slip vanishes or a stuck contact lets go.
#include <algorithm>
#include <cmath>

#include "carom/engine/tolerances.h"
#include "cushion_models.h"

namespace carom::detail {
namespace {

struct State {
    double v_x, v_y, a_x, a_y, a_z, work;
};

State plus(const State& y, double h, const State& k) {
    return {y.v_x + h * k.v_x, y.v_y + h * k.v_y, y.a_x + h * k.a_x,
            y.a_y + h * k.a_y, y.a_z + h * k.a_z, y.work + h * k.work};
}

double norm(const Vec2& a) {
    return std::sqrt(a.x() * a.x() + a.y() * a.y());
}

class Impact {
  public:
    Impact(const CushionContact& p, const State& start)
        : f_(p.f_c),
          mu_(p.mu_s),
          e_(p.e_c),
          s_((p.height - p.R) / p.R),
          c_(std::sqrt((1.0 - s_) * (1.0 + s_))),
          y_(start) {
        noise_ = 0x1p-48 * (1.0 + std::abs(y_.v_x) + std::abs(y_.a_x) + std::abs(y_.a_y) + std::abs(y_.a_z));
    }

    State run() {
        settle();
        while (y_.v_y > 1e-15 && !spent()) advance(y_.v_y, 0.0);
        const double target = e_ * e_ * y_.work;
        y_.work = 0.0;
        y_.v_y = 0.0;
        while (target - y_.work > 1e-14 * target && !spent()) advance(0.0, target);
        return y_;
    }

  private:
    struct Forces {
        Vec2 q, p;
        double load;
    };

    Vec2 nose_slip(const State& y) const { return {y.v_x + s_ * y.a_y - c_ * y.a_z, -s_ * y.v_y + y.a_x}; }
    static Vec2 cloth_slip(const State& y) { return {y.v_x - y.a_y, y.v_y + y.a_x}; }
    bool none(const Vec2& slip) const { return norm(slip) <= kCushionStick + noise_; }
    double floor() const { return 1e-4 * kCushionStick + noise_; }
    bool spent() const { return steps_ >= kCushionSteps; }

    // Static friction at the nose for a given friction coefficient vector mu_s C/|C| of the cloth.
    Vec2 nose_hold(const Vec2& mu) const {
        const double k = 2.5 - s_, gain = s_ * s_ + 2.5;
        double q_y = (s_ * c_ - k * mu.y() * s_) / (gain + k * mu.y() * c_);
        double load = s_ + c_ * q_y;
        if (!(load > 0.0)) {
            load = 0.0;
            q_y = s_ * c_ / gain;
        }
        return {-(1.0 - 2.5 * s_) * mu.x() * load / 3.5, q_y};
    }
    Vec2 cloth_hold(const Vec2& q) const {
        return {-(1.0 - 2.5 * s_) * q.x() / 3.5, (-c_ - (2.5 - s_) * q.y()) / 3.5};
    }

    Forces forces(const Vec2& nose_direction, const Vec2& cloth_direction) const {
        Forces f;
        f.q = nose_stuck_ ? nose_hold(mu_ * cloth_direction) : Vec2(f_ * nose_direction);
        f.load = std::max(0.0, s_ + c_ * f.q.y());
        f.p = cloth_stuck_ ? cloth_hold(f.q) : Vec2(mu_ * f.load * cloth_direction);
        return f;
    }
    Forces forces(const State& y) const {
        const Vec2 nose = nose_slip(y), cloth = cloth_slip(y);
        // A slip of rounding size has no direction; the contact goes where settle() found that it is driven.
        const double nose_size = norm(nose), cloth_size = norm(cloth);
        const Vec2 cloth_direction = cloth_size <= floor() ? cloth_direction_ : Vec2(cloth / cloth_size);
        if (nose_creeps_) return forces(driven_nose(cloth_direction), cloth_direction);
        return forces(nose_size <= floor() ? nose_direction_ : Vec2(nose / nose_size), cloth_direction);
    }

    // Where a nose that static friction no longer holds goes: the drive less the friction points along the
    // slip. A contraction, because friction acts nearly alike in all directions.
    Vec2 driven_nose(const Vec2& cloth_direction) const {
        Vec2 direction = nose_direction_;
        turn(direction, nose_hold(mu_ * cloth_direction));
        for (int i = 0; i < 12; ++i) {
            const Forces f = forces(direction, cloth_direction);
            turn(direction, nose_slip(change(f)) + 3.5 * f.q);
        }
        return direction;
    }

    // Change per unit of impulse.
    State change(const Forces& f) const {
        return {-(f.q.x() + f.p.x()),       -(c_ - s_ * f.q.y() + f.p.y()),
                -2.5 * (f.q.y() + f.p.y()), -2.5 * (s_ * f.q.x() - f.p.x()),
                2.5 * c_ * f.q.x(),         0.0};
    }

    // Change per unit of fall of v_y.
    State slope(const State& y) const {
        State k = change(forces(y));
        const double fall = -k.v_y;
        k.work = std::abs(y.v_y);
        return {k.v_x / fall, -1.0, k.a_x / fall, k.a_y / fall, k.a_z / fall, k.work / fall};
    }

    // Decides for both contacts whether they stick, and where a vanished slip goes.
    void settle() {
        // A direction that the slip itself has; a vanished one keeps its last (at first: none).
        const Vec2 nose = nose_slip(y_), cloth = cloth_slip(y_);
        const bool nose_gone = none(nose), cloth_gone = none(cloth);
        if (!nose_gone) nose_direction_ = nose / norm(nose);
        if (!cloth_gone) cloth_direction_ = cloth / norm(cloth);
        const bool was_stuck = nose_stuck_;
        nose_stuck_ = nose_gone && f_ > 0.0 && norm(nose_hold(mu_ * cloth_direction_)) <= f_;
        cloth_stuck_ = false;
        if (cloth_gone && mu_ > 0.0 && !nose_stuck_) {
            const Forces f = forces(nose_direction_, cloth_direction_);
            cloth_stuck_ = norm(cloth_hold(f.q)) <= mu_ * f.load;
        }
        // The same as in driven_nose(), for both.
        for (int i = 0; i < 40; ++i) {
            const Forces f = forces(nose_direction_, cloth_direction_);
            const State k = change(f);
            if (nose_gone && !nose_stuck_) turn(nose_direction_, nose_slip(k) + 3.5 * f.q);
            if (cloth_gone && !cloth_stuck_) turn(cloth_direction_, cloth_slip(k) + 3.5 * f.p);
        }
        nose_creeps_ = !nose_stuck_ && f_ > 0.0 &&
                       (was_stuck || nose_gone || (nose_creeps_ && norm(nose) < kCushionCreep)) &&
                       norm(nose_hold(mu_ * cloth_direction_)) > f_;
        if (nose_stuck_) {  // what is left of the slip
            y_.a_x -= nose.y();
            y_.a_z += nose.x() / c_;
        } else if (cloth_stuck_) {
            y_.a_x -= cloth.y();
            y_.a_y += cloth.x();
        }
    }
    static void turn(Vec2& direction, const Vec2& towards) {
        const double size = norm(towards);
        if (size > 0.0) direction = towards / size;
    }

    // Most that v_y may fall before a slip vanishes; a little less, so that its direction is still one at the
    // end.
    double until_gone(const Vec2& slip, const Vec2& rate) const {
        const double size = norm(slip);
        const double closing = size > floor() ? -(slip.x() * rate.x() + slip.y() * rate.y()) / size : 0.0;
        return closing > 0.0 ? 0.95 * size / closing : 2.0;
    }

    // One accepted step: v_y falls by at most `most` (0: no limit), the work stays at or below `target` (0:
    // no limit).
    void advance(double most, double target) {
        const State k1 = slope(y_);
        double h = std::min(step_, 1.0);
        if (most > 0.0) h = std::min(h, most);
        if (!nose_stuck_ && f_ > 0.0) h = std::min(h, until_gone(nose_slip(y_), nose_slip(k1)));
        if (!cloth_stuck_ && mu_ > 0.0) h = std::min(h, until_gone(cloth_slip(y_), cloth_slip(k1)));
        double force = -change(forces(y_)).v_y;  // fall per impulse
        for (;;) {
            if (target > 0.0)
                h = std::min(h, std::sqrt(y_.v_y * y_.v_y + 2.0 * force * (target - y_.work)) + y_.v_y);
            double error;
            const State next = step(k1, h, error);
            if (++steps_ > kCushionSteps) return;
            const bool smallest = h < 1e-13;
            const bool rough = error > kCushionTolerance + noise_;
            if ((rough || lets_go(next, h)) && !smallest) {
                h *= 0.5;
                step_ = h;
                continue;
            }
            if (target > 0.0 && next.work > target * (1.0 + 1e-14) && !smallest) {
                // Too far: again with the force that this step has met.
                const double fell = h * (h - 2.0 * y_.v_y) / 2.0;
                force = fell / (next.work - y_.work);
                continue;
            }
            const bool ends = most > 0.0 && h == most;
            y_ = next;
            if (ends) y_.v_y = 0.0;
            if (40.0 * error < kCushionTolerance + noise_) step_ = std::max(step_, 2.0 * h);
            settle_after(h);
            return;
        }
    }

    // Whether a stuck contact needs more than static friction can give at the end of a step; steps of this
    // length find it.
    bool lets_go(const State& next, double h) const {
        if (h < 1e-9) return false;
        if (nose_stuck_) return norm(forces(next).q) > f_ * (1.0 + 1e-12);
        if (!cloth_stuck_) return false;
        const Forces f = forces(next);
        return norm(f.p) > mu_ * f.load * (1.0 + 1e-12);
    }

    void settle_after(double h) {
        const bool nose_gone = none(nose_slip(y_)) && f_ > 0.0,
                   cloth_gone = none(cloth_slip(y_)) && mu_ > 0.0;
        const bool was_stuck = nose_stuck_ || cloth_stuck_;
        if (nose_gone || cloth_gone || was_stuck || nose_creeps_) settle();
        // A contact that has just let go starts a layer of its own.
        if (was_stuck && !(nose_stuck_ || cloth_stuck_)) step_ = std::max(h, 1e-6);
    }

    // Dormand and Prince, J. Comp. Appl. Math. 6 (1980), RK5(4)7M.
    State step(const State& k1, double h, double& error) const {
        const State k2 = slope(plus(y_, h / 5.0, k1));
        const State k3 = slope(plus(plus(y_, h * 3.0 / 40.0, k1), h * 9.0 / 40.0, k2));
        const State k4 =
            slope(plus(plus(plus(y_, h * 44.0 / 45.0, k1), h * -56.0 / 15.0, k2), h * 32.0 / 9.0, k3));
        const State k5 = slope(plus(plus(plus(plus(y_, h * 19372.0 / 6561.0, k1), h * -25360.0 / 2187.0, k2),
                                         h * 64448.0 / 6561.0, k3),
                                    h * -212.0 / 729.0, k4));
        const State k6 = slope(plus(plus(plus(plus(plus(y_, h * 9017.0 / 3168.0, k1), h * -355.0 / 33.0, k2),
                                              h * 46732.0 / 5247.0, k3),
                                         h * 49.0 / 176.0, k4),
                                    h * -5103.0 / 18656.0, k5));
        const State next = plus(
            plus(plus(plus(plus(y_, h * 35.0 / 384.0, k1), h * 500.0 / 1113.0, k3), h * 125.0 / 192.0, k4),
                 h * -2187.0 / 6784.0, k5),
            h * 11.0 / 84.0, k6);
        const State k7 = slope(next);
        const State zero{};
        const State off =
            plus(plus(plus(plus(plus(plus(zero, h * 71.0 / 57600.0, k1), h * -71.0 / 16695.0, k3),
                                h * 71.0 / 1920.0, k4),
                           h * -17253.0 / 339200.0, k5),
                      h * 22.0 / 525.0, k6),
                 h * -1.0 / 40.0, k7);
        error = std::max(
            {std::abs(off.v_x), std::abs(off.a_x), std::abs(off.a_y), std::abs(off.a_z), std::abs(off.work)});
        return next;
    }

    double f_, mu_, e_, s_, c_;
    State y_;
    double noise_ = 0.0;
    double step_ = 0.25;
    int steps_ = 0;
    bool nose_stuck_ = false, cloth_stuck_ = false, nose_creeps_ = false;
    Vec2 nose_direction_ = Vec2::Zero(), cloth_direction_ = Vec2::Zero();
};

}  // namespace

void cushion_mathavan_2010(const CushionContact& p, const Vec2& normal, Vec3& v, Vec3& w) {
    const double approach = approach_speed(normal, v);
    if (!(approach > 0.0)) return;
    const Vec2 y = -normal, x(y.y(), -y.x());
    const auto along = [](const Vec3& a, const Vec2& axis) { return a.x() * axis.x() + a.y() * axis.y(); };
    const double spin = p.R / approach;
    const State start{along(v, x) / approach, 1.0, along(w, x) * spin, along(w, y) * spin, w.z() * spin, 0.0};
    const State end = Impact(p, start).run();
    const double v_x = end.v_x * approach, v_y = end.v_y * approach, w_x = end.a_x / spin,
                 w_y = end.a_y / spin;
    v = Vec3(v_x * x.x() + v_y * y.x(), v_x * x.y() + v_y * y.y(), 0.0);
    w = Vec3(w_x * x.x() + w_y * y.x(), w_x * x.y() + w_y * y.y(), end.a_z / spin);
}

}  // namespace carom::detail

namespace carom {

bool mathavan_2010_ends(const CushionContact& p) {
    const double s = std::abs(p.height - p.R) / p.R, c = std::sqrt((1.0 - s) * (1.0 + s));
    return p.f_c * s + p.mu_s * (s + p.f_c * c) < c;
}

}  // namespace carom
