// The errors of a player's hand, and the unknown properties of a table, from options.
#pragma once

#include <string>

#include "carom/games/solve.h"

namespace carom::tools {

/// The default of --hand.
inline constexpr const char* kHand = "aim=0.2,speed=3%,tip=0.02";

/// "aim=0.2,speed=3%,tip=0.02". @param unknown  if not null, the keys of --unknown are read into it, too
/// @throws UsageError
games::Hand read_hand(const std::string& text, games::Unknown* unknown = nullptr);

/// The default of --unknown.
inline constexpr const char* kUnknown = "cloth=5%,rails=2%,places=0.1,gaps=20";

/// "cloth=5%,rails=2%,places=0.1,gaps=20" or "none"; places in millimetres, gaps in micrometres.
/// @throws UsageError
games::Unknown read_unknown(const std::string& text);

/// "aim 0.2 deg, speed 3 %, tip 0.02 R"
std::string hand_words(const games::Hand& hand);

}  // namespace carom::tools
