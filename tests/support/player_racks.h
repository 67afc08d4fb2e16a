// Racks between players of carom/games/player.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "base/draws.h"
#include "carom/engine/simulate.h"
#include "carom/games/player.h"

namespace carom::test {

struct RackShot {
    games::State before;
    Scene table;  ///< before the shot, without what the advice changes
    games::Advice advice;
    games::Verdict verdict;
    games::Option taken;
    /// Whether the shot kept the turn or won.
    bool made() const {
        const games::State& next = taken.state;
        return next.over ? next.winner == before.turn
                         : next.turn == before.turn && verdict.fouls.empty() && !taken.rerack();
    }
};

inline Scene pool_rack(const std::string& table, games::Game game, std::uint64_t seed) {
    const std::string more = game == &games::kNineBall ? "spot_ball = 9\n" : "";
    return parse_scene("[table]\npreset = \"" + table + "\"\n[balls]\npreset = \"pool\"\n[rack]\ngame = \"" +
                           std::string(name(game)) + "\"\nseed = " + std::to_string(seed % 1000000007) +
                           "\n" + more + "[[ball]]\nid = \"cue\"\nposition = [0.5, 0.5]\n[cue]\n",
                       "rack");
}

inline Scene nine_foot_rack(games::Game game, std::uint64_t seed) {
    return pool_rack("nine_foot", game, seed);
}

/// A player's adviser: games::advise(), or another function.
using Adviser = std::function<games::Advice(const games::State&, const Scene&, std::uint64_t seed)>;

inline Adviser adviser(const games::Skill& skill, kernel::Isa isa = kernel::best_isa()) {
    return [skill, isa](const games::State& state, const Scene& scene, std::uint64_t seed) {
        games::AdviceOptions options;
        options.seed = seed;
        options.best = 1;
        options.fresh = state.opening ? 1 : 0;
        return games::advise(state, scene, skill, isa, options).front();
    };
}

/// Number of these racks in which the breaker keeps the turn.
inline int breaks_kept(const std::string& table, games::Game game, const games::Skill& skill, int racks,
                       std::uint64_t first_seed) {
    const kernel::Isa isa = kernel::best_isa();
    int kept = 0;
    for (std::uint64_t seed = first_seed; seed < first_seed + static_cast<std::uint64_t>(racks); ++seed) {
        RackShot shot;
        shot.before = games::new_game(game);
        shot.table = pool_rack(table, game, seed);
        Scene scene = games::scene_with(shot.table, adviser(skill)(shot.before, shot.table, seed));
        scene.cue = games::with_noise(*scene.cue, skill.noise, seed, 0);
        shot.verdict = games::judge(shot.before, simulate(make_plan(scene, isa)));
        shot.taken = shot.verdict.options.front();
        kept += shot.made();
    }
    return kept;
}

inline constexpr int kLongestRack = 300;

/// Plays a rack until `each` returns false, it is over, or kLongestRack shots. Strikes have the errors of the
/// players' skills. @return the winner, or -1
inline int play_rack(games::Game game, const std::array<games::Skill, 2>& skills,
                     const std::array<Adviser, 2>& advisers, std::uint64_t seed, int breaker,
                     const std::function<bool(const RackShot&)>& each) {
    games::State state = games::new_game(game, breaker);
    const kernel::Isa isa = kernel::best_isa();
    SplitMix64 racks = draws_of(seed, 0, "rack");
    Scene scene = nine_foot_rack(game, racks.next());
    for (int n = 0; n < kLongestRack; ++n) {
        const auto player = static_cast<std::size_t>(state.turn);
        RackShot shot;
        shot.before = state;
        shot.table = scene;
        const auto index = static_cast<std::uint64_t>(n);
        shot.advice = advisers[player](state, scene, seed * kLongestRack + index);
        scene = games::scene_with(scene, shot.advice);
        scene.cue = games::with_noise(shot.advice.cue, skills[player].noise, seed ^ 0x5eed, index);
        validate(scene);
        const Record record = simulate(make_plan(scene, isa));
        shot.verdict = games::judge(state, record, shot.advice.call);
        std::size_t option = 0;
        if (const int chooser = shot.verdict.chooser; chooser >= 0)
            option = games::choose(shot.verdict, record, skills[static_cast<std::size_t>(chooser)]);
        shot.taken = shot.verdict.options[option];
        if (!each(shot) || shot.taken.state.over) return shot.taken.state.winner;
        state = shot.taken.state;
        if (shot.taken.rerack()) {
            scene = nine_foot_rack(game, racks.next());
            continue;
        }
        std::optional<Vec2> place;
        if (state.in_hand != games::InHand::kNo)
            place = games::free_place(record, shot.taken, head_spot(scene.table));
        scene = games::table_after(scene, record, shot.taken, place);
    }
    return -1;
}

}  // namespace carom::test
