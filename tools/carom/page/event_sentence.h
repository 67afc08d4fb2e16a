// An event of a shot in words, for the program's story and for pages.
#pragma once

#include <cstddef>
#include <string>

#include "base/shown_units.h"
#include "carom/engine/record.h"

namespace carom::tools {

/// "cue meets 1, cut 31 deg, 2.1 m/s"
std::string event_sentence(const Record& record, std::size_t index, Units units);

}  // namespace carom::tools
