// Breaks with balls of different sizes: racks with odd balls, chains of touching balls, and a cue ball of
// another size.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/table.h"
#include "reference/random_impacts.h"
#include "scene/rack.h"
#include "support/hard_scenes.h"

namespace carom::test {

/// The scene of a seed. Sizes are 0.8 to 1.25 times the radius and 0.7 to 1.5 times the mass.
class OddBreak {
  public:
    explicit OddBreak(std::uint64_t seed) : rng_(seed) {
        scene_.file = "(odd break)";
        scene_.balls = make_ball_params(chance(0.5) ? "pool" : "pool_classic");
        scene_.table = make_table(chance(0.5) ? "seven_foot" : "nine_foot");
        choose_models();
        if (chance(0.6))
            rack();
        else
            chain();
        cue_ball();
    }

    Scene take() { return std::move(scene_); }

  private:
    double uniform(double lo, double hi) { return rng_.uniform(lo, hi); }
    bool chance(double p) { return uniform(0.0, 1.0) < p; }

    void choose_models() {
        const double kind = uniform(0.0, 1.0);
        Physics& physics = scene_.physics;
        if (kind < 0.1) physics.ball_ball = ball_ball_model("two_step");
        if (kind >= 0.1 && kind < 0.15) physics.ball_ball = ball_ball_model("elastic");
        if (kind >= 0.15 && kind < 0.2) physics.substeps = 1000;
        const double clusters = uniform(0.0, 1.0);
        if (clusters < 0.1) physics.clusters = ClusterModel::kSequential;
        if (clusters >= 0.1 && clusters < 0.15) physics.clusters = ClusterModel::kRigid;
        if (chance(0.2)) scene_.balls.mu_b = uniform(0.0, 0.2);
        if (chance(0.2)) scene_.balls.e_b = uniform(0.7, 1.0);
    }

    // A size up to this radius.
    BallSize odd(double largest) {
        const double R = scene_.balls.R;
        const double radius = std::min(R * uniform(0.8, 1.25), largest);
        return {radius, scene_.balls.m * uniform(0.7, 1.5)};
    }

    void place(const std::string& id, const Vec2& at, const BallSize& size) {
        add_ball(scene_, id, Vec3(at.x(), at.y(), size.R));
        if (!(size == scene_.balls.size())) scene_.ball.back().own = size;
    }

    void rack() {
        Rack rack;
        rack.game = chance(0.5) ? RackGame::kEightBall : RackGame::kNineBall;
        rack.seed = rng_.next();
        rack.gap = chance(0.3) ? 0.0 : uniform(0.0, 1e-3);
        const double R = scene_.balls.R, spaced = chance(0.5) ? R : 1.05 * R, share = chance(0.3) ? 0.0 : 0.3;
        for (const RackedBall& b : make_rack(rack, scene_.table, spaced)) {
            const bool is_odd = chance(share);
            // Two of the largest touch if the rack has no gap.
            place(b.id, b.position, is_odd ? odd(spaced) : scene_.balls.size());
        }
    }

    // Each touches the previous one; some also the one before that.
    void chain() {
        const int count = 3 + static_cast<int>(uniform(0.0, 7.0));
        Vec2 at(0.5 * scene_.table.width + uniform(-0.1, 0.1), 0.6 * scene_.table.length);
        BallSize before = odd(1.0);
        place("1", at, before);
        for (int k = 2; k <= count; ++k) {
            const BallSize size = chance(0.5) ? odd(1.0) : scene_.balls.size();
            for (int attempt = 0; attempt < 20; ++attempt) {
                const double angle = uniform(0.0, 2.0 * reference::kDegree * 180.0);
                const double apart =
                    contact_distance(before.R, size.R, false) + (chance(0.7) ? 0.0 : uniform(0.0, 1e-3));
                const Vec2 here = at + apart * Vec2(std::cos(angle), std::sin(angle));
                if (!fits(here, size)) continue;
                place(std::to_string(k), here, size);
                at = here;
                before = size;
                break;
            }
        }
    }

    bool fits(const Vec2& at, const BallSize& size) const {
        const double edge = 2.0 * size.R;
        if (at.x() < edge || at.x() > scene_.table.width - edge || at.y() < 0.35 * scene_.table.length ||
            at.y() > scene_.table.length - edge)
            return false;
        return std::none_of(scene_.ball.begin(), scene_.ball.end(), [&](const BallStart& b) {
            const double R = scene_.size_of(b).R;
            return length(planar(b.position) - at) < contact_distance(R, size.R, false) - 1e-13;
        });
    }

    void cue_ball() {
        const Vec2 at(0.5 * scene_.table.width + uniform(-0.2, 0.2), 0.2 * scene_.table.length);
        const BallSize size = chance(0.8) ? odd(1.0) : scene_.balls.size();
        const Vec2 goal = planar(scene_.ball.front().position);
        const double angle =
            std::atan2(goal.y() - at.y(), goal.x() - at.x()) + uniform(-2.0, 2.0) * reference::kDegree;
        const double speed = chance(0.8) ? uniform(1.0, 12.0) : uniform(0.01, 1.0);
        place("cue", at, size);
        BallStart& cue = scene_.ball.back();
        cue.velocity = {speed * std::cos(angle), speed * std::sin(angle), 0.0};
        if (chance(0.5)) cue.spin = rolling_spin(cue.velocity.x(), cue.velocity.y(), size.R);
        if (chance(0.3)) cue.spin.z() = uniform(-100.0, 100.0);
        // It flies, and may hop at cushions.
        if (chance(0.1)) cue.velocity.z() = uniform(0.3, 2.0);
        if (chance(0.1)) scene_.balls.e_h = 0.2;
    }

    reference::Generator rng_;
    Scene scene_ = empty_scene();
};

}  // namespace carom::test
