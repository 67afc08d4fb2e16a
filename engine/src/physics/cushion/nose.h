// The contact of a ball with an inclined nose, for several cushion models.
#pragma once

#include <cmath>

#include "carom/engine/cushion.h"

namespace carom::detail {

inline double approach_speed(const Vec2& normal, const Vec3& v) {
    return -(v.x() * normal.x() + v.y() * normal.y());
}

/// The inclined contact: its normal points from the nose to the ball's centre.
struct NoseContact {
    Vec3 n;          ///< unit
    double u_n;      ///< normal contact velocity, < 0
    Vec3 u_t;        ///< tangential contact velocity, with spin
    double speed_t;  ///< |u_t|
};

inline NoseContact nose_contact(const CushionContact& p, const Vec2& normal, const Vec3& v, const Vec3& w) {
    const double tangent = (p.height - p.R) / p.R;
    const double scale = 1.0 / std::sqrt(1.0 + tangent * tangent);
    NoseContact c;
    c.n = Vec3(normal.x() * scale, normal.y() * scale, -tangent * scale);
    const Vec3 arm = -p.R * c.n;
    const Vec3 u = v + Vec3(w.y() * arm.z() - w.z() * arm.y(), w.z() * arm.x() - w.x() * arm.z(),
                            w.x() * arm.y() - w.y() * arm.x());
    // The spin's contribution is perpendicular to n; v_z is 0.
    c.u_n = v.x() * c.n.x() + v.y() * c.n.y();
    c.u_t = u - c.u_n * c.n;
    c.speed_t = std::sqrt(c.u_t.x() * c.u_t.x() + c.u_t.y() * c.u_t.y() + c.u_t.z() * c.u_t.z());
    return c;
}

/// Applies a normal impulse J_n and a tangential one J_t against the slip (both per mass). The cloth absorbs
/// the vertical part.
inline void apply_at_nose(const CushionContact& p, const NoseContact& c, double J_n, double J_t, Vec3& v,
                          Vec3& w) {
    const Vec3 t = c.speed_t > 0.0 ? Vec3(c.u_t * (-J_t / c.speed_t)) : Vec3(0.0, 0.0, 0.0);
    v = Vec3(v.x() + (J_n * c.n.x() + t.x()), v.y() + (J_n * c.n.y() + t.y()), 0.0);
    const double turn = -2.5 / p.R;  // dw = (5 / 2R) (-n x J_t)
    w = Vec3(w.x() + turn * (c.n.y() * t.z() - c.n.z() * t.y()),
             w.y() + turn * (c.n.z() * t.x() - c.n.x() * t.z()),
             w.z() + turn * (c.n.x() * t.y() - c.n.y() * t.x()));
}

}  // namespace carom::detail
