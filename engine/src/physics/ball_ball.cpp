#include "carom/engine/ball_ball.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "carom/engine/math.h"
#include "carom/kernel/closed_forms.h"
#include "physics/cluster.h"

namespace carom {

using kernel::Ball;
using kernel::ImpactParams;
using kernel::ImpactResult;

namespace {

void elastic(const BallBallSettings&, const Ball& ball1, const Ball& ball2, const ImpactParams& params,
             ImpactResult& result) {
    kernel::collide_elastic(ball1, ball2, params, result);
}

void inelastic(const BallBallSettings&, const Ball& ball1, const Ball& ball2, const ImpactParams& params,
               ImpactResult& result) {
    kernel::collide_inelastic(ball1, ball2, params, result);
}

void mathavan(const BallBallSettings& settings, const Ball& ball1, const Ball& ball2,
              const ImpactParams& params, ImpactResult& result) {
    if (settings.march != nullptr)
        settings.march(ball1, ball2, params, settings.substeps, result);
    else
        settings.by_tolerance(ball1, ball2, params, settings.tolerance, result);
}

}  // namespace

constinit const BallBallModelInfo kMathavan = {
    .name = "mathavan",
    .source = "Mathavan, Jackson, Parkin, Sports Engineering 17 (2014)",
    .collide = mathavan,
    .reads_friction = true,
    .reads_restitution = true,
    .reads_cloth = true,
    .reads_tolerance = true,
};

namespace {

constexpr BallBallModelInfo kInelastic = {
    .name = "inelastic",
    .source = "D. Alciatore, Technical Proof A.14",
    .collide = inelastic,
    .reads_friction = true,
    .reads_restitution = true,
};
constexpr BallBallModelInfo kElastic = {
    .name = "elastic",
    .source = "exchange of the normal velocities",
    .collide = elastic,
};
// The free impact of two balls, then the cloth's impact on balls that it presses down (airborne.h). If no
// ball can leave the cloth, this is the planar impact of balls without friction or of equal height.
constexpr BallBallModelInfo kTwoStep = {
    .name = "two_step",
    .source = "A. Domenech, Int. J. Mech. Sci. 50 (2008): ball on ball, then ball on cloth",
    .collide = inelastic,
    .reads_friction = true,
    .reads_restitution = true,
    .free = true,
};

}  // namespace

std::span<const BallBallModelInfo* const> all_of(const BallBallModelInfo*) {
    static constexpr const BallBallModelInfo* kModels[] = {&kMathavan, &kInelastic, &kElastic, &kTwoStep};
    return kModels;
}

const char* name(const BallBallModelInfo* model) {
    return model->name;
}

const BallBallModelInfo* ball_ball_model(std::string_view name) {
    for (const BallBallModelInfo* model : all_of(&kMathavan))
        if (name == model->name) return model;
    return nullptr;
}

double Falling::operator()(double u) const {
    return more == 0.0 ? at_rest : at_rest + more * exponential(-fall * u);
}

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

namespace effects {

/// The friction between two balls on the cloth, at their slip. The line of centres of unlike balls is tilted.
[[gnu::noinline]] double pair_friction(const Falling& friction, double R1, double R2, const Vec2& apart,
                                       const Velocities& ball1, const Velocities& ball2) {
    if (friction.constant()) return friction.at_rest;
    const Vec2 y = apart / length(apart), x(y.y(), -y.x());
    const double S = (R2 - R1) / (R1 + R2), C = std::sqrt((1.0 - S) * (1.0 + S));
    const Vec3 v = ball1.v - ball2.v;
    // [rad/s] Both spins as one spin of ball 1. For equal radii, the factors here change no bit.
    const Vec3 w = ball1.w + (R2 / R1) * ball2.w;
    const double along = x.x() * v.x() + x.y() * v.y() - C * (R1 * w.z()) + S * (R1 * dot(y, planar(w)));
    const double upward = R1 * (x.x() * w.x() + x.y() * w.y()) - S * dot(y, planar(v));
    return friction(length(Vec2(along, upward)));
}

// How the line of centres turns until the middle of a contact.
struct ContactTurn {
    double tangent = 0.0;  // of the angle, against the balls' motion past each other
    // [rad/s] Vertical spin of both balls that has the effect of the turning on the slip.
    double spin = 0.0;
};

// A contact of two balls without friction and losses: x'' = -2 x^1.5 - v_t^2 / D in units of the approach. In
// half of its time h the normal turns by h v_t / D, less for a graze, which its turning ends; 1 / (1 + s +
// ...) is the impulse over that of a normal that stays, fitted to integrations from s = 0 to 12. Friction
// slows v_t. Because the normal turns on, the slip at both ends of the contact differs from that in its
// middle by the angle times v_n, as if the balls had more spin.
[[gnu::noinline]] ContactTurn contact_turn(const PairLaw& law, const BallSize& size1, const BallSize& size2,
                                           double mu_b, const Vec2& apart, const Velocities& ball1,
                                           const Velocities& ball2) {
    // [L/V] Half of the time of a contact of two equal balls.
    constexpr double kHalf = 1.2195;
    const double D = length(apart);
    const Vec2 n = apart / D, t(-n.y(), n.x()), v = planar(ball1.v - ball2.v);
    const double v_n = dot(v, n);
    if (!(v_n > 0.0)) return {};
    double v_t = dot(v, t);
    const Vec3 turning = size1.R * ball1.w + size2.R * ball2.w;
    const double along = v_t + turning.z(), slip = length(Vec2(along, dot(planar(turning), t)));
    // Half of the friction's impulse acts before the middle.
    const double e_b = law.model.restitution(law.balls);
    if (slip > 0.0) v_t -= 0.5 * std::min(mu_b * (1.0 + e_b) * v_n, 2.0 / 7.0 * slip) * (along / slip);
    const double h =
        kHalf * contact_length(v_n) / v_n * pair_softness(size1, size2, {law.balls.R, law.balls.m});
    const double s = v_t * v_t * h / (D * v_n), more = s * (0.7443 + 0.5208 * s);
    const double tangent = v_t * h / D * (1.0 + more) / (1.0 + s * (1.0 + more));
    return {tangent, -tangent * v_n / (size1.R + size2.R)};
}

}  // namespace effects

namespace {

Ball kernel_ball(const Vec3& r, const Velocities& at) {
    return {{r.x(), r.y(), r.z()}, {at.v.x(), at.v.y(), at.v.z()}, {at.w.x(), at.w.y(), at.w.z()}};
}

}  // namespace

ImpactParams PairLaw::params(const BallSize& size1, const BallSize& size2, double mu_b) const {
    // Between equal balls without friction nothing presses a ball onto the cloth.
    const double mu_s = mu_b != 0.0 || size1.R != size2.R ? balls.mu_s : 0.0;
    return {.R = size1.R,
            .m = size1.m,
            .mu_s1 = mu_s,
            .mu_s2 = mu_s,
            .mu_b = mu_b,
            .e_b = model.restitution(balls),
            .cloth_slip = settings.cloth_slip,
            .mass_ratio = size2.m / size1.m,
            .radius_ratio = size2.R / size1.R};
}

PairImpact collide(const PairLaw& law, const BallSize& size1, const BallSize& size2, const Vec3& r1,
                   const Vec3& r2, Velocities& ball1, Velocities& ball2) {
    const Falling friction = law.model.friction(law.balls);
    const double mu_b = friction.any() ? effects::pair_friction(friction, size1.R, size2.R,
                                                                planar(r2) - planar(r1), ball1, ball2)
                                       : 0.0;
    const ImpactParams params = law.params(size1, size2, mu_b);
    const Vec2 apart = planar(r2) - planar(r1);
    effects::ContactTurn turn;
    if (law.contact_time) turn = effects::contact_turn(law, size1, size2, mu_b, apart, ball1, ball2);
    const Vec2 middle =
        (apart - turn.tangent * Vec2(-apart.y(), apart.x())) / std::sqrt(1.0 + turn.tangent * turn.tangent);
    Ball one = kernel_ball(r1, ball1), two = kernel_ball(r2, ball2);
    if (turn.tangent != 0.0) {
        // From the origin, so that mirrored impacts round alike.
        one.r[0] = one.r[1] = 0.0;
        two.r[0] = middle.x();
        two.r[1] = middle.y();
        one.w[2] += turn.spin;
        two.w[2] += turn.spin;
    }
    const bool integrated =
        law.model.reads_tolerance && (size1 == size2 || mu_b != 0.0 || params.mu_s1 != 0.0);
    ImpactResult result;
    if (integrated || size1 == size2)
        law.model.collide(law.settings, one, two, params, result);
    else
        collide_unequal(size1, size2, one, two, params, result);
    result.w1[2] -= turn.spin;
    result.w2[2] -= turn.spin;
    ball1 = {Vec3(result.v1), Vec3(result.w1)};
    ball2 = {Vec3(result.v2), Vec3(result.w2)};
    const char* const method = !integrated                     ? law.model.name
                               : law.settings.march != nullptr ? "march"
                                                               : kernel::name(result.method);
    const bool grazes = turn.tangent != 0.0 && dot(planar(ball1.v - ball2.v), apart) >= 0.0;
    return {result.status, result.steps, method, grazes};
}

}  // namespace carom
