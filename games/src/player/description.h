// A shot that was played, as a player describes it.
#pragma once

#include <string>

#include "carom/engine/record.h"
#include "carom/games/player.h"
#include "carom/games/shot.h"

namespace carom::games::detail {

/// How the ball fell: directly, off a rail, off another ball, or after a cushion of the cue ball.
ShotKind kind_of(const Record& record, const Shot& shot, const Shot::Fallen& fallen);
/// The motion of the cue ball at its first contact: "follow", "stun" or "draw"; "" if it hits no ball.
std::string spin_words(const Record& record, const Shot& shot);
/// The rails that the ball of a bank meets, or the cue ball of a kick: "off the left rail at diamond 3.2".
/// @param bank  the number of that ball; 0: the cue ball
std::string rail_words(const Record& record, const Shot& shot, int bank);
/// A place by the nearest pocket or spot, or by both sides of a line between two.
std::string place_words(const Table& table, const Vec2& place);

}  // namespace carom::games::detail
