#include "loop/bounce.h"

#include <algorithm>
#include <cmath>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "contact/touch.h"

namespace carom {

namespace {

// [-] Two parts count as one if the cosine of the angle between their normals is larger: a cushion and the
// jaw that continues it.
constexpr double kOneNormal = 1.0 - 1e-6;

}  // namespace

TableTouch table_touch(const Plan& plan, const Balls& balls, const Contact& contact) {
    const Touch met = touch_part(plan.geometry, contact, balls.at(contact.ball));
    TableTouch touch{{.normal = -planar(met.n),
                      .height = part_height(plan.geometry, contact),
                      .model = is_jaw(contact, plan.geometry) ? plan.jaw : plan.cushion},
                     {contact, planar(met.n), met.closing},
                     met.bend};
    touch.approach.a_c = touch.pressing(balls.segment(contact.ball).a);
    return touch;
}

TableTouches table_touches(const Plan& plan, const Balls& balls, const Detector& detector,
                           const RestingContacts& resting, const Contact& met) {
    TableTouches touches(table_touch(plan, balls, met));
    const Vec2 here = planar(balls.position(met.ball));
    const double R = balls.radius(met.ball), reach = R * (1.0 + kBoxShare) + kTouchTolerance;
    const double noise = closing_noise(R, {balls.velocity(met.ball), balls.spin(met.ball)});
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
    // A tree finds the parts in a different order.
    std::sort(touches.begin() + 1, touches.end(), [](const TableTouch& p, const TableTouch& q) {
        return p.normal.x() < q.normal.x() || (p.normal.x() == q.normal.x() && p.normal.y() < q.normal.y());
    });
    return touches;
}

}  // namespace carom
