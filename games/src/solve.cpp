#include "carom/games/solve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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
static double env(const char* n,double d){const char*v=getenv(n);return v?atof(v):d;}
static const double kLook = env("LOOK",0.30), kBreed = env("BREED",0.42), kChoose = env("CHOOSE",.10), kReport = 0.10;
static const std::size_t kStarts = env("STARTS",1), kFinalists = env("FINAL",16);

// [shots] Per candidate in the first look, and how many more the remaining quarter gets in each round.
static const std::size_t kFirst = env("FIRST",8), kMore = env("MORE",3), kRounds = env("ROUNDS",3); static const double kKeep=env("KEEP",4);
// Generations, the initial distance of descendants from their parents as a fraction of a range, and its
// factor per generation.
static const int kGenerations = env("GEN",6);
static const double kScales=env("SCALES",0), kNearby = env("NEARBY",0.08), kShrink = env("SHRINK",0.62);
static const std::size_t kParents = env("PARENTS",16);
static const std::size_t kYoung = env("YOUNG",24), kGrown = env("GROWN",120);
// [-] Two shots are of different kind if some input differs by this fraction of its range.
constexpr double kOtherKind = 0.12;
// A map: cells per side, its share of the budget, and its half-width in distances at which success halves.
constexpr std::size_t kSide = 24;
constexpr double kMap = 0.15, kReach = 3.0;
// Errors whose cost is reported.
constexpr double kAimOff = 0.2, kSpeedOff = 0.05, kTipOff = 0.05, kPlaceOff = 0.01;

class Solver {
  public:
    Solver(const Scene& scene, const Measure& want, kernel::Isa isa, const SolveOptions& options)
        : trials_(scene, want, isa, options), options_(options) {}

    std::vector<Solution> run(std::vector<Share>* starts) {
        // Each search is on its own, from other places, until the choice among the last generations.
        std::vector<Candidate> best;
        for (std::size_t start = 0; start < kStarts; ++start) {
            const double before = static_cast<double>(trials_.played());
            std::vector<Candidate> found = look(); gen_=0;
            if (env("CEM",1)>0) { for (std::size_t round = 0; round < kRoundsC; ++round) found = climbed(std::move(found), round); }
            else {
            double nearby = kNearby;
            // A small budget has fewer generations.
            const double bred = before + (kLook + kBreed) * share();
            for (int generation = 0;
                 generation < kGenerations && static_cast<double>(trials_.played()) < bred;
                 ++generation, nearby *= kShrink)
                found = breed(std::move(found), nearby);
            }
            found.resize(std::min(found.size(), kFinalists));
            // After 120 shots the best is often only the luckiest.
            trials_.play(found, static_cast<std::size_t>(kChoose * share()) / found.size());
            sort(found);
            if (starts != nullptr) starts->push_back(share_of(found[0].successes, found[0].shots));
            best.insert(best.end(), found.begin(), found.end());
        }
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

    /// [shots] Of one start.
    double share() const { return static_cast<double>(options_.shots / kStarts); }
    /// Shots per cost of an error.
    std::size_t detail_shots() const { return std::clamp<std::size_t>(options_.shots / 400, 25, 1000); }
    double range(std::size_t k) const { return options_.choices[k].high - options_.choices[k].low; }

    /// Halton's sequence, shifted by the seed, over the whole space.
    std::vector<Candidate> look() {
        const double budget = kLook * share();
        double cost = 0.0, share = 1.0, before = 0.0, shots = kFirst;
        for (std::size_t round = 0; round < kRounds; ++round, share /= kKeep, before = shots, shots *= kMore)
            cost += share * (shots - before);
        const auto count = std::max<std::size_t>(64, static_cast<std::size_t>(budget / cost));
        SplitMix64 random(options_.seed + 0x9e3779b9u * ++looks_);
        std::vector<double> shift(options_.choices.size());
        for (double& s : shift) s = random.uniform();
        constexpr std::array<int, 12> kPrimes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
        std::vector<Candidate> all(count);
        for (std::size_t i = 0; i < count; ++i) {
            if (env("LLUCK",1)>0) all[i].luck = i % kLuck;
            for (std::size_t k = 0; k < options_.choices.size(); ++k) {
                double x = shift[k], part = 1.0;
                const int base = kPrimes[k % kPrimes.size()];
                for (std::size_t n = i + 1; n > 0; n /= static_cast<std::size_t>(base))
                    x += (part /= base) * static_cast<double>(n % static_cast<std::size_t>(base));
                x -= std::floor(x);
                all[i].values.push_back(options_.choices[k].low + x * range(k));
            }
        }
        std::size_t each = kFirst;
        for (std::size_t round = 0; round < kRounds; ++round, each *= kMore) {
            trials_.play(all, each);
            sort(all);
            if (round + 1 < kRounds) all.resize(std::max<std::size_t>(kParents, static_cast<std::size_t>(all.size() / kKeep)));
        }
        return different(all, env("APART",0.5) * kOtherKind, std::size_t(env("P0",32)));
    }

    /// Searches around a place: each step has new candidates with the spread of the best of the last one.
    std::vector<Candidate> climb(const Candidate& from, std::size_t budget) {
        static const std::size_t kSteps = env("STEPS",4), kElite=env("ELITE",6), kEach=env("EACH",30); static const double kInfl=env("INFL",1.3), kWide=env("WIDE",4);
        std::vector<Candidate> best = {from};
        SplitMix64 random(options_.seed + 0x5bf03635u * ++generation_);
        const std::size_t n = from.values.size();
        const std::size_t children = std::max<std::size_t>(4, budget / kSteps / kEach);
        for (std::size_t step = 0; step < kSteps; ++step) {
            std::vector<double> mean(n, 0.0);
            for (const Candidate& c : best)
                for (std::size_t k = 0; k < n; ++k) mean[k] += c.values[k] / static_cast<double>(best.size());
            std::vector<Candidate> young;
            for (std::size_t i = 0; i < children; ++i) {
                Candidate child{step == 0 ? from.values : mean};
                for (const Candidate& c : best) {
                    const double by = kInfl * standard_normal(random) / std::sqrt(static_cast<double>(best.size()));
                    for (std::size_t k = 0; k < n; ++k) child.values[k] += by * (c.values[k] - mean[k]);
                }
                for (std::size_t k = 0; k < n; ++k) {
                    if (step == 0) child.values[k] += range(k) * std::exp2(-kWide - kScales * random.uniform()) * standard_normal(random);
                    child.values[k] = std::clamp(child.values[k], options_.choices[k].low, options_.choices[k].high);
                }
                young.push_back(std::move(child));
            }
            trials_.play(young, kEach);
            young.insert(young.end(), best.begin(), best.end());
            trials_.play(young, kEach);
            sort(young);
            young.resize(std::min(young.size(), kElite));
            best = std::move(young);
        }
        return best;
    }
    std::vector<Candidate> climbed(std::vector<Candidate> list, std::size_t round) {
        static const std::size_t kMany[] = {(std::size_t)env("P0",10), (std::size_t)env("P1",3)};
        const std::size_t many = std::min(kMany[round], list.size());
        const double each = kBreed * share() / kRoundsC / static_cast<double>(many);
        list.resize(many);
        std::vector<Candidate> all = list;
        for (std::size_t i = 0; i < many; ++i) { auto more = climb(list[i], static_cast<std::size_t>(.8 * each)); all.insert(all.end(), more.begin(), more.begin()+2); }
        trials_.play(all, all.back().shots + static_cast<std::size_t>(.2 * each / 2));
        sort(all);
        return different(all, env("YAPART",.01), all.size());
    }
    static inline const std::size_t kRoundsC = env("CROUNDS",2), kLuck = 61;
    /// The best of these and their descendants.
    std::vector<Candidate> breed(std::vector<Candidate> parents, double nearby) {
        const std::size_t np = std::max<std::size_t>(env("PMIN",8), kParents * std::pow(env("PSHRINK",1), gen_));
        const std::size_t kGrown = env("GROWN",120) * std::pow(env("GG",1), gen_), kYoung = env("YOUNG",24) * std::pow(env("GG",1), gen_);
        const double budget = kBreed * share() / kGenerations;
        const auto count = std::max<std::size_t>(
            np, static_cast<std::size_t>(budget / (kYoung + (kGrown - kYoung) / 4.0)));
        std::vector<Candidate> young;
        SplitMix64 random(options_.seed + 0x5bf03635u * ++generation_);
        // The better half has three quarters of the descendants.
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t half = (parents.size() + 1) / 2;
            const std::size_t from = i % 4 == 3
                                         ? half + (i / 4) % std::max<std::size_t>(1, parents.size() - half)
                                         : (i - i / 4) % half;
            Candidate child;
            child.values = parents[std::min(from, parents.size() - 1)].values;
            for (std::size_t k = 0; k < child.values.size(); ++k)
                child.values[k] = std::clamp(child.values[k] + nearby * std::exp2(-kScales * random.uniform()) * range(k) * standard_normal(random),
                                             options_.choices[k].low, options_.choices[k].high);
            young.push_back(std::move(child));
        }
        trials_.play(young, kYoung);
        sort(young);
        young.resize(std::max<std::size_t>(np, young.size() / 4));
        trials_.play(young, kGrown);
        trials_.play(parents, kGrown);
        young.insert(young.end(), parents.begin(), parents.end());
        sort(young);
        return different(young, env("YAPART",0.5) * nearby, (++gen_, np));
    }

    /// The best, without candidates near to a better one.
    std::vector<Candidate> different(const std::vector<Candidate>& sorted, double apart,
                                     std::size_t most) const {
        std::vector<Candidate> kept;
        for (const Candidate& candidate : sorted) {
            const bool near = std::any_of(kept.begin(), kept.end(), [&](const Candidate& other) {
                double away = 0.0;
                for (std::size_t k = 0; k < candidate.values.size(); ++k)
                    if (range(k) > 0.0)
                        away = std::max(away, std::abs(candidate.values[k] - other.values[k]) / range(k));
                return away < apart;
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
            for (const Solution::Cost& cost : found.costs)
                for (const double way : {-1.0, 1.0}) {
                    const auto& part = way < 0.0 ? cost.less : cost.more;
                    const double low = part ? share_of(*part, cost.shots).low : 0.0;
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
    std::optional<std::vector<double>> moved(std::vector<double> values, const Solution::Cost& cost,
                                             double way) const {
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
        for (const auto& [fall, count] : falls) found.falls.push_back({fall.first, fall.second, count});
        std::stable_sort(found.falls.begin(), found.falls.end(),
                         [](const auto& one, const auto& two) { return one.count > two.count; });
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
    void add_costs(const Candidate& candidate, std::vector<Solution::Cost>& costs) {
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
    Solution::Cost cost(const Candidate& candidate, const std::string& input, double by, const char* unit,
                        Off&& off) {
        const std::size_t shots = std::min(detail_shots(), candidate.shots);
        Solution::Cost cost{input, by, unit, shots, {}, {}};
        for (const bool less : {true, false}) {
            std::vector<Candidate> moved(1, Candidate{candidate.values});
            off(moved[0], less ? -by : by);
            trials_.play(moved, shots);
            trials_.turned = 0.0;
            if (moved[0].invalid < shots) (less ? cost.less : cost.more) = moved[0].successes;
        }
        return cost;
    }
    Trials trials_;
    const SolveOptions& options_;
    std::uint64_t generation_ = 0, looks_ = 0; int gen_=0;
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

std::vector<Choice> default_choices() {
    return {{"cue.aim_deg", 0.0, 360.0}, {"cue.speed", 0.5, 6.0}, {"cue.offset.height", -0.4, 0.4}};
}

std::vector<Solution> solve(const Scene& scene, const Measure& want, kernel::Isa isa,
                            const SolveOptions& options, std::vector<Share>* starts) {
    return Solver(scene, want, isa, options).run(starts);
}

SuccessMap success_map(const Scene& scene, const Measure& want, kernel::Isa isa, const SolveOptions& options,
                       const Solution& around) {
    return Solver(scene, want, isa, options).map(around);
}

}  // namespace carom::games
