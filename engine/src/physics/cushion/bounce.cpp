#include "physics/cushion/bounce.h"

#include <algorithm>
#include <cmath>

#include "carom/engine/airborne.h"
#include "physics/reach.h"

namespace carom {

namespace {

// [-] Most impacts of one contact in one bounce.
constexpr int kMostImpacts = 200;
// [of the energy] Amount that rounding may add if two normals are nearly opposite; it is removed again.
constexpr double kEnergyRounding = 1e-10;
// [-] Smallest determinant for scaling two impulses; below it the normals are opposite.
constexpr double kLeastDeterminant = 1e-6;

// [-] Below this determinant two normals are nearly opposite: they enclose less than 18 degrees, or more than
// 162.
constexpr double kOpposite = 0.1;

double closing(const NoseTouch& touch, const Velocities& m) {
    return -dot(touch.normal, planar(m.v));
}

class Bounce {
  public:
    Bounce(const BallParams& balls, const BallSize& size, std::span<const NoseTouch> touches,
           double tolerance)
        : balls_(balls), size_(size), touches_(touches), tolerance_(tolerance) {}

    bool run(Velocities& m) const {
        if (touches_.size() == 1) return alone(touches_[0], m);
        return (touches_.size() == 2 && both(m)) || mean(m);
    }

  private:
    // After an impact with a high nose and a low restitution, a ball may still approach the nose (han_2005:
    // e_c < 1/c^2 - 1). The next impact is at the same instant, so a bounce is a sequence of impacts, until
    // the closing speed is within rounding.
    bool alone(const NoseTouch& touch, Velocities& m) const {
        CushionContact nose = cushion_contact(balls_, size_, touch.height, touch.normal, m.v, m.w);
        nose.tolerance = tolerance_;
        const double noise = closing_noise(size_.R, m);
        for (int impacts = 0; impacts < kMostImpacts; ++impacts) {
            if (!touch.model->resolve(nose, touch.normal, m.v, m.w)) return false;
            if (!(closing(touch, m) > noise)) return true;
        }
        // A nose near the top of the ball removes a small fraction of the speed in each impact: the limit is
        // 0.
        const Vec2 stopped = planar(m.v) + closing(touch, m) * touch.normal;
        m.v = Vec3(stopped.x(), stopped.y(), m.v.z());
        return true;
    }

    // @return whether scaling the two impulses worked; otherwise the motion is unchanged
    bool both(Velocities& m) const {
        Velocities one = m, two = m;
        const NoseTouch &first = touches_[0], &second = touches_[1];
        if (!alone(first, one) || !alone(second, two)) return false;
        const Velocities d1{one.v - m.v, one.w - m.w}, d2{two.v - m.v, two.w - m.w};
        // Change of each closing speed by each impulse of size 1.
        const double a11 = -closing(first, d1), a12 = -closing(first, d2);
        const double a21 = -closing(second, d1), a22 = -closing(second, d2);
        const double determinant = a11 * a22 - a12 * a21;
        if (!(determinant > kLeastDeterminant * a11 * a22)) return false;
        double share1 = a22 * (a11 - a12) / determinant, share2 = a11 * (a22 - a21) / determinant;
        // A negative share: the other part's impulse makes the ball leave this part faster than its own
        // would.
        if (!(share1 > 0.0) || !(share2 > 0.0)) {
            m = share1 > 0.0 ? one : two;
            return true;
        }
        const auto moved = [&] {
            return Velocities{m.v + (share1 * d1.v + share2 * d2.v), m.w + (share1 * d1.w + share2 * d2.w)};
        };
        Velocities after = moved();
        // The determinant of nearly opposite normals has lost its digits; the separation speeds recover them.
        if (determinant < kOpposite * a11 * a22) {
            const double left1 = closing(first, one) - closing(first, after),
                         left2 = closing(second, two) - closing(second, after);
            share1 += (a12 * left2 - a22 * left1) / determinant;
            share2 += (a21 * left1 - a11 * left2) / determinant;
            after = moved();
        }
        // Friction that its own impulse would have ended may reverse the slip.
        const double before = kinetic_energy(m.v, m.w, size_.R),
                     now = kinetic_energy(after.v, after.w, size_.R);
        const double slack = determinant < kOpposite * a11 * a22 ? kEnergyRounding : 1e-14;
        if (now > before * (1.0 + slack)) return false;
        if (now > before && slack > 1e-14) {
            const double share = std::sqrt(before / now);
            after = {share * after.v, share * after.w};
        }
        m = after;
        return true;
    }

    // The energy of a mean is at most the mean of the energies.
    bool mean(Velocities& m) const {
        for (int round = 0; round < kMostImpacts; ++round) {
            const double noise = closing_noise(size_.R, m);
            Velocities sum{Vec3::Zero(), Vec3::Zero()};
            int closes = 0;
            for (const NoseTouch& touch : touches_) {
                if (!(closing(touch, m) > noise)) continue;
                Velocities after = m;
                if (!alone(touch, after)) return false;
                sum.v += after.v;
                sum.w += after.w;
                ++closes;
            }
            if (closes == 0) break;
            m.v = sum.v / closes;
            m.w = sum.w / closes;
        }
        return true;
    }

    const BallParams& balls_;
    const BallSize& size_;
    const std::span<const NoseTouch> touches_;
    const double tolerance_;
};

/// [m/s] Upward speed of a ball on the cloth after it hits a nose: the result of (A6), or e_h times its
/// magnitude if it points down. 0 if that is below bounce_end().
double hop_speed(const BallParams& balls, double R, double gravity, const NoseTouch& touch, Velocities ball) {
    const double up = R - touch.height, reach = nose_reach(R, touch.height, 0.0);
    const Vec3 n(R / reach * touch.normal.x(), R / reach * touch.normal.y(), up / reach);
    hit_nose(balls, R, *touch.model, n, 0.0, ball);
    const double speed = ball.v.z() < 0.0 ? -balls.e_h * ball.v.z() : ball.v.z();
    return speed < bounce_end(R, gravity) ? 0.0 : speed;
}

}  // namespace

bool bounce(const BallParams& balls, const BallSize& size, std::span<const NoseTouch> touches,
            std::optional<double> hops, double tolerance, Velocities& ball) {
    const Velocities came = ball;
    if (!Bounce(balls, size, touches, tolerance).run(ball)) return false;
    ball.v.z() = 0.0;
    const NoseTouch& first = touches.front();
    if (!hops || balls.e_h == 0.0 || first.model->grip == nullptr) return true;
    // A planar model may keep more speed than the law in space that throws the ball up; the hop gets at most
    // the lost energy.
    const double lost = kinetic_energy(came.v, came.w, size.R) - kinetic_energy(ball.v, ball.w, size.R);
    ball.v.z() = std::min(hop_speed(balls, size.R, *hops, first, came), std::sqrt(std::max(0.0, 2.0 * lost)));
    return true;
}

}  // namespace carom
