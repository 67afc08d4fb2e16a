// Clusters in the air, at cushions, jaws and pockets take time, tell who touched whom, and agree with another
// integration (kernel/reference/contact_phase.h) that hits the same surfaces. CAROM_RESIDUALS=1 prints the
// errors.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "reference/contact_phase.h"
#include "reference/random_impacts.h"
#include "support/engine_cases.h"
#include "support/hard_scenes.h"

namespace carom {
namespace {

using namespace test;

#ifdef CAROM_SANITIZED
constexpr int kBreaksInTheAir = 2;
#else
constexpr int kBreaksInTheAir = 80;
#endif

constexpr double kRadius = 0.028575;  // [m] of pool balls
constexpr const char* kTable = "[table]\npreset = \"nine_foot\"\n[balls]\npreset = \"pool\"\n";

/// A break with a raised cue, from any place behind the head string.
Scene raised_break(reference::Generator& rng, double least, double most) {
    return parse_scene(
        fmt::format("{}[rack]\ngame = \"{}\"\n[cue]\nball = \"cue\"\nspeed = {}\nelevation_deg = {}\n"
                    "aim_hit = [\"1\", {}]\n[[ball]]\nid = \"cue\"\nposition = [{}, {}]\n",
                    kTable, rng.uniform(0.0, 1.0) < 0.5 ? "nine_ball" : "eight_ball", rng.uniform(5.0, 8.0),
                    rng.uniform(least, most), rng.uniform(-0.5, 0.5), rng.uniform(0.3, 0.97),
                    rng.uniform(0.2, 0.63)),
        "s.toml");
}

/// Its racked balls are up to 3 % smaller, and lighter or heavier.
Scene unlike_break(reference::Generator& rng) {
    Scene scene = raised_break(rng, 2.0, 10.0);
    for (BallStart& ball : scene.ball) {
        if (ball.id == "cue") continue;
        const double R = rng.uniform(0.97, 1.0) * scene.balls.R;
        ball.own = BallSize{R, rng.uniform(0.8, 1.2) * scene.balls.m};
        ball.position.z() = R;
    }
    return scene;
}

/// Two balls frozen to each other and to the left rail, hit by a third from any side.
Scene frozen_to_rail(reference::Generator& rng) {
    const double R = kRadius, side = rng.uniform(-75.0, 75.0) / 180.0 * M_PI, away = 0.2;
    const double hit = rng.uniform(-0.9, 0.9) * 2.0 * R, x = R + std::cos(side) * away - std::sin(side) * hit,
                 y = 1.0 + std::sin(side) * away + std::cos(side) * hit, v = rng.uniform(0.5, 8.0);
    return parse_scene(
        fmt::format("{}[[ball]]\nid = \"cue\"\nposition = [{}, {}]\nvelocity = [{}, {}]\n"
                    "[[ball]]\nid = \"a\"\nposition = [{}, 1.0]\n[[ball]]\nid = \"b\"\nposition = [{}, {}]\n",
                    kTable, x, y, -v * std::cos(side), -v * std::sin(side), R, R,
                    rng.uniform(0.0, 1.0) < 0.5 ? 1.0 + 2.0 * R : 1.0 - 2.0 * R),
        "s.toml");
}

const Event* first_cluster(const Record& record) {
    for (const Event& e : record.events)
        if (e.type == EventType::kBallCluster) return &e;
    return nullptr;
}

bool lasts(const Record& record, const Event& cluster) {
    return record.state_at(cluster.a, cluster.time).state == MotionState::kColliding;
}

/// Largest error of a velocity or R w after the first cluster [V], against the other integration.
double error_of(const Scene& scene) {
    Plan plan = plan_of(scene);
    SimulateOptions options;
    const Record whole = simulate(plan);
    const Event* cluster = first_cluster(whole);
    if (cluster == nullptr) return 0.0;
    options.until = cluster->time + 1e-9;
    const Record record = simulate(plan, options);
    plan.contact_phase = reference::contact_phase;
    const Record other = simulate(plan, options);
    double most = 0.0, fastest = 0.0;
    for (const int ball : record.clusters[0].balls) {
        const auto i = static_cast<std::size_t>(ball);
        const Segment &one = record.tracks[i].segments.back(), &two = other.tracks[i].segments.back();
        fastest =
            std::max(fastest, length3(record.state_at(ball, std::nextafter(cluster->time, 0.0)).velocity));
        most = std::max({most, length3(one.v - two.v), kRadius * length3(one.w - two.w)});
    }
    return most / fastest;
}

void expect_small(const char* what, std::vector<double>& errors) {
    for (const double share : {0.5, 0.9, 1.0})
        report(fmt::format("{}: velocity [V], share {}", what, share).c_str(), share_of(errors, share));
    EXPECT_LT(share_of(errors, 0.9), 1e-3) << what;
}

TEST(ClusterSurfaces, RaisedBreaksTakeTime) {
    reference::Generator rng(71);
    int lasting = 0;
    for (int k = 0; k < 20; ++k) {
        const Record record = run_verified(raised_break(rng, 7.9, 8.1));
        const Event* cluster = first_cluster(record);
        ASSERT_NE(cluster, nullptr);
        lasting += lasts(record, *cluster);
    }
    EXPECT_EQ(lasting, 20);
}

TEST(ClusterSurfaces, FrozenBallsTakeTime) {
    reference::Generator rng(72);
    int lasting = 0, clusters = 0, cushions = 0;
    while (clusters < 20) {
        const Record record = run_verified(frozen_to_rail(rng));
        const Event* cluster = first_cluster(record);
        if (cluster == nullptr) continue;
        ++clusters;
        lasting += lasts(record, *cluster);
        for (const Hit& hit : record.hits(*cluster)) cushions += hit.partner == Partner::kCushion;
    }
    EXPECT_GE(lasting, 18);
    EXPECT_GE(cushions, 10);
}

TEST(ClusterSurfaces, AgreeWithAnotherIntegration) {
    reference::Generator breaks(73), rails(75);
    std::vector<double> raised, unlike, frozen;
    for (int k = 0; k < kBreaksInTheAir; ++k) raised.push_back(error_of(raised_break(breaks, 2.0, 10.0)));
    for (int k = 0; k < kBreaksInTheAir; ++k) unlike.push_back(error_of(unlike_break(breaks)));
    for (int k = 0; k < 40; ++k) frozen.push_back(error_of(frozen_to_rail(rails)));
    expect_small("raised", raised);
    expect_small("unlike balls, raised", unlike);
    expect_small("at a rail", frozen);
}

// A ball that spins at 470 rad/s creeps towards another one. An instant once slid for a fifth of a second.
TEST(ClusterSurfaces, AnInstantLeavesTheSpinToTheCloth) {
    const Record record = run_verified(
        parse_scene("[table]\ncushion = []\n[physics]\nball_ball = \"elastic\"\n"
                    "[[ball]]\nid = \"2\"\nposition = [0.4709795032638199, 0.2303549601408146]\n"
                    "[[ball]]\nid = \"3\"\nposition = [0.4289711684341682, 0.19160676915284877]\n"
                    "[[ball]]\nid = \"4\"\nposition = [0.48356838120484313, 0.17460872571923222]\n"
                    "velocity = [-8.10595023509811e-07, 0]\n"
                    "spin = [286.57256903600495, -200.1925118204335, 318.48866540804596]\n"
                    "[[ball]]\nid = \"15\"\nposition = [0.4995545037638199, 0.27984831283312067]\n",
                    "s.toml"));
    ASSERT_FALSE(record.clusters.empty());
    for (int ball = 0; ball < 4; ++ball)
        EXPECT_LT(length3(record.state_at(ball, 1e-6).velocity), 1e-4) << ball;
}

// The memory of one run serves the next one, of another model.
TEST(ClusterSurfaces, ARigidClusterHasNoHitsOfAnEarlierRun) {
    reference::Generator rng(74);
    RunBuffers buffers;
    Scene scene = frozen_to_rail(rng);
    Record record = simulate(plan_of(scene), buffers);
    ASSERT_FALSE(record.clusters.empty());
    scene.physics.clusters = ClusterModel::kRigid;
    const Plan rigid = plan_of(scene);
    record = simulate(rigid, buffers);
    EXPECT_EQ(record.clusters, simulate(rigid).clusters);
}

}  // namespace
}  // namespace carom
