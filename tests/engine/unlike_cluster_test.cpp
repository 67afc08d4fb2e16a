// The compliant cluster of balls of different sizes, on the cloth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "carom/kernel/tolerance.h"
#include "physics/cluster.h"
#include "reference/random_impacts.h"
#include "support/engine_cases.h"

namespace carom::test {
namespace {

constexpr double kR = 0.028575;

ClusterSettings settings(double mu_b, double mu_s, double e) {
    return {.R = kR,
            .mu_s = mu_s,
            .mu_b = mu_b,
            .e_b = e,
            .integrate = kernel::contact_phase_function(kernel::best_isa()),
            .unlike = true};
}

ClusterBall ball(double x, double y, double R = kR, double mass = 1.0, const Vec3& v = Vec3::Zero(),
                 const Vec3& w = Vec3::Zero()) {
    return {0, Vec3(x, y, R), v, w, R, mass};
}

// A ball that touches another in the given direction.
ClusterBall beside(const ClusterBall& at, double angle, double R, double mass, double gap = 0.0) {
    const double apart = contact_distance(at.R, R, false) + gap;
    return ball(at.r.x() + apart * std::cos(angle), at.r.y() + apart * std::sin(angle), R, mass);
}

// All pairs nearer than 1 mm are contacts; gaps of rounding size count as 0.
std::vector<ClusterContact> contacts_of(const std::vector<ClusterBall>& balls) {
    std::vector<ClusterContact> contacts;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        for (std::size_t j = i + 1; j < balls.size(); ++j) {
            const Vec3 apart = balls[j].r - balls[i].r;
            const double distance = apart.norm(), gap = distance - (balls[i].R + balls[j].R);
            if (gap < 1e-3)
                contacts.push_back(
                    {static_cast<int>(i), static_cast<int>(j), apart / distance, gap < 1e-14 ? 0.0 : gap});
        }
    }
    return contacts;
}

double energy(const std::vector<ClusterBall>& balls) {
    double sum = 0.0;
    for (const ClusterBall& b : balls)
        sum += b.mass * (0.5 * b.v.squaredNorm() + 0.2 * b.R * b.R * b.w.squaredNorm());
    return sum;
}

Vec3 momentum(const std::vector<ClusterBall>& balls) {
    Vec3 sum = Vec3::Zero();
    for (const ClusterBall& b : balls) sum += b.mass * b.v;
    return sum;
}

double difference(const std::vector<ClusterBall>& a, const std::vector<ClusterBall>& b) {
    double most = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k)
        most = std::max({most, (a[k].v - b[k].v).norm(), kR * (a[k].w - b[k].w).norm()});
    return most;
}

// The cue ball and a rack of rows 1 to 5; some balls have their own size and then leave gaps.
std::vector<ClusterBall> rack(double V, double gap = 0.0) {
    const double apart = 2.0 * kR + gap;
    std::vector<ClusterBall> balls{ball(0.0, -apart, kR, 1.0, {0.0, V, 0.0})};
    for (int row = 0; row < 5; ++row)
        for (int k = 0; k <= row; ++k)
            balls.push_back(ball((k - 0.5 * row) * apart, row * std::sqrt(0.75) * apart));
    return balls;
}

// With equal balls, the code for unlike balls matches today's result up to the steps of either. The
// regularisation costs 6e-4 V in touching racks on either path.
TEST(UnlikeCluster, EqualBallsMatchTheirOwnPath) {
    double frictionless = 0.0, rough = 0.0;
    for (const double mu_b : {0.0, 0.05}) {
        for (const double gap : {0.0, 1e-5}) {
            std::vector<ClusterBall> one = rack(1.0, gap), other = one;
            one[0].v.x() = other[0].v.x() = 0.1;
            one[0].w = other[0].w = {-20.0, 5.0, 15.0};
            const ClusterSettings s = settings(mu_b, 0.2, 0.95);
            ClusterMap map;
            ASSERT_GT(map.compliant(one, contacts_of(one), s, 1.0, true), 0);
            ASSERT_GT(map.compliant(other, contacts_of(other), s, 1.0, true), 0);
            double& worst = mu_b == 0.0 ? frictionless : rough;
            worst = std::max(worst, difference(one, other));
        }
    }
    EXPECT_LT(frictionless, 2e-5);
    EXPECT_LT(rough, 1.5e-3);
}

// Two balls through the map match the pair kernel, unlike balls as closely as equal ones.
TEST(UnlikeCluster, TwoBallsMatchThePairKernel) {
    for (const bool odd : {false, true}) {
        reference::Generator rng(7);
        std::vector<double> differences;
        for (int k = 0; k < 200; ++k) {
            reference::Impact i = reference::random_impact(rng);
            kernel::ImpactParams& p = i.params;
            p.mu_s2 = p.mu_s1;
            const double radii = rng.uniform(0.8, 1.25), masses = rng.uniform(0.7, 1.5);
            if (odd) {
                p.radius_ratio = radii;
                p.mass_ratio = masses;
                const double R2 = p.R * radii;
                const Vec2 y = Vec2(i.ball2.r[0] - i.ball1.r[0], i.ball2.r[1] - i.ball1.r[1]).normalized();
                const double apart = contact_distance(p.R, R2, false);
                i.ball2.r[0] = i.ball1.r[0] + apart * y.x();
                i.ball2.r[1] = i.ball1.r[1] + apart * y.y();
                i.ball1.r[2] = p.R;
                i.ball2.r[2] = R2;
            }
            kernel::ImpactResult want;
            kernel::tolerance_function(kernel::best_isa())(i.ball1, i.ball2, p, 1e-8, want);
            ASSERT_EQ(want.status, kernel::ImpactStatus::kOk);
            const auto from = [](const kernel::Ball& b, double R, double mass) {
                return ClusterBall{0,
                                   Vec3(b.r[0], b.r[1], b.r[2]),
                                   Vec3(b.v[0], b.v[1], 0.0),
                                   Vec3(b.w[0], b.w[1], b.w[2]),
                                   R,
                                   mass};
            };
            std::vector<ClusterBall> balls{from(i.ball1, p.R, 1.0),
                                           from(i.ball2, p.R * p.radius_ratio, p.mass_ratio)};
            const std::vector<ClusterContact> contacts = contacts_of(balls);
            const double V = dot3(contacts.front().n, balls[0].v - balls[1].v);
            ClusterMap map;
            ClusterSettings s = settings(p.mu_b, p.mu_s1, p.e_b);
            s.R = p.R;
            s.unlike = odd;
            s.turns = false;  // an impact of two balls at an instant
            ASSERT_GT(map.compliant(balls, contacts, s, V, true), 0);
            differences.push_back(std::max((balls[0].v - Vec3(want.v1[0], want.v1[1], 0.0)).norm(),
                                           (balls[1].v - Vec3(want.v2[0], want.v2[1], 0.0)).norm()) /
                                  V);
        }
        std::sort(differences.begin(), differences.end());
        EXPECT_LT(differences[100], 2e-4) << odd;
        EXPECT_LT(differences[180], 2e-3) << odd;
        EXPECT_LT(differences.back(), 1.5e-2) << odd;
    }
}

// Momentum is conserved where the cloth has no friction, energy always, and no contact is left closing.
TEST(UnlikeCluster, MomentumAndEnergy) {
    reference::Generator rng(12);
    for (int k = 0; k < 200; ++k) {
        std::vector<ClusterBall> balls{ball(0.0, 0.0, kR * rng.uniform(0.8, 1.25), rng.uniform(0.7, 1.5))};
        for (int n = 1; n < 6; ++n) {
            const ClusterBall next = beside(balls.back(), rng.uniform(-1.0, 1.0), kR * rng.uniform(0.8, 1.25),
                                            rng.uniform(0.7, 1.5), n % 3 == 0 ? 1e-5 : 0.0);
            balls.push_back(next);
        }
        balls[0].v = {rng.uniform(0.5, 5.0), rng.uniform(-0.5, 0.5), 0.0};
        for (int c = 0; c < 3; ++c) balls[0].w[c] = rng.uniform(-60.0, 60.0);
        const std::vector<ClusterContact> contacts = contacts_of(balls);
        const double V = dot3(contacts.front().n, balls[0].v - balls[1].v);
        if (!(V > 0.0)) continue;
        const double mu_b = k % 2 == 0 ? 0.0 : 0.05, mu_s = k % 4 == 1 ? 0.2 : 0.0,
                     e = k % 3 == 0 ? 1.0 : 0.9;
        std::vector<ClusterBall> after = balls;
        ClusterMap map;
        ASSERT_GT(map.compliant(after, contacts, settings(mu_b, mu_s, e), V, true), 0) << k;
        EXPECT_LE(energy(after), energy(balls) * (1.0 + 1e-13)) << k;
        if (mu_b == 0.0 && e == 1.0) {
            EXPECT_NEAR(energy(after) / energy(balls), 1.0, 3e-6) << k;
        }
        if (mu_s == 0.0) {
            EXPECT_LT((momentum(after) - momentum(balls)).norm(), 1e-13 * momentum(balls).norm()) << k;
        }
        for (const ClusterBall& b : after) EXPECT_EQ(b.v.z(), 0.0);
    }
}

// Lines of any masses up to the allowed ratio. From a ratio of 3e4 on, two heavy balls with a light one
// between them once lost half of their energy, because contacts of heavy balls outlast those of light ones.
TEST(UnlikeCluster, LinesOfAnyMassesLoseNothing) {
    std::vector<std::vector<double>> lines{
        {1e5, 1.0, 1e5}, {1e6, 1.0, 1e6}, {1.0, 1e-6, 1.0}, {6e4, 1.0, 1.0, 6e4}, {1e6, 1.0, 1e3, 1.0, 1e6}};
    reference::Generator rng(4);
    while (lines.size() < 25) {
        std::vector<double> masses(static_cast<std::size_t>(rng.uniform(3.0, 6.0)));
        const double least = std::pow(10.0, rng.uniform(-6.0, 0.0));
        for (double& mass : masses) mass = least * std::pow(10.0, rng.uniform(0.0, 6.0));
        lines.push_back(masses);
    }
    for (std::size_t k = 0; k < lines.size(); ++k) {
        std::vector<ClusterBall> balls{ball(0.0, 0.0, kR, lines[k][0], {1.0, 0.0, 0.0})};
        for (std::size_t b = 1; b < lines[k].size(); ++b)
            balls.push_back(beside(balls.back(), 0.0, kR, lines[k][b]));
        const std::vector<ClusterContact> contacts = contacts_of(balls);
        std::vector<ClusterBall> after = balls, finer = balls;
        ClusterMap map;
        ClusterSettings with = settings(0.0, 0.0, 1.0);
        ASSERT_GT(map.compliant(after, contacts, with, 1.0, true), 0) << k;
        EXPECT_NEAR(energy(after) / energy(balls), 1.0, 3e-6) << k;
        EXPECT_LT((momentum(after) - momentum(balls)).norm(), 1e-12 * momentum(balls).norm()) << k;
        // A light ball between heavy ones oscillates up to a million times.
        with.tolerance = 1e-7;
        if (map.compliant(finer, contacts, with, 1.0, true) < 0) continue;
        EXPECT_LT(difference(after, finer), 2e-3) << k;
    }
}

// With gaps, a row of balls of falling mass passes the impulse on pair by pair, nearly.
TEST(UnlikeCluster, ARowWithGapsIsAChainOfPairs) {
    std::vector<ClusterBall> balls{ball(0.0, 0.0, kR, 1.5, {1.0, 0.0, 0.0})};
    for (const double mass : {1.2, 0.9, 0.7})
        balls.push_back(beside(balls.back(), 0.0, kR * std::cbrt(mass), mass, 1.5e-4));
    balls[1].r.x() -= 1.5e-4;
    for (std::size_t b = 2; b < balls.size(); ++b) balls[b].r.x() -= 1.5e-4;
    const std::vector<ClusterContact> contacts = contacts_of(balls);
    std::vector<ClusterBall> after = balls;
    ClusterMap map;
    ASSERT_GT(map.compliant(after, contacts, settings(0.0, 0.0, 1.0), 1.0, true), 0);
    double v = 1.0;
    for (std::size_t b = 0; b + 1 < balls.size(); ++b) {
        const double m1 = balls[b].mass, m2 = balls[b + 1].mass;
        EXPECT_NEAR(after[b].v.x(), v * (m1 - m2) / (m1 + m2), 1e-3) << b;
        v *= 2.0 * m1 / (m1 + m2);
    }
    EXPECT_NEAR(after.back().v.x(), v, 1e-3);
}

TEST(UnlikeCluster, MirrorImagesHaveMirrorResults) {
    const double large = 1.25 * kR;
    std::vector<ClusterBall> balls{ball(0.0, 0.0, large, 1.4, {0.0, 2.0, 0.0}, {-40.0, 0.0, 0.0})};
    balls.push_back(beside(balls[0], M_PI / 2 + 0.6, kR, 1.0));
    balls.push_back(beside(balls[0], M_PI / 2 - 0.6, kR, 1.0));
    balls[2].r.x() = -balls[1].r.x();
    balls[2].r.y() = balls[1].r.y();
    ClusterMap map;
    std::vector<ClusterContact> contacts = contacts_of(balls);
    ASSERT_EQ(contacts.size(), 2u);
    contacts[0].gap = contacts[1].gap = 0.0;
    ASSERT_GT(map.compliant(balls, contacts, settings(0.05, 0.2, 0.95), 2.0, true), 0);
    EXPECT_NEAR(balls[0].v.x(), 0.0, 1e-15);
    EXPECT_NEAR(balls[1].v.x(), -balls[2].v.x(), 1e-14);
    EXPECT_NEAR(balls[1].v.y(), balls[2].v.y(), 1e-14);
    EXPECT_NEAR(balls[1].w.z(), -balls[2].w.z(), 1e-12);
}

// In a scene, an odd ball beside equal ones changes nothing for balls that it does not touch.
TEST(UnlikeCluster, AnOddBallOutOfReachChangesNothing) {
    Scene scene = empty_scene();
    add_ball(scene, "cue", 0.0, -0.5, 0.02, 3.0);
    add_ball(scene, "1", 0.0, 0.0);
    add_ball(scene, "2", -kR, std::sqrt(3.0) * kR);
    add_ball(scene, "3", kR, std::sqrt(3.0) * kR);
    const Record without = simulate(plan_of(scene));
    add_ball(scene, "odd", 0.5, -3.0);
    scene.ball.back().own = BallSize{1.2 * kR, 0.2};
    scene.ball.back().position.z() = 1.2 * kR;
    const Record with = simulate(plan_of(scene));
    for (std::size_t b = 0; b < 4; ++b) EXPECT_EQ(with.tracks[b].segments, without.tracks[b].segments) << b;
}

}  // namespace
}  // namespace carom::test
