// How far the balls of a scene can get: bounds that hold for the whole shot.
#include "plan/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "physics/cue.h"
#include "physics/motion.h"

namespace carom {
namespace {

// [-] Margin of the distances that balls can travel, far above the rounding of the bound.
constexpr double kReachMargin = 1e-9;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

class Bounds {
  public:
    Bounds(const Scene& scene, ReachMemory& memory, const Words& say)
        : scene_(scene),
          say_(say),
          starts_(memory.starts),
          radius_(memory.radius),
          motion_(motion_params(scene.balls, scene.physics.gravity, scene.balls.R)),
          time_(scene.stop.time.value_or(kUnbounded)) {
        motion_.sliding = motion_.rolling = motion_.spin_decay = false;  // only the states are needed
        starts_.clear();
        for (const BallStart& ball : scene.ball) {
            Vec3 v = ball.velocity, w = ball.spin;
            if (scene.cue && scene.cue->ball == ball.id) {
                const StruckBall struck =
                    strike(*scene.cue, scene.size_of(ball), true, scene.physics.vertical);
                v = struck.v;
                w = struck.w;
            }
            const BallSize size = scene.size_of(ball);
            motion_.R = size.R;
            starts_.push_back(
                {ball.position.head<2>(), v, w, start_segment(0.0, ball.position, v, w, motion_), size});
            // A ball that starts in the air, or is pressed onto the cloth by the tip, flies and slips.
            if (ball.flies() || v.z() != 0.0) {
                lifted_ = true;
                starts_.back().segment.state = MotionState::kSliding;
            }
            energy_height_ += size.m * scene.physics.gravity * ball.height;
        }
    }

    Reach find() {
        Reach reach;
        int movers = 0, mover = -1;
        for (std::size_t i = 0; i < starts_.size(); ++i) {
            reach.slips = reach.slips || starts_[i].segment.state == MotionState::kSliding;
            if (!translates(starts_[i].segment.state)) continue;
            ++movers;
            mover = static_cast<int>(i);
        }
        reach.moves = movers > 0;
        std::vector<double>& radius = radius_;
        radius.assign(starts_.size(), 0.0);
        reach.why = say_("nothing moves");
        if (movers == 1 && !lifted_) {
            const std::size_t m = static_cast<std::size_t>(mover);
            radius[m] = alone(starts_[m]);
            reach.why = say_("ball {}, the only one that moves, goes no farther than {:.3g} m",
                             scene_.ball[m].id, radius[m]);
        }
        // The bound of a ball without contacts is valid only if it indeed has none. Over a pocket, the cloth
        // does not slow it.
        if (movers > 1 || lifted_ || meets_cushion(radius) || meets_ball(radius) || meets_pocket(radius)) {
            const double far = by_energy();
            std::fill(radius.begin(), radius.end(), far);
            reach.why = far < kUnbounded ? say_("no ball goes farther than {:.3g} m until the stop", far)
                                         : say_("nothing limits how far a ball can go");
        }
        reach.pairs = meets_ball(radius);
        reach.cushions = meets_cushion(radius);
        reach.pockets = meets_pocket(radius);
        return reach;
    }

  private:
    static double wide(double x) { return x * (1.0 + kReachMargin); }

    double alone(const Start& s) const {
        const Vec2 u = cloth_slip(s.v, s.w, s.size.R);
        double speed = length(s.v.head<2>()), far = 0.0;
        if (s.segment.state == MotionState::kSliding) {
            if (motion_.slide == 0.0) return wide(speed > 0.0 ? speed * time_ : 0.0);
            const double t = 2.0 * length(u) / (7.0 * motion_.slide);
            far = speed * t + 0.5 * motion_.slide * t * t;
            speed = length(Vec2(s.v.head<2>() - (2.0 / 7.0) * u));
        }
        if (speed > 0.0) far += motion_.roll > 0.0 ? speed * speed / (2.0 * motion_.roll) : speed * time_;
        return wide(far);
    }

    double by_energy() const {
        const Physics& p = scene_.physics;
        // An impact can gain energy with the published sign of the cloth slip, with few steps, and with a
        // loose tolerance.
        const bool coarse = p.substeps ? *p.substeps < 100 : p.tolerance > 1e-6;
        const bool gains =
            p.ball_ball->reads_tolerance && (p.cloth_slip == kernel::ClothSlip::kAsPublished || coarse);
        if (gains || !(time_ < kUnbounded)) return kUnbounded;
        // The lightest ball could receive all the energy, so divide by its mass.
        double lightest = kUnbounded, energy = 0.0;
        for (const Start& s : starts_) lightest = std::min(lightest, s.size.m);
        for (const Start& s : starts_) energy += (s.size.m / lightest) * kinetic_energy(s.v, s.w, s.size.R);
        energy += energy_height_ / lightest;
        return wide(std::sqrt(2.0 * energy) * time_);
    }

    bool meets_ball(const std::vector<double>& radius) const {
        for (std::size_t i = 0; i < starts_.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                if (radius[i] == 0.0 && radius[j] == 0.0) continue;  // both stay, even if they touch
                if (length(starts_[i].place - starts_[j].place) <=
                    wide(contact_distance(starts_[i].size.R, starts_[j].size.R, scene_.balls.discs())) +
                        radius[i] + radius[j])
                    return true;
            }
        }
        return false;
    }
    bool meets_cushion(const std::vector<double>& radius) const {
        for (std::size_t i = 0; i < starts_.size(); ++i) {
            if (radius[i] == 0.0) continue;
            const double near = wide(starts_[i].size.R) + radius[i];
            for (const Cushion& c : scene_.table.cushions)
                if (distance_to_segment(starts_[i].place, c.from, c.to) <= near) return true;
            for (const Jaw& j : scene_.table.jaws)
                if (const double d = length(starts_[i].place - j.center);
                    j.around() ? std::abs(d - j.radius) <= near : d <= near + j.radius)
                    return true;
        }
        return false;
    }
    bool meets_pocket(const std::vector<double>& radius) const {
        for (std::size_t i = 0; i < starts_.size(); ++i)
            for (const Pocket& p : scene_.table.pockets)
                if (length(starts_[i].place - p.center) <= wide(p.radius) + radius[i]) return true;
        return false;
    }

    const Scene& scene_;
    const Words& say_;
    std::vector<Start>& starts_;
    std::vector<double>& radius_;
    MotionParams motion_;
    double time_;
    bool lifted_ = false;         // the cloth does not limit a ball's path
    double energy_height_ = 0.0;  // [J] of all balls
};

}  // namespace

Reach reach_of(const Scene& scene, ReachMemory& memory, const Words& say) {
    return Bounds(scene, memory, say).find();
}

}  // namespace carom
