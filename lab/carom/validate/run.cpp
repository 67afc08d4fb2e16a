#include "validate/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/console.h"
#include "base/setup.h"
#include "carom/engine/cushion.h"
#include "carom/engine/plan.h"
#include "carom/engine/record.h"
#include "carom/engine/simulate.h"
#include "carom/engine/variation.h"
#include "carom/games/measures.h"
#include "validate/measure.h"

namespace carom::tools {
namespace {

constexpr double kClaimBand = 0.25;  ///< of the uncertainty
constexpr double kManyBand = 3.0;    ///< standard deviations
/// standard deviations to each side that contain 95 % of a normal distribution
constexpr double kNinetyFive = 1.96;

std::string model_of(const ValidationCase& of, const Scene& scene) {
    switch (of.about) {
        case About::kCushion:
            return name(scene.physics.cushion);
        case About::kBallBall:
            return name(scene.physics.ball_ball);
        case About::kClusters:
            return names_of(ClusterModel())[static_cast<std::size_t>(scene.physics.clusters)];
        case About::kCloth:
        case About::kCue:
            break;
    }
    return kAbout[static_cast<std::size_t>(of.about)];
}

std::string differences(const Scene& scene, const std::string& preset) {
    Scene shipped = scene;
    shipped.balls = make_ball_params(preset);
    std::string text;
    for (const char* key : {"radius", "mass", "mu_s", "mu_r", "mu_sp", "mu_b", "e_b", "e_c", "f_c"}) {
        const SceneNumber number(scene, std::string("balls.") + key);
        if (const double value = number.value(scene); value != number.value(shipped))
            text += fmt::format("{}{} = {:g}", text.empty() ? "" : ", ", key, value);
    }
    return text;
}

/// The model and the computed numbers of one shot with one variant, and their standard deviations.
struct Computed {
    std::string model, differs;
    std::vector<double> numbers, sampled;
};

/// Mean of the samples, and its standard deviation.
struct Mean {
    double sum = 0.0, squares = 0.0;
    int count = 0;
    void add(double x) {
        sum += x;
        squares += x * x;
        ++count;
    }
    double value() const { return sum / count; }
    double deviation() const { return std::sqrt(std::max(0.0, squares / count - value() * value()) / count); }
};

Computed play(const ValidationCase& of, const ValidationShot& shot, const Variant& variant,
              const std::string& text, kernel::Isa isa) {
    const Plan plan = make_plan(parse_scene(text, of.file), isa);
    const Record record = simulate(plan, interruptible());
    Computed out{model_of(of, plan.scene),
                 differences(plan.scene, variant.preset),
                 {},
                 std::vector<double>(shot.measured.size(), 0.0)};
    for (const Measured& m : shot.measured) out.numbers.push_back(measure(record, m));
    return out;
}

Computed play_sweep(const ValidationCase& of, const ValidationShot& shot, const Variant& variant,
                    const std::string& text, kernel::Isa isa, const std::function<void()>& progress) {
    std::vector<std::string> rules;
    for (const std::string& rule : of.sweep->vary) rules.push_back(filled_in(of, shot, variant, rule));
    const Variation variation = Variation::from_text(text, of.file, rules, of.sweep->seed);
    std::vector<games::Measure> wanted, among;
    for (const Measured& m : shot.measured) {
        wanted.emplace_back(m.of, variation.base());
        among.emplace_back(m.among.empty() ? "1" : m.among, variation.base());
    }
    std::vector<Mean> means(shot.measured.size());
    for (int i = 0; i < of.sweep->count; ++i) {
        const VariedShot varied = variation.shot(static_cast<std::uint64_t>(i));
        if (!varied.scene) throw std::runtime_error(fmt::format("shot {} of the sweep: {}", i, varied.error));
        const Record record = simulate(make_plan(*varied.scene, isa), interruptible());
        for (std::size_t k = 0; k < means.size(); ++k)
            if (among[k].holds(record))
                means[k].add(shot.measured[k].quantity == Quantity::kShare
                                 ? double(wanted[k].holds(record))
                                 : std::get<double>(wanted[k].of(record)));
        progress();
    }
    Computed out{model_of(of, variation.base()), differences(variation.base(), variant.preset), {}, {}};
    for (const Mean& mean : means) {
        out.numbers.push_back(mean.value());
        out.sampled.push_back(mean.deviation());
    }
    return out;
}

Computed computed(const ValidationCase& of, const ValidationShot& shot, const Variant& variant,
                  kernel::Isa isa, const std::function<void()>& progress) {
    const std::string text = filled_in(of, shot, variant, of.scene);
    try {
        if (of.sweep) return play_sweep(of, shot, variant, text, isa, progress);
        Computed out = play(of, shot, variant, text, isa);
        progress();
        return out;
    } catch (const SceneError& error) {
        throw std::runtime_error(
            fmt::format("{}, {}, {}: {}\n{}", of.id, variant.name, shot.name, error.what(), text));
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(fmt::format("{}, {}, {}: {}", of.id, variant.name, shot.name, error.what()));
    }
}

}  // namespace

double ValidationRow::deviation() const {
    return (computed - measured->value) / uncertainty;
}

bool ValidationRow::within() const {
    return std::abs(computed - measured->value) <= uncertainty;
}

bool ValidationRow::as_claimed() const {
    if (!claim) return within();
    const double off = std::abs(computed - *claim);
    if (of->sweep) return off <= kManyBand * sampled + 1.0 / of->sweep->count;
    return !within() && off <= kClaimBand * uncertainty;
}

long runs_of(const ValidationCase& of) {
    return static_cast<long>(of.shots.size() * of.variants.size()) * (of.sweep ? of.sweep->count : 1);
}

std::vector<ValidationRow> run_case(const ValidationCase& of, kernel::Isa isa,
                                    const std::function<void(long)>& progress) {
    long runs = 0;
    const auto step = [&] {
        throw_if_interrupted();
        progress(++runs);
    };
    std::vector<ValidationRow> rows;
    std::size_t first = 0;  // index of the shot's first number in the claims
    for (const ValidationShot& shot : of.shots) {
        std::vector<Computed> all;
        for (const Variant& variant : of.variants) all.push_back(computed(of, shot, variant, isa, step));
        for (std::size_t k = 0; k < shot.measured.size(); ++k)
            for (std::size_t v = 0; v < of.variants.size(); ++v) {
                const Measured& m = shot.measured[k];
                const double sampled = all[v].sampled[k];
                rows.push_back({&of, &shot, &of.variants[v], &m, all[v].model, all[v].differs,
                                of.variants[v].claims.at(first + k), all[v].numbers[k], sampled,
                                std::hypot(m.uncertainty, kNinetyFive * sampled)});
            }
        first += shot.measured.size();
    }
    return rows;
}

}  // namespace carom::tools
