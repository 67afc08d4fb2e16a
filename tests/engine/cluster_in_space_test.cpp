// Clusters with an airborne ball, or with a model in which balls leave the cloth: the map in space against an
// independent integration (support/moving_contacts.h), and whole scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "carom/engine/tolerances.h"
#include "physics/cluster.h"
#include "reference/random_impacts.h"
#include "support/engine_cases.h"
#include "support/hard_scenes.h"
#include "support/moving_contacts.h"

namespace carom {
namespace {

using namespace test;
using reference::Generator;

constexpr double kPoolR = 0.028575;  // [m] of pool balls

ClusterSettings settings_of(const MovingLaw& law) {
    return {.R = law.R,
            .mu_s = 0.0,
            .mu_b = law.mu_b,
            .e_b = law.e_b,
            .epsilon = kClusterEpsilon,
            .integrate = kernel::contact_phase_function(kernel::best_isa()),
            .mu_b_more = law.mu_b_more,
            .mu_b_fall = law.mu_b_fall};
}

std::vector<ClusterContact> contacts_of(const std::vector<ClusterBall>& balls, double reach) {
    std::vector<ClusterContact> contacts;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        for (std::size_t j = i + 1; j < balls.size(); ++j) {
            const Vec3 apart = balls[j].r - balls[i].r;
            const double distance = length3(apart), gap = distance - 2.0 * kPoolR;
            if (gap < reach)
                contacts.push_back({static_cast<int>(i), static_cast<int>(j), apart / distance,
                                    gap < kTouchUlp ? 0.0 : gap});
        }
    }
    return contacts;
}

double energy(const std::vector<ClusterBall>& balls) {
    double sum = 0.0;
    for (const ClusterBall& b : balls)
        sum += 0.5 * b.v.squaredNorm() + 0.2 * kPoolR * kPoolR * b.w.squaredNorm();
    return sum;
}

Vec3 momentum(const std::vector<ClusterBall>& balls) {
    Vec3 sum = Vec3::Zero();
    for (const ClusterBall& b : balls) sum += b.v;
    return sum;
}

/// Largest velocity difference [V] between map and integration, at the contact-free instant where they agree
/// best: whether a slow contact some 2 L/V after the others counts is ambiguous.
double error_of(std::vector<ClusterBall> balls, const MovingLaw& law, double V) {
    std::vector<MovingBall> start;
    for (const ClusterBall& b : balls)
        start.push_back(
            {{b.r.x(), b.r.y(), b.r.z()}, {b.v.x(), b.v.y(), b.v.z()}, {b.w.x(), b.w.y(), b.w.z()}});
    const double before = energy(balls);
    const Vec3 carried = momentum(balls);
    ClusterMap map;
    const double reach = 60.0 * contact_length(V);
    EXPECT_GT(map.compliant(balls, contacts_of(balls, reach), settings_of(law), V, false), 0);
    EXPECT_LE(energy(balls), before * (1.0 + 1e-12));
    EXPECT_LE(length3(momentum(balls) - carried), 1e-13 * V * static_cast<double>(balls.size()));
    MovingLaw free = law;
    free.cloth = false;
    free.look_ahead = 4.0;
    MovingContacts truth(start, free, V);
    EXPECT_GT(truth.run(), 0.0);
    double least = 1.0;
    for (const std::vector<MovingBall>& end : truth.ends()) {
        double worst = 0.0;
        for (std::size_t b = 0; b < end.size(); ++b)
            worst = std::max(worst, length3(balls[b].v - Vec3(end[b].v[0], end[b].v[1], end[b].v[2])) / V);
        least = std::min(least, worst);
    }
    return least;
}

MovingLaw pool_law() {
    const BallParams p = make_ball_params("pool");
    MovingLaw law;
    law.R = p.R;
    law.stiffness = kContactStiffness;
    law.mu_b = p.mu_b;
    law.e_b = p.e_b;
    law.mu_b_more = p.mu_b_more;
    law.mu_b_fall = p.mu_b_fall;
    return law;
}

ClusterBall ball(int id, const Vec3& r, const Vec3& v = Vec3::Zero(), const Vec3& w = Vec3::Zero()) {
    return {id, r, v, w};
}

// A fourth ball lands with spin beside the middle of the hollow of three touching balls.
TEST(ClusterInSpace, ABallOnThree) {
    Generator rng(81);
    double worst = 0.0;
    for (int n = 0; n < 12; ++n) {
        const double gap = n % 3 * 1e-4, side = 2.0 * kPoolR + gap, root3 = std::sqrt(3.0);
        std::vector<ClusterBall> balls{ball(0, {0.0, 0.0, kPoolR}), ball(1, {side, 0.0, kPoolR}),
                                       ball(2, {0.5 * side, 0.5 * root3 * side, kPoolR})};
        const double V = rng.uniform(0.3, 4.0), aside = n < 3 ? 0.0 : 0.005;
        Vec3 top(0.5 * side + rng.uniform(-aside, aside), side / (2.0 * root3) + rng.uniform(-aside, aside),
                 0.2);
        // Lower it until it touches the first ball.
        double z = 0.0;
        for (const ClusterBall& b : balls) {
            const Vec2 level = planar(top - b.r);
            z = std::max(z, kPoolR + std::sqrt(4.0 * kPoolR * kPoolR - level.squaredNorm()));
        }
        top.z() = z;
        // Separate statements: compilers differ in the order of arguments.
        const Vec3 w{rng.uniform(-40.0, 40.0), rng.uniform(-40.0, 40.0), rng.uniform(-40.0, 40.0)};
        const Vec3 v{rng.uniform(-0.3, 0.3) * V, rng.uniform(-0.3, 0.3) * V, -V};
        balls.push_back(ball(3, top, v, w));
        worst = std::max(worst, error_of(balls, pool_law(), V));
    }
    report("a ball on three, error in V", worst);
    EXPECT_LT(worst, 3e-3);
    EXPECT_GT(worst, 0.0);
}

TEST(ClusterInSpace, BreaksThroughTheAir) {
    Generator rng(82);
    for (const double gap : {0.0, 1e-4, 3e-4}) {
        double worst = 0.0;
        for (int n = 0; n < 6; ++n) {
            std::vector<ClusterBall> balls;
            const double side = 2.0 * kPoolR + gap;
            for (int row = 0; row < 5; ++row)
                for (int k = 0; k <= row; ++k)
                    balls.push_back(
                        ball(static_cast<int>(balls.size()),
                             {(k - 0.5 * row) * side, 0.5 * std::sqrt(3.0) * row * side, kPoolR}));
            const double height = rng.uniform(0.001, 0.02), x = rng.uniform(-0.002, 0.002);
            const double y = -std::sqrt(4.0 * kPoolR * kPoolR - height * height - x * x);
            const double V = rng.uniform(6.0, 9.0);
            // Separate statements: compilers differ in the order of arguments.
            const Vec3 w{-rng.uniform(0.0, 2.0) * V / kPoolR, 0.0, rng.uniform(-30.0, 30.0)};
            const Vec3 v{0.0, V, rng.uniform(-0.4, 0.4)};
            balls.push_back(ball(15, {x, y, kPoolR + height}, v, w));
            worst = std::max(worst, error_of(balls, pool_law(), V));
        }
        report(("break through the air, gap " + std::to_string(gap) + ", error in V").c_str(), worst);
        EXPECT_LT(worst, 3e-3) << gap;
    }
}

// With all balls level and nothing pressing on the cloth, the map in space equals the planar map, although
// one turns the normals by positions and the other by its own law.
TEST(ClusterInSpace, LevelBallsWithoutClothMatchThePlanarMap) {
    Generator rng(83);
    double worst = 0.0;
    for (int n = 0; n < 20; ++n) {
        MovingLaw law = pool_law();
        law.mu_b = law.mu_b_more = 0.0;
        const double angle = rng.uniform(0.2, 1.2), gap = rng.uniform(0.0, 1e-4), V = rng.uniform(1.0, 6.0);
        const double far = 2.0 * kPoolR + gap;
        std::vector<ClusterBall> space{ball(0, {0.0, -2.0 * kPoolR, kPoolR}, {0.1 * V, V, 0.0}),
                                       ball(1, {0.0, 0.0, kPoolR}),
                                       ball(2, {far * std::sin(angle), far * std::cos(angle), kPoolR})};
        std::vector<ClusterBall> plane = space;
        const std::vector<ClusterContact> contacts = contacts_of(space, 1e-3);
        ClusterMap map;
        EXPECT_GT(map.compliant(space, contacts, settings_of(law), V, false), 0);
        EXPECT_GT(map.compliant(plane, contacts, settings_of(law), V, true), 0);
        for (std::size_t b = 0; b < 3; ++b) {
            EXPECT_EQ(space[b].v.z(), 0.0);
            worst = std::max(worst, length3(space[b].v - plane[b].v) / V);
        }
    }
    report("level, in space and in the plane, difference in V", worst);
    EXPECT_LT(worst, 1e-5);
}

// Two balls moving together close at the rounding of their speeds without end; the map must not wait for
// them.
TEST(ClusterInSpace, EndsWhenNoContactIsLeft) {
    const double V = 2.0, D = 2.0 * kPoolR;
    std::vector<ClusterBall> balls{ball(0, {0.0, -D, kPoolR}, {0.0, V, 0.0}), ball(1, {0.0, 0.0, kPoolR}),
                                   ball(2, {D, 0.0, kPoolR}, {0.2 * V * (1.0 + 1e-16), 0.0, 0.0}),
                                   ball(3, {2.0 * D, 0.0, kPoolR}, {0.2 * V * (1.0 - 1e-16), 0.0, 0.0})};
    ASSERT_GT(balls[2].v.x(), balls[3].v.x());
    MovingLaw law = pool_law();
    law.mu_b = law.mu_b_more = 0.0;
    ClusterMap map;
    const std::vector<ClusterContact> contacts{{0, 1, {0.0, 1.0, 0.0}, 0.0}, {2, 3, {1.0, 0.0, 0.0}, 0.0}};
    const long steps = map.compliant(balls, contacts, settings_of(law), V, false);
    EXPECT_GT(steps, 0);
    EXPECT_LT(steps, 300);
    EXPECT_NEAR(balls[3].v.x(), 0.2 * V, 1e-15 * V);
}

// Rigid model: the landing ball goes up again, and no ball passes through the cloth.
TEST(ClusterInSpace, RigidKeepsBallsOnTheCloth) {
    const double root3 = std::sqrt(3.0), height = std::sqrt(8.0 / 3.0) * kPoolR;
    for (const double e : {0.0, 0.5, 1.0}) {
        std::vector<ClusterBall> balls{ball(0, {-kPoolR, -kPoolR / root3, kPoolR}),
                                       ball(1, {kPoolR, -kPoolR / root3, kPoolR}),
                                       ball(2, {0.0, 2.0 * kPoolR / root3, kPoolR}),
                                       ball(3, {0.0, 0.0, kPoolR + height}, {0.0, 0.0, -2.0})};
        const double before = energy(balls);
        ClusterMap map;
        EXPECT_GT(map.rigid(balls, contacts_of(balls, 1e-6), {.R = kPoolR, .e_b = e}), 0);
        EXPECT_LE(energy(balls), before * (1.0 + 1e-12));
        EXPECT_NEAR(length(planar(momentum(balls))), 0.0, 1e-12);
        for (int b = 0; b < 3; ++b) EXPECT_GE(balls[b].v.z(), -1e-12);
        const Vec3 n = (balls[0].r - balls[3].r) / (2.0 * kPoolR);
        const double closing = dot3(balls[3].v - balls[0].v, n);
        EXPECT_NEAR(closing, e * 2.0 * n.z(), 1e-9) << "they part at e times the approach";
    }
}

Scene on_three(const std::string& more) {
    return parse_scene("[table]\ncushion = []\n[physics]\n" + more +
                           "[balls]\npreset = \"pool\"\n[[ball]]\nid = \"a\"\nposition = [-0.0286, 0]\n"
                           "[[ball]]\nid = \"b\"\nposition = [0.0286, 0]\n"
                           "[[ball]]\nid = \"c\"\nposition = [0, 0.049536]\n"
                           "[[ball]]\nid = \"top\"\nposition = [0, 0.0165]\nheight = 0.2\n",
                       "s.toml");
}

int count(const Record& record, EventType type) {
    return static_cast<int>(std::count_if(record.events.begin(), record.events.end(),
                                          [type](const Event& e) { return e.type == type; }));
}

TEST(ClusterInSpace, ADroppedBallPushesAllThreeApart) {
    for (const char* const more : {"", "ball_ball = \"two_step\"\n"}) {
        const Record record = run_verified(on_three(more));
        EXPECT_EQ(record.stopped, StopReason::kAtRest) << more;
        EXPECT_GE(count(record, EventType::kBallCluster), 1) << more;
        double least = 1.0, most = 0.0;
        for (int b = 0; b < 3; ++b) {
            const Vec3 from = record.state_at(b, 0.0).position,
                       to = record.state_at(b, record.duration).position;
            const double way = length(planar(to) - planar(from));
            least = std::min(least, way);
            most = std::max(most, way);
        }
        EXPECT_GT(least, 0.02) << more;
        EXPECT_LT(most, 1.6 * least) << more << "the first of three impacts would take it all";
    }
    // Pair by pair, the three are met one after another.
    EXPECT_EQ(count(run_verified(on_three("clusters = \"sequential\"\n")), EventType::kBallCluster), 0);
}

// A third ball flying by makes it a cluster in space, although the two that collide are on the cloth.
TEST(ClusterInSpace, TheThirdBallMayFly) {
    Scene scene = empty_scene();
    add_ball(scene, "one", Vec3(0.0, 0.0, kPoolR), Vec3(0.0, 2.0, 0.0));
    add_ball(scene, "two", Vec3(0.0, 2.2 * kPoolR, kPoolR));
    // The third ball, above and between the others, lands on "two" when "one" meets it.
    scene.ball.push_back(scene.ball.back());
    BallStart& high = scene.ball.back();
    high.id = "high";
    high.height = 1.9 * kPoolR;
    high.position = {0.0, 2.9 * kPoolR, kPoolR + high.height};
    high.velocity = {0.0, 0.0, -0.02};
    const Record record = run_verified(scene);
    EXPECT_EQ(count(record, EventType::kBallCluster) > 0, true);
    EXPECT_EQ(record.clusters.front().balls.size(), 3u);
}

// A ball passes a resting one at 8 m/s and approaches it at 0.2 m/s while a third flies within reach: the
// contact opens in the map as the two pass. This cluster was once repeated 10 000 times.
TEST(ClusterInSpace, AGlancingContactOpensWhereTheBallsStay) {
    const Scene scene = parse_scene(
        "[[ball]]\nposition = [0.240011, 1.994503]\nheight = 0.0001\n"
        "[[ball]]\nid = \"fast\"\nposition = [0.2702, 2.0431]\nvelocity = [8.2, -5.7, -1.0]\n"
        "[[ball]]\nid = \"third\"\nposition = [0.292003, 1.970753]\n",
        "s.toml");
    const Record record = run_verified(scene);
    EXPECT_EQ(record.stopped, StopReason::kAtRest);
    EXPECT_LT(record.events.size(), 100u);
}

TEST(ClusterInSpace, TwoStepBreaksComeToRest) {
    for (int seed = 1; seed <= 8; ++seed) {
        const Scene scene =
            parse_scene("[physics]\nball_ball = \"two_step\"\n[rack]\ngame = \"eight_ball\"\nseed = " +
                            std::to_string(seed) +
                            "\n[cue]\nball = \"cue\"\nspeed = 8\naim_deg = 90\n"
                            "[[ball]]\nid = \"cue\"\nposition = [0.62, 0.5]\n",
                        "s.toml");
        const Record record = run_verified(scene);
        EXPECT_EQ(record.stopped, StopReason::kAtRest);
        ASSERT_GE(count(record, EventType::kBallCluster), 1);
        EXPECT_EQ(record.clusters.front().balls.size(), 16u);
    }
}

}  // namespace
}  // namespace carom
