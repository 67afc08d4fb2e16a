#include "loop/bounce.h"

#include <algorithm>
#include <cmath>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"

namespace carom {

namespace {

// [-] Two parts count as one if the cosine of the angle between their normals is above this: a cushion and
// the jaw that continues it.
constexpr double kOneNormal = 1.0 - 1e-6;

}  // namespace

TableTouch table_touch(const Plan& plan, const Balls& balls, const Contact& contact) {
    const int ball = contact.ball;
    const Vec2 here = planar(balls.position(ball)), v = planar(balls.velocity(ball));
    TableTouch touch;
    if (contact.with == With::kNose) {
        const Nose& nose = plan.geometry.noses[contact.other];
        const Vec2 out = here - nose.center;
        touch.normal = out / (nose.sign() * length(out));
        touch.height = nose.height;
        const double v_t = cross(touch.normal, v);
        touch.curving = v_t * v_t / (balls.radius(ball) + nose.radius - nose.inset);
    } else {
        const CushionLine& line = plan.geometry.cushions[contact.other];
        touch.normal = Vec2(-line.direction.y(), line.direction.x());
        if (dot(touch.normal, here - line.from) < 0.0) touch.normal = -touch.normal;
        touch.height = line.height;
    }
    touch.model = is_jaw(contact, plan.geometry) ? plan.jaw : plan.cushion;
    touch.approach = {.contact = contact,
                      .n = -touch.normal,
                      .v_n = -(touch.normal.x() * v.x() + touch.normal.y() * v.y()),
                      .a_c = touch.pressing(balls.segment(ball).a)};
    return touch;
}

namespace {

bool touches_now(const Plan& plan, const Balls& balls, const Contact& contact) {
    const Vec2 here = planar(balls.position(contact.ball)), v = planar(balls.velocity(contact.ball));
    const double R = balls.radius(contact.ball);
    if (contact.with == With::kNose) {
        const Nose& nose = plan.geometry.noses[contact.other];
        const Vec2 out = here - nose.center;
        return nose.sign() * length(out) - (R + nose.radius - nose.inset) <= kTouchTolerance &&
               nose.span.holds(out, end_rounding(here, 0.0));
    }
    const CushionLine& line = plan.geometry.cushions[contact.other];
    const Vec2 offset = here - line.from;
    if (std::abs(cross(line.direction, offset)) - (R - line.inset) > kTouchTolerance) return false;
    const double foot = dot(line.direction, offset), rate = dot(line.direction, v);
    const double slack = end_rounding(here, line.length);
    return !past_end(foot, rate, 0.0, slack) && !past_end(line.length - foot, -rate, 0.0, slack);
}

}  // namespace

TableTouches table_touches(const Plan& plan, const Balls& balls, const Detector& detector,
                           const RestingContacts& resting, const Contact& met) {
    TableTouches touches(table_touch(plan, balls, met));
    const Vec2 here = planar(balls.position(met.ball));
    const double R = balls.radius(met.ball), reach = R * (1.0 + kBoxShare) + kTouchTolerance;
    const double noise = closing_noise(R, {balls.velocity(met.ball), balls.spin(met.ball)});
    detector.parts_near(
        {here.x() - reach, here.y() - reach, here.x() + reach, here.y() + reach}, [&](const Contact& part) {
            const Contact contact = part.of(met.ball);
            if (contact.with == With::kPocket || contact == met || !touches_now(plan, balls, contact)) return;
            const TableTouch touch = table_touch(plan, balls, contact);
            const auto is_one = [&touch](const TableTouch& t) {
                return dot(t.normal, touch.normal) > kOneNormal;
            };
            if (touch.approach.v_n > noise && !resting.has(contact) &&
                std::none_of(touches.begin(), touches.end(), is_one))
                touches.add(touch);
        });
    // A tree finds the parts in another order.
    std::sort(touches.begin() + 1, touches.end(), [](const TableTouch& p, const TableTouch& q) {
        return p.normal.x() < q.normal.x() || (p.normal.x() == q.normal.x() && p.normal.y() < q.normal.y());
    });
    return touches;
}

}  // namespace carom
