// The C interface: games, aiming aids, noise and advice.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "carom/games/aim.h"
#include "carom/games/noise.h"
#include "carom/games/player.h"
#include "carom/games/rules.h"
#include "cue.h"
#include "guard.h"
#include "handles.h"

using namespace carom::c;

namespace {

namespace games = carom::games;
using carom::interface::read_as;
using carom::interface::value_of;

template <class T>
T taken(const carom_value* value, const char* name) {
    return read_as<T>(part_at(value, ""), name);
}

/// Gives what `make` returns as a value.
template <class Make>
carom_status given(carom_value** out, Make&& make) {
    return made(out, [&](carom_value& value) { value.value = value_of(make()); });
}

games::Option option_of(const carom_value* verdict, size_t index) {
    const std::string path = "options[" + std::to_string(index) + "]";
    return read_as<games::Option>(part_at(verdict, path.c_str()), path.c_str());
}

}  // namespace

carom_status carom_games(carom_value** games) {
    return given(games, games::all_games);
}

carom_status carom_game_new(const char* game, const char* options, carom_value** state) {
    return made(state, [&](carom_value& value) {
        need({game});
        value.value = carom::interface::new_state(game, json_of(options, "options"));
    });
}

carom_status carom_legal(const carom_value* state, const carom_scene* scene, carom_value** legal) {
    return given(legal, [&] {
        need({state, scene});
        return games::legal(taken<games::State>(state, "state"), scene->scene);
    });
}

carom_status carom_judge(const carom_value* state, const carom_record* record, const char* call,
                         carom_value** verdict) {
    return given(verdict, [&] {
        need({state, record});
        games::Verdict judged = games::judge(taken<games::State>(state, "state"), record->record,
                                             read_as<games::Call>(json_of(call, "call"), "call"));
        name_record(judged, record->record);
        return judged;
    });
}

carom_status carom_may_place(const carom_record* record, const carom_value* verdict, size_t option,
                             const double place[2], int32_t* allowed) {
    return guarded([&] {
        need({record, place, allowed});
        const carom::Vec2 at(place[0], place[1]);
        *allowed = games::may_place(record->record, option_of(verdict, option), at) ? 1 : 0;
    });
}

carom_status carom_next_shot(const carom_record* record, const carom_value* verdict, size_t option,
                             const carom_cue* cue, const double* place, carom_scene** scene) {
    return made(scene, [&](carom_scene& s) {
        need({record, cue});
        const games::Option of = option_of(verdict, option);
        std::optional<carom::Vec2> put;
        if (place != nullptr) put = carom::Vec2(place[0], place[1]);
        s.scene = games::next_scene(record->scene, record->record, of,
                                    cue_of(games::cue_ball(of.state), *cue), put);
    });
}

carom_status carom_pocket_lines(const carom_scene* scene, const char* ball, const char* cue_ball,
                                carom_value** lines) {
    return given(lines, [&] {
        need({scene, ball, cue_ball});
        return games::pocket_lines(scene->scene, ball, cue_ball);
    });
}

carom_status carom_aim_pot(const carom_scene* scene, const char* cue_ball, const carom_cue* how,
                           const char* ball, const char* pocket, carom_value** aim) {
    return given(aim, [&] {
        need({scene, cue_ball, how, ball, pocket});
        return games::aim_pot(scene->scene, cue_of(cue_ball, *how), ball, pocket);
    });
}

carom_status carom_bank_routes(const carom_scene* scene, const char* cue_ball, const carom_cue* how,
                               const char* ball, const char* pocket, carom_value** aims) {
    return given(aims, [&] {
        need({scene, cue_ball, how, ball, pocket});
        return games::bank_routes(scene->scene, cue_of(cue_ball, *how), ball, pocket);
    });
}

carom_status carom_noise(const char* name, double radius, carom_value** noise) {
    return given(noise, [&] {
        need({name});
        return games::noise_by_name(name, radius);
    });
}

carom_status carom_noisy_cue(const carom_cue* cue, const carom_value* noise, uint64_t seed, uint64_t index,
                             carom_cue* out) {
    return guarded([&] {
        need({cue, noise, out});
        *out =
            cue_of(games::with_noise(cue_of("cue", *cue), taken<games::Noise>(noise, "noise"), seed, index));
    });
}

carom_status carom_advise(const carom_value* state, const carom_scene* scene, const char* skill,
                          uint64_t seed, size_t best, carom_value** advice) {
    return given(advice, [&] {
        need({state, scene, skill});
        games::AdviceOptions options;
        options.seed = seed;
        options.best = best;
        const auto before = taken<games::State>(state, "state");
        const games::Skill level = games::skill_by_name(skill, scene->scene.balls.R);
        return games::advise(before, scene->scene, level, carom::kernel::best_isa(), options);
    });
}
