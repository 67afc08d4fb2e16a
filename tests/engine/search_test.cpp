// Boxes, tournament and rejects only skip: events are the same bit for bit with every search.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "carom/engine/tolerances.h"
#include "contact/detect.h"
#include "loop/box_search.h"
#include "loop/event_queue.h"
#include "support/gas.h"
#include "support/random_scenes.h"

namespace carom {
namespace {

using namespace test;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Box random_box(Generator& rng) {
    const double x = rng.uniform(-3.0, 3.0), y = rng.uniform(-3.0, 3.0);
    Box box{x, y, x + rng.uniform(0.0, 0.5), y + rng.uniform(0.0, 0.5)};
    if (rng.uniform() < 0.02) box = {-kInfinity, -kInfinity, kInfinity, kInfinity};
    return box;
}

bool overlap(const Box& a, const Box& b) {
    return a.low_x <= b.high_x && b.low_x <= a.high_x && a.low_y <= b.high_y && b.low_y <= a.high_y;
}

// Moves, removals and rebuilds: every overlap in double is found, and direct loop and tree agree.
TEST(BoxSearch, FindsEveryOverlap) {
    for (const int count : {1, 5, 64, 65, 300}) {
        BoxSearch direct, tree;
        direct.set_up(count, Search::kDirect);
        tree.set_up(count, Search::kTree);
        Generator rng(static_cast<std::uint64_t>(count));
        std::vector<Box> boxes(static_cast<std::size_t>(count));
        std::vector<bool> in(boxes.size(), true);
        const auto place = [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            boxes[k] = random_box(rng);
            in[k] = true;
            direct.place(i, boxes[k]);
            tree.place(i, boxes[k]);
        };
        for (int i = 0; i < count; ++i) place(i);
        std::size_t found = 0, needed = 0;
        for (int round = 0; round < 2000; ++round) {
            const int i = static_cast<int>(rng.next() % static_cast<std::uint64_t>(count));
            if (rng.uniform() < 0.1) {
                in[i] = false;
                direct.remove(i);
                tree.remove(i);
            } else {
                place(i);
            }
            direct.rebuild_if_due();
            tree.rebuild_if_due();
            const Box asked = random_box(rng);
            std::vector<int> a, b;
            direct.overlapping(asked, [&a](int k) { a.push_back(k); });
            tree.overlapping(asked, [&b](int k) { b.push_back(k); });
            EXPECT_TRUE(std::is_sorted(a.begin(), a.end()));
            std::sort(b.begin(), b.end());
            ASSERT_EQ(a, b);
            for (int k = 0; k < count; ++k) {
                if (!in[k] || !overlap(asked, boxes[k])) continue;
                ++needed;
                ASSERT_TRUE(std::binary_search(a.begin(), a.end(), k)) << count << " " << round;
            }
            for (const int k : a) ASSERT_TRUE(in[k]);
            found += a.size();
        }
        EXPECT_GE(found, needed);
        EXPECT_LE(static_cast<double>(found), 1.001 * static_cast<double>(needed) + 1.0);
    }
}

TEST(EventQueue, TheFirstEventsAreTheEarliest) {
    for (const int count : {0, 1, 2, 3, 16, 17, 100, 300, 5000}) {
        EventQueue queue;
        queue.set_up(count);
        std::vector<double> time(static_cast<std::size_t>(count), kInfinity);
        Generator rng(7);
        // Few different times, so that many are equal.
        const auto change = [&](int i) {
            time[i] = rng.uniform() < 0.2 ? kInfinity : static_cast<double>(rng.next() % 64);
            queue.set(i, time[i]);
        };
        for (int i = 0; i < count; ++i) change(i);
        for (int round = 0; round < 1000; ++round) {
            for (int k = 0; k < 3 && count > 0; ++k)
                change(static_cast<int>(rng.next() % static_cast<std::uint64_t>(count)));
            const double first = count > 0 ? *std::min_element(time.begin(), time.end()) : kInfinity;
            ASSERT_EQ(queue.first(), first);
            if (!(first < kInfinity)) continue;
            std::vector<int> expected, found;
            for (int i = 0; i < count; ++i)
                if (time[i] == first) expected.push_back(i);
            queue.all_at(first, [&found](int i) { found.push_back(i); });
            ASSERT_EQ(found, expected);
        }
    }
}

// Random paths, many aimed to pass at about the reach.
TEST(Rejects, NeverMissAContact) {
    Generator rng(11);
    int rejected = 0, contacts = 0;
    const double R = 0.028575;
    const auto vec = [&rng](double size) { return Vec2{rng.uniform(-size, size), rng.uniform(-size, size)}; };
    for (int k = 0; k < 200000; ++k) {
        const bool rolls = rng.uniform() < 0.3;
        Path ball{vec(0.5), vec(2.0), rolls ? Vec2(Vec2::Zero()) : vec(2.0), rng.uniform(0.01, 2.0),
                  rolls,    true};
        Path other{vec(0.5), Vec2::Zero(), Vec2::Zero(), kInfinity, true, false};
        if (rng.uniform() < 0.5) {
            // The first ball's position at some time, then about a diameter in any direction.
            const double t = rng.uniform() * ball.horizon, share = 1.0 + 1e-7 * rng.uniform(-5.0, 5.0);
            const SinCos side = sin_cos_deg(rng.uniform(0.0, 360.0));
            other.r = ball.r + t * (ball.v + 0.5 * t * ball.a) + 2.0 * R * share * Vec2(side.cos, side.sin);
        }
        const double window = rng.uniform() < 0.5 ? ball.horizon : rng.uniform() * ball.horizon;
        const double t = time_to_ball(ball, other, 2.0 * R);
        const Vec2 r = other.r - ball.r, v = other.v - ball.v, a = other.a - ball.a;
        const bool apart = stays_apart(r, v, a, 2.0 * R, window);
        for (const double long_or_not : {window, 0.0, -1.0, kInfinity})
            ASSERT_EQ(stays_apart(r, v, a, 2.0 * R, long_or_not),
                      stays_apart_plain(r, v, a, 2.0 * R, long_or_not))
                << k;
        rejected += apart;
        contacts += t <= window;
        ASSERT_FALSE(apart && t <= window) << k << " " << t << " of " << window;
        const CushionLine line{other.r, {0.6, 0.8}, 0.7, R};
        ASSERT_FALSE(stays_off_line(ball, line, R, window) && time_to_line(ball, line, R) <= window) << k;
    }
    EXPECT_GT(rejected, 50000);
    EXPECT_GT(contacts, 20000);
}

struct Way {
    Search balls, table;
    double travel;
};
const Way kWays[] = {{Search::kDirect, Search::kDirect, kInfinity},
                     {Search::kTree, Search::kTree, kInfinity},
                     {Search::kDirect, Search::kTree, 1.0},
                     {Search::kTree, Search::kDirect, kBoxTravel}};

Record run(const Scene& scene, const Way& way) {
    Plan plan = plan_of(scene);
    plan.ball_search = way.balls;
    plan.table_search = way.table;
    plan.box_travel = way.travel;
    return simulate(plan);
}

TEST(Search, EverySearchGivesTheSameBitsInAGas) {
    for (const int n : {4, 100, 900}) {
        const Scene scene = gas(n, 3000, 5);
        const std::string hash = run(scene, kWays[0]).hash();
        for (const Way& way : kWays) EXPECT_EQ(run(scene, way).hash(), hash) << n << " " << way.travel;
        EXPECT_EQ(simulate(plan_of(scene)).hash(), hash) << "as planned";
    }
}

TEST(Search, EverySearchGivesTheSameBitsInRandomScenes) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        Scene scene = RandomScene(seed).make();
        if (!scene.stop.time) scene.stop.events = 400;
        const std::string hash = run(scene, kWays[0]).hash();
        for (const Way& way : kWays) EXPECT_EQ(run(scene, way).hash(), hash) << "seed " << seed;
    }
}

// For balls that separate forever the search must report no next event.
TEST(Search, BallsThatSeparateForeverEndTheRun) {
    Scene scene = frictionless();
    for (int i = 0; i < 6; ++i) {
        const SinCos away = sin_cos_deg(60.0 * i);
        add_ball(scene, std::to_string(i), away.cos, away.sin, away.cos, away.sin);
    }
    // Two side by side stay near each other forever.
    add_ball(scene, "left", 0.0, 0.0, 0.1, 0.1);
    add_ball(scene, "right", 0.05, -0.05, 0.1, 0.1);
    for (const Way& way : kWays) {
        const Record record = run(scene, way);
        EXPECT_EQ(record.stopped, StopReason::kEndless);
        EXPECT_TRUE(record.events.empty());
    }
}

TEST(Search, ThePlanChoosesByCount) {
    EXPECT_EQ(plan_of(gas(16, 10, 1)).ball_search, Search::kDirect);
    EXPECT_EQ(plan_of(gas(16, 10, 1)).box_travel, kInfinity);
    const Plan many = plan_of(gas(static_cast<int>(kTreeFromBalls), 10, 1));
    EXPECT_EQ(many.ball_search, Search::kTree);
    EXPECT_EQ(many.table_search, Search::kDirect);
    EXPECT_EQ(many.box_travel, kBoxTravel);
}

}  // namespace
}  // namespace carom
