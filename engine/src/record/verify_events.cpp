// Compares the events of a record with its segments, and computes every impact again.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/airborne.h"
#include "carom/engine/tolerances.h"
#include "contact/touch.h"
#include "physics/cluster.h"
#include "physics/cue.h"
#include "physics/cushion/bounce.h"
#include "physics/motion.h"
#include "physics/reach.h"
#include "record/verify_parts.h"

namespace carom {
namespace {

// [-] Events of a ball at one instant from which on they are compared as a whole.
constexpr int kPile = 3;
// [m/s], [of the speeds] Jump of the velocity of a ball in a resting contact between two of its intervals.
constexpr double kHeldJump = 1e-3, kHeldShare = 1e-2;
// [contact time] A cluster without duration lasts for this long in its integration.
constexpr double kInstant = 20.0;
// [-] Balls whose radii differ by this fraction are alike, but the kernel has another solver for unlike
// balls.
constexpr double kUnlike = 0x1p-40;

/// A model of the impact of two balls: the law of `mathavan`, for alike balls too by the solver for unlike
/// ones (Gauss collocation), which shares no code with the solver of the loop.
void as_unlike(const BallBallSettings& settings, const kernel::Ball& ball1, const kernel::Ball& ball2,
               const kernel::ImpactParams& params, kernel::ImpactResult& result) {
    kernel::ImpactParams unlike = params;
    if (params.radius_ratio == 1.0) unlike.radius_ratio += kUnlike;
    settings.by_tolerance(ball1, ball2, unlike, settings.tolerance, result);
    if (result.status != kernel::ImpactStatus::kOk)
        settings.by_tolerance(ball1, ball2, params, settings.tolerance, result);
}

BallBallModelInfo checking(const Plan& plan) {
    BallBallModelInfo model = *plan.ball_ball;
    if (model.reads_tolerance && plan.impact.march == nullptr) model.collide = as_unlike;
    return model;
}

/// A ball whose motion changes at the present instant.
struct Changed {
    std::size_t before = 0, after = 0;      ///< segments; those between them have no duration
    bool begins = false;                    ///< at the start of the record there is none before
    Placed at{Vec3::Zero(), Vec3::Zero()};  ///< just before, then after the events so far
    Vec3 w = Vec3::Zero();
    std::size_t next = 0;  ///< the segment that began after the events so far
    double error = 0.0;    ///< [m/s] of the velocities
    int events = 0;
    const Event* last = nullptr;
    bool flies = false;
    bool held = false;   ///< before, after or meanwhile
    bool loose = false;  ///< the velocities depend on more than the events of this ball
    double speeds(double R) const { return length3(at.velocity) + R * length3(w); }
};

class Events {
  public:
    Events(const Record& record, const Plan& plan)
        : record_(record), plan_(plan), model_(checking(plan)), changed_(record.tracks.size()) {}

    std::optional<Violation> run() {
        for (std::size_t ball = 0; ball < record_.tracks.size(); ++ball)
            for (const Segment& segment : track(ball).segments) begun_.push_back({segment.start, ball});
        std::sort(begun_.begin(), begun_.end());
        for (auto next = begun_.begin();
             !found_ && (next != begun_.end() || event_ < record_.events.size());) {
            first_ = event_;
            now_ = next != begun_.end() ? next->first : kNever;
            if (first_ < record_.events.size()) now_ = std::min(now_, record_.events[first_].time);
            const auto begin = next;
            while (next != begun_.end() && next->first == now_) ++next;
            last_ = first_;
            while (last_ < record_.events.size() && record_.events[last_].time == now_) ++last_;
            calm_ = std::all_of(record_.events.begin() + static_cast<std::ptrdiff_t>(first_),
                                record_.events.begin() + static_cast<std::ptrdiff_t>(last_),
                                [](const Event& e) { return kind(e.type).phase == EventPhase::kTransition; });
            // The constructor from iterators is missing in emscripten's library.
            instant(std::span(begun_).subspan(static_cast<std::size_t>(begin - begun_.begin()),
                                              static_cast<std::size_t>(next - begin)));
        }
        return found_;
    }

  private:
    const BallTrack& track(std::size_t ball) const { return record_.tracks[ball]; }
    const std::string& id(std::size_t ball) const { return track(ball).id; }
    double R(std::size_t ball) const { return plan_.sizes[ball].R; }
    bool flights() const { return plan_.in_force(Effect::kAirborne); }
    const Segment& before(std::size_t ball) const { return track(ball).segments[changed_[ball].before]; }
    const Segment& after(std::size_t ball) const { return track(ball).segments[changed_[ball].after]; }
    double tau(std::size_t ball) const { return now_ - before(ball).start; }
    bool is_changed(std::size_t ball) const {
        return changed_[ball].after < track(ball).segments.size() && after(ball).start == now_;
    }
    double same_place(std::size_t ball) const {
        return kSamePlace + rounding_of(changed_[ball].at.velocity, changed_[ball].w, R(ball), now_) +
               touch_tolerance(planar(changed_[ball].at.position));
    }

    template <class... Values>
    void report(const char* law, fmt::format_string<Values...> message, Values&&... values) {
        if (!found_) found_ = Violation{event_, law, fmt::format(message, std::forward<Values>(values)...)};
    }

    // Applies the events of one instant to the states before it, and compares the result with the segments
    // that begin.
    void instant(std::span<const std::pair<double, std::size_t>> begun) {
        first_ = event_;
        for (auto it = begun.begin(); it != begun.end() && !found_; ++it)
            if (it == begun.begin() || it->second != (it - 1)->second) prepare(it->second);
        while (event_ < last_ && !found_) apply();
        event_ = last_ > first_ ? last_ - 1 : first_;
        for (auto it = begun.begin(); it != begun.end() && !found_; ++it)
            if (it == begun.begin() || it->second != (it - 1)->second) compare(it->second);
        event_ = last_;
    }

    void prepare(std::size_t ball) {
        const std::vector<Segment>& segments = track(ball).segments;
        Changed& c = changed_[ball];
        const std::size_t from = c.after;
        c = {};
        c.begins = segments[from].start == now_;  // only at the start of the record
        c.before = c.after = c.next = from;
        while (c.after + 1 < segments.size() && segments[c.after + 1].start == now_) ++c.after;
        for (std::size_t k = from; k <= c.after; ++k) c.held |= segments[k].held;
        c.loose = c.held && !calm_;
        const Segment& s = segments[from];
        if (c.begins) {
            const BallStart& b = plan_.scene.ball[ball];
            const auto begin = flights() ? free_segment : start_segment;
            const Segment start = begin(0.0, b.position, b.velocity, b.spin, plan_.motion[ball]);
            if ((s.r - start.r).norm() > kSamePlace ||
                (s.v - start.v).norm() + R(ball) * (s.w - start.w).norm() >
                    same_speed(length3(start.v) + R(ball) * length3(start.w), ball))
                report("U6", "ball {} does not start as in the scene", id(ball));
        }
        c.at = placed_at(s, c.begins ? 0.0 : tau(ball), record_.gravity, R(ball));
        c.w = c.begins ? s.w : spin_at(s, tau(ball), R(ball));
        c.flies = is_aloft(s, R(ball));
        // A cluster ends without an event, or the ball leaves it because it meets something else.
        if (s.state == MotionState::kColliding && !c.begins) {
            c.at.velocity = segments[++c.next].v;
            c.w = segments[c.next].w;
            check_start(ball, segments[c.next]);
        }
    }

    double same_speed(double speeds, std::size_t ball) const {
        return kSameShare * speeds + kSameTime * plan_.motion[ball].slide;
    }

    bool rests(std::size_t ball) const {
        return std::any_of(resting_.begin(), resting_.end(), [ball](const Contact& c) {
            return c.ball == static_cast<int>(ball) || c.partner() == static_cast<int>(ball);
        });
    }

    void compare(std::size_t ball) {
        const Changed& c = changed_[ball];
        const Segment &s = before(ball), &next = after(ball);
        if (c.begins && c.after == c.before) return;
        const bool leaves = s.state == MotionState::kColliding;
        // A contact that ends leaves the other ball the forces of its group for one more interval.
        const bool released = c.last != nullptr && kind(c.last->type).phase == EventPhase::kRelease;
        if (next.held && !rests(ball) && !released && !s.held)
            return report("U6", "ball {} rests against nothing at {:.17g} s", id(ball), now_);
        if (c.events == 0 && !c.held && !leaves)
            return report("U6", "ball {} changes its motion at {:.17g} s without an event", id(ball), now_);
        // At its transition a ball of a group stops, unless the group drives it on.
        const bool goes_on =
            next.state == s.state || (s.state == MotionState::kRolling && translates(next.state));
        if (s.held && s.ends && calm_ && c.events == 0 && s.start + s.duration <= now_ && !goes_on)
            return report("U6", "ball {} is {} from {:.17g} s on without an event", id(ball),
                          name(next.state), now_);
        if (next.state == MotionState::kPocketed) return check_pocketed(ball);
        if (next.state == MotionState::kColliding) return check_colliding(ball);
        if (c.held || c.next == c.before) check_start(ball, next);
        // A pile of impacts at one instant is compared as a whole.
        else if (c.next != c.after && c.events < kPile)
            report("U6", "ball {} changes its motion at {:.17g} s more often than its events", id(ball),
                   now_);
    }

    // Compares the ball with the motion that begins after the events so far, from which the next event
    // starts.
    // @param from  the events that follow
    void step(std::size_t ball, std::size_t from) {
        Changed& c = changed_[ball];
        const int of = static_cast<int>(ball);
        const std::vector<Segment>& segments = track(ball).segments;
        const auto has = [&](const Event& e) {
            if (e.type != EventType::kBallCluster) return e.a == of || contact_of(e).partner() == of;
            const std::vector<int>& members = record_.clusters[static_cast<std::size_t>(e.detail)].balls;
            return std::find(members.begin(), members.end(), of) != members.end();
        };
        while (from < last_ && !has(record_.events[from])) ++from;
        // A ball that is pressed down hits the cloth before its motion begins.
        const bool waits = from < last_ && record_.events[from].type == EventType::kBallCloth &&
                           !(c.at.position.z() > R(ball));
        // A group may begin any number of motions.
        if (found_ || c.held || waits) return;
        if (++c.next > c.after)
            return report("U6", "ball {} changes its motion at {:.17g} s less often than its events",
                          id(ball), now_);
        const Segment& s = segments[c.next];
        check_start(ball, s);
        c.at = placed_at(s, 0.0, record_.gravity);
        c.w = s.w;
        if (s.state == MotionState::kColliding && c.next + 1 < segments.size())
            c.at.velocity = segments[c.next + 1].v;
        c.flies = is_aloft(s, R(ball));
        c.error = 0.0;
        c.loose = false;
    }

    void check_start(std::size_t ball, const Segment& next) {
        const Changed& c = changed_[ball];
        if (next.state == MotionState::kPocketed) return;
        const Placed there = placed_at(next, 0.0, record_.gravity);
        if ((there.position - c.at.position).norm() > same_place(ball))
            return report("U6", "ball {} jumps by {:.3g} m at {:.17g} s", id(ball),
                          (there.position - c.at.position).norm(), now_);
        if (c.loose || next.state == MotionState::kColliding) return;
        // The cloth absorbs a slow rise.
        Vec3 v = c.at.velocity;
        const bool lies = !is_off_cloth(next.state);
        if (lies && flights() &&
            (v.z() > bounce_end(R(ball), record_.gravity) || v.z() < -kSameShare * c.speeds(R(ball))))
            return report("U6", "ball {} stays on the cloth at {:.17g} s, although it has {:.3g} m/s upwards",
                          id(ball), now_, v.z());
        if (lies) v.z() = 0.0;
        const double off = std::max((there.velocity - v).lpNorm<Eigen::Infinity>(),
                                    R(ball) * (next.w - c.w).lpNorm<Eigen::Infinity>());
        const double allowed = c.error + same_speed(c.speeds(R(ball)), ball) +
                               (c.held ? kHeldJump + kHeldShare * c.speeds(R(ball)) : 0.0);
        if (off > allowed)
            report("U5", "{} leaves a residual of {:.3g} m/s in the motion of ball {} (allowed: {:.3g} m/s)",
                   c.last != nullptr ? name(c.last->type) : "the end of a motion", off, id(ball), allowed);
    }

    void check_pocketed(std::size_t ball) {
        const Event* last = changed_[ball].last;
        const Segment& s = after(ball);
        if (last == nullptr || last->type != EventType::kBallPocket)
            return report("U6", "ball {} is pocketed at {:.17g} s without an event", id(ball), now_);
        const Pocket& pocket = record_.table.pockets[static_cast<std::size_t>(last->b)];
        if ((s.r - Vec3(pocket.center.x(), pocket.center.y(), -pocket.depth)).norm() > kSamePlace)
            report("U6", "ball {} does not lie in pocket {}", id(ball), pocket.id);
    }

    void check_colliding(std::size_t ball) {
        const Segment &s = after(ball), &next = *(&s + 1);
        if (changed_[ball].last == nullptr || changed_[ball].last->type != EventType::kBallCluster)
            report("U6", "ball {} collides at {:.17g} s without a cluster", id(ball), now_);
        if (R(ball) * (s.w - next.w).norm() > same_speed(length3(next.v) + R(ball) * length3(next.w), ball))
            report("U6", "the spin of ball {} changes at the end of a cluster", id(ball));
    }

    bool has_part(const Contact& c) const {
        const Geometry& g = plan_.geometry;
        const std::size_t parts = c.with == With::kNose      ? g.noses.size()
                                  : c.with == With::kCushion ? g.cushions.size()
                                  : c.with == With::kPocket  ? g.pockets.size()
                                                             : record_.tracks.size();
        return c.other < 0 || static_cast<std::size_t>(c.other) < parts;
    }

    // @return whether the event names balls whose motion changes now, and a part of the table
    bool involve(const Event& e) {
        const auto n = record_.tracks.size();
        std::vector<std::size_t> balls{static_cast<std::size_t>(e.a)};
        const auto partner = kind(e.type).partner;
        if (partner == Partner::kBall) balls.push_back(static_cast<std::size_t>(e.b));
        if (e.type == EventType::kBallCluster) {
            if (e.detail < 0 || static_cast<std::size_t>(e.detail) >= record_.clusters.size()) {
                report("U6", "the balls of the cluster are missing");
                return false;
            }
            const std::vector<int>& members = record_.clusters[static_cast<std::size_t>(e.detail)].balls;
            for (const int ball : {e.a, e.b})
                if (std::count(members.begin(), members.end(), ball) != 1)
                    report("U6", "the cluster lacks a ball that met another");
            balls.assign(members.begin(), members.end());
        }
        const Contact contact = contact_of(e);
        if (!has_part(contact))
            report("U6", "the event names a part that no ball can reach");
        else if (partner == Partner::kBall && e.a == e.b)
            report("U6", "ball {} meets itself", id(static_cast<std::size_t>(e.a)));
        else if (contact.with == With::kNose &&
                 event_partner(contact, plan_.geometry, planar(changed_[balls[0]].at.position)) != e.b)
            report("U6", "the event names another nose than its part");
        for (const std::size_t ball : balls) {
            if (found_) break;
            if (ball >= n || !is_changed(ball)) {
                report("U6", "the event changes no motion of ball {}", ball < n ? id(ball) : "?");
                break;
            }
            ++changed_[ball].events;
            changed_[ball].last = &e;
        }
        return !found_;
    }

    void apply() {
        const Event& e = record_.events[event_];
        if (!involve(e)) return;
        const auto a = static_cast<std::size_t>(e.a);
        switch (e.type) {
            case EventType::kCueStrike:
                cue_strike(a);
                break;
            case EventType::kBallBall:
                pair(e);
                break;
            case EventType::kBallCluster:
                cluster(e);
                break;
            case EventType::kBallCushion:
            case EventType::kBallJaw:
                cushion(a);
                return;
            case EventType::kBallCloth:
                cloth(a);
                break;
            case EventType::kBallPocket:
                pocket(a, plan_.geometry.pockets[e.b]);
                step(a, event_ + 1);
                break;
            case EventType::kBallEdge:
                edge(a, plan_.geometry.pockets[e.b]);
                step(a, event_ + 1);
                break;
            case EventType::kSlideRoll:
            case EventType::kRollSpin:
            case EventType::kRollStop:
            case EventType::kSpinStop:
                transition(e, a);
                step(a, event_ + 1);
                break;
            case EventType::kBallBallHold:
            case EventType::kBallCushionHold:
            case EventType::kBallJawHold:
                hold(e);
                break;
            case EventType::kBallBallRelease:
            case EventType::kBallCushionRelease:
            case EventType::kBallJawRelease:
                release(e);
                break;
            case EventType::kBallOut:
                step(a, event_ + 1);
                break;
        }
        ++event_;
    }

    void hold(const Event& e) {
        const Contact c = contact_of(e);
        const auto ball = static_cast<std::size_t>(c.ball);
        const double gap = c.with == With::kBall
                               ? gap_between(seen(ball), seen(static_cast<std::size_t>(c.other)))
                               : touch_part(plan_.geometry, c, body(ball, true)).gap;
        if (meets(ball, record_.partner_id(e), gap, 0.0, kNever)) resting_.push_back(c);
    }

    void release(const Event& e) {
        const auto it = std::find_if(resting_.begin(), resting_.end(),
                                     [&](const Contact& c) { return c.same(contact_of(e)); });
        if (it == resting_.end())
            return report("U6", "a resting contact of ball {} ends that did not begin", track(e.a).id);
        resting_.erase(it);
    }

    void cue_strike(std::size_t ball) {
        const std::optional<Cue>& cue = plan_.scene.cue;
        Changed& c = changed_[ball];
        if (!c.begins || !cue || cue->ball != id(ball))
            return report("U6", "the scene has no strike of ball {} at {:.17g} s", id(ball), now_);
        const StruckBall struck = strike(*cue, plan_.sizes[ball], plan_.in_force(Effect::kSquirt),
                                         flights() ? Vertical::kKeep : Vertical::kDrop);
        free(ball, struck.v, struck.w);
        step(ball, event_ + 1);
    }

    void transition(const Event& e, std::size_t ball) {
        const Segment &s = before(ball), &next = track(ball).segments[changed_[ball].before + 1];
        if (changed_[ball].events > 1 || s.state == MotionState::kColliding) return;
        if (std::abs(s.start + s.duration - now_) > same_time(now_))
            report("U6", "the state of ball {} changes at {:.17g} s, not at {:.17g} s", id(ball), now_,
                   s.start + s.duration);
        if (!is_off_cloth(s.state) && transition_type(s, next) != e.type)
            report("U6", "ball {} was {} and is {} after {}", id(ball), name(s.state), name(next.state),
                   name(e.type));
    }

    BallAt body(std::size_t ball, bool level) const {
        const Placed& at = changed_[ball].at;
        if (!level) return {at.position, at.velocity, R(ball), true};
        return {Vec3(at.position.x(), at.position.y(), 0.0), Vec3(at.velocity.x(), at.velocity.y(), 0.0),
                R(ball)};
    }
    bool falls(std::size_t ball) const { return before(ball).state == MotionState::kFalling; }
    SeenBall seen(std::size_t ball) const {
        const Changed& c = changed_[ball];
        SeenBall seen = see(record_, ball, c.before, c.at.position, 0.0, flights());
        seen.flies = c.flies;
        return seen;
    }
    // A ball on the cloth rises only if it is fast enough.
    void free(std::size_t ball, const Vec3& v, const Vec3& w) {
        Changed& c = changed_[ball];
        c.at.velocity = v;
        c.w = w;
        c.flies = !falls(ball) && flights() &&
                  (c.at.position.z() > R(ball) || v.z() >= bounce_end(R(ball), record_.gravity));
        if (!c.flies && !falls(ball)) c.at.velocity.z() = std::min(v.z(), 0.0);
    }

    /// Whether a ball touches something and approaches it, within the errors of their motion.
    bool meets(std::size_t ball, const std::string& other, double gap, double closing, double error) {
        const Changed& c = changed_[ball];
        if (gap > 2.0 * same_place(ball))
            report("U6", "ball {} does not touch {}: there are {:.3g} m between them", id(ball), other, gap);
        else if (!c.loose && !(closing > -error))
            report("U6", "ball {} does not approach {}, but leaves it at {:.3g} m/s", id(ball), other,
                   -closing);
        return !found_;
    }

    void pair(const Event& e) {
        const auto a = static_cast<std::size_t>(e.a), b = static_cast<std::size_t>(e.b);
        Changed &p = changed_[a], &q = changed_[b];
        p.loose = q.loose = p.loose || q.loose;
        const SeenBall one = seen(a), two = seen(b);
        const bool space = in_space(one, two), free_bodies = flights() && (plan_.ball_ball->free || space);
        const bool level = !free_bodies || (!space && (falls(a) || falls(b)));
        BallAt ball1 = body(a, level), ball2 = body(b, level);
        const Touch met =
            free_bodies ? touch_ball(ball1, ball2) : touch_level(ball1, ball2, plan_.balls.discs());
        const double noise = kSameShare * (p.speeds(R(a)) + q.speeds(R(b)));
        if (!meets(a, "ball " + id(b), gap_between(one, two), met.closing, noise)) return;
        const bool to_tolerance = model_.reads_tolerance && !free_bodies && plan_.impact.march == nullptr;
        const double error = to_tolerance ? plan_.scene.physics.tolerance * met.closing : 0.0;
        Velocities m1{ball1.v, p.w}, m2{ball2.v, q.w};
        const BallSize &size1 = plan_.sizes[a], &size2 = plan_.sizes[b];
        if (free_bodies) {
            FreePair bodies{size1, size2, plan_.ball_ball->friction(plan_.balls), plan_.e_b()};
            const double parting = parting_speed(std::max(R(a), R(b)), plan_.gravity);
            const auto e_b = restitution_in_air(bodies.e_b, met.closing, parting);
            bodies.e_b = e_b.value_or(0.0);
            const auto lies = [&](std::size_t ball) {
                return !changed_[ball].flies && !(space && falls(ball));
            };
            if (e_b)
                hit_ball(bodies, met.n, m1, m2);
            else
                part_slowly(bodies, met.n, {lies(a), lies(b)}, plan_.gravity, m1, m2);
        } else {
            hit_again(a, b, error, m1, m2);
        }
        for (const auto& [ball, m] : {std::pair{a, &m1}, std::pair{b, &m2}}) {
            // The cloth carries both, or the fall of one continues.
            if (level && (falls(ball) || !free_bodies)) m->v.z() = changed_[ball].at.velocity.z();
            free(ball, m->v, m->w);
        }
        // The solver for unlike balls errs by up to 14 tolerances (docs/design/impact_kernel.md).
        p.error = q.error = (size1 == size2 ? 2.0 : 14.0) * error;
        step(a, event_ + 1);
        step(b, event_ + 1);
    }

    // Computes the impact of two balls on the cloth again, with the normal of collide(); no other place does.
    // Where the two solvers disagree (the one for unlike balls erred by up to six tolerances, in 8 of 20 000
    // random scenes), the solver of the loop decides, with a tenth of the tolerance.
    void hit_again(std::size_t a, std::size_t b, double error, Velocities& m1, Velocities& m2) const {
        if (comes_first(body(b, true).r, body(a, true).r)) return hit_again(b, a, error, m2, m1);
        BallBallSettings settings = plan_.impact;
        settings.tolerance = std::max(kernel::kTightestTolerance, 0.1 * settings.tolerance);
        const auto solve = [&](const BallBallModelInfo& model, Velocities& v1, Velocities& v2) {
            const auto hit = [&](bool contact_time) {
                Velocities one = v1, two = v2;
                const PairImpact impact =
                    collide({model, settings, plan_.balls, contact_time}, plan_.sizes[a], plan_.sizes[b],
                            body(a, true).r, body(b, true).r + Vec3(0.0, 0.0, R(b) - R(a)), one, two);
                if (impact.grazes) return false;
                v1 = one;
                v2 = two;
                return true;
            };
            if (!hit(plan_.contact_time)) hit(false);
        };
        Velocities other1 = m1, other2 = m2;
        solve(model_, m1, m2);
        solve(*plan_.ball_ball, other1, other2);
        const double apart =
            (m1.v - other1.v).norm() + R(a) * (m1.w - other1.w).norm() + R(b) * (m2.w - other2.w).norm();
        if (apart > error) m1 = other1, m2 = other2;
    }

    void cushion(std::size_t ball) {
        Changed& c = changed_[ball];
        std::vector<NoseTouch> touches;
        const bool in_air = c.flies;
        const double noise = closing_noise(R(ball), {c.at.velocity, c.w});
        for (;; involve(record_.events[event_])) {
            const Event& e = record_.events[event_];
            const Contact contact = contact_of(e);
            const BallAt at = body(ball, !in_air);
            const Touch met = touch_part(plan_.geometry, contact, at);
            const CushionModelInfo& model = plan_.model_of(partner_of(contact, plan_.geometry));
            double gap = met.gap;
            if (contact.with == With::kNose && !beside(plan_.geometry.noses[contact.other], at, kSamePlace))
                gap = kNever;
            if (contact.with == With::kCushion) {
                const CushionLine& line = plan_.geometry.cushions[contact.other];
                const double foot = in_frame(line, planar(at.r) - line.from).x();
                gap = std::max({gap, -foot, foot - line.length});
            }
            if (!meets(ball, record_.partner_id(e), gap, met.closing, noise)) return;
            ++event_;
            if (in_air) {
                Velocities m{c.at.velocity, c.w};
                hit_nose(plan_.balls, R(ball), model, -met.n, parting_speed(R(ball), plan_.gravity), m);
                free(ball, m.v, m.w);
                return step(ball, event_);
            }
            const double height =
                with_nose(plan_.geometry, contact, [](const auto& nose) { return nose.height; });
            touches.push_back({-planar(met.n), height, &model});
            // Other parts that it touches and approaches belong to the same bounce, unless they are one.
            if (event_ == last_ || kind(record_.events[event_].type).phase != EventPhase::kImpact) break;
            const Contact next = contact_of(record_.events[event_]);
            if (next.ball != contact.ball || !next.is_nose() || !has_part(next) ||
                !touches_part(plan_.geometry, next, at))
                break;
            const Touch another = touch_part(plan_.geometry, next, at);
            if (!(another.closing > noise) ||
                std::any_of(touches.begin(), touches.end(),
                            [&](const NoseTouch& t) { return act_as_one(-t.normal, planar(another.n)); }))
                break;
        }
        Velocities m{body(ball, true).v, c.w};
        if (!bounce(plan_.balls, plan_.sizes[ball], touches,
                    flights() && !falls(ball) ? std::optional(record_.gravity) : std::nullopt,
                    plan_.impact.tolerance, m))
            return;
        if (falls(ball)) m.v.z() = c.at.velocity.z();
        free(ball, m.v, m.w);
        step(ball, event_);
    }

    void cloth(std::size_t ball) {
        Changed& c = changed_[ball];
        if (c.events == 1 && flies(before(ball).state)) {
            if (std::abs(c.at.position.z() - R(ball)) > same_place(ball))
                return report("U6", "ball {} lands {:.3g} m above the cloth", id(ball),
                              c.at.position.z() - R(ball));
            c.at.velocity = landing_velocity(before(ball), plan_.motion[ball]);
            c.at.position.z() = R(ball);
        }
        Velocities m{c.at.velocity, c.w};
        if (!c.loose && !(m.v.z() < 0.0))
            return report("U6", "ball {} does not come down on the cloth at {:.17g} s", id(ball), now_);
        if (m.v.z() < 0.0) hit_cloth(plan_.balls, plan_.motion[ball], m);
        free(ball, m.v, m.w);
        step(ball, event_ + 1);
    }

    void pocket(std::size_t ball, const Pocket& pocket) {
        const double beyond = -touch_part(pocket, body(ball, true)).gap;
        const bool at_once = plan_.scene.physics.pocket == PocketModel::kAtOnce || record_.gravity == 0.0;
        // A resting ball that passes the edge is pushed in as soon as it touches something again.
        const Changed& c = changed_[ball];
        const bool pushed =
            c.held && c.after > c.before && track(ball).segments[c.after - 1].state == MotionState::kFalling;
        if (beyond > same_place(ball))
            report("U6", "ball {} is {:.3g} m beside pocket {}", id(ball), beyond, pocket.id);
        else if (!(at_once || falls(ball) || pushed || changed_[ball].flies || flies(before(ball).state)))
            report("U6", "ball {} does not fall into pocket {}", id(ball), pocket.id);
    }

    void edge(std::size_t ball, const Pocket& pocket) {
        Changed& c = changed_[ball];
        const Touch met = touch_part(pocket, body(ball, true));
        // A ball may begin inside, or a cluster may carry it there.
        const bool inside = now_ == 0.0 || before(ball).state == MotionState::kColliding;
        if (-met.gap > same_place(ball) || (!inside && met.gap > same_place(ball)))
            return report("U6", "ball {} is {:.3g} m from the edge of pocket {}", id(ball), -met.gap,
                          pocket.id);
        if (!falls(ball)) {
            if (after(ball).state != MotionState::kFalling && !is_gone(after(ball).state))
                report("U6", "ball {} passes the edge of pocket {} and does not fall", id(ball), pocket.id);
            return;
        }
        const double v_n = met.closing, sunk = (R(ball) - c.at.position.z()) / R(ball);
        const auto away = climbs(v_n, std::max(0.0, sunk), R(ball), record_.gravity);
        if (!away) return report("U6", "ball {} comes out of pocket {} too slowly", id(ball), pocket.id);
        c.at.velocity.head<2>() += (*away - v_n) * planar(met.n);
        if (sunk < 0.0) return;
        c.at.velocity.z() = 0.0;
        c.at.position.z() = R(ball);
    }

    void cluster(const Event& e) {
        const std::vector<int>& members = record_.clusters[static_cast<std::size_t>(e.detail)].balls;
        const auto a = static_cast<std::size_t>(e.a), b = static_cast<std::size_t>(e.b);
        if (!meets(a, "ball " + id(b), gap_between(seen(a), seen(b)), 0.0, kNever)) return;
        const double closing = touch_ball(body(a, false), body(b, false)).closing;
        std::vector<ClusterMove> moves;
        double lasts = -1.0;
        bool known = true;
        const bool calm = std::none_of(members.begin(), members.end(),
                                       [this](int m) { return changed_[static_cast<std::size_t>(m)].held; });
        for (const int member : members) {
            const auto ball = static_cast<std::size_t>(member);
            Changed& c = changed_[ball];
            const std::vector<Segment>& segments = track(ball).segments;
            std::size_t k = std::min(c.next + 1, c.after);
            // A contact in which it rested has ended, which began another motion.
            while (c.held && k < c.after && segments[k].state != MotionState::kColliding) ++k;
            const Segment& s = segments[k];
            const bool collides = s.state == MotionState::kColliding;
            const double duration = collides ? s.duration : 0.0;
            if (lasts >= 0.0 && duration != lasts && calm)
                return report("U6", "the balls of a cluster collide for {:.3g} and {:.3g} s", lasts,
                              duration);
            // Among the motions of a group that begin now, this one may be another's.
            known = known && (lasts < 0.0 || duration == lasts);
            lasts = duration;
            const Placed end = placed_at(collides ? segments[k + 1] : s, 0.0, record_.gravity);
            const bool level = c.at.position.z() == R(ball) && end.velocity.z() == 0.0 &&
                               (!collides || end.position.z() == R(ball));
            known = known && level && !c.loose && !s.held && !rests(ball) && !before(ball).held &&
                    before(ball).state != MotionState::kFalling;
            moves.push_back({member, c.at, end, R(ball) * length3(c.w)});
            c.loose = true;
        }
        for (const int member : members) step(static_cast<std::size_t>(member), event_ + 1);
        const double time = lasts > 0.0 ? lasts : kInstant * contact_time(closing);
        if (const auto fault = verify_hits(record_, plan_, e, moves, lasts, time, known))
            report(fault->law, "{}", fault->message);
    }

    const Record& record_;
    const Plan& plan_;
    const BallBallModelInfo model_;
    std::vector<Changed> changed_;
    std::vector<Contact> resting_;
    std::vector<std::pair<double, std::size_t>> begun_;  // when segments begin, and of which ball
    std::size_t event_ = 0, first_ = 0, last_ = 0;       // first_ to last_ - 1 are of this instant
    bool calm_ = true;                                   // nothing but transitions happens
    double now_ = 0.0;
    std::optional<Violation> found_;
};

}  // namespace

std::optional<Violation> verify_events(const Record& record, const Plan& plan) {
    return Events(record, plan).run();
}

}  // namespace carom
