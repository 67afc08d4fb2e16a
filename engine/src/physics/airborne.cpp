#include "carom/engine/airborne.h"

#include <algorithm>
#include <cmath>

#include "carom/engine/math.h"

namespace carom {

namespace {

// [R] Height of the lowest bounce: the depth to which a resting ball sinks into the cloth.
constexpr double kBounceApex = 0.0045;
// [bounce_end] Separation speed of a slow contact. Such contacts occur about 1000 times a second, and raise
// the energy by at most 1.3e-5 J/kg.
constexpr double kPartingShare = 0.1;
// [-] A contact with less restitution is treated as having this one when deciding whether it is slow: so a
// plastic contact at metres per second still has friction.
constexpr double kSlowRestitution = 0.5;

}  // namespace

double bounce_end(double R, double gravity) {
    return std::sqrt(2.0 * gravity * kBounceApex * R);
}

double parting_speed(double R, double gravity) {
    return kPartingShare * bounce_end(R, gravity);
}

std::optional<double> restitution_in_air(double e, double v_n, double parting) {
    if (std::max(e, kSlowRestitution) * v_n < parting) return std::nullopt;
    return std::max(e, parting / v_n);
}

double cloth_restitution(const BallParams& balls, double V) {
    return std::min(1.0, balls.cloth_restitution()(V));
}

void hit_cloth(const BallParams& balls, const MotionParams& motion, Velocities& ball) {
    Vec3 &v = ball.v, &w = ball.w;
    const double R = motion.R, V = -v.z();
    double e = cloth_restitution(balls, V);
    if (e * V < bounce_end(R, motion.gravity)) e = 0.0;
    const Vec2 u(v.x() - R * w.y(), v.y() + R * w.x());
    const double slip = length(u);
    // A unit of impulse changes the slip by 7/2: 1 from the centre, 5/2 from the spin.
    const double J = std::min(balls.mu_s * (1.0 + e) * V, 2.0 / 7.0 * slip);
    if (J > 0.0) {
        const Vec2 j = u * (J / slip);
        v.x() -= j.x();
        v.y() -= j.y();
        w.x() -= 2.5 / R * j.y();
        w.y() += 2.5 / R * j.x();
    }
    v.z() = e * V;
    if (!motion.spin_decay) return;
    const double left = std::max(0.0, std::abs(w.z()) - 2.5 * balls.mu_sp / R * ((1.0 + e) * V));
    w.z() = w.z() < 0.0 ? -left : left;
}

namespace {

/// Impulse [kg m/s] of ball 1 on ball 2.
void exchange(const FreePair& pair, const Vec3& impulse, Velocities& ball1, Velocities& ball2) {
    ball1.v -= impulse / pair.size1.m;
    ball2.v += impulse / pair.size2.m;
}

}  // namespace

void hit_ball(const FreePair& pair, const Vec3& n, Velocities& ball1, Velocities& ball2) {
    const BallSize &size1 = pair.size1, &size2 = pair.size2;
    const Vec3 v = ball1.v - ball2.v, a = size1.R * ball1.w + size2.R * ball2.w;
    const double v_n = dot3(v, n);
    if (!(v_n > 0.0)) return;
    const double m_r = size1.m * size2.m / (size1.m + size2.m);
    const double J_n = (1.0 + pair.e_b) * m_r * v_n;
    exchange(pair, J_n * n, ball1, ball2);
    if (!pair.friction.any()) return;
    const Vec3 c = (v - v_n * n) + cross3(a, n);
    const double slip = length3(c);
    if (!(slip > 0.0)) return;
    const double J_t = std::min(pair.friction(slip) * J_n, 2.0 / 7.0 * m_r * slip);
    const Vec3 F = (J_t / slip) * c, turn = cross3(n, F);
    exchange(pair, F, ball1, ball2);
    ball1.w -= 2.5 / (size1.m * size1.R) * turn;
    ball2.w -= 2.5 / (size2.m * size2.R) * turn;
}

void part_slowly(const FreePair& pair, const Vec3& n, const Lies& lies, double gravity, Velocities& ball1,
                 Velocities& ball2) {
    const double parting = parting_speed(std::max(pair.size1.R, pair.size2.R), gravity);
    const double v_n = dot3(ball1.v - ball2.v, n);
    const double level = n.x() * n.x() + n.y() * n.y();
    const double k1 = (lies.one ? level : 1.0) / pair.size1.m, k2 = (lies.two ? level : 1.0) / pair.size2.m;
    // Two balls cannot both lie on the cloth one above the other, nor separate if neither can move.
    if (!(k1 + k2 > 0.0)) return;
    exchange(pair, (v_n + parting) / (k1 + k2) * n, ball1, ball2);
    if (lies.one) ball1.v.z() = 0.0;
    if (lies.two) ball2.v.z() = 0.0;
}

bool hit_nose(const BallParams& balls, double R, const CushionModelInfo& model, const Vec3& n, double parting,
              Velocities& ball) {
    const double v_n = -dot3(ball.v, n);
    if (!(v_n > 0.0)) return false;
    const std::optional<double> e_c = restitution_in_air(cushion_restitution(balls, v_n), v_n, parting);
    if (!e_c) {
        ball.v += (v_n + parting) * n;
        return true;
    }
    const Vec3 surface = ball.v - R * cross3(ball.w, n);
    const Vec3 u = surface - dot3(surface, n) * n;
    const double slip = length3(u);
    ball.v += (1.0 + *e_c) * v_n * n;
    if (model.grip == nullptr || !(slip > 0.0)) return false;
    const double J_t = model.grip(*e_c, balls.cushion_friction()(slip), v_n, slip);
    const Vec3 j = (J_t / slip) * u;
    ball.v -= j;
    ball.w += 2.5 / R * cross3(n, j);
    return false;
}

}  // namespace carom
