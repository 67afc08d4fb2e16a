#include "support/scene_scan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "carom/engine/simulate.h"
#include "carom/engine/verify.h"
#include "support/crowded_scenes.h"
#include "support/natural_shots.h"
#include "support/random_scenes.h"

namespace carom::test {
namespace {

constexpr double kSlowMs = 50.0, kGiveUpMs = 2500.0;  // CPU time

double cpu_ms() {
    return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

enum class Fault { kNone, kInvalid, kSlow, kGivenUp, kError, kViolation };
constexpr const char* kFaults[] = {"", "invalid", "slow", "given up", "error", "violation"};

struct Outcome {
    Fault fault = Fault::kNone;
    std::string what;
    double ms = 0.0;  ///< CPU of the simulation, without the check
    std::size_t rounds = 0;
};

class GivenUp : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

Outcome judge(const Scene& scene) {
    Outcome out;
    try {
        validate(scene);
    } catch (const SceneError& error) {
        return {Fault::kInvalid, error.what()};
    }
    const double start = cpu_ms();
    SimulateOptions options;
    options.progress_rounds = 1;
    options.progress = [&](std::size_t, double time) {
        if (++out.rounds % 64 == 0 && cpu_ms() - start > kGiveUpMs)
            throw GivenUp("given up at t = " + std::to_string(time) + " s");
    };
    try {
        const Plan plan = plan_of(scene);
        const Record record = simulate(plan, options);
        out.ms = cpu_ms() - start;
        if (const auto broken = verify(record, plan)) {
            out.fault = Fault::kViolation;
            out.what = broken->law + " at event " + std::to_string(broken->event) + ": " + broken->message;
        } else if (record.stopped == StopReason::kEndless) {
            out.fault = Fault::kViolation;
            out.what = "goes on for ever";
        } else if (out.ms > kSlowMs) {
            out.fault = Fault::kSlow;
            out.what = std::to_string(record.events.size()) + " events, " +
                       std::to_string(segments_of(record)) + " segments";
        }
    } catch (const GivenUp& error) {
        out.ms = cpu_ms() - start;
        out.fault = Fault::kGivenUp;
        out.what = error.what();
    } catch (const std::exception& error) {
        out.ms = cpu_ms() - start;
        out.fault = Fault::kError;
        out.what = error.what();
        out.what = out.what.substr(0, out.what.find('\n'));
    }
    return out;
}

/// Removes balls one by one, and then spins, while the same kind of fault remains.
Scene least(Scene scene) {
    const Fault fault = judge(scene).fault;
    for (bool smaller = true; smaller && fault != Fault::kNone;) {
        smaller = false;
        for (std::size_t k = scene.ball.size(); k-- > 0 && scene.ball.size() > 1;) {
            Scene without = scene;
            if (without.cue && without.cue->ball == without.ball[k].id) continue;
            without.ball.erase(without.ball.begin() + static_cast<std::ptrdiff_t>(k));
            if (judge(without).fault != fault) continue;
            scene = without;
            smaller = true;
        }
        for (BallStart& ball : scene.ball) {
            const Vec3 spin = ball.spin;
            if (spin.isZero(0.0)) continue;
            ball.spin.setZero();
            if (judge(scene).fault == fault)
                smaller = true;
            else
                ball.spin = spin;
        }
    }
    return scene;
}

/// CPU times in bins with limits 2^(1/4) apart, from 1 us on, so that ranges can be added.
class Times {
  public:
    void add(double ms) {
        const int bin = std::max(0, static_cast<int>(std::ceil(4.0 * std::log2(std::max(1.0, 1e3 * ms)))));
        ++count_[bin];
        ++all_;
        most_ = std::max(most_, ms);
    }
    /// [ms] Upper limit of the bin in which this share of the runs is reached.
    double at(double share) const {
        long seen = 0;
        for (const auto& [bin, count] : count_)
            if ((seen += count) >= static_cast<long>(std::ceil(share * static_cast<double>(all_))))
                return std::min(most_, 1e-3 * std::exp2(0.25 * bin));
        return 0.0;
    }
    void print() const {
        std::printf("CPU of a run: p50 %.3g ms, p99 %.3g, p99.9 %.3g, max %.3g\nbins", at(0.5), at(0.99),
                    at(0.999), most_);
        for (const auto& [bin, count] : count_) std::printf(" %d:%ld", bin, count);
        std::printf("\n");
    }

  private:
    std::map<int, long> count_;
    long all_ = 0;
    double most_ = 0.0;
};

int refuse() {
    std::fprintf(stderr,
                 "CAROM_RANDOM_SCENES=FROM:COUNT or FROM:COUNT:FAMILY, as in 0:1000:rings/wide, or "
                 "SEED:1:FAMILY:toml, "
                 "or SEED:1:FAMILY:least; families lists the families\n");
    return 2;
}

void print_families() {
    std::printf("other\n");
    for (const char* name : natural_families()) std::printf("%s\n", name);
    for (const char* name : crowded_families()) std::printf("%s\n%s/wide\n%s/extreme\n", name, name, name);
}

}  // namespace

std::optional<Scene> seeded_scene(const std::string& family, std::uint64_t seed) {
    if (family.empty() || family == "random") return RandomScene(seed).make();
    if (family == "other") return RandomScene(seed, DrawOrder::kFirstFirst).make();
    return family_scene(family, seed);
}

int scan_scenes(const char* wanted) {
    if (std::string(wanted) == "families") {
        print_families();
        return 0;
    }
    unsigned long long from = 0, count = 0;
    char family_text[64] = "", what[8] = "";
    const int read = std::sscanf(wanted, "%llu:%llu:%63[^:]:%7s", &from, &count, family_text, what);
    const std::string family = family_text, form = what;
    if (count == 0 || read < 2 || !seeded_scene(family, from)) return refuse();
    if (!form.empty()) {
        if (form != "toml" && form != "least") return refuse();
        const Scene scene = *seeded_scene(family, from);
        std::printf("%s", scene_text(form == "least" ? least(scene) : scene).c_str());
        return 0;
    }
    Times times;
    int failed = 0, others[std::size(kFaults)] = {};
    double total_ms = 0.0;
    for (unsigned long long seed = from; seed < from + count; ++seed) {
        const double start = cpu_ms();
        const Outcome out = judge(*seeded_scene(family, seed));
        total_ms += cpu_ms() - start;
        ++others[static_cast<int>(out.fault)];
        if (out.fault == Fault::kInvalid) continue;
        times.add(out.ms);
        failed += out.fault >= Fault::kGivenUp ? 1 : 0;
        if (out.fault == Fault::kNone) continue;
        std::printf("seed %llu: %s, %.0f ms, %zu rounds: %s\n", seed, kFaults[static_cast<int>(out.fault)],
                    out.ms, out.rounds, out.what.c_str());
        std::fflush(stdout);
    }
    std::printf("%llu scenes from %llu: %d failed, %.1f ms on average\n", count, from, failed,
                total_ms / static_cast<double>(count));
    std::printf("%d slow, %d given up, %d errors, %d violations, %d invalid\n", others[2], others[3],
                others[4], others[5], others[1]);
    times.print();
    return 0;
}

}  // namespace carom::test
