// Shots of one player on many tables, played and judged in one pass: what learning environments are made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "carom/engine/batch.h"
#include "carom/games/rules.h"

namespace carom::games {

/// What comes of the shots, in memory of the caller's: arrays of n, and of n x balls in the order of
/// Scene::ball. Of a shot that does not end at rest nothing is written.
struct JudgedArrays {
    /// n x balls x 2 [m]: behind the shot, x and y in turns; NaN for a ball that is not on the table
    double* xy = nullptr;
    /// n: eight-ball, the player's Group before the shot; then that behind it
    std::int32_t* group = nullptr;
    std::int32_t* foul = nullptr;  ///< n: number of the first Foul, or -1
    /// n: of pool the balls that fell in a fair shot, otherwise Verdict::points
    std::int32_t* points = nullptr;
    /// n: whether it is still the player's turn, in a game that is not over
    std::uint8_t* goes_on = nullptr;
};

/// The state of a game in the middle of a turn of player 0, who has these balls of eight-ball.
State state_of_turn(Game game, Group group);

/// Plays shots as simulate_many() does, and each thread judges what it has played: by judge(), for player 0
/// in the middle of a turn. Of eight-ball the first ball that counts and falls is taken as called.
/// @param options  `judge` is not read
/// @return the messages of simulate_many()
/// @throws what simulate_many() and judge() throw
std::vector<Batch::Message> judge_many(Game game, const Scene& scene, std::size_t shots,
                                       std::span<const BatchColumn> columns, kernel::Isa isa,
                                       const BatchOptions& options, const BatchArrays& out,
                                       const JudgedArrays& judged);

}  // namespace carom::games
