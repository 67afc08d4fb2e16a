// Impacts of balls of different radius and mass, by tolerance and by march.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "carom/kernel/closed_forms.h"
#include "carom/kernel/march.h"
#include "tolerance_support.h"

namespace carom::test {
namespace {

using namespace kernel;
using Triple = std::array<double, 3>;

Triple operator+(const Triple& a, const Triple& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Triple operator*(double s, const Triple& a) {
    return {s * a[0], s * a[1], s * a[2]};
}
Triple operator-(const Triple& a, const Triple& b) {
    return a + -1.0 * b;
}
double dot(const Triple& a, const Triple& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Triple cross(const Triple& a, const Triple& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Triple& a) {
    return std::sqrt(dot(a, a));
}
Triple of(const double (&a)[3]) {
    return {a[0], a[1], a[2]};
}

struct Two {
    double m[2], R[2], mu_s[2];
    Triple v[2], w[2], n;
};

Two two_of(const Impact& i) {
    const ImpactParams& p = i.params;
    Two t{{p.m, p.m * p.mass_ratio},      {p.R, p.R * p.radius_ratio},    {p.mu_s1, p.mu_s2},
          {of(i.ball1.v), of(i.ball2.v)}, {of(i.ball1.w), of(i.ball2.w)}, {}};
    const Triple apart = of(i.ball2.r) - of(i.ball1.r);
    t.n = 1.0 / length(apart) * apart;
    return t;
}

// The impact as forces on two spheres in space that stay on the cloth, in SI units and table coordinates,
// without a contact frame. Marched in `steps` equal normal impulses.
ImpactResult marched_in_space(const Impact& i, int steps) {
    const ImpactParams& p = i.params;
    Two t = two_of(i);
    const double sign = p.cloth_slip == ClothSlip::kAsPublished ? -1.0 : 1.0, cos2 = 1.0 - t.n[2] * t.n[2];
    const double reduced = t.m[0] * t.m[1] / (t.m[0] + t.m[1]);
    const double dP = (1.0 + p.e_b) * reduced * dot(t.v[0] - t.v[1], t.n) / cos2 / steps;
    double work = 0.0, goal = std::numeric_limits<double>::infinity();
    while (work < goal) {
        const double closing = dot(t.v[0] - t.v[1], t.n);
        Triple slip = t.v[0] + cross(t.w[0], t.R[0] * t.n) - (t.v[1] + cross(t.w[1], -t.R[1] * t.n));
        slip = slip - dot(slip, t.n) * t.n;
        // Near zero the friction falls with the slip. Otherwise the steps alternate in sign and press down
        // one ball and the other in turn, unlike a slip of zero.
        const double c = std::hypot(length(slip), 1e-4);
        const Triple friction = -p.mu_b * dP / c * slip;  // on ball 1
        const Triple force[2] = {friction - dP * t.n, dP * t.n - friction};
        for (int k = 0; k < 2; ++k) {
            Triple level = force[k];
            const double spin = 5.0 / (2.0 * t.m[k] * t.R[k] * t.R[k]);
            Triple torque = cross((k == 0 ? t.R[0] : -t.R[1]) * t.n, force[k]);
            if (force[k][2] < 0.0) {  // pressed on the cloth
                const Triple u{t.v[k][0] - sign * t.R[k] * t.w[k][1], t.v[k][1] + sign * t.R[k] * t.w[k][0],
                               0.0};
                const double size = length(u);
                const Triple cloth = size > 1e-14 ? t.mu_s[k] * force[k][2] / size * u : Triple{};
                level = level + cloth;
                torque = torque + cross(Triple{0.0, 0.0, -t.R[k]}, cloth);
            }
            level[2] = 0.0;
            t.v[k] = t.v[k] + 1.0 / t.m[k] * level;
            t.w[k] = t.w[k] + spin * torque;
        }
        const double after = dot(t.v[0] - t.v[1], t.n);
        work += 0.5 * dP * std::fabs(closing + after);
        if (goal > 1e300 && after <= 0.0) goal = (1.0 + p.e_b * p.e_b) * work;
    }
    ImpactResult r{};
    for (int k = 0; k < 3; ++k) {
        r.v1[k] = t.v[0][k];
        r.v2[k] = t.v[1][k];
        r.w1[k] = t.w[0][k];
        r.w2[k] = t.w[1][k];
    }
    return r;
}

// Anywhere on the table, in any direction; the second ball is 0.8 to 1.25 times as large.
Impact unlike(Generator& rng) {
    Impact i{};
    i.params = {.R = 0.0286,
                .m = 0.17,
                .mu_s1 = rng.uniform(0.0, 0.4),
                .mu_s2 = rng.uniform(0.0, 0.4),
                .mu_b = rng.uniform(0.0, 0.2),
                .e_b = rng.uniform(),
                .mass_ratio = rng.uniform(0.7, 1.5),
                .radius_ratio = rng.uniform(0.8, 1.25)};
    const double R1 = i.params.R, R2 = R1 * i.params.radius_ratio, angle = rng.uniform(0.0, 6.283);
    const double level = 2.0 * std::sqrt(R1 * R2), y[2] = {std::cos(angle), std::sin(angle)};
    i.ball1.r[2] = R1;
    i.ball2.r[0] = level * y[0];
    i.ball2.r[1] = level * y[1];
    i.ball2.r[2] = R2;
    const bool rolls = rng.next() % 4 == 0;
    const double along = rng.uniform(0.3, 2.0), across = rng.uniform(-1.0, 1.0);
    for (int k = 0; k < 2; ++k) i.ball1.v[k] = along * y[k] + across * (k == 0 ? y[1] : -y[0]);
    if (rolls) {
        i.ball1.w[0] = -i.ball1.v[1] / R1;
        i.ball1.w[1] = i.ball1.v[0] / R1;
        return i;
    }
    for (int k = 0; k < 3; ++k) {
        i.ball1.w[k] = rng.uniform(-40.0, 40.0);
        i.ball2.w[k] = rng.uniform(-40.0, 40.0);
    }
    return i;
}

// Equal radii and masses up to a factor of ten apart: ball 1 at the origin, ball 2 along y, both with random
// velocities and spins.
Impact of_one_radius(Generator& rng) {
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

constexpr Impact (*kKinds[])(Generator&) = {unlike, of_one_radius};

double energy_of(const Impact& i, const double (&v1)[3], const double (&w1)[3], const double (&v2)[3],
                 const double (&w2)[3]) {
    const Two t = two_of(i);
    const Triple v[2] = {of(v1), of(v2)}, w[2] = {of(w1), of(w2)};
    double sum = 0.0;
    for (int k = 0; k < 2; ++k)
        sum += t.m[k] * (0.5 * dot(v[k], v[k]) + 0.2 * t.R[k] * t.R[k] * dot(w[k], w[k]));
    return sum;
}

Impact swapped(const Impact& i) {
    Impact s = i;
    std::swap(s.ball1, s.ball2);
    std::swap(s.params.mu_s1, s.params.mu_s2);
    s.params.R *= i.params.radius_ratio;
    s.params.m *= i.params.mass_ratio;
    s.params.radius_ratio = 1.0 / i.params.radius_ratio;
    s.params.mass_ratio = 1.0 / i.params.mass_ratio;
    return s;
}

TEST(UnlikeImpact, MatchesForcesOnTwoSpheres) {
    for (const ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        Generator rng(81);
        for (int n = 0; n < 120; ++n) {
            Impact i = kKinds[n % 4 == 0](rng);
            i.params.cloth_slip = slip;
            if (n % 3 == 1) i.ball1.w[0] = i.ball1.w[1] = i.ball1.w[2] = i.ball2.w[0] = i.ball2.w[1] = 0.0;
            const ImpactResult r = solve(i, 1e-9);
            ASSERT_EQ(r.status, ImpactStatus::kOk);
            EXPECT_LT(difference(r, marched_in_space(i, 40000), i.params.R) / approach_speed(i), 4e-4)
                << n << " " << i.params.radius_ratio << " " << i.params.mass_ratio << " mu_b "
                << i.params.mu_b;
        }
    }
}

// The error bound, against the solution to 1e-13.
TEST(UnlikeImpact, KeepsTheTolerance) {
    for (const ClothSlip slip : {ClothSlip::kConsistent, ClothSlip::kAsPublished}) {
        Generator rng(82);
        for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-6, 1e-8, 1e-10}) {
            for (int n = 0; n < 1500; ++n) {
                Impact i = unlike(rng);
                i.params.cloth_slip = slip;
                if (n % 5 == 0) i.params.mu_b = 0.01;
                if (n % 5 == 1) i.params.e_b = n % 2;
                const double error =
                    difference(solve(i, tolerance), solve(i, 1e-13), i.params.R) / approach_speed(i);
                EXPECT_LT(error, tolerance) << n;
            }
        }
    }
}

// Slips that end, begin at zero or pass close to it, over many decades: straight at a resting ball, rolling,
// almost without spin, and almost without friction. Slips that pass exactly through zero were once missed.
TEST(UnlikeImpact, KeepsTheToleranceWhereSlipsVanish) {
    Generator rng(89);
    const auto decades = [&rng](double lowest) {
        return rng.uniform(-1.0, 1.0) * std::pow(10.0, rng.uniform(lowest, 0.0));
    };
    for (int n = 0; n < 3000; ++n) {
        Impact i = unlike(rng);
        const double R = i.params.R;
        i.params.mu_b = std::pow(10.0, rng.uniform(-4.0, -0.7));
        if (n % 4 == 0) i.params.e_b = rng.next() % 2 == 0 ? 0.0 : 1.0;
        i.ball2.r[0] = 0.0;
        i.ball2.r[1] = 2.0 * R * std::sqrt(i.params.radius_ratio);
        i.ball1.v[0] = 0.0;
        i.ball1.v[1] = 1.0;
        for (Ball* ball : {&i.ball1, &i.ball2})
            for (double& w : ball->w) w = 0.0;
        const int kind = n % 5;
        if (kind >= 2) i.ball1.v[0] = decades(-8.0);
        if (kind == 1 || kind == 3) {
            i.ball1.w[0] = -1.0 / R;
            i.ball1.w[1] = i.ball1.v[0] / R;
        }
        if (kind == 4) {
            i.ball1.w[0] = 10.0 * decades(-8.0);
            i.ball1.w[2] = 30.0 * decades(-8.0);
            i.ball2.w[0] = 1e-5 * decades(-1.0);
        }
        const ImpactResult truth = solve(i, 1e-11);
        ASSERT_EQ(truth.status, ImpactStatus::kOk);
        for (const double tolerance : {1e-3, 1e-6, 1e-8})
            EXPECT_LT(difference(solve(i, tolerance), truth, R), tolerance)
                << n << " kind " << kind << " mu_b " << i.params.mu_b;
    }
}

// Energy is never gained; without a cloth, momentum and the difference of the spins' changes are conserved.
TEST(UnlikeImpact, MomentumAndEnergy) {
    Generator rng(83);
    for (int n = 0; n < 5000; ++n) {
        Impact i = kKinds[n % 5 >= 3](rng);
        if (n % 2 == 0) i.params.e_b = 1.0;
        for (const double tolerance : {1e-3, 1e-6, 1e-10}) {
            const ImpactResult r = solve(i, tolerance);
            const double before = energy_of(i, i.ball1.v, i.ball1.w, i.ball2.v, i.ball2.w);
            EXPECT_LE(energy_of(i, r.v1, r.w1, r.v2, r.w2), before * (1.0 + 1e-14)) << n;
        }
        i.params.mu_s1 = i.params.mu_s2 = 0.0;
        const ImpactResult r = solve(i, 1e-3);
        const Two t = two_of(i);
        for (int k = 0; k < 2; ++k)
            EXPECT_NEAR(t.m[0] * r.v1[k] + t.m[1] * r.v2[k], t.m[0] * i.ball1.v[k] + t.m[1] * i.ball2.v[k],
                        1e-14);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(t.m[0] * t.R[0] * (r.w1[k] - i.ball1.w[k]),
                        t.m[1] * t.R[1] * (r.w2[k] - i.ball2.w[k]), 1e-14);
        // Without friction and with full restitution, no energy is lost.
        i.params.mu_b = 0.0;
        i.params.e_b = 1.0;
        const ImpactResult free = solve(i, 1e-3);
        const double before = energy_of(i, i.ball1.v, i.ball1.w, i.ball2.v, i.ball2.w);
        EXPECT_NEAR(energy_of(i, free.v1, free.w1, free.v2, free.w2), before, 1e-14 * before);
    }
}

// Mirroring an impact, or exchanging the balls, does the same to its result, bit for bit.
TEST(UnlikeImpact, MirrorAndOrder) {
    Generator rng(84);
    for (int n = 0; n < 1000; ++n) {
        const Impact i = kKinds[n % 2](rng);
        const ImpactResult r = solve(i, 1e-6);
        ImpactResult other = solve(swapped(i), 1e-6);
        std::swap(other.v1, other.v2);
        std::swap(other.w1, other.w2);
        EXPECT_LT(difference(r, other, i.params.R), 1e-12);
        Impact mirrored = i;
        for (Ball* ball : {&mirrored.ball1, &mirrored.ball2}) {
            ball->r[0] = -ball->r[0];
            ball->v[0] = -ball->v[0];
            ball->w[1] = -ball->w[1];
            ball->w[2] = -ball->w[2];
        }
        ImpactResult m = solve(mirrored, 1e-6);
        for (double(*v)[3] : {&m.v1, &m.v2}) (*v)[0] = -(*v)[0];
        for (double(*w)[3] : {&m.w1, &m.w2}) {
            (*w)[1] = -(*w)[1];
            (*w)[2] = -(*w)[2];
        }
        EXPECT_EQ(difference(r, m, i.params.R), 0.0) << n;
    }
}

// Results are continuous where the balls become equal, or equal in radius.
TEST(UnlikeImpact, ContinuousAtEqualBalls) {
    Generator rng(85);
    for (int n = 0; n < 300; ++n) {
        Impact i = unlike(rng);
        if (n % 2 == 0) i.params.mass_ratio = 1.0;
        Impact same = i;
        same.params.radius_ratio = 1.0;
        same.ball2.r[2] = same.ball1.r[2];
        const ImpactResult wanted = solve(same, 1e-11);
        for (const double more : {-1e-5, 1e-5, 1e-8}) {
            i.params.radius_ratio = 1.0 + more;
            i.ball2.r[2] = i.params.R * i.params.radius_ratio;
            const double moved = difference(solve(i, 1e-11), wanted, i.params.R) / approach_speed(i);
            EXPECT_LT(moved, 40.0 * std::fabs(more) + 2e-11) << n;
        }
    }
}

TEST(UnlikeImpact, ContinuousAtEqualMasses) {
    Generator rng(73);
    for (int n = 0; n < 500; ++n) {
        Impact i = of_one_radius(rng);
        i.params.mass_ratio = 1.0;
        const ImpactResult equal = solve(i, 1e-11);
        for (const double more : {-1e-6, 1e-6, 1e-9}) {
            i.params.mass_ratio = 1.0 + more;
            const double moved = difference(solve(i, 1e-11), equal, i.params.R) / approach_speed(i);
            EXPECT_LT(moved, 8.0 * std::fabs(more) + 2e-11);
        }
    }
}

// A ball a million times as heavy acts as a wall: it stays, and the other rebounds at e_b.
TEST(UnlikeImpact, AgainstAWall) {
    for (const double ratio : {1.0, 1.25}) {
        Impact i{};
        i.params = {.R = 0.03,
                    .m = 0.17,
                    .mu_s1 = 0.0,
                    .mu_s2 = 0.0,
                    .mu_b = 0.0,
                    .e_b = 0.8,
                    .mass_ratio = 1e6,
                    .radius_ratio = ratio};
        i.ball1.r[2] = 0.03;
        i.ball2.r[1] = 2.0 * 0.03 * std::sqrt(ratio);
        i.ball2.r[2] = 0.03 * ratio;
        i.ball1.v[0] = 0.3;
        i.ball1.v[1] = 1.0;
        const ImpactResult r = solve(i, 1e-9);
        ASSERT_EQ(r.status, ImpactStatus::kOk);
        EXPECT_NEAR(r.v1[0], 0.3, 1e-9);
        EXPECT_NEAR(r.v1[1], -0.8, 2e-6);
        EXPECT_NEAR(r.v2[1], 0.0, 2e-6);
    }
}

TEST(UnlikeImpact, TheMarchConverges) {
    Generator rng(86);
    for (int n = 0; n < 200; ++n) {
        Impact i = unlike(rng);
        if (n % 4 == 0) {
            i.params.radius_ratio = 1.0;
            i.ball2.r[2] = i.ball1.r[2];
        }
        const ImpactResult truth = solve(i, 1e-9);
        for (const MarchFunction march : {march_function(best_isa()), summed_march_function(best_isa())}) {
            ImpactResult r{};
            march(i.ball1, i.ball2, i.params, 10000, r);
            ASSERT_EQ(r.status, ImpactStatus::kOk);
            EXPECT_GT(r.steps, 9000);
            EXPECT_LT(difference(r, truth, i.params.R) / approach_speed(i), 6e-4) << n;
        }
    }
}

TEST(UnlikeImpact, ABatchSolvesThemOneByOne) {
    Generator rng(87);
    const int count = 203;
    std::vector<Impact> impacts;
    std::vector<double> numbers[26];
    for (int n = 0; n < count; ++n) {
        Impact i = unlike(rng);
        if (n % 3 == 0) {
            i.params.mass_ratio = i.params.radius_ratio = 1.0;
            i.ball2.r[2] = i.ball1.r[2];
        }
        impacts.push_back(i);
        for (int k = 0; k < 3; ++k) {
            const double each[] = {i.ball1.r[k], i.ball1.v[k], i.ball1.w[k],
                                   i.ball2.r[k], i.ball2.v[k], i.ball2.w[k]};
            for (int a = 0; a < 6; ++a) numbers[3 * a + k].push_back(each[a]);
        }
        const ImpactParams& p = i.params;
        const double params[] = {p.R, p.m, p.mu_s1, p.mu_s2, p.mu_b, p.e_b, p.mass_ratio, p.radius_ratio};
        for (int a = 0; a < 8; ++a) numbers[18 + a].push_back(params[a]);
    }
    const auto in = [&](int a) { return numbers[a].data(); };
    ImpactBatch batch{
        count,
        {{in(0), in(1), in(2)}, {in(3), in(4), in(5)}, {in(6), in(7), in(8)}},
        {{in(9), in(10), in(11)}, {in(12), in(13), in(14)}, {in(15), in(16), in(17)}},
        {in(18), in(19), in(20), in(21), in(22), in(23), ClothSlip::kConsistent, in(24), in(25)}};
    std::vector<double> out[12];
    for (std::vector<double>& o : out) o.resize(count);
    const auto to = [&](int a) { return out[a].data(); };
    std::vector<ImpactStatus> status(count);
    tolerance_batch_function(best_isa())(batch, 1e-6,
                                         {{{to(0), to(1), to(2)}, {to(3), to(4), to(5)}},
                                          {{to(6), to(7), to(8)}, {to(9), to(10), to(11)}},
                                          status.data(),
                                          nullptr,
                                          nullptr});
    for (int n = 0; n < count; ++n) {
        const ImpactResult r = solve(impacts[n], 1e-6);
        EXPECT_EQ(status[n], r.status);
        const bool alike = n % 3 == 0;
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(out[k][n], r.v1[k], alike ? 2e-6 * approach_speed(impacts[n]) : 0.0);
            EXPECT_NEAR(out[6 + k][n], r.v2[k], alike ? 2e-6 * approach_speed(impacts[n]) : 0.0);
        }
    }
}

TEST(UnlikeImpact, RefusedIfFrictionCouldLock) {
    Generator rng(88);
    Impact i = unlike(rng);
    for (const double ratio : {0.0, 0.249, 4.01, std::numeric_limits<double>::quiet_NaN()}) {
        i.params.radius_ratio = ratio;
        EXPECT_EQ(solve(i, 1e-6).status, ImpactStatus::kBadParameter) << ratio;
    }
    i.params.radius_ratio = 1.25;
    i.ball2.r[2] = 1.25 * i.params.R;
    i.params.mu_s1 = i.params.mu_s2 = 1.0;
    i.params.mu_b = 1.0;
    EXPECT_EQ(solve(i, 1e-6).status, ImpactStatus::kBadParameter);
    i.params.mu_s1 = i.params.mu_s2 = 0.2;
    i.params.mu_b = 0.1;
    EXPECT_EQ(solve(i, 1e-6).status, ImpactStatus::kOk);
    i.ball2.r[2] = i.params.R;  // too low for the larger ball
    EXPECT_EQ(solve(i, 1e-6).status, ImpactStatus::kBadState);
    ImpactResult r{};
    collide_inelastic(i.ball1, i.ball2, i.params, r);
    EXPECT_EQ(r.status, ImpactStatus::kBadParameter);
}

TEST(UnlikeImpact, UnsupportedMassRatiosAreRefused) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Generator rng(74);
    Impact i = of_one_radius(rng);
    i.params.mu_s1 = i.params.mu_s2 = 0.2;
    for (double ratio : {0.0, -1.0, 0.9e-6, 1.1e6, 1e300, nan}) {
        i.params.mass_ratio = ratio;
        EXPECT_EQ(solve(i, 1e-6).status, ImpactStatus::kBadParameter) << ratio;
    }
    for (double ratio : {1.0 / kLargestMassRatio, 0.0999, 0.1, 10.0, 10.01, kLargestMassRatio}) {
        i.params.mass_ratio = ratio;
        EXPECT_EQ(solve(i, 1e-6).status, ImpactStatus::kOk) << ratio;
    }
    // Cloth friction up to 1 is accepted, as between equal balls.
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

TEST(UnlikeImpact, EveryInstructionSetAgrees) {
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
