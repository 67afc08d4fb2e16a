#include "carom/engine/derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/fnv.h"
#include "carom/engine/batch.h"
#include "carom/engine/scene_number.h"
#include "carom/engine/simulate.h"

namespace carom {
namespace {

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
constexpr double kUnmoved = 1e-6;
// From this many balls on, the shots are long enough for threads.
constexpr std::size_t kManyBalls = 4;

constexpr double kNone = std::numeric_limits<double>::infinity();

double largest(const Vec3& v) {
    return v.cwiseAbs().maxCoeff();
}

/// What identifies an event in another shot: its kind, its partners, and how often they have met before.
/// `past` is everything that happened before to the balls that meet.
struct Mark {
    std::uint64_t id, past;
};
std::uint64_t mix(std::initializer_list<std::uint64_t> numbers) {
    Fnv hash;
    for (const std::uint64_t number : numbers) hash.add(number);
    return hash.value();
}

/// What happened to each ball, with everything that happened before to the balls that it met: two shots in
/// which this is equal have the same causes in the same order. Rolling, stopping and the end of spin are left
/// out: they do not push anything.
class Pasts {
  public:
    explicit Pasts(const Record& record) : record_(record), balls_(record.tracks.size()) {}

    std::uint64_t of(std::size_t ball) const { return balls_[ball].past; }

    Mark add(const Event& event) {
        const EventKind& what = kind(event.type);
        Ball& a = balls_[static_cast<std::size_t>(event.a)];
        const bool pair = what.partner == Partner::kBall;
        const auto type = static_cast<std::uint64_t>(event.type);
        const auto one = static_cast<std::uint64_t>(pair ? std::min(event.a, event.b) : event.a),
                   two = static_cast<std::uint64_t>(pair ? std::max(event.a, event.b) : event.b);
        const bool pushes = what.phase != EventPhase::kTransition || what.partner != Partner::kNone ||
                            event.type == EventType::kBallOut;
        if (!pushes) {
            const std::uint64_t id = mix({type, one, a.pushes});
            return {mix({id, ++times_[id]}), mix({id, a.past})};
        }
        std::vector<int> met{event.a};
        if (event.type == EventType::kBallCluster)
            met = record_.clusters[static_cast<std::size_t>(event.detail)];
        else if (pair)
            met.push_back(event.b);
        std::uint64_t all = 0;  // in any order
        for (const int ball : met)
            all += mix({balls_[static_cast<std::size_t>(ball)].past, static_cast<std::uint64_t>(ball)});
        const std::uint64_t past = mix({all, type, pair ? 0 : two}), id = mix({type, one, two});
        for (const int ball : met) {
            balls_[static_cast<std::size_t>(ball)].past = past;
            ++balls_[static_cast<std::size_t>(ball)].pushes;
        }
        return {mix({id, ++times_[id]}), past};
    }

  private:
    struct Ball {
        std::uint64_t past = 1, pushes = 0;
    };
    const Record& record_;
    std::vector<Ball> balls_;
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
    std::vector<Vec3> last;
    Vec3 last_bend = Vec3::Zero();
    for (const Pair& pair : pairs) {
        const auto comparable = [&](const std::vector<Result>& shot) {
            return !shot.empty() && (same ? shot[which].past == middle.past : shot[which].past != 0);
        };
        const bool use = comparable(pair.low) && comparable(pair.high);
        if (!use) {
            last.clear();
            continue;
        }
        const Vec3 &low = pair.low[which].x, &high = pair.high[which].x;
        std::vector<Vec3> row{(high - low) / (2.0 * pair.step)};
        const Vec3 bend = ((high - middle.x) + (low - middle.x)) / (2.0 * pair.step);
        // In proportion to the step, unless the derivative jumps here or rounding decides.
        const double jump = largest(bend - last_bend / kRatio) / (1.0 - 1.0 / kRatio);
        double power = 1.0;
        for (std::size_t k = 0; k < last.size(); ++k) {
            power *= kRatio * kRatio;
            row.push_back(row[k] + (row[k] - last[k]) / (power - 1.0));
            const double change = largest(row[k + 1] - row[k]), size = largest(row[k + 1]);
            double error = change;
            // The terms of Taylor's series shrink by a constant factor: that of the next one is known.
            if (k == 0 && same && change < 0.2 * size) error = 5.0 * change * change / size;
            error = std::max(error, kJump * jump);
            if (error < best.error) best = {row[k + 1], error};
        }
        last = std::move(row);
        last_bend = bend;
    }
    return best;
}

}  // namespace

class Differences {
  public:
    Differences(Derivatives& out, const Plan& plan, const Record& record, const std::vector<double>& times,
                const std::vector<std::size_t>& events)
        : out_(out), scene_(plan.scene), record_(record), isa_(plan.isa), events_(events) {
        if (plan.sizes.size() != record.tracks.size())
            throw std::invalid_argument("the record is not of this plan: it has another number of balls");
        out_.balls_ = plan.sizes.size();
        for (const BallSize& size : plan.sizes) radii_.push_back(size.R);
        scene_.physics.tolerance = kTolerance;
        scene_.physics.substeps.reset();
        scene_.effects.clear();  // other shots may need one that this one excludes
        try {
            validate(scene_);
        } catch (const SceneError& error) {
            throw DerivativeError(error.message());
        }
        const bool rests = record.stopped == StopReason::kAtRest;
        for (const double time : times)
            times_.push_back(time < record.duration ? std::max(time, 0.0) : rests ? kNone : record.duration);
        order_.resize(times.size());
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::sort(order_.begin(), order_.end(),
                  [this](std::size_t a, std::size_t b) { return times_[a] < times_[b]; });
        double until = times.empty() ? 0.0 : times_[order_.back()];
        for (const std::size_t event : events) until = std::max(until, record.events[event].time + kAfter);
        if (until < kNone) options_.until = until;
        if (!rests) scene_.stop.events.reset();
        Pasts pasts(record);
        std::vector<std::uint64_t> ids;
        for (const Event& event : record.events) ids.push_back(pasts.add(event).id);
        for (const std::size_t event : events) ids_.push_back(ids[event]);
        middle_ = results_of(simulate(make_plan(scene_, isa_), options_));
        ++out_.shots_;
    }

    void add(const std::string& key) {
        const SceneNumber number = check_varies(scene_, key);
        const double value = number.value(scene_);
        if (std::isnan(value))
            throw DerivativeError(fmt::format("{} is not a real number that the scene sets", key));
        const Interval& range = number.row().range;
        double size = std::abs(value);
        if (std::string_view(range.unit) == "degrees")
            size = kAngle;
        else if (range.low < 0.0)
            size = std::max(1.0, size);
        const auto fits = [&](int k) {
            return contains(range, value - step(size, k)) && contains(range, value + step(size, k));
        };
        int least = 0;
        while (least < kSteps - 2 && size > 0.0 && !fits(least)) ++least;
        if (!(size > 0.0) || !fits(least))
            throw DerivativeError(
                fmt::format("{} = {} is at the end of its range, where it has no derivative; move it inwards",
                            key, value));
        Derivatives::Column column{key, "", {}, {}, kNone};
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
            const std::vector<Pair> more = play(key, value, size, shorter ? next : first - 1, 1, column.why);
            pairs.insert(shorter ? pairs.end() : pairs.begin(), more.begin(), more.end());
            if (shorter)
                ++next;
            else
                --first;
        }
        first_ = std::max(0, next - 3);
        out_.columns_.push_back(std::move(column));
    }

  private:
    static double step(double size, int k) { return kFirstStep * size * std::pow(kRatio, -k); }

    std::vector<Pair> play(const std::string& key, double value, double size, int first, int count,
                           std::string& why) {
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
             simulate_many(scene_, values.size(), {&column, 1}, isa_, options, {}))
            why = message.text;
        out_.shots_ += static_cast<int>(values.size());
        std::vector<Pair> pairs;
        for (std::size_t k = 0; k < values.size(); k += 2)
            pairs.push_back({0.5 * (values[k + 1] - values[k]), results[k], results[k + 1]});
        return pairs;
    }

    /// States of every ball at every time (position, velocity, R spin), then times and places of events.
    std::vector<Result> results_of(const Record& record) const {
        std::vector<Result> results(3 * times_.size() * out_.balls_ + 2 * events_.size(), {Vec3::Zero(), 0});
        Pasts pasts(record);
        auto event = record.events.begin();
        std::vector<Mark> marks;
        for (const std::size_t k : order_) {
            for (; event != record.events.end() && event->time <= times_[k]; ++event)
                marks.push_back(pasts.add(*event));
            const double time = std::min(times_[k], record.duration);
            for (std::size_t ball = 0; ball < out_.balls_; ++ball) {
                const BallState state = record.state_at(static_cast<int>(ball), time);
                if (is_gone(state.state)) continue;
                Result* to = &results[3 * (k * out_.balls_ + ball)];
                to[0] = {state.position, pasts.of(ball)};
                to[1] = {state.velocity, to[0].past};
                to[2] = {radii_[ball] * state.spin, to[0].past};
            }
        }
        if (events_.empty()) return results;
        for (; event != record.events.end(); ++event) marks.push_back(pasts.add(*event));
        for (std::size_t e = 0; e < events_.size(); ++e) {
            const auto found = std::find_if(marks.begin(), marks.end(),
                                            [&](const Mark& mark) { return mark.id == ids_[e]; });
            if (found == marks.end()) continue;
            const Event& same = record.events[static_cast<std::size_t>(found - marks.begin())];
            Result* to = &results[3 * times_.size() * out_.balls_ + 2 * e];
            to[0] = {{same.time, 0.0, 0.0}, found->past};
            to[1] = {record.state_at(same.a, same.time).position, found->past};
            to[1].x.z() = 0.0;
        }
        return results;
    }

    /// The derivatives from these pairs, and their error.
    void read(const std::vector<Pair>& pairs, double size, Derivatives::Column& column) const {
        const std::size_t states = 3 * times_.size() * out_.balls_;
        std::vector<Slope> slopes;
        // By kind: position, velocity, spin, time and place.
        std::array<double, 5> most, errors{};
        most.fill(kUnmoved / size);
        for (std::size_t i = 0; i < middle_.size(); ++i) {
            Slope slope{Vec3::Zero(), 0.0};
            if (middle_[i].past != 0) {
                slope = slope_of(pairs, i, middle_[i], true);
                if (!(slope.error < kNone)) slope = slope_of(pairs, i, middle_[i], false);
            } else if (i >= states) {
                slope.x.setConstant(std::numeric_limits<double>::quiet_NaN());
            }
            const std::size_t kind = i < states ? i % 3 : 3 + (i - states) % 2;
            if (middle_[i].past != 0) most[kind] = std::max(most[kind], largest(slope.x));
            errors[kind] = std::max(errors[kind], slope.error);
            slopes.push_back(slope);
        }
        column.error = 0.0;
        for (std::size_t kind = 0; kind < most.size(); ++kind)
            column.error = std::max(column.error, errors[kind] / most[kind]);
        column.states.clear(), column.events.clear();
        for (std::size_t i = 0; i < states; i += 3)
            column.states.push_back(
                {slopes[i].x, slopes[i + 1].x, slopes[i + 2].x / radii_[i / 3 % out_.balls_]});
        for (std::size_t i = states; i < slopes.size(); i += 2)
            column.events.push_back({slopes[i].x.x(), planar(slopes[i + 1].x)});
    }

    // [s] Shots continue for this long after the last event that is wanted.
    static constexpr double kAfter = 0.1;

    Derivatives& out_;
    Scene scene_;
    const Record& record_;
    kernel::Isa isa_;
    const std::vector<std::size_t>& events_;
    std::vector<std::uint64_t> ids_;  // of these events
    std::vector<double> times_;       // infinite: at rest
    std::vector<std::size_t> order_;  // of the times
    std::vector<double> radii_;
    SimulateOptions options_;
    std::vector<Result> middle_;
    int first_ = 0;  // step of the next column
};

Derivatives::Derivatives(const Plan& plan, const Record& record, const std::vector<std::string>& inputs,
                         const std::vector<double>& times, const std::vector<std::size_t>& events) {
    Differences differences(*this, plan, record, times, events);
    for (const std::string& input : inputs) differences.add(input);
}

std::string Derivatives::refusal(std::size_t input) const {
    const Column& column = columns_[input];
    if (column.error <= kMostDerivativeError) return "";
    return fmt::format("{} has no derivative here: {} (estimated error {:.2g})", column.input,
                       column.why.empty() ? "an event begins or ends within the smallest step" : column.why,
                       column.error);
}

void Derivatives::check() const {
    for (std::size_t input = 0; input < columns_.size(); ++input)
        if (const std::string why = refusal(input); !why.empty()) throw DerivativeError(why);
}

}  // namespace carom
