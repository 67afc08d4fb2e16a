// The words below a drawing of a shot.
#pragma once

#include <string>

#include "base/shown_units.h"
#include "carom/engine/record.h"
#include "carom/engine/scene.h"

namespace carom::tools {

std::string stroke_words(const Cue& cue, Units units);

/// Initial positions of a few balls, from the corner of the table, and their radius; "" for many balls.
std::string places_words(const Record& record, Units units);

/// The balls that fall, or whether a carom shot scores a point, and the duration of the shot.
std::string outcome_words(const Record& record);

}  // namespace carom::tools
