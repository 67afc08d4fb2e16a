// The interface of the ball-ball models, and balls of different radius and mass.
#include "carom/engine/ball_ball.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/temporary_folder.h"
#include "carom/kernel/closed_forms.h"
#include "physics/cluster.h"
#include "reference/random_impacts.h"
#include "support/engine_cases.h"
#include "support/hard_scenes.h"
#include "support/scene_errors.h"

namespace carom {
namespace {

using namespace test;

const auto kModels = all_of(&kMathavan);

BallBallSettings settings() {
    BallBallSettings s;
    s.by_tolerance = kernel::tolerance_function(kernel::Isa::kScalar);
    s.tolerance = 1e-9;
    return s;
}

bool same(const kernel::ImpactResult& a, const kernel::ImpactResult& b) {
    for (int k = 0; k < 3; ++k)
        if (a.v1[k] != b.v1[k] || a.v2[k] != b.v2[k] || a.w1[k] != b.w1[k] || a.w2[k] != b.w2[k])
            return false;
    return true;
}

// A model's result depends on exactly the parameters that it declares.
TEST(BallBall, ResultsDependOnExactlyTheDeclaredParameters) {
    for (const BallBallModelInfo* model : kModels) {
        const BallBallModelInfo& info = *model;
        EXPECT_EQ(ball_ball_model(info.name), model);
        bool spin = false, turns = false, friction = false, restitution = false, cloth = false, sign = false;
        reference::Generator rng(3);
        for (int i = 0; i < 100; ++i) {
            reference::Impact x = reference::random_impact(rng);
            x.params.e_b = 0.9;
            const auto after = [&](const reference::Impact& y) {
                kernel::ImpactResult result;
                info.collide(settings(), y.ball1, y.ball2, y.params, result);
                EXPECT_EQ(result.status, kernel::ImpactStatus::kOk);
                return result;
            };
            const kernel::ImpactResult base = after(x);
            reference::Impact y = x;
            y.params.mu_b += 0.01;
            friction = friction || !same(base, after(y));
            y = x;
            y.params.e_b = 0.8;
            restitution = restitution || !same(base, after(y));
            y = x;
            y.params.mu_s1 += 0.1;
            y.params.mu_s2 += 0.1;
            cloth = cloth || !same(base, after(y));
            y = x;
            y.params.cloth_slip = kernel::ClothSlip::kAsPublished;
            sign = sign || !same(base, after(y));
            y = x;
            y.ball1.w[2] += 20.0;
            const kernel::ImpactResult spun = after(y);
            for (int k = 0; k < 2; ++k) spin = spin || spun.v1[k] != base.v1[k] || spun.v2[k] != base.v2[k];
            for (int k = 0; k < 3; ++k)
                turns = turns || std::abs(base.w1[k] - x.ball1.w[k]) > 1e-9 * std::abs(x.ball1.w[k]) + 1e-12;
        }
        EXPECT_EQ(friction, info.reads_friction) << info.name;
        EXPECT_EQ(restitution, info.reads_restitution) << info.name;
        EXPECT_EQ(cloth, info.reads_cloth) << info.name;
        EXPECT_EQ(sign, info.reads_cloth) << info.name;
        EXPECT_EQ(spin, info.reads_friction) << info.name;
        EXPECT_EQ(turns, info.reads_friction) << info.name;
    }
}

TEST(Unequal, EqualBallsGiveTheInelasticImpact) {
    reference::Generator rng(4);
    for (int i = 0; i < 1000; ++i) {
        const reference::Impact x = reference::random_impact(rng);
        kernel::ImpactResult a, b;
        kernel::collide_inelastic(x.ball1, x.ball2, x.params, a);
        const BallSize size{x.params.R, x.params.m};
        collide_unequal(size, size, x.ball1, x.ball2, x.params, b);
        ASSERT_EQ(a.status, b.status);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(a.v1[k], b.v1[k], 1e-13);
            EXPECT_NEAR(a.v2[k], b.v2[k], 1e-13);
            EXPECT_NEAR(a.w1[k], b.w1[k], 1e-11);
            EXPECT_NEAR(a.w2[k], b.w2[k], 1e-11);
        }
    }
}

TEST(Unequal, AnImpactWithoutSolutionReturnsItsInput) {
    const kernel::Ball one{{0.0, 0.0, 0.03}, {0.0, 1.0, 0.0}, {1.0, 2.0, 3.0}},
        two{{0.0, 0.06, 0.03}, {0.0, 0.0, 0.0}, {}};
    const kernel::ImpactParams rough{0.03, 0.17, 0.2, 0.2, 0.05, 0.9};
    kernel::ImpactParams smooth = rough;
    smooth.mu_b = 0.0;
    kernel::Ball away = one;
    away.v[1] = -1.0;
    const auto status = [&](const kernel::Ball& a, const kernel::Ball& b, double R,
                            const kernel::ImpactParams& p) {
        kernel::ImpactResult result{};
        collide_unequal({0.03, 0.17}, {R, 0.3}, a, b, p, result);
        EXPECT_EQ(result.v1[1], a.v[1]);
        EXPECT_EQ(result.w1[2], a.w[2]);
        return result.status;
    };
    EXPECT_EQ(status(one, two, 0.02, rough), kernel::ImpactStatus::kBadParameter);
    EXPECT_EQ(status(one, one, 0.03, smooth), kernel::ImpactStatus::kBadState);
    EXPECT_EQ(status(away, two, 0.03, smooth), kernel::ImpactStatus::kNotApproaching);
}

TEST(Unequal, AnyMassRatioConservesMomentumAndLosesEnergy) {
    reference::Generator rng(5);
    for (int i = 0; i < 1000; ++i) {
        const reference::Impact x = reference::random_impact(rng);
        const double R = x.params.R, m1 = rng.uniform(0.05, 0.4), m2 = rng.uniform(0.05, 0.4);
        kernel::ImpactResult r;
        collide_unequal({R, m1}, {R, m2}, x.ball1, x.ball2, x.params, r);
        ASSERT_EQ(r.status, kernel::ImpactStatus::kOk);
        const auto vec = [](const double(&a)[3]) { return Vec3(a[0], a[1], a[2]); };
        const Vec3 v1 = vec(x.ball1.v), v2 = vec(x.ball2.v), w1 = vec(x.ball1.w), w2 = vec(x.ball2.w);
        const Vec3 dv1 = vec(r.v1) - v1, dv2 = vec(r.v2) - v2, dw1 = vec(r.w1) - w1, dw2 = vec(r.w2) - w2;
        const Vec3 n = (vec(x.ball2.r) - vec(x.ball1.r)).normalized();
        const double scale = v1.norm() + v2.norm() + R * (w1.norm() + w2.norm());
        EXPECT_LE((m1 * dv1 + m2 * dv2).norm(), 1e-14 * scale);
        EXPECT_LE((m1 * dw1 - m2 * dw2).norm(), 1e-12 * scale / R);
        EXPECT_NEAR((vec(r.v2) - vec(r.v1)).dot(n), x.params.e_b * (v1 - v2).dot(n), 1e-13 * scale);
        const auto energy = [&](const Vec3& a, const Vec3& w, double m) {
            return m * (0.5 * a.squaredNorm() + 0.2 * R * R * w.squaredNorm());
        };
        const double before = energy(v1, w1, m1) + energy(v2, w2, m2);
        EXPECT_LE(energy(vec(r.v1), vec(r.w1), m1) + energy(vec(r.v2), vec(r.w2), m2),
                  before * (1.0 + 1e-14));
    }
}

const char* kSequential =
    "[physics]\nball_ball = \"elastic\"\nclusters = \"sequential\"\n[table]\ncushion = []\n";

Scene scene_of(const std::string& text) {
    return parse_scene(text, "s.toml");
}

// Two balls on one cloth touch when their centres are 2 sqrt(R1 R2) apart; an elastic impact exchanges
// velocities by mass.
TEST(Unequal, HeadOnElastic) {
    const Scene scene =
        scene_of(std::string(kSequential) +
                 "[[ball]]\nid = \"big\"\nradius = 0.04\nmass = 0.5\nposition = [0, 0]\n"
                 "velocity = [0, 1]\nspin = [-25, 0, 0]\n"
                 "[[ball]]\nid = \"small\"\nradius = 0.02\nmass = 0.1\nposition = [0, 0.5]\n");
    EXPECT_EQ(scene.ball[0].position.z(), 0.04);
    EXPECT_EQ(scene.ball[1].position.z(), 0.02);
    const Record record = run_verified(scene);
    const Event* hit = first(record, EventType::kBallBall);
    ASSERT_NE(hit, nullptr);
    const double reach = 2.0 * std::sqrt(0.04 * 0.02);
    const Vec3 r1 = record.state_at(0, hit->time).position, r2 = record.state_at(1, hit->time).position;
    EXPECT_NEAR((r2 - r1).norm(), 0.04 + 0.02, 1e-14) << "the surfaces touch";
    EXPECT_NEAR(r2.y() - r1.y(), reach, 1e-14);
    const double v = record.state_at(0, std::nextafter(hit->time, 0.0)).velocity.y();
    EXPECT_NEAR(record.state_at(0, hit->time).velocity.y(), v * 0.4 / 0.6, 1e-14);
    EXPECT_NEAR(record.state_at(1, hit->time).velocity.y(), v * 1.0 / 0.6, 1e-14);
    // Each then rolls by its own radius.
    const BallState small = record.state_at(1, hit->time + 0.9);
    ASSERT_EQ(small.state, MotionState::kRolling);
    EXPECT_NEAR(small.spin.x() * 0.02, -small.velocity.y(), 1e-14);
}

TEST(Unequal, CushionAndCueUseTheBallsOwnSize) {
    const std::string table = "[table]\n[[table.cushion]]\nfrom = [-1, 1]\nto = [1, 1]\nheight = 0.03\n";
    const auto contact_y = [&](const std::string& own) {
        const Record record =
            run_verified(scene_of(table + "[[ball]]\nposition = [0, 0.5]\n" + own +
                                  "[cue]\nspeed = 1\noffset = [0, 0]\nrestitution = 0.5\n"));
        const Event* hit = first(record, EventType::kBallCushion);
        EXPECT_NE(hit, nullptr);
        return std::pair(record.state_at(0, hit->time).position.y(), record.state_at(0, 0.0).velocity.y());
    };
    const auto [y, v] = contact_y("radius = 0.025\nmass = 0.3\n");
    EXPECT_NEAR(y, 1.0 - 0.025, 1e-14);
    EXPECT_NEAR(v, 1.5 / (1.0 + 0.3 / 0.567), 1e-14);
    EXPECT_NEAR(contact_y("").first, 1.0 - 0.028575, 1e-14);
}

// Random scenes with a heavy, large ball among small ones: every law holds after every event.
TEST(Unequal, RandomScenesKeepEveryLaw) {
    reference::Generator rng(6);
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        Scene scene = empty_scene();
        scene.table = box(1.0, 1.6, 0.03);
        if (i % 3 == 0) scene.physics.clusters = ClusterModel::kSequential;
        scene.physics.ball_ball =
            i % 2 ? (i % 4 == 1 ? &kMathavan : ball_ball_model("inelastic")) : ball_ball_model("elastic");
        const bool radii = i % 4 <= 1;
        if (i % 4 == 0) scene.balls.mu_b = 0.0;
        scene.stop.events = 40;
        for (int k = 0; k < 4; ++k) {
            const BallSize own{radii || i % 2 == 0 ? rng.uniform(0.02, 0.045) : scene.balls.R,
                               rng.uniform(0.05, 0.5)};
            const double vx = k < 2 ? rng.uniform(-2.0, 2.0) : 0.0, vy = k < 2 ? rng.uniform(-2.0, 2.0) : 0.0;
            add_ball(scene, std::to_string(k), 0.15 + 0.2 * k, rng.uniform(0.1, 1.5), vx, vy,
                     k < 2 ? rolling_spin(vx, vy, own.R) : Vec3(Vec3::Zero()));
            scene.ball.back().own = own;
            scene.ball.back().position.z() = own.R;
        }
        hits += count(run_verified(scene), EventType::kBallBall);
    }
    EXPECT_GT(hits, 250);
}

// An explicit size equal to the common one changes nothing.
TEST(Unequal, AnExplicitCommonSizeChangesNothing) {
    const std::string two = "[[ball]]\nvelocity = [0.1, 2]\n[[ball]]\nid = \"1\"\nposition = [0.64, 1.2]\n";
    const Scene plain = scene_of(two), written = scene_of(two + "radius = 0.028575\nmass = 0.170097\n");
    EXPECT_TRUE(written.alike());
    EXPECT_EQ(simulate(plan_of(plain)).hash(), simulate(plan_of(written)).hash());
}

// [physics] march: the two forms nearly agree, and each equals the kernel's.
TEST(Substeps, AreSummedOrMarchedAsPublished) {
    const std::string two =
        "[[ball]]\nid = \"a\"\nposition = [0.5, 0.5]\nvelocity = [0.3, 2]\n[[ball]]\nid = \"b\"\nposition = "
        "[0.56, 0.7]\n"
        "[physics]\nsubsteps = 1000\n";
    const Plan summed = plan_of(scene_of(two));
    const Plan published = plan_of(scene_of(two + "march = \"published\"\n"));
    EXPECT_EQ(summed.impact.march, kernel::summed_march_function(summed.isa));
    EXPECT_EQ(published.impact.march, kernel::march_function(published.isa));
    const Record one = simulate(summed), other = simulate(published);
    EXPECT_NE(one.hash(), other.hash());
    EXPECT_NEAR(one.duration, other.duration, 1e-8);
}

TEST(Unequal, ModelsWithAFormulaAcceptThem) {
    const std::string big =
        "[[ball]]\nid = \"a\"\nposition = [0.3, 0.5]\n[[ball]]\nid = \"b\"\nradius = 0.03\n";
    const std::string heavy =
        "[[ball]]\nid = \"a\"\nposition = [0.3, 0.5]\n[[ball]]\nid = \"b\"\nmass = 0.2\n";
    const std::string third = "[[ball]]\nid = \"c\"\nposition = [0.9, 0.9]\n";
    for (const std::string& two : {big, heavy}) {
        EXPECT_EQ(error_of(two), "");
        EXPECT_EQ(error_of(two + third), "");
        EXPECT_EQ(error_of(two + "[physics]\nsubsteps = 1000\n"), "");
        EXPECT_EQ(error_of(two + third + "[physics]\nball_ball = \"elastic\"\n"), "");
        EXPECT_EQ(error_of(two + "[balls]\nmu_b = 0\n"), "");
    }
    EXPECT_EQ(error_of(heavy + "[physics]\nball_ball = \"inelastic\"\n"), "");
    // The overlap is measured between spheres on one cloth.
    EXPECT_EQ(
        error_of("[balls]\nmu_b = 0\n[[ball]]\nposition = [0.3, 0.5]\nradius = 0.04\n[[ball]]\nid = \"b\"\n"
                 "radius = 0.02\nposition = [0.3, 0.5566]\n"),
        "");
}

// The friction between unlike balls depends on the slip along the tilted line of centres, as a vector in
// space.
TEST(Unequal, FrictionFallsWithTheSlipOfBothSurfaces) {
    reference::Generator rng(6);
    BallParams falls = make_ball_params("pool_classic");
    falls.mu_b = 0.01;
    falls.mu_b_more = 0.1;
    falls.mu_b_fall = 1.0;
    const BallBallSettings exact = settings();
    const auto any = [&rng](double most) {
        return Vec3(rng.uniform(-most, most), rng.uniform(-most, most), 0.0);
    };
    for (int i = 0; i < 200; ++i) {
        const BallSize size1{rng.uniform(0.02, 0.04), 0.17}, size2{rng.uniform(0.02, 0.04), 0.2};
        const Vec3 r1(0.0, 0.0, size1.R), r2(0.6 * contact_distance(size1.R, size2.R, false),
                                             0.8 * contact_distance(size1.R, size2.R, false), size2.R);
        Velocities a{any(1.0) + Vec3(0.9, 1.2, 0.0), any(30.0)}, b{any(0.3), any(30.0)};
        a.w.z() = rng.uniform(-30.0, 30.0);
        b.w.z() = rng.uniform(-30.0, 30.0);
        const Vec3 n = (r2 - r1) / (size1.R + size2.R), v = a.v - b.v;
        const Vec3 slip = v - v.dot(n) * n + (size1.R * a.w + size2.R * b.w).cross(n);
        BallParams constant = falls;
        constant.mu_b = falls.ball_friction()(slip.norm());
        constant.mu_b_more = 0.0;
        Velocities a1 = a, b1 = b;
        const PairImpact one = collide({kMathavan, exact, falls}, size1, size2, r1, r2, a, b);
        const PairImpact two = collide({kMathavan, exact, constant}, size1, size2, r1, r2, a1, b1);
        ASSERT_EQ(one.status, two.status);
        // Measured: 6.4e-8 m/s, in an impact of many stretches. With the slip of equal balls it would be 1e-3
        // m/s.
        EXPECT_LE((a.v - a1.v).norm() + (b.v - b1.v).norm(), 1e-6);
        EXPECT_LE(size1.R * (a.w - a1.w).norm() + size2.R * (b.w - b1.w).norm(), 1e-6);
    }
}

// Against the integration of one Hertz contact of balls that move: any cut, spin, speed, friction and mass.
TEST(ContactTime, ActsInTheMiddleOfTheContact) {
    reference::Generator rng(7);
    BallParams balls = make_ball_params("pool_classic");
    for (const bool masses : {false, true}) {
        std::vector<double> errors, instant;
        for (int k = 0; k < 4000; ++k) {
            const double V = std::exp(rng.uniform(std::log(0.1), std::log(10.0))),
                         cut = rng.uniform(0.0, 1.569),
                         ratio = masses ? std::exp(rng.uniform(-1.38, 1.38)) : 1.0;
            balls.mu_b = rng.uniform(0.0, 0.1);
            balls.e_b = rng.uniform(0.9, 1.0);
            const double R = balls.R, spin = rng.uniform() < 0.3 ? 0.0 : V / R;
            const Vec3 n(std::cos(0.3), std::sin(0.3), 0.0), t(-n.y(), n.x(), 0.0);
            const auto any = [&](double most) {
                const double x = rng.uniform(-most, most), y = rng.uniform(-most, most);
                return Vec3(x, y, rng.uniform(-most, most));
            };
            const Velocities one{V * (std::cos(cut) * n + std::sin(cut) * t), any(spin)},
                two{Vec3::Zero(), any(0.3 * spin)};
            // The integration, as the contact phase of a cluster of two.
            std::vector<ClusterBall> truth{{0, Vec3(0.0, 0.0, R), one.v, one.w, R, 1.0},
                                           {1, Vec3(0.0, 0.0, R) + 2.0 * R * n, two.v, two.w, R, ratio}};
            ClusterMap map;
            ASSERT_GT(map.compliant(truth, {{0, 1, n, 0.0}},
                                    {.R = R,
                                     .mu_s = balls.mu_s,
                                     .mu_b = balls.mu_b,
                                     .e_b = balls.e_b,
                                     .epsilon = 1e-4,
                                     .tolerance = 1e-8,
                                     .integrate = kernel::contact_phase_function(kernel::best_isa()),
                                     .unlike = masses},
                                    V * std::cos(cut), true),
                      0);
            const BallSize size1{R, balls.m}, size2{R, balls.m * ratio};
            for (const bool contact_time : {false, true}) {
                Velocities a = one, b = two;
                collide({kMathavan, settings(), balls, contact_time}, size1, size2, truth[0].r, truth[1].r, a,
                        b);
                const double error = std::max({(a.v - truth[0].v).lpNorm<Eigen::Infinity>(),
                                               (b.v - truth[1].v).lpNorm<Eigen::Infinity>(),
                                               R * (a.w - truth[0].w).lpNorm<Eigen::Infinity>(),
                                               R * (b.w - truth[1].w).lpNorm<Eigen::Infinity>()});
                (contact_time ? errors : instant).push_back(error / V);
            }
        }
        const std::string which = masses ? "masses 1/4 to 4, " : "";
        for (const double share : {0.5, 0.9, 0.99, 1.0}) {
            report((which + "middle of the contact, error in V, share " + std::to_string(share)).c_str(),
                   share_of(errors, share));
            report((which + "first touch, error in V, share " + std::to_string(share)).c_str(),
                   share_of(instant, share));
        }
        EXPECT_LT(share_of(errors, 0.5), 5e-5);
        EXPECT_LT(share_of(errors, 0.9), 3e-4);
        // Without the spin that replaces the turning of the slip: 8.6e-4 and 1.2e-3.
        EXPECT_LT(share_of(errors, 0.99), masses ? 1e-3 : 8e-4);
        EXPECT_LT(share_of(errors, 1.0), 1e-2);
        EXPECT_GT(share_of(instant, 0.9), 20.0 * share_of(errors, 0.9));
    }
}

TEST(Unequal, RecordsKeepTheSizes) {
    const Scene scene = scene_of(std::string(kSequential) +
                                 "[[ball]]\nradius = 0.04\nmass = 0.5\nvelocity = [0, 1]\n"
                                 "[[ball]]\nid = \"b\"\nposition = [0.6, 1]\n");
    const Record record = simulate(plan_of(scene));
    const TemporaryFolder folder;
    const std::string path = folder.file("sizes.json");
    write_record(record, path);
    const Record read = read_record(path);
    EXPECT_EQ(read.hash(), record.hash());
    EXPECT_EQ(read.size(0), (BallSize{0.04, 0.5}));
    EXPECT_EQ(read.size(1), scene.balls.size());
    EXPECT_FALSE(read.tracks[1].own);
    EXPECT_EQ(read.state_at(0, 0.1).spin, record.state_at(0, 0.1).spin);
}

}  // namespace
}  // namespace carom
