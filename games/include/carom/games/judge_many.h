// Plays and judges shots of one player on many tables in one pass, for learning environments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/games/rules.h"

namespace carom::games {

/// Results of the shots, in the caller's memory: arrays of n, and of n x balls in the order of Scene::ball.
/// Nothing is written for a shot that does not end at rest.
struct JudgedArrays {
    /// n x balls x 2 [m]: after the shot, x and y alternating; NaN for a ball that is not on the table
    double* xy = nullptr;
    /// n: eight-ball, the player's Group before the shot; replaced by the one after it
    std::int32_t* group = nullptr;
    std::int32_t* foul = nullptr;  ///< n: number of the first Foul, or -1
    /// n: pool: number of balls that fell in a fair shot; otherwise Verdict::points
    std::int32_t* points = nullptr;
    /// n: whether the player's turn continues in a game that is not over
    std::uint8_t* goes_on = nullptr;
};

/// The state of a game in the middle of a turn of player 0, who has this group in eight-ball.
State state_of_turn(Game game, Group group);

/// The call of a player who foresees the shot: the first ball that falls and counts.
Call lucky_call(const State& state, const Record& record);

/// Plays shots as simulate_many() does; each thread judges its shots with judge(), for player 0 in the middle
/// of a turn. In eight-ball, the first ball that counts and falls is taken as called.
/// @param options `judge` is ignored
/// @return the messages of simulate_many()
/// @throws as simulate_many() and judge()
std::vector<Batch::Message> judge_many(Game game, const Scene& scene, std::size_t shots,
                                       std::span<const BatchColumn> columns, kernel::Isa isa,
                                       const BatchOptions& options, const BatchArrays& out,
                                       const JudgedArrays& judged);

}  // namespace carom::games
