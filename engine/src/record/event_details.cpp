#include "carom/engine/event_details.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "carom/engine/frozen.h"
#include "carom/engine/geometry.h"
#include "carom/engine/math.h"
#include "carom/engine/vec.h"
#include "contact/touch.h"
#include "physics/motion.h"
#include "record/verify_parts.h"

namespace carom {
namespace {

bool has(const Record& record, const Event& event, int ball) {
    if (event.a == ball || (kind(event.type).partner == Partner::kBall && event.b == ball)) return true;
    if (event.type != EventType::kBallCluster) return false;
    const std::vector<int>& cluster = record.clusters[static_cast<std::size_t>(event.detail)].balls;
    return std::find(cluster.begin(), cluster.end(), ball) != cluster.end();
}

BallState state_of(const Record& record, int ball, const Segment& s, double tau) {
    const double R = record.size(ball).R;
    const Placed placed = placed_at(s, tau, record.gravity, R);
    const Vec3 spin = tau > 0.0 ? spin_at(s, tau, R) : s.w;
    const int pocket = s.state == MotionState::kPocketed ? record.tracks[ball].pocket : -1;
    return {s.state, placed.position, placed.velocity, spin, pocket};
}

/// The ball before and after the event: the segment that ends there, and the one that the event began.
BallAtEvent around(const Record& record, std::size_t index, int ball) {
    const std::vector<Segment>& segments = record.tracks[ball].segments;
    const double time = record.events[index].time;
    const auto earlier = [](const Segment& s, double t) { return s.start < t; };
    const auto later = [](double t, const Segment& s) { return t < s.start; };
    auto first = std::lower_bound(segments.begin(), segments.end(), time, earlier);
    const auto end = std::upper_bound(first, segments.end(), time, later);
    // No event caused a ball's initial motion.
    if (first == segments.begin()) ++first;
    std::size_t begin = index, last = index;
    while (begin > 0 && record.events[begin - 1].time == time) --begin;
    while (last + 1 < record.events.size() && record.events[last + 1].time == time) ++last;
    std::ptrdiff_t rank = 0, all = 0;
    for (std::size_t i = begin; i <= last; ++i) {
        if (!has(record, record.events[i], ball)) continue;
        rank += i < index;
        ++all;
    }
    // During a cluster a ball has its velocities after the cluster.
    const auto state = [&](auto segment) {
        BallState s = state_of(record, ball, *segment, std::max(0.0, time - segment->start));
        if (s.state != MotionState::kColliding) return s;
        const Segment& after = *(segment + 1);
        return BallState{after.state, s.position, after.v, after.w};
    };
    if (end - first == all) return {ball, state(first + rank - 1), state(first + rank)};
    return {ball, state(first - 1), state(std::max(first, end) - 1), rank == 0, rank == all - 1};
}

/// Sets the contact point and normal of ball a.
void place_contact(const Record& record, const Event& event, EventDetails& d) {
    const BallState& a = d.balls.front().after;
    const double R = record.size(event.a).R;
    switch (kind(event.type).partner) {
        case Partner::kBall: {
            const BallState& b = d.balls[1].after;
            const BallAt ball{a.position, a.velocity, R},
                other{b.position, b.velocity, record.size(event.b).R};
            d.normal = (record.balls.discs() ? touch_level(other, ball, true) : touch_ball(other, ball)).n;
            d.point = a.position - R * d.normal;
            return;
        }
        case Partner::kCushion:
        case Partner::kJaw: {
            const CushionPoint at =
                cushion_point(record.table, kind(event.type).partner, event.b, planar(a.position));
            d.point = at.point;
            d.normal = Vec3(at.normal.x(), at.normal.y(), 0.0);
            d.diamond = at.diamond;
            return;
        }
        case Partner::kPocket:
        case Partner::kNone:
            if (event.type != EventType::kBallCloth) return;
            d.normal = Vec3::UnitZ();
            d.point = a.position - R * d.normal;
    }
}

double diamond(const Table& table, const Cushion& cushion, const Vec2& point) {
    if (!(table.width > 0.0 && table.length > 0.0)) return EventDetails::kNone;
    const Vec2 along = cushion.to - cushion.from;
    return std::abs(along.y()) > std::abs(along.x())
               ? (point.y() - table.corner.y()) / table.length * kLongRail
               : (point.x() - table.corner.x()) / table.width * kShortRail;
}

// [degrees] Length of one straight piece of a drawn arc.
constexpr double kDrawnStep = 3.0;

constexpr EventColumn kColumns[] = {
    {"a_x", "m", "centre of ball a"},
    {"a_y", "m", ""},
    {"a_z", "m", ""},
    {"a_vx_before", "m/s", "velocity of ball a just before the event"},
    {"a_vy_before", "m/s", ""},
    {"a_vz_before", "m/s", ""},
    {"a_wx_before", "rad/s", "its angular velocity"},
    {"a_wy_before", "rad/s", ""},
    {"a_wz_before", "rad/s", ""},
    {"a_vx", "m/s", "velocity of ball a just after the event"},
    {"a_vy", "m/s", ""},
    {"a_vz", "m/s", ""},
    {"a_wx", "rad/s", "its angular velocity"},
    {"a_wy", "rad/s", ""},
    {"a_wz", "rad/s", ""},
    {"b_x", "m", "as for ball a, of the other ball if any"},
    {"b_y", "m", ""},
    {"b_z", "m", ""},
    {"b_vx_before", "m/s", ""},
    {"b_vy_before", "m/s", ""},
    {"b_vz_before", "m/s", ""},
    {"b_wx_before", "rad/s", ""},
    {"b_wy_before", "rad/s", ""},
    {"b_wz_before", "rad/s", ""},
    {"b_vx", "m/s", ""},
    {"b_vy", "m/s", ""},
    {"b_vz", "m/s", ""},
    {"b_wx", "rad/s", ""},
    {"b_wy", "rad/s", ""},
    {"b_wz", "rad/s", ""},
    {"point_x", "m", "contact point of ball a"},
    {"point_y", "m", ""},
    {"point_z", "m", ""},
    {"normal_x", "", "unit vector along which ball a is pushed"},
    {"normal_y", "", ""},
    {"normal_z", "", ""},
    {"cut_deg", "deg", "cut angle, between the relative velocity before and the normal; 0 is head-on"},
    {"closing", "m/s", "approach speed along the normal"},
    {"impulse", "N s", "on ball a"},
    {"lost", "J", "energy lost by the balls of this event"},
    {"diamond", "",
     "place on a cushion: 0 to 4 along short rails, 0 to 8 along long ones, from the origin's side"},
};

}  // namespace

std::string met_name(const Record& record, const Event& event) {
    const Partner partner = kind(event.type).partner;
    const auto named = [&](const auto& parts) { return parts[static_cast<std::size_t>(event.b)].name; };
    std::string text;
    if (event.b >= 0 && partner != Partner::kNone && partner != Partner::kBall)
        text = with_parts(record.table, partner, named);
    return text.empty() ? record.partner_id(event) : text;
}

Vec2 nearest_point(const Table& table, Partner partner, int part, const Vec2& place) {
    const auto at = static_cast<std::size_t>(part);
    return partner == Partner::kJaw ? nearest_point(nose_of(table.jaws[at], part, 0.0), place)
                                    : nearest_point(line_of(table.cushions[at], 0.0), place);
}

CushionPoint cushion_point(const Table& table, Partner partner, int part, const Vec2& center) {
    const Vec2 nearest = nearest_point(table, partner, part, center), n = (center - nearest).normalized();
    const auto at = static_cast<std::size_t>(part);
    if (partner == Partner::kCushion)
        return {Vec3(nearest.x(), nearest.y(), table.cushions[at].height), n,
                diamond(table, table.cushions[at], nearest)};
    const Jaw& jaw = table.jaws[at];
    const Vec2 point = jaw.is_arc() ? nearest : Vec2(nearest + jaw.radius * n);
    return {Vec3(point.x(), point.y(), jaw.height), n};
}

Table without_arcs(const Table& table) {
    Table drawn = table;
    std::erase_if(drawn.jaws, [](const Jaw& jaw) { return jaw.is_arc(); });
    for (const Jaw& arc : table.jaws) {
        if (!arc.is_arc()) continue;
        const double turn = *arc.to_deg - *arc.from_deg;
        const int pieces = std::max(2, static_cast<int>(std::ceil(turn / kDrawnStep)));
        // Exact at both ends, so that they join the neighbouring parts.
        const auto at = [&](int i) {
            const SinCos out = sin_cos_deg(i == pieces ? *arc.to_deg : *arc.from_deg + turn * i / pieces);
            return Vec2(arc.center + arc.radius * Vec2(out.cos, out.sin));
        };
        for (int i = 0; i < pieces; ++i) drawn.cushions.push_back({arc.id, at(i), at(i + 1), arc.height});
    }
    return drawn;
}

std::optional<Vec2> diamond_place(const Table& t, std::string_view rail, double number) {
    if (!(t.width > 0.0 && t.length > 0.0)) return std::nullopt;
    const double across = number / kShortRail * t.width, along = number / kLongRail * t.length;
    if (rail == "head") return t.corner + Vec2(across, 0.0);
    if (rail == "foot") return t.corner + Vec2(across, t.length);
    if (rail == "left") return t.corner + Vec2(0.0, along);
    if (rail == "right") return t.corner + Vec2(t.width, along);
    return std::nullopt;
}

EventDetails details_of(const Record& record, std::size_t event) {
    const Event& e = record.events[event];
    const EventKind& of = kind(e.type);
    EventDetails d;
    d.balls.push_back(around(record, event, e.a));
    if (of.partner == Partner::kBall) d.balls.push_back(around(record, event, e.b));
    if (e.type == EventType::kBallCluster)
        for (const int ball : record.clusters[static_cast<std::size_t>(e.detail)].balls)
            if (ball != e.a && ball != e.b) d.balls.push_back(around(record, event, ball));

    const BallAtEvent& a = d.balls.front();
    place_contact(record, e, d);
    const bool impact = of.phase == EventPhase::kImpact && of.partner != Partner::kPocket;
    if (!impact && of.phase != EventPhase::kStrike) return d;
    const auto known = [&](auto member, std::size_t count) {
        return std::all_of(d.balls.begin(), d.balls.begin() + static_cast<std::ptrdiff_t>(count),
                           [member](const BallAtEvent& ball) { return ball.*member; });
    };
    const bool whole =
        known(&BallAtEvent::before_known, d.balls.size()) && known(&BallAtEvent::after_known, d.balls.size());
    if (whole) d.impulse = record.size(e.a).m * (a.after.velocity - a.before.velocity).norm();
    if (!impact) return d;
    const bool pair = of.partner == Partner::kBall;
    if (known(&BallAtEvent::before_known, pair ? 2 : 1)) {
        const Vec3 v = a.before.velocity - (pair ? d.balls[1].before.velocity : Vec3::Zero());
        d.closing = -v.dot(d.normal);
        d.cut = std::atan2(v.cross(d.normal).norm(), d.closing);
    }
    if (!whole) return d;
    d.lost = 0.0;
    // ball_energy() is divided by the mass in [balls].
    for (const BallAtEvent& ball : d.balls)
        d.lost += record.balls.m *
                  (ball_energy(record, ball.ball, ball.before) - ball_energy(record, ball.ball, ball.after));
    return d;
}

std::span<const EventColumn> event_columns() {
    return kColumns;
}

void event_row(const Record& record, std::size_t event, std::span<double> row) {
    const EventDetails d = details_of(record, event);
    auto at = row.begin();
    const auto put = [&at](const Vec3& v) {
        for (const double value : v) *at++ = value;
    };
    for (std::size_t i = 0; i < 2; ++i) {
        const bool there = i < d.balls.size();
        const BallState none{MotionState::kStationary, Vec3::Constant(EventDetails::kNone),
                             Vec3::Constant(EventDetails::kNone), Vec3::Constant(EventDetails::kNone)};
        const BallState &before = there ? d.balls[i].before : none, &after = there ? d.balls[i].after : none;
        put(after.position);
        put(before.velocity);
        put(before.spin);
        put(after.velocity);
        put(after.spin);
    }
    put(d.point);
    put(d.normal);
    for (const double value : {d.cut * kDegrees, d.closing, d.impulse, d.lost, d.diamond}) *at++ = value;
}

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
