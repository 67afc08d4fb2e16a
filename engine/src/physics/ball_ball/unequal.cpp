// Impacts of two balls of different size.
#include <algorithm>
#include <cmath>

#include "carom/engine/ball_ball.h"

namespace carom {

using kernel::Ball;
using kernel::ImpactParams;
using kernel::ImpactResult;

double contact_distance(double R1, double R2, bool discs) {
    if (discs) return R1 + R2;
    return R1 == R2 ? 2.0 * R1 : 2.0 * std::sqrt(R1 * R2);
}

void collide_unequal(const BallSize& size1, const BallSize& size2, const Ball& ball1, const Ball& ball2,
                     const ImpactParams& params, ImpactResult& result) {
    result = {};
    std::copy_n(ball1.v, 3, result.v1);
    std::copy_n(ball1.w, 3, result.w1);
    std::copy_n(ball2.v, 3, result.v2);
    std::copy_n(ball2.w, 3, result.w2);
    const Vec2 apart(ball2.r[0] - ball1.r[0], ball2.r[1] - ball1.r[1]);
    const double distance = length(apart);
    if (!(distance > 0.0) || (size1.R != size2.R && params.mu_b != 0.0)) {
        result.status =
            distance > 0.0 ? kernel::ImpactStatus::kBadParameter : kernel::ImpactStatus::kBadState;
        return;
    }
    const Vec2 y = apart / distance, x(y.y(), -y.x());
    const Vec2 v(ball1.v[0] - ball2.v[0], ball1.v[1] - ball2.v[1]);
    const double approach = y.x() * v.x() + y.y() * v.y();
    if (!(approach > 0.0)) {
        result.status = kernel::ImpactStatus::kNotApproaching;
        return;
    }
    // Impulses on ball 2, divided by the reduced mass; the shares convert them to changes of velocity.
    const double total = size1.m + size2.m, share1 = size2.m / total, share2 = size1.m / total;
    const double J_n = (1.0 + params.e_b) * approach;
    double J_x = 0.0, J_z = 0.0;
    if (params.mu_b != 0.0) {
        const double R = size1.R;
        const Vec3 w(ball1.w[0] + ball2.w[0], ball1.w[1] + ball2.w[1], ball1.w[2] + ball2.w[2]);
        const double c_x = x.x() * v.x() + x.y() * v.y() - R * w.z();
        const double c_z = R * (x.x() * w.x() + x.y() * w.y());
        const double c = length(Vec2(c_x, c_z));
        // A unit of J_t changes the slip by 7/2: 1 from the centres, 5/2 from the spins.
        const double J_t = std::min(params.mu_b * J_n, 2.0 / 7.0 * c);
        if (c > 0.0) {
            J_x = J_t * (c_x / c);
            J_z = J_t * (c_z / c);
        }
    }
    const double spin1 = 2.5 * share1 / size1.R, spin2 = 2.5 * share2 / size2.R;
    for (int k = 0; k < 2; ++k) {
        const double J = J_n * y[k] + J_x * x[k];
        result.v1[k] -= share1 * J;
        result.v2[k] += share2 * J;
        result.w1[k] -= spin1 * J_z * x[k];
        result.w2[k] -= spin2 * J_z * x[k];
    }
    result.w1[2] += spin1 * J_x;
    result.w2[2] += spin2 * J_x;
    result.steps = 1;
    result.status = kernel::ImpactStatus::kOk;
}

}  // namespace carom
