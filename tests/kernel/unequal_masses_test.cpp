// Impacts of balls of one radius and different mass, by tolerance.
// The bound on the error is in tolerance_bound_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "carom/kernel/closed_forms.h"
#include "carom/kernel/march.h"
#include "tolerance_support.h"

namespace carom::test {
namespace {

using namespace kernel;

struct Vector {
    double x, y, z;
};

// The impact in SI units and table coordinates, marched in `steps` equal normal impulses: the equations
// exactly as in physics.md, without the scaling by which the kernel treats masses as friction. The line of
// centres is y.
ImpactResult marched(const Impact& i, int steps) {
    const ImpactParams& p = i.params;
    const double m[2] = {p.m, p.m * p.mass_ratio}, R = p.R, mu_s[2] = {p.mu_s1, p.mu_s2};
    Vector v[2] = {{i.ball1.v[0], i.ball1.v[1], 0.0}, {i.ball2.v[0], i.ball2.v[1], 0.0}};
    Vector w[2] = {{i.ball1.w[0], i.ball1.w[1], i.ball1.w[2]}, {i.ball2.w[0], i.ball2.w[1], i.ball2.w[2]}};
    const double reduced = m[0] * m[1] / (m[0] + m[1]);
    const double dP = (1.0 + p.e_b) * reduced * (v[0].y - v[1].y) / steps;
    double work = 0.0, goal = std::numeric_limits<double>::infinity();
    while (work < goal) {
        const double closing = v[0].y - v[1].y;
        // Slip of ball 1 on ball 2 at the contact, and the friction on ball 1 along it.
        const double c_x = v[0].x - v[1].x - R * (w[0].z + w[1].z), c_z = R * (w[0].x + w[1].x);
        const double c = std::hypot(c_x, c_z);
        const double F_x = c > 0.0 ? -p.mu_b * dP * c_x / c : 0.0,
                     F_z = c > 0.0 ? -p.mu_b * dP * c_z / c : 0.0;
        const int pressed = F_z > 0.0 ? 1 : 0;  // the other ball's vertical friction is -F_z
        const double u_x = v[pressed].x - R * w[pressed].y, u_y = v[pressed].y + R * w[pressed].x;
        const double u = std::hypot(u_x, u_y), N = std::fabs(F_z);
        const double H_x = u > 1e-14 ? -mu_s[pressed] * N * u_x / u : 0.0;
        const double H_y = u > 1e-14 ? -mu_s[pressed] * N * u_y / u : 0.0;
        for (int k = 0; k < 2; ++k) {
            const double side = k == 0 ? 1.0 : -1.0, spin = 5.0 / (2.0 * m[k] * R);
            v[k].x += side * F_x / m[k];
            v[k].y -= side * dP / m[k];
            // The contact is at +-R y, where the friction is +-(F_x, F_z): both torques are alike.
            w[k].x += spin * F_z;
            w[k].z -= spin * F_x;
            if (k != pressed) continue;
            v[k].x += H_x / m[k];
            v[k].y += H_y / m[k];
            w[k].x += spin * H_y;  // at -R z
            w[k].y -= spin * H_x;
        }
        const double after = v[0].y - v[1].y;
        work += 0.5 * dP * std::fabs(closing + after);
        if (goal > 1e300 && after <= 0.0) goal = (1.0 + p.e_b * p.e_b) * work;
    }
    ImpactResult r{};
    const auto copy = [](const Vector& from, double(&to)[3]) {
        to[0] = from.x;
        to[1] = from.y;
        to[2] = from.z;
    };
    copy(v[0], r.v1);
    copy(w[0], r.w1);
    copy(v[1], r.v2);
    copy(w[1], r.w2);
    return r;
}

// Ball 1 at the origin, ball 2 along y, both with random velocities and spins.
Impact along_y(Generator& rng) {
    Impact i{};
    i.params = {0.0286,
                0.17,
                rng.uniform(0.0, 0.4),
                rng.uniform(0.0, 0.4),
                rng.uniform(0.01, 0.2),
                rng.uniform(),
                ClothSlip::kConsistent,
                std::pow(10.0, rng.uniform(-1.0, 1.0))};
    i.ball2.r[1] = 2.0 * i.params.R;
    for (int k = 0; k < 3; ++k) {
        i.ball1.v[k] = k < 2 ? rng.uniform(-1.0, 1.0) : 0.0;
        i.ball1.w[k] = rng.uniform(-40.0, 40.0);
        i.ball2.w[k] = rng.uniform(-40.0, 40.0);
    }
    i.ball1.v[1] = rng.uniform(0.3, 2.0);
    return i;
}

TEST(UnequalMasses, AsTheEquationsInSIUnits) {
    Generator rng(71);
    double worst = 0.0;
    for (int n = 0; n < 200; ++n) {
        const Impact i = along_y(rng);
        const ImpactResult r = solve(i, 1e-9);
        ASSERT_EQ(r.status, ImpactStatus::kOk);
        const double coarse = difference(r, marched(i, 1000), i.params.R) / approach_speed(i);
        const double fine = difference(r, marched(i, 20000), i.params.R) / approach_speed(i);
        // The march errs by about 2 shares of a step, for the lighter ball by twice that.
        EXPECT_LT(coarse, 4e-3) << i.params.mass_ratio;
        EXPECT_LT(fine, 2e-4) << i.params.mass_ratio;
        worst = std::fmax(worst, coarse);
    }
    EXPECT_GT(worst, 2e-4) << "the march is a witness only where its steps show";
}

TEST(UnequalMasses, MomentumAndEnergy) {
    Generator rng(72);
    for (int n = 0; n < 2000; ++n) {
        Impact i = along_y(rng);
        const double m1 = i.params.m, m2 = m1 * i.params.mass_ratio, R = i.params.R;
        const auto energy = [&](const double(&v1)[3], const double(&w1)[3], const double(&v2)[3],
                                const double(&w2)[3]) {
            double sum = 0.0;
            for (int k = 0; k < 3; ++k) {
                sum += m1 * (0.5 * v1[k] * v1[k] + 0.2 * R * R * w1[k] * w1[k]) +
                       m2 * (0.5 * v2[k] * v2[k] + 0.2 * R * R * w2[k] * w2[k]);
            }
            return sum;
        };
        for (double tolerance : {1e-3, 1e-6, 1e-10}) {
            const ImpactResult r = solve(i, tolerance);
            const double before = energy(i.ball1.v, i.ball1.w, i.ball2.v, i.ball2.w);
            EXPECT_LE(energy(r.v1, r.w1, r.v2, r.w2), before * (1.0 + 1e-14));
        }
        i.params.mu_s1 = i.params.mu_s2 = 0.0;  // no cloth: momentum and both spins as pairs
        const ImpactResult r = solve(i, 1e-3);
        for (int k = 0; k < 2; ++k) {
            const double before = m1 * i.ball1.v[k] + m2 * i.ball2.v[k];
            EXPECT_NEAR(m1 * r.v1[k] + m2 * r.v2[k], before, 1e-14);
        }
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(m1 * (r.w1[k] - i.ball1.w[k]), m2 * (r.w2[k] - i.ball2.w[k]), 1e-13);
        }
    }
}

// Equal masses are not a special case: the result is continuous in the ratio, and which ball comes first does
// not matter.
TEST(UnequalMasses, ContinuousAtEqualMassesAndWhicheverIsFirst) {
    Generator rng(73);
    for (int n = 0; n < 500; ++n) {
        Impact i = along_y(rng), swapped = i;
        std::swap(swapped.ball1, swapped.ball2);
        std::swap(swapped.params.mu_s1, swapped.params.mu_s2);
        swapped.params.mass_ratio = 1.0 / i.params.mass_ratio;
        const ImpactResult r = solve(i, 1e-11);
        ImpactResult other = solve(swapped, 1e-11);
        std::swap(other.v1, other.v2);
        std::swap(other.w1, other.w2);
        EXPECT_LT(difference(r, other, i.params.R), 4e-11 * approach_speed(i));
        i.params.mass_ratio = 1.0;
        const ImpactResult equal = solve(i, 1e-11);
        for (double more : {-1e-6, 1e-6, 1e-9}) {
            i.params.mass_ratio = 1.0 + more;
            const double moved = difference(solve(i, 1e-11), equal, i.params.R) / approach_speed(i);
            EXPECT_LT(moved, 8.0 * std::fabs(more) + 2e-11);
        }
    }
}

TEST(UnequalMasses, RefusedWhereNothingIsClaimed) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Generator rng(74);
    Impact i = along_y(rng);
    i.params.mu_s1 = i.params.mu_s2 = 0.2;
    for (double ratio : {0.0, -1.0, 0.9e-6, 1.1e6, 1e300, nan}) {
        i.params.mass_ratio = ratio;
        EXPECT_EQ(solve(i, 1e-6).status, ImpactStatus::kBadParameter) << ratio;
    }
    for (double ratio : {1.0 / kLargestMassRatio, 0.0999, 0.1, 10.0, 10.01, kLargestMassRatio}) {
        i.params.mass_ratio = ratio;
        EXPECT_EQ(solve(i, 1e-6).status, ImpactStatus::kOk) << ratio;
    }
    // Friction on the cloth up to 1, as between equal balls.
    i.params.mass_ratio = 1.5;
    i.params.mu_s1 = i.params.mu_s2 = 0.9;
    EXPECT_EQ(solve(i, 1e-6).status, ImpactStatus::kOk);
    i.params.mu_s1 = i.params.mu_s2 = 1.1;
    EXPECT_EQ(solve(i, 1e-6).status, ImpactStatus::kBadParameter);
    ImpactResult r{};
    collide_inelastic(i.ball1, i.ball2, i.params, r);
    EXPECT_EQ(r.status, ImpactStatus::kBadParameter);
    collide_elastic(i.ball1, i.ball2, i.params, r);
    EXPECT_EQ(r.status, ImpactStatus::kBadParameter);
}

TEST(UnequalMasses, EveryInstructionSetAgrees) {
    for (const Impact& i : impacts_of_masses_that_differ(75, 3000, ClothSlip::kConsistent)) {
        for (double tolerance : {1e-3, 1e-10}) {
            const ImpactResult scalar = solve(i, tolerance, Isa::kScalar);
            for (Isa isa : isas())
                EXPECT_TRUE(same_velocities(solve(i, tolerance, isa), scalar)) << name(isa);
        }
    }
}

}  // namespace
}  // namespace carom::test
