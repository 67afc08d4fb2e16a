// Seeded scenes that provoke trouble: touching balls and racks, balls on cushions and in jaws, extreme spin.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/math.h"
#include "reference/random_impacts.h"
#include "scene/rack.h"
#include "support/hard_scenes.h"

namespace carom::test {
using reference::Generator;

/// The order in which the components of a vector or a speed are drawn. One seed thus defines two scenes, of
/// two otherwise independent families.
enum class DrawOrder { kLastFirst, kFirstFirst };

class RandomScene {
  public:
    explicit RandomScene(std::uint64_t seed, DrawOrder order = DrawOrder::kLastFirst)
        : seed_(seed), rng_(seed), scene_(empty_scene()), order_(order) {}

    Scene make() {
        choose_table();
        choose_physics();
        const int wanted = 1 + whole(22);
        if (wanted >= 11 && scene_.table.width > 0.0 && chance(0.5)) place_rack();
        while (static_cast<int>(scene_.ball.size()) < wanted && tries_++ < 2000) place_one();
        set_in_motion();
        return scene_;
    }

  private:
    double uniform(double lo, double hi) { return rng_.uniform(lo, hi); }
    bool last_first() const { return order_ == DrawOrder::kLastFirst; }
    bool chance(double p) { return uniform(0.0, 1.0) < p; }
    int whole(int n) { return std::min(n - 1, static_cast<int>(uniform(0.0, static_cast<double>(n)))); }
    template <class T>
    T one_of(const std::vector<T>& list) {
        return list[whole(static_cast<int>(list.size()))];
    }

    void choose_table() {
        switch (whole(4)) {
            case 0:
                break;  // endless cloth
            case 1:
                scene_.table = box(1.0, 2.0, 0.036576);
                break;
            default:
                scene_.table = make_table("seven_foot");
                break;
        }
    }

    void choose_physics() {
        BallParams& b = scene_.balls;
        b.mu_s = one_of<double>({0.2, 0.2, 0.05, 0.6});
        b.mu_r = one_of<double>({0.01, 0.01, 0.005, 0.05});
        b.mu_sp = one_of<double>({0.0127, 0.0127, 0.044});
        b.mu_b = one_of<double>({0.05, 0.05, 0.0, 0.2});
        // Every other scene has the default friction of pool tables, which falls with the slip.
        if (b.mu_b == 0.05 && seed_ % 2 == 1) {
            const BallParams pool = make_ball_params("pool");
            b.mu_b = pool.mu_b, b.mu_b_more = pool.mu_b_more, b.mu_b_fall = pool.mu_b_fall;
        }
        b.e_b = one_of<double>({0.95, 0.95, 1.0, 0.5, 0.8});
        b.e_c = one_of<double>({0.85, 0.85, 0.0, 0.5, 1.0});
        b.f_c = one_of<double>({0.2, 0.2, 0.0});
        Physics& p = scene_.physics;
        p.ball_ball = one_of<const BallBallModelInfo*>(
            {&kMathavan, &kMathavan, ball_ball_model("inelastic"), ball_ball_model("elastic")});
        // The published march gains energy by construction if the impact is lossless: 1e-4 of it at N = 1000
        // and e = 1.
        if (p.ball_ball == &kMathavan && b.e_b == 1.0) b.e_b = 0.95;
        p.cushion = chance(0.7) ? &kHan2005 : &kSmooth;
        p.clusters = one_of<ClusterModel>({ClusterModel::kCompliant, ClusterModel::kCompliant,
                                           ClusterModel::kSequential, ClusterModel::kRigid});
    }

    // No overlap with balls, cushions or jaws, and outside the pockets' circles.
    bool fits(const Vec2& r) const {
        const double R = scene_.balls.R;
        const Table& t = scene_.table;
        if (t.width > 0.0 && (r.x() < R - 1e-13 || r.y() < R - 1e-13 || r.x() > t.width - R + 1e-13 ||
                              r.y() > t.length - R + 1e-13))
            return false;
        for (const BallStart& b : scene_.ball)
            if ((Vec2(b.position.x(), b.position.y()) - r).norm() < 2.0 * R - 1e-14) return false;
        for (const Jaw& j : t.jaws)
            if ((j.center - r).norm() < R + j.radius - 1e-14) return false;
        for (const Pocket& p : t.pockets)
            if ((p.center - r).norm() < p.radius) return false;
        for (const Cushion& c : t.cushions) {
            const Vec2 along = (c.to - c.from).normalized();
            const double foot = std::clamp(along.dot(r - c.from), 0.0, (c.to - c.from).norm());
            if ((c.from + foot * along - r).norm() < R - 1e-14) return false;
        }
        return true;
    }

    Vec2 direction() {
        if (chance(0.3)) return one_of<Vec2>({{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {0.5, std::sqrt(3.0) / 2.0}});
        const SinCos a = sin_cos(uniform(0.0, 6.283185307179586));
        return {a.cos, a.sin};
    }

    // One draw per statement, here and below, because compilers differ in the order of arguments.
    Vec3 spin() {
        const auto size = [this] { return one_of<double>({1e-3, 10.0, 100.0, 400.0}); };
        const double first = last_first() ? size() : uniform(-1, 1);
        const double second = uniform(-1, 1), third = uniform(-1, 1);
        if (last_first()) {
            const double x = uniform(-1, 1);
            return Vec3(x, third, second) * first;
        }
        return Vec3(first, second, third) * size();
    }

    Vec2 velocity() {
        const auto speed = [this] { return one_of<double>({0.0, 1e-6, 0.05, 1.0, 5.0, 12.0}); };
        if (last_first()) {
            const double share = uniform(0.5, 1.0), v = speed();
            return direction() * v * share;
        }
        const Vec2 along = direction();
        const double v = speed();
        return along * v * uniform(0.5, 1.0);
    }

    Vec2 point(const Vec2& low, const Vec2& high) {
        const int first = last_first() ? 1 : 0, second = 1 - first;
        Vec2 p;
        p[first] = uniform(low[first], high[first]);
        p[second] = uniform(low[second], high[second]);
        return p;
    }

    void place(const Vec2& r) {
        if (fits(r)) add_ball(scene_, std::to_string(scene_.ball.size()), r.x(), r.y());
    }

    void place_one() {
        const double R = scene_.balls.R;
        const Table& t = scene_.table;
        const double w = t.width > 0.0 ? t.width : 1.0, l = t.width > 0.0 ? t.length : 1.0;
        const Vec2 anywhere = point(Vec2(R, R), Vec2(w - R, l - R));
        const int kind = whole(5);
        if (kind <= 1 && !scene_.ball.empty()) {  // touches another ball, or nearly
            const Vec3& p = scene_.ball[whole(static_cast<int>(scene_.ball.size()))].position;
            const double gap = one_of<double>({0.0, 0.0, 1e-15, 1e-9, 1e-5});
            const Vec2 towards = direction();
            place(Vec2(p.x(), p.y()) + (2.0 * R + gap) * towards);
        } else if (kind == 2 && t.width > 0.0) {  // on a cushion, sometimes in a corner
            const double gap = one_of<double>({0.0, 0.0, 1e-12, 1e-7});
            const bool corner = chance(0.15);
            switch (whole(4)) {
                case 0:
                    place({R + gap, corner ? R : anywhere.y()});
                    break;
                case 1:
                    place({w - R - gap, corner ? l - R : anywhere.y()});
                    break;
                case 2:
                    place({corner ? w - R : anywhere.x(), R + gap});
                    break;
                default:
                    place({corner ? R : anywhere.x(), l - R - gap});
                    break;
            }
        } else if (kind == 3 && !t.jaws.empty()) {  // against a jaw
            const Jaw& j = one_of<Jaw>(t.jaws);
            place(j.center + (R + j.radius) * direction());
        } else {
            place(anywhere);
        }
    }

    void place_rack() {
        Rack rack;
        rack.game = chance(0.5) ? RackGame::kEightBall : RackGame::kNineBall;
        rack.gap = one_of<double>({0.0, 1e-12, 1e-6, 1e-4});
        rack.seed = 1 + static_cast<std::uint64_t>(whole(1000));
        const Vec2 spot(0.5 * scene_.table.width, 0.72 * scene_.table.length);
        for (const RackedBall& b : make_rack(rack, spot_at(spot), scene_.balls.R)) place(b.position);
    }

    void set_in_motion() {
        const double R = scene_.balls.R;
        const double moving = one_of<double>({0.1, 0.4, 1.0});
        bool any = false;
        for (BallStart& b : scene_.ball) {
            const bool last = &b == &scene_.ball.back();
            if (!chance(moving) && !(last && !any)) continue;
            any = true;
            const Vec2 v = velocity();
            b.velocity = Vec3(v.x(), v.y(), 0.0);
            switch (whole(3)) {
                case 0:
                    b.spin = rolling_spin(v.x(), v.y(), R);
                    break;
                case 1:
                    b.spin = spin();
                    break;
                default:
                    break;
            }
        }
    }

    std::uint64_t seed_;
    Generator rng_;
    Scene scene_;
    DrawOrder order_;
    int tries_ = 0;
};

/// Of all balls together.
inline std::size_t segments_of(const Record& record) {
    std::size_t count = 0;
    for (const BallTrack& track : record.tracks) count += track.segments.size();
    return count;
}

/// The scene as text, for inspection.
inline std::string dump(const Scene& scene) {
    std::string text;
    char line[400];
    const BallParams& b = scene.balls;
    std::snprintf(
        line, sizeof line,
        "table %s %g, mu_s %g mu_r %g mu_sp %g mu_b %g + %g exp(-%g u) e_b %g e_c %g f_c %g, models %s "
        "%s %s\n",
        scene.table.preset.c_str(), scene.table.width, b.mu_s, b.mu_r, b.mu_sp, b.mu_b, b.mu_b_more,
        b.mu_b_fall, b.e_b, b.e_c, b.f_c, name(scene.physics.ball_ball), name(scene.physics.cushion),
        name(scene.physics.clusters));
    text += line;
    for (const BallStart& s : scene.ball) {
        std::snprintf(line, sizeof line, "%s: r %.17g %.17g v %.17g %.17g w %.17g %.17g %.17g\n",
                      s.id.c_str(), s.position.x(), s.position.y(), s.velocity.x(), s.velocity.y(),
                      s.spin.x(), s.spin.y(), s.spin.z());
        text += line;
    }
    return text;
}

/// The fault of a run of the scene: a broken law or an error, or "". `options` lets a caller watch the run
/// and stop it by throwing from its progress function.
inline std::string what_breaks(const Scene& scene, const SimulateOptions& options = {}) {
    const Plan plan = plan_of(scene);
    try {
        const Record record = simulate(plan, options);
        if (const auto violation = verify(record, plan))
            return violation->law + " at event " + std::to_string(violation->event) + ": " +
                   violation->message;
        const bool may_stop = scene.stop.time || scene.stop.events;
        if (record.stopped != StopReason::kAtRest && !may_stop) return "did not come to rest";
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

}  // namespace carom::test
