#include "tangent/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <variant>

#include "carom/engine/scene_number.h"
#include "carom/engine/tangents.h"
#include "physics/cue.h"

namespace carom::tangent {
namespace {

// [-] and [degrees] Steps of the differences. Four points of them are exact to 1e-13 for sines and roots.
constexpr double kStep = 1e-3, kAngleStep = 0.1;

Input with_step(const std::string& key, double value, const Interval& range,
                std::function<Change(Scene&, double)> put) {
    const bool degrees = std::string_view(range.unit) == "degrees";
    double step = kStep * std::abs(value);
    if (range.low < 0.0) step = degrees ? kAngleStep : kStep * std::max(1.0, std::abs(value));
    if (!(step > 0.0) || !contains(range, value - 2.0 * step) || !contains(range, value + 2.0 * step))
        throw TangentError(fmt::format(
            "{} = {} is at the end of its range, where it has no derivative; move it inwards", key, value));
    return {key, value, step, std::move(put)};
}

/// The numbers in the order in which numbers_of() reads them: of the balls and the stroke, and of the table.
std::vector<double> list_of(const Scene& scene, Vertical vertical) {
    std::vector<double> list;
    for (const auto member : kParamMembers) list.push_back(scene.balls.*member);
    const auto add_all = [&list](const auto& v) { list.insert(list.end(), v.data(), v.data() + v.size()); };
    list.push_back(scene.physics.gravity);
    for (const BallStart& ball : scene.ball) {
        const BallSize size = scene.size_of(ball);
        list.insert(list.end(), {size.R, size.m});
        add_all(ball.position);
        if (scene.cue && scene.cue->ball == ball.id) {
            const StruckBall struck = strike(*scene.cue, size, true, vertical);
            add_all(struck.v);
            add_all(struck.w);
        } else {
            add_all(ball.velocity);
            add_all(ball.spin);
        }
    }
    return list;
}
void add_table(const Geometry& table, std::vector<double>& list) {
    const auto add = [&list](const Vec2& v) { list.insert(list.end(), {v.x(), v.y()}); };
    for (const CushionLine& line : table.cushions) {
        add(line.from);
        add(line.direction);
        list.insert(list.end(), {line.length, line.height, line.inset});
    }
    for (const Nose& nose : table.noses) {
        add(nose.center);
        list.insert(list.end(), {nose.radius, nose.height, nose.inset});
    }
    for (const Pocket& pocket : table.pockets) {
        add(pocket.center);
        list.push_back(pocket.radius);
    }
}

}  // namespace

Input input_of(Scene& scene, const std::string& key) {
    const SceneNumber number(scene, key);
    const double value = number.value(scene);
    if (std::isnan(value))
        throw TangentError(fmt::format("{} is no number with a fraction that the scene sets", key));
    const BallParams balls = scene.balls;
    number.put(scene, value);
    if (scene.balls != balls)
        throw TangentError(
            fmt::format("{0} replaces a fit of the scene; name a number of the fit instead: {0}_fit.0", key));
    return with_step(key, value, number.row().range,
                     [number](Scene& s, double x) { return number.put(s, x); });
}

BallParams with_numbers(BallParams balls, const double* numbers) {
    for (const auto member : kParamMembers) balls.*member = *numbers++;
    return balls;
}

const Dual& Numbers::param(double BallParams::*member) const {
    const auto at = std::find(kParamMembers.begin(), kParamMembers.end(), member);
    return params[static_cast<std::size_t>(at - kParamMembers.begin())];
}

Numbers numbers_of(const Plan& plan, Scene& scene, const std::vector<Input>& inputs) {
    // Effects that the plan skips are computed: they change nothing here, but they change derivatives.
    const Vertical vertical = plan.in_force(Effect::kAirborne) ? Vertical::kKeep : Vertical::kDrop;
    std::vector<double> base = list_of(scene, vertical);
    add_table(plan.geometry, base);
    std::vector<Dual> list(base.begin(), base.end());
    for (std::size_t lane = 0; lane < inputs.size(); ++lane) {
        const Input& input = inputs[lane];
        std::array<std::vector<double>, 4> at;
        for (const auto& [k, steps] : {std::pair{0, -2.0}, {1, -1.0}, {2, 1.0}, {3, 2.0}}) {
            const Change change = input.put(scene, input.value + steps * input.step);
            at[k] = list_of(scene, vertical);
            if (change < Change::kTable) continue;
            scene.effects.clear();
            try {
                add_table(make_plan(scene, plan.isa).geometry, at[k]);
            } catch (const SceneError& error) {
                throw TangentError(fmt::format("{}: {}", input.key, error.message()));
            }
            if (at[k].size() != base.size())
                throw TangentError(fmt::format("{} changes which parts of the table there are", input.key));
            scene = plan.scene;
        }
        input.put(scene, input.value);
        for (std::size_t i = 0; i < at[0].size(); ++i)
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
