// The list of ball-ball models, each in a file of this folder, and the law of friction that they share.
#include "carom/engine/ball_ball.h"

#include <span>
#include <string_view>
#include "carom/engine/math.h"

namespace carom {

extern const BallBallModelInfo kInelastic, kElastic, kTwoStep;

std::span<const BallBallModelInfo* const> all_of(const BallBallModelInfo*) {
    static constexpr const BallBallModelInfo* kModels[] = {&kMathavan, &kInelastic, &kElastic, &kTwoStep};
    return kModels;
}

const char* name(const BallBallModelInfo* model) {
    return model->name;
}

const BallBallModelInfo* ball_ball_model(std::string_view name) {
    for (const BallBallModelInfo* model : all_of(&kMathavan))
        if (name == model->name) return model;
    return nullptr;
}

double Falling::operator()(double u) const {
    return more == 0.0 ? at_rest : at_rest + more * exponential(-fall * u);
}

}  // namespace carom
