#include "loop/clusters.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "carom/engine/airborne.h"
#include "contact/contact.h"
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
// [contact time] A ball that was pushed into a cushion is waited for as long; a slower one is put at its
// edge.
constexpr double kWaits = 4.0;
// [-] Prolongations until no two balls overlap.
constexpr int kProlongations = 8;
// [approach speed] After a cluster, slower closing is rounding.
constexpr double kClosesStill = 1e-12;
// [strongest impulse] A weaker one is rounding: the balls did not touch.
constexpr double kPushes = 1e-9;

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
    return box_around(planar(ball.r), (balls_.radius(ball.ball) + gap) * (1.0 + kBoxShare) +
                                          kBoxShare * (std::abs(ball.r.x()) + std::abs(ball.r.y())));
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
    pushes_.clear();
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

// Positions of the balls at the end of the cluster, when no two of them overlap, outside of cushions.
// @return false: the balls must stay in place
bool Clusters::find_paths() {
    duration_ = 0.0;
    double duration = map_.duration();
    paths_.clear();
    for (std::size_t k = 0; k < members_.size(); ++k) paths_.push_back(map_.moved(k));
    const auto place = [&] {
        for (std::size_t k = 0; k < members_.size(); ++k) {
            ClusterBall& m = members_[k];
            const Placed at{m.r + paths_[k], m.v};
            const std::optional<Vec3> out = near_.outside(k, m.r, at);
            if (!out) return false;
            paths_[k] = *out - m.r;
            if (in_space_ && near_.lies(m.ball, at)) m.v.z() = 0.0;
        }
        return true;
    };
    if (!place()) return false;
    const double longest = kLongest * contact_time_;
    for (int round = 0; const double more = overlap_ends(); ++round) {
        duration += more;
        // A cushion may bring them together again.
        if (!(duration <= longest) || round == kProlongations) return false;
        for (std::size_t k = 0; k < members_.size(); ++k) {
            ClusterBall& m = members_[k];
            const double pull = near_.lies(m.ball, {m.r + paths_[k], m.v}) ? 0.0 : plan_.gravity;
            paths_[k] += more * m.v - Vec3(0.0, 0.0, 0.5 * pull * more * more);
            m.v.z() -= pull * more;
        }
        if (!place()) return false;
    }
    if (!(duration <= longest)) return false;
    duration_ = duration;
    obstacle_ = find_obstacle();
    return duration_ > 0.0;
}

// [s] Time until balls that overlap at the ends of their paths no longer do; 0: none overlap.
double Clusters::overlap_ends() const {
    double longest = 0.0;
    for (std::size_t i = 0; i < members_.size(); ++i) {
        for (std::size_t j = i + 1; j < members_.size(); ++j) {
            ClusterBall p = members_[i], q = members_[j];
            p.r += paths_[i];
            q.r += paths_[j];
            const Touch ends = touch_of(p, q, in_space_, plan_.balls.discs());
            if (ends.gap >= -kTouchUlp * std::max(p.R, q.R)) continue;
            if (!(ends.closing < 0.0)) return kNever;
            longest = std::max(longest, ends.gap / ends.closing * (1.0 + kBoxShare));
        }
    }
    return longest;
}

// Returns the first ball that a member hits on its path, kNone or kColliding.
int Clusters::find_obstacle() const {
    int found = kNone;
    for (std::size_t k = 0; k < members_.size() && found != kColliding; ++k) {
        const ClusterBall& ball = members_[k];
        const Vec3& path = paths_[k];
        const double most = length(planar(path)) + duration_ * detector_.fastest();
        detector_.balls_near(near_box(ball, most), [&](int q) {
            const auto is_before = [this](int one, int two) {
                return before_place(planar(balls_.position(one)), planar(balls_.position(two)));
            };
            if (found == kColliding || is_member(q) || passes(ball.ball, q) || has_room(ball, path, q))
                return;
            if (balls_.collides(q) || balls_.sinks(q))
                found = kColliding;
            else if (found == kNone || is_before(q, found))
                found = q;
        });
    }
    return found;
}

bool Clusters::is_member(int ball) const {
    return std::any_of(members_.begin(), members_.end(),
                       [ball](const ClusterBall& m) { return m.ball == ball; });
}

// Whether a ball on its path misses another one that continues its present motion.
bool Clusters::has_room(const ClusterBall& ball, const Vec3& path3, int other) const {
    const Vec2 path = planar(path3);
    const Segment& s = balls_.segment(other);
    if (is_gone(s.state)) return true;
    const Vec2 apart = planar(balls_.position(other)) - planar(ball.r);
    double touching = (ball.R + balls_.radius(other)) * (1.0 + kBoxShare);
    touching += 0.5 * duration_ * duration_ * length(s.a);
    if (balls_.collides(other)) {
        // It may leave its cluster.
        const double speed =
            std::max(length(planar(balls_.velocity(other))), length(planar(balls_.afterwards(other).v)));
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
    near_.forget();
    ClusterSettings settings{
        .R = p.R,
        .mu_s = plan_.ball_ball->reads_cloth ? p.mu_s : 0.0,
        .mu_b = friction ? p.mu_b : 0.0,
        .e_b = plan_.e_b(),
        .published_cloth_slip = plan_.scene.physics.cloth_slip == kernel::ClothSlip::kAsPublished,
        .epsilon = kClusterEpsilon,
        .tolerance = plan_.cluster_tolerance,
        .integrate = plan_.contact_phase,
        .mu_b_more = friction ? p.mu_b_more : 0.0,
        .mu_b_fall = p.mu_b_fall,
        .slide = p.rolls() ? plan_.motion.front().slide : 0.0};
    if (plan_.clusters == ClusterModel::kRigid) return rigid(settings);
    // A ball that falls into a pocket would move down during the cluster.
    may_last &= std::none_of(members_.begin(), members_.end(),
                             [this](const ClusterBall& m) { return balls_.sinks(m.ball); });
    std::int64_t steps = may_last ? integrate(settings, v_n) : -1;
    // A ball that is hit meanwhile joins.
    while (steps >= 0 && find_paths()) {
        if (obstacle_ == kNone) return steps;
        if (obstacle_ == kColliding) break;
        joined_.push_back(obstacle_);
        collect_at(first_, second_, v_n);
        const std::int64_t more = integrate(settings, v_n);
        steps = more < 0 ? more : steps + more;
    }
    // Without time the balls stay in place, and nothing else joins.
    duration_ = 0.0;
    joined_.clear();
    if (may_last) collect_at(first_, second_, v_n);
    near_.forget();
    settings.slide = 0.0;  // the weight needs time
    steps = compliant(settings, v_n);
    if (steps >= 0 && closes_still(v_n)) {
        settings.turns = false;
        const std::int64_t more = compliant(settings, v_n);
        steps = more < 0 ? more : steps + more;
    }
    // Friction and a wedge can press balls together without end: then resolve the cluster as rigid.
    return steps < 0 ? rigid(settings) : steps;
}

// The motion of a cluster that lasts, with the parts of the table that its balls may reach.
std::int64_t Clusters::integrate(const ClusterSettings& settings, double v_n) {
    const double longest = kLongest * contact_time_;
    near_.begin(members_, in_space_, kWaits * contact_time_);
    // A slipping ball may gain speed from the cloth.
    double fastest = v_n;
    for (const ClusterBall& m : members_) fastest = std::max(fastest, length3(m.v));
    fastest += settings.slide * longest;
    for (std::size_t k = 0; k < members_.size(); ++k)
        detector_.parts_near(near_box(members_[k], fastest * longest), [&](const Contact& part) {
            if (part.is_nose()) near_.add(k, part);
        });
    near_.sort();
    ClusterSettings with = settings;
    with.longest = longest;
    if (in_space_) {
        with.gravity = plan_.gravity;
        with.hop = bounce_end(plan_.balls.R, plan_.gravity);
    }
    if (near_.any()) with.surfaces = &near_;
    return compliant(with, v_n);
}

// The settings for the balls of the last collect_at().
ClusterSettings Clusters::of_members(ClusterSettings settings) const {
    settings.unlike = unlike_;
    if (!unlike_) settings.R = balls_.radius(members_.front().ball);
    return settings;
}

std::int64_t Clusters::compliant(const ClusterSettings& settings, double v_n) {
    const std::int64_t steps = map_.compliant(members_, contacts_, of_members(settings), v_n, !in_space_);
    if (steps >= 0) add_pushes();
    return steps;
}

void Clusters::add_pushes() {
    pushes_.resize(contacts_.size());
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
        const ClusterPush& push = map_.pushes()[c];
        if (pushes_[c].first < 0.0) pushes_[c].first = push.first;
        pushes_[c].impulse += push.impulse;
    }
}

// If a contact changed no speed by more than rounding, the balls did not touch.
const std::vector<Hit>& Clusters::hits() {
    double strongest = 0.0;
    for (const ClusterPush& push : pushes_) strongest = std::max(strongest, push.impulse);
    hits_.clear();
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
        const ClusterPush& push = pushes_[c];
        if (push.first < 0.0 || !(push.impulse > kPushes * strongest)) continue;
        // An instant has no course.
        const double first = duration_ > 0.0 ? push.first : 0.0;
        hits_.push_back({balls_.now() + first, members_[contacts_[c].i].ball, Partner::kBall,
                         members_[contacts_[c].j].ball, plan_.balls.m * push.impulse});
    }
    for (Hit hit : near_.hits()) {
        hit.time += balls_.now();
        hits_.push_back(hit);
    }
    // Of simultaneous ones the order stays. Insertion sort is stable and allocates no memory.
    for (auto here = hits_.begin(); here != hits_.end(); ++here) {
        const auto to = std::upper_bound(hits_.begin(), here, *here,
                                         [](const Hit& p, const Hit& q) { return p.time < q.time; });
        std::rotate(to, here, here + 1);
    }
    return hits_;
}

// Balls on the cloth push each other in the plane, whatever the tilt of their normals.
std::int64_t Clusters::rigid(const ClusterSettings& settings) {
    ClusterSettings without = of_members(settings);
    without.e_b = plan_.balls.e_b;
    if (unlike_ && !in_space_) {
        for (ClusterContact& c : contacts_) {
            const Vec2 n = planar(c.n);
            c.n = Vec3(n.x(), n.y(), 0.0) / length(n);
        }
    }
    const std::int64_t steps = map_.rigid(members_, contacts_, without);
    add_pushes();
    return steps;
}

}  // namespace carom
