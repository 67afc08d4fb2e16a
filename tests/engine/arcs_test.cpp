// Round walls, discs and pucks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "carom/engine/event_details.h"
#include "carom/engine/variation.h"
#include "contact/detect.h"
#include "reference/random_impacts.h"
#include "support/hard_scenes.h"

namespace carom::test {
namespace {

using Real = long double;  // 11 bits more than double
constexpr Real kPi = std::numbers::pi_v<Real>;

constexpr double kSmallR = 0.01;

Jaw arc(const Vec2& center, double radius, double from_deg, double to_deg, const char* side = "inside") {
    return {"a", center, radius, kSmallR, "", side, from_deg, to_deg};
}

Scene lossless() {
    Scene scene = frictionless();
    scene.balls.R = kSmallR;
    return scene;
}

double energy_left(const Record& record) {
    double before = 0.0, after = 0.0;
    for (std::size_t i = 0; i < record.tracks.size(); ++i) {
        const double m = record.size(static_cast<int>(i)).m;
        before += m * record.tracks[i].segments.front().v.squaredNorm();
        after += m * record.state_at(static_cast<int>(i), record.duration).velocity.squaredNorm();
    }
    return after / before;
}

// All chords of a circle are equal, so the orbit has a closed form: 1000 bounces stay within 1e-9 m.
TEST(Arcs, AThousandBouncesInACircle) {
    Scene scene = lossless();
    scene.table.jaws.push_back(arc({0.3, -0.2}, 0.5 + kSmallR, 0.0, 360.0));
    const Vec2 start(0.5, -0.1), v(0.6, 0.35);
    add_ball(scene, "1", start.x(), start.y(), v.x(), v.y());
    scene.stop.events = 1000;
    const Record record = run_verified(scene);
    ASSERT_EQ(record.events.size(), 1000u);
    const Real x = Real(start.x()) - 0.3L, y = Real(start.y()) + 0.2L, speed = std::hypot(Real(v.x()), v.y());
    const Real miss = (x * v.y() - y * v.x()) / speed, chord = 2.0L * std::sqrt(0.25L - miss * miss);
    const Real along = -(x * v.x() + y * v.y()) / speed;
    // Direction of the path at the hit, and its angle to the normal.
    const Real first = std::atan2(Real(v.y()), Real(v.x())) - std::asin(miss / 0.5L),
               turn = kPi - 2.0L * std::asin(std::abs(miss) / 0.5L);
    for (std::size_t n = 0; n < record.events.size(); ++n) {
        const Event& e = record.events[n];
        EXPECT_EQ(e.type, EventType::kBallJaw);
        const Real time = (along + chord / 2.0L + chord * n) / speed;
        ASSERT_NEAR(e.time, static_cast<double>(time), 1e-9) << n;
        const Real angle = first + (miss > 0.0L ? turn : -turn) * n;
        const Vec3 at = record.state_at(0, e.time).position;
        ASSERT_NEAR(at.x(), static_cast<double>(0.3L + 0.5L * std::cos(angle)), 1e-9) << n;
        ASSERT_NEAR(at.y(), static_cast<double>(-0.2L + 0.5L * std::sin(angle)), 1e-9) << n;
    }
    EXPECT_NEAR(energy_left(record), 1.0, 1e-12);
}

// A ball behind an arc, inside the square around its circle, bounces off a cushion as if there were no arc.
TEST(Arcs, ActOnTheirOwnSideAlsoInACommonBounce) {
    for (const bool with_arc : {false, true}) {
        Scene scene = lossless();
        scene.table.cushions.push_back({"c", {0.29, 0.2}, {0.29, 0.5}, kSmallR});
        if (with_arc) scene.table.jaws.push_back(arc({0.0, 0.0}, 0.3, 0.0, 45.0));
        add_ball(scene, "1", 0.2, 0.27, 0.5, -0.125);
        scene.stop.events = 1;
        const Record record = run_verified(scene);
        ASSERT_EQ(record.events.size(), 1u);
        EXPECT_EQ(record.events[0].type, EventType::kBallCushion);
        EXPECT_EQ(record.tracks[0].segments.back().v, Vec3(-0.5, -0.125, 0.0)) << with_arc;
    }
}

/// The next bounce of a point in a stadium: half circles of radius 1/2 about (0, 0) and (1, 0), and the lines
/// y = -1/2 and 1/2 between them.
struct Orbit {
    Real x, y, vx, vy, time = 0.0L;
    void bounce() {
        Real best = 1e30L, nx = 0.0L, ny = 0.0L;
        constexpr Real kLeast = 1e-12L;
        for (const Real side : {-0.5L, 0.5L}) {
            const Real t = (side - y) / vy;
            const Real at = x + t * vx;
            if (t > kLeast && at >= 0.0L && at <= 1.0L && t < best) best = t, nx = 0.0L, ny = side * 2.0L;
        }
        for (const Real center : {0.0L, 1.0L}) {
            const Real dx = x - center, a = vx * vx + vy * vy, b = dx * vx + y * vy,
                       c = dx * dx + y * y - 0.25L, D = b * b - a * c;
            if (D < 0.0L) continue;
            const Real t = (-b + std::sqrt(D)) / a, at = dx + t * vx;
            const bool in_front = center == 0.0L ? at <= 0.0L : at >= 0.0L;
            if (t > kLeast && in_front && t < best) best = t, nx = 2.0L * at, ny = 2.0L * (y + t * vy);
        }
        x += best * vx, y += best * vy, time += best;
        const Real into = vx * nx + vy * ny;
        vx -= 2.0L * into * nx, vy -= 2.0L * into * ny;
    }
};

Scene stadium() {
    Scene scene = lossless();
    constexpr double kHalf = 0.5 + kSmallR;
    scene.table.cushions.push_back({"c1", {0.0, -kHalf}, {1.0, -kHalf}, kSmallR});
    scene.table.cushions.push_back({"c2", {0.0, kHalf}, {1.0, kHalf}, kSmallR});
    scene.table.jaws.push_back(arc({0.0, 0.0}, kHalf, 90.0, 270.0));
    scene.table.jaws.push_back(arc({1.0, 0.0}, kHalf, -90.0, 90.0));
    return scene;
}

// A stadium is chaotic, so doubles cannot follow a whole orbit. Each of 1000 bounces, computed from the
// previous one in 64 bits, is within 1e-9 m (measured: 1e-13), so a true orbit stays close to all of it.
TEST(Arcs, AThousandBouncesInAStadium) {
    Scene scene = stadium();
    add_ball(scene, "1", 0.3, 0.1, 0.7, 0.45);
    scene.stop.events = 1000;
    const Record record = run_verified(scene);
    ASSERT_EQ(record.events.size(), 1000u);
    EXPECT_EQ(record.stopped, StopReason::kEvents);
    const std::vector<Segment>& segments = record.tracks[0].segments;
    int round = 0;
    double worst = 0.0;
    for (std::size_t n = 0; n + 1 < segments.size(); ++n) {
        const Segment& s = segments[n];
        Orbit orbit{s.r.x(), s.r.y(), s.v.x(), s.v.y(), s.start};
        orbit.bounce();
        const Segment& next = segments[n + 1];
        ASSERT_NEAR(next.start, static_cast<double>(orbit.time), 1e-9) << n;
        ASSERT_NEAR(next.r.x(), static_cast<double>(orbit.x), 1e-9) << n;
        ASSERT_NEAR(next.r.y(), static_cast<double>(orbit.y), 1e-9) << n;
        ASSERT_NEAR(next.v.x(), static_cast<double>(orbit.vx), 1e-9) << n;
        ASSERT_NEAR(next.v.y(), static_cast<double>(orbit.vy), 1e-9) << n;
        round += record.events[n].type == EventType::kBallJaw;
        worst = std::max(worst, length(Vec2(next.r.x() - static_cast<double>(orbit.x),
                                            next.r.y() - static_cast<double>(orbit.y))));
    }
    report("bounce in a stadium, m", worst);
    EXPECT_GT(round, 400);
    EXPECT_LT(round, 900);
    EXPECT_NEAR(energy_left(record), 1.0, 1e-12);
}

// The orbit agrees with the reference until chaos takes over: each bounce multiplies an error by two or
// three, starting from 1e-16.
TEST(Arcs, AStadiumKeepsItsOrbitForTwentyBounces) {
    Scene scene = stadium();
    add_ball(scene, "1", 0.3, 0.1, 0.7, 0.45);
    scene.stop.events = 20;
    const Record record = run_verified(scene);
    Orbit orbit{0.3, 0.1, 0.7, 0.45};
    for (const Event& e : record.events) {
        orbit.bounce();
        ASSERT_NEAR(e.time, static_cast<double>(orbit.time), 1e-6);
    }
}

/// The first time at which a ball touches an arc, found by small steps and bisection.
double stepped(const Path& path, const Nose& nose, double R, double until) {
    const auto at = [&](double t) { return Vec2(path.r + t * path.v + 0.5 * t * t * path.a - nose.center); };
    const auto gap = [&](double t) { return nose.sign() * length(at(t)) - nose.radius - R; };
    const auto in_front = [&](double t) {
        return nose.span.holds(at(t)) && nose.sign() * length(at(t)) >= nose.radius;
    };
    constexpr int kSteps = 6000;
    for (int k = 0; k < kSteps; ++k) {
        double low = until * k / kSteps, high = until * (k + 1) / kSteps;
        if (!(gap(low) > 0.0 && gap(high) <= 0.0)) continue;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (low + high);
            (gap(middle) > 0.0 ? low : high) = middle;
        }
        if (in_front(high)) return high;
    }
    return kNever;
}

// From any side, on any path, to any part of a circle.
TEST(Arcs, AreDetectedFromAllSides) {
    reference::Generator random(11);
    const auto draw = [&random](double low, double high) { return random.uniform(low, high); };
    int met = 0, missed = 0;
    // Separate statements: compilers differ in the order of arguments.
    const auto place = [&draw](double most) {
        const double x = draw(-most, most);
        return Vec2(x, draw(-most, most));
    };
    for (int k = 0; k < 500; ++k) {
        const double from = draw(0.0, 360.0), turn = k % 3 == 0 ? 360.0 : draw(20.0, 350.0);
        const Vec2 center = place(0.4);
        const Jaw wall = arc(center, draw(0.2, 1.0), from, from + turn, k % 2 == 0 ? "inside" : "outside");
        const Nose nose = nose_of(wall, 0, 0.0);
        Path path{place(1.0), Vec2::Zero(), Vec2::Zero(), 3.0, true, true};
        path.v = place(1.0);
        if (k % 4 != 0) path.a = place(0.5), path.straight = false;
        const Vec2 out = path.r - nose.center;
        // Exclude balls already inside it, or wholly behind it; scenes allow neither.
        if (std::abs(length(out) - std::abs(nose.radius)) < kSmallR) continue;
        if (nose.span.whole && nose.sign() * length(out) < nose.radius) continue;
        const double t = time_to_nose(path, nose, kSmallR),
                     reference = stepped(path, nose, kSmallR, path.horizon);
        // Only one of the two methods sees a short contact between two steps, or a ball that comes around an
        // end, where it touches the end first.
        if (reference < kNever) {
            EXPECT_NEAR(t, reference, 1e-9)
                << k << " from " << out.transpose() << ", v " << path.v.transpose() << ", a "
                << path.a.transpose() << ", radius " << nose.radius;
        } else if (t < kNever && nose.sign() < 0.0) {
            EXPECT_FALSE(nose.span.whole) << k;
        }
        (t < kNever ? met : missed) += 1;
    }
    EXPECT_GT(met, 80);
    EXPECT_GT(missed, 80);
}

// A ball that loses speed at a round wall ends up running along it, and leaves it at its end.
TEST(Arcs, ABallRunsAlongARoundWall) {
    Scene scene = lossless();
    scene.balls.e_c = 0.5;
    constexpr double kRadius = 0.5 + kSmallR;
    scene.table.cushions.push_back({"c1", {-1.0, -kRadius}, {0.0, -kRadius}, kSmallR});
    scene.table.jaws.push_back(arc({0.0, 0.0}, kRadius, -90.0, 90.0));
    add_ball(scene, "1", -0.5, -0.5, 1.0, 0.0);
    scene.stop.time = 3.0;
    const Record record = run_verified(scene);
    // Half a turn at constant speed, then a straight line.
    const BallState end = record.state_at(0, 3.0);
    EXPECT_NEAR(end.velocity.x(), -1.0, 1e-4);
    EXPECT_NEAR(end.velocity.y(), 0.0, 1e-3);
    EXPECT_NEAR(end.position.y(), 0.5, 1e-3);
    EXPECT_NEAR(end.position.x(), -(3.0 - 0.5 - 0.5 * std::numbers::pi), 1e-3);
}

// Code that draws tables receives arcs as short cushions.
TEST(Arcs, AreDrawnAsShortCushions) {
    const Scene scene = stadium();
    const Table drawn = without_arcs(scene.table);
    EXPECT_TRUE(drawn.jaws.empty());
    ASSERT_EQ(drawn.cushions.size(), 2u + 2u * 60u);
    for (std::size_t i = 2; i < drawn.cushions.size(); ++i) {
        const Vec2 center(i < 62 ? 0.0 : 1.0, 0.0);
        EXPECT_NEAR(length(drawn.cushions[i].from - center), 0.5 + kSmallR, 1e-15);
    }
    EXPECT_EQ(drawn.cushions[2].from, Vec2(0.0, 0.5 + kSmallR));
}

// Balls and pucks lose speed in round tables and stadiums, some with a round obstacle, until they rest.
TEST(Arcs, RandomTablesKeepTheLaws) {
    for (int k = 0; k < 16; ++k) {
        SCOPED_TRACE(k);
        reference::Generator random(static_cast<std::uint64_t>(1000 + k));
        Scene scene = empty_scene();
        const double R = scene.balls.R, straight = k % 4 == 0 ? 0.0 : random.uniform(0.05, 1.0);
        const bool pucks = k % 5 == 4;
        const double height = pucks ? R : 1.28 * R;
        const auto wall = [&](const Vec2& center, double radius, double from, double to, const char* side) {
            scene.table.jaws.push_back({"a", center, radius, height, "", side, from, to});
        };
        if (k % 4 == 0) {
            wall({0.0, 0.0}, 0.5, 0.0, 360.0, "inside");
        } else {
            scene.table.cushions.push_back({"c1", {0.0, -0.5}, {straight, -0.5}, height});
            scene.table.cushions.push_back({"c2", {0.0, 0.5}, {straight, 0.5}, height});
            wall({0.0, 0.0}, 0.5, 90.0, 270.0, "inside");
            wall({straight, 0.0}, 0.5, -90.0, 90.0, "inside");
        }
        if (k % 4 == 2) wall({0.5 * straight, 0.0}, 0.12, 0.0, 360.0, "outside");
        if (k % 4 == 3) wall({0.5 * straight, -0.8}, 0.45, 20.0, 160.0, "outside");
        scene.balls.e_c = random.uniform(0.2, 1.0);
        scene.balls.e_b = random.uniform(0.5, 1.0);
        if (pucks) {
            scene.balls.slides = scene.balls.disc = true;
            scene.balls.mu_b = scene.balls.f_c = 0.0;
            scene.physics.ball_ball = ball_ball_model("inelastic");
            scene.physics.cushion = &kSmooth;
        }
        for (int tries = 0; tries < 60 && scene.ball.size() < 4; ++tries) {
            Scene more = scene;
            const double x = random.uniform(-0.5, 0.5 + straight), y = random.uniform(-0.5, 0.5),
                         v = random.uniform(-3.0, 3.0);
            add_ball(more, std::to_string(tries), x, y, v, random.uniform(-3.0, 3.0));
            try {
                validate(more);
            } catch (const SceneError&) {
                continue;
            }
            scene = more;
        }
        const Record record = run_verified(scene);
        EXPECT_EQ(record.stopped, StopReason::kAtRest);
    }
}

const std::string kHead = "[balls]\nradius = 0.01\n";

TEST(Arcs, AreWrittenAndReadBack) {
    Scene scene = parse_scene(kHead +
                                  "[[table.arc]]\ncenter = [0, 0]\nradius = 1\nfrom_deg = 10\n[[ball]]\n"
                                  "position = [0.2, 0.1]\n",
                              "s.toml");
    ASSERT_EQ(scene.table.jaws.size(), 1u);
    EXPECT_EQ(scene.table.jaws[0].id, "a1");
    EXPECT_EQ(scene.table.jaws[0].to_deg, 370.0);
    EXPECT_EQ(scene.table.width, 2.0);
    EXPECT_EQ(scene.table.length, 2.0);
    const Scene again = parse_scene(scene_text(scene), "s.toml");
    EXPECT_TRUE(again.table == scene.table);
    const std::string wider = with_values(scene_text(scene), "s.toml", {{"table.arc.a1.radius", "1.5"}});
    EXPECT_EQ(parse_scene(wider, "s.toml").table.jaws[0].radius, 1.5);
    Scene built = scene;
    EXPECT_NO_THROW(validate(built));
    built.table.jaws[0].to_deg = 5.0;
    EXPECT_THROW(validate(built), SceneError);
    const Record record = simulate(make_plan(scene, kernel::Isa::kScalar));
    EXPECT_TRUE(parse_record(record_json(record), "r.json").table == record.table);
}

// Two discs touch at the sum of their radii; unlike balls touch at a smaller distance.
TEST(Discs, TouchAtTheSumOfTheirRadii) {
    for (const bool discs : {true, false}) {
        Scene scene = lossless();
        scene.balls.disc = discs;
        add_ball(scene, "1", 0.0, 0.0, 1.0, 0.0);
        add_ball(scene, "2", 0.5, 0.0);
        scene.ball.back().own = BallSize{0.04, scene.balls.m};
        scene.ball.back().position.z() = 0.04;
        scene.stop.time = 1.0;
        const Record record = run_verified(scene);
        ASSERT_EQ(record.events.size(), 1u);
        EXPECT_NEAR(record.events[0].time, 0.5 - (discs ? kSmallR + 0.04 : 2.0 * std::sqrt(kSmallR * 0.04)),
                    1e-14);
        if (discs) {
            EXPECT_EQ(details_of(record, 0).cut, 0.0);
        }
        // Equal masses exchange their velocities.
        EXPECT_NEAR(record.state_at(0, 1.0).velocity.x(), 0.0, 1e-14);
        EXPECT_NEAR(record.state_at(1, 1.0).velocity.x(), 1.0, 1e-14);
    }
}

Scene pucks() {
    Scene scene = lossless();
    scene.balls.disc = scene.balls.slides = true;
    scene.balls.mu_s = 0.15;
    scene.physics.gravity = 9.81;
    return scene;
}

// A puck stops after v^2 / (2 mu g), and never rolls.
TEST(Pucks, StopAfterTheFrictionDistance) {
    Scene scene = pucks();
    add_ball(scene, "1", 0.0, 0.0, 1.2, 0.9);
    scene.ball[0].spin = {0.0, 0.0, 5.0};
    scene.balls.mu_sp = 0.02;
    const Record record = run_verified(scene);
    const double mu_g = 0.15 * 9.81, way = 1.5 * 1.5 / (2.0 * mu_g);
    const BallState end = record.state_at(0, record.duration);
    EXPECT_NEAR(end.position.x(), 0.8 * way, 1e-13);
    EXPECT_NEAR(end.position.y(), 0.6 * way, 1e-13);
    EXPECT_TRUE(end.velocity.isZero(0.0));
    for (const Segment& s : record.tracks[0].segments) EXPECT_NE(s.state, MotionState::kRolling);
    EXPECT_EQ(record.events[0].type, EventType::kRollStop);
    EXPECT_NEAR(record.events[0].time, 1.5 / mu_g, 1e-14);
}

// Two that stick share the momentum and stop together.
TEST(Pucks, ThatStickStopTogether) {
    Scene scene = pucks();
    scene.balls.e_b = 0.0;
    scene.physics.ball_ball = ball_ball_model("inelastic");
    add_ball(scene, "1", 0.0, 0.0, 1.0, 0.0);
    add_ball(scene, "2", 0.1, 0.0);
    const Record record = run_verified(scene);
    const double mu_g = 0.15 * 9.81, v2 = 1.0 - 2.0 * mu_g * (0.1 - 2.0 * kSmallR),
                 way = 0.25 * v2 / (2.0 * mu_g);
    EXPECT_NEAR(record.state_at(1, record.duration).position.x(), 0.1 + way, 1e-8);
    EXPECT_NEAR(record.state_at(0, record.duration).position.x(), 0.1 - 2.0 * kSmallR + way, 1e-8);
    for (const BallTrack& track : record.tracks)
        for (const Segment& s : track.segments) EXPECT_TRUE(planar(s.w).isZero(0.0));
}

TEST(Pucks, AreWrittenAndReadBack) {
    const std::string text =
        "[balls]\nrolls = false\nmu_b = 0\nf_c = 0\n[physics]\nball_ball = \"elastic\"\n"
        "cushion = \"smooth\"\n[[ball]]\nposition = [0.4, 0.5]\nvelocity = [1, 0]\n";
    const Scene scene = parse_scene(text, "s.toml");
    EXPECT_FALSE(scene.balls.rolls());
    EXPECT_TRUE(parse_scene(scene_text(scene), "s.toml").balls == scene.balls);
}

}  // namespace
}  // namespace carom::test
