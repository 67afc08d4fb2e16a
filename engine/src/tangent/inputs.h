// What a shot depends on, with the derivatives by its inputs.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/scene_number.h"
#include "tangent/dual.h"

namespace carom::tangent {

/// A number of a scene by which a shot is differentiated.
struct Input {
    std::string key;
    double value;
    double step;  ///< of the differences that find what depends on it; nearly everything does linearly
    std::function<Change(Scene&, double)> put;
};
/// @param scene  is changed if it throws
/// @throws TangentError if the number has no derivative, std::invalid_argument if there is no such number
Input input_of(Scene& scene, const std::string& key);

/// BallParams consists of numbers only: here they are a list.
inline constexpr std::size_t kParams = sizeof(BallParams) / sizeof(double);
using ParamList = std::array<double, kParams>;
BallParams params_of(const double* list);

/// All numbers of a plan that the replay reads.
struct Numbers {
    struct Ball {
        Dual R, m;
        Dual3 r, v, w;  ///< at the start, after the stroke
    };
    struct Line {
        Dual2 from, direction;
        Dual length, height, inset;
    };
    struct Round {
        Dual2 center;
        Dual radius, height, inset;  ///< of a pocket: the radius only
    };
    std::array<Dual, kParams> params;
    Dual gravity;
    std::vector<Ball> balls;
    std::vector<Line> cushions;
    std::vector<Round> noses, pockets;

    const Dual& param(double BallParams::*member) const;
};
/// @param scene  that of the plan; changed and put back
/// @param inputs  at most kLanes
Numbers numbers_of(const Plan& plan, Scene& scene, const std::vector<Input>& inputs);

}  // namespace carom::tangent
