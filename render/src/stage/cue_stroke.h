// The cue before and after the strike.
#pragma once

#include <optional>

#include "carom/render/draw_list.h"

namespace carom::render {

/// The cue at time t [s], where it is drawn: before the strike at 0 it aims and draws back, and after it it
/// follows through and fades. A record does not have the cue, so aim, elevation and the place of the tip are
/// those that give the ball its first velocity and spin.
std::optional<DrawCue> cue_at(const Record& record, const TableMesh& table, double t);

}  // namespace carom::render
