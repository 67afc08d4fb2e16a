// Impacts of balls off the cloth: reference values, computed independently with 30 digits, and conservation
// laws (docs/reference/physics.md, "Balls in the air"). Pool balls, mu_s = 0.2, e_t = 0.5.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carom/engine/airborne.h"
#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/math.h"
#include "physics/cue.h"
#include "physics/motion.h"
#include "physics/reach.h"
#include "reference/random_impacts.h"
#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;
using reference::Generator;

constexpr double kAirR = 0.028575, kAirM = 0.170097, kAirG = 9.81;

BallParams balls() {
    BallParams p = pool_balls();
    p.R = kAirR;
    p.m = kAirM;
    p.mu_s = 0.2;
    p.mu_b = 0.05;
    p.mu_b_more = 0.0;
    p.mu_sp = 0.0127;
    p.e_b = 0.95;
    p.e_c = 0.85;
    p.e_c_fall = 0.0;
    p.f_c = 0.2;
    p.f_c_more = 0.0;
    p.e_t = 0.5;
    return p;
}

MotionParams motion(bool spin_decay = false) {
    MotionParams m = motion_params(balls(), kAirG, kAirR);
    m.spin_decay = spin_decay;
    return m;
}

/// Equal to 1e-13 of the larger value, or of 1.
void expect_close(const Vec3& got, const Vec3& want, const char* what) {
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(got[k], want[k], 1e-13 * std::max(1.0, std::abs(want[k]))) << what << " [" << k << "]";
}

Velocities on_cloth(Velocities ball, const BallParams& p = balls(), bool spin_decay = false) {
    MotionParams m = motion_params(p, kAirG, kAirR);
    m.spin_decay = spin_decay;
    hit_cloth(p, m, ball);
    return ball;
}

double energy(const Velocities& b, double R = kAirR, double m = kAirM) {
    return m * (0.5 * b.v.squaredNorm() + 0.2 * R * R * b.w.squaredNorm());
}

TEST(Cloth, TheSlowestBounce) {
    const double v = bounce_end(kAirR, kAirG);
    EXPECT_NEAR(v, 0.0502283460806744, 1e-15);
    EXPECT_NEAR(v * v / (2.0 * kAirG), 0.0001285875, 1e-17);
    EXPECT_NEAR(2.0 * v / kAirG, 0.0102402336555911, 1e-15);
}

TEST(Cloth, LandingsOfTheReference) {
    const struct {
        Velocities before;
        Vec3 v;
        double R_wy, slip;
    } kRows[] = {
        {{{1.0, 0.0, -2.0}, {0.0, 0.0, 7.0}}, {0.714285714285714, 0.0, 1.0}, 0.714285714285714, 0.0},
        {{{3.0, 0.0, -1.0}, {0.0, 0.0, 7.0}}, {2.7, 0.0, 0.5}, 0.75, 1.95},
        {{{1.0, 0.0, -2.0}, {0.0, -3.0 / kAirR, 7.0}}, {0.4, 0.0, 1.0}, -1.5, 1.9},
        {{{1.0, 0.0, -2.0}, {0.0, 4.0 / kAirR, 7.0}}, {1.6, 0.0, 1.0}, 2.5, -0.9},
    };
    for (const auto& row : kRows) {
        const Velocities after = on_cloth(row.before);
        EXPECT_NEAR(after.v.x(), row.v.x(), 1e-14);
        EXPECT_EQ(after.v.y(), 0.0);
        EXPECT_EQ(after.v.z(), row.v.z());
        EXPECT_NEAR(kAirR * after.w.y(), row.R_wy, 1e-14);
        EXPECT_NEAR(after.v.x() - kAirR * after.w.y(), row.slip, 1e-14);
        EXPECT_EQ(after.w.z(), 7.0) << "only pivot friction takes vertical spin";
    }
    const Velocities oblique = on_cloth({{1.2, -0.7, -3.0}, {20.0, -35.0, 50.0}});
    expect_close(oblique.v, {0.571392857142857, -0.663285714285714, 1.5}, "v");
    expect_close(oblique.w, {23.212098487689, 19.9962504686914, 50.0}, "w");
    const Velocities pivot = on_cloth({{0.0, 0.0, -2.0}, {0.0, 0.0, 7.0}}, balls(), true);
    EXPECT_NEAR(7.0 - pivot.w.z(), 3.33333333333333, 1e-13);
    EXPECT_EQ(on_cloth({{0.0, 0.0, -2.0}, {0.0, 0.0, -1.0}}, balls(), true).w.z(), 0.0) << "not past 0";
}

// Every landing conserves v - (2/5) R (z x w) and the direction of the slip, and its energy balances.
TEST(Cloth, LandingsKeepTheirLaws) {
    Generator random(22);
    int gripped = 0;
    for (int k = 0; k < 20000; ++k) {
        Velocities b;
        for (int i = 0; i < 3; ++i) {
            b.v[i] = random.uniform(-5.0, 5.0);
            b.w[i] = random.uniform(-200.0, 200.0);
        }
        b.v.z() = -random.uniform(0.2, 5.0);
        const Velocities a = on_cloth(b);
        const double V = -b.v.z(), J = std::hypot(a.v.x() - b.v.x(), a.v.y() - b.v.y());
        const Vec2 slip = cloth_slip(b.v, b.w, kAirR), left = cloth_slip(a.v, a.w, kAirR);
        EXPECT_NEAR(a.v.x() + 0.4 * kAirR * a.w.y(), b.v.x() + 0.4 * kAirR * b.w.y(), 1e-14);
        EXPECT_NEAR(a.v.y() - 0.4 * kAirR * a.w.x(), b.v.y() - 0.4 * kAirR * b.w.x(), 1e-14);
        EXPECT_LE(std::abs(cross(slip, left)), 1e-13 * slip.norm());
        EXPECT_GE(dot(slip, left), -1e-13 * slip.norm());
        EXPECT_LE(J, 0.2 * 1.5 * V * (1.0 + 1e-13));
        gripped += left.norm() < 1e-13;
        const double lost = (energy(b) - energy(a)) / kAirM;
        EXPECT_NEAR(lost, 0.75 * 0.5 * V * V + J * slip.norm() - 1.75 * J * J, 1e-12);
        // Mirror images and quarter turns agree bit for bit.
        const auto turned = [](const Vec3& x) { return Vec3(-x.y(), x.x(), x.z()); };
        const Velocities quarter = on_cloth({turned(b.v), turned(b.w)});
        EXPECT_EQ(quarter.v, turned(a.v));
        EXPECT_EQ(quarter.w, turned(a.w));
        const Velocities mirror = on_cloth({{-b.v.x(), b.v.y(), b.v.z()}, {b.w.x(), -b.w.y(), -b.w.z()}});
        EXPECT_EQ(mirror.v, Vec3(-a.v.x(), a.v.y(), a.v.z()));
        EXPECT_EQ(mirror.w, Vec3(a.w.x(), -a.w.y(), -a.w.z()));
    }
    EXPECT_GT(gripped, 200);
}

TEST(Cloth, RestitutionMayFallWithTheSpeed) {
    BallParams p = balls();
    p.e_t = 0.4;
    p.e_t_more = 0.3;
    p.e_t_fall = 0.5;
    EXPECT_NEAR(on_cloth({{0.0, 0.0, -2.0}, Vec3::Zero()}, p).v.z(), 2.0 * (0.4 + 0.3 * std::exp(-1.0)),
                1e-15);
}

FreePair pair(double mu_b = 0.05) {
    return {{kAirR, kAirM}, {kAirR, kAirM}, {mu_b}, balls().e_b};
}

TEST(FreeBalls, AFullHitOfARollingBall) {
    Velocities one{{2.0, 0.0, 0.0}, {0.0, 2.0 / kAirR, 0.0}}, two{Vec3::Zero(), Vec3::Zero()};
    hit_ball(pair(), {1.0, 0.0, 0.0}, one, two);
    EXPECT_NEAR(one.v.x(), 0.05, 1e-15);
    EXPECT_NEAR(one.v.z(), 0.0975, 1e-15);
    EXPECT_NEAR(kAirR * one.w.y(), 1.75625, 1e-14);
    EXPECT_NEAR(two.v.x(), 1.95, 1e-15);
    EXPECT_NEAR(two.v.z(), -0.0975, 1e-15);
    const Velocities after = on_cloth(two);
    EXPECT_NEAR(after.v.x(), 1.9305, 1e-14);
    EXPECT_EQ(after.v.z(), 0.0) << "the rebound of 0.049 m/s is below bounce_end()";
    EXPECT_NEAR(kAirR * after.w.y(), -0.195, 1e-14);
}

TEST(FreeBalls, UnlikeBalls) {
    FreePair p = pair();
    p.size1 = {0.0603 / 2.0, 0.1987};
    const double R1 = p.size1.R, sine = (kAirR - R1) / (R1 + kAirR);
    EXPECT_NEAR(sine, -0.0268199233716475, 1e-15);
    EXPECT_NEAR(contact_distance(R1, kAirR, false), 0.0587038755109064, 1e-15);
    const Vec3 n(std::sqrt(1.0 - sine * sine), 0.0, sine);
    Velocities one{{2.0, 0.0, 0.0}, {0.0, 2.0 / R1, 0.0}}, two{Vec3::Zero(), Vec3::Zero()};
    hit_ball(p, n, one, two);
    expect_close(one.v, {0.204942397219913, 0.0, 0.138098768339488}, "v1");
    expect_close(two.v, {2.09690909112097, 0.0, -0.161321041929347}, "v2");
    EXPECT_NEAR(R1 * one.w.y(), 1.77523553936006, 1e-13);
    EXPECT_NEAR(kAirR * two.w.y(), -0.26256017642378, 1e-13);
    const Velocities after = on_cloth(two);
    expect_close(after.v, {2.04851277854216, 0.0, 0.0806605209646737}, "v2 after the cloth");
    EXPECT_NEAR(kAirR * after.w.y(), -0.14156939497677, 1e-13);
}

double total_energy(const FreePair& p, const Velocities& one, const Velocities& two) {
    return energy(one, p.size1.R, p.size1.m) + energy(two, p.size2.R, p.size2.m);
}

// Conserved: momentum and spin about the line of centres. Both surfaces receive equal impulses, energy
// balances, and a moving observer sees the same impact.
TEST(FreeBalls, KeepTheirLaws) {
    Generator random(5);
    for (int k = 0; k < 20000; ++k) {
        FreePair p = pair(random.uniform(0.0, 0.4));
        p.size2 = {random.uniform(0.02, 0.05), random.uniform(0.05, 0.4)};
        p.e_b = random.uniform(0.0, 1.0);
        Velocities b1, b2;
        Vec3 n;
        for (int i = 0; i < 3; ++i) {
            b1.v[i] = random.uniform(-5.0, 5.0);
            b1.w[i] = random.uniform(-200.0, 200.0);
            b2.v[i] = random.uniform(-5.0, 5.0);
            b2.w[i] = random.uniform(-200.0, 200.0);
            n[i] = random.uniform(-1.0, 1.0);
        }
        n.normalize();
        if (!(dot3(b1.v - b2.v, n) > 0.0)) n = -n;
        Velocities a1 = b1, a2 = b2;
        hit_ball(p, n, a1, a2);
        const BallSize &s1 = p.size1, &s2 = p.size2;
        EXPECT_LE((s1.m * (a1.v - b1.v) + s2.m * (a2.v - b2.v)).norm(), 1e-14);
        EXPECT_NEAR(dot3(a1.v - a2.v, n), -p.e_b * dot3(b1.v - b2.v, n), 1e-13);
        EXPECT_NEAR(dot3(a1.w, n), dot3(b1.w, n), 1e-12);
        EXPECT_NEAR(dot3(a2.w, n), dot3(b2.w, n), 1e-12);
        EXPECT_LE((s1.m * s1.R * (a1.w - b1.w) - s2.m * s2.R * (a2.w - b2.w)).norm(), 1e-14);
        EXPECT_LE(total_energy(p, a1, a2), total_energy(p, b1, b2) * (1.0 + 1e-14));
        const Vec3 wind(3.0, -7.0, 2.0);
        Velocities c1{b1.v + wind, b1.w}, c2{b2.v + wind, b2.w};
        hit_ball(p, n, c1, c2);
        EXPECT_LE((c1.v - wind - a1.v).norm() + (c2.v - wind - a2.v).norm(), 1e-13);
        EXPECT_LE((c1.w - a1.w).norm(), 1e-10);
    }
}

// For balls at one height with v_z = 0, the planar closed form is the same law.
TEST(FreeBalls, MatchTheInelasticModelInThePlane) {
    Generator random(9);
    const BallBallModelInfo& model = *ball_ball_model("inelastic");
    for (int k = 0; k < 2000; ++k) {
        const SinCos at = sin_cos(random.uniform(0.0, 6.0));
        const Vec3 n(at.cos, at.sin, 0.0);
        Velocities b1{{random.uniform(0.1, 5.0) * at.cos, random.uniform(0.1, 5.0) * at.sin, 0.0},
                      {0.0, 0.0, random.uniform(-90.0, 90.0)}},
            b2{Vec3::Zero(), Vec3::Zero()};
        if (!(dot3(b1.v, n) > 0.0)) continue;
        kernel::ImpactResult planar_result;
        const kernel::ImpactParams params{
            .R = kAirR, .m = kAirM, .mu_s1 = 0.0, .mu_s2 = 0.0, .mu_b = 0.05, .e_b = 0.95};
        model.collide({}, {{0, 0, kAirR}, {b1.v.x(), b1.v.y(), 0.0}, {0.0, 0.0, b1.w.z()}},
                      {{2.0 * kAirR * n.x(), 2.0 * kAirR * n.y(), kAirR}, {0, 0, 0}, {0, 0, 0}}, params,
                      planar_result);
        hit_ball(pair(), n, b1, b2);
        EXPECT_NEAR(b1.v.x(), planar_result.v1[0], 1e-14);
        EXPECT_NEAR(b1.v.y(), planar_result.v1[1], 1e-14);
        EXPECT_NEAR(b2.w.z(), planar_result.w2[2], 1e-11);
    }
}

TEST(FreeBalls, ASlowContactSeparates) {
    const double parting = parting_speed(kAirR, kAirG), up = bounce_end(kAirR, kAirG);
    EXPECT_NEAR(parting, 0.1 * up, 1e-18);
    Velocities top{{0.0, 0.0, -1e-3}, Vec3::Zero()}, low{Vec3::Zero(), Vec3::Zero()};
    const Vec3 n(0.6, 0.0, -0.8);
    part_slowly(pair(), n, {false, true}, kAirG, top, low);
    EXPECT_NEAR(dot3(top.v - low.v, n), -parting, 1e-16);
    EXPECT_EQ(low.v.z(), 0.0);
    EXPECT_GT(low.v.x(), 0.0);
}

// Han's equations with the vertical speed kept (reference values), X into the cushion.
TEST(Noses, HansEquationsWithTheVerticalSpeed) {
    const struct {
        double height, v_X, R_wY;
        Vec3 after;  // v_X, v_z, R w_Y
    } kRows[] = {
        {0.9, 2.0, 0.0, {-1.66871428571429, 0.311288926751928, 0.142857142857143}},
        {0.9, 2.0, 2.0, {-1.61157142857143, 0.87985317652714, 0.714285714285714}},
    };
    for (const auto& row : kRows) {
        // han_2005 uses sin = (h - R)/R; for the nose's cylinder tan = (h - R)/R, so the normal is set here.
        const double s = row.height - 1.0, c = std::sqrt(1.0 - s * s);
        Velocities ball{{row.v_X, 0.0, 0.0}, {0.0, row.R_wY / kAirR, 0.0}};
        hit_nose(balls(), kAirR, kHan2005, {-c, 0.0, -s}, 0.0, ball);
        EXPECT_NEAR(ball.v.x(), row.after[0], 1e-13);
        EXPECT_NEAR(ball.v.z(), row.after[1], 1e-13);
        EXPECT_NEAR(kAirR * ball.w.y(), row.after[2], 1e-13);
    }
    const double s = 0.28, c = std::sqrt(1.0 - s * s);
    Velocities stun{{2.0, 0.0, 0.0}, Vec3::Zero()};
    hit_nose(balls(), kAirR, kHan2005, {-c, 0.0, -s}, 0.0, stun);
    expect_close({stun.v.x(), stun.v.z(), kAirR * stun.w.y()}, {-1.45472, -0.84096, -0.4}, "stun");
    Velocities draw{{2.0, 0.0, 0.0}, {0.0, -2.0 / kAirR, 0.0}};
    hit_nose(balls(), kAirR, kHan2005, {-c, 0.0, -s}, 0.0, draw);
    expect_close({draw.v.x(), draw.v.z(), kAirR * draw.w.y()},
                 {-1.29472, -1.38953142857143, -0.971428571428571}, "draw");
}

TEST(Noses, InTheAir) {
    const double height = 1.28 * kAirR, rho = nose_reach(kAirR, height, 0.0);
    EXPECT_NEAR(rho, 0.029674005897418, 1e-16);
    EXPECT_NEAR(rho - kAirR, 0.00109900589741803, 1e-16);
    const double q = 0.5 * kAirR, D = std::sqrt(rho * rho - q * q);
    Velocities ball{{2.0, 0.3, 0.4}, {5.0, 30.0, -12.0}};
    hit_nose(balls(), kAirR, kHan2005, {-D / rho, 0.0, q / rho}, 0.0, ball);
    expect_close(ball.v, {-0.592740417914752, 0.280498574654794, 1.67557743697222}, "v");
    expect_close(ball.w, {4.17851395710517, 41.4059844837882, -13.4953753931198}, "w");
}

Cue cue_of(double mass, double speed, double elevation, double side, double height) {
    Cue cue;
    cue.mass = mass;
    cue.speed = speed;
    cue.aim_deg = 0.0;
    cue.elevation_deg = elevation;
    cue.side = side;
    cue.height = height;
    cue.end_mass = 0.0;
    cue.restitution = 1.0;
    return cue;
}

TEST(RaisedCue, AJumpCue) {
    const StruckBall struck =
        strike(cue_of(0.25, 4.0, 35.0, 0.0, 0.0), {kAirR, kAirM}, true, Vertical::kKeep);
    EXPECT_NEAR(struck.v.norm(), 4.76080524259873, 1e-13);
    const Velocities after = on_cloth({struck.v, struck.w});
    EXPECT_NEAR(after.v.x(), 3.08061763537315, 1e-13);
    EXPECT_NEAR(after.v.z(), 1.36534285260558, 1e-13);
    const Segment hop = airborne_segment(0.0, {0.0, 0.0, kAirR}, after.v, after.w, motion());
    EXPECT_NEAR(hop.duration, 0.27835736036811, 1e-14);
    EXPECT_NEAR(hop.duration * after.v.x(), 0.85751259328592, 1e-13);
    EXPECT_NEAR(placed_at(hop, 0.5 * hop.duration, kAirG).position.z() - kAirR, 0.0950133081121886, 1e-14);
}

TEST(RaisedCue, TheBallEscapesTheTipUpToAnElevation) {
    for (const auto& [mass, most] : {std::pair{0.567, 35.5886375465806}, std::pair{0.25, 42.7311671880923}}) {
        for (const double off : {-1e-6, 1e-6}) {
            const Cue cue = cue_of(mass, 4.0, most + off, 0.0, 0.0);
            const StruckBall struck = strike(cue, {kAirR, kAirM}, true, Vertical::kKeep);
            const Velocities after = on_cloth({struck.v, struck.w});
            EXPECT_EQ(meets_tip_again(cue, {kAirR, kAirM}, after.v, after.w), off > 0.0) << mass;
        }
    }
}

TEST(RaisedCue, AMasse) {
    const Cue cue = cue_of(0.567, 3.2, 45.0, 0.4, 0.1);
    const StruckBall struck = strike(cue, {kAirR, kAirM}, true, Vertical::kKeep);
    EXPECT_NEAR(struck.v.norm(), 3.7101563075111, 1e-13);
    const Velocities after = on_cloth({struck.v, struck.w});
    expect_close(after.v, {2.19619983477814, 0.660962318167523, 1.31173834215157}, "v");
    expect_close(after.w, {-33.9832332068009, 69.8418617914362, -91.8102076746507}, "w");
}

// Coriolis: the cloth's forces all act at the contact point, so the final rolling velocity is independent of
// e_t, mu_s and the number of bounces.
TEST(RaisedCue, CoriolisTheorem) {
    const StruckBall struck =
        strike(cue_of(0.567, 3.2, 45.0, 0.4, 0.1), {kAirR, kAirM}, true, Vertical::kKeep);
    const Vec2 want(2.13892308218161, 0.749564766943755);
    for (const double e_t : {0.0, 0.3, 0.5, 0.8, 0.99}) {
        for (const double mu_s : {0.01, 0.2, 1.0}) {
            BallParams p = balls();
            p.e_t = e_t;
            p.mu_s = mu_s;
            Velocities ball{struck.v, struck.w};
            for (int bounce = 0; bounce < 40; ++bounce) {
                ball = on_cloth(ball, p);
                const Vec2 slip = cloth_slip(ball.v, ball.w, kAirR);
                EXPECT_LE((planar(ball.v) - 2.0 / 7.0 * slip - want).norm(), 1e-14);
                ball.v.z() = -ball.v.z();
            }
        }
    }
}

// With a level cue, squirt turns the path in the plane; with a raised cue it turns it away from the offset,
// by the same angle.
TEST(RaisedCue, Squirt) {
    Cue cue = cue_of(0.567, 3.0, 1e-9, 0.3, 0.0);
    cue.end_mass = 0.00567;
    const StruckBall flat = strike(cue, {kAirR, kAirM}, true, Vertical::kDrop);
    const StruckBall space = strike(cue, {kAirR, kAirM}, true, Vertical::kKeep);
    EXPECT_LE((flat.v - space.v).norm(), 1e-9);
    cue.elevation_deg = 30.0;
    cue.side = 0.0;
    cue.height = 0.3;
    const StruckBall down = strike(cue, {kAirR, kAirM}, true, Vertical::kKeep);
    const double turn = std::atan2(-down.v.z(), down.v.x()) - 30.0 * 3.14159265358979324 / 180.0;
    const double r = 0.3, S = 2.5 * r * std::sqrt(1.0 - r * r);
    EXPECT_NEAR(turn, std::atan2(S, 1.0 + kAirM / 0.00567 + 2.5 * (1.0 - r * r)), 1e-14);
}

}  // namespace
}  // namespace carom
