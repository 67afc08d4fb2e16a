#include "measure_rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carom/engine/event_details.h"
#include "carom/games/spots.h"

namespace carom::games::detail {
namespace {

Texts listed(const PlayedShot& played, EventType type, bool partner) {
    Texts texts;
    for (const Event& event : played.record.events)
        if (event.type == type)
            texts.push_back(partner ? played.record.partner_id(event) : played.id(event.a));
    return texts;
}

double count(const PlayedShot& played, EventType type, bool struck) {
    const int ball = played.struck();
    return static_cast<double>(
        std::count_if(played.record.events.begin(), played.record.events.end(), [&](const Event& event) {
            return event.type == type && (struck ? event.a == ball : event.a != ball);
        }));
}

/// Where a ball is driven to its `number`-th cushion, from 1.
std::optional<CushionPoint> cushion(const PlayedShot& played, double number) {
    const std::vector<Hit> hits = driven(played, played.struck());
    const auto index = static_cast<std::size_t>(number) - 1;
    if (index >= hits.size()) return std::nullopt;
    const Hit& hit = hits[index];
    const Vec3 at = played.record.state_at(hit.a, hit.time).position;
    return cushion_point(played.record.table, hit.partner, hit.b, planar(at));
}

/// Sums or compares over the pieces of a ball's motion: f(segment, seconds for which it applies).
template <class F>
void pieces(const Record& record, int ball, F&& f) {
    const std::vector<Segment>& segments = record.tracks[static_cast<std::size_t>(ball)].segments;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const double end = i + 1 < segments.size() ? segments[i + 1].start : record.duration;
        const double lasts = std::min(end - segments[i].start, segments[i].duration);
        if (lasts > 0.0 && !is_gone(segments[i].state)) f(segments[i], lasts);
    }
}

/// Length of the parabola of a segment in the plane [m], by its closed form.
double length_of(const Segment& s, double time) {
    const double v2 = s.v.x() * s.v.x() + s.v.y() * s.v.y(), a2 = s.a.squaredNorm();
    const double va = s.v.x() * s.a.x() + s.v.y() * s.a.y();
    if (a2 == 0.0) return std::sqrt(v2) * time;
    // With tau from the vertex, the speed is sqrt(h^2 + a^2 tau^2).
    const double a = std::sqrt(a2), shift = va / a2, h2 = std::max(0.0, v2 - va * va / a2);
    const auto whole = [&](double tau) {
        const double speed = std::sqrt(h2 + a2 * tau * tau);
        return 0.5 * (tau * speed + (h2 > 0.0 ? h2 / a * std::asinh(a * tau / std::sqrt(h2)) : 0.0));
    };
    return whole(time + shift) - whole(shift);
}

BallState last(const PlayedShot& played, int ball) {
    return played.record.state_at(ball, played.record.duration);
}

double distance(const PlayedShot& played, const Arguments& of) {
    const BallState s = last(played, of.ball);
    if (is_gone(s.state)) return kNone;
    return std::hypot(s.position.x() - of.numbers[0], s.position.y() - of.numbers[1]);
}

Texts fouls(const PlayedShot& played, const Arguments& of, bool opening) {
    Texts texts;
    for (const CalledFoul& called : judged(played, *of.game, opening).fouls)
        texts.emplace_back(name(called.foul));
    return texts;
}

using P = const PlayedShot&;
using A = const Arguments&;
using V = MeasureValue;

// Names of arguments: BALL, X, Y, R, K (a number from 1), GAME.
const MeasureRow kRows[] = {
    {{"pocketed", "", "list", "balls that fell, in order"},
     [](P p, A) -> V { return listed(p, EventType::kBallPocket, false); }},
    {{"pockets", "", "list", "pockets they fell into, in the same order"},
     [](P p, A) -> V { return listed(p, EventType::kBallPocket, true); }},
    {{"balls_pocketed", "", "", "number of balls that fell, except the struck ball"},
     [](P p, A) -> V { return count(p, EventType::kBallPocket, false); }},
    {{"any_pocketed", "", "truth", "whether a ball other than the struck one fell"},
     [](P p, A) -> V { return double(count(p, EventType::kBallPocket, false) > 0.0); }},
    {{"pocket_of", "BALL", "text", "pocket that holds the ball; out if it left the table, else empty"},
     [](P p, A of) -> V {
         for (const Event& event : p.record.events) {
             if (event.a == of.ball && event.type == EventType::kBallPocket)
                 return Texts{p.record.partner_id(event)};
             if (event.a == of.ball && event.type == EventType::kBallOut) return Texts{"out"};
         }
         return Texts{};
     }},
    {{"off_table", "", "list", "balls that left the table"},
     [](P p, A) -> V { return listed(p, EventType::kBallOut, false); }},
    {{"scratch", "", "truth", "whether the struck ball fell or left the table"},
     [](P p, A) -> V {
         return double(count(p, EventType::kBallPocket, true) + count(p, EventType::kBallOut, true) > 0.0);
     }},
    {{"first_hit", "", "list", "ball that the struck ball hits first; several if it hits them at once"},
     [](P p, A) -> V {
         Texts texts;
         for (const int ball : p.shot().first_hits) texts.push_back(p.id(ball));
         return texts;
     }},
    {{"cushions", "", "list", "cushions and jaws that the struck ball is driven to, in order"},
     [](P p, A) -> V {
         Texts texts;
         for (const Hit& hit : driven(p, p.struck()))
             texts.push_back(p.record.partner_id(hit.partner, hit.b));
         return texts;
     }},
    {{"cushion_x", "K", "m", "x of the struck ball's K-th contact with a cushion"},
     [](P p, A of) -> V {
         const auto at = cushion(p, of.numbers[0]);
         return at ? at->point.x() : kNone;
     }},
    {{"cushion_y", "K", "m", "y of that contact"},
     [](P p, A of) -> V {
         const auto at = cushion(p, of.numbers[0]);
         return at ? at->point.y() : kNone;
     }},
    {{"cushion_diamond", "K", "", "its place in diamonds: 0 to 4 on short rails, 0 to 8 on long ones"},
     [](P p, A of) -> V {
         const auto at = cushion(p, of.numbers[0]);
         return at ? at->diamond : kNone;
     }},
    {{"driven", "", "",
      "number of balls driven to a rail, pocketed or off the table, except the struck ball"},
     [](P p, A) -> V {
         const std::vector<int> balls = p.shot().driven_after(p.shot().first_time);
         return double(balls.size()) - double(std::count(balls.begin(), balls.end(), p.struck()));
     }},
    {{"past_head_string", "", "",
      "number of balls that fell or crossed the head string, except the struck ball"},
     [](P p, A) -> V {
         const Record& record = p.record;
         const double back = -head_string(record.table);
         double balls = 0.0;
         for (int i = 0; i < static_cast<int>(record.tracks.size()); ++i)
             if (i != p.struck() && (record.tracks[static_cast<std::size_t>(i)].pocket >= 0 ||
                                     farthest(record, i, Vec2(0.0, -1.0), record.duration) > back))
                 ++balls;
         return balls;
     }},
    {{"legal_break", "GAME", "truth", "whether the shot is a fair break of the game"},
     [](P p, A of) -> V { return double(fouls(p, of, true).empty()); }},
    {{"break_foul", "GAME", "list", "fouls of the shot as a break of the game"},
     [](P p, A of) -> V { return fouls(p, of, true); }},
    {{"foul", "GAME", "list", "fouls of the shot in the middle of a game; in eight-ball with an open table"},
     [](P p, A of) -> V { return fouls(p, of, false); }},
    {{"x", "BALL", "m", "final x"}, [](P p, A of) -> V { return last(p, of.ball).position.x(); }},
    {{"y", "BALL", "m", "final y"}, [](P p, A of) -> V { return last(p, of.ball).position.y(); }},
    {{"distance", "BALL, X, Y", "m", "from the ball's final position to (X, Y); empty if it is gone"},
     [](P p, A of) -> V { return distance(p, of); }},
    {{"travel", "BALL", "m", "length of the ball's path on the table"},
     [](P p, A of) -> V {
         double sum = 0.0;
         pieces(p.record, of.ball, [&sum](const Segment& s, double time) { sum += length_of(s, time); });
         return sum;
     }},
    {{"max_speed", "BALL", "m/s", "largest speed of the ball"},
     [](P p, A of) -> V {
         double most = 0.0;
         // Speed is convex in each piece, so that it is largest at an end.
         pieces(p.record, of.ball, [&](const Segment& s, double time) {
             for (const double tau : {0.0, time}) {
                 const double up = flies(s.state) ? s.v.z() - p.record.gravity * tau : 0.0;
                 most = std::max(most, std::hypot(velocity_at(s, tau).x(), velocity_at(s, tau).y(), up));
             }
         });
         return most;
     }},
    {{"rest_time", "BALL", "s", "time when the ball comes to rest or falls"},
     [](P p, A of) -> V {
         double end = 0.0;
         pieces(p.record, of.ball, [&end](const Segment& s, double time) {
             if (s.state != MotionState::kStationary) end = s.start + time;
         });
         return end;
     }},
    {{"air_time", "BALL", "s", "time that the ball spends in the air"},
     [](P p, A of) -> V {
         double sum = 0.0;
         pieces(p.record, of.ball, [&sum](const Segment& s, double time) {
             if (s.state == MotionState::kAirborne) sum += time;
         });
         return sum;
     }},
    {{"duration", "", "s", "duration of the shot"}, [](P p, A) -> V { return p.record.duration; }},
};

}  // namespace

std::span<const MeasureRow> measure_rows() {
    static const std::vector<MeasureRow> kAll = [] {
        std::vector<MeasureRow> all(std::begin(kRows), std::end(kRows));
        all.insert(all.end(), route_rows().begin(), route_rows().end());
        return all;
    }();
    return kAll;
}

}  // namespace carom::games::detail
