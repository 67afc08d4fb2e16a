// Plan: the computations that a scene needs. Constant during a run, and the only input of the event loop.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/geometry.h"
#include "carom/engine/motion.h"
#include "carom/engine/scene.h"
#include "carom/engine/tolerances.h"
#include "carom/kernel/contact_phase.h"

namespace carom {

/// One effect: in force or skipped, and why.
struct EffectDecision {
    std::string keyword;
    bool in_force;
    std::string reason;
};

struct Plan;
struct EffectFacts;

/// Whether an effect can influence a scene, and why.
struct Need {
    bool needed;
    std::string reason;
};

/// One effect: a row of effect_table().
struct EffectInfo {
    const char* keyword;       ///< of [effects]
    const char* skipped_when;  ///< for people
    const char* keys;          ///< the scene keys that belong to it, separated by commas
    Need (*need)(const EffectFacts&);
    void (*leave_out)(Plan&) = nullptr;  ///< removes it from the plan, in addition to Plan::skipped
    bool last = false;                   ///< decided last, because it depends on the others
};
/// All effects, in the order of Effect and of Plan::effects.
std::span<const EffectInfo> effect_table();

/// How detection finds the possible partners of a ball: by testing every box, or with a box tree (as Box2D).
/// The events are the same to the last bit; lab/notes/2026-11-event_cost.md has the measured crossover.
enum class Search : std::uint8_t { kDirect, kTree };
constexpr auto names_of(Search) {
    return std::array{"direct", "tree"};
}

struct Plan {
    Scene scene;                  ///< ids, table and settings, as read
    BallParams balls{};           ///< as in the scene, except that the friction of skipped effects is 0
    std::vector<BallSize> sizes;  ///< of every ball
    double gravity = 9.81;
    std::vector<MotionParams> motion;           ///< of every ball, without skipped effects
    Geometry geometry;                          ///< empty lists if nothing can reach them
    const CushionModelInfo* cushion = nullptr;  ///< of straight noses and their ends
    const CushionModelInfo* jaw = nullptr;      ///< of round jaws
    const CushionModelInfo& model_of(Partner nose) const { return nose == Partner::kJaw ? *jaw : *cushion; }
    std::vector<EffectDecision> effects;  ///< of effect_table(), then those that no scene can request
    std::bitset<kEffects> skipped;
    bool in_force(Effect effect) const { return !skipped[static_cast<std::size_t>(effect)]; }
    void skip(Effect effect) { skipped.set(static_cast<std::size_t>(effect)); }
    bool pairs = true;  ///< two balls can meet
    kernel::Isa isa = kernel::Isa::kScalar;
    const BallBallModelInfo* ball_ball = nullptr;
    /// e_b as the ball-ball model reads it: 1 if it does not read it.
    double e_b() const { return ball_ball->restitution(balls); }
    BallBallSettings impact;
    /// Impacts of two balls act along the line of centres in the middle of their contact.
    bool contact_time = false;
    kernel::ContactPhaseFunction contact_phase = nullptr;  ///< of compliant clusters
    double cluster_tolerance = kDefaultTolerance;          ///< of theirs; physics.tolerance
    /// kSequential if there are fewer than three balls
    ClusterModel clusters = ClusterModel::kSequential;
    Search ball_search = Search::kDirect;   ///< among balls
    Search table_search = Search::kDirect;  ///< among cushions, noses and pockets
    /// [ball radii] Distance that a ball's box covers before it is renewed; infinite: until the ball's next
    /// own event.
    double box_travel = std::numeric_limits<double>::infinity();
    std::vector<std::string> warnings;  ///< one sentence each, for stderr
};

/// Decides once per run, by arguments valid for the whole shot (docs/design/architecture.md).
/// @param isa must be available (kernel::isa_from_environment)
/// @throws SceneError if [effects] excludes a needed effect
Plan make_plan(const Scene& scene, kernel::Isa isa);

/// Whether the plan dissipates no energy: impacts return all of it, without friction, pockets and flight. A
/// nose above or below a ball's centre drives it into the cloth, which dissipates some.
bool loses_nothing(const Plan& plan);

/// Plans for one scene with changing numbers: the same decisions as make_plan, in reused memory. The plans
/// have no reasons, no warnings, and no pocket names in their geometry.
class Planner {
  public:
    Planner(const Scene& scene, kernel::Isa isa);
    ~Planner();
    Planner(Planner&& other) noexcept;
    Planner& operator=(Planner&& other) noexcept;

    /// The scene to plan; may be changed between two plans.
    Scene& scene() { return plan_.scene; }
    /// Valid until the next call.
    /// @param same_table  the table has not changed since the last call
    /// @throws SceneError as make_plan
    const Plan& plan(bool same_table = false);

  private:
    struct Memory;
    Plan plan_;
    std::unique_ptr<Memory> memory_;
};

}  // namespace carom
