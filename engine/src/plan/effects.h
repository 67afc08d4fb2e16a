// How far the balls of a scene can get, and which effects the scene needs.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom {

/// Formats a text like fmt::format, or returns "" without allocating memory.
class Words {
  public:
    explicit Words(bool wanted) : wanted_(wanted) {}

    template <class... Values>
    std::string operator()(fmt::format_string<Values...> text, Values&&... values) const {
        return wanted_ ? fmt::format(text, std::forward<Values>(values)...) : std::string();
    }
    bool wanted() const { return wanted_; }

  private:
    bool wanted_;
};

/// A ball at the start; the cue ball after the stroke.
struct Start {
    Vec2 place;
    Vec3 v, w;
    Segment segment;
    BallSize size;
};

/// Lists that are reused for every scene.
struct ReachMemory {
    std::vector<Start> starts;
    std::vector<double> radius;  ///< [m] how far each ball can get
};

struct Reach {
    bool moves = false;     ///< some ball changes its position
    bool slips = false;     ///< some ball slips on the cloth at the start
    bool pairs = false;     ///< two balls can meet
    bool cushions = false;  ///< a ball can meet a cushion or jaw
    bool pockets = false;   ///< a ball can enter a pocket's circle
    /// the bound, for users: "ball cue, the only one that moves, rests within 0.81 m"
    std::string why;
};

/// The smaller of two bounds. (1) A ball that moves alone and hits nothing gets no farther than its friction
/// allows: |v| t + mu_s g t^2/2 while it slides (t = 2|u|/(7 mu_s g)), then v^2/(2 mu_r g) with v = v - 2u/7.
/// (2) If the models do not gain energy, no ball is ever faster than sqrt(2E) until the scene's stop time,
/// where E is the energy of all balls per mass.
Reach reach_of(const Scene& scene, ReachMemory& memory, const Words& say);

/// Fills Plan::effects, and removes skipped effects from the plan: lists, coefficients, models. The plan's
/// geometry, balls, and cushion models must be those of its scene.
/// @param say  whether to state reasons
/// @throws SceneError at the line of an [effects] key that excludes a needed effect
void decide_effects(Plan& plan, ReachMemory& memory, const Words& say);

}  // namespace carom
