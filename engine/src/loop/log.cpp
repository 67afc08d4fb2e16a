#include "loop/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/record_hash.h"
#include "carom/engine/airborne.h"
#include "carom/engine/frozen.h"
#include "physics/motion.h"

namespace carom {

namespace {

// [-] Initial capacity for segments and events: enough for a break. Doubles when full.
constexpr std::size_t kRoom = 256;
// [sqrt(2 R/g)] A flying ball that has stayed in place for this long is balanced: 5 s for a pool ball. A ball
// off balance only by rounding would slide off in half this time.
constexpr double kLongestBalance = 65.0;

}  // namespace

Log::Log(const Plan& plan, const SimulateOptions& options, Balls& balls, LogMemory& memory, Keep keep)
    : Borrowed(memory),
      plan_(plan),
      options_(options),
      balls_(balls),
      geometry_(plan.geometry),
      keep_(keep),
      struck_(struck_ball(plan.scene)) {
    if (options.profile && keep == Keep::kRecord) costs_.emplace();
    events_.clear();
    segments_.clear();
    cluster_ball_.clear();
    hits_.clear();
    cluster_end_.clear();
    touched_.clear();
    stays_.assign(plan.in_force(Effect::kAirborne) ? plan.sizes.size() : 0, {0.0, Vec3::Zero()});
    reserve();
}

void Log::reserve() {
    touched_.reserve(plan_.scene.ball.size() + 1);
    if (keep_ != Keep::kOutcome) segments_.reserve(static_cast<std::size_t>(balls_.count()) + kRoom);
    if (plan_.clusters != ClusterModel::kSequential) {
        cluster_ball_.reserve(kRoom);
        hits_.reserve(kRoom);
        cluster_end_.reserve(kRoom);
    }
    events_.reserve(kRoom);
}

void Log::cluster(int a, int b, const std::vector<ClusterBall>& balls, const std::vector<Hit>& hits) {
    event(EventType::kBallCluster, a, b, static_cast<int>(cluster_end_.size()));
    cluster_ball_.insert(cluster_ball_.end(), balls.begin(), balls.end());
    hits_.insert(hits_.end(), hits.begin(), hits.end());
    cluster_end_.push_back({cluster_ball_.size(), hits_.size()});
}

void Log::watch(int ball) {
    if (stays_.empty()) return;
    const Segment& s = balls_.segment(ball);
    Stay& stay = stays_[ball];
    // To leave, it would have to rise higher than the lowest bounce.
    const double gravity = balls_.motion(ball).gravity, end = bounce_end(balls_.radius(ball), gravity);
    const bool stays =
        flies(s.state) && length3(s.v) < end && 2.0 * gravity * length3(s.r - stay.place) < end * end;
    if (!stays) {
        stay = {balls_.now(), s.r};
        return;
    }
    const double longest = kLongestBalance * std::sqrt(2.0 * balls_.radius(ball) / gravity);
    if (!(balls_.now() - stay.since > longest)) return;
    const auto met = std::find_if(events_.rbegin(), events_.rend(), [ball](const Event& e) {
        return e.type != EventType::kBallCloth &&
               (e.a == ball || (kind(e.type).partner == Partner::kBall && e.b == ball));
    });
    constexpr const char* kMove = "; move one of them by a thousandth of a millimetre";
    if (met != events_.rend() && kind(met->type).partner == Partner::kBall)
        fail(fmt::format("balls {} and {} balance on each other{}", id(met->a), id(met->b), kMove));
    fail(fmt::format("ball {} balances on a cushion or a jaw; move it by a thousandth of a millimetre",
                     id(ball)));
}

void Log::fall(int ball, int pocket) {
    begin(ball, pocketed_segment(balls_.now(), geometry_.pockets[pocket]));
    event(EventType::kBallPocket, ball, pocket);
}

void Log::end_set_up(double set_up_ns) {
    if (!costs_) return;
    event_costs_.resize(events_.size());
    if (!event_costs_.empty() && events_.front().type == EventType::kCueStrike)
        event_costs_.front().method = "point";
    setup_detect_ns_ = set_up_ns;
    *costs_ = {};
}

// If an iteration causes several events, the first one gets the cost; if it causes none, the next event does.
void Log::book_costs() {
    event_costs_.resize(events_.size());
    EventCost& cost = costs_->event;
    if (events_.size() > events_before_) {
        cost.queue_ns = cost.detect_ns - costs_->search_ns;
        event_costs_[events_before_] = cost;
        *costs_ = {};
    } else {
        cost.steps = 0;  // of an impact without an event
        cost.method = {};
    }
}

void Log::report_progress() {
    if (++rounds_unreported_ < options_.progress_rounds && !long_round_) return;
    rounds_unreported_ = 0;
    long_round_ = false;
    options_.progress(events_.size(), balls_.now());
}

void Log::fail_crowded() {
    if (is_crowded())
        fail(fmt::format("more than {} events within {:g} s of simulated time", kEventCap, kEventCapSpan));
    fail(fmt::format("{} rounds without an event", kQuietCap));
}

void Log::fail(const std::string& why) {
    std::string text = fmt::format("simulation stopped at t = {:.17g} s after {} events: {}\n", balls_.now(),
                                   events_.size(), why);
    const std::size_t count = events_.size();
    Record frame;
    begin_record(frame);
    text += "last events:\n";
    for (std::size_t i = count > 8 ? count - 8 : 0; i < count; ++i) {
        const Event& e = events_[i];
        text += fmt::format("  {:.17g} {} {} {}\n", e.time, name(e.type), id(e.a), frame.partner_id(e));
    }
    text += "balls that move (id state x y vx vy wx wy wz):\n";
    for (int i = 0; i < balls_.count(); ++i) {
        const Segment& s = balls_.segment(i);
        if (s.state == MotionState::kStationary || is_gone(s.state)) continue;
        const double tau = std::max(0.0, balls_.now() - s.start);
        const Vec3 r = position_at(s, tau), v = velocity_at(s, tau), w = spin_at(s, tau, balls_.radius(i));
        text += fmt::format("  {} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", id(i),
                            name(s.state), r.x(), r.y(), v.x(), v.y(), w.x(), w.y(), w.z());
    }
    text.pop_back();  // messages do not end with a line break
    if (keep_ != Keep::kRecord) throw SimulationError(text);
    if (costs_) event_costs_.resize(events_.size());
    throw SimulationError(text, std::make_shared<const Record>(record(StopReason::kEvents)));
}

// An empty record for this run, in the record's existing memory.
void Log::begin_record(Record& record) const {
    const Scene& scene = plan_.scene;
    record.clear();
    record.table = scene.table;
    record.balls = plan_.balls;
    record.gravity = plan_.gravity;
    record.render = scene.render;
    record.start_time = options_.start_time;
    record.tracks.resize(scene.ball.size());
    for (std::size_t i = 0; i < scene.ball.size(); ++i) {
        record.tracks[i].id = scene.ball[i].id;
        record.tracks[i].own = scene.ball[i].own;
    }
}

Record Log::record(StopReason why) {
    Record result;
    record(why, result);
    return result;
}

void Log::record(StopReason why, Record& record) {
    begin_record(record);
    std::vector<std::size_t> count(record.tracks.size());
    for (const BallSegment& s : segments_) ++count[s.ball];
    for (int i = 0; i < balls_.count(); ++i) count[i] += balls_.collides(i);
    for (std::size_t i = 0; i < count.size(); ++i) record.tracks[i].segments.reserve(count[i]);
    for (const BallSegment& s : segments_) record.tracks[s.ball].segments.push_back(s.segment);
    for (int i = 0; i < balls_.count(); ++i)
        if (balls_.collides(i)) record.tracks[i].segments.push_back(balls_.afterwards(i));
    auto member = cluster_ball_.begin();
    auto hit = hits_.begin();
    for (const End& end : cluster_end_) {
        Cluster& cluster = record.clusters.emplace_back();
        for (const auto to = cluster_ball_.begin() + static_cast<std::ptrdiff_t>(end.ball); member != to;
             ++member)
            cluster.balls.push_back(member->ball);
        const auto to = hits_.begin() + static_cast<std::ptrdiff_t>(end.hit);
        cluster.hits.assign(hit, to);
        hit = to;
    }
    for (const Event& e : events_)
        if (e.type == EventType::kBallPocket) record.tracks[e.a].pocket = e.b;
    record.events.swap(events_);  // both keep memory for the next run
    record.costs = std::move(event_costs_);
    record.setup_detect_ns = setup_detect_ns_;
    record.duration = balls_.now();
    record.stopped = why;
}

int struck_ball(const Scene& scene) {
    for (std::size_t i = 0; i < scene.ball.size(); ++i) {
        const BallStart& ball = scene.ball[i];
        const bool moves =
            scene.cue ? ball.id == scene.cue->ball : !ball.velocity.isZero(0.0) || !ball.spin.isZero(0.0);
        if (moves) return static_cast<int>(i);
    }
    return -1;
}

/// Whether the struck ball was driven to the cushion or jaw that it hits.
bool Log::is_driven(const Hit& hit) {
    if (of_struck_.empty())
        for (const BallSegment& s : segments_)
            if (s.ball == struck_) of_struck_.push_back(s.segment);
    return !still_frozen(plan_.scene.table, hit, of_struck_, balls_.radius(struck_));
}

std::span<const Hit> Log::hits(const Event& event) const {
    if (event.type != EventType::kBallCluster) return {};
    const auto index = static_cast<std::size_t>(event.detail);
    const std::size_t begin = index == 0 ? 0 : cluster_end_[index - 1].hit;
    return std::span(hits_).subspan(begin, cluster_end_[index].hit - begin);
}

std::uint64_t Log::hash() const {
    RecordHash hash;
    for (int ball = 0; ball < balls_.count(); ++ball) {
        const auto segments = std::count_if(segments_.begin(), segments_.end(),
                                            [ball](const BallSegment& s) { return s.ball == ball; });
        hash.ball(static_cast<std::size_t>(segments) + balls_.collides(ball));
        for (const BallSegment& s : segments_)
            if (s.ball == ball) hash.segment(s.segment);
        if (balls_.collides(ball)) hash.segment(balls_.afterwards(ball));
    }
    for (const Event& e : events_) hash.event(e);
    hash.duration(balls_.now());
    return hash.value();
}

void Log::outcome(StopReason why, Outcome& out) {
    of_struck_.clear();
    out.stopped = why;
    out.duration = balls_.now();
    out.events = static_cast<std::int64_t>(events_.size());
    out.clusters = static_cast<int>(cluster_end_.size());
    out.struck = struck_;
    out.first_hit = -1;
    out.contacts = out.approach_cushions = 0;
    out.hash = keep_ != Keep::kOutcome && options_.hash ? hash() : 0;
    out.balls.assign(static_cast<std::size_t>(balls_.count()), {});
    for (int i = 0; i < balls_.count(); ++i) {
        const Segment& s = balls_.segment(i);
        out.balls[i].position =
            placed_at(s, std::min(balls_.now() - s.start, s.duration), plan_.gravity, balls_.radius(i))
                .position;
    }
    int fallen = 0;
    for (const Event& e : events_) {
        each_hit(e, hits(e), [&](const Hit& hit) {
            if (hit.partner == Partner::kCushion || hit.partner == Partner::kJaw) {
                ++out.balls[hit.a].cushions;
                if (hit.a == struck_ && out.contacts < 2 && is_driven(hit)) ++out.approach_cushions;
            }
            if (hit.partner != Partner::kBall || struck_ < 0 || (hit.a != struck_ && hit.b != struck_))
                return;
            const int met = hit.a == struck_ ? hit.b : hit.a;
            if (out.balls[met].met) return;
            out.balls[met].met = true;
            if (out.contacts++ == 0) out.first_hit = met;
        });
        BallOutcome& ball = out.balls[e.a];
        if (e.type == EventType::kBallOut) ball.pocket = kOffTable;
        if (e.type != EventType::kBallPocket) continue;
        ball.pocket = e.b;
        ball.fell = fallen++;
    }
}

}  // namespace carom
