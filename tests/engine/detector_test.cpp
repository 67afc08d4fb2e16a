// The detector alone: no impact is resolved and no shot simulated; ball positions are set by hand.
#include <cmath>
#include <cstdint>
#include <string>

#include "contact/detect.h"
#include "loop/detector.h"
#include "loop/run.h"
#include "physics/motion.h"
#include "support/engine_cases.h"
#include "support/random_scenes.h"

namespace carom {
namespace {

using namespace test;

/// The parts of a run that a detector reads, with a scene's balls at their start.
struct Parts {
    explicit Parts(const Scene& scene, Search search = Search::kDirect)
        : plan(plan_by(scene, search)),
          balls(plan, memory.balls),
          log(plan, options, balls, memory.log, Keep::kRecord),
          resting(plan, balls, log, memory.resting),
          detector(plan, balls, resting, nullptr, memory.detector) {
        for (int i = 0; i < balls.count(); ++i) {
            const BallStart& b = scene.ball[static_cast<std::size_t>(i)];
            log.begin(i, start_segment(0.0, b.position, b.velocity, b.spin, balls.motion(i)));
        }
        detector.update(log.touched());
    }
    static Plan plan_by(const Scene& scene, Search search) {
        Plan plan = plan_of(scene);
        plan.ball_search = plan.table_search = search;
        return plan;
    }
    /// Gives the ball a new motion from now on.
    void turn(int ball, const Vec3& v, const Vec3& w) {
        log.begin(ball, start_segment(balls.now(), balls.position(ball), v, w, balls.motion(ball)));
        detector.update(log.touched());
    }

    Plan plan;
    SimulateOptions options;
    RunBuffers::Memory memory;
    Balls balls;
    Log log;
    RestingContacts resting;
    Detector detector;
};

/// A frictionless ball: it keeps its velocity.
void add_gliding(Scene& scene, const std::string& id, double x, double y, double vx, double vy) {
    add_ball(scene, id, {x, y, scene.balls.R}, {vx, vy, 0.0});
}

Scene gliding_scene() {
    Scene scene = empty_scene();
    scene.balls.mu_s = scene.balls.mu_r = scene.balls.mu_sp = scene.balls.mu_b = 0.0;
    scene.stop.time = 100.0;
    return scene;
}

TEST(Detector, RestingBallsHaveNoNextEvent) {
    Scene scene = gliding_scene();
    add_gliding(scene, "a", 0.0, 0.0, 0.0, 0.0);
    add_gliding(scene, "b", 0.0, 1.0, 0.0, 0.0);
    Parts parts(scene);
    EXPECT_EQ(parts.detector.next().time, kNever);
}

TEST(Detector, FindsTheContactOfTwoBalls) {
    Scene scene = gliding_scene();
    add_gliding(scene, "a", 0.0, 0.0, 0.0, 2.0);
    add_gliding(scene, "b", 0.0, 1.0, 0.0, 0.0);
    Parts parts(scene);
    const PredictedEvent next = parts.detector.next();
    EXPECT_NEAR(next.time, (1.0 - 2.0 * scene.balls.R) / 2.0, 1e-15);
    EXPECT_EQ(next.contact, (Contact{0, With::kBall, 1}));
    // Asked again without an event, it returns the same result.
    EXPECT_EQ(parts.detector.next().time, next.time);
}

TEST(Detector, SearchesAgainWhenAPartnerTurns) {
    Scene scene = gliding_scene();
    add_gliding(scene, "a", 0.0, 0.0, 0.0, 2.0);
    add_gliding(scene, "b", 0.0, 1.0, 0.0, 0.0);
    add_gliding(scene, "c", 0.0, 3.0, 0.0, 0.0);
    Parts parts(scene);
    EXPECT_EQ(parts.detector.next().contact.other, 1);
    parts.balls.advance_to(0.1);
    parts.turn(1, {1.0, 0.0, 0.0}, Vec3::Zero());  // b leaves the line of a
    const PredictedEvent next = parts.detector.next();
    EXPECT_EQ(next.contact, (Contact{0, With::kBall, 2}));
    EXPECT_NEAR(next.time, (3.0 - 2.0 * scene.balls.R) / 2.0, 1e-15);
}

// Simultaneous events have an order: pocket, transition, ball, cushion. All numbers here are exact.
TEST(Detector, OrderAtOneInstant) {
    Scene scene = gliding_scene();
    scene.balls.R = 0.03125;
    scene.table.width = scene.table.length = 8.0;
    scene.table.cushions = {{"c", {3.0, 1.0}, {5.0, 1.0}, 1.25 * scene.balls.R}};
    scene.table.pockets = {{"p", {0.0, 1.0}, 0.0625, 0.125}};
    // In a quarter of a second "c" meets the cushion, "a" meets "b" and "p" falls.
    add_gliding(scene, "c", 4.0, 0.96875 - 0.25, 0.0, 1.0);
    add_gliding(scene, "a", 2.0, -1.0, 0.0, 1.0);
    add_gliding(scene, "b", 2.0, -1.0 + 0.25 + 0.0625, 0.0, 0.0);
    add_gliding(scene, "p", 0.0, 0.9375 - 0.25, 0.0, 1.0);
    Parts parts(scene);
    for (const With with : {With::kPocket, With::kBall, With::kCushion}) {
        const PredictedEvent next = parts.detector.next();
        EXPECT_EQ(next.time, 0.25);
        EXPECT_EQ(next.contact.with, with);
        parts.balls.advance_to(next.time);
        parts.turn(next.contact.ball, Vec3::Zero(), Vec3::Zero());  // it stops; its part is over
    }
    EXPECT_EQ(parts.detector.next().time, kNever);
}

/// The first contact or transition by closed forms alone: every ball against every ball and part.
PredictedEvent by_hand(const Parts& parts) {
    PredictedEvent first;
    const auto offer = [&](double time, const Contact& contact) {
        if (time < first.time) first = {time, contact};
    };
    const Geometry& g = parts.plan.geometry;
    const auto path = [&](int i) {
        const Segment& s = parts.balls.segment(i);
        const bool straight = s.state == MotionState::kRolling || cross(planar(s.v), s.a) == 0.0;
        return Path{planar(s.r),
                    planar(s.v),
                    s.a,
                    s.duration,
                    straight,
                    translates(s.state),
                    parts.balls.radius(i) * std::sqrt(s.w.squaredNorm())};
    };
    for (int i = 0; i < parts.balls.count(); ++i) {
        const Path p = path(i);
        const double R = parts.balls.radius(i);
        offer(parts.balls.segment(i).duration, {i, With::kNothing, -1});
        for (int j = i + 1; j < parts.balls.count(); ++j)
            if (p.moves || path(j).moves)
                offer(time_to_ball(p, path(j), contact_distance(R, parts.balls.radius(j), false)),
                      {i, With::kBall, j});
        if (!p.moves) continue;
        for (std::size_t k = 0; k < g.cushions.size(); ++k)
            offer(time_to_line(p, g.cushions[k], R), {i, With::kCushion, static_cast<int>(k)});
        for (std::size_t k = 0; k < g.noses.size(); ++k)
            offer(time_to_circle(p, g.noses[k].center, R + g.noses[k].radius),
                  {i, With::kNose, static_cast<int>(k)});
        for (std::size_t k = 0; k < g.pockets.size(); ++k)
            offer(time_to_pocket(p, g.pockets[k].center, g.pockets[k].radius),
                  {i, With::kPocket, static_cast<int>(k)});
    }
    return first;
}

TEST(Detector, AgreesWithTestingEveryPair) {
    int moving = 0, ties = 0;
    for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
        const Scene scene = RandomScene(seed).make();
        for (const Search search : {Search::kDirect, Search::kTree}) {
            Parts parts(scene, search);
            const PredictedEvent next = parts.detector.next(), expected = by_hand(parts);
            ASSERT_EQ(next.time, expected.time) << "seed " << seed;
            if (next.time == kNever) continue;
            ++moving;
            // The detector orders simultaneous events itself (OrderAtOneInstant).
            ties += !(next.contact == expected.contact);
        }
    }
    EXPECT_GT(moving, 1500);
    EXPECT_LT(ties, moving / 20);
}

TEST(Detector, SkipsRestingContacts) {
    Scene scene = empty_scene();
    const double R = scene.balls.R;
    add_ball(scene, "a", {0.0, 0.0, R}, {0.0, 0.1, 0.0}, {-0.1 / R, 0.0, 0.0});
    add_ball(scene, "b", {0.0, 2.0 * R, R}, {0.0, 0.1, 0.0}, {-0.1 / R, 0.0, 0.0});
    Parts parts(scene);
    const Contact contact{0, With::kBall, 1};
    Meeting met = parts.balls.meet(contact);
    met.pressing = 1.0;  // pressed together but not closing: no bounce
    EXPECT_FALSE(parts.resting.has(contact));
    ASSERT_TRUE(parts.resting.try_hold(met, scene.balls.e_b));
    EXPECT_TRUE(parts.resting.has(contact));
    EXPECT_TRUE(parts.resting.has({1, With::kBall, 0}));
    parts.detector.update(parts.log.touched());
    EXPECT_EQ(parts.detector.next().contact.with, With::kNothing);
    parts.resting.release(0);
    EXPECT_FALSE(parts.resting.has(contact));
}

}  // namespace
}  // namespace carom
