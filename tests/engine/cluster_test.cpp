// The cluster maps against the test values of the design notes (clusters, section 9): racks, three-ball hits,
// cradles.
#include "physics/cluster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "carom/engine/tolerances.h"
#include "reference/random_impacts.h"
#include "support/engine_cases.h"

namespace carom {
namespace {

using namespace test;

constexpr double kR = 0.028575;

struct Result {
    std::vector<ClusterBall> balls;
    double energy_ratio;
    long steps;
};

ClusterSettings settings(double mu_b, double mu_s, double e, double epsilon = kClusterEpsilon,
                         double tolerance = 1e-6) {
    return {kR, mu_s, mu_b, e, false, epsilon, tolerance, kernel::contact_phase_function(kernel::best_isa())};
}

double energy_of(const std::vector<ClusterBall>& balls) {
    double sum = 0.0;
    for (const ClusterBall& b : balls) sum += 0.5 * b.v.squaredNorm() + 0.2 * kR * kR * b.w.squaredNorm();
    return sum;
}

// All pairs nearer than 1 mm are contacts; gaps of rounding size count as 0.
std::vector<ClusterContact> contacts_of(const std::vector<ClusterBall>& balls) {
    std::vector<ClusterContact> contacts;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        for (std::size_t j = i + 1; j < balls.size(); ++j) {
            const Vec3 apart = balls[j].r - balls[i].r;
            const double distance = apart.norm(), gap = distance - 2.0 * kR;
            if (gap < 1e-3)
                contacts.push_back(
                    {static_cast<int>(i), static_cast<int>(j), apart / distance, gap < 1e-14 ? 0.0 : gap});
        }
    }
    return contacts;
}

Result run(std::vector<ClusterBall> balls, const ClusterSettings& s, double V) {
    const double before = energy_of(balls);
    ClusterMap map;
    const long steps = map.compliant(balls, contacts_of(balls), s, V, true);
    EXPECT_GT(steps, 0);
    return {balls, energy_of(balls) / before, steps};
}

// The limit of a slow impact: the balls do not move during the contact, so the normals stay fixed. The power
// of 2 changes only the bits of their turning, which is 1e-10.
Result run_slow(std::vector<ClusterBall> balls, const ClusterSettings& s, double V) {
    constexpr double kSlow = 0x1p-30;
    for (ClusterBall& b : balls) b.v *= kSlow, b.w *= kSlow;
    Result result = run(balls, s, V * kSlow);
    for (ClusterBall& b : result.balls) b.v /= kSlow, b.w /= kSlow;
    return result;
}

ClusterBall ball(int id, double x, double y, double vx = 0.0, double vy = 0.0, const Vec3& w = Vec3::Zero()) {
    return {id, Vec3(x, y, kR), Vec3(vx, vy, 0.0), w};
}

// The cue ball behind the apex, then rows 1 to 5 from left to right.
std::vector<ClusterBall> rack(double V) {
    std::vector<ClusterBall> balls{ball(0, 0.0, -2.0 * kR, 0.0, V)};
    int id = 1;
    for (int row = 0; row < 5; ++row)
        for (int k = 0; k <= row; ++k)
            balls.push_back(ball(id++, (2 * k - row) * kR, row * std::sqrt(3.0) * kR));
    return balls;
}

struct RackRow {
    std::size_t index;  // of the right half
    double x[3], y[3];  // frictionless e = 1, e = .95, with friction
};

const RackRow kRack[] = {
    {0, {0, 0, 0}, {-.1792493, -.1547054, -.15753}},
    {1, {0, 0, 0}, {-.1202530, -.0852981, -.08670}},
    {3, {.1011428, .1014642, .08421}, {-.1203169, -.1003372, -.09195}},
    {6, {.0987545, .0971801, .08876}, {-.1026033, -.0822078, -.07754}},
    {5, {0, 0, 0}, {-.0123179, -.0055660, -.01446}},
    {10, {.1297824, .1233941, .10294}, {-.0180125, -.0046261, .00515}},
    {9, {.0079022, .0073312, .01928}, {.0238511, .0269041, .02728}},
    {15, {.2798454, .2509706, .25497}, {.4847065, .4346939, .41585}},
    {14, {.0080044, .0069150, .02488}, {.2566027, .2302609, .24284}},
    {13, {0, 0, 0}, {.2633651, .2361939, .21546}},
};

TEST(Cluster, TouchingRack) {  // H1
    const ClusterSettings columns[] = {settings(0.0, 0.0, 1.0, kClusterEpsilon, 1e-8),
                                       settings(0.0, 0.0, 0.95, kClusterEpsilon, 1e-8),
                                       settings(0.05, 0.2, 0.95), settings(0.05, 0.2, 0.95, 1e-4)};
    const double tolerance[] = {1e-6, 1e-6, 3e-3, 3e-4}, energy_left[] = {1.0, .8022334, .76032, .76032};
    for (int column = 0; column < 4; ++column) {
        const Result result = run_slow(rack(1.0), columns[column], 1.0);
        const int k = std::min(column, 2);
        for (const RackRow& row : kRack) {
            EXPECT_NEAR(result.balls[row.index].v.x(), row.x[k], tolerance[column])
                << "column " << column << " ball " << row.index;
            EXPECT_NEAR(result.balls[row.index].v.y(), row.y[k], tolerance[column])
                << "column " << column << " ball " << row.index;
        }
        EXPECT_NEAR(result.energy_ratio, energy_left[column], column < 2 ? 1e-6 : 2e-3);
        // Left and right.
        Vec3 sum = Vec3::Zero();
        for (const ClusterBall& b : result.balls) sum += b.v;
        EXPECT_LT((sum - Vec3(0, 1, 0)).norm(), column < 2 ? 1e-13 : 1e-2);
        for (int row = 0, first = 1; row < 5; first += ++row) {
            for (int i = 0; i <= row; ++i) {
                const ClusterBall &left = *(result.balls.begin() + first + i),
                                  &right = *(result.balls.begin() + first + row - i);
                EXPECT_NEAR(left.v.x(), -right.v.x(), 1e-12);
                EXPECT_NEAR(left.v.y(), right.v.y(), 1e-12);
            }
        }
        EXPECT_NEAR(result.balls[0].v.x(), 0.0, 1e-15);
    }
}

TEST(Cluster, ScalesWithTheSpeed) {
    const ClusterSettings friction = settings(0.05, 0.2, 0.95);
    const Result one = run_slow(rack(1.0), friction, 1.0), eight = run_slow(rack(8.0), friction, 8.0),
                 fast = run(rack(8.0), friction, 8.0);
    double moved = 0.0;
    for (std::size_t b = 0; b < one.balls.size(); ++b) {
        EXPECT_LT((eight.balls[b].v - 8.0 * one.balls[b].v).norm(), 1e-8)
            << "no material constant in a touching rack whose balls do not move";
        moved = std::max(moved, (fast.balls[b].v - 8.0 * one.balls[b].v).norm() / 8.0);
    }
    EXPECT_NEAR(moved, 4.2e-3, 5e-4) << "what the moving normals change at 8 m/s";
}

// The pair that touches first may be slow; the fastest pair sets the scale of friction and steps.
TEST(Cluster, SlowPairFirst) {
    const Result slow = run(rack(1.0), settings(0.05, 0.2, 0.95), 1e-6),
                 fast = run(rack(1.0), settings(0.05, 0.2, 0.95), 1.0);
    EXPECT_EQ(slow.steps, fast.steps);
    for (std::size_t b = 0; b < fast.balls.size(); ++b) EXPECT_EQ(slow.balls[b].v, fast.balls[b].v);
    EXPECT_LE(fast.steps, 1140) << "of a touching rack";
}

// Large friction is stiff while it sticks; steps then have up to twelve stages and are longer.
TEST(Cluster, LargeFriction) {
    const double mu_b[] = {0.2, 0.4, 0.8};
    const long most[] = {2340, 4020, 6800};
    for (int k = 0; k < 3; ++k) {
        const ClusterSettings s = settings(mu_b[k], 0.2, 0.95);
        ClusterSettings fine_steps = s;
        fine_steps.tolerance = 1e-11;
        std::vector<ClusterBall> balls = rack(1.0);
        balls[0].v.x() = 0.05;
        balls[0].w = Vec3(20.0, -10.0, 15.0);
        const Result result = run(balls, s, 1.0), fine = run(balls, fine_steps, 1.0);
        EXPECT_LE(result.steps, most[k]) << "evaluations at mu_b = " << mu_b[k];
        double worst = 0.0;
        for (std::size_t b = 0; b < fine.balls.size(); ++b)
            worst = std::max({worst, (result.balls[b].v - fine.balls[b].v).norm(),
                              kR * (result.balls[b].w - fine.balls[b].w).norm()});
        EXPECT_LT(worst, 4e-6) << "error of the steps at mu_b = " << mu_b[k];
    }
}

TEST(Cluster, ThreeBalls) {  // H2
    const double e[] = {1.0, 0.95, 0.9, 0.5}, cue[] = {-.2, -.17, -.14, .1},
                 object[] = {.692820, .675500, .658179, .519615};
    for (int k = 0; k < 4; ++k) {
        const std::vector<ClusterBall> balls{ball(0, 0.0, -std::sqrt(3.0) * kR, 0.0, 1.0), ball(1, -kR, 0.0),
                                             ball(2, kR, 0.0)};
        const Result result = run_slow(balls, settings(0.0, 0.0, e[k]), std::cos(M_PI / 6));
        EXPECT_NEAR(result.balls[0].v.y(), cue[k], 1e-6) << e[k];
        EXPECT_EQ(result.balls[0].v.x(), 0.0) << e[k];
        EXPECT_NEAR(result.balls[2].v.norm(), object[k], 1e-6) << e[k];
        EXPECT_EQ(result.balls[1].v.x(), -result.balls[2].v.x()) << e[k];
        EXPECT_EQ(result.balls[1].v.y(), result.balls[2].v.y()) << e[k];
        // Rigid: the same by symmetry, momentum and restitution, to rounding.
        ClusterMap map;
        std::vector<ClusterBall> rigid = balls;
        map.rigid(rigid, contacts_of(rigid), settings(0.0, 0.0, e[k]));
        EXPECT_NEAR(rigid[0].v.y(), 1.0 - 0.6 * (1.0 + e[k]), 1e-12) << e[k];
        EXPECT_NEAR(rigid[2].v.norm(), 0.2 * std::sqrt(3.0) * (1.0 + e[k]), 1e-12) << e[k];
        EXPECT_NEAR(rigid[1].v.x(), -rigid[2].v.x(), 1e-12) << e[k];
    }
    const std::vector<ClusterBall> balls{ball(0, 0.0, -std::sqrt(3.0) * kR, 0.0, 1.0), ball(1, -kR, 0.0),
                                         ball(2, kR, 0.0)};
    const Result with_friction = run_slow(balls, settings(0.05, 0.2, 0.95, 1e-3), std::cos(M_PI / 6));
    EXPECT_NEAR(with_friction.balls[0].v.y(), -.16723, 1e-4);
    EXPECT_NEAR(with_friction.balls[2].v.x(), .32120, 1e-4);
    EXPECT_NEAR(with_friction.balls[2].v.y(), .58362, 1e-4);
    EXPECT_NEAR(kR * with_friction.balls[2].w.z(), -.0341,
                1e-4);  // clockwise, as in the pair kernel; the notes print the magnitude
    EXPECT_NEAR(with_friction.energy_ratio, .91646, 2e-4);
}

std::vector<ClusterBall> line(int n, double first_gap = 0.0) {
    std::vector<ClusterBall> balls;
    for (int k = 0; k < n; ++k) balls.push_back(ball(k, 0.0, 2.0 * k * kR + (k > 1 ? first_gap : 0.0)));
    balls[0].v.y() = 1.0;
    return balls;
}

TEST(Cluster, Cradles) {  // H3
    const std::vector<std::vector<std::vector<double>>> expected{
        {{0, 1}, {.025, .975}, {.05, .95}},
        {{-.070952, .076403, .994549}, {-.044454, .095670, .948784}, {-.016976, .113009, .903967}},
        {{-.071085, -.029626, .109739, .990973},
         {-.044632, -.005973, .124616, .925989},
         {-.017258, .017166, .136630, .863462}},
        {{-.071085, -.030274, -.014464, .127045, .988777},
         {-.044632, -.007140, .008093, .138243, .905436},
         {-.017258, .013109, .031653, .145891, .826604}},
        {{-.071085, -.030274, -.015833, -.006795, .136517, .987470},
         {-.044632, -.007140, .004484, .016449, .144492, .886347},
         {-.017258, .012996, .019194, .044556, .148220, .792291}}};
    const double e[] = {1.0, 0.95, 0.9};
    for (int n = 2; n <= 6; ++n) {
        for (int k = 0; k < 3; ++k) {
            const Result result = run(line(n), settings(0.0, 0.0, e[k], kClusterEpsilon, 1e-8), 1.0);
            double sum = 0.0;
            for (int b = 0; b < n; ++b) {
                EXPECT_NEAR(result.balls[b].v.y(), expected[n - 2][k][b], 1e-6)
                    << "n = " << n << " e = " << e[k] << " ball " << b;
                sum += result.balls[b].v.y();
            }
            EXPECT_NEAR(sum, 1.0, 1e-13);
        }
    }
}

TEST(Cluster, GapInALine) {
    const double d_max = 0.8286 * contact_length(1.0);
    const double gaps[] = {0.1, 0.4, 1.0, 1.4};
    const double expected[][3] = {{-.019131, .068308, .950823},
                                  {.015161, .033821, .951018},
                                  {.024870, .024499, .950631},
                                  {.025000, .024375, .950625}};
    for (int k = 0; k < 4; ++k) {
        const Result result = run(line(3, gaps[k] * d_max), settings(0.0, 0.0, 0.95), 1.0);
        for (int b = 0; b < 3; ++b)
            EXPECT_NEAR(result.balls[b].v.y(), expected[k][b], 2e-5) << "gap " << gaps[k] << " ball " << b;
    }
}

TEST(Cluster, SqueezedBallStays) {  // H6
    const std::vector<ClusterBall> balls{ball(0, -2.0 * kR, 0.0, 1.0, 0.0), ball(1, 0.0, 0.0),
                                         ball(2, 2.0 * kR, 0.0, -1.0, 0.0)};
    const Result result = run(balls, settings(0.0, 0.0, 0.95), 1.0);
    EXPECT_EQ(result.balls[1].v, Vec3::Zero());
    EXPECT_NEAR(result.balls[0].v.x(), -0.95, 1e-6);
    EXPECT_EQ(result.balls[0].v.x(), -result.balls[2].v.x());
}

// Two balls through the map match the pair kernel, up to the bias of the regularisation.
TEST(Cluster, TwoBallsMatchThePairKernel) {
    reference::Generator rng(7);
    std::vector<double> differences;
    for (int k = 0; k < 60; ++k) {
        const reference::Impact impact = reference::random_impact(rng);
        kernel::ImpactResult want;
        kernel::march_function(kernel::best_isa())(impact.ball1, impact.ball2, impact.params, 100000, want);
        const auto from = [](const kernel::Ball& b, int id) {
            return ClusterBall{id, Vec3(b.r[0], b.r[1], b.r[2]), Vec3(b.v[0], b.v[1], 0.0),
                               Vec3(b.w[0], b.w[1], b.w[2])};
        };
        std::vector<ClusterBall> balls{from(impact.ball1, 0), from(impact.ball2, 1)};
        if (impact.params.mu_s1 != impact.params.mu_s2) {
            kernel::ImpactParams same = impact.params;
            same.mu_s2 = same.mu_s1;
            kernel::march_function(kernel::best_isa())(impact.ball1, impact.ball2, same, 100000, want);
        }
        const Vec3 n = (balls[1].r - balls[0].r).normalized();
        const double V = (balls[0].v - balls[1].v).dot(n);
        ClusterMap map;
        const std::vector<ClusterContact> contacts = contacts_of(balls);
        ClusterSettings with = settings(impact.params.mu_b, impact.params.mu_s1, impact.params.e_b, 1e-3);
        with.turns = false;  // an impact of two balls at an instant
        map.compliant(balls, contacts, with, V, true);
        const double difference = std::max((balls[0].v - Vec3(want.v1[0], want.v1[1], 0.0)).norm(),
                                           (balls[1].v - Vec3(want.v2[0], want.v2[1], 0.0)).norm()) /
                                  V;
        differences.push_back(difference);
    }
    std::sort(differences.begin(), differences.end());
    EXPECT_LT(differences[30], 1e-4) << "median";
    EXPECT_LT(differences.back(), 1e-2) << "worst";
}

TEST(Cluster, NeverGainsEnergyAndLeavesNoContactClosing) {
    reference::Generator rng(11);
    for (int k = 0; k < 60; ++k) {
        std::vector<ClusterBall> balls = rack(1.0);
        const double gap = rng.uniform(0.0, 3e-4);
        for (ClusterBall& b : balls) b.r *= 1.0 + gap / (2.0 * kR);
        for (int c = 0; c < 3; ++c) balls[0].w[c] = rng.uniform(-60.0, 60.0);
        balls[0].v.x() = rng.uniform(-0.2, 0.2);
        const double mu = k % 2 ? 0.05 : 0.0, e = k % 3 == 0 ? 1.0 : (k % 3 == 1 ? 0.95 : 0.85);
        const Result result = run(balls, settings(mu, 0.2, e), 1.0);
        EXPECT_LE(result.energy_ratio, 1.0 + 1e-13) << k;
    }
}

TEST(Cluster, FifthRoot) {
    reference::Generator rng(5);
    for (int k = 0; k < 20000; ++k) {
        const double x = std::pow(10.0, rng.uniform(-300.0, 300.0));
        EXPECT_NEAR(fifth_root(x) / static_cast<double>(std::pow(static_cast<long double>(x), 0.2L)), 1.0,
                    1e-15)
            << x;
    }
    EXPECT_EQ(fifth_root(0.0), 0.0);
    EXPECT_EQ(fifth_root(32.0), 2.0);
    EXPECT_EQ(fifth_root(1.0), 1.0);
    const double least = std::numeric_limits<double>::denorm_min();
    EXPECT_NEAR(fifth_root(least) / static_cast<double>(std::pow(static_cast<long double>(least), 0.2L)), 1.0,
                1e-15);
}

// The fourth power of the speed underflows long before the length does.
TEST(Cluster, AContactHasALengthAtEverySpeed) {
    for (int exponent = -323; exponent <= 6; ++exponent) {
        const double V = std::pow(10.0, exponent);
        const long double x = static_cast<long double>(V) * V / kContactStiffness;
        EXPECT_NEAR(contact_length(V) / static_cast<double>(std::pow(x, 0.4L)), 1.0, 2e-15) << V;
    }
    EXPECT_EQ(contact_length(0.0), 0.0);
}

// Alciatore, TP B.29: 2270 N at a compression of 0.1995 mm, and 284 us at 2.06 m/s. Hertz (Landau and
// Lifshitz, section 9): a contact lasts 2.943 times its largest compression over the speed.
TEST(Cluster, AContactLastsAsLongAsPublished) {
    const double m = 0.170097, speed = 2.06;
    EXPECT_NEAR(kContactStiffness * m * std::pow(0.1995e-3, 1.5), 2270.0, 1.0);
    const double compression = std::pow(0.625 * speed * speed / kContactStiffness, 0.4);
    EXPECT_NEAR(compression, 0.1995e-3, 1e-6);
    EXPECT_NEAR(2.943 * compression / speed, 284e-6, 2e-6);
}

// Every shipped model reads both e_b and mu_b, or neither, so this one is made up.
TEST(Cluster, AModelMayReadRestitutionButNoFriction) {
    Scene scene = empty_scene();
    scene.balls.e_b = 0.9;
    scene.balls.mu_b = 0.0;
    scene.physics.ball_ball = ball_ball_model("inelastic");
    add_ball(scene, "cue", 0.0, 0.0, 2.0, 0.0);
    add_ball(scene, "1", 0.5, kR);
    add_ball(scene, "2", 0.5, -kR);
    Plan plan = plan_of(scene);
    const Record with_both = simulate(plan);
    ASSERT_EQ(count(with_both, EventType::kBallCluster), 1);
    BallBallModelInfo model = *plan.ball_ball;
    model.reads_friction = false;
    plan.ball_ball = &model;
    EXPECT_EQ(simulate(plan).hash(), with_both.hash());
    model.reads_restitution = false;
    EXPECT_NE(simulate(plan).hash(), with_both.hash());
}

// Warns only if a third ball can take part, and only for the model with a least restitution.
TEST(Cluster, APlanSaysWhichRestitutionCounts) {
    const auto warnings = [](int balls, double e_b, ClusterModel model) {
        Scene scene = empty_scene();
        scene.balls.e_b = e_b;
        scene.physics.clusters = model;
        for (int k = 0; k < balls; ++k) add_ball(scene, std::to_string(k), 0.1 * k, 0.0, k == 0 ? 1.0 : 0.0);
        return plan_of(scene).warnings;
    };
    const auto found = warnings(3, 0.001, ClusterModel::kCompliant);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0], "balls.e_b is 0.001, but impacts of three or more balls use 0.0016");
    EXPECT_TRUE(warnings(2, 0.001, ClusterModel::kCompliant).empty());
    EXPECT_TRUE(warnings(3, 0.002, ClusterModel::kCompliant).empty());
    EXPECT_TRUE(warnings(3, 0.001, ClusterModel::kRigid).empty());
}

// Three balls in line: a plastic impact leaves them one velocity, and a small restitution separates the outer
// two by about as much.
TEST(Cluster, PlasticBallsEndWithOneVelocity) {
    for (const double e : {0.0, 0.001, 0.003, 0.01, 0.02, 0.049}) {
        std::vector<ClusterBall> line;
        for (int k = 0; k < 3; ++k)
            line.push_back({k, {2.0 * kR * k, 0.0, kR}, {k == 0 ? 1.0 : 0.0, 0.0, 0.0}, Vec3::Zero()});
        const Result out = run(line, settings(0.0, 0.0, e), 1.0);
        for (const ClusterBall& ball : out.balls) EXPECT_NEAR(ball.v.x(), 1.0 / 3.0, 0.5 * e + 1e-3) << e;
        EXPECT_GE(out.balls[2].v.x() - out.balls[0].v.x(), 0.5 * e) << e;
    }
}

TEST(Cluster, BallsThatHardlyMoveComeToRest) {
    // Scene files refuse speeds below 1e-60 m/s, but balls may reach them. Below 1e-100 m/s they count as
    // resting.
    for (const double speed : {1e-60, 5e-77, 1e-80, 1e-100, 1e-150}) {
        Scene scene = parse_scene(
            "[[ball]]\n[[ball]]\nid = \"b1\"\nposition = [0.15715, 0.5]\n"
            "[[ball]]\nid = \"b2\"\nposition = [0.2143, 0.5]\n",
            "s.toml");
        scene.ball[1].velocity = Vec3(speed, speed, 0.0);
        const Record record = run_verified(scene);
        EXPECT_EQ(record.stopped, StopReason::kAtRest) << speed;
        EXPECT_EQ(count(record, EventType::kBallBall), speed < 1e-100 ? 0 : 1) << speed;
    }
}

}  // namespace
}  // namespace carom
