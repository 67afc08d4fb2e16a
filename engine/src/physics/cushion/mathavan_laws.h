// The laws of the cushion model `mathavan_2010` (equations and symbols: mathavan.cpp): slips, static
// friction, and the effect of a pair of friction forces. Independent of the integration.
#pragma once

#include <algorithm>
#include <cmath>

#include "carom/engine/cushion.h"
#include "carom/engine/vec.h"

namespace carom::detail {

/// Velocities relative to the approach speed, a = R w, and the work of the normal force.
struct MathavanState {
    double v_x, v_y, a_x, a_y, a_z, work;
};

inline MathavanState plus(const MathavanState& y, double h, const MathavanState& k) {
    return {y.v_x + h * k.v_x, y.v_y + h * k.v_y, y.a_x + h * k.a_x,
            y.a_y + h * k.a_y, y.a_z + h * k.a_z, y.work + h * k.work};
}

/// Length of a vector whose squares are normal numbers.
inline double norm(const Vec2& a) {
    return std::sqrt(a.x() * a.x() + a.y() * a.y());
}

/// Friction at nose and cloth per unit of normal impulse, and the load on the cloth.
struct MathavanForces {
    Vec2 q, p;
    double load;
};

struct MathavanLaws {
    double f, mu;  ///< friction at the nose and of the cloth
    double s, c;   ///< sine and cosine of the nose's height angle

    explicit MathavanLaws(const CushionContact& p)
        : f(p.f_c), mu(p.mu_s), s((p.height - p.R) / p.R), c(std::sqrt((1.0 - s) * (1.0 + s))) {}

    Vec2 nose_slip(const MathavanState& y) const {
        return {y.v_x + s * y.a_y - c * y.a_z, -s * y.v_y + y.a_x};
    }
    static Vec2 cloth_slip(const MathavanState& y) { return {y.v_x - y.a_y, y.v_y + y.a_x}; }

    /// Static friction at the nose for a given friction coefficient vector mu_s C/|C| of the cloth.
    Vec2 nose_hold(const Vec2& cloth) const {
        const double k = 2.5 - s, gain = s * s + 2.5;
        double q_y = (s * c - k * cloth.y() * s) / (gain + k * cloth.y() * c);
        double load = s + c * q_y;
        if (!(load > 0.0)) {
            load = 0.0;
            q_y = s * c / gain;
        }
        return {-(1.0 - 2.5 * s) * cloth.x() * load / 3.5, q_y};
    }
    /// Static friction at the cloth for a given friction of the nose.
    Vec2 cloth_hold(const Vec2& q) const {
        return {-(1.0 - 2.5 * s) * q.x() / 3.5, (-c - (2.5 - s) * q.y()) / 3.5};
    }
    /// Whether the ball would lift off the cloth while the nose holds it.
    bool nose_hold_lifts(const Vec2& cloth) const { return !(s + c * nose_hold(cloth).y() > 0.0); }

    double load(const Vec2& q) const { return std::max(0.0, s + c * q.y()); }

    /// Change per unit of impulse.
    MathavanState change(const MathavanForces& forces) const {
        const auto& [q, p, load] = forces;
        return {-(q.x() + p.x()),           -(c - s * q.y() + p.y()), -2.5 * (q.y() + p.y()),
                -2.5 * (s * q.x() - p.x()), 2.5 * c * q.x(),          0.0};
    }
};

/// The model mathavan_2010 with a different tolerance, relative to the approach speed and per step.
bool cushion_mathavan_2010_to(const CushionContact& contact, const Vec2& normal, Vec3& v, Vec3& w,
                              double tolerance);

}  // namespace carom::detail
