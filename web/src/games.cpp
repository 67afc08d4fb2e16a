// Games: legal choices, the verdict on a shot, the next scene.
#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/verdict.h"
#include "carom/engine/batch.h"
#include "carom/games/noise.h"
#include "carom/games/player.h"
#include "carom/games/rules.h"
#include "carom/interface/shape.h"
#include "web.h"

namespace carom::web {
namespace {

games::State state_at(const char* text, std::size_t size) {
    return interface::read_as<games::State>(Json::parse(text, text + size, nullptr, false), "state");
}

const games::Option& option_of(const WebVerdict* verdict, std::size_t index) {
    if (index >= verdict->verdict.options.size())
        throw BadArgument("option " + std::to_string(index) + " is out of range; there are " +
                          std::to_string(verdict->verdict.options.size()));
    return verdict->verdict.options[index];
}

void give_scene(Scene scene) {
    validate(scene);
    std::string source = scene_text(scene);
    give(new WebScene{std::move(scene), std::move(source), {}}, "");
}

}  // namespace

/// @param options  keys of a state that are not defaults
CAROM_WEB int carom_game_new(const char* name, std::size_t size, const char* options,
                             std::size_t options_size) {
    return guarded([&] {
        const Json chosen = Json::parse(options, options + options_size);
        give(nullptr, dumped(interface::new_state(std::string(name, size), chosen)));
    });
}
CAROM_WEB int carom_games() {
    return guarded([&] { give(nullptr, dumped(interface::value_of(games::all_games()))); });
}
CAROM_WEB int carom_game_legal(const char* state, std::size_t size, const WebScene* scene) {
    return guarded([&] {
        const games::State before = state_at(state, size);
        Json legal = interface::value_of(games::legal(before, scene->scene));
        legal["text"] = games::next_text(before);
        give(nullptr, dumped(legal));
    });
}
CAROM_WEB int carom_game_judge(const WebShot* shot, const char* state, std::size_t size, const char* call,
                               std::size_t call_size) {
    return guarded([&] {
        const games::State before = state_at(state, size);
        auto verdict = std::make_unique<WebVerdict>();
        const auto said = interface::read_as<games::Call>(Json::parse(call, call + call_size), "call");
        verdict->verdict = games::judge(before, shot->record, said);
        std::string text = dumped(interface::value_of(verdict->verdict));
        give(verdict.release(), std::move(text));
    });
}
/// @param options {"skill", "seed", "best", "shots", "seconds"}
CAROM_WEB int carom_game_advise(const char* state, std::size_t size, const WebScene* scene,
                                const char* options, std::size_t options_size) {
    return guarded([&] {
        const Json asked = Json::parse(options, options + options_size);
        const Scene& table = scene->scene;
        games::AdviceOptions how;
        how.seed = asked.at("seed").get<std::uint64_t>();
        how.best = asked.at("best").get<std::size_t>();
        how.fresh = asked.at("shots").get<std::size_t>();
        games::Skill skill = games::skill_by_name(asked.at("skill").get<std::string>(), table.balls.R);
        const games::State before = state_at(state, size);
        const auto start = std::chrono::steady_clock::now();
        // A share of the time is left for a search of pots alone.
        const std::chrono::duration<double> most(0.6 * asked.at("seconds").get<double>());
        how.stop = [&] { return std::chrono::steady_clock::now() - start > most; };
        std::vector<games::Advice> advice;
        try {
            advice = games::advise(before, table, skill, kernel::best_isa(), how);
        } catch (const BatchStopped&) {
            how.stop = {};
            how.fresh = 0;
            skill.look = games::Look::kPot;
            advice = games::advise(before, table, skill, kernel::best_isa(), how);
        }
        give(nullptr, dumped(interface::value_of(advice)));
    });
}
/// The strike of a player of a level who intends the scene's cue.
CAROM_WEB int carom_game_strike(const WebScene* scene, double seed, const char* skill, std::size_t size) {
    return guarded([&] {
        if (!scene->scene.cue) throw BadArgument("the scene has no cue");
        const Cue& cue = *scene->scene.cue;
        const games::Skill by = games::skill_by_name(std::string(skill, size), scene->scene.balls.R);
        const games::Noise noise = by.noise_at(cue.speed);
        give(nullptr,
             dumped(interface::value_of(games::with_noise(cue, noise, static_cast<std::uint64_t>(seed), 0))));
    });
}
CAROM_WEB int carom_game_choose(const WebShot* shot, const WebVerdict* verdict, const char* skill,
                                std::size_t size) {
    return guarded([&] {
        const games::Skill by = games::skill_by_name(std::string(skill, size), shot->scene.balls.R);
        give(nullptr, std::to_string(games::choose(verdict->verdict, shot->record, by)));
    });
}
CAROM_WEB void carom_free_verdict(WebVerdict* verdict) {
    delete verdict;
}
CAROM_WEB int carom_game_may_place(const WebShot* shot, const WebVerdict* verdict, std::size_t option,
                                   double x, double y) {
    return guarded([&] {
        const bool may = games::may_place(shot->record, option_of(verdict, option), Vec2(x, y));
        give(nullptr, may ? "true" : "false");
    });
}
/// The next scene: the cue ball at (x, y), or if they are NaN, at its position or the free place nearest to
/// the head spot; the cue of the last shot, aimed at the nearest ball that may be hit first.
CAROM_WEB int carom_game_next(const WebShot* shot, const WebVerdict* verdict, std::size_t index, double x,
                              double y) {
    return guarded([&] {
        const games::Option& option = option_of(verdict, index);
        std::optional<Vec2> place;
        if (x == x && y == y)
            place = Vec2(x, y);
        else if (option.state.in_hand != games::InHand::kNo)
            place = games::free_place(shot->record, option);
        Scene next = games::table_after(shot->scene, shot->record, option, place);
        const std::vector<std::string> balls = ids_of(next.ball);
        next.cue =
            tools::next_cue(next, shot->scene.cue.value_or(Cue{}), games::struck_next(option.state, balls),
                            games::legal(option.state, next).first);
        give_scene(std::move(next));
    });
}
/// The scene at rest, without a game: pocketed balls are gone, and the cue is from the last shot. If the
/// struck ball is gone, there is no cue.
CAROM_WEB int carom_shot_after(const WebShot* shot) {
    return guarded([&] {
        Scene next = scene_after(shot->scene, shot->record);
        if (shot->scene.cue && index_of(next.ball, shot->scene.cue->ball) >= 0) next.cue = shot->scene.cue;
        give_scene(std::move(next));
    });
}

}  // namespace carom::web
