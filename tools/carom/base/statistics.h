// Shares of shots and how sure they are.
#pragma once

#include <string>

#include "carom/games/solve.h"

namespace carom::tools {

using games::Share;
using games::share_of;
std::string share_text(const Share& share);

}  // namespace carom::tools
