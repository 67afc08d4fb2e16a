#include "carom/games/solve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/draws.h"
#include "carom/kernel/splitmix64.h"
#include "trials.h"

namespace carom::games {
namespace {

using detail::Candidate;
using detail::Trials;

// Shares of the budget: the first look at the whole space, the generations, and the choice among the last
// generation; the rest is for the figures.
constexpr double kLook = 0.30, kBreed = 0.42, kChoose = 0.08, kReport = 0.10;
// The first look gives each candidate one shot, and in further rounds this many times more to the best
// twelfth. Many single shots find narrow places: a few percent of them succeed, most of these on the flank of
// a place.
constexpr std::size_t kMore = 4, kRounds = 3, kKept = 12;
// Searches on their own, from other places, and the generations before their best come together.
constexpr std::size_t kStarts = 2;
constexpr int kGenerations = 8, kApart = 3;
// The largest distance of descendants from their parents as a fraction of a range, its factor per generation,
// and the halvings of it that are drawn: the size of a place is not known.
constexpr double kNearby = 0.10, kShrink = 0.75, kOctaves = 5.0;
// [-] Share of descendants that first move along the line through another parent nearby: good shots lie on
// ridges.
constexpr double kAlong = 0.3;
// Parents of all searches, their factor per generation, and the fewest; shots of a descendant, then of the
// best quarter of them and of the parents, and the factor of both.
constexpr double kParents = 64.0, kFewer = 0.7;
constexpr std::size_t kFewest = 8;
constexpr double kYoung = 8.0, kGrown = 30.0, kLonger = 1.2;
// [shots] Of the best of each search, to compare them.
constexpr std::size_t kCompare = 200;
// [-] Two shots are of different kind if some input differs by this fraction of its range.
constexpr double kOtherKind = 0.12;
// [-] Of this, between the places of the first look.
constexpr double kSamePlace = 0.15;
// A map: cells per side, its share of the budget, and its half-width in distances at which success halves.
constexpr std::size_t kSide = 24;
constexpr double kMap = 0.15, kReach = 3.0;
// Errors whose cost is reported.
constexpr double kAimOff = 0.2, kSpeedOff = 0.05, kTipOff = 0.05, kPlaceOff = 0.01;

class Solver {
  public:
    Solver(const Scene& scene, const Measure& want, kernel::Isa isa, const SolveOptions& options)
        : trials_(scene, want, isa, options), options_(options) {}

    std::vector<Solution> run(std::vector<double>* starts) {
        std::vector<Candidate> best;
        for (std::size_t start = 0; start < kStarts; ++start) {
            std::vector<Candidate> found = look();
            for (int generation = 0; generation < kApart; ++generation)
                found = breed(std::move(found), generation, kStarts);
            std::vector<Candidate> first(found.begin(), found.begin() + 1);
            trials_.play(first, std::max(first[0].shots, kCompare));
            if (starts != nullptr) starts->push_back(share_of(first[0].successes, first[0].shots).value);
            best.insert(best.end(), found.begin(), found.end());
        }
        for (int generation = kApart; generation < kGenerations; ++generation)
            best = breed(std::move(best), generation, 1);
        // After 120 shots the best is often only the luckiest.
        trials_.play(best, best[0].shots + static_cast<std::size_t>(kChoose * budget()) / best.size());
        sort(best);
        std::vector<Candidate> kinds = different(best, kOtherKind, std::max<std::size_t>(1, options_.best));
        // Shots that the search has not used.
        const auto each = std::max<std::size_t>(
            100, static_cast<std::size_t>(kReport * static_cast<double>(options_.shots)) / kinds.size());
        trials_.fresh = true;
        std::vector<Solution> solutions;
        solutions.reserve(kinds.size());
        for (const Candidate& kind : kinds) {
            Solution& found = solutions.emplace_back(improved(solution(kind.values, each), each));
            found.exact = options_.unknown == kExactTable ? found.successes : exact_successes(found);
        }
        std::stable_sort(solutions.begin(), solutions.end(), [](const Solution& a, const Solution& b) {
            return a.successes * b.shots > b.successes * a.shots;
        });
        return solutions;
    }

    SuccessMap map(const Solution& around) {
        if (options_.choices.size() < 2)
            throw std::invalid_argument("a map needs two inputs; give two ranges");
        trials_.fresh = true;
        const std::size_t each = std::max<std::size_t>(
            8, static_cast<std::size_t>(kMap * static_cast<double>(options_.shots)) / (kSide * kSide));
        std::vector<std::pair<double, std::size_t>> order;
        for (std::size_t k = 0; k < options_.choices.size(); ++k)
            order.emplace_back(half_width(around, k, each), k);
        std::sort(order.begin(), order.end());
        SuccessMap map;
        std::array<Choice, 2> window;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto [part, k] = order[axis];
            map.choices[axis] = k;
            const Choice& choice = options_.choices[k];
            const double reach = std::max(kReach * part * range(k), 1e-9);
            window[axis].low = std::max(choice.low, around.values[k] - reach);
            window[axis].high = std::min(choice.high, around.values[k] + reach);
        }
        const auto at = [](const Choice& c, std::size_t i) {
            return c.low + (c.high - c.low) * (static_cast<double>(i) + 0.5) / kSide;
        };
        std::vector<Candidate> cells;
        for (std::size_t row = 0; row < kSide; ++row)
            for (std::size_t column = 0; column < kSide; ++column) {
                map.cells.push_back({{at(window[0], column), at(window[1], row)}, 0.0});
                Candidate& cell = cells.emplace_back(Candidate{around.values});
                for (std::size_t axis = 0; axis < 2; ++axis)
                    cell.values[map.choices[axis]] = map.cells.back().place[axis];
            }
        trials_.play(cells, each);
        for (std::size_t i = 0; i < cells.size(); ++i) map.cells[i].success = cells[i].score();
        return map;
    }

  private:
    /// The error of a choice, as a fraction of its range, at which success halves on average of both sides; 1
    /// if it never does.
    double half_width(const Solution& around, std::size_t k, std::size_t shots) {
        constexpr std::size_t kHalvings = 12;
        const double low = options_.choices[k].low, high = options_.choices[k].high;
        std::vector<Candidate> off(2 * kHalvings + 1, Candidate{around.values});
        for (std::size_t i = 0; i < 2 * kHalvings; ++i) {
            const double by = std::ldexp(range(k), -static_cast<int>(i / 2));
            double& value = off[i].values[k];
            value = std::clamp(value + (i % 2 == 0 ? -by : by), low, high);
        }
        trials_.play(off, shots);
        double part = 1.0;
        for (std::size_t i = 0; i < kHalvings; ++i)
            if (off[2 * i].score() + off[2 * i + 1].score() < off.back().score())
                part = std::ldexp(1.0, -static_cast<int>(i));
        return part;
    }

    static void sort(std::vector<Candidate>& list) {
        std::stable_sort(list.begin(), list.end(),
                         [](const Candidate& a, const Candidate& b) { return a.score() > b.score(); });
    }

    double budget() const { return static_cast<double>(options_.shots); }
    /// Shots per cost of an error.
    std::size_t detail_shots() const { return std::clamp<std::size_t>(options_.shots / 400, 25, 1000); }
    double range(std::size_t k) const { return options_.choices[k].high - options_.choices[k].low; }

    /// Halton's sequence, shifted by the seed, over the whole space.
    std::vector<Candidate> look() {
        double cost = 0.0, part = 1.0, before = 0.0, shots = 1.0;
        for (std::size_t round = 0; round < kRounds; ++round, part /= kKept, before = shots, shots *= kMore)
            cost += part * (shots - before);
        const auto count = std::max<std::size_t>(
            64, static_cast<std::size_t>(kLook * budget() / static_cast<double>(kStarts) / cost));
        SplitMix64 random(options_.seed + 0x9e3779b9u * looks_++);
        std::vector<double> shift(options_.choices.size());
        for (double& s : shift) s = random.uniform();
        constexpr std::array<int, 12> kPrimes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
        std::vector<Candidate> all(count);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < options_.choices.size(); ++k) {
                double x = shift[k], digit = 1.0;
                const int base = kPrimes[k % kPrimes.size()];
                for (std::size_t n = i + 1; n > 0; n /= static_cast<std::size_t>(base))
                    x += (digit /= base) * static_cast<double>(n % static_cast<std::size_t>(base));
                x -= std::floor(x);
                all[i].values.push_back(options_.choices[k].low + x * range(k));
            }
        }
        const std::size_t most = parents(0, kStarts);
        std::size_t each = 1;
        for (std::size_t round = 0; round < kRounds; ++round, each *= kMore) {
            trials_.play(all, each);
            sort(all);
            if (round + 1 < kRounds) all.resize(std::max<std::size_t>(most, all.size() / kKept));
        }
        return different(all, kSamePlace * kOtherKind, most);
    }

    static std::size_t parents(int generation, std::size_t searches) {
        return std::max(kFewest,
                        static_cast<std::size_t>(kParents * std::pow(kFewer, generation)) / searches);
    }

    /// The best of these and their descendants. @param searches  that share the generation's budget
    std::vector<Candidate> breed(std::vector<Candidate> old, int generation, std::size_t searches) {
        const double shots = kBreed * budget() / kGenerations / static_cast<double>(searches);
        const double longer = std::pow(kLonger, generation), nearby = kNearby * std::pow(kShrink, generation);
        const auto young_shots = static_cast<std::size_t>(kYoung * longer),
                   grown_shots = static_cast<std::size_t>(kGrown * longer);
        const std::size_t most = parents(generation, searches);
        const auto count = std::max<std::size_t>(
            most, static_cast<std::size_t>(4.0 * shots / static_cast<double>(3 * young_shots + grown_shots)));
        std::vector<Candidate> young;
        SplitMix64 random(options_.seed + 0x5bf03635u * ++generation_);
        // The better half has three quarters of the descendants.
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t half = (old.size() + 1) / 2;
            const std::size_t from = i % 4 == 3 ? half + (i / 4) % std::max<std::size_t>(1, old.size() - half)
                                                : (i - i / 4) % half;
            Candidate child;
            child.values = old[std::min(from, old.size() - 1)].values;
            if (random.uniform() < kAlong) {
                const Candidate& other =
                    old[static_cast<std::size_t>(random.below(static_cast<int>(old.size())))];
                if (apart(child, other) < kOtherKind) {
                    const double by = standard_normal(random);
                    for (std::size_t k = 0; k < child.values.size(); ++k)
                        child.values[k] += by * (child.values[k] - other.values[k]);
                }
            }
            for (std::size_t k = 0; k < child.values.size(); ++k) {
                const double by = nearby * std::exp2(-kOctaves * random.uniform()) * range(k);
                child.values[k] = std::clamp(child.values[k] + by * standard_normal(random),
                                             options_.choices[k].low, options_.choices[k].high);
            }
            young.push_back(std::move(child));
        }
        trials_.play(young, young_shots);
        sort(young);
        young.resize(std::max<std::size_t>(most, young.size() / 4));
        trials_.play(young, grown_shots);
        trials_.play(old, grown_shots);
        young.insert(young.end(), old.begin(), old.end());
        sort(young);
        std::vector<Candidate> kept = different(young, 0.5 * nearby, parents(generation + 1, searches));
        // The best of other kinds remain, too.
        for (Candidate& kind : different(young, kOtherKind, std::max<std::size_t>(1, options_.best)))
            if (std::none_of(kept.begin(), kept.end(),
                             [&](const Candidate& other) { return apart(kind, other) == 0.0; }))
                kept.push_back(std::move(kind));
        return kept;
    }

    /// The largest difference of two candidates as a fraction of a range.
    double apart(const Candidate& one, const Candidate& other) const {
        double away = 0.0;
        for (std::size_t k = 0; k < one.values.size(); ++k)
            if (range(k) > 0.0) away = std::max(away, std::abs(one.values[k] - other.values[k]) / range(k));
        return away;
    }

    /// The best, without candidates near to a better one.
    std::vector<Candidate> different(const std::vector<Candidate>& sorted, double least,
                                     std::size_t most) const {
        std::vector<Candidate> kept;
        for (const Candidate& candidate : sorted) {
            const bool near = std::any_of(kept.begin(), kept.end(), [&](const Candidate& other) {
                return apart(candidate, other) < least;
            });
            if (!near) kept.push_back(candidate);
            if (kept.size() == most) break;
        }
        return kept;
    }

    /// Replaces a shot by one of its erroneous versions while that is better, so that no reported error
    /// improves success beyond the intervals.
    Solution improved(Solution found, std::size_t shots) {
        constexpr int kMost = 20;
        for (int k = 0; k < kMost; ++k) {
            const Share on = share_of(found.successes, found.shots);
            std::optional<std::vector<double>> better;
            double most = on.high;
            for (const Cost& cost : found.costs)
                for (const double way : {-1.0, 1.0}) {
                    const double part = way < 0.0 ? cost.less : cost.more;
                    const double low = part > 0.0 ? with_interval(part, cost.shots).low : 0.0;
                    const auto values = low > most ? moved(found.values, cost, way) : std::nullopt;
                    if (values) better = values, most = low;
                }
            if (!better) return found;
            Solution next = solution(*better, shots);
            if (next.successes <= found.successes) return found;
            found = std::move(next);
        }
        return found;
    }
    /// The choices with one input off, if that is within its range.
    std::optional<std::vector<double>> moved(std::vector<double> values, const Cost& cost, double way) const {
        for (std::size_t k = 0; k < values.size(); ++k) {
            const Choice& choice = options_.choices[k];
            if (choice.key != cost.input && !(cost.input == "aim" && choice.key == "cue.aim_deg")) continue;
            values[k] += way * cost.by;
            if (values[k] >= choice.low && values[k] <= choice.high) return values;
        }
        return std::nullopt;
    }

    /// All figures of a shot come from the same errors.
    Solution solution(const std::vector<double>& values, std::size_t shots) {
        std::vector<Candidate> meant_so(1, Candidate{values});
        std::map<std::pair<int, int>, std::size_t> falls;
        std::mutex guard;
        trials_.play(meant_so, shots, [&](std::size_t, const Record& record) {
            const std::lock_guard lock(guard);
            for (const Event& event : record.events)
                if (event.type == EventType::kBallPocket) ++falls[{event.a, event.b}];
        });
        const Candidate& candidate = meant_so[0];
        Solution found;
        found.values = values;
        found.shots = candidate.shots;
        found.successes = candidate.successes;
        found.scene = trials_.meant_scene(values);
        for (const auto& [fall, count] : falls)
            found.falls.push_back({found.scene.ball[static_cast<std::size_t>(fall.first)].id,
                                   found.scene.table.pockets[static_cast<std::size_t>(fall.second)].id,
                                   share_of(count, found.shots).value});
        std::stable_sort(found.falls.begin(), found.falls.end(),
                         [](const Fall& one, const Fall& two) { return one.share > two.share; });
        add_costs(candidate, found.costs);
        return found;
    }
    std::size_t exact_successes(const Solution& found) {
        std::vector<Candidate> one(1, Candidate{found.values});
        trials_.exact = true;
        trials_.play(one, found.shots);
        trials_.exact = false;
        return one[0].successes;
    }
    void add_costs(const Candidate& candidate, std::vector<Cost>& costs) {
        for (std::size_t k = 0; k < options_.choices.size(); ++k) {
            const std::string& key = options_.choices[k].key;
            const bool place = key.find(".position.") != key.npos, tip = key.rfind("cue.offset", 0) == 0,
                       speed = key == "cue.speed";
            if (!place && !tip && !speed) continue;
            const double by = speed ? kSpeedOff * candidate.values[k] : place ? kPlaceOff : kTipOff;
            costs.push_back(cost(candidate, key, by,
                                 speed   ? "m/s"
                                 : place ? "m"
                                         : "ball radii",
                                 [&, k](Candidate& c, double off) { c.values[k] += off; }));
        }
        costs.push_back(cost(candidate, "aim", kAimOff, "degrees",
                             [this](Candidate&, double off) { trials_.turned = off; }));
    }
    template <class Off>
    Cost cost(const Candidate& candidate, const std::string& input, double by, const char* unit, Off&& off) {
        const std::size_t shots = std::min(detail_shots(), candidate.shots);
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        Cost cost{input, by, unit, kNone, kNone, static_cast<int>(shots)};
        for (const bool less : {true, false}) {
            std::vector<Candidate> moved(1, Candidate{candidate.values});
            off(moved[0], less ? -by : by);
            trials_.play(moved, shots);
            trials_.turned = 0.0;
            if (moved[0].invalid < shots) (less ? cost.less : cost.more) = moved[0].score();
        }
        return cost;
    }
    Trials trials_;
    const SolveOptions& options_;
    std::uint64_t looks_ = 0, generation_ = 0;
};

}  // namespace

Share share_of(std::size_t part, std::size_t whole) {
    // 95 % of a normal distribution lie within.
    constexpr double kZ = 1.959963984540054;
    if (whole == 0) return {0.0, 0.0, 1.0};
    const double n = static_cast<double>(whole), p = static_cast<double>(part) / n, z2 = kZ * kZ / n;
    const double middle = (p + 0.5 * z2) / (1.0 + z2);
    const double half = kZ * std::sqrt(p * (1.0 - p) / n + 0.25 * z2 / n) / (1.0 + z2);
    // At 0 and 1, the interval must contain the share despite rounding.
    return {p, part == 0 ? 0.0 : middle - half, part == whole ? 1.0 : middle + half};
}

Share with_interval(double share, std::size_t shots) {
    return share_of(static_cast<std::size_t>(std::llround(share * static_cast<double>(shots))), shots);
}

std::vector<Choice> default_choices() {
    return {{"cue.aim_deg", 0.0, 360.0}, {"cue.speed", 0.5, 6.0}, {"cue.offset.height", -0.4, 0.4}};
}

std::vector<Solution> solve(const Scene& scene, const Measure& want, kernel::Isa isa,
                            const SolveOptions& options, std::vector<double>* starts) {
    return Solver(scene, want, isa, options).run(starts);
}

SuccessMap success_map(const Scene& scene, const Measure& want, kernel::Isa isa, const SolveOptions& options,
                       const Solution& around) {
    return Solver(scene, want, isa, options).map(around);
}

}  // namespace carom::games
