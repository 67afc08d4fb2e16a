#include "carom/engine/frozen.h"

#include <algorithm>
#include <limits>

#include "carom/engine/event_details.h"
#include "carom/engine/vec.h"

namespace carom {
namespace {

// [ball radii] A ball that has moved away from a cushion by less than this has not left it: rounding of
// positions, far below anything visible.
constexpr double kStillFrozen = 1e-9;

/// How long segment `i` is in force [s after its start], at most until `time`.
double lasts(std::span<const Segment> segments, std::size_t i, double time) {
    const double next =
        i + 1 < segments.size() ? segments[i + 1].start : std::numeric_limits<double>::infinity();
    return std::min({std::min(next, time) - segments[i].start, segments[i].duration});
}

}  // namespace

double farthest(std::span<const Segment> segments, const Vec2& along, double time) {
    double most = dot(along, planar(segments.front().r));
    for (std::size_t i = 0; i < segments.size() && segments[i].start <= time; ++i) {
        const Segment& s = segments[i];
        const double whole = lasts(segments, i, time);
        const double v = dot(along, planar(s.v)), a = dot(along, s.a);
        // The ends, and the turning point.
        for (const double tau : {0.0, whole, a < 0.0 ? std::clamp(-v / a, 0.0, whole) : whole})
            most = std::max(most, dot(along, planar(position_at(s, tau))));
    }
    return most;
}

bool still_frozen(const Table& table, const Hit& hit, std::span<const Segment> segments, double R) {
    const Vec2 start = planar(segments.front().r);
    const Vec2 away = start - nearest_point(table, hit.partner, hit.b, start);
    if (away.isZero(0.0)) return false;
    const Vec2 along = away / length(away);
    const double from = dot(along, start), slack = kStillFrozen * R;
    std::size_t last = 0;
    while (last + 1 < segments.size() && segments[last + 1].start <= hit.time) ++last;
    const Vec2 here = planar(position_at(segments[last], lasts(segments, last, hit.time)));
    return dot(along, here) >= from - slack && farthest(segments, along, hit.time) <= from + slack;
}

}  // namespace carom
