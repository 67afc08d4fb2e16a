#include "tangent/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "carom/engine/scene_number.h"
#include "carom/engine/tangents.h"
#include "physics/cue.h"

namespace carom::tangent {
namespace {

static_assert(std::is_trivially_copyable_v<BallParams> && sizeof(BallParams) % sizeof(double) == 0);

// [-] and [degrees] Steps of the differences. Four points of them are exact to 1e-13 for sines and roots.
constexpr double kStep = 1e-3, kAngleStep = 0.1;

Input with_step(const std::string& key, double value, const Interval& range,
                std::function<void(Scene&, double)> put) {
    const bool degrees = std::string_view(range.unit) == "degrees";
    double step = kStep * std::abs(value);
    if (range.low < 0.0) step = degrees ? kAngleStep : kStep * std::max(1.0, std::abs(value));
    if (!(step > 0.0) || !contains(range, value - 2.0 * step) || !contains(range, value + 2.0 * step))
        throw TangentError(fmt::format(
            "{} = {} is at the end of its range, where it has no derivative; move it inwards", key, value));
    return {key, value, step, std::move(put)};
}

/// A number of a fit of [balls], such as balls.mu_b_fit.0.
std::optional<Input> in_fit(const Scene& scene, const std::string& key) {
    for (const Field<BallParams>& row : kBallFields) {
        const FieldValue value = row.get(scene.balls);
        const auto* list = std::get_if<std::vector<double>>(&value);
        for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
            if (key != fmt::format("balls.{}.{}", row.key, k)) continue;
            return with_step(key, (*list)[k], row.range, [&row, k](Scene& s, double x) {
                auto numbers = std::get<std::vector<double>>(row.get(s.balls));
                numbers[k] = x;
                row.set(s.balls, numbers);
            });
        }
    }
    return std::nullopt;
}

/// The numbers of a plan in the order in which numbers_of() reads them.
std::vector<double> list_of(const Plan& plan) {
    const Scene& scene = plan.scene;
    std::vector<double> list(kParams);
    std::memcpy(list.data(), &scene.balls, sizeof(BallParams));
    const auto add = [&list](const auto&... numbers) { (list.push_back(numbers), ...); };
    const auto add_all = [&list](const auto& v) { list.insert(list.end(), v.data(), v.data() + v.size()); };
    add(plan.gravity);
    // Effects that the plan skips are computed: they change nothing here, but they change derivatives.
    const Vertical vertical = plan.in_force(Effect::kAirborne) ? Vertical::kKeep : Vertical::kDrop;
    for (std::size_t i = 0; i < scene.ball.size(); ++i) {
        const BallStart& ball = scene.ball[i];
        add(plan.sizes[i].R, plan.sizes[i].m);
        add_all(ball.position);
        if (scene.cue && scene.cue->ball == ball.id) {
            const StruckBall struck = strike(*scene.cue, plan.sizes[i], true, vertical);
            add_all(struck.v);
            add_all(struck.w);
        } else {
            add_all(ball.velocity);
            add_all(ball.spin);
        }
    }
    for (const CushionLine& line : plan.geometry.cushions) {
        add_all(line.from);
        add_all(line.direction);
        add(line.length, line.height, line.inset);
    }
    for (const Nose& nose : plan.geometry.noses) {
        add_all(nose.center);
        add(nose.radius, nose.height, nose.inset);
    }
    for (const Pocket& pocket : plan.geometry.pockets) {
        add_all(pocket.center);
        add(pocket.radius);
    }
    return list;
}

/// The numbers of the plan of a scene whose input is `steps` steps away.
std::vector<double> moved_list(const Plan& plan, const Input& input, double steps) {
    Scene scene = plan.scene;
    scene.effects.clear();
    input.put(scene, input.value + steps * input.step);
    try {
        return list_of(make_plan(scene, plan.isa));
    } catch (const SceneError& error) {
        throw TangentError(fmt::format("{}: {}", input.key, error.message()));
    }
}

}  // namespace

Input input_of(const Scene& scene, const std::string& key) {
    if (auto found = in_fit(scene, key)) return *found;
    const SceneNumber number(scene, key);
    const double value = number.value(scene);
    if (std::isnan(value))
        throw TangentError(fmt::format("{} is no number with a fraction that the scene sets", key));
    Scene same = scene;
    number.put(same, value);
    if (same.balls != scene.balls)
        throw TangentError(
            fmt::format("{0} replaces a fit of the scene; name a number of the fit instead: {0}_fit.0", key));
    return with_step(key, value, number.row().range, [number](Scene& s, double x) { number.put(s, x); });
}

BallParams params_of(const double* list) {
    BallParams balls{};
    std::memcpy(&balls.R, list, sizeof(BallParams));
    return balls;
}

const Dual& Numbers::param(double BallParams::*member) const {
    static const BallParams kAny{};
    return params[static_cast<std::size_t>(&(kAny.*member) - &kAny.R)];
}

Numbers numbers_of(const Plan& plan, const std::vector<Input>& inputs) {
    const std::vector<double> base = list_of(plan);
    std::vector<Dual> list(base.begin(), base.end());
    for (std::size_t lane = 0; lane < inputs.size(); ++lane) {
        const Input& input = inputs[lane];
        std::array<std::vector<double>, 4> at;
        for (const auto& [k, steps] : {std::pair{0, -2.0}, {1, -1.0}, {2, 1.0}, {3, 2.0}}) {
            at[k] = moved_list(plan, input, steps);
            if (at[k].size() != base.size())
                throw TangentError(fmt::format("{} changes which parts of the table there are", input.key));
        }
        for (std::size_t i = 0; i < base.size(); ++i)
            list[i].d[lane] = (8.0 * (at[2][i] - at[1][i]) - (at[3][i] - at[0][i])) / (12.0 * input.step);
    }
    const Dual* next = list.data();
    const auto two = [&next] { return next += 2, Dual2{next[-2], next[-1]}; };
    const auto three = [&next] { return next += 3, Dual3{next[-3], next[-2], next[-1]}; };
    Numbers n;
    for (Dual& param : n.params) param = *next++;
    n.gravity = *next++;
    for (std::size_t i = 0; i < plan.sizes.size(); ++i) {
        Numbers::Ball& ball = n.balls.emplace_back();
        ball.R = *next++, ball.m = *next++;
        ball.r = three(), ball.v = three(), ball.w = three();
    }
    for (std::size_t i = 0; i < plan.geometry.cushions.size(); ++i) {
        Numbers::Line& line = n.cushions.emplace_back();
        line.from = two(), line.direction = two();
        line.length = *next++, line.height = *next++, line.inset = *next++;
    }
    for (std::size_t i = 0; i < plan.geometry.noses.size(); ++i) {
        Numbers::Round& nose = n.noses.emplace_back();
        nose.center = two();
        nose.radius = *next++, nose.height = *next++, nose.inset = *next++;
    }
    for (std::size_t i = 0; i < plan.geometry.pockets.size(); ++i) {
        Numbers::Round& pocket = n.pockets.emplace_back();
        pocket.center = two();
        pocket.radius = *next++;
    }
    return n;
}

}  // namespace carom::tangent
