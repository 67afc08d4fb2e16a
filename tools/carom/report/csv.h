// Writes events and samples of a record as CSV. Numbers read back to the same bits. Names need no quotes,
// because the scene reader rejects ball ids with a comma, a quote or a control character.
#pragma once

#include <string>

#include "carom/engine/record.h"

namespace carom::tools {

/// `time,type,a,b`, followed by `detect_ns,resolve_ns,kernel_ns,steps,method` for a profiled record.
void write_events_csv(const Record& record, const std::string& path);

/// `time,ball,state,x,y,z,vx,vy,vz,wx,wy,wz`: every ball at k dt, k = 0, 1, ..., up to the duration.
/// @throws UsageError if there are too many rows
void write_samples_csv(const Record& record, double dt, const std::string& path);

}  // namespace carom::tools
