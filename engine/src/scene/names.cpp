// How models are spelt in files, and the text of a scene error.
#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "carom/engine/ball_ball.h"
#include "carom/engine/cushion.h"
#include "carom/engine/math.h"
#include "carom/engine/scene.h"

namespace carom {

SceneError::SceneError(const std::string& file, SourceLocation where, const std::string& message)
    : std::runtime_error(where.line > 0 ? fmt::format("{}:{}:{}: {}", file, where.line, where.column, message)
                                        : fmt::format("{}: {}", file, message)),
      message_(message) {}

double ball_friction(const BallParams& balls, double slip) {
    if (balls.mu_b_more == 0.0) return balls.mu_b;
    return balls.mu_b + balls.mu_b_more * exponential(-balls.mu_b_fall * slip);
}

bool Scene::alike() const {
    for (const BallStart& start : ball)
        if (!(size_of(start) == size_of(ball.front()))) return false;
    return true;
}

const char* name(BallBallModel model) {
    return ball_ball_model(model).name;
}

const char* name(CushionModel model) {
    return cushion_model(model).name;
}

const char* name(ClusterModel model) {
    switch (model) {
        case ClusterModel::kCompliant:
            return "compliant";
        case ClusterModel::kRigid:
            return "rigid";
        case ClusterModel::kSequential:
            return "sequential";
    }
    return "?";
}

const char* name(ClothSlipSign sign) {
    switch (sign) {
        case ClothSlipSign::kConsistent:
            return "consistent";
        case ClothSlipSign::kAsPublished:
            return "as_published";
    }
    return "?";
}

}  // namespace carom
