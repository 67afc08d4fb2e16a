// The event loop: next event -> advance its balls -> resolve -> record -> re-detect for those balls only.
#include "carom/engine/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "carom/engine/cushion.h"
#include "carom/engine/tolerances.h"
#include "cue.h"
#include "detect.h"
#include "motion.h"
#include "roots.h"

namespace carom {

namespace {

using Clock = std::chrono::steady_clock;

// Something that will happen unless an earlier event changes it.
struct Candidate {
    double time = kNever;
    EventType type = EventType::kCueStrike;
    int a = -1, b = -1;
    int nose = -1;  // kBallCushion, kBallJaw: index into Plan::noses, or -1 for the straight part
};

// Written order of events at one and the same time: pocket, own transition, ball-ball, cushion.
int rank(EventType type) {
    switch (type) {
        case EventType::kBallPocket: return 0;
        case EventType::kBallBall:
        case EventType::kBallCluster: return 2;
        case EventType::kBallCushion:
        case EventType::kBallJaw: return 3;
        default: return 1;
    }
}

template <bool kProfile>
class Shot {
  public:
    Shot(const Plan& plan, const SimulateOptions& options)
        : plan_(plan), options_(options), motion_(motion_params(plan.balls, plan.gravity)) {}

    Record run();

  private:
    void set_up();
    Candidate next() const;
    bool before(const Candidate& x, const Candidate& y) const;
    double closing(const Candidate& c) const;
    Vec2 place(const Candidate& c) const;

    void apply(const Candidate& c);
    bool resolve_ball_ball(const Candidate& c);
    void resolve_nose(const Candidate& c);
    void begin(int ball, const Segment& segment);
    void redetect(int a, int b);
    void detect_features(int ball);
    void rescan(int ball);
    Candidate pair(int a, int b) const;
    Path path(int ball) const;
    const Segment& now_of(int ball) const { return record_.tracks[static_cast<std::size_t>(ball)].segments.back(); }
    void guard_cap();
    [[noreturn]] void fail(const std::string& why) const;

    double seconds_to_ns(Clock::time_point from, Clock::time_point to) const {
        return std::chrono::duration<double, std::nano>(to - from).count();
    }

    const Plan& plan_;
    const SimulateOptions& options_;
    MotionParams motion_;
    Record record_;
    double now_ = 0.0;
    int balls_ = 0;
    int dropped_ = 0;  // contacts in a row that turned out not to approach
    EventCost cost_;
    // Per ball: its transition, its first contact with the table, its first contact with another ball.
    std::vector<Candidate> own_, feature_, pair_;
};

template <bool kProfile>
void Shot<kProfile>::set_up() {
    const Scene& scene = plan_.scene;
    record_.table = scene.table;
    record_.balls = plan_.balls;
    record_.gravity = plan_.gravity;
    record_.render = scene.render;
    balls_ = static_cast<int>(scene.ball.size());
    for (const BallStart& ball : scene.ball) {
        BallTrack track;
        track.id = ball.id;
        track.segments.push_back(start_segment(0.0, ball.position, ball.velocity, ball.spin, motion_));
        record_.tracks.push_back(std::move(track));
    }
    own_.resize(scene.ball.size());
    feature_.resize(scene.ball.size());
    pair_.resize(scene.ball.size());
    if (scene.cue) {
        for (int i = 0; i < balls_; ++i) {
            if (scene.ball[static_cast<std::size_t>(i)].id != scene.cue->ball) continue;
            const StruckBall struck = strike(*scene.cue, plan_.balls);
            begin(i, start_segment(0.0, now_of(i).r, struck.v, struck.w, motion_));
            record_.events.push_back({0.0, EventType::kCueStrike, i, -1});
            if constexpr (kProfile) record_.costs.push_back({0.0, 0.0, 0.0, 0, "point"});
        }
    }
    for (int i = 0; i < balls_; ++i) {
        own_[static_cast<std::size_t>(i)] = {now_of(i).start + now_of(i).duration, EventType::kSlideRoll, i, -1, -1};
        detect_features(i);
        rescan(i);
    }
}

template <bool kProfile>
Path Shot<kProfile>::path(int ball) const {
    const Segment& s = now_of(ball);
    const double tau = now_ - s.start;
    const Vec3 r = position_at(s, tau), v = velocity_at(s, tau);
    const bool moves = translates(s.state);
    const bool straight = s.state == MotionState::kRolling ||
                          (s.state == MotionState::kSliding && s.v.x() * s.a.y() - s.v.y() * s.a.x() == 0.0);
    return {Vec2(r.x(), r.y()), Vec2(v.x(), v.y()), s.a, std::max(0.0, s.duration - tau), straight, moves};
}

// Closing speed of a contact at its time: at one instant the deepest closing goes first.
template <bool kProfile>
double Shot<kProfile>::closing(const Candidate& c) const {
    if (c.type != EventType::kBallBall) return 0.0;
    const Segment &s = now_of(c.a), &q = now_of(c.b);
    const Vec3 r = position_at(q, c.time - q.start) - position_at(s, c.time - s.start);
    const Vec3 v = velocity_at(q, c.time - q.start) - velocity_at(s, c.time - s.start);
    return -(r.x() * v.x() + r.y() * v.y());
}

template <bool kProfile>
Vec2 Shot<kProfile>::place(const Candidate& c) const {
    const Vec3 r = position_at(now_of(c.a), c.time - now_of(c.a).start);
    const Vec2 here(r.x(), r.y());
    switch (c.type) {
        case EventType::kBallBall: {
            const Vec3 q = position_at(now_of(c.b), c.time - now_of(c.b).start);
            return 0.5 * (here + Vec2(q.x(), q.y()));
        }
        case EventType::kBallPocket: return plan_.pockets[static_cast<std::size_t>(c.b)].center;
        case EventType::kBallCushion:
        case EventType::kBallJaw: {
            if (c.nose >= 0) return plan_.noses[static_cast<std::size_t>(c.nose)].center;
            const CushionLine& line = plan_.cushions[static_cast<std::size_t>(c.b)];
            return line.from + line.direction * line.direction.dot(here - line.from);
        }
        default: return here;
    }
}

// Order of candidates: time, then kind, then the deeper closing, then the place (x, then y). Never an id.
template <bool kProfile>
bool Shot<kProfile>::before(const Candidate& x, const Candidate& y) const {
    if (x.time != y.time) return x.time < y.time;
    if (x.time == kNever) return false;
    if (rank(x.type) != rank(y.type)) return rank(x.type) < rank(y.type);
    const double closing_x = closing(x), closing_y = closing(y);
    if (closing_x != closing_y) return closing_x > closing_y;
    const Vec2 place_x = place(x), place_y = place(y);
    if (place_x.x() != place_y.x()) return place_x.x() < place_y.x();
    return place_x.y() < place_y.y();
}

template <bool kProfile>
Candidate Shot<kProfile>::next() const {
    Candidate first;
    for (std::size_t i = 0; i < own_.size(); ++i) {
        for (const Candidate* c : {&own_[i], &feature_[i], &pair_[i]}) {
            if (c->time <= first.time && before(*c, first)) first = *c;
        }
    }
    return first;
}

template <bool kProfile>
Candidate Shot<kProfile>::pair(int a, int b) const {
    const double t = time_to_ball(path(a), path(b), 2.0 * plan_.balls.R);
    return {now_ + t, EventType::kBallBall, std::min(a, b), std::max(a, b), -1};
}

template <bool kProfile>
void Shot<kProfile>::rescan(int ball) {
    Candidate first;
    for (int j = 0; j < balls_; ++j) {
        if (j == ball || now_of(j).state == MotionState::kPocketed || now_of(ball).state == MotionState::kPocketed) continue;
        const Candidate c = pair(ball, j);
        if (before(c, first)) first = c;
    }
    pair_[static_cast<std::size_t>(ball)] = first;
}

template <bool kProfile>
void Shot<kProfile>::detect_features(int ball) {
    Candidate first;
    if (translates(now_of(ball).state)) {
        const Path p = path(ball);
        const double R = plan_.balls.R;
        const auto offer = [&](double t, EventType type, int index, int nose) {
            if (t == kNever) return;
            const Candidate c{now_ + t, type, ball, index, nose};
            if (before(c, first)) first = c;
        };
        for (std::size_t i = 0; i < plan_.cushions.size(); ++i) {
            const CushionLine& line = plan_.cushions[i];
            offer(time_to_line(p, line.from, line.direction, line.length, R), EventType::kBallCushion, static_cast<int>(i), -1);
        }
        for (std::size_t i = 0; i < plan_.noses.size(); ++i) {
            const Nose& nose = plan_.noses[i];
            offer(time_to_circle(p, nose.center, R + nose.radius), nose.type, nose.index, static_cast<int>(i));
        }
        for (std::size_t i = 0; i < plan_.pockets.size(); ++i)
            offer(time_to_pocket(p, plan_.pockets[i].center, plan_.pockets[i].radius), EventType::kBallPocket, static_cast<int>(i), -1);
    } else if (now_of(ball).state != MotionState::kPocketed) {
        // A ball that rests inside a pocket's circle falls.
        const Vec3& r = now_of(ball).r;
        for (std::size_t i = 0; i < plan_.pockets.size(); ++i) {
            if (length(Vec2(r.x(), r.y()) - plan_.pockets[i].center) < plan_.pockets[i].radius)
                first = {now_, EventType::kBallPocket, ball, static_cast<int>(i), -1};
        }
    }
    feature_[static_cast<std::size_t>(ball)] = first;
}

// After an event that touched a (and b): their own candidates anew, and those of balls whose next contact was with them.
template <bool kProfile>
void Shot<kProfile>::redetect(int a, int b) {
    for (const int i : {a, b}) {
        if (i < 0) continue;
        const Segment& s = now_of(i);
        own_[static_cast<std::size_t>(i)] = {s.start + s.duration, EventType::kSlideRoll, i, -1, -1};
        detect_features(i);
        rescan(i);
    }
    for (int j = 0; j < balls_; ++j) {
        if (j == a || j == b) continue;
        Candidate& mine = pair_[static_cast<std::size_t>(j)];
        const bool stale = mine.time != kNever && (mine.a == a || mine.b == a || (b >= 0 && (mine.a == b || mine.b == b)));
        if (stale) {
            rescan(j);
            continue;
        }
        for (const int i : {a, b}) {
            if (i < 0 || now_of(i).state == MotionState::kPocketed || now_of(j).state == MotionState::kPocketed) continue;
            const Candidate c = pair(i, j);
            if (before(c, mine)) mine = c;
        }
    }
}

template <bool kProfile>
void Shot<kProfile>::begin(int ball, const Segment& segment) {
    record_.tracks[static_cast<std::size_t>(ball)].segments.push_back(segment);
}

template <bool kProfile>
bool Shot<kProfile>::resolve_ball_ball(const Candidate& c) {
    const Segment &sa = now_of(c.a), &sb = now_of(c.b);
    const double R = plan_.balls.R;
    const Vec3 ra = position_at(sa, now_ - sa.start), rb = position_at(sb, now_ - sb.start);
    // Ball 1 is the one further left, then nearer: relabelling the balls changes no bit.
    const bool swap = rb.x() < ra.x() || (rb.x() == ra.x() && rb.y() < ra.y());
    const int one = swap ? c.b : c.a, two = swap ? c.a : c.b;
    const auto kernel_ball = [&](const Segment& s, const Vec3& r) {
        const Vec3 v = velocity_at(s, now_ - s.start), w = spin_at(s, now_ - s.start, R);
        return kernel::Ball{{r.x(), r.y(), r.z()}, {v.x(), v.y(), v.z()}, {w.x(), w.y(), w.z()}};
    };
    const kernel::Ball b1 = kernel_ball(now_of(one), swap ? rb : ra), b2 = kernel_ball(now_of(two), swap ? ra : rb);
    const BallParams& p = plan_.balls;
    const kernel::ImpactParams params{p.R, p.m, p.mu_s, p.mu_s, p.mu_b, p.e_b,
                                      plan_.scene.physics.cloth_slip == ClothSlipSign::kAsPublished
                                          ? kernel::ClothSlip::kAsPublished
                                          : kernel::ClothSlip::kConsistent};
    kernel::ImpactResult result;
    const auto start = kProfile ? Clock::now() : Clock::time_point{};
    switch (plan_.scene.physics.ball_ball) {
        case BallBallModel::kMathavan: plan_.march(b1, b2, params, plan_.scene.physics.substeps, result); break;
        case BallBallModel::kInelastic: kernel::collide_inelastic(b1, b2, params, result); break;
        case BallBallModel::kElastic: kernel::collide_elastic(b1, b2, params, result); break;
    }
    if constexpr (kProfile) {
        cost_.kernel_ns = seconds_to_ns(start, Clock::now());
        cost_.steps = result.steps;
        cost_.method = plan_.scene.physics.ball_ball == BallBallModel::kMathavan ? "march" : name(plan_.scene.physics.ball_ball);
    }
    if (result.status != kernel::ImpactStatus::kOk && result.status != kernel::ImpactStatus::kNotApproaching)
        fail(fmt::format("the impact of {} and {} could not be computed: {}", record_.tracks[static_cast<std::size_t>(c.a)].id,
                         record_.tracks[static_cast<std::size_t>(c.b)].id, kernel::describe(result.status)));
    const auto vec = [](const double (&x)[3]) { return Vec3(x[0], x[1], x[2]); };
    begin(one, start_segment(now_, Vec3(b1.r[0], b1.r[1], b1.r[2]), vec(result.v1), vec(result.w1), motion_));
    begin(two, start_segment(now_, Vec3(b2.r[0], b2.r[1], b2.r[2]), vec(result.v2), vec(result.w2), motion_));
    return result.status == kernel::ImpactStatus::kOk;
}

template <bool kProfile>
void Shot<kProfile>::resolve_nose(const Candidate& c) {
    const Segment& s = now_of(c.a);
    const double tau = now_ - s.start;
    const Vec3 r = position_at(s, tau);
    Vec3 v = velocity_at(s, tau), w = spin_at(s, tau, plan_.balls.R);
    const Vec2 here(r.x(), r.y());
    Vec2 normal;
    double height;
    if (c.nose >= 0) {
        const Nose& nose = plan_.noses[static_cast<std::size_t>(c.nose)];
        const Vec2 out = here - nose.center;
        normal = out / length(out);
        height = nose.height;
    } else {
        const CushionLine& line = plan_.cushions[static_cast<std::size_t>(c.b)];
        normal = Vec2(-line.direction.y(), line.direction.x());
        if (normal.dot(here - line.from) < 0.0) normal = -normal;
        height = line.height;
    }
    const BallParams& p = plan_.balls;
    resolve_cushion(plan_.scene.physics.cushion, {p.R, p.m, p.mu_s, p.e_c, p.f_c, height}, normal, v, w);
    if constexpr (kProfile) cost_.method = name(plan_.scene.physics.cushion);
    begin(c.a, start_segment(now_, r, v, w, motion_));
}

template <bool kProfile>
void Shot<kProfile>::apply(const Candidate& c) {
    EventType type = c.type;
    bool happened = true;
    switch (c.type) {
        case EventType::kBallBall: happened = resolve_ball_ball(c); break;
        case EventType::kBallCushion:
        case EventType::kBallJaw: resolve_nose(c); break;
        case EventType::kBallPocket:
            begin(c.a, pocketed_segment(now_, plan_.pockets[static_cast<std::size_t>(c.b)]));
            record_.tracks[static_cast<std::size_t>(c.a)].pocket = c.b;
            break;
        default: {
            const Segment next_segment = after_transition(now_of(c.a), motion_);
            type = transition_type(now_of(c.a), next_segment);
            begin(c.a, next_segment);
        }
    }
    dropped_ = happened ? 0 : dropped_ + 1;
    if (happened) {
        record_.events.push_back({now_, type, c.a, c.b});
        if constexpr (kProfile) record_.costs.push_back(cost_);
    }
    guard_cap();
}

template <bool kProfile>
void Shot<kProfile>::guard_cap() {
    const std::size_t count = record_.events.size();
    const std::size_t cap = static_cast<std::size_t>(kEventCap);
    if (dropped_ > kEventCap || (count > cap && now_ - record_.events[count - 1 - cap].time < kEventCapSpan))
        fail(fmt::format("more than {} events within {:g} s of simulated time", kEventCap, kEventCapSpan));
}

template <bool kProfile>
void Shot<kProfile>::fail(const std::string& why) const {
    std::string text = fmt::format("simulation stopped at t = {:.17g} s after {} events: {}\n", now_, record_.events.size(), why);
    const std::size_t count = record_.events.size();
    text += "last events:\n";
    for (std::size_t i = count > 8 ? count - 8 : 0; i < count; ++i) {
        const Event& e = record_.events[i];
        text += fmt::format("  {:.17g} {} {} {}\n", e.time, name(e.type), record_.tracks[static_cast<std::size_t>(e.a)].id,
                            record_.partner_id(e));
    }
    text += "balls that move (id state x y vx vy wx wy wz):\n";
    for (int i = 0; i < balls_; ++i) {
        const Segment& s = now_of(i);
        if (s.state == MotionState::kStationary || s.state == MotionState::kPocketed) continue;
        const double tau = std::max(0.0, now_ - s.start);
        const Vec3 r = position_at(s, tau), v = velocity_at(s, tau), w = spin_at(s, tau, plan_.balls.R);
        text += fmt::format("  {} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n",
                            record_.tracks[static_cast<std::size_t>(i)].id, name(s.state), r.x(), r.y(), v.x(), v.y(), w.x(),
                            w.y(), w.z());
    }
    throw SimulationError(text);
}

template <bool kProfile>
Record Shot<kProfile>::run() {
    const auto set_up_start = kProfile ? Clock::now() : Clock::time_point{};
    set_up();
    if constexpr (kProfile) record_.setup_detect_ns = seconds_to_ns(set_up_start, Clock::now());
    double stop = plan_.scene.stop.time.value_or(kNever);
    if (options_.until) stop = std::min(stop, *options_.until);
    const std::int64_t most = plan_.scene.stop.events.value_or(-1);
    for (;;) {
        if (most >= 0 && static_cast<std::int64_t>(record_.events.size()) >= most) {
            record_.stopped = StopReason::kEvents;
            break;
        }
        const auto start = kProfile ? Clock::now() : Clock::time_point{};
        const Candidate c = next();
        if (c.time > stop || c.time == kNever) {
            record_.stopped = c.time == kNever ? StopReason::kAtRest : StopReason::kTime;
            if (c.time != kNever) now_ = stop;
            break;
        }
        if constexpr (kProfile) cost_ = {};
        now_ = std::max(now_, c.time);
        const auto found = kProfile ? Clock::now() : Clock::time_point{};
        const std::size_t events_before = record_.events.size();
        apply(c);
        const auto resolved = kProfile ? Clock::now() : Clock::time_point{};
        redetect(c.a, c.type == EventType::kBallBall ? c.b : -1);
        if constexpr (kProfile) {
            if (record_.events.size() > events_before) {
                EventCost& cost = record_.costs.back();
                cost.resolve_ns = seconds_to_ns(found, resolved);
                cost.detect_ns = seconds_to_ns(start, found) + seconds_to_ns(resolved, Clock::now());
            }
        }
        if (options_.progress) options_.progress(record_.events.size(), now_);
    }
    record_.duration = now_;
    return std::move(record_);
}

}  // namespace

Record simulate(const Plan& plan, const SimulateOptions& options) {
    return options.profile ? Shot<true>(plan, options).run() : Shot<false>(plan, options).run();
}

}  // namespace carom
