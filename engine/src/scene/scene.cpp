// The parts of a scene that compute something.
#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "carom/engine/scene.h"

namespace carom {

SceneError::SceneError(const std::string& file, SourceLocation where, const std::string& message)
    : std::runtime_error(where.line > 0 ? fmt::format("{}:{}:{}: {}", file, where.line, where.column, message)
                                        : fmt::format("{}: {}", file, message)),
      message_(message) {}

bool Scene::alike() const {
    for (const BallStart& start : ball)
        if (!(size_of(start) == size_of(ball.front()))) return false;
    return true;
}

}  // namespace carom
