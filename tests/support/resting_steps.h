// An independent reference for resting contacts: small time steps, contacts as stiff critically damped
// springs without friction, sliding friction that ends a slip exactly within a step, and rolling resistance.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "carom/engine/scene.h"

namespace carom::test {

/// A ball on the cloth: centre, velocity, and the velocity s at which its spin would be rolling.
struct SteppedBall {
    Vec2 r, v, s;
};

/// Steps a scene with equal balls, straight cushions and whole round walls around the balls until all rest or
/// its stop time is over. `frequency` [1/s] is sqrt(stiffness / mass).
class RestingSteps {
  public:
    RestingSteps(const Scene& scene, double step, double frequency)
        : scene_(scene), step_(step), stiffness_(frequency * frequency) {
        for (const BallStart& b : scene.ball)
            balls_.push_back(
                {planar(b.position), planar(b.velocity), scene.balls.R * Vec2(b.spin.y(), -b.spin.x())});
        force_.resize(balls_.size());
    }

    /// @return the final balls
    const std::vector<SteppedBall>& run() {
        for (double t = 0.0; t < *scene_.stop.time; t += step_) {
            push();
            double fastest = 0.0;
            for (std::size_t i = 0; i < balls_.size(); ++i) fastest = std::max(fastest, move(i));
            if (fastest < 1e-7) break;
        }
        return balls_;
    }

  private:
    // Force per mass of a contact with this overlap and closing speed; `mass` is the reduced mass.
    double spring(double overlap, double closing, double mass) const {
        return std::max(0.0, stiffness_ * overlap + 2.0 * std::sqrt(stiffness_ * mass) * closing);
    }

    void push() {
        const double R = scene_.balls.R;
        std::fill(force_.begin(), force_.end(), Vec2(Vec2::Zero()));
        for (std::size_t i = 0; i < balls_.size(); ++i) {
            const SteppedBall& b = balls_[i];
            for (std::size_t j = i + 1; j < balls_.size(); ++j) {
                const Vec2 apart = balls_[j].r - b.r;
                if (dot(apart, apart) >= 4.0 * R * R) continue;
                const Vec2 n = apart / length(apart);
                const Vec2 F = spring(2.0 * R - length(apart), dot(b.v - balls_[j].v, n), 0.5) * n;
                force_[i] -= F;
                force_[j] += F;
            }
            for (const Cushion& c : scene_.table.cushions) {
                const Vec2 along = (c.to - c.from) / length(c.to - c.from);
                Vec2 n(-along.y(), along.x());
                if (dot(n, b.r - c.from) < 0.0) n = -n;
                lean(i, R - dot(n, b.r - c.from), -n);
            }
            for (const Jaw& wall : scene_.table.jaws) {
                const Vec2 out = b.r - wall.center;
                if (length(out) > 0.0) lean(i, length(out) - (wall.radius - R), out / length(out));
            }
        }
    }

    void lean(std::size_t i, double overlap, const Vec2& n) {
        if (overlap > 0.0) force_[i] -= spring(overlap, dot(balls_[i].v, n), 1.0) * n;
    }

    // @return the largest of its speeds
    double move(std::size_t i) {
        SteppedBall& b = balls_[i];
        b.v += step_ * force_[i];
        const double g = scene_.physics.gravity;
        const Vec2 u = b.v - b.s;
        const double slip = length(u), grip = scene_.balls.mu_s * g * step_;
        const bool rolls = 2.0 / 7.0 * slip <= grip;
        if (slip > 0.0) {
            const Vec2 f = (rolls ? 2.0 / 7.0 : grip / slip) * u;
            b.v -= f;
            b.s += 2.5 * f;
        }
        const double speed = length(b.v);
        if (rolls && speed > 0.0) {
            b.v *= 1.0 - std::min(1.0, scene_.balls.mu_r * g * step_ / speed);
            b.s = b.v;
        }
        b.r += step_ * b.v;
        return length(b.v) + length(b.s);
    }

    const Scene& scene_;
    const double step_, stiffness_;
    std::vector<SteppedBall> balls_;
    std::vector<Vec2> force_;  // per mass
};

}  // namespace carom::test
