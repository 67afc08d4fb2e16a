// The errors of a player's hand, from options.
#pragma once

#include <string>

#include "carom/games/solve.h"

namespace carom::tools {

/// The default of --hand.
inline constexpr const char* kHand = "aim=0.2,speed=3%,tip=0.02";

/// "aim=0.2,speed=3%,tip=0.02". @throws UsageError
games::Hand read_hand(const std::string& text);

/// "aim 0.2 deg, speed 3 %, tip 0.02 R"
std::string hand_words(const games::Hand& hand);

}  // namespace carom::tools
