// Which frame pays for which event.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "carom/engine/record.h"

namespace carom::tools {

/// The frame k in 0..frames-1 with t_k <= t < t_(k+1), t_k being render::frame_time: an event at a frame's
/// own time belongs to that frame and to no other. What is before the first frame or after the last belongs
/// to the first or last.
long frame_of(double t, double from, double fps, long frames);

/// What the simulation cost during one frame [ms].
struct FrameCost {
    double detect_ms = 0.0;           ///< finding its events, and looking for new ones after each
    double resolve_ms = 0.0;          ///< advancing and resolving, without the two below
    double kernel_ms = 0.0;           ///< inside the kernel of ball-ball impacts
    double cluster_ms = 0.0;          ///< inside the map of impacts of three balls and more
    std::vector<std::size_t> events;  ///< indices into Record::events
    double simulate_ms() const { return detect_ms + resolve_ms + kernel_ms + cluster_ms; }
};

/// Sums the costs of a profiled record by frame. The first detection of all pairs, made before any event,
/// counts for frame 0. Nothing is lost: the sums over all frames are the sums over all events.
std::vector<FrameCost> costs_by_frame(const Record& record, double from, double fps, long frames);

/// Percentile by nearest rank: the smallest value such that at least p percent of all values are not above it.
/// @param sorted  ascending, not empty   @param p  0..100
double percentile(const std::vector<double>& sorted, double p);

/// Wall time of frames that are made one after the other, from the moments at which each was done. What the
/// caller does in between (a progress bar, removing files) does not count. The clock is the caller's, so that
/// the bookkeeping can be tested without one.
class FrameWalls {
  public:
    explicit FrameWalls(std::function<double()> now_ms) : now_ms_(std::move(now_ms)) {}
    void frame_done() {
        const double now = now_ms_();
        if (started_) walls_.push_back(now - mark_);
    }
    void next_starts() {
        mark_ = now_ms_();
        started_ = true;
    }
    /// One for every frame but the first, whose start nobody saw.
    const std::vector<double>& walls() const { return walls_; }

  private:
    std::function<double()> now_ms_;
    bool started_ = false;
    double mark_ = 0.0;
    std::vector<double> walls_;
};

}  // namespace carom::tools
