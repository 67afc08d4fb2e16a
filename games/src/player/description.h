// A shot that was played, as a player describes it.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "carom/engine/record.h"
#include "carom/games/player.h"
#include "carom/games/shot.h"

namespace carom::games::detail {

/// How the ball fell: directly, off a rail, off another ball, or after a cushion of the cue ball.
ShotKind kind_of(const Record& record, const Shot& shot, const Shot::Fallen& fallen);
/// The motion of the cue ball at its first contact: "follow", "stun" or "draw"; "" if it hits no ball.
std::string spin_words(const Record& record, const Shot& shot);
/// The contacts before `until` that bring a ball to its place, in order: rails, except at the mouth of a
/// pocket, and balls. Hit::a is the ball that comes, and Hit::b the one that it drives on or leaves.
std::vector<Hit> chain_of(const Record& record, int ball,
                          double until = std::numeric_limits<double>::infinity());
/// The chain of a potted ball, without its own first contact: "off the left rail at diamond 3.2, the 2".
/// @param ball  its index; -1: the rails of the struck ball before its first hit
std::string chain_words(const Record& record, const Shot& shot, int ball);
/// A place by the nearest pocket or spot, or by both sides of a line between two.
std::string place_words(const Table& table, const Vec2& place);

}  // namespace carom::games::detail
