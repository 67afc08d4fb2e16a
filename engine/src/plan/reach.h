// What balls of a scene can ever come to: bounds that hold for the whole shot.
#pragma once

#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/engine/scene.h"
#include "plan/words.h"

namespace carom {

/// A ball at the start. Where the cue strikes it, the velocities are those after the strike.
struct Start {
    Vec2 place;
    Vec3 v, w;
    Segment segment;
    BallSize size;
};

/// Lists that are filled anew for every scene.
struct ReachMemory {
    std::vector<Start> starts;
    std::vector<double> radius;  ///< [m] that each ball cannot leave
};

struct Reach {
    bool moves = false;     ///< some ball leaves its place
    bool slips = false;     ///< some ball slips on the cloth at the start
    bool pairs = false;     ///< two balls can meet
    bool cushions = false;  ///< a ball can meet a cushion or jaw
    bool pockets = false;   ///< a ball can enter a pocket's circle
    /// the bound, for people who ask: "ball cue, the only one that moves, rests within 0.81 m"
    std::string why;
};

/// The smaller of two bounds. (1) The only moving ball that meets nothing goes no farther than its
/// own friction lets it: |v| t + mu_s g t^2/2 while it slides (t = 2|u|/(7 mu_s g)), then v^2/(2 mu_r g) with
/// v = v - 2u/7. (2) No ball is ever faster than sqrt(2E), E the energy per mass of all balls, in the time
/// until the scene's stop; for models that do not gain energy.
Reach reach_of(const Scene& scene, ReachMemory& memory, const Words& say);

}  // namespace carom
