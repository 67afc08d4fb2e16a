// The story of a shot in sentences.
#pragma once

#include <string>

#include "base/shown_units.h"
#include "carom/engine/record.h"

namespace carom::tools {

/// One line per event. A long shot is summarised by its landmarks: the strike, the first contacts of the
/// struck ball, and balls that fall or leave the table. A line counts the contacts between two landmarks.
std::string story(const Record& record, Units units);

/// One line per event, however many there are.
std::string all_events(const Record& record, Units units);

}  // namespace carom::tools
