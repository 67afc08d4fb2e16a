#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <variant>

#include "carom/engine/batch.h"
#include "carom/games/aim.h"
#include "carom/games/fit.h"
#include "carom/games/noise.h"
#include "carom/games/player.h"
#include "carom/games/rules.h"
#include "carom/games/solve.h"
#include "carom/interface/shape.h"

namespace carom::interface {

Value new_state(const std::string& game, const Value& options) {
    Value chosen = options;
    if (chosen.is_object()) chosen["game"] = name(games::game_named(game));
    const auto asked = read_as<games::State>(chosen, "options");
    Value state = value_of(games::new_game(asked.game, asked.turn, asked.target));
    chosen.erase("target");
    state.update(chosen);
    return state;
}

Value value_of(const Outcome& outcome, const Record& record, const Scene& scene) {
    Batch one(1, outcome.balls.size());
    for (const OutcomeColumn& column : kOutcomeColumns) column.put(one, 0, outcome);
    const auto value = [&](const OutcomeColumn& column, std::size_t at) {
        return std::visit([](auto&& of) { return Value(of); }, carom::value_of(column, one, at, scene));
    };
    Value shot, balls = Value::array();
    for (const OutcomeColumn& column : kOutcomeColumns)
        if (column.per_ball == 0 && !column.on_request) shot[column.name] = value(column, 0);
    for (std::size_t i = 0; i < outcome.balls.size(); ++i) {
        const BallState end = record.state_at(static_cast<int>(i), record.duration);
        Value ball{{"id", record.tracks[i].id},
                   {"state", name(end.state)},
                   {"position", value_of(end.position)},
                   {"velocity", value_of(end.velocity)},
                   {"spin", value_of(end.spin)}};
        for (const OutcomeColumn& column : kOutcomeColumns)
            if (column.per_ball == 1) ball[column.name] = value(column, i);
        balls.push_back(ball);
    }
    shot["balls"] = balls;
    return shot;
}

std::span<const Shape* const> types() {
    static const std::array kTypes = {
        &shape_of<games::State>(),    &shape_of<games::Call>(),
        &shape_of<games::Legal>(),    &shape_of<games::CalledFoul>(),
        &shape_of<games::Respot>(),   &shape_of<games::Option>(),
        &shape_of<games::Verdict>(),  &shape_of<games::RuleOption>(),
        &shape_of<games::GameInfo>(), &shape_of<Cue>(),
        &shape_of<games::Share>(),    &shape_of<games::Advice>(),
        &shape_of<games::Noise>(),    &shape_of<games::PocketLine>(),
        &shape_of<games::Aim>(),      &shape_of<games::Hand>(),
        &shape_of<games::Unknown>(),  &shape_of<games::Fall>(),
        &shape_of<games::Cost>(),     &shape_of<games::Fit>(),
    };
    return kTypes;
}

}  // namespace carom::interface
