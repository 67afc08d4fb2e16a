// The derivatives of a shot by numbers of its scene: how each of them moves every ball. They are central
// differences of whole shots, so every effect that the engine simulates has them.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"

namespace carom {

/// A shot or an input without derivatives. what() is one sentence.
class DerivativeError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Derivatives of a ball's state by one input: of its centre [m], velocity [m/s] and spin [rad/s].
struct StateDerivative {
    Vec3 position, velocity, spin;
};

/// [-] A column whose relative error may be larger than this is refused; and the same for steps that a shot
/// checks afterwards, and for figures to two digits. At a corner of the shot, such as a ball that rolls from
/// the stroke on, the derivative is the mean of both sides, and the error half their difference.
inline constexpr double kMostDerivativeError = 1e-3, kRoughDerivativeError = 0.3;

/// Columns of derivatives, each by one input in its own unit: cue.aim_deg gives m per degree. They belong to
/// the shot with physics.tolerance = 1e-12, for any tolerance of the scene.
class Derivatives {
  public:
    /// @param record  of this plan
    /// @param inputs  keys of numbers as in SceneNumber: cue.speed, ball.1.position.x, balls.mu_s; or a
    /// number of a fit, such as balls.mu_b_fit.0
    /// @param times  [s] of the states; from the end of the record on, the state in which a shot ends
    /// @param events  of the record, whose times and places are differentiated
    /// @throws std::invalid_argument for an input that is no number of the scene, or a record of another one;
    /// DerivativeError for an input at the end of its range; SceneError for friction that no impact with a
    /// tolerance accepts; SimulationError
    Derivatives(const Plan& plan, const Record& record, const std::vector<std::string>& inputs,
                const std::vector<double>& times, const std::vector<std::size_t>& events = {});

    /// Why a column is refused, a sentence that names the input; "" if its error() is at most `most`.
    std::string refusal(std::size_t input, double most = kMostDerivativeError) const;
    /// @throws DerivativeError with the first refusal
    void check(double most = kMostDerivativeError) const;

    /// Of a ball at times[time]. 0 if it is out of play.
    StateDerivative state(std::size_t time, int ball, std::size_t input) const {
        const Vec3* slopes = &columns_[input].slopes[3 * (time * balls_ + static_cast<std::size_t>(ball))];
        return {slopes[0], slopes[1], slopes[2]};
    }
    /// Of the time of events[event] [s]. NaN if the shot with the tighter tolerance lacks this event.
    double event_time(std::size_t event, std::size_t input) const {
        return columns_[input].slopes[states_ + 2 * event].x();
    }
    /// Of the position of ball `Event::a` at events[event], including the shift of the event in time [m].
    Vec2 event_place(std::size_t event, std::size_t input) const {
        return planar(columns_[input].slopes[states_ + 2 * event + 1]);
    }
    /// [-] Estimated error of a column: the largest one of any ball, relative to the largest derivative of
    /// the same kind (position, velocity, spin, event). Infinite if no shots could be compared.
    double error(std::size_t input) const { return columns_[input].error; }
    int shots() const { return shots_; }  ///< played

  private:
    struct Column {
        std::string input, why;    ///< `why` shots have no result; "" if all have one
        std::vector<Vec3> slopes;  ///< position, velocity and spin of every ball at every time, then events
        double error;
    };
    friend class Differences;
    std::vector<Column> columns_;
    std::size_t balls_ = 0, states_ = 0;  ///< the number of slopes before those of events
    int shots_ = 0;
};

}  // namespace carom
