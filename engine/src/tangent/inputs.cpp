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

// [-] and [degrees] Steps of the differences; four points are exact to 1e-13 for sines and roots.
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

template <class Vector>
auto duals(const Vector& v) {
    std::array<Dual, Vector::RowsAtCompileTime> list;
    std::copy(v.begin(), v.end(), list.begin());
    return list;
}

Numbers values_of(const Scene& scene, const Geometry& table, Vertical vertical) {
    Numbers n;
    for (std::size_t i = 0; i < kParams; ++i) n.params[i] = scene.balls.*kParamMembers[i];
    n.gravity = scene.physics.gravity;
    for (const BallStart& ball : scene.ball) {
        const BallSize size = scene.size_of(ball);
        const bool struck = scene.cue && scene.cue->ball == ball.id;
        const StruckBall moves =
            struck ? strike(*scene.cue, size, true, vertical) : StruckBall{ball.velocity, ball.spin, 0.0};
        n.balls.push_back({size.R, size.m, duals(ball.position), duals(moves.v), duals(moves.w)});
    }
    for (const CushionLine& line : table.cushions)
        n.cushions.push_back({duals(line.from), duals(line.direction), line.length, line.height, line.inset});
    for (const Nose& nose : table.noses)
        n.noses.push_back({duals(nose.center), nose.radius, nose.height, nose.inset});
    for (const Pocket& pocket : table.pockets)
        n.pockets.push_back({duals(pocket.center), pocket.radius, {}, {}});
    return n;
}

void append(std::vector<Dual*>& list, Dual& number) {
    list.push_back(&number);
}
template <std::size_t N>
void append(std::vector<Dual*>& list, std::array<Dual, N>& numbers) {
    for (Dual& number : numbers) list.push_back(&number);
}

/// All numbers, in a fixed order.
std::vector<Dual*> list_of(Numbers& n) {
    std::vector<Dual*> list;
    const auto add = [&list](auto&... numbers) { (append(list, numbers), ...); };
    add(n.params, n.gravity);
    for (Numbers::Ball& b : n.balls) add(b.R, b.m, b.r, b.v, b.w);
    for (Numbers::Line& l : n.cushions) add(l.from, l.direction, l.length, l.height, l.inset);
    for (std::vector<Numbers::Round>* rounds : {&n.noses, &n.pockets})
        for (Numbers::Round& r : *rounds) add(r.center, r.radius, r.height, r.inset);
    return list;
}

}  // namespace

Input input_of(Scene& scene, const std::string& key) {
    const SceneNumber number(scene, key);
    const double value = number.value(scene);
    if (std::isnan(value))
        throw TangentError(fmt::format("{} is not a real number that the scene sets", key));
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
    // Also compute effects that the plan skips: they change nothing here, but they change derivatives.
    const Vertical vertical = plan.in_force(Effect::kAirborne) ? Vertical::kKeep : Vertical::kDrop;
    Numbers n = values_of(scene, plan.geometry, vertical);
    const std::vector<Dual*> list = list_of(n);
    for (std::size_t lane = 0; lane < inputs.size(); ++lane) {
        const Input& input = inputs[lane];
        std::array<Numbers, 4> near;
        std::array<std::vector<Dual*>, 4> at;
        for (const auto& [k, steps] : {std::pair{0, -2.0}, {1, -1.0}, {2, 1.0}, {3, 2.0}}) {
            const Change change = input.put(scene, input.value + steps * input.step);
            Geometry table = plan.geometry;
            if (change >= Change::kTable) {
                scene.effects.clear();
                try {
                    table = make_plan(scene, plan.isa).geometry;
                } catch (const SceneError& error) {
                    throw TangentError(fmt::format("{}: {}", input.key, error.message()));
                }
            }
            near[k] = values_of(scene, table, vertical);
            at[k] = list_of(near[k]);
            if (at[k].size() != list.size())
                throw TangentError(fmt::format("{} changes the number of parts of the table", input.key));
            if (change >= Change::kTable) scene = plan.scene;
        }
        input.put(scene, input.value);
        for (std::size_t i = 0; i < list.size(); ++i)
            list[i]->d[lane] =
                (8.0 * (at[2][i]->x - at[1][i]->x) - (at[3][i]->x - at[0][i]->x)) / (12.0 * input.step);
    }
    return n;
}

}  // namespace carom::tangent
