// The cue before and after the strike.
#pragma once

#include <optional>

#include "carom/render/draw_list.h"

namespace carom::render {

/// The cue at time t [s], if it is drawn: before the strike at 0 it aims and draws back, then it follows
/// through and fades. A record does not contain the cue, so its aim, elevation and tip are derived from the
/// ball's first velocity and spin.
std::optional<DrawCue> cue_at(const Record& record, const TableMesh& table, double t);

}  // namespace carom::render
