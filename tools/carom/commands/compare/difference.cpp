#include "commands/compare/difference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "base/console.h"

namespace carom::tools {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

/// Where |d0 + s b + s^2 c|^2 may have a maximum in 0 < s < 1: the roots of its derivative, a cubic, found by
/// bisection where the cubic is monotonic.
std::vector<double> turning_points(const Vec3& d0, const Vec3& b, const Vec3& c) {
    const double g0 = d0.dot(b), g1 = b.dot(b) + 2.0 * d0.dot(c), g2 = 3.0 * b.dot(c), g3 = 2.0 * c.dot(c);
    const auto slope = [&](double s) { return g0 + s * (g1 + s * (g2 + s * g3)); };
    std::vector<double> ends = {0.0};
    if (const double inside = g2 * g2 - 3.0 * g1 * g3; inside > 0.0 && g3 > 0.0)
        for (const double s :
             {(-g2 - std::sqrt(inside)) / (3.0 * g3), (-g2 + std::sqrt(inside)) / (3.0 * g3)})
            if (s > 0.0 && s < 1.0) ends.push_back(s);
    ends.push_back(1.0);
    std::vector<double> roots;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        double low = ends[i], high = ends[i + 1];
        // A distance that falls and then rises has no maximum there.
        if (!(slope(low) > 0.0 && slope(high) < 0.0)) continue;
        for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (low + high);
            (slope(middle) > 0.0 ? low : high) = middle;
        }
        roots.push_back(low);
    }
    return roots;
}

BallEnd end_of(const Record& record, int ball, const BallWay& way) {
    const BallState state = record.state_at(ball, record.duration);
    return {state.state, state.pocket < 0 ? "" : record.table.pockets.at(state.pocket).id,
            way.at(way.last())};
}

/// Times from 0 to `until` between which both paths are one parabola each.
std::vector<double> knots(const BallWay& a, const BallWay& b, double until) {
    std::vector<double> times = {0.0, until, a.last(), b.last()};
    for (const BallWay* way : {&a, &b})
        for (const Segment& s : way->segments()) times.push_back(s.start);
    for (double& t : times) t = std::clamp(t, 0.0, until);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

void find_largest(const BallWay& a, const BallWay& b, double until, BallDifference& out) {
    const auto apart = [&](double t) -> Vec3 { return a.at(t) - b.at(t); };
    const auto look = [&](double t) {
        const double length = apart(t).norm();
        if (!(length > out.largest)) return;
        out.largest = length;
        out.largest_at = t;
    };
    const double both_gone = out.a.gone_like(out.b) ? std::max(a.last(), b.last()) : kForever;
    const std::vector<double> times = knots(a, b, std::min(until, both_gone));
    look(0.0);
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        throw_if_interrupted();
        const double from = times[i], length = times[i + 1] - from;
        const Vec3 d0 = apart(from), half = apart(from + 0.5 * length), d1 = apart(times[i + 1]);
        const Vec3 c = 2.0 * (d0 - 2.0 * half + d1);
        for (const double s : turning_points(d0, d1 - d0 - c, c)) look(from + s * length);
        look(times[i + 1]);
    }
}

NamedEvent by_names(const Record& record, const Event& event) {
    const auto id = [&record](int ball) { return record.tracks.at(ball).id; };
    NamedEvent out{event.time, name(event.type), {}};
    if (event.type == EventType::kBallCluster && event.detail >= 0) {
        for (const int ball : record.clusters.at(event.detail).balls) out.who.push_back(id(ball));
    } else {
        out.who.push_back(id(event.a));
        if (std::string partner = record.partner_id(event); !partner.empty())
            out.who.push_back(std::move(partner));
    }
    return out;
}

/// The balls of a shot by name.
using BallsByName = std::unordered_map<std::string_view, int>;

BallsByName balls_by_name(const Record& record) {
    BallsByName places;
    for (std::size_t i = 0; i < record.tracks.size(); ++i)
        places.emplace(record.tracks[i].id, static_cast<int>(i));
    return places;
}

std::vector<std::string> balls_beyond(const Record& record, const BallsByName& other) {
    std::vector<std::string> ids;
    for (const BallTrack& track : record.tracks)
        if (other.count(track.id) == 0) ids.push_back(track.id);
    return ids;
}

std::vector<NamedEvent> events_of_both(const Record& record, const BallsByName& other) {
    std::vector<NamedEvent> events;
    for (const Event& event : record.events)
        if (other.count(record.tracks.at(event.a).id) != 0) events.push_back(by_names(record, event));
    return events;
}

EventDifference event_difference(std::vector<NamedEvent> a, std::vector<NamedEvent> b) {
    EventDifference out;
    const std::size_t both = std::min(a.size(), b.size());
    for (; out.alike < both && a[out.alike].alike(b[out.alike]); ++out.alike) {
        const double apart = std::abs(a[out.alike].time - b[out.alike].time);
        if (apart == 0.0) continue;
        if (!out.first_apart) out.first_apart = out.alike;
        out.farthest_apart = std::max(out.farthest_apart, apart);
    }
    out.a = std::move(a);
    out.b = std::move(b);
    return out;
}

/// [s] Positions are known up to here.
double known_until(const Record& record) {
    return record.stopped == StopReason::kAtRest ? kForever : record.duration;
}

}  // namespace

bool ShotDifference::within(double length) const {
    return same_balls() && std::all_of(balls.begin(), balls.end(),
                                       [length](const BallDifference& ball) { return ball.within(length); });
}

ShotDifference difference(const Record& a, const Record& b) {
    ShotDifference out;
    out.same_bits = a.hash() == b.hash();
    const BallsByName of_a = balls_by_name(a), of_b = balls_by_name(b);
    out.only_a = balls_beyond(a, of_b);
    out.only_b = balls_beyond(b, of_a);
    out.events = event_difference(events_of_both(a, of_b), events_of_both(b, of_a));
    out.until = std::min({known_until(a), known_until(b), std::max(a.duration, b.duration)});
    for (std::size_t i = 0; i < a.tracks.size(); ++i) {
        const std::string& id = a.tracks[i].id;
        const auto same = of_b.find(id);
        if (same == of_b.end()) continue;
        const int in_a = static_cast<int>(i), in_b = same->second;
        const BallWay way_a(a, in_a), way_b(b, in_b);
        BallDifference& ball = out.balls.emplace_back();
        ball.id = id;
        ball.a = end_of(a, in_a, way_a);
        ball.b = end_of(b, in_b, way_b);
        if (!ball.a.gone_like(ball.b)) ball.end = (ball.a.position - ball.b.position).norm();
        find_largest(way_a, way_b, out.until, ball);
    }
    return out;
}

}  // namespace carom::tools
