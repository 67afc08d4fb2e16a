// Cluster members: the boxes find the same balls as a full scan, in any order, and an impact among thousands
// examines no more balls than one among a hundred.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "carom/engine/tolerances.h"
#include "loop/run.h"
#include "physics/cluster.h"
#include "physics/motion.h"
#include "support/gas.h"

namespace carom {
namespace {

using namespace test;

/// A crowd of n balls (n a square) with gaps of about a third of a radius; some fast, some slow, some at
/// rest.
Scene crowd(int n, long events, std::uint64_t seed, bool friction) {
    Scene scene = friction ? empty_scene() : frictionless();
    scene.stop.events = events;
    int side = 1;
    while (side * side < n) ++side;
    const double R = scene.balls.R, cell = 2.3 * R;
    scene.table = box(cell * side, cell * side, 0.036576);
    Generator rng(seed);
    for (int i = 0; i < n; ++i) {
        const int column = i % side, row = i / side;
        const double x = cell * (column + rng.uniform(0.44, 0.56));
        const double y = cell * (row + rng.uniform(0.44, 0.56));
        const SinCos way = sin_cos_deg(rng.uniform(0.0, 360.0));
        const double kind = rng.uniform();
        const double speed = kind < 0.3 ? 0.0 : kind < 0.95 ? rng.uniform(0.1, 1.5) : 9.0;
        const double vx = speed * way.cos, vy = speed * way.sin;
        add_ball(scene, std::to_string(i + 1), x, y, vx, vy, rolling_spin(vx, vy, R));
    }
    return scene;
}

/// A ball as it enters an event.
struct Comer {
    Vec2 r, v;
    bool collides;  ///< in an earlier cluster, which still lasts
};

/// The cluster rule of docs/reference/physics.md, applied by examining every ball.
class FullScan {
  public:
    FullScan(const Record& record, double R) : R_(R), now_(record.tracks.size()), tracks_(record.tracks) {}

    /// Advances to `time`; call it in the order of events.
    void go_to(double time) {
        balls_.clear();
        for (std::size_t i = 0; i < now_.size(); ++i) {
            const std::vector<Segment>& list = tracks_[i].segments;
            while (now_[i] + 1 < list.size() && list[now_[i] + 1].start < time) ++now_[i];
            const Segment& s = list[now_[i]];
            const bool collides = s.state == MotionState::kColliding;
            const Vec3 v = collides ? list[now_[i] + 1].v : velocity_at(s, time - s.start);
            balls_.push_back(
                {planar(position_at(s, time - s.start)), planar(v), collides && time < s.start + s.duration});
        }
    }

    std::vector<int> members(int a, int b) const {
        double v_n = closing(a, b);
        for (;;) {
            const double time = contact_time(v_n);
            std::vector<int> list{a, b};
            for (std::size_t k = 0; k < list.size(); ++k)
                for (int q = 0; q < static_cast<int>(balls_.size()); ++q)
                    if (std::find(list.begin(), list.end(), q) == list.end() && !at(q).collides &&
                        gap(list[k], q) <= time * (std::max(0.0, closing(list[k], q)) + v_n))
                        list.push_back(q);
            double fastest = v_n;
            for (std::size_t i = 0; list.size() > 2 && i < list.size(); ++i)
                for (std::size_t j = i + 1; j < list.size(); ++j)
                    fastest =
                        std::max(fastest, nearness(gap(list[i], list[j]),
                                                   time * (std::max(0.0, closing(list[i], list[j])) + v_n)) *
                                              closing(list[i], list[j]));
            std::sort(list.begin(), list.end());
            if (!(fastest > kClusterFaster * v_n)) return list;
            v_n = fastest;
        }
    }

  private:
    const Comer& at(int ball) const { return balls_[ball]; }
    double gap(int p, int q) const {
        const double left = length(at(q).r - at(p).r) - 2.0 * R_;
        return left <= kTouchUlp * R_ ? 0.0 : left;
    }
    /// 1 up to half the reach, then falling to 0.
    static double nearness(double gap, double reach) {
        const double t = std::clamp(2.0 * gap / reach - 1.0, 0.0, 1.0);
        return 1.0 - t * t * (3.0 - 2.0 * t);
    }
    double closing(int p, int q) const {
        const Vec2 apart = at(q).r - at(p).r;
        return (apart / length(apart)).dot(at(p).v - at(q).v);
    }

    double R_;
    std::vector<std::size_t> now_;
    const std::vector<BallTrack>& tracks_;
    std::vector<Comer> balls_;
};

TEST(ClusterSearch, FindsTheBallsOfAFullScan) {
    for (const bool friction : {false, true}) {
        for (const int n : {25, 400, 3969}) {
            const Scene scene = crowd(n, 2000, 17, friction);
            Plan plan = plan_of(scene);
            plan.box_travel = 0.1;  // boxes that hardly predict a ball's path
            const Record record = simulate(plan);
            FullScan scan(record, scene.balls.R);
            std::size_t pairs = 0, clusters = 0, joined = 0;
            for (std::size_t k = 0; k < record.events.size(); ++k) {
                const Event& e = record.events[k];
                const bool cluster = e.type == EventType::kBallCluster;
                if (!cluster && e.type != EventType::kBallBall) continue;
                // The record does not order events at one instant.
                if (k > 0 && record.events[k - 1].time == e.time) continue;
                scan.go_to(e.time);
                std::vector<int> took_part{std::min(e.a, e.b), std::max(e.a, e.b)};
                if (cluster) took_part = record.clusters[e.detail].balls;
                std::sort(took_part.begin(), took_part.end());
                const std::vector<int> found = scan.members(e.a, e.b);
                // Balls that a cluster member would meet during the cluster join it.
                if (took_part.size() > found.size() && found.size() > 2) {
                    ASSERT_TRUE(std::includes(took_part.begin(), took_part.end(), found.begin(), found.end()))
                        << n << " balls, event " << k;
                    ++joined;
                } else {
                    ASSERT_EQ(took_part, found) << n << " balls, event " << k;
                }
                ++(cluster ? clusters : pairs);
            }
            EXPECT_GT(pairs, 50u) << n;
            EXPECT_GT(clusters, 20u) << n;
            EXPECT_LT(joined, clusters / 4) << n;
        }
    }
}

TEST(ClusterSearch, EverySearchGivesTheSameBits) {
    for (const int n : {25, 400, 900}) {
        const Scene scene = crowd(n, 2000, 3, true);
        Plan plan = plan_of(scene);
        const std::string hash = simulate(plan).hash();
        for (const Search search : {Search::kDirect, Search::kTree}) {
            for (const double travel : {0.5, kBoxTravel, kNever}) {
                plan.ball_search = search;
                plan.box_travel = travel;
                EXPECT_EQ(simulate(plan).hash(), hash) << n << " " << travel;
            }
        }
    }
}

// Ties are decided by place, so reordered balls give the same shot.
TEST(ClusterSearch, TheOrderOfTheBallsDoesNotMatter) {
    Scene scene = crowd(900, 2000, 5, false);
    const Record one = simulate(plan_of(scene));
    std::reverse(scene.ball.begin(), scene.ball.end());
    const Record other = simulate(plan_of(scene));
    ASSERT_EQ(one.events.size(), other.events.size());
    ASSERT_GT(one.clusters.size(), 50u);
    const auto last = static_cast<int>(scene.ball.size()) - 1;
    for (std::size_t k = 0; k < one.events.size(); ++k) ASSERT_EQ(one.events[k].time, other.events[k].time);
    for (std::size_t c = 0; c < one.clusters.size(); ++c) {
        std::vector<int> mirrored = other.clusters[c].balls;
        for (int& ball : mirrored) ball = last - ball;
        ASSERT_EQ(one.clusters[c].balls, mirrored);
    }
    for (std::size_t i = 0; i < one.tracks.size(); ++i) {
        const Segment &s = one.tracks[i].segments.back(),
                      &q = other.tracks[one.tracks.size() - 1 - i].segments.back();
        ASSERT_EQ(s.r, q.r);
        ASSERT_EQ(s.v, q.v);
    }
}

// Equal balls may share the size of [balls] or each have their own.
TEST(ClusterSearch, UsesTheSizeOfTheBallsThemselves) {
    Scene scene = empty_scene();
    const BallSize large{0.035, 0.2};
    scene.balls.R = large.R;
    scene.balls.m = large.m;
    add_ball(scene, "cue", 0.0, 0.0, 0.0, 2.0);
    add_ball(scene, "a", -0.0351, 0.7);
    add_ball(scene, "b", 0.0351, 0.7);
    const Record one = simulate(plan_of(scene));
    scene.balls = pool_balls();
    for (BallStart& ball : scene.ball) ball.own = large;
    const Record other = simulate(plan_of(scene));
    ASSERT_EQ(one.clusters.size(), 1u);
    EXPECT_EQ(other.clusters[0].balls, one.clusters[0].balls);
    EXPECT_EQ(other.hash(), one.hash());
}

/// Average number of balls that an impact examines besides its own two.
double looks_per_impact(const Scene& scene) {
    const Plan plan = plan_of(scene);
    const SimulateOptions options;
    RunBuffers::Memory memory;
    Run run(plan, options, memory);
    const Record record = run.simulate();
    const auto impacts = std::count_if(record.events.begin(), record.events.end(),
                                       [](const Event& e) { return balls_collide(e.type); });
    EXPECT_GT(impacts, 500);
    return static_cast<double>(run.clusters().looks()) / static_cast<double>(impacts);
}

TEST(ClusterSearch, WorkPerImpactDoesNotGrowWithTheBalls) {
    std::vector<double> dense, thin;
    for (const int n : {100, 400, 1600, 4096}) {
        dense.push_back(looks_per_impact(crowd(n, 2000, 11, false)));
        Scene scene = gas(n, 2000, 11);
        scene.physics.clusters = ClusterModel::kCompliant;
        thin.push_back(looks_per_impact(scene));
        report("looks an impact, dense", dense.back());
        report("looks an impact, thin", thin.back());
        // A fitting ball has six neighbours, a pair eight; boxes are wider than balls.
        EXPECT_LT(dense.back(), 60.0) << n;
        EXPECT_LT(thin.back(), 4.0) << n;
    }
    EXPECT_LT(dense.back(), 1.5 * dense.front());
    EXPECT_LT(thin.back(), 1.5 * thin.front());
}

}  // namespace
}  // namespace carom
