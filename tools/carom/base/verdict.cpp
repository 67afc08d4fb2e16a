#include "base/verdict.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "carom/engine/math.h"

namespace carom::tools {

using Json = nlohmann::ordered_json;

Json measure_json(const games::Measure& measure, const Record& record) {
    const games::MeasureValue value = measure.of(record);
    if (!measure.is_number()) return std::get<std::vector<std::string>>(value);
    const double number = std::get<double>(value);
    if (measure.is_truth()) return number != 0.0;
    return std::isnan(number) ? Json() : Json(number);
}

Cue next_cue(const Scene& table, const Cue& before, const std::string& ball,
             const std::vector<std::string>& first) {
    Cue cue = before;
    cue.ball = ball;
    cue.side = 0.0;
    const int struck = index_of(table.ball, ball);
    double least = HUGE_VAL;
    for (const BallStart& other : table.ball) {
        if (struck < 0 || other.id == ball) continue;
        if (!first.empty() && std::find(first.begin(), first.end(), other.id) == first.end()) continue;
        const Vec2 way = planar(other.position - table.ball[struck].position);
        if (way.norm() >= least) continue;
        least = way.norm();
        cue.aim_deg = direction_deg(way.x(), way.y());
    }
    return cue;
}

}  // namespace carom::tools
