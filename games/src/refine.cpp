#include "carom/games/refine.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/derivatives.h"
#include "carom/engine/plan.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"

namespace carom::games {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

// [-] Share of the search's shots used for the success rate of an exact shot; [degrees] largest turn of its
// aim.
constexpr double kExactShare = 0.1, kTurn = 20.0;
// Limits on steps, and on the halvings of one.
constexpr int kMostSteps = 30, kMostHalvings = 10;
// [-] Ignore directions that move the balls by less than this fraction of the most effective one.
constexpr double kWeak = 1e-6;

/// A shot, and the distances of its balls from their places at rest.
struct Try {
    std::vector<double> values;
    Scene scene;
    Plan plan;
    Record record;
    VectorXd off;  ///< two per place
};

class Refiner {
  public:
    Refiner(const Scene& scene, std::span<const Choice> choices, std::span<const Place> places,
            kernel::Isa isa, const std::function<bool(const Record&)>& allowed)
        : scene_(scene), choices_(choices), places_(places), isa_(isa), allowed_(allowed) {
        for (const Choice& choice : choices) numbers_.emplace_back(scene, choice.key);
    }

    Refined run() {
        std::vector<double> values;
        for (const SceneNumber& number : numbers_) values.push_back(number.value(scene_));
        std::optional<Try> now = at(values);
        if (!now)
            return {values, scene_, std::numeric_limits<double>::infinity(), shots_,
                    "a ball that is wanted at rest falls"};
        std::string trouble;
        for (int step = 0; step < kMostSteps && miss(*now) > kRefined; ++step) {
            VectorXd move;
            try {
                move = newton(*now);
            } catch (const DerivativeError& error) {
                trouble = error.what();
                break;
            }
            std::optional<Try> next;
            for (int k = 0; k < kMostHalvings && !next; ++k, move *= 0.5) {
                next = at(moved(now->values, move));
                if (next && (!(next->off.norm() < now->off.norm()) || (allowed_ && !allowed_(next->record))))
                    next.reset();
            }
            if (!next) {
                trouble =
                    "no small step improves it and keeps the rest of the goal: the order of events would "
                    "change";
                break;
            }
            now = std::move(next);
        }
        const double left = miss(*now);
        if (left > kRefined && trouble.empty()) trouble = "it converges too slowly";
        return {now->values, now->scene, left, shots_, left > kRefined ? trouble : ""};
    }

  private:
    double range(std::size_t k) const { return choices_[k].high - choices_[k].low; }

    static double miss(const Try& shot) {
        double most = 0.0;
        for (Eigen::Index i = 0; i < shot.off.size(); i += 2)
            most = std::max(most, shot.off.segment<2>(i).norm());
        return most;
    }

    std::vector<double> moved(std::vector<double> values, const VectorXd& move) const {
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] =
                std::clamp(values[k] + move[static_cast<Eigen::Index>(k)], choices_[k].low, choices_[k].high);
        return values;
    }

    /// Empty if the scene is invalid, does not come to rest, or a ball with a place is gone.
    std::optional<Try> at(const std::vector<double>& values) {
        Scene scene = scene_;
        for (std::size_t k = 0; k < values.size(); ++k) numbers_[k].put(scene, values[k]);
        try {
            validate(scene);
            ++shots_;
            Plan plan = make_plan(scene, isa_);
            Record record = simulate(plan);
            if (record.stopped != StopReason::kAtRest) return std::nullopt;
            VectorXd off(static_cast<Eigen::Index>(2 * places_.size()));
            for (std::size_t i = 0; i < places_.size(); ++i) {
                const BallState end = record.state_at(places_[i].ball, record.duration);
                if (is_gone(end.state)) return std::nullopt;
                off.segment<2>(static_cast<Eigen::Index>(2 * i)) = planar(end.position) - places_[i].at;
            }
            return Try{values, std::move(scene), std::move(plan), std::move(record), std::move(off)};
        } catch (const SceneError&) {
            return std::nullopt;
        } catch (const SimulationError&) {
            return std::nullopt;
        }
    }

    /// The minimum-norm step, in fractions of the ranges.
    VectorXd newton(const Try& shot) const {
        std::vector<std::string> keys;
        for (const Choice& choice : choices_) keys.push_back(choice.key);
        const Derivatives by(shot.plan, shot.record, keys, {shot.record.duration});
        by.check(kRoughDerivativeError);
        MatrixXd slopes(shot.off.size(), static_cast<Eigen::Index>(keys.size()));
        for (std::size_t i = 0; i < places_.size(); ++i)
            for (std::size_t k = 0; k < keys.size(); ++k)
                slopes.block<2, 1>(static_cast<Eigen::Index>(2 * i), static_cast<Eigen::Index>(k)) =
                    range(k) * planar(by.state(0, places_[i].ball, k).position);
        Eigen::JacobiSVD<MatrixXd> svd(slopes, Eigen::ComputeThinU | Eigen::ComputeThinV);
        svd.setThreshold(kWeak);
        VectorXd move = -svd.solve(shot.off);
        for (std::size_t k = 0; k < keys.size(); ++k) move[static_cast<Eigen::Index>(k)] *= range(k);
        return move;
    }

    const Scene& scene_;
    std::span<const Choice> choices_;
    std::span<const Place> places_;
    kernel::Isa isa_;
    const std::function<bool(const Record&)>& allowed_;
    std::vector<SceneNumber> numbers_;
    int shots_ = 0;
};

}  // namespace

Refined refine(const Scene& scene, std::span<const Choice> choices, std::span<const Place> places,
               kernel::Isa isa, const std::function<bool(const Record&)>& allowed) {
    return Refiner(scene, choices, places, isa, allowed).run();
}

Exact exact(const Solution& found, const Measure& want, kernel::Isa isa, const SolveOptions& options) {
    const std::vector<Place> places = want.places();
    if (places.empty())
        throw std::invalid_argument("the goal has no place; add one, as in cue near (0.6, 1.2, 0.05)");
    Exact result{{}, options.choices, {}};
    for (std::size_t k = 0; k < result.choices.size(); ++k) {
        Choice& choice = result.choices[k];
        const double aim = found.scene.cue->aim_deg, per = found.scene.cue->speed / found.values[k];
        if (choice.key.starts_with("hit.")) choice = {"cue.aim_deg", aim - kTurn, aim + kTurn};
        if (choice.key == kBallSpeed) choice = {"cue.speed", choice.low * per, choice.high * per};
    }
    result.refined = refine(found.scene, result.choices, places, isa,
                            [&want](const Record& record) { return want.holds(record); });
    if (!result.refined.trouble.empty()) return result;
    SolveOptions once = options;
    once.choices = result.choices;
    for (std::size_t k = 0; k < once.choices.size(); ++k)
        once.choices[k].low = once.choices[k].high = result.refined.values[k];
    once.racks = {};
    once.best = 1;
    once.shots = static_cast<std::size_t>(kExactShare * static_cast<double>(once.shots));
    result.solution = solve(result.refined.scene, want, isa, once)[0];
    return result;
}

}  // namespace carom::games
