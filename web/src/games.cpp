// Games: what is legal, the verdict on a shot, the next scene.
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/game_state.h"
#include "base/verdict.h"
#include "carom/games/rules.h"
#include "web.h"

namespace carom::web {
namespace {

using Json = nlohmann::ordered_json;

std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

games::State state_at(const char* text, std::size_t size) {
    return tools::parse_state(std::string(text, size), "the state");
}

games::Call call_at(const char* text, std::size_t size) {
    const Json json = Json::parse(text_at(text, size));
    return {json.value("ball", ""), json.value("pocket", ""), json.value("safety", false),
            json.value("pushOut", false)};
}

const games::Option& option_of(const WebVerdict* verdict, std::size_t index) {
    if (index >= verdict->verdict.options.size())
        throw BadArgument("option " + std::to_string(index) + " is out of range; there are " +
                          std::to_string(verdict->verdict.options.size()));
    return verdict->verdict.options[index];
}

}  // namespace
}  // namespace carom::web

using carom::web::guarded;
using carom::web::WebScene;
using carom::web::WebShot;
using carom::web::WebVerdict;

CAROM_WEB int carom_game_new(const char* name, std::size_t size, int first, int target) {
    return guarded([&] {
        const carom::games::Game game = carom::tools::game_of(std::string(name, size));
        carom::web::give(nullptr, carom::web::dumped(
                                      carom::tools::state_json(carom::games::new_game(game, first, target))));
    });
}
CAROM_WEB int carom_game_legal(const char* state, std::size_t size, const WebScene* scene) {
    return guarded([&] {
        std::vector<std::string> ids;
        for (const carom::BallStart& ball : scene->scene.ball) ids.push_back(ball.id);
        const carom::games::State before = carom::web::state_at(state, size);
        const carom::games::Legal legal = carom::games::legal(before, ids);
        carom::web::give(nullptr, carom::web::dumped({{"cueBalls", legal.cue_balls},
                                                      {"first", legal.first},
                                                      {"callable", legal.callable},
                                                      {"inHand", carom::name(legal.in_hand)},
                                                      {"mayPushOut", legal.may_push_out},
                                                      {"text", carom::tools::next_text(before)}}));
    });
}
CAROM_WEB int carom_game_judge(const WebShot* shot, const char* state, std::size_t size, const char* call,
                               std::size_t call_size) {
    return guarded([&] {
        const carom::games::State before = carom::web::state_at(state, size);
        auto verdict = std::make_unique<WebVerdict>();
        verdict->verdict = carom::games::judge(before, shot->record, carom::web::call_at(call, call_size));
        auto json = carom::tools::verdict_json(verdict->verdict, before.game);
        for (std::size_t i = 0; i < verdict->verdict.options.size(); ++i) {
            const carom::games::Option& option = verdict->verdict.options[i];
            json["options"][i]["text"] = carom::tools::next_text(option.state);
            json["options"][i]["rerack"] = option.rerack();
        }
        std::string text = carom::web::dumped(json);
        carom::web::give(verdict.release(), std::move(text));
    });
}
CAROM_WEB void carom_free_verdict(WebVerdict* verdict) {
    delete verdict;
}
CAROM_WEB int carom_game_may_place(const WebShot* shot, const WebVerdict* verdict, std::size_t option,
                                   double x, double y) {
    return guarded([&] {
        const bool may =
            carom::games::may_place(shot->record, carom::web::option_of(verdict, option), carom::Vec2(x, y));
        carom::web::give(nullptr, may ? "true" : "false");
    });
}
/// The next scene: the cue ball at (x, y), or, if they are NaN, where it lies or at the free place nearest to
/// the head spot; the cue of the last shot, aimed at the nearest ball that may be hit first.
CAROM_WEB int carom_game_next(const WebShot* shot, const WebVerdict* verdict, std::size_t index, double x,
                              double y) {
    return guarded([&] {
        const carom::games::Option& option = carom::web::option_of(verdict, index);
        std::optional<carom::Vec2> place;
        if (x == x && y == y)
            place = carom::Vec2(x, y);
        else if (option.state.in_hand != carom::games::InHand::kNo)
            place = carom::tools::free_place(shot->record, option);
        carom::Scene next = carom::games::table_after(shot->scene, shot->record, option, place);
        std::vector<std::string> ids;
        for (const carom::BallStart& ball : next.ball) ids.push_back(ball.id);
        next.cue = carom::tools::next_cue(next, shot->scene.cue.value_or(carom::Cue{}),
                                          carom::games::cue_ball(option.state),
                                          carom::games::legal(option.state, ids).first);
        carom::validate(next);
        std::string source = carom::scene_text(next);
        carom::web::give(new WebScene{std::move(next), std::move(source), {}}, "");
    });
}
/// The table as it rests, without a game: pocketed balls are gone, and the cue is that of the last shot. If
/// the struck ball is gone, there is no cue.
CAROM_WEB int carom_shot_after(const WebShot* shot) {
    return guarded([&] {
        carom::Scene next = carom::scene_after(shot->scene, shot->record);
        if (shot->scene.cue)
            for (const carom::BallStart& ball : next.ball)
                if (ball.id == shot->scene.cue->ball) next.cue = shot->scene.cue;
        carom::validate(next);
        std::string source = carom::scene_text(next);
        carom::web::give(new WebScene{std::move(next), std::move(source), {}}, "");
    });
}
