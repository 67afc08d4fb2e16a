#include "loop/clusters.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "contact/place.h"
#include "contact/touch.h"

namespace carom {

namespace {

// [reach] Contacts with a smaller gap count fully in the scale of a cluster.
constexpr double kNearShare = 0.5;
// [reach] Contacts up to this gap are listed, because balls may close it during the cluster.
constexpr double kListed = 8.0;
// [contact time] A cluster that would last longer is instantaneous: its balls would travel too far on
// straight paths.
constexpr double kLongest = 20.0;
// Most balls that may join a cluster because one of its balls would hit them.
constexpr std::size_t kMostJoin = 4;
// [approach speed] After a cluster, slower closing is rounding.
constexpr double kClosesStill = 1e-12;

/// For balls on the cloth, ignores the height at which the fall of one began; unlike balls touch above or
/// below their equators.
Touch touch_of(const ClusterBall& p, const ClusterBall& q, bool in_space, bool discs) {
    const auto at = [&](const ClusterBall& b) {
        if (in_space) return BallAt{b.r, b.v, b.R};
        return BallAt{{b.r.x(), b.r.y(), discs ? 0.0 : b.R}, {b.v.x(), b.v.y(), 0.0}, b.R};
    };
    return touch_ball(at(p), at(q));
}

// Falls smoothly from 1 for near balls to 0 at the edge of reach.
double nearness(double gap, double reach) {
    const double part = reach > 0.0 ? gap / reach : 0.0;
    if (!(part > kNearShare)) return 1.0;
    if (!(part < 1.0)) return 0.0;
    const double t = (part - kNearShare) / (1.0 - kNearShare);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

}  // namespace

Clusters::Clusters(const Plan& plan, const Balls& balls, const Detector& detector, ClustersMemory& memory)
    : Borrowed(memory),
      plan_(plan),
      flights_(plan.in_force(Effect::kAirborne)),
      balls_(balls),
      detector_(detector) {}

// Whether one of two balls falls into a pocket and cannot touch the other in the plane.
bool Clusters::passes(int a, int b) const {
    return flights_ && (balls_.sinks(a) || balls_.sinks(b)) && balls_.in_space(a, b);
}

ClusterBall Clusters::member(int ball) const {
    const BallSize& size = plan_.sizes[ball];
    const double mass = size.m / plan_.balls.m;
    if (flights_ && flies(balls_.segment(ball).state)) {
        const Placed at = balls_.placed(ball);
        return {ball, at.position, at.velocity, balls_.spin(ball), size.R, mass};
    }
    return {ball, balls_.position(ball), balls_.velocity(ball), balls_.spin(ball), size.R, mass};
}

// Breadth-first search from the pair: finds every ball within reach during the contact (equation 5), then all
// contacts between them. The fastest approach among near balls sets the scale of the solution, because a pair
// may touch very slowly while its neighbours are about to collide at full speed. Each approach is weighted by
// nearness, so that the result does not jump when a fast ball comes within reach.
double Clusters::collect(int a, int b, double v_n, bool pair) {
    pair_ = pair;
    first_ = a;
    second_ = b;
    joined_.clear();
    for (;;) {
        collect_at(a, b, v_n);
        double fastest = v_n;
        for (const ClusterContact& c : contacts_) {
            const ClusterBall &p = members_[c.i], &q = members_[c.j];
            fastest = std::max(fastest, c.nearness * dot3(c.n, p.v - q.v));
        }
        if (members_.size() < 3 || !(fastest > kClusterFaster * v_n)) break;
        v_n = fastest;
    }
    return v_n;
}

// Overlaps the box of every ball within `gap` of this one: a ball's box contains its present position, and
// the margin covers rounding.
Box Clusters::near_box(const ClusterBall& ball, double gap) const {
    const double x = ball.r.x(), y = ball.r.y();
    const double half =
        (balls_.radius(ball.ball) + gap) * (1.0 + kBoxShare) + kBoxShare * (std::abs(x) + std::abs(y));
    return {x - half, y - half, x + half, y + half};
}

void Clusters::collect_at(int a, int b, double v_n) {
    const double time = plan_.clusters == ClusterModel::kCompliant
                            ? contact_time(v_n) * pair_softness(plan_.sizes[a], plan_.sizes[b],
                                                                {plan_.balls.R, plan_.balls.m})
                            : 0.0;
    contact_time_ = time;
    const auto reach = [&](const Touch& near) { return time * (std::max(0.0, near.closing) + v_n); };
    const auto gap_of = [this](const ClusterBall& p, const ClusterBall& q) {
        Touch near = touch_of(p, q, flights_, plan_.balls.discs());
        // Only here is it decided whether balls touch: a gap within the rounding of the positions counts as
        // touching.
        if (near.gap <= kTouchUlp * std::max(p.R, q.R)) near.gap = 0.0;
        return near;
    };
    members_.clear();
    contacts_.clear();
    members_.push_back(member(a));
    members_.push_back(member(b));
    for (const int ball : joined_) members_.push_back(member(ball));
    for (std::size_t k = 0; k < members_.size(); ++k) {
        const ClusterBall here = members_[k];
        const double speed = here.v.z() == 0.0 ? length(planar(here.v)) : length3(here.v);
        const double most = time * (speed + detector_.fastest() + v_n);
        // The order is arbitrary: it does not affect the set of members, which are sorted below.
        detector_.balls_near(near_box(here, most), [&](int q) {
            // A ball of another cluster is compressed; its other contacts wait for the end of that cluster.
            if (is_member(q) || balls_.collides(q) || passes(here.ball, q)) return;
            ++looks_;
            const ClusterBall candidate = member(q);
            const Touch near = gap_of(here, candidate);
            if (near.gap <= reach(near)) members_.push_back(candidate);
        });
    }
    unlike_ = std::any_of(members_.begin(), members_.end(),
                          [&](const ClusterBall& m) { return !(plan_.sizes[m.ball] == plan_.sizes[a]); });
    in_space_ = flights_ && (plan_.ball_ball->free ||
                             std::any_of(members_.begin(), members_.end(), [this](const ClusterBall& m) {
                                 return flies(balls_.segment(m.ball).state);
                             }));
    if (members_.size() < 3 && !pair_) return;
    std::sort(members_.begin(), members_.end(), [](const ClusterBall& p, const ClusterBall& q) {
        const Vec2 here = planar(p.r), there = planar(q.r);
        return here == there ? p.r.z() < q.r.z() : before_place(here, there);
    });
    for (std::size_t i = 0; i < members_.size(); ++i) {
        for (std::size_t j = i + 1; j < members_.size(); ++j) {
            const Touch near = gap_of(members_[i], members_[j]);
            if (!passes(members_[i].ball, members_[j].ball) && near.gap <= kListed * reach(near))
                contacts_.push_back({static_cast<int>(i), static_cast<int>(j), near.n, near.gap,
                                     nearness(near.gap, reach(near))});
        }
    }
    // Sort by position. Insertion sort is stable and allocates no memory.
    const auto place = [this](const ClusterContact& c) {
        return Vec2(planar(members_[c.i].r) + planar(members_[c.j].r));
    };
    for (auto here = contacts_.begin(); here != contacts_.end(); ++here) {
        const auto to = std::upper_bound(contacts_.begin(), here, *here,
                                         [&place](const ClusterContact& p, const ClusterContact& q) {
                                             return before_place(place(p), place(q));
                                         });
        std::rotate(to, here, here + 1);
    }
}

// Positions of the balls at the end of the cluster, when no two of them overlap.
// @return false: the balls must stay in place
bool Clusters::find_paths() {
    double duration = map_.duration();
    paths_.clear();
    for (std::size_t k = 0; k < members_.size(); ++k) paths_.push_back(planar(map_.moved(k)));
    while (const double more = overlap_ends()) {
        duration += more;
        if (!(duration <= kLongest * contact_time_)) break;
        for (std::size_t k = 0; k < members_.size(); ++k) paths_[k] += more * planar(members_[k].v);
    }
    obstacle_ = kTable;
    if (!(duration <= kLongest * contact_time_)) return false;
    duration_ = duration;
    obstacle_ = find_obstacle();
    if (obstacle_ != kNone) duration_ = 0.0;
    return duration_ > 0.0;
}

// [s] Time until balls that overlap at the ends of their paths no longer do; 0: none overlap.
double Clusters::overlap_ends() const {
    double longest = 0.0;
    for (std::size_t i = 0; i < members_.size(); ++i) {
        for (std::size_t j = i + 1; j < members_.size(); ++j) {
            const ClusterBall &p = members_[i], &q = members_[j];
            const Vec2 apart = planar(q.r) + paths_[j] - planar(p.r) - paths_[i];
            const double distance = length(apart), most = contact_distance(p.R, q.R, plan_.balls.discs());
            if (!(distance < most - kTouchUlp * std::max(p.R, q.R))) continue;
            const double opens = dot(apart, planar(q.v) - planar(p.v)) / distance;
            if (!(opens > 0.0)) return kNever;
            longest = std::max(longest, (most - distance) / opens * (1.0 + kBoxShare));
        }
    }
    return longest;
}

// Returns the first ball that a member hits on its path, kTable or kNone. A ball that no cluster may include
// counts as the table.
int Clusters::find_obstacle() const {
    int found = kNone;
    for (std::size_t k = 0; k < members_.size() && found != kTable; ++k) {
        const ClusterBall& ball = members_[k];
        const Vec2& path = paths_[k];
        detector_.parts_near(near_box(ball, length(path)), [&](const Contact&) { found = kTable; });
        const double most = length(path) + duration_ * detector_.fastest();
        detector_.balls_near(near_box(ball, most), [&](int q) {
            const auto is_before = [this](int one, int two) {
                return before_place(planar(balls_.position(one)), planar(balls_.position(two)));
            };
            if (found == kTable || is_member(q) || has_room(ball, path, q)) return;
            const bool joins = !balls_.collides(q) && !balls_.segment(q).held && !balls_.sinks(q) &&
                               !flies(balls_.segment(q).state);
            found = !joins ? kTable : found == kNone || is_before(q, found) ? q : found;
        });
    }
    return found;
}

bool Clusters::is_member(int ball) const {
    return std::any_of(members_.begin(), members_.end(),
                       [ball](const ClusterBall& m) { return m.ball == ball; });
}

// Whether a ball on its path misses another one that continues its present motion.
bool Clusters::has_room(const ClusterBall& ball, const Vec2& path, int other) const {
    const Segment& s = balls_.segment(other);
    if (is_gone(s.state)) return true;
    const Vec2 apart = planar(balls_.position(other)) - planar(ball.r);
    double touching = (ball.R + balls_.radius(other)) * (1.0 + kBoxShare);
    touching += 0.5 * duration_ * duration_ * length(s.a);
    if (balls_.collides(other) || s.held) {
        // The other one may leave its cluster, or be pushed by other balls.
        double speed = length(planar(balls_.velocity(other)));
        if (!s.held) speed = std::max(speed, length(planar(balls_.afterwards(other).v)));
        return length(apart) > touching + length(path) + duration_ * speed;
    }
    const Vec2 relative = duration_ * planar(balls_.velocity(other)) - path;
    const double whole = dot(relative, relative),
                 share = whole > 0.0 ? std::clamp(-dot(apart, relative) / whole, 0.0, 1.0) : 0.0;
    return length(apart + share * relative) > touching;
}

// In an instantaneous cluster, the solution moves the balls, but they stay in place. In the solution, a
// glancing contact with a fast slip opens almost without force, because its normal turns while the balls pass
// each other. In place they still approach, and the same cluster would recur ten thousand times. Then solve
// again with fixed normals, as in an impact of two balls.
bool Clusters::closes_still(double v_n) const {
    return std::any_of(contacts_.begin(), contacts_.end(), [&](const ClusterContact& c) {
        return c.gap == 0.0 && dot3(c.n, members_[c.i].v - members_[c.j].v) > kClosesStill * v_n;
    });
}

std::int64_t Clusters::resolve(double v_n, bool friction, bool may_last) {
    duration_ = 0.0;
    const BallParams& p = plan_.balls;
    ClusterSettings settings{
        .R = unlike_ ? p.R : balls_.radius(members_.front().ball),
        .mu_s = plan_.ball_ball->reads_cloth ? p.mu_s : 0.0,
        .mu_b = friction ? p.mu_b : 0.0,
        .e_b = plan_.e_b(),
        .published_cloth_slip = plan_.scene.physics.cloth_slip == kernel::ClothSlip::kAsPublished,
        .epsilon = kClusterEpsilon,
        .tolerance = plan_.cluster_tolerance,
        .integrate = plan_.contact_phase,
        .mu_b_more = friction ? p.mu_b_more : 0.0,
        .mu_b_fall = p.mu_b_fall,
        .slide = p.rolls() ? plan_.motion.front().slide : 0.0,
        .unlike = unlike_};
    if (plan_.clusters == ClusterModel::kRigid) return rigid(settings);
    const auto run = [&] { return map_.compliant(members_, contacts_, settings, v_n, !in_space_); };
    // A falling ball, or one in space, would move up or down during the cluster, and resting contacts would
    // push other balls meanwhile.
    may_last &= !in_space_ && std::none_of(members_.begin(), members_.end(), [this](const ClusterBall& m) {
        return balls_.sinks(m.ball) || balls_.segment(m.ball).held;
    });
    std::int64_t steps = run();
    if (steps >= 0 && may_last) {
        if (find_paths()) return steps;
        // A ball that is hit meanwhile joins. If that does not help, the cluster is instantaneous and the
        // ball is hit afterwards.
        while (obstacle_ != kTable && joined_.size() < kMostJoin) {
            joined_.push_back(obstacle_);
            collect_at(first_, second_, v_n);
            const std::int64_t more = unlike_ == settings.unlike && !in_space_ ? run() : -1;
            if (more < 0) break;
            steps += more;
            if (find_paths()) return steps;
        }
        if (!joined_.empty()) {
            joined_.clear();
            collect_at(first_, second_, v_n);
            steps += run();
        }
    }
    if (steps >= 0 && closes_still(v_n)) {
        settings.turns = false;
        const std::int64_t more = run();
        steps = more < 0 ? more : steps + more;
    }
    // Friction and a wedge can press balls together without end: then resolve the cluster as rigid.
    return steps < 0 ? rigid(settings) : steps;
}

// Balls on the cloth push each other in the plane, whatever the tilt of their normals.
std::int64_t Clusters::rigid(const ClusterSettings& settings) {
    ClusterSettings without = settings;
    without.e_b = plan_.balls.e_b;
    if (unlike_ && !in_space_) {
        for (ClusterContact& c : contacts_) {
            const Vec2 n = planar(c.n);
            c.n = Vec3(n.x(), n.y(), 0.0) / length(n);
        }
    }
    return map_.rigid(members_, contacts_, without);
}

}  // namespace carom
