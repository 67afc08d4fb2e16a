// Differences between two shots with results known on paper.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/scene.h"
#include "carom/engine/simulate.h"
#include "carom/kernel/isa.h"
#include "commands/compare/difference.h"

namespace carom::tools {
namespace {

Record played(const std::string& text) {
    return simulate(make_plan(parse_scene(text, "a test"), kernel::Isa::kFastest));
}

ShotDifference between(const std::string& a, const std::string& b) {
    return difference(played(a), played(b));
}

/// A ball on an endless cloth.
std::string lone(const std::string& position, const std::string& velocity = "[0, 0]",
                 const std::string& more = "") {
    return "[table]\ncushion = []\n[[ball]]\nid = \"a\"\nposition = " + position +
           "\nvelocity = " + velocity + "\n" + more;
}

TEST(Difference, OfAShotToItselfIsZero) {
    const ShotDifference d = between(lone("[0, 0]", "[1, 0.5]"), lone("[0, 0]", "[1, 0.5]"));
    EXPECT_TRUE(d.same_bits);
    EXPECT_TRUE(d.within(0.0));
    EXPECT_TRUE(d.events.ends_alike());
    EXPECT_FALSE(d.events.first_apart);
    ASSERT_EQ(d.balls.size(), 1u);
    EXPECT_EQ(d.balls[0].end, 0.0);
    EXPECT_EQ(d.balls[0].largest, 0.0);
}

TEST(Difference, OfAShiftedShotIsTheShift) {
    const ShotDifference d = between(lone("[0, 0]", "[1, 0.5]"), lone("[0.03, 0.04]", "[1, 0.5]"));
    EXPECT_FALSE(d.same_bits);
    EXPECT_NEAR(d.balls[0].end, 0.05, 1e-15);
    EXPECT_NEAR(d.balls[0].largest, 0.05, 1e-15);
    EXPECT_TRUE(d.within(0.0500001));
    EXPECT_FALSE(d.within(0.0499999));
    EXPECT_TRUE(d.events.ends_alike()) << "events do not name places";
    EXPECT_FALSE(d.events.first_apart);
}

// A ball thrown up is v^2 / 2g above a resting one after v / g, between two events, and back at the end.
TEST(Difference, FindsTheLargestBetweenEvents) {
    for (const double v : {1.0, 2.0}) {
        const std::string up = "[0, 0, " + std::to_string(v) + "]";
        const ShotDifference d = between(lone("[0, 0]", up), lone("[0, 0]"));
        EXPECT_NEAR(d.balls[0].largest, v * v / (2.0 * 9.81), 1e-12);
        EXPECT_NEAR(d.balls[0].largest_at, v / 9.81, 1e-7);
        EXPECT_NEAR(d.balls[0].end, 0.0, 1e-12);
        EXPECT_FALSE(d.within(1e-4)) << "what counts is not the end alone";
    }
}

// The same from samples: no sampled instant of a real shot exceeds the largest distance, and one nearly
// reaches it.
TEST(Difference, IsTheLargestOfManySamples) {
    const auto scene = [](const char* name) {
        return std::string(CAROM_SOURCE_DIR) + "/scenes/" + name + ".toml";
    };
    const Record a = simulate(make_plan(read_scene(scene("eight_ball_break")), kernel::Isa::kFastest));
    const Record b = simulate(make_plan(read_scene(scene("raised_break")), kernel::Isa::kFastest));
    const ShotDifference d = difference(a, b);
    for (std::size_t i = 0; i < d.balls.size(); ++i) {
        const BallDifference& ball = d.balls[i];
        ASSERT_EQ(ball.id, a.tracks[i].id);
        ASSERT_EQ(ball.id, b.tracks[i].id);
        double largest = 0.0;
        for (int k = 0; k <= 20000; ++k) {
            const double t = d.until * k / 20000;
            const BallState x = a.state_at(static_cast<int>(i), t), y = b.state_at(static_cast<int>(i), t);
            if (!is_gone(x.state) && !is_gone(y.state))
                largest = std::max(largest, (x.position - y.position).norm());
        }
        EXPECT_LE(largest, ball.largest + 1e-12) << ball.id;
        // At 12 m/s, the faster of both, half a sample is 2.4 mm of path for each ball; a ball that is gone
        // in one shot may continue in the other.
        if (!ball.a.gone() && !ball.b.gone()) {
            EXPECT_GE(largest, ball.largest - 0.005) << ball.id;
        }
        EXPECT_GE(ball.largest, ball.end) << ball.id;
    }
}

// Balls in the same pocket are equal, however they fell, even if one is placed at the bottom slightly later.
TEST(Difference, OfBallsInOnePocketIsZero) {
    const auto shot = [](const char* speed) {
        return std::string("[[ball]]\nid = \"a\"\nposition = [0.2, 0.2]\nvelocity = [") + speed + ", " +
               speed + "]\nspin = [-20, 20, 0]\n";
    };
    const ShotDifference d = between(shot("-1"), shot("-1.0000001"));
    ASSERT_EQ(d.balls.size(), 1u);
    EXPECT_EQ(d.balls[0].a.pocket, "p1");
    EXPECT_EQ(d.balls[0].b.pocket, "p1");
    EXPECT_EQ(d.balls[0].end, 0.0);
    EXPECT_GT(d.balls[0].largest, 0.0);
    EXPECT_LT(d.balls[0].largest, 1e-5);
    EXPECT_TRUE(d.within(1e-5));
    EXPECT_TRUE(d.events.ends_alike());
    ASSERT_TRUE(d.events.first_apart);
    EXPECT_GT(d.events.farthest_apart, 0.0);

    const ShotDifference other = between(shot("-1"), shot("-0.05"));
    EXPECT_TRUE(other.balls[0].a.gone());
    EXPECT_FALSE(other.balls[0].b.gone());
    EXPECT_FALSE(other.within(1e3)) << "one in a pocket and one on the table are never equal";
}

TEST(Difference, EndsWhereEitherShotEnds) {
    const std::string whole = lone("[0, 0]", "[1, 0]"),
                      stopped = lone("[0, 0]", "[1, 0]", "[stop]\ntime = 0.25\n");
    const ShotDifference d = between(whole, stopped);
    EXPECT_EQ(d.until, 0.25);
    EXPECT_EQ(d.balls[0].largest, 0.0);
    EXPECT_GT(d.balls[0].end, 0.1);
    EXPECT_FALSE(d.within(0.1));
    EXPECT_FALSE(d.events.ends_alike());
    // Rest is known forever, so the longer shot counts.
    const Record slow = played(lone("[0, 0]", "[0.1, 0]")), fast = played(whole);
    EXPECT_EQ(difference(slow, fast).until, fast.duration);
    EXPECT_NEAR(difference(slow, fast).balls[0].largest, difference(slow, fast).balls[0].end, 1e-15);
}

TEST(Difference, ComparesCommonBallsByName) {
    const auto two = [](const char* first, const char* second) {
        return std::string("[[ball]]\nid = \"") + first +
               "\"\nposition = [0.5, 0.5]\nvelocity = [0, 0.5]\n[[ball]]\nid = \"" + second +
               "\"\nposition = [0.5, 0.8]\n";
    };
    const ShotDifference d = between(two("a", "b"), two("c", "b"));
    EXPECT_TRUE(d.same_bits) << "names are no part of a hash";
    EXPECT_EQ(d.only_a, std::vector<std::string>{"a"});
    EXPECT_EQ(d.only_b, std::vector<std::string>{"c"});
    ASSERT_EQ(d.balls.size(), 1u);
    EXPECT_EQ(d.balls[0].id, "b");
    EXPECT_EQ(d.balls[0].largest, 0.0);
    EXPECT_FALSE(d.within(1.0)) << "other balls are another shot";
    // Reordered balls are the same, and so are events that name them in another order.
    const std::string swapped =
        "[[ball]]\nid = \"b\"\nposition = [0.5, 0.8]\n[[ball]]\nid = \"a\"\nposition = [0.5, 0.5]\nvelocity "
        "= [0, 0.5]\n";
    const ShotDifference same = between(two("a", "b"), swapped);
    EXPECT_TRUE(same.same_balls());
    EXPECT_EQ(same.balls[0].id, "a");
    EXPECT_LT(same.balls[0].largest, 1e-12);
    EXPECT_GT(same.events.a.size(), 3u);
    EXPECT_TRUE(same.events.ends_alike()) << same.events.alike;
}

TEST(Difference, FindsTheFirstEventOfAnotherKind) {
    const auto shot = [](const char* x) {
        return std::string(
                   "[[ball]]\nid = \"a\"\nposition = [0.5, 0.5]\nvelocity = [0, 0.5]\n[[ball]]\nid = "
                   "\"b\"\nposition = [") +
               x + ", 0.8]\n";
    };
    const ShotDifference d = between(shot("0.5"), shot("0.8"));
    EXPECT_EQ(d.events.alike, 1u);
    EXPECT_FALSE(d.events.first_apart);
    ASSERT_GT(d.events.a.size(), 1u);
    ASSERT_GT(d.events.b.size(), 1u);
    EXPECT_EQ(d.events.a[0].type, "slide_roll");
    EXPECT_EQ(d.events.a[1].type, "ball_ball");
    EXPECT_EQ(d.events.a[1].who, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(d.events.b[1].who, (std::vector<std::string>{"a"}));
    EXPECT_EQ(d.balls[1].id, "b");
}

}  // namespace
}  // namespace carom::tools
