#include "tangent/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "carom/engine/tangents.h"
#include "contact/roots.h"

namespace carom::tangent {
namespace {

// [-] A computed state agrees with the record within this fraction of the ball's speed, or within ten times
// the impact tolerance.
constexpr double kAgrees = 1e-9;

// [R] Two bodies with a larger gap or overlap do not just touch.
constexpr double kTouches = 1e-8;

double speed_of(const Vec3& v, const Vec3& w, double R) {
    return length3(v) + R * length3(w);
}

/// A record from a file may belong to another scene.
template <class Part>
const Part& part_of(const std::vector<Part>& parts, int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= parts.size())
        throw std::invalid_argument("the record is not of this plan: its table has other parts");
    return parts[static_cast<std::size_t>(index)];
}

}  // namespace

Replay::Replay(const Plan& plan, const Record& record, Scene& scene, const std::vector<Input>& inputs,
               double until)
    : plan_(plan),
      record_(record),
      numbers_(numbers_of(plan, scene, inputs)),
      laws_{plan, numbers_},
      balls_(record.tracks.size()),
      until_(std::min(until, record.duration)) {
    if (plan.sizes.size() != record.tracks.size())
        throw std::invalid_argument("the record is not of this plan: it has another number of balls");
    if (!plan.balls.rolls()) throw TangentError("pucks (balls.rolls = false) have no derivatives here");
    if (plan.balls.discs() && !plan.scene.of_one_radius())
        throw TangentError("discs of different size have no derivatives here");
    for (std::size_t i = 0; i < balls_.size(); ++i) {
        const Numbers::Ball& ball = numbers_.balls[i];
        const Segment& first = record.tracks[i].segments.front();
        if (first.held)
            throw TangentError(fmt::format(
                "{} is in a resting contact at the start, and a resting contact has no derivative here",
                who(static_cast<int>(i))));
        balls_[i].flew = -kNever;
        balls_[i].legs.push_back(
            leg_of(first, 0.0, {ball.r, ball.v, ball.w}, surface_of(numbers_, static_cast<int>(i))));
    }
    for (const Event& event : record.events) {
        if (event.time > until_) break;
        now_ = event.time;
        try {
            replay(event);
        } catch (const TangentError& error) {
            throw TangentError(fmt::format("the {} of {} at {:.6g} s has no derivative here: {}",
                                           name(event.type), whom(event), event.time, error.what()));
        }
    }
}

std::string Replay::who(int ball) const {
    return "ball " + record_.tracks[ball].id;
}

std::string Replay::whom(const Event& event) const {
    const std::string partner = record_.partner_id(event);
    if (partner.empty()) return who(event.a);
    return fmt::format("{} and {}{}", who(event.a), kind(event.type).partner == Partner::kBall ? "ball " : "",
                       partner);
}

const Leg& Replay::leg_at(int ball, double time) const {
    const std::vector<Leg>& legs = balls_[ball].legs;
    const auto after = std::upper_bound(legs.begin() + 1, legs.end(), time,
                                        [](double t, const Leg& leg) { return t < leg.start.x; });
    return after[-1];
}

// An event at which a gap closes shifts by -dg / (dg/dt).
Dual Replay::when(const Touch<Dual3>& touch, double size) const {
    if (std::abs(touch.gap.x) > kTouches * size)
        throw TangentError("the two overlapped before, and met when they began to approach");
    return chain(now_, touch.gap, 1.0 / touch.closing.x);
}

// On a straight path it would pass the centre at |apart x velocity| / |velocity|; it collides because that is
// less than |apart|.
void Replay::add_miss(const Dual2& apart, const Dual2& velocity, const Event& event) {
    const Dual speed = length(velocity), side = cross(apart, velocity) / speed;
    if (!(speed.x > 0.0)) return;
    rooms_.push_back({length(apart) - (side.x < 0.0 ? -side : side),
                      fmt::format("{} misses {}{} at {:.3f} s", who(event.a),
                                  kind(event.type).partner == Partner::kBall ? "ball " : "",
                                  record_.partner_id(event), now_)});
}

const Segment& Replay::next(int ball, double start) {
    const std::vector<Segment>& segments = record_.tracks[ball].segments;
    const std::size_t k = ++balls_[ball].segment;
    if (k >= segments.size() || std::abs(segments[k].start - start) > kAgrees * (1.0 + start))
        throw TangentError(fmt::format("the motion of {} does not restart at this event", who(ball)));
    if (segments[k].held) throw TangentError("a resting contact begins");
    return segments[k];
}

void Replay::begin(int ball, const Dual& time, const State& state) {
    Ball& b = balls_[ball];
    const Segment& segment = next(ball, time.x);
    const Leg& last = b.legs.back();
    const double R = plan_.sizes[ball].R;
    double off = 0.0, most = speed_of(segment.v, segment.w, R);
    for (int i = 0; i < 3; ++i) {
        // The cloth absorbs a vertical speed that is too small for a bounce.
        if (i < 2 || is_off_cloth(segment.state)) off = std::max(off, std::abs(state.v[i].x - segment.v[i]));
        off = std::max(off, R * std::abs(state.w[i].x - segment.w[i]));
        most = std::max({most, std::abs(last.from.v[i].x), R * std::abs(last.from.w[i].x)});
    }
    if (!is_gone(segment.state) && off > most * std::max(kAgrees, 10.0 * plan_.scene.physics.tolerance))
        throw TangentError(fmt::format("{} does not continue as after this event alone", who(ball)));
    if (flies(last.state)) b.flew = now_;
    if (segment.state == MotionState::kFalling && last.state != MotionState::kFalling) b.fell = now_;
    Leg leg = leg_of(segment, time, state, surface_of(numbers_, ball));
    b.legs.push_back(leg);
}

void Replay::go_on(int ball, const Dual& time, State state) {
    Ball& b = balls_[ball];
    const bool lies = !(state.r[2].x > plan_.sizes[ball].R);
    if (lies && state.v[2].x < 0.0 && b.legs.back().state != MotionState::kFalling) {
        meet_cloth(laws_, ball, state);
        b.on_cloth = true;
    }
    begin(ball, time, state);
}

void Replay::replay(const Event& event) {
    Dual time(event.time);
    switch (event.type) {
        case EventType::kCueStrike: {
            const Numbers::Ball& ball = numbers_.balls[event.a];
            go_on(event.a, time, {ball.r, ball.v, ball.w});
            break;
        }
        case EventType::kBallBall:
            time = ball_ball(event);
            break;
        case EventType::kBallCushion:
        case EventType::kBallJaw:
            time = cushion(event);
            break;
        case EventType::kBallPocket:
        case EventType::kBallEdge:
            time = pocket(event);
            break;
        case EventType::kSlideRoll:
        case EventType::kRollSpin:
        case EventType::kRollStop:
        case EventType::kSpinStop:
            time = transition(event);
            break;
        case EventType::kBallCloth: {
            Ball& ball = balls_[event.a];
            if (ball.on_cloth) {
                ball.on_cloth = false;
                time = times_.back();
                break;
            }
            time = ball.legs.back().start + ball.legs.back().duration;
            time.x = now_;
            State state = ball.legs.back().at(time);
            state.r[2] = numbers_.balls[event.a].R;
            go_on(event.a, time, state);
            ball.on_cloth = false;
            break;
        }
        case EventType::kBallOut:
            // The flight continues unchanged, so its start has no influence here.
            begin(event.a, time, balls_[event.a].legs.back().at(time));
            time.d.fill(std::numeric_limits<double>::quiet_NaN());
            break;
        case EventType::kBallCluster:
            time = cluster(event);
            break;
        case EventType::kBallBallHold:
        case EventType::kBallBallRelease:
        case EventType::kBallCushionHold:
        case EventType::kBallCushionRelease:
        case EventType::kBallJawHold:
        case EventType::kBallJawRelease:
            throw TangentError("it is a resting contact");
    }
    times_.push_back(time);
    places_.push_back(planar(leg_at(event.a, event.time).from.r));
}

Dual Replay::transition(const Event& event) {
    const Leg& leg = balls_[event.a].legs.back();
    Dual time = leg.start + leg.duration;
    time.x = now_;
    State s = leg.at(time);
    if (leg.state == MotionState::kSliding) {
        const Dual2 u = slip_of(leg.from, leg.R);
        for (int i = 0; i < 2; ++i) s.v[i] = leg.from.v[i] - 2.0 / 7.0 * u[i];
        roll(s, leg.R);
    } else {
        for (int i = 0; i < 2; ++i) s.v[i] = s.w[i] = 0.0;
    }
    begin(event.a, time, s);
    return time;
}

bool Replay::in_space(int a, int b) const {
    const auto state = [this](int ball) { return balls_[ball].legs.back().state; };
    const auto over = [&](int p, int q) {
        return state(p) == MotionState::kFalling && balls_[q].flew >= balls_[p].fell;
    };
    return flies(state(a)) || flies(state(b)) || over(a, b) || over(b, a);
}

Replay::Meeting Replay::meet(const Event& event) {
    const int one = event.a, two = event.b;
    const Leg leg1 = balls_[one].legs.back(), leg2 = balls_[two].legs.back();
    const Numbers::Ball &b1 = numbers_.balls[one], &b2 = numbers_.balls[two];
    const bool space = in_space(one, two);
    const auto sinks = [](const Leg& leg) { return leg.state == MotionState::kFalling; };
    const auto at = [space](const Leg& leg, const Dual& R, const Dual& time) {
        State s = leg.at(time);
        if (space) place_in_space(leg, s);
        return BallAt<Dual3>{s.r, s.v, R};
    };
    const BallAt<Dual3> ball1 = at(leg1, b1.R, now_), ball2 = at(leg2, b2.R, now_);
    const Dual time =
        when(space ? touch_ball(ball1, ball2) : touch_level(ball1, ball2, plan_.balls.discs()), b1.R.x);
    Dual3 apart = at(leg2, b2.R, time).r - at(leg1, b1.R, time).r;
    if (!space) apart[2] = sinks(leg1) || sinks(leg2) ? Dual(0.0) : b2.R - b1.R;
    const Meeting m{space, time, apart, leg1.at(time), leg2.at(time)};
    add_miss(planar(m.apart), planar(m.s2.v - m.s1.v), event);
    return m;
}

Dual Replay::ball_ball(const Event& event) {
    const int one = event.a, two = event.b;
    const Leg leg1 = balls_[one].legs.back(), leg2 = balls_[two].legs.back();
    const Meeting met = meet(event);
    const bool space = met.space;
    const Dual& time = met.time;
    State s1 = met.s1, s2 = met.s2;
    const auto sinks = [](const Leg& leg) { return leg.state == MotionState::kFalling; };
    if (laws_.flights() && (plan_.ball_ball->free || space)) {
        const auto lies = [&](const Leg& leg) { return !flies(leg.state) && !(space && sinks(leg)); };
        if (!space && (sinks(leg1) || sinks(leg2))) s1.v[2] = s2.v[2] = 0.0;
        collide_free(laws_, one, two, met.apart, event.slow, {lies(leg1), lies(leg2)}, s1, s2);
        // The engine continues the ball with the smaller coordinates first.
        for (const auto& [ball, leg, s] : {std::tie(one, leg1, s1), std::tie(two, leg2, s2)}) {
            State after = s;
            if (space) {
                State place = leg.at(time);
                place_in_space(leg, place);
                after.r = place.r;
            }
            if (space && sinks(leg)) {
                after.r[2] = after.r[2] + after.v[2] * after.v[2] / (2.0 * leg.gravity);
                begin(ball, time, after);
            } else {
                if (sinks(leg)) after.v[2] = leg.at(time).v[2];
                go_on(ball, time, after);
            }
        }
    } else {
        collide(laws_, one, two, met.apart, s1, s2);
        begin(one, time, s1);
        begin(two, time, s2);
    }
    return time;
}

Dual Replay::cluster(const Event& event) {
    const std::vector<int>& members = record_.clusters[static_cast<std::size_t>(event.detail)].balls;
    const auto has = [&members](int ball) {
        return std::find(members.begin(), members.end(), ball) != members.end();
    };
    if (!has(event.a) || !has(event.b))
        throw std::invalid_argument("the record is not of this plan: a cluster without the balls that met");
    const auto off_cloth = [this](int ball) { return is_off_cloth(balls_[ball].legs.back().state); };
    if (std::any_of(members.begin(), members.end(), off_cloth) || (laws_.flights() && plan_.ball_ball->free))
        throw TangentError("more than two balls touch at once, and not all of them on the cloth");
    const Dual time = meet(event).time;
    std::vector<State> states;
    states.reserve(members.size());
    for (const int ball : members) states.push_back(balls_[ball].legs.back().at(time));
    const Ball& first = balls_[members.front()];
    const Segment& colliding =
        part_of(record_.tracks[members.front()].segments, static_cast<int>(first.segment) + 1);
    const bool lasts = colliding.state == MotionState::kColliding;
    const Dual duration = lasts ? colliding.duration : 0.0;
    std::vector<State> after = states;
    collide_cluster(laws_, members, event.a, event.b, duration.x, after);
    for (std::size_t k = 0; k < members.size(); ++k) {
        if (lasts) {
            for (int i = 0; i < 2; ++i) states[k].v[i] = (after[k].r[i] - states[k].r[i]) / duration;
            states[k].w = after[k].w;
            begin(members[k], time, states[k]);
        }
        begin(members[k], time + duration, after[k]);
    }
    return time;
}

Dual Replay::cushion(const Event& event) {
    const int ball = event.a;
    const std::size_t k = static_cast<std::size_t>(&event - record_.events.data());
    for (std::size_t i = k + 1; i < record_.events.size() && record_.events[i].time == now_; ++i)
        if (kind(record_.events[i].type).phase == EventPhase::kImpact && record_.events[i].a == ball &&
            (record_.events[i].type == EventType::kBallJaw ||
             record_.events[i].type == EventType::kBallCushion))
            throw TangentError("the ball meets two parts of the table at once");
    const Leg leg = balls_[ball].legs.back();
    const bool flying = flies(leg.state);
    const Dual& R = numbers_.balls[ball].R;
    const Contact part = contact_of(event);
    const Nose* round = part.with == With::kNose ? &part_of(plan_.geometry.noses, part.other) : nullptr;
    if (round == nullptr) part_of(plan_.geometry.cushions, part.other);
    const auto add_end = [&](const Dual& left) {
        rooms_.push_back({left, fmt::format("{} passes the end of {} at {:.3f} s", who(ball),
                                            record_.partner_id(event), now_)});
    };
    const auto touch_at = [&](const State& s) {
        return touch_part(numbers_, part, BallAt<Dual3>{s.r, s.v, R, flying});
    };
    const Dual time = when(touch_at(leg.at(now_)), R.x);
    State s = leg.at(time);
    const Touch<Dual3> touch = touch_at(s);
    // Points into the table.
    const Dual3 normal{-touch.n[0], -touch.n[1], -touch.n[2]};
    if (round != nullptr && round->is_arc()) {
        const Dual2 out = planar(s.r) - numbers_.noses[part.other].center;
        for (const Vec2& end : {round->span.from, round->span.to}) {
            const Dual aside = end.x() * out[1] - end.y() * out[0];
            if (dot(end, Vec2(out[0].x, out[1].x)) > 0.0) add_end(aside.x < 0.0 ? -aside : aside);
        }
    } else if (round != nullptr) {
        const Dual reach = reach_of(numbers_.noses[part.other], R, flying);
        add_miss({reach * normal[0], reach * normal[1]}, planar(s.v), event);
    } else {
        const Numbers::Line& line = numbers_.cushions[part.other];
        const Dual foot = dot(line.direction, planar(s.r) - line.from);
        for (const Dual& left : {foot, line.length - foot}) add_end(left);
    }
    const CushionModelInfo& model = event.type == EventType::kBallJaw ? *plan_.jaw : *plan_.cushion;
    if (flying) {
        meet_nose_in_air(laws_, ball, model, normal, s);
        go_on(ball, time, s);
    } else {
        const bool hops = laws_.flights() && leg.state != MotionState::kFalling;
        const Dual& height =
            round != nullptr ? numbers_.noses[part.other].height : numbers_.cushions[part.other].height;
        meet_cushion(laws_, ball, model, planar(normal), height, hops, s);
        begin(ball, time, s);
    }
    return time;
}

Dual Replay::pocket(const Event& event) {
    const int ball = event.a;
    const Leg leg = balls_[ball].legs.back();
    const Numbers::Round& pocket = part_of(numbers_.pockets, event.b);
    const bool falls = leg.state == MotionState::kFalling;
    if (event.type == EventType::kBallEdge && falls) throw TangentError("the ball leaves the pocket again");
    Dual time = leg.start + leg.duration;
    const State here = leg.at(now_);
    const Dual2 out = planar(here.r) - pocket.center;
    const Dual distance = length(out);
    const double rate = (out[0].x * here.v[0].x + out[1].x * here.v[1].x) / distance.x;
    // It sinks or lands before it crosses the edge, or it crosses the edge.
    const bool ends = (falls || flies(leg.state)) && std::abs(time.x - now_) <= kAgrees * (1.0 + now_);
    if (!ends) time = when({{}, distance - pocket.radius, -rate, 0.0}, pocket.radius.x);
    time.x = now_;
    State s = leg.at(time);
    if (!ends) add_miss(planar(s.r) - pocket.center, planar(s.v), event);
    if (event.type == EventType::kBallEdge) {
        s.v[2] = 0.0;
    } else {
        s.r = {pocket.center[0], pocket.center[1], 0.0};
    }
    begin(ball, time, s);
    return time;
}

}  // namespace carom::tangent

namespace carom {

Tangents::Tangents(const Plan& plan, const Record& record, const std::vector<std::string>& inputs,
                   std::optional<double> until)

    : inputs_(inputs),
      duration_(std::min(record.duration, until.value_or(kNever))),
      parts_(std::make_unique<Parts>()) {
    Scene scene = plan.scene;
    for (std::size_t first = 0; first < inputs.size(); first += tangent::kLanes) {
        std::vector<tangent::Input> part;
        for (std::size_t i = first; i < std::min(inputs.size(), first + tangent::kLanes); ++i)
            part.push_back(tangent::input_of(scene, inputs[i]));
        parts_->replays.push_back(
            std::make_unique<tangent::Replay>(plan, record, scene, part, until.value_or(kNever)));
    }
}
Tangents::~Tangents() = default;
Tangents::Tangents(Tangents&& other) noexcept = default;
Tangents& Tangents::operator=(Tangents&& other) noexcept = default;

StateTangent Tangents::state_at(int ball, double time, std::size_t input) const {
    time = std::min(time, duration_);
    const tangent::Leg& leg = parts_->of(input).leg_at(ball, time);
    const std::size_t lane = input % tangent::kLanes;
    StateTangent t;
    if (is_gone(leg.state)) return t;
    tangent::State s = leg.at(time);
    tangent::place_in_space(leg, s);
    for (int i = 0; i < 3; ++i) {
        t.position[i] = s.r[i].d[lane];
        t.velocity[i] = s.v[i].d[lane];
        t.spin[i] = s.w[i].d[lane];
    }
    return t;
}

double Tangents::event_time(std::size_t event, std::size_t input) const {
    return parts_->of(input).times()[event].d[input % tangent::kLanes];
}
Vec2 Tangents::event_place(std::size_t event, std::size_t input) const {
    const tangent::Dual2& place = parts_->of(input).places()[event];
    return {place[0].d[input % tangent::kLanes], place[1].d[input % tangent::kLanes]};
}
std::size_t Tangents::events() const {
    return parts_->replays.empty() ? 0 : parts_->replays.front()->times().size();
}
double Tangents::impact_error() const {
    double error = 0.0;
    for (const auto& replay : parts_->replays) error = std::max(error, replay->error());
    return error;
}

}  // namespace carom
