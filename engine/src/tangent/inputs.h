// Everything that a shot depends on, with the derivatives by its inputs.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <iterator>
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
    double step;  ///< of the differences that find the dependent numbers, which are nearly all linear in it
    std::function<Change(Scene&, double)> put;
};
/// @param scene  is changed if it throws
/// @throws TangentError if the number has no derivative, std::invalid_argument if it does not exist
Input input_of(Scene& scene, const std::string& key);

/// The numbers of BallParams; each has one row.
inline constexpr std::size_t kParams = std::count_if(std::begin(kBallFields), std::end(kBallFields),
                                                     [](const auto& row) { return row.number != nullptr; });
inline constexpr auto kParamMembers = [] {
    std::array<double BallParams::*, kParams> members{};
    auto next = members.begin();
    for (const Field<BallParams>& row : kBallFields)
        if (row.number != nullptr) *next++ = row.number;
    return members;
}();
/// These balls with other numbers.
BallParams with_numbers(BallParams balls, const double* numbers);

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
/// @param scene  of the plan; changed and restored
/// @param inputs  at most kLanes
Numbers numbers_of(const Plan& plan, Scene& scene, const std::vector<Input>& inputs);

}  // namespace carom::tangent
