// A crowded scene under construction: its numbers, walls and balls, drawn from a seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/geometry.h"
#include "carom/engine/math.h"
#include "carom/kernel/tolerance.h"
#include "reference/random_impacts.h"
#include "scene/rack.h"
#include "support/crowded_scenes.h"

namespace carom::test {

inline constexpr double kPi = std::numbers::pi;

/// A scene under construction. Numbers are drawn in separate statements, because compilers differ in the
/// order of arguments.
class Crowd {
  public:
    Crowd(std::uint64_t seed, Level level) : rng_(seed), level_(level) {
        scene_.file = "(crowd)";
        choose_balls();
        choose_models();
        if (level_ == Level::kNatural) return;
        scene_.stop.time = 60.0;
        scene_.stop.events = 20000;
    }

    Scene take() { return std::move(scene_); }
    double R() const { return scene_.balls.R; }

    double uniform(double lo, double hi) { return rng_.uniform(lo, hi); }
    bool chance(double p) { return uniform(0.0, 1.0) < p; }
    int whole(int from, int to) {
        return std::min(to, from + static_cast<int>(uniform(0.0, static_cast<double>(to - from + 1))));
    }
    double logarithmic(double lo, double hi) { return lo * exp(uniform(0.0, 1.0) * std::log(hi / lo)); }
    template <std::size_t kCount>
    double one_of(const double (&list)[kCount]) {
        return list[whole(0, static_cast<int>(kCount) - 1)];
    }
    Vec2 direction() {
        const SinCos a = sin_cos(uniform(0.0, 2.0 * kPi));
        return {a.cos, a.sin};
    }
    /// [m/s]
    double speed() { return level_ == Level::kExtreme ? logarithmic(1e-5, 10.0) : logarithmic(0.01, 8.0); }
    /// [rad/s]
    Vec3 spin(double surface) {
        const double x = uniform(-1.0, 1.0), y = uniform(-1.0, 1.0), z = uniform(-1.0, 1.0);
        return Vec3(x, y, z) * (surface / R());
    }

    double nose() { return nose_; }
    void wall(const Vec2& from, const Vec2& to) { scene_.table.cushions.push_back({"", from, to, nose_}); }
    /// Closed, with its corner at the origin.
    void box(double w, double l) {
        wall({0.0, 0.0}, {w, 0.0});
        wall({w, 0.0}, {w, l});
        wall({w, l}, {0.0, l});
        wall({0.0, l}, {0.0, 0.0});
    }
    void jaw(const Vec2& center, double radius) { scene_.table.jaws.push_back({"", center, radius, nose_}); }

    int balls() const { return static_cast<int>(scene_.ball.size()); }
    Vec2 place_of(int ball) const { return planar(scene_.ball[static_cast<std::size_t>(ball)].position); }
    void ball(const Vec2& r) {
        BallStart start;
        start.id = "b" + std::to_string(balls());
        start.position = {r.x(), r.y(), R()};
        scene_.ball.push_back(start);
    }
    void move(int ball, const Vec2& v, const Vec3& w) {
        BallStart& start = scene_.ball[static_cast<std::size_t>(ball)];
        start.velocity = {v.x(), v.y(), 0.0};
        start.spin = w;
    }
    /// Spinning freely, rolling, or without spin.
    void shoot(int ball, const Vec2& v) {
        const int kind = whole(0, 2);
        Vec3 w = Vec3::Zero();
        if (kind == 0) w = Vec3(-v.y() / R(), v.x() / R(), 0.0);
        if (kind == 1) w = spin(2.0 * v.norm());
        move(ball, v, w);
    }
    /// Whether a ball fits there, at sufficient distance from every wall.
    bool fits(const Vec2& r, double slack = 1e-14) const {
        for (const BallStart& b : scene_.ball)
            if ((planar(b.position) - r).norm() < 2.0 * R() - slack) return false;
        for (const Cushion& c : scene_.table.cushions)
            if (distance_to_segment(r, c.from, c.to) < R() - slack) return false;
        for (const Jaw& j : scene_.table.jaws)
            if ((j.center - r).norm() < R() + j.radius - slack) return false;
        return true;
    }
    /// Adds a ball that touches another or nearly touches; false if there is no room.
    bool attach(int to) {
        constexpr double kGaps[] = {0.0, 0.0, 0.0, 1e-15, 1e-12, 1e-9, 1e-6};
        const double gap = one_of(kGaps) * R();
        const bool lattice = chance(0.5);
        const Vec2 any = direction();
        const SinCos turn = sin_cos(kPi / 3.0 * whole(0, 5));
        const Vec2 r = place_of(to) + (2.0 * R() + gap) * (lattice ? Vec2(turn.cos, turn.sin) : any);
        if (!fits(r)) return false;
        ball(r);
        return true;
    }
    /// A gap between objects that nearly touch [m].
    double small_gap() {
        constexpr double kGaps[] = {0.0, 0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3};
        return one_of(kGaps) * R();
    }
    /// Shoots one ball at the others, from a distance of a few ball radii.
    void strike(int target, const Vec2& from) {
        const double away = 2.0 * R() + (chance(0.3) ? 0.0 : uniform(0.0, 4.0)) * R();
        const double off = uniform(-0.9, 0.9) * R() * (chance(0.4) ? 0.0 : 1.0);
        const Vec2 r = place_of(target) + away * from + off * Vec2(-from.y(), from.x());
        const double v = speed();
        if (!fits(r)) return;
        ball(r);
        shoot(balls() - 1, -v * from);
    }
    /// Spins some balls, always including the first.
    void spin_some(double share) {
        for (int i = 0; i < balls(); ++i) {
            const bool turns = i == 0 || chance(share);
            const double surface = 3.0 * speed();
            const Vec3 w = spin(surface);
            if (turns) move(i, planar(scene_.ball[static_cast<std::size_t>(i)].velocity), w);
        }
    }

  private:
    void choose_balls() {
        use_balls(scene_, "pool_classic");
        BallParams& b = scene_.balls;
        constexpr double kRestitutions[] = {0.95, 0.95, 0.8, 0.6, 0.0};
        b.e_b = one_of(kRestitutions);
        constexpr double kCushions[] = {0.85, 0.85, 0.7, 0.5, 0.0};
        b.e_c = one_of(kCushions);
        scene_.table.cushions.clear();
        if (level_ == Level::kNatural) return;
        const bool extreme = level_ == Level::kExtreme;
        b.R = extreme ? logarithmic(1e-3, 1.0) : logarithmic(0.01, 0.1);
        b.m = 7100.0 * b.R * b.R * b.R;
        b.mu_s = extreme ? logarithmic(1e-6, 5.0) : logarithmic(0.01, 1.0);
        b.mu_r = b.mu_s * logarithmic(1e-3, 0.3);
        b.mu_sp = b.mu_s * logarithmic(1e-2, 0.3);
        b.mu_b = chance(0.2) ? 0.0 : uniform(0.0, 0.95);
        b.e_b = uniform(0.0, 1.0);
        b.e_c = uniform(0.0, 1.0);
        b.f_c = uniform(0.0, 1.0);
        scene_.physics.gravity = extreme ? logarithmic(0.01, 100.0) : logarithmic(1.0, 20.0);
    }

    void choose_models() {
        Physics& p = scene_.physics;
        const char* const kPairs[] = {"mathavan", "inelastic", "inelastic", "elastic"};
        p.ball_ball = ball_ball_model(kPairs[whole(0, 3)]);
        if (p.ball_ball->reads_tolerance && scene_.balls.mu_s > kernel::kLargestFriction)
            p.ball_ball = ball_ball_model("inelastic");
        const char* const kRails[] = {"han_2005", "han_2005", "smooth", "impulse"};
        p.cushion = cushion_model(kRails[whole(0, 3)]);
        constexpr ClusterModel kClusters[] = {ClusterModel::kCompliant, ClusterModel::kCompliant,
                                              ClusterModel::kSequential, ClusterModel::kRigid};
        p.clusters = kClusters[whole(0, 3)];
        nose_ = R() * uniform(1.1, 1.5);
    }

    reference::Generator rng_;
    Level level_;
    Scene scene_;
    double nose_ = 0.0;
};

}  // namespace carom::test
