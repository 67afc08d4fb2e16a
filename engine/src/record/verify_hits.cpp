// Whether the hits that a record lists for a cluster explain the motion of its balls.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "carom/engine/event_details.h"
#include "record/verify_parts.h"

namespace carom {
namespace {

// [-] Share of the possible motion of balls that may be a detour. [-] Error of the impulse of a hit.
constexpr double kTurns = 0.5, kHistory = 0.02;
// [V] A fainter touch may leave no hit.
constexpr double kFaint = 1e-7;

/// The momentum that hits give a ball, in units of the mass in [balls].
struct Given {
    Vec3 change = Vec3::Zero(), expected = change;  // [m/s]
    // [m/s] The impulses, the uncertainty of their normals, and of cushions.
    double sum = 0.0, slack = 0.0, open = 0.0;
    Vec3 from = change, path = change;  // [m]
    double mass = 0.0;                  // 0: no member
    double speeds = 0.0, fast = 0.0;    // with spins, and without
};

class Hits {
  public:
    Hits(const Record& record, const Plan& plan, const Event& cluster, double lasts, double time)
        : record_(record),
          plan_(plan),
          cluster_(cluster),
          lasts_(lasts),
          time_(time),
          given_(record.tracks.size()) {}

    std::optional<HitFault> check(std::span<const ClusterMove> moves, bool known) {
        for (const ClusterMove& move : moves) add(move);
        const std::span<const Hit> hits = record_.hits(cluster_);
        // A record before version 4 shows only which balls met first.
        if (hits.size() == 1 && hits[0].impulse == 0.0) return std::nullopt;
        double before = cluster_.time;
        for (const Hit& hit : hits) {
            if (!is_possible(hit, before))
                return HitFault{"U6", "a hit of the cluster is of another ball or another time"};
            before = hit.time;
            give(hit);
        }
        return known ? compare(moves) : std::nullopt;
    }

  private:
    Given& of(int ball) { return given_[static_cast<std::size_t>(ball)]; }

    void add(const ClusterMove& move) {
        const BallSize& size = plan_.sizes[static_cast<std::size_t>(move.ball)];
        Given& g = of(move.ball);
        g.mass = size.m / record_.balls.m;
        g.change = g.mass * (move.end.velocity - move.before.velocity);
        g.from = move.before.position;
        if (lasts_ > 0.0) g.path = move.end.position - g.from;
        g.fast = length3(move.before.velocity) + length3(move.end.velocity);
        g.speeds = g.fast + move.spin;
        // Friction of a cushion acts along it, at any speed that the other hits gave.
        for (const Hit& hit : record_.hits(cluster_))
            if (hit.partner != Partner::kBall && hit.a == move.ball) g.open += g.mass * g.speeds;
    }

    bool is_possible(const Hit& hit, double earliest) {
        const bool pair = hit.partner == Partner::kBall;
        return hit.time >= earliest && hit.time <= cluster_.time + lasts_ + same_time(cluster_.time) &&
               of(hit.a).mass > 0.0 && !(pair && (hit.a == hit.b || of(hit.b).mass == 0.0));
    }

    void give(const Hit& hit) {
        const double J = hit.impulse / record_.balls.m,
                     share = lasts_ > 0.0 ? (hit.time - cluster_.time) / lasts_ : 0.0;
        Given& one = of(hit.a);
        const Vec3 here = one.from + share * one.path;
        one.sum += J;
        if (hit.partner == Partner::kNone) return;
        if (hit.partner != Partner::kBall) {
            const Vec2 n = cushion_point(record_.table, hit.partner, hit.b, planar(here)).normal;
            one.expected += J * Vec3(n.x(), n.y(), 0.0);
            return;
        }
        Given& two = of(hit.b);
        Vec3 apart = two.from + share * two.path - here;
        if (record_.balls.discs()) apart.z() = 0.0;
        const double distance = length3(apart);
        const Vec3 push = J / distance * apart;
        one.expected -= push;
        two.expected += push;
        two.sum += J;
        // The normal turns while they move past each other, as far as their paths lead, or on a detour. A
        // rigid cluster pushes balls on the cloth in the plane, at any tilt of their normals.
        const double past = std::max(length3(two.path - one.path), kTurns * time_ * (one.fast + two.fast));
        const double slack =
            std::min(1.0, past / distance) + kHistory + 1.0 - length(planar(apart)) / distance;
        one.slack += slack * J;
        two.slack += slack * J;
    }

    std::optional<HitFault> compare(std::span<const ClusterMove> moves) {
        double fastest = 0.0;
        for (const ClusterMove& move : moves) {
            Given& g = of(move.ball);
            fastest = std::max(fastest, g.fast);
            if (g.open > 0.0) g.open += g.sum;
        }
        const double error = (2.0 * plan_.cluster_tolerance + kFaint) * fastest;
        Given all;
        for (const ClusterMove& move : moves) {
            const Given& g = of(move.ball);
            if (lasts_ > 0.0 || g.sum == 0.0)
                if (auto fault = left(move.ball, g, g.slack + most_friction() * g.sum + g.mass * error))
                    return fault;
            all.change += g.change;
            all.expected += g.expected;
            all.sum += 0.5 * g.sum;  // both balls have it
            all.open += g.open;
            all.mass += g.mass;
            all.speeds += g.speeds;
        }
        return left(cluster_.a, all, all.mass * error);
    }

    double most_friction() const {
        const bool friction = plan_.clusters == ClusterModel::kCompliant && plan_.in_force(Effect::kThrow);
        return friction ? plan_.ball_ball->friction(plan_.balls).most() : 0.0;
    }

    /// @param inside  [m/s] uncertainty of the impulses between the balls
    std::optional<HitFault> left(int ball, const Given& g, double inside) const {
        // The line of centres of unlike balls is tilted, and presses one of them on the cloth.
        const auto [least, most] =
            std::minmax_element(plan_.sizes.begin(), plan_.sizes.end(),
                                [](const BallSize& p, const BallSize& q) { return p.R < q.R; });
        const double tilt = (most->R - least->R) / (most->R + least->R);
        const double cloth = 2.0 * plan_.balls.mu_s * (most_friction() + tilt);
        const auto i = static_cast<std::size_t>(ball);
        const double off = length(planar(g.change - g.expected));
        const double allowed = inside + g.open + cloth * g.sum +
                               g.mass * (kSameShare * g.speeds + plan_.motion[i].slide * time_);
        if (!(off > allowed)) return std::nullopt;
        return HitFault{
            "U5", fmt::format(
                      "the hits of the cluster leave {:.3g} m/s of ball {} unexplained (allowed: {:.3g} m/s)",
                      off / g.mass, record_.tracks[i].id, allowed / g.mass)};
    }

    const Record& record_;
    const Plan& plan_;
    const Event& cluster_;
    const double lasts_, time_;
    std::vector<Given> given_;
};

}  // namespace

std::optional<HitFault> verify_hits(const Record& record, const Plan& plan, const Event& cluster,
                                    std::span<const ClusterMove> moves, double lasts, double time,
                                    bool known) {
    return Hits(record, plan, cluster, lasts, time).check(moves, known);
}

}  // namespace carom
