#include "loop/bounce.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "contact/touch.h"
#include "physics/motion.h"

namespace carom {

namespace {

// [-] Most impacts of one contact in one bounce.
constexpr int kMostImpacts = 200;
// [-] Two parts count as one if the cosine of the angle between their normals is above this: a cushion and
// the jaw that continues it.
constexpr double kOneNormal = 1.0 - 1e-6;
// [of the energy] What rounding may add to it where two normals are nearly opposite; it is taken off again.
constexpr double kEnergyRounding = 1e-10;
// [-] Least determinant for which two impulses are scaled: below, the normals are opposite.
constexpr double kLeastDeterminant = 1e-6;

// [-] Below this determinant two normals are nearly opposite: they enclose less than 18 degrees, or more than
// 162.
constexpr double kOpposite = 0.1;

struct Motion {
    Vec3 v, w;
};

double rounding(double R, const Motion& m) {
    return kClosingUlp * std::numeric_limits<double>::epsilon() * (length(planar(m.v)) + R * m.w.norm());
}

double closing(const TableTouch& touch, const Motion& m) {
    return -dot(touch.normal, planar(m.v));
}

/// Twice the energy, per mass.
double energy(double R, const Motion& m) {
    return m.v.squaredNorm() + kInertia * R * R * m.w.squaredNorm();
}

/// A ball and all that touches it.
class Bounce {
  public:
    Bounce(const Plan& plan, const TableTouches& touches)
        : plan_(plan), size_(plan.sizes[touches[0].approach.contact.ball]), touches_(touches) {}

    bool run(Motion& m) const {
        if (touches_.size() == 1) return alone(touches_[0], m);
        return (touches_.size() == 2 && both(m)) || mean(m);
    }

  private:
    // After an impact with a high nose and a low restitution, a ball may still approach it (han_2005: e_c <
    // 1/c^2 - 1). The next impact is at the same instant, so a bounce is a sequence of impacts, until the
    // closing speed is within rounding.
    bool alone(const TableTouch& touch, Motion& m) const {
        const CushionContact nose = cushion_contact(plan_.balls, size_, touch.height, touch.normal, m.v, m.w);
        const double noise = rounding(size_.R, m);
        for (int impacts = 0; impacts < kMostImpacts; ++impacts) {
            if (!touch.model->resolve(nose, touch.normal, m.v, m.w)) return false;
            if (!(closing(touch, m) > noise)) return true;
        }
        // A nose near the top of the ball takes a small share of the speed in each impact: the limit is 0.
        const Vec2 stopped = planar(m.v) + closing(touch, m) * touch.normal;
        m.v = Vec3(stopped.x(), stopped.y(), m.v.z());
        return true;
    }

    // @return whether scaling the two impulses worked; otherwise the motion is unchanged
    bool both(Motion& m) const {
        Motion one = m, two = m;
        const TableTouch &first = touches_[0], &second = touches_[1];
        if (!alone(first, one) || !alone(second, two)) return false;
        const Motion d1{one.v - m.v, one.w - m.w}, d2{two.v - m.v, two.w - m.w};
        // The change of each closing speed by each impulse of size 1.
        const double a11 = -closing(first, d1), a12 = -closing(first, d2);
        const double a21 = -closing(second, d1), a22 = -closing(second, d2);
        const double determinant = a11 * a22 - a12 * a21;
        if (!(determinant > kLeastDeterminant * a11 * a22)) return false;
        double share1 = a22 * (a11 - a12) / determinant, share2 = a11 * (a22 - a21) / determinant;
        // A negative one: the impulse of the other makes the ball leave this part faster than its own would.
        if (!(share1 > 0.0) || !(share2 > 0.0)) {
            m = share1 > 0.0 ? one : two;
            return true;
        }
        const auto moved = [&] {
            return Motion{m.v + (share1 * d1.v + share2 * d2.v), m.w + (share1 * d1.w + share2 * d2.w)};
        };
        Motion after = moved();
        // The determinant of normals that are nearly opposite has lost its digits, and the speeds at which
        // the ball leaves give them back.
        if (determinant < kOpposite * a11 * a22) {
            const double left1 = closing(first, one) - closing(first, after),
                         left2 = closing(second, two) - closing(second, after);
            share1 += (a12 * left2 - a22 * left1) / determinant;
            share2 += (a21 * left1 - a11 * left2) / determinant;
            after = moved();
        }
        // Friction that its own impulse would have ended may turn the slip round.
        const double before = energy(size_.R, m), now = energy(size_.R, after);
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
    bool mean(Motion& m) const {
        for (int round = 0; round < kMostImpacts; ++round) {
            const double noise = rounding(size_.R, m);
            Motion sum{Vec3::Zero(), Vec3::Zero()};
            int closes = 0;
            for (const TableTouch& touch : touches_) {
                if (!(closing(touch, m) > noise)) continue;
                Motion after = m;
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

    const Plan& plan_;
    const BallSize& size_;
    const TableTouches& touches_;
};

}  // namespace

TableTouch table_touch(const Plan& plan, const Balls& balls, const Contact& contact) {
    const Touch<Vec3> met = touch_part(plan.geometry, contact, balls.at(contact.ball));
    TableTouch touch{.approach = {contact, planar(met.n), met.closing},
                     .normal = -planar(met.n),
                     .height = part_height(plan.geometry, contact),
                     .bend = met.bend,
                     .model = is_jaw(contact, plan.geometry) ? plan.jaw : plan.cushion};
    touch.approach.a_c = touch.pressing(balls.segment(contact.ball).a);
    return touch;
}

TableTouches table_touches(const Plan& plan, const Balls& balls, const Detector& detector,
                           const RestingContacts& resting, const Contact& met) {
    TableTouches touches(table_touch(plan, balls, met));
    const Vec2 here = planar(balls.position(met.ball));
    const double R = balls.radius(met.ball), reach = R * (1.0 + kBoxShare) + kTouchTolerance;
    const double noise = rounding(R, {balls.velocity(met.ball), balls.spin(met.ball)});
    const auto add = [&](const Contact& part) {
        const Contact contact = part.of(met.ball);
        if (contact.with == With::kPocket || contact == met) return;
        if (!touches_part(plan.geometry, contact, balls.at(met.ball))) return;
        const TableTouch touch = table_touch(plan, balls, contact);
        const auto is_one = [&touch](const TableTouch& t) {
            return dot(t.normal, touch.normal) > kOneNormal;
        };
        if (touch.approach.v_n > noise && !resting.has(contact) &&
            std::none_of(touches.begin(), touches.end(), is_one))
            touches.add(touch);
    };
    detector.parts_near({here.x() - reach, here.y() - reach, here.x() + reach, here.y() + reach}, add);
    // A tree finds the parts in another order.
    std::sort(touches.begin() + 1, touches.end(), [](const TableTouch& p, const TableTouch& q) {
        return p.normal.x() < q.normal.x() || (p.normal.x() == q.normal.x() && p.normal.y() < q.normal.y());
    });
    return touches;
}

bool bounce(const Plan& plan, const TableTouches& touches, Vec3& v, Vec3& w) {
    Motion m{v, w};
    if (!Bounce(plan, touches).run(m)) return false;
    v = m.v;
    w = m.w;
    return true;
}

}  // namespace carom
