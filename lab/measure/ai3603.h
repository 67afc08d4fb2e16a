// Eight-ball by the rules of the course AI3603 (SJTU-RL2/AI3603-Billiards, poolenv.py and evaluate.py),
// rewritten from their description: groups are fixed at the start, shots are not called, and a foul restores
// the balls' places and passes the turn.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "carom/games/shot.h"
#include "carom/games/spots.h"
#include "facts.h"
#include "support/player_racks.h"

namespace carom::lab {

/// The result of a strike by these rules.
struct Ai3603Shot {
    std::optional<bool> wins;  ///< if it ends the game: whether the player who struck wins
    bool foul = false, keeps_turn = false;
};

/// @param solids, left  the striker's group, and the number of its balls before the shot
inline Ai3603Shot ai3603_shot(const Record& record, bool solids, int left) {
    using games::detail::number_of;
    const games::Shot shot = games::shot_of(record);
    const auto number = [&](int ball) { return number_of(record.tracks[static_cast<std::size_t>(ball)].id); };
    const auto own = [&](int n) { return n > 0 && n != 8 && (n < 8) == solids; };
    bool cue = false, eight = false, any_own = false, any = false;
    for (int ball = 0; ball < static_cast<int>(record.tracks.size()); ++ball) {
        if (!shot.gone(ball)) continue;
        any = true;
        cue |= ball == shot.struck;
        eight |= number(ball) == 8;
        any_own |= own(number(ball));
    }
    if (eight) return {.wins = !cue && left == 0};
    if (cue || shot.first_hits.empty()) return {.foul = true};
    const int first = number(shot.first_hits[0]);
    if (left > 0 ? !own(first) : first != 8) return {.foul = true};
    const bool cushion =
        std::any_of(shot.touches.begin(), shot.touches.end(), [&](const games::BallContact& touch) {
            return touch.cushion() && (touch.ball == shot.struck || touch.ball == shot.first_hits[0]);
        });
    if (!any && !cushion) return {.foul = true};
    return {.keeps_turn = any_own};
}

/// One rack on the seven-foot table. Both break with the stroke of carom/games/player.h.
/// @return the first player's points: 1 for a win, 1/2 for a draw
inline double ai3603_rack(const std::array<test::Adviser, 2>& advisers, std::uint64_t seed, int breaker,
                          bool breaker_has_solids) {
    constexpr int kMostStrikes = 60;
    Scene table = test::pool_rack("seven_foot", &games::kEightBall, seed);
    const games::Noise noise = games::noise_by_name("ai3603", table.balls.R);
    const auto left = [&](bool solids) {
        return static_cast<int>(
            std::count_if(table.ball.begin(), table.ball.end(), [&](const BallStart& ball) {
                const int n = games::detail::number_of(ball.id);
                return n > 0 && n != 8 && (n < 8) == solids;
            }));
    };
    const auto has_solids = [&](int player) { return (player == breaker) == breaker_has_solids; };
    games::State state = games::new_game(&games::kEightBall, breaker);
    state.opening = false;
    state.in_hand = games::InHand::kNo;
    for (int player : {0, 1})
        state.group[static_cast<std::size_t>(player)] =
            has_solids(player) ? games::Group::kSolids : games::Group::kStripes;
    games::State opening = games::new_game(&games::kEightBall, breaker);
    bool racked = true;
    for (int n = 0; n < kMostStrikes; ++n) {
        const int player = state.turn;
        opening.turn = player;
        const auto index = static_cast<std::uint64_t>(n);
        const games::Advice advice = advisers[static_cast<std::size_t>(player)](
            racked ? opening : state, table, seed * kMostStrikes + index);
        Scene scene = games::scene_with(table, advice);
        scene.cue = games::with_noise(advice.cue, noise, seed ^ 0x3603, index);
        scene.cue->speed = std::clamp(scene.cue->speed, 0.5, 8.0);
        validate(scene);
        const Record record = simulate(make_plan(scene, kernel::best_isa()));
        const Ai3603Shot did = ai3603_shot(record, has_solids(player), left(has_solids(player)));
        if (did.wins) return (player == 0) == *did.wins ? 1.0 : 0.0;
        if (!did.foul) {
            games::Option next;
            next.state = state;
            table = games::table_after(scene, record, next);
            table.cue = scene.cue;
            racked = false;
        }
        if (!did.keeps_turn) state.turn = 1 - player;
    }
    const int first = left(has_solids(0)), second = left(has_solids(1));
    return first == second ? 0.5 : first < second ? 1.0 : 0.0;
}

}  // namespace carom::lab
