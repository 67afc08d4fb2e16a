// Ball-ball impacts with a third ball within reach: one event for the whole cluster.
#include <algorithm>
#include <array>
#include <cmath>

#include "loop/shot.h"

namespace carom {

namespace {

// An order of places that mirrors in the axes and quarter turns keep, up to the order of mirror images among
// themselves: so do the sums of a cluster, to the last bit.
bool before_place(const Vec2& p, const Vec2& q) {
    const auto key = [](const Vec2& a) {
        const double x = std::abs(a.x()), y = std::abs(a.y());
        return std::array<double, 4>{std::max(x, y), std::min(x, y), a.y(), a.x()};
    };
    return key(p) < key(q);
}

// Gap of two balls and the speed at which it closes.
struct Nearness {
    double gap, closing;
    Vec2 n;
};

Nearness nearness(const ClusterBall& p, const ClusterBall& q, double R) {
    const Vec2 apart = planar(q.r) - planar(p.r);
    const double distance = length(apart);
    Nearness near{distance - 2.0 * R, 0.0, apart / distance};
    // Gaps are decided once, here: rounding of the positions counts as touching.
    if (near.gap <= kTouchUlp * R) near.gap = 0.0;
    near.closing = near.n.dot(planar(p.v) - planar(q.v));
    return near;
}

}  // namespace

// Breadth first from the pair: every ball that can be reached while the contact lasts (equation 5); then all
// their contacts. The fastest approach among them sets the scale of the map: a pair may begin to touch very
// slowly while its neighbours are about to meet at full speed.
double Shot::collect_cluster(int a, int b, double v_n) {
    for (;;) {
        collect_cluster_at(a, b, v_n);
        double fastest = v_n;
        for (const ClusterContact& c : cluster_contacts_) {
            const ClusterBall &p = cluster_balls_[c.i], &q = cluster_balls_[c.j];
            fastest = std::max(fastest, c.n.dot(planar(p.v) - planar(q.v)));
        }
        if (cluster_balls_.size() < 3 || !(fastest > kClusterFaster * v_n)) return v_n;
        v_n = fastest;
    }
}

// Whoever is no more than `gap` from the ball has a box that overlaps this one: boxes hold where a ball is
// now, and the share keeps rounding inside.
Box Shot::near_box(const ClusterBall& ball, double gap) const {
    const double x = ball.r.x(), y = ball.r.y();
    const double half =
        (radius(ball.ball) + gap) * (1.0 + kBoxShare) + kBoxShare * (std::abs(x) + std::abs(y));
    return {x - half, y - half, x + half, y + half};
}

void Shot::collect_cluster_at(int a, int b, double v_n) {
    const double R = radius(a);  // alike, but perhaps not those of [balls]
    const double time = plan_.clusters == ClusterModel::kCompliant ? contact_time(v_n) : 0.0;
    const auto reach = [&](const Nearness& near) { return time * (std::max(0.0, near.closing) + v_n); };
    const auto member = [this](int ball) {
        return ClusterBall{ball, position_now(ball), velocity_now(ball), spin_now(ball)};
    };
    cluster_balls_.clear();
    cluster_contacts_.clear();
    cluster_balls_.push_back(member(a));
    cluster_balls_.push_back(member(b));
    for (std::size_t k = 0; k < cluster_balls_.size(); ++k) {
        const ClusterBall here = cluster_balls_[k];
        const double most = time * (length(planar(here.v)) + fastest_ + v_n);
        // In no order; who belongs to the cluster does not depend on it, and the sort below is by place.
        ball_boxes_.overlapping(near_box(here, most), [&](int q) {
            const bool known = std::any_of(cluster_balls_.begin(), cluster_balls_.end(),
                                           [q](const ClusterBall& m) { return m.ball == q; });
            if (known) return;
            ++cluster_looks_;
            const ClusterBall candidate = member(q);
            const Nearness near = nearness(here, candidate, R);
            if (near.gap <= reach(near)) cluster_balls_.push_back(candidate);
        });
    }
    if (cluster_balls_.size() < 3) return;
    std::sort(cluster_balls_.begin(), cluster_balls_.end(), [](const ClusterBall& p, const ClusterBall& q) {
        return before_place(planar(p.r), planar(q.r));
    });
    for (std::size_t i = 0; i < cluster_balls_.size(); ++i) {
        for (std::size_t j = i + 1; j < cluster_balls_.size(); ++j) {
            const Nearness near = nearness(cluster_balls_[i], cluster_balls_[j], R);
            if (near.gap <= 2.0 * reach(near))
                cluster_contacts_.push_back({static_cast<int>(i), static_cast<int>(j), near.n, near.gap});
        }
    }
    // By place; insertion keeps the order of equals and needs no memory.
    const auto place = [this](const ClusterContact& c) {
        return Vec2(planar(cluster_balls_[c.i].r) + planar(cluster_balls_[c.j].r));
    };
    for (auto here = cluster_contacts_.begin(); here != cluster_contacts_.end(); ++here) {
        const auto to = std::upper_bound(cluster_contacts_.begin(), here, *here,
                                         [&place](const ClusterContact& p, const ClusterContact& q) {
                                             return before_place(place(p), place(q));
                                         });
        std::rotate(to, here, here + 1);
    }
}

// A slow cluster may hold a contact that is pressed together, behind the one that met first: held, it drives
// that one too. Bounced off together they would meet again and again.
[[gnu::noinline]] bool Shot::hold_in_cluster(Pressed when) {
    const auto segment = [this](const ClusterBall& b) {
        return start_segment(now_, b.r, b.v, b.w, motion_of(b.ball));
    };
    for (const ClusterContact& c : cluster_contacts_) {
        const ClusterBall &p = cluster_balls_[c.i], &q = cluster_balls_[c.j];
        if (c.gap > 0.0 || held_together(p.ball, q.ball)) continue;
        Nearing pair = nearing(p.ball, q.ball);
        if (when == Pressed::kAfter) pair.a_c = pressing(pair.contact.n, segment(p), segment(q));
        if (pair.v_n > 0.0 && hold_instead(pair.contact, pair.v_n, pair.a_c, plan_.balls.e_b)) return true;
    }
    return false;
}

// The cluster's balls part: not inlined into one of the two loops only.
[[gnu::noinline]] void Shot::end_cluster(const Candidate& c) {
    for (const ClusterBall& ball : cluster_balls_) free_ball(ball.ball);
    for (const ClusterBall& ball : cluster_balls_)
        begin(ball.ball, start_segment(now_, ball.r, ball.v, ball.w, motion_of(ball.ball)));
    record_event(EventType::kBallCluster, c.a, c.b,
                 static_cast<int>(record_.clusters.size() + log_cluster_.size()));
    for (const ClusterBall& ball : cluster_balls_) log_member_.push_back(ball.ball);
    log_cluster_.push_back(log_member_.size());
}

// True if the impact was a cluster's, or a contact of it is held now; false leaves it to the pair kernel.
template <bool kProfile>
bool Shot::resolve_cluster(const Candidate& c, double v_n) {
    v_n = collect_cluster(c.a, c.b, v_n);
    if (cluster_balls_.size() < 3) return false;
    const bool slow = is_slow(v_n);
    if (slow && hold_in_cluster(Pressed::kBefore)) return true;
    long_round_ = true;
    const BallParams& p = plan_.balls;
    const auto start = kProfile ? Clock::now() : Clock::time_point{};
    long steps;
    if (plan_.clusters == ClusterModel::kRigid) {
        steps = cluster_map_.rigid(cluster_balls_, cluster_contacts_, p.e_b);
    } else {
        const bool frictionless = !plan_.ball_ball->reads_friction;
        const double mu_b = frictionless || !plan_.in_force(Effect::kThrow) ? 0.0 : pair_friction(c.a, c.b);
        const ClusterSettings settings{
            .R = radius(c.a),
            .mu_s = plan_.ball_ball->reads_cloth ? p.mu_s : 0.0,
            .mu_b = mu_b,
            .e_b = frictionless ? 1.0 : p.e_b,
            .published_cloth_slip = plan_.scene.physics.cloth_slip == ClothSlipSign::kAsPublished,
            .epsilon = kClusterEpsilon,
            .longest_step = mu_b > 0.0 ? kClusterFrictionStep : kClusterStep,
            .integrate = plan_.contact_phase};
        steps = cluster_map_.compliant(cluster_balls_, cluster_contacts_, settings, v_n);
        // Friction and a wedge can keep balls pressed together without end: then as if they were rigid.
        if (steps < 0) steps = cluster_map_.rigid(cluster_balls_, cluster_contacts_, p.e_b);
    }
    if constexpr (kProfile) {
        cost_.kernel_ns = nanoseconds(start, Clock::now());
        cost_.steps = steps;
        cost_.method = name(plan_.clusters);
    }
    if (slow && hold_in_cluster(Pressed::kAfter)) return true;
    end_cluster(c);
    return true;
}

// A bound on the speed of every ball that cluster search asks for: speeds are largest at an end of a segment.
// It only grows, for it is no more than a bound; nothing that is computed depends on it.
[[gnu::noinline]] void Shot::bound_speed(const Segment& s) {
    fastest_ = std::max(fastest_, length(planar(s.v)));
    if (s.a == Vec2::Zero()) return;
    fastest_ = std::max(fastest_, s.duration < kNever ? length(planar(velocity_at(s, s.duration))) : kNever);
}

template bool Shot::resolve_cluster<false>(const Candidate&, double);
#ifndef CAROM_WITHOUT_PROFILE
template bool Shot::resolve_cluster<true>(const Candidate&, double);
#endif

}  // namespace carom
