// Assigns the cost of events to frames.
#include "base/frame_costs.h"

#include <algorithm>
#include <cmath>

#include "carom/render/sequence.h"

namespace carom::tools {

long frame_of(double t, double from, double fps, long frames) {
    if (frames <= 1 || !(t > from)) return 0;
    const long last = frames - 1;
    const double guess = std::floor((t - from) * fps);
    long k = guess >= static_cast<double>(last) ? last : static_cast<long>(guess);
    // The guess is rounded; the frames' own times decide.
    while (k > 0 && render::frame_time(from, k, fps) > t) --k;
    while (k < last && render::frame_time(from, k + 1, fps) <= t) ++k;
    return k;
}

std::vector<FrameCost> costs_by_frame(const Record& record, double from, double fps, long frames) {
    std::vector<FrameCost> sums(static_cast<std::size_t>(std::max(frames, 1L)));
    constexpr double kMsPerNs = 1e-6;
    sums[0].detect_ms = record.setup_detect_ns * kMsPerNs;
    for (std::size_t i = 0; i < record.events.size(); ++i) {
        FrameCost& sum = sums[frame_of(record.events[i].time, from, fps, frames)];
        sum.events.push_back(i);
        if (i >= record.costs.size()) continue;
        const EventCost& cost = record.costs[i];
        const bool cluster = record.events[i].type == EventType::kBallCluster;
        sum.detect_ms += cost.detect_ns * kMsPerNs;
        sum.resolve_ms += (cost.resolve_ns - cost.kernel_ns) * kMsPerNs;
        (cluster ? sum.cluster_ms : sum.kernel_ms) += cost.kernel_ns * kMsPerNs;
    }
    return sums;
}

double percentile(const std::vector<double>& sorted, double p) {
    const double rank = std::ceil(p / 100.0 * static_cast<double>(sorted.size()));
    const auto index =
        static_cast<std::size_t>(std::clamp(rank, 1.0, static_cast<double>(sorted.size()))) - 1;
    return sorted[index];
}

}  // namespace carom::tools
