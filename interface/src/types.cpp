#include <array>
#include <span>
#include <string>

#include "carom/games/aim.h"
#include "carom/games/noise.h"
#include "carom/games/player.h"
#include "carom/games/rules.h"
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

std::span<const Shape* const> types() {
    static const std::array kTypes = {
        &shape_of<games::State>(),    &shape_of<games::Call>(),
        &shape_of<games::Legal>(),    &shape_of<games::CalledFoul>(),
        &shape_of<games::Respot>(),   &shape_of<games::Option>(),
        &shape_of<games::Verdict>(),  &shape_of<games::RuleOption>(),
        &shape_of<games::GameInfo>(), &shape_of<Cue>(),
        &shape_of<games::Share>(),    &shape_of<games::Advice>(),
        &shape_of<games::Noise>(),    &shape_of<games::PocketLine>(),
        &shape_of<games::Aim>(),
    };
    return kTypes;
}

}  // namespace carom::interface
