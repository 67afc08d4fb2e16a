// Cushion model `stronge`: a compliant nose with a tangential spring (W. J. Stronge, Impact Mechanics, the
// lumped-parameter model of contact with tangential compliance).
//
// Units: time in 1 / (normal frequency), velocities in the normal approach speed, forces per mass. The normal
// force is sin t in compression (t <= t_c = pi/2) and sin phi(t) in restitution, phi = t/e + t_c (1 - 1/e),
// until t_f = (1 + e) t_c. The tangential spring has the compliance eta = beta_t / omega^2 (normal: 1); a
// unit of tangential impulse changes the tangential velocity by beta_t = 7/2. While the nose sticks, spring
// and ball oscillate with frequency omega.
#include <algorithm>
#include <cmath>

#include "carom/engine/math.h"
#include "physics/cushion/nose.h"

namespace carom {
namespace detail {
namespace {

// [-] Grid that brackets the end of sticking: about a thirtieth of the restitution, far finer than the
// oscillation of the tangential spring.
constexpr int kStrongeGrid = 32;

constexpr double kOmega = 1.8;  // tangential over normal frequency; value of pooltool 0.6.0
constexpr double kBeta = 3.5;
constexpr double kEta = kBeta / (kOmega * kOmega);
constexpr double kCompression = 1.5707963267948966;  // t_c

// The normal force and its impulse since the start of the impact.
class NormalForce {
  public:
    explicit NormalForce(double e) : e_(e) {}
    double end() const { return (1.0 + e_) * kCompression; }
    double phase(double t) const { return t / e_ + kCompression * (1.0 - 1.0 / e_); }
    double time(double phase) const { return e_ * (phase - kCompression * (1.0 - 1.0 / e_)); }
    double force(double t) const { return sin_cos(t <= kCompression ? t : phase(t)).sin; }
    double impulse(double t) const {
        return t <= kCompression ? 1.0 - sin_cos(t).cos : 1.0 - e_ * sin_cos(phase(t)).cos;
    }

  private:
    double e_;
};

// The oscillation of ball and spring while the nose sticks, from time t0.
struct Swing {
    double t0;
    double u0;  // tangential velocity at t0
    double s0;  // deflection of the spring at t0
    double velocity(double t) const {
        const SinCos x = sin_cos(kOmega * (t - t0));
        return u0 * x.cos - kOmega * s0 * x.sin;
    }
    double deflection(double t) const {
        const SinCos x = sin_cos(kOmega * (t - t0));
        return s0 * x.cos + u0 / kOmega * x.sin;
    }
};

// Time at which the spring's force reaches f times the normal force. In compression, h = f F - |s| / eta
// obeys h'' + omega^2 h = f F (omega^2 - 1) > 0 and starts from h = h' = 0 (or h' > 0);
// since omega (t_c - t0) < pi, h > 0, so the nose breaks away only in restitution. There the first sign
// change is bracketed on a grid and bisected.
double release_time(const Swing& swing, const NormalForce& normal, double f) {
    const auto margin = [&](double t) { return f * normal.force(t) - std::abs(swing.deflection(t)) / kEta; };
    const double from = std::max(swing.t0, kCompression), end = normal.end();
    double low = from, high = end;
    for (int k = 1; k <= kStrongeGrid; ++k) {
        const double t = from + (end - from) * (static_cast<double>(k) / kStrongeGrid);
        if (margin(t) < 0.0) {
            high = t;
            break;
        }
        low = t;
    }
    // Either the sign changes, or the force vanishes with the normal force at the end of the contact.
    for (int k = 0; k < 60; ++k) {
        const double middle = low + 0.5 * (high - low);
        if (!(middle > low && middle < high)) break;
        (margin(middle) < 0.0 ? high : low) = middle;
    }
    return low;
}

// Tangential velocity after the impact; r: before it; both over the normal approach speed.
double velocity_after(double r, double e, double f) {
    const NormalForce normal(e);
    const double total = 1.0 + e;
    Swing swing{0.0, r, 0.0};
    if (!(r < f * kEta)) {  // slips at first; the slip of the nose itself is u - eta f F'
        const double excess = r / f - kBeta;
        double cosine;  // of the phase at the end of the slip
        if (excess <= 0.0) {
            cosine = excess / (kEta - kBeta);
            swing.t0 = arc_cos(std::min(cosine, 1.0));
        } else {
            const double fall = kBeta * e - kEta / e;  // <= 0: the slip of the nose grows in restitution
            if (!(fall > 0.0) || excess >= fall) return r - f * kBeta * total;
            cosine = -excess / fall;
            swing.t0 = normal.time(arc_cos(cosine));
        }
        swing.s0 = kEta * f * normal.force(swing.t0);
        swing.u0 = r - kBeta * f * normal.impulse(swing.t0);
    }
    if (e == 0.0) return swing.velocity(kCompression);
    const double t = release_time(swing, normal, f);
    const double slipping = swing.deflection(t) < 0.0 ? -1.0 : 1.0;
    return swing.velocity(t) - slipping * f * kBeta * (total - normal.impulse(t));
}

}  // namespace

double stronge_grip(double e, double f, double v_n, double slip) {
    if (!(f > 0.0) || !(slip > 0.0)) return 0.0;
    const double r = slip / v_n;
    return (r - velocity_after(r, e, f)) / kBeta * v_n;
}

bool cushion_stronge(const CushionContact& p, const Vec2& normal, Vec3& v, Vec3& w) {
    if (!(approach_speed(normal, v) > 0.0)) return true;
    const NoseContact c = nose_contact(p, normal, v, w);
    const double approach = -c.u_n;
    apply_at_nose(p, c, (1.0 + p.e_c) * approach, stronge_grip(p.e_c, p.f_c, approach, c.speed_t), v, w);
    return true;
}

}  // namespace detail

extern constinit const CushionModelInfo kStronge = {
    .name = "stronge",
    .source = "Stronge, Impact Mechanics, compliant contact",
    .resolve = detail::cushion_stronge,
    .reads_friction = true,
    .reflects_when_level = true,
    .grip = detail::stronge_grip,
};

}  // namespace carom
