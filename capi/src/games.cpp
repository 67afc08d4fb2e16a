// The C interface: rules of games, and noise.
#include "carom/games/rules.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/games/noise.h"
#include "carom/games/player.h"
#include "cue.h"
#include "guard.h"
#include "handles.h"

using namespace carom::c;

namespace {

namespace games = carom::games;

static_assert(CAROM_IN_THE_D == static_cast<int>(games::InHand::kD));

/// A value of an enumeration. @throws BadArgument
std::size_t checked(const char* what, int32_t value, std::size_t count) {
    if (value < 0 || static_cast<std::size_t>(value) >= count)
        throw BadArgument(std::string(what) + " is " + std::to_string(value) + "; expected 0 to " +
                          std::to_string(count - 1));
    return static_cast<std::size_t>(value);
}
template <class E>
E value_of(const char* what, int32_t value) {
    return static_cast<E>(checked(what, value, games::names_of(E{}).size()));
}
games::Game game_of(int32_t number) {
    const auto all = games::all_of(games::Game{});
    return all[checked("game", number, all.size())];
}

// The options of the rules share `game`, two bits each, because the size of the struct is promised.
constexpr int kGameBits = 8, kGameMask = (1 << kGameBits) - 1, kOptionBits = 2, kOptionMask = 3;

/// @throws BadArgument for bits that are no options of the game
std::vector<std::string> unpacked(games::Game game, std::uint32_t bits) {
    std::vector<std::string> rules;
    for (const games::RuleOption& option : games::info_of(game).options) {
        const std::size_t value = bits & kOptionMask;
        bits = value < option.values.size() ? bits >> kOptionBits : ~0U;
        if (bits == ~0U) break;
        if (value > 0) rules.push_back(option.key + "=" + option.values[value]);
    }
    if (bits != 0)
        throw BadArgument(std::string("the state has rule options of another game, not of ") + name(game) +
                          "; begin a new game and set them");
    return rules;
}

std::uint32_t number_of(games::Game game) {
    const auto all = games::all_of(game);
    return static_cast<std::uint32_t>(std::find(all.begin(), all.end(), game) - all.begin());
}

std::uint32_t packed(const games::State& state) {
    std::uint32_t bits = 0;
    int shift = 0;
    for (const games::RuleOption& option : games::info_of(state.game).options) {
        for (std::uint32_t value = 1; value < option.values.size(); ++value)
            if (std::find(state.rules.begin(), state.rules.end(), option.key + "=" + option.values[value]) !=
                state.rules.end())
                bits |= value << shift;
        shift += kOptionBits;
    }
    return bits;
}

games::State state_of(const carom_game_state& s) {
    games::State state;
    state.game = game_of(s.game & kGameMask);
    state.rules = unpacked(state.game, static_cast<std::uint32_t>(s.game) >> kGameBits);
    state.turn = s.turn;
    state.opening = s.opening != 0;
    state.in_hand = value_of<games::InHand>("in_hand", s.in_hand);
    state.points = {s.points[0], s.points[1]};
    state.target = s.target;
    state.over = s.over != 0;
    state.winner = s.winner;
    state.group = {value_of<games::Group>("group", s.group[0]), value_of<games::Group>("group", s.group[1])};
    state.may_push_out = s.may_push_out != 0;
    state.fouls = {s.fouls[0], s.fouls[1]};
    state.on = value_of<games::BallOn>("on", s.on);
    state.free_ball = s.free_ball != 0;
    return state;
}

carom_game_state state_of(const games::State& s) {
    carom_game_state state{};
    state.game = static_cast<int32_t>(number_of(s.game) | packed(s) << kGameBits);
    state.turn = s.turn;
    state.opening = s.opening ? 1 : 0;
    state.in_hand = static_cast<int32_t>(s.in_hand);
    state.target = s.target;
    state.over = s.over ? 1 : 0;
    state.winner = s.winner;
    for (std::size_t player = 0; player < 2; ++player) {
        state.points[player] = s.points[player];
        state.group[player] = static_cast<int32_t>(s.group[player]);
        state.fouls[player] = s.fouls[player];
    }
    state.may_push_out = s.may_push_out ? 1 : 0;
    state.on = static_cast<int32_t>(s.on);
    state.free_ball = s.free_ball ? 1 : 0;
    return state;
}

std::string text_of(const char* text) {
    return text != nullptr ? text : "";
}

void check_record(const carom_record& record, const carom_verdict& verdict) {
    if (verdict.record != record.record.hash())
        throw BadArgument("the verdict belongs to another record; give the record that was judged");
}

const games::Option& option_of(const carom_verdict* verdict, size_t index) {
    need({verdict});
    check_index(index, verdict->verdict.options.size(), "option");
    return verdict->verdict.options[index];
}

void fill(const std::vector<std::string>& balls, const games::Legal& legal, uint8_t* strike, uint8_t* first,
          uint8_t* callable) {
    const auto mark = [&](uint8_t* out, const std::vector<std::string>& list) {
        for (size_t i = 0; out != nullptr && i < balls.size(); ++i)
            out[i] = std::find(list.begin(), list.end(), balls[i]) != list.end() ? 1 : 0;
    };
    mark(strike, legal.cue_balls);
    mark(first, legal.first);
    mark(callable, legal.callable);
}

}  // namespace

carom_status carom_game_new(carom_game game, int first, int target, carom_game_state* state) {
    return guarded([&] {
        need({state});
        const auto of = game_of(static_cast<int32_t>(game));
        *state = asked([&] { return state_of(games::new_game(of, first, target)); });
    });
}

carom_status carom_game_rule(carom_game_state* state, const char* option) {
    return guarded([&] {
        need({state, option});
        games::State with = state_of(*state);
        asked([&] {
            games::set_rule(with, option);
            return true;
        });
        *state = state_of(with);
    });
}

carom_status carom_legal(const carom_game_state* state, size_t count, const char* const* ids, uint8_t* strike,
                         uint8_t* first, uint8_t* callable) {
    return guarded([&] {
        need({state});
        if (count > 0) need({ids});
        std::vector<std::string> balls;
        for (size_t i = 0; i < count; ++i) {
            need({ids[i]});
            balls.emplace_back(ids[i]);
        }
        fill(balls, asked([&] { return games::legal(state_of(*state), balls); }), strike, first, callable);
    });
}

carom_status carom_legal_on(const carom_game_state* state, const carom_scene* scene, uint8_t* strike,
                            uint8_t* first, uint8_t* callable) {
    return guarded([&] {
        need({state, scene});
        const carom::Scene& on = scene->scene;
        fill(carom::ids_of(on.ball), asked([&] { return games::legal(state_of(*state), on); }), strike, first,
             callable);
    });
}

carom_status carom_judge(const carom_game_state* state, const carom_record* record, const carom_call* call,
                         carom_verdict** verdict) {
    return made(verdict, [&](carom_verdict& v) {
        need({state, record});
        games::Call said;
        if (call != nullptr)
            said = {text_of(call->ball), text_of(call->pocket), call->safety != 0, call->push_out != 0};
        const games::State before = state_of(*state);
        v.record = record->record.hash();
        v.verdict = asked([&] { return games::judge(before, record->record, said); });
    });
}

void carom_verdict_free(carom_verdict* verdict) {
    delete verdict;
}

size_t carom_verdict_foul_count(const carom_verdict* verdict) {
    return verdict != nullptr ? verdict->verdict.fouls.size() : 0;
}

const char* carom_verdict_foul(const carom_verdict* verdict, size_t index) {
    return index < carom_verdict_foul_count(verdict) ? carom::name(verdict->verdict.fouls[index].foul)
                                                     : nullptr;
}

const char* carom_verdict_rule(const carom_verdict* verdict, size_t index) {
    if (index >= carom_verdict_foul_count(verdict)) return nullptr;
    return verdict->verdict.fouls[index].rule.c_str();
}

int carom_verdict_points(const carom_verdict* verdict) {
    return verdict != nullptr ? verdict->verdict.points : 0;
}

int carom_verdict_penalty(const carom_verdict* verdict) {
    return verdict != nullptr ? verdict->verdict.penalty : 0;
}

int carom_verdict_chooser(const carom_verdict* verdict) {
    return verdict != nullptr ? verdict->verdict.chooser : -1;
}

size_t carom_verdict_option_count(const carom_verdict* verdict) {
    return verdict != nullptr ? verdict->verdict.options.size() : 0;
}

carom_status carom_verdict_option(const carom_verdict* verdict, size_t index, carom_option* option) {
    return guarded([&] {
        need({option});
        const games::Option& of = option_of(verdict, index);
        *option = {carom::name(of.decision), state_of(of.state), of.rerack() ? 1 : 0, of.respots.size()};
    });
}

carom_status carom_verdict_respot(const carom_verdict* verdict, size_t option, size_t index,
                                  const char** ball, double place[2]) {
    return guarded([&] {
        need({ball, place});
        const games::Option& of = option_of(verdict, option);
        check_index(index, of.respots.size(), "respot");
        *ball = of.respots[index].ball.c_str();
        std::copy_n(of.respots[index].place.data(), 2, place);
    });
}

carom_status carom_may_place(const carom_record* record, const carom_verdict* verdict, size_t option,
                             const double place[2], int32_t* allowed) {
    return guarded([&] {
        need({record, place, allowed});
        const games::Option& of = option_of(verdict, option);
        check_record(*record, *verdict);
        *allowed = asked([&] { return games::may_place(record->record, of, {place[0], place[1]}); }) ? 1 : 0;
    });
}

carom_status carom_next_shot(const carom_record* record, const carom_verdict* verdict, size_t option,
                             const carom_cue* cue, const double* place, carom_scene** scene) {
    return made(scene, [&](carom_scene& s) {
        need({record, cue});
        const games::Option& of = option_of(verdict, option);
        check_record(*record, *verdict);
        std::optional<carom::Vec2> put;
        if (place != nullptr) put = carom::Vec2(place[0], place[1]);
        const carom::Cue strike = cue_of(games::cue_ball(of.state), *cue);
        s.scene = asked([&] { return games::next_scene(record->scene, record->record, of, strike, put); });
    });
}

carom_status carom_advise(const carom_game_state* state, const carom_scene* scene, const char* skill,
                          uint64_t seed, size_t best, carom_advice** advice) {
    return made(advice, [&](carom_advice& a) {
        need({state, scene, skill});
        games::AdviceOptions options;
        options.seed = seed;
        options.best = best;
        const games::State before = state_of(*state);
        a.shots = asked([&] {
            const games::Skill level = games::skill_by_name(skill, scene->scene.balls.R);
            return games::advise(before, scene->scene, level, carom::kernel::best_isa(), options);
        });
        for (const games::Advice& shot : a.shots)
            a.words.push_back(games::words_of(shot, scene->scene.table));
    });
}

void carom_advice_free(carom_advice* advice) {
    delete advice;
}

size_t carom_advice_count(const carom_advice* advice) {
    return advice != nullptr ? advice->shots.size() : 0;
}

carom_status carom_advice_shot(const carom_advice* advice, size_t index, carom_advised* shot) {
    return guarded([&] {
        need({advice, shot});
        check_index(index, advice->shots.size(), "shot");
        const games::Advice& of = advice->shots[index];
        *shot = {};
        shot->words = advice->words[index].c_str();
        shot->kind = carom::name(of.kind);
        for (const auto& [theirs, ours] : kCueNumbers) shot->cue.*theirs = of.cue.*ours;
        shot->call = {of.call.ball.c_str(), of.call.pocket.c_str(), of.call.safety ? 1 : 0,
                      of.call.push_out ? 1 : 0};
        shot->placed = of.place ? 1 : 0;
        if (of.place) std::copy_n(of.place->data(), 2, shot->place);
        const auto fill = [](double* out, const games::Share& share) {
            out[0] = share.value;
            out[1] = share.low;
            out[2] = share.high;
        };
        fill(shot->makes, of.makes);
        fill(shot->fouls, of.fouls);
        shot->worth = of.worth;
    });
}

carom_status carom_noisy_cue(const carom_cue* cue, const double deviations[5], uint64_t seed, uint64_t index,
                             carom_cue* out) {
    return guarded([&] {
        need({cue, deviations, out});
        const games::Noise sd = {deviations[0], deviations[1], deviations[2], deviations[3], deviations[4]};
        const carom::Cue struck =
            asked([&] { return games::with_noise(cue_of("cue", *cue), sd, seed, index); });
        for (const auto& [theirs, ours] : kCueNumbers) out->*theirs = struck.*ours;
    });
}

carom_status carom_noise(const char* name, double radius, double deviations[5]) {
    return guarded([&] {
        need({name, deviations});
        const games::Noise sd = asked([&] { return games::noise_by_name(name, radius); });
        const double numbers[] = {sd.speed, sd.aim_deg, sd.elevation_deg, sd.side, sd.height};
        std::copy_n(numbers, 5, deviations);
    });
}
