// Impact models with one closed formula.
#include "carom/kernel/closed_forms.h"

#include "frame.h"

namespace carom::kernel {

void collide_elastic(const Ball& ball1, const Ball& ball2, const ImpactParams& params,
                     ImpactResult& result) noexcept {
    Frame frame;
    FrameState s;
    if (enter_frame(ball1, ball2, params, frame, s, result) != ImpactStatus::kOk) return;
    const double v1y = s.v1y;
    s.v1y = s.v2y;
    s.v2y = v1y;
    leave_frame(ball1, ball2, frame, s, 1, result);
}

void collide_inelastic(const Ball& ball1, const Ball& ball2, const ImpactParams& params,
                       ImpactResult& result) noexcept {
    Frame frame;
    FrameState s;
    if (enter_frame(ball1, ball2, params, frame, s, result) != ImpactStatus::kOk) return;
    const double R = params.R;
    // Normal impulse per unit mass: equal balls, kinematic restitution.
    const double J_n = 0.5 * (1.0 + params.e_b) * (s.v1y - s.v2y);
    // The tangential impulse acts against the slip at the contact. A unit of it changes both the horizontal
    // and the vertical slip by 7 (equal balls), because in this model both balls turn freely.
    const double c_x = s.v1x - s.v2x - R * (s.w1z + s.w2z);
    const double c_z = R * (s.w1x + s.w2x);
    const double c = square_root(c_x * c_x + c_z * c_z);
    double J_x = 0.0, J_z = 0.0;
    if (c > 0.0) {
        const double coulomb = params.mu_b * J_n, stop = c / 7.0;
        const double J_t = coulomb < stop ? coulomb : stop;
        J_x = -J_t * (c_x / c);
        J_z = -J_t * (c_z / c);
    }
    const double spin = 2.5 / R;
    s.v1y -= J_n;
    s.v2y += J_n;
    s.v1x += J_x;
    s.v2x -= J_x;
    s.w1x += spin * J_z;
    s.w2x += spin * J_z;
    s.w1z -= spin * J_x;
    s.w2z -= spin * J_x;
    leave_frame(ball1, ball2, frame, s, 1, result);
}

}  // namespace carom::kernel
