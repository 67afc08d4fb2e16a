// The derivatives of a shot by the numbers of its scene: how each of them moves every ball. The record's
// events are replayed on dual numbers; nothing is simulated again.
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"

namespace carom {

/// A shot or an input without derivatives. what() is one sentence.
class TangentError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The change of one input up to which the order of events stays the same, to first order; infinite if
/// nothing is near. The derivatives are invalid beyond it.
struct Margin {
    double down, up;               ///< >= 0, in the unit of the input
    std::string down_why, up_why;  ///< the event that changes there: "cue misses j4 at 1.2 s"; "" if none
};

/// Derivatives of a ball's state by one input.
struct StateTangent {
    Vec3 position = Vec3::Zero();  ///< of the centre [m]
    Vec3 velocity = Vec3::Zero();  ///< [m/s]
    Vec3 spin = Vec3::Zero();      ///< [rad/s]
};

/// The derivatives of one record, each by one input in its own unit: cue.aim_deg gives m per degree.
class Tangents {
  public:
    /// @param inputs  keys of numbers as in SceneNumber: cue.speed, ball.1.position.x, balls.mu_s; or a
    /// number of a fit, such as balls.mu_b_fit.0
    /// @param record  of this plan
    /// @param until  [s] do not replay events after this time
    /// @throws TangentError if an event has no derivative: a resting contact, three balls that meet in the
    /// air, two cushions at once, a ball that leaves a pocket, the published march, or an impact at a corner
    /// of its model.
    Tangents(const Plan& plan, const Record& record, const std::vector<std::string>& inputs,
             std::optional<double> until = std::nullopt);
    ~Tangents();
    Tangents(Tangents&& other) noexcept;
    Tangents& operator=(Tangents&& other) noexcept;

    const std::vector<std::string>& inputs() const { return inputs_; }
    /// At a fixed time. For a ball out of play they are 0.
    StateTangent state_at(int ball, double time, std::size_t input) const;
    /// At rest, or at the end of the record.
    StateTangent at_end(int ball, std::size_t input) const { return state_at(ball, duration_, input); }
    /// Of the time of an event [s]; NaN if a ball leaves the table.
    double event_time(std::size_t event, std::size_t input) const;
    /// Of the position of ball `Event::a` at its event, including the shift of the event in time [m].
    Vec2 event_place(std::size_t event, std::size_t input) const;
    /// Number of replayed events: all, unless `until` stopped earlier.
    std::size_t events() const;
    /// [-] Largest difference between two estimates of an impact's derivatives, relative to the largest of
    /// them: at most 1e-5, or 1e-3 if three or more balls touch. Everything else is exact to rounding.
    double impact_error() const;
    /// One per input. Searches the near misses of all balls, so it is slower than the derivatives.
    std::vector<Margin> margins() const;

  private:
    struct Parts;
    std::vector<std::string> inputs_;
    double duration_ = 0.0;
    std::unique_ptr<Parts> parts_;
};

}  // namespace carom
