#include "carom/engine/derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/fnv.h"
#include "carom/engine/batch.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"

namespace carom {
namespace differences {

// physics.tolerance of the shots that are compared.
constexpr double kTolerance = 1e-12;
// [sizes of the input] The first step, and how many times shorter each next one is.
constexpr double kFirstStep = 3e-4, kRatio = 4.0;
constexpr int kSteps = 13;
// [degrees] The size of an angle; other inputs are as large as they are.
constexpr double kAngle = 30.0;
// [-] Shorter steps are tried until the estimated error of the column is at most
// the first; above the second, they are tried until two in a row do not help.
constexpr double kEnough = 1e-6, kFair = 1e-4;
// [-] One difference is a sample of its rounding errors: others are larger by up to this.
constexpr double kJump = 3.0;
// [m], [m/s] or [s] An input that changes a result by less than this over its whole size does not change it.
constexpr double kUnmoved = 1e-3;
// From this many balls on, the shots are long enough for threads.
constexpr std::size_t kManyBalls = 4;

constexpr double kNone = std::numeric_limits<double>::infinity();

inline double largest(const Vec3& v) {
    return v.cwiseAbs().maxCoeff();
}

inline std::uint64_t mix(std::initializer_list<std::uint64_t> numbers) {
    Fnv hash;
    for (const std::uint64_t number : numbers) hash.add(number);
    return hash.value();
}

/// The past of each ball: its events, and the past of every ball that it met. Two shots in which this is
/// equal have the same causes in the same order. Rolling, stopping and the end of spin are left
/// out: they do not push anything.
class Pasts {
  public:
    struct Mark {
        std::uint64_t id;    ///< of an event in other shots: its kind and partners, and how often they met
        std::uint64_t past;  ///< of the balls that meet
    };
    std::vector<Mark> marks;  ///< of all events

    explicit Pasts(const Record& record)
        : balls_(record.tracks.size(), {{-std::numeric_limits<double>::infinity(), 1}}) {
        for (const Event& event : record.events) {
            const EventKind& type_of = kind(event.type);
            const bool pair = type_of.partner == Partner::kBall;
            const auto number = [](auto x) { return static_cast<std::uint64_t>(x); };
            const auto type = number(event.type), one = number(pair ? std::min(event.a, event.b) : event.a),
                       two = number(pair ? std::max(event.a, event.b) : event.b);
            if (type_of.phase == EventPhase::kTransition && type_of.partner == Partner::kNone &&
                event.type != EventType::kBallOut) {
                const auto& before = balls_[one];
                const std::uint64_t id = mix({type, one, before.size()});
                marks.push_back({mix({id, ++times_[id]}), mix({id, before.back().second})});
                continue;
            }
            std::vector<int> met{event.a};
            if (event.type == EventType::kBallCluster)
                met = record.clusters[number(event.detail)].balls;
            else if (pair)
                met.push_back(event.b);
            std::uint64_t all = 0;  // in any order
            for (const int ball : met) all += mix({balls_[number(ball)].back().second, number(ball)});
            const std::uint64_t past = mix({all, type, pair ? 0 : two}), id = mix({type, one, two});
            for (const int ball : met) balls_[number(ball)].emplace_back(event.time, past);
            marks.push_back({mix({id, ++times_[id]}), past});
        }
    }
    std::uint64_t at(std::size_t ball, double time) const {
        const auto after = std::upper_bound(balls_[ball].begin(), balls_[ball].end(), time,
                                            [](double t, const auto& entry) { return t < entry.first; });
        return after[-1].second;
    }

  private:
    std::vector<std::vector<std::pair<double, std::uint64_t>>> balls_;
    std::map<std::uint64_t, std::uint64_t> times_;
};

/// A result of a shot: three numbers, and the past on which they depend.
struct Result {
    Vec3 x;
    std::uint64_t past;  ///< 0: the shot lacks this result
};
/// A pair of shots at the input plus and minus a step.
struct Pair {
    double step;
    std::vector<Result> low, high;  ///< empty: not played
};
struct Slope {
    Vec3 x = Vec3::Zero();
    double error = kNone;
};

/// The derivative of one result, from pairs with shorter and shorter steps: the entry of the extrapolation to
/// the step 0 (Richardson) with the least estimated error.
/// @param same  use only shots in which the result has the same past
Slope slope_of(const std::vector<Pair>& pairs, std::size_t which, const Result& middle, bool same) {
    Slope best;
    std::array<Vec3, kSteps> row, last;
    row.fill(Vec3::Zero());
    Vec3 last_bend = Vec3::Zero();
    std::size_t known = 0;  // entries of `last`
    for (const Pair& pair : pairs) {
        const auto comparable = [&](const auto& shot) {
            return !shot.empty() && (same ? shot[which].past == middle.past : shot[which].past != 0);
        };
        if (!comparable(pair.low) || !comparable(pair.high)) {
            known = 0;
            continue;
        }
        const Vec3 &low = pair.low[which].x, &high = pair.high[which].x;
        row[0] = (high - low) / (2.0 * pair.step);
        const Vec3 bend = ((high - middle.x) + (low - middle.x)) / (2.0 * pair.step);
        double power = 1.0;
        for (std::size_t k = 0; k < known; ++k) {
            power *= kRatio * kRatio;
            row[k + 1] = row[k] + (row[k] - last[k]) / (power - 1.0);
            const double change = largest(row[k + 1] - row[k]), size = largest(row[k + 1]);
            double error = change;
            // The terms of Taylor's series shrink by a constant factor: that of the next one is known.
            if (k == 0 && same && change < 0.2 * size) error = 5.0 * change * change / size;
            // The bend is in proportion to the step, unless the derivative jumps here or rounding decides.
            error = std::max(error, kJump * largest(bend - last_bend / kRatio) / (1.0 - 1.0 / kRatio));
            if (error < best.error) best = {row[k + 1], error};
        }
        last = row;
        last_bend = bend;
        ++known;
    }
    return best;
}

}  // namespace differences

using namespace differences;

class Differences {
  public:
    Differences(Derivatives& out, const Plan& plan, const Record& record, const std::vector<double>& times,
                const std::vector<std::size_t>& events)
        : out_(out), plan_(plan), scene_(plan.scene) {
        if (plan.sizes.size() != record.tracks.size())
            throw std::invalid_argument("the record is not of this plan: it has another number of balls");
        out_.balls_ = plan.sizes.size();
        out_.states_ = 3 * times.size() * out_.balls_;
        scene_.physics.tolerance = kTolerance;
        scene_.physics.substeps.reset();
        scene_.effects.clear();  // other shots may need one that this one excludes
        validate(scene_);
        const bool rests = record.stopped == StopReason::kAtRest;
        for (const double time : times)
            times_.push_back(time < record.duration ? std::max(time, 0.0) : rests ? kNone : record.duration);
        double until = 0.0;
        for (const double time : times_) until = std::max(until, time);
        const Pasts pasts(record);
        for (const std::size_t event : events) {
            until = std::max(until, record.events[event].time + kAfter);
            ids_.push_back(pasts.marks[event].id);
        }
        if (until < kNone) options_.until = until;
        if (!rests) scene_.stop.events.reset();
        middle_ = results_of(simulate(make_plan(scene_, plan_.isa), options_));
        ++out_.shots_;
    }

    void add(const std::string& key) {
        const SceneNumber number = check_varies(scene_, key);
        const double value = number.value(scene_);
        if (std::isnan(value))
            throw DerivativeError(fmt::format("{} is not a real number that the scene sets", key));
        const Interval& range = number.row().range;
        const double size = std::string_view(range.unit) == "degrees"
                                ? kAngle
                                : std::max(range.low < 0.0 ? 1.0 : 0.0, std::abs(value));
        const auto fits = [&](int k) {
            return contains(range, value - step(size, k)) && contains(range, value + step(size, k));
        };
        int least = 0;
        while (least < kSteps - 2 && size > 0.0 && !fits(least)) ++least;
        if (!(size > 0.0) || !fits(least))
            throw DerivativeError(
                fmt::format("{} = {} is at the end of its range, where it has no derivative; move it inwards",
                            key, value));
        Derivatives::Column column{key, "", {}, kNone};
        int first = std::max(least, first_), next = first + 2;
        std::vector<Pair> pairs = play(key, value, size, first, 2, column.why);
        double best = kNone;
        for (int worse = 0;;) {
            read(pairs, size, column);
            if (column.error <= kEnough) break;
            worse = column.error < 0.5 * best ? 0 : worse + 1;
            best = std::min(best, column.error);
            const bool shorter =
                next < kSteps && (best > kMostDerivativeError || worse < (best > kFair ? 2 : 1));
            if (!shorter && (first == least || best <= kFair)) break;
            const auto more = play(key, value, size, shorter ? next++ : --first, 1, column.why);
            pairs.insert(shorter ? pairs.end() : pairs.begin(), more.begin(), more.end());
        }
        first_ = std::max(0, next - 3);
        out_.columns_.push_back(std::move(column));
    }

  private:
    static double step(double size, int k) { return kFirstStep * size * std::pow(kRatio, -k); }

    std::vector<Pair> play(const std::string& key, double value, double size, int first, int count,
                           std::string& why) {
        why.clear();
        std::vector<double> values;
        for (int k = first; k < first + count; ++k)
            for (const double sign : {-1.0, 1.0}) values.push_back(value + sign * step(size, k));
        std::vector<std::vector<Result>> results(values.size());
        BatchOptions options;
        options.simulate = options_;
        options.threads = out_.balls_ < kManyBalls ? 1 : 0;
        options.judge = [&](std::size_t shot, const Outcome&, const Record& record) {
            results[shot] = results_of(record);
        };
        const BatchColumn column{key, values};
        for (const Batch::Message& message :
             simulate_many(scene_, values.size(), {&column, 1}, plan_.isa, options, {}))
            why = message.text;
        out_.shots_ += static_cast<int>(values.size());
        std::vector<Pair> pairs;
        for (std::size_t k = 0; k < values.size(); k += 2)
            pairs.push_back({0.5 * (values[k + 1] - values[k]), results[k], results[k + 1]});
        return pairs;
    }

    /// States of every ball at every time (position, velocity, R spin), then times and places of events.
    std::vector<Result> results_of(const Record& record) const {
        std::vector<Result> results(out_.states_ + 2 * ids_.size(), {Vec3::Zero(), 0});
        const Pasts pasts(record);
        for (std::size_t i = 0; i < out_.states_; i += 3) {
            const std::size_t ball = i / 3 % out_.balls_;
            const double time = std::min(times_[i / 3 / out_.balls_], record.duration);
            const BallState state = record.state_at(static_cast<int>(ball), time);
            if (is_gone(state.state)) continue;
            const std::uint64_t past = pasts.at(ball, time);
            results[i] = {state.position, past};
            results[i + 1] = {state.velocity, past};
            results[i + 2] = {plan_.sizes[ball].R * state.spin, past};
        }
        for (std::size_t e = 0; e < ids_.size(); ++e) {
            const auto found = std::find_if(pasts.marks.begin(), pasts.marks.end(),
                                            [&](const Pasts::Mark& mark) { return mark.id == ids_[e]; });
            if (found == pasts.marks.end()) continue;
            const Event& same = record.events[static_cast<std::size_t>(found - pasts.marks.begin())];
            Result* to = &results[out_.states_ + 2 * e];
            to[0] = {{same.time, 0.0, 0.0}, found->past};
            to[1] = {record.state_at(same.a, same.time).position, found->past};
        }
        return results;
    }

    /// The derivatives from these pairs, and their error.
    void read(const std::vector<Pair>& pairs, double size, Derivatives::Column& column) const {
        // By kind: position, velocity, spin and events.
        std::array<double, 4> most, errors{};
        most.fill(kUnmoved / size);
        column.slopes.assign(middle_.size(), Vec3::Zero());
        for (std::size_t i = 0; i < middle_.size(); ++i) {
            const bool state = i < out_.states_;
            const std::size_t kind = state ? i % 3 : 3;
            if (middle_[i].past == 0) {
                if (!state) column.slopes[i].setConstant(std::numeric_limits<double>::quiet_NaN());
                continue;
            }
            Slope slope = slope_of(pairs, i, middle_[i], true);
            if (!(slope.error < kNone)) slope = slope_of(pairs, i, middle_[i], false);
            most[kind] = std::max(most[kind], largest(slope.x));
            errors[kind] = std::max(errors[kind], slope.error);
            column.slopes[i] = kind == 2 ? Vec3(slope.x / plan_.sizes[i / 3 % out_.balls_].R) : slope.x;
        }
        column.error = 0.0;
        for (std::size_t kind = 0; kind < most.size(); ++kind)
            column.error = std::max(column.error, errors[kind] / most[kind]);
    }

    // [s] Shots continue for this long after the last event that is wanted.
    static constexpr double kAfter = 0.1;

    Derivatives& out_;
    const Plan& plan_;
    Scene scene_;
    std::vector<std::uint64_t> ids_;  // of the events
    std::vector<double> times_;       // infinite: at rest
    SimulateOptions options_;
    std::vector<Result> middle_;
    int first_ = 0;  // step of the next column
};

Derivatives::Derivatives(const Plan& plan, const Record& record, const std::vector<std::string>& inputs,
                         const std::vector<double>& times, const std::vector<std::size_t>& events) {
    Differences differences(*this, plan, record, times, events);
    for (const std::string& input : inputs) differences.add(input);
}

std::string Derivatives::refusal(std::size_t input, double most) const {
    const Column& column = columns_[input];
    if (column.error <= most) return "";
    return fmt::format("{} has no derivative here: {} (estimated error {:.2g})", column.input,
                       column.why.empty() ? "an event begins or ends within the smallest step" : column.why,
                       column.error);
}

void Derivatives::check(double most) const {
    for (std::size_t input = 0; input < columns_.size(); ++input)
        if (const std::string why = refusal(input, most); !why.empty()) throw DerivativeError(why);
}

}  // namespace carom
