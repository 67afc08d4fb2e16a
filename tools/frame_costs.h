// Which frame pays for which event.
#pragma once

#include <cstddef>
#include <vector>

#include "carom/engine/record.h"

namespace carom::tools {

/// The frame k in 0..frames-1 with t_k <= t < t_(k+1), t_k being render::frame_time: an event at a frame's
/// own time belongs to that frame and to no other. What is before the first frame or after the last belongs
/// to the first or last.
long frame_of(double t, double from, double fps, long frames);

/// What the simulation cost during one frame.
struct FrameCost {
    double simulate_ms = 0.0;         ///< detect and resolve of its events
    double kernel_ms = 0.0;           ///< the part of simulate_ms inside impact kernels
    std::vector<std::size_t> events;  ///< indices into Record::events
};

/// Sums the costs of a profiled record by frame. The first detection of all pairs, made before any event,
/// counts for frame 0. Nothing is lost: the sums over all frames are the sums over all events.
std::vector<FrameCost> costs_by_frame(const Record& record, double from, double fps, long frames);

/// Percentile by nearest rank: the smallest value such that at least p percent of all values are not above
/// it.
/// @param sorted  ascending, not empty   @param p  0..100
double percentile(const std::vector<double>& sorted, double p);

/// Middle value; the mean of the two middle ones for an even count. @param values not empty
double median(std::vector<double> values);

}  // namespace carom::tools
