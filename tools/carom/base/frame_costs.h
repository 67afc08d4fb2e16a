// Assigns the cost of events to frames.
#pragma once

#include <cstddef>
#include <vector>

#include "carom/engine/record.h"

namespace carom::tools {

/// The frame k in 0..frames-1 with t_k <= t < t_(k+1), t_k being render::frame_time: an
/// event at a frame's own time belongs to that frame only. An event before the first
/// frame belongs to the first one, an event after the last frame to the last one.
long frame_of(double t, double from, double fps, long frames);

/// The cost of the simulation during one frame [ms].
struct FrameCost {
    double detect_ms = 0.0;           ///< finding its events, and searching again after each
    double resolve_ms = 0.0;          ///< advancing and resolving, without the next two
    double kernel_ms = 0.0;           ///< inside the kernel of ball-ball impacts
    double cluster_ms = 0.0;          ///< inside the map of impacts of three balls and more
    std::vector<std::size_t> events;  ///< indices into Record::events
    double simulate_ms() const { return detect_ms + resolve_ms + kernel_ms + cluster_ms; }
};

/// Sums the costs of a profiled record by frame. The first search of all pairs, before any event, belongs to
/// frame 0. The sums over all frames equal the sums over all events.
std::vector<FrameCost> costs_by_frame(const Record& record, double from, double fps, long frames);

/// Percentile by nearest rank: the smallest value such that at least p percent of all values do not exceed
/// it.
/// @param sorted ascending, not empty @param p 0..100
double percentile(const std::vector<double>& sorted, double p);

}  // namespace carom::tools
