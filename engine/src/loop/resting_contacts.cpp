#include "loop/resting_contacts.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "carom/engine/tolerances.h"
#include "contact/contact.h"
#include "contact/resting_constants.h"
#include "contact/touch.h"
#include "physics/motion.h"

namespace carom {

namespace {

bool lies(MotionState state) {
    return !flies(state) && !is_gone(state) && state != MotionState::kFalling;
}

// Uses products, because logarithms differ between libraries in the last bits.
int most_bounces(double restitution) {
    int bounces = 0;
    for (double left = restitution; left >= resting::kSpeedLeft && bounces < resting::kMostBounces;
         left *= restitution)
        ++bounces;
    return std::max(resting::kFewestBounces, bounces);
}

bool touches(const RestingContact& c, int ball) {
    return c.contact.ball == ball || c.contact.partner() == ball;
}

}  // namespace

RestingContacts::RestingContacts(const Plan& plan, const Balls& balls, Log& log, RestingMemory& memory)
    : Borrowed(memory), plan_(plan), balls_(balls), log_(log), lossless_(loses_nothing(plan)) {
    contacts_.clear();
    struck_.clear();
    struck_.reserve(std::min<std::size_t>(plan.sizes.size(), resting::kMostStruck));
    bounces_.clear();
    bounces_.reserve(resting::kBouncesKept);
    next_bounce_ = 0;
}

void RestingContacts::note(const Bounce& bounce) {
    if (bounces_.size() < resting::kBouncesKept) {
        bounces_.push_back(bounce);
        return;
    }
    bounces_[next_bounce_] = bounce;
    next_bounce_ = (next_bounce_ + 1) % resting::kBouncesKept;
}

// Whether the closing speed of a contact has fallen since this bounce. Assumes that it has if the bounce is
// no longer stored.
bool RestingContacts::has_fallen(const Event& from, const Contact& contact, double v_n) const {
    for (std::size_t k = 0; k < bounces_.size(); ++k) {
        const Bounce& b = bounces_[(next_bounce_ + k) % bounces_.size()];
        if (b.time == from.time && b.contact.same(contact)) return v_n <= resting::kNotFallen * b.v_n;
    }
    return true;
}

bool RestingContacts::find(const Contact& contact) const {
    return std::any_of(contacts_.begin(), contacts_.end(),
                       [&](const RestingContact& c) { return c.contact.same(contact); });
}

// Whether the closing speed of a contact may be discarded: a lossless bounce continues.
bool RestingContacts::may_lose(const Meeting& met) const {
    if (!lossless_) return true;
    double speeds = length(planar(met.ball.v));
    if (met.contact.partner() >= 0) speeds += length(planar(met.other.v));
    return met.touch.closing <= resting::kLosslessShare * speeds;
}

// A contact becomes a resting contact if
//   - the rebound would be shorter than the Hertz contact time (holds()). The acceleration is that of the
//     contact or, if a ball is already in a resting contact, the one that friction alone could cause. Each
//     bounce within a group loses a fraction of its speed, so bouncing down to rounding would need ten times
//     as many for every power of ten; their limit is the resting contact, which the group's solution keeps or
//     opens.
//   - or it has chattered (Zeno behaviour), as in a wedge with a plastic side, or when an impact travels back
//     and forth through balls that rest on each other between two rails. The limit is again the resting
//     contact. Elastic bounces count only if the closing speed has in fact fallen.
bool RestingContacts::try_begin(const Meeting& met, double restitution) {
    const Contact& c = met.contact;
    const int partner = c.partner();
    const double v_n = met.touch.closing;
    if (is_gone(balls_.segment(c.ball).state)) return false;
    note({balls_.now(), c, v_n});
    const bool rests = balls_.segment(c.ball).held || (partner >= 0 && balls_.segment(partner).held);
    const double pressing = rests ? std::max(met.pressing, 2.0 * balls_.motion(c.ball).slide) : met.pressing;
    if (!(holds(v_n, pressing, restitution) && may_lose(met)) && !chatters(c, v_n)) return false;
    // A ball that is pushed while it falls does not come back.
    bool falls = false;
    for (const int ball : {c.ball, partner}) {
        if (ball < 0 || balls_.segment(ball).state != MotionState::kFalling) continue;
        log_.fall(ball, pocket_under(plan_.geometry, planar(balls_.position(ball))));
        falls = true;
    }
    if (falls) return true;
    contacts_.push_back({.contact = c, .n = planar(met.touch.n), .began = balls_.now()});
    log_.event(EventPhase::kHold, c);
    return true;
}

bool RestingContacts::in_contact(int ball) const {
    return std::any_of(contacts_.begin(), contacts_.end(),
                       [ball](const RestingContact& c) { return touches(c, ball); });
}

void RestingContacts::start(int ball) {
    // A ball that fell into a pocket has no contact to start.
    if (in_contact(ball)) solve(ball, Transitions::kNotYet);
}

bool RestingContacts::chatters(const Contact& contact, double v_n) const {
    // Lossless bounces continue; only those without duration must end.
    const double since = lossless_ ? balls_.now() : balls_.now() - resting::kChatterSpan;
    const double restitution = contact.with == With::kBall ? plan_.balls.e_b : plan_.balls.e_c;
    int bounces = 0;
    const std::vector<Event>& events = log_.events();
    for (std::size_t k = events.size(); k-- > 0;) {
        const Event& e = events[k];
        if (e.time < since) break;
        const EventPhase phase = kind(e.type).phase;
        if (phase != EventPhase::kImpact && phase != EventPhase::kHold) continue;
        if (!contact_of(e).same(contact)) continue;
        bounces += phase == EventPhase::kHold || e.type == EventType::kBallCluster ? resting::kManyAtOnce : 1;
        // Computed late, because most impacts have no bounces before them.
        if (bounces >= resting::kFewestBounces && bounces >= most_bounces(restitution))
            return restitution < 1.0 || e.time == balls_.now() || has_fallen(e, contact, v_n);
    }
    return false;
}

void RestingContacts::end(const RestingContact& c) {
    log_.event(EventPhase::kRelease, c.contact);
}

void RestingContacts::begin_free(int ball) {
    const BallAt at = balls_.at(ball);
    log_.begin(ball, balls_.after_impact(ball, at.r, {at.v, balls_.spin(ball)}));
}

void RestingContacts::release(int ball) {
    if (!balls_.segment(ball).held) return;
    const auto kept = std::stable_partition(contacts_.begin(), contacts_.end(),
                                            [ball](const RestingContact& c) { return !touches(c, ball); });
    std::vector<RestingContact> ended(kept, contacts_.end());
    contacts_.erase(kept, contacts_.end());
    sort_by_place(ended);
    for (const RestingContact& c : ended) end(c);
    // From here the ball has a free segment, which the caller replaces.
    begin_free(ball);
    for (const RestingContact& c : ended) {
        const int partner = c.contact.ball == ball ? c.contact.partner() : c.contact.ball;
        if (partner >= 0 && balls_.segment(partner).held) solve(partner, Transitions::kNotYet);
    }
}

const RestingContacts::Struck* RestingContacts::find_struck(int ball) const {
    const auto it =
        std::find_if(struck_.begin(), struck_.end(), [ball](const Struck& s) { return s.ball == ball; });
    return it != struck_.end() ? &*it : nullptr;
}

// Whether a contact continues after an impact of its balls.
bool RestingContacts::goes_on(RestingContact& c) const {
    const int i = c.contact.ball, j = c.contact.partner();
    const Struck *const si = find_struck(i), *const sj = j >= 0 ? find_struck(j) : nullptr;
    if (si == nullptr && sj == nullptr) return true;
    if ((si != nullptr && !lies(si->segment.state)) || (sj != nullptr && !lies(sj->segment.state)))
        return false;
    refresh_normal(c);
    const Vec2 vi = planar(si != nullptr ? si->segment.v : balls_.velocity(i));
    const Vec2 vj = j < 0 ? Vec2(Vec2::Zero()) : planar(sj != nullptr ? sj->segment.v : balls_.velocity(j));
    const double rate = dot(c.n, vj - vi), e = j >= 0 ? plan_.balls.e_b : plan_.balls.e_c;
    return holds(std::abs(rate), 2.0 * balls_.motion(i).slide, e) ||
           (rate < 0.0 && chatters(c.contact, -rate));
}

void RestingContacts::go_on() {
    const bool any_held = std::any_of(struck_.begin(), struck_.end(),
                                      [this](const Struck& s) { return balls_.segment(s.ball).held; });
    std::vector<RestingContact> ended;
    std::vector<int> unsolved;
    if (any_held) {
        const auto kept = std::stable_partition(contacts_.begin(), contacts_.end(),
                                                [this](RestingContact& c) { return goes_on(c); });
        ended.assign(kept, contacts_.end());
        contacts_.erase(kept, contacts_.end());
        sort_by_place(ended);
        for (const RestingContact& c : ended) end(c);
        for (const Struck& s : struck_) unsolved.push_back(s.ball);
        for (const RestingContact& c : ended)
            for (const int ball : {c.contact.ball, c.contact.partner()})
                if (ball >= 0 && balls_.segment(ball).held && find_struck(ball) == nullptr)
                    unsolved.push_back(ball);
    }
    const std::vector<int>& touched = log_.touched();
    const auto before = static_cast<std::ptrdiff_t>(touched.size());
    for (const Struck& s : struck_) log_.begin(s.ball, s.segment);
    struck_.clear();
    for (const int ball : unsolved) {
        // The group of another ball may already have solved this one.
        const bool is_new = std::find(touched.begin() + before, touched.end(), ball) != touched.end();
        if (is_new && balls_.segment(ball).held) continue;
        if (in_contact(ball))
            solve(ball, Transitions::kNotYet);
        else if (!is_new)
            begin_free(ball);
    }
}

void RestingContacts::advance(int ball) {
    solve(ball, Transitions::kDue);
}

bool RestingContacts::has_come_to_transition(const Segment& s) const {
    return s.held && s.ends && s.start + s.duration <= balls_.now();
}

// Removes from the list the contacts of this ball's group, all balls connected to it by resting contacts.
// Returns the group in its present state.
RestingGroup RestingContacts::group_of(int ball, Transitions transitions) {
    std::vector<int> members{ball};
    const auto is_member = [&](int b) {
        return std::find(members.begin(), members.end(), b) != members.end();
    };
    for (std::size_t k = 0; k < members.size(); ++k) {
        for (const RestingContact& c : contacts_) {
            if (!touches(c, members[k])) continue;
            const int other = c.contact.ball == members[k] ? c.contact.partner() : c.contact.ball;
            if (other >= 0 && !is_member(other)) members.push_back(other);
        }
    }
    RestingGroup group;
    double lightest = plan_.sizes[ball].m;
    for (const int b : members) lightest = std::min(lightest, plan_.sizes[b].m);
    for (const int b : members) {
        RestingBall member{b,  balls_.position(b), balls_.velocity(b),         balls_.spin(b),
                           {}, &balls_.motion(b),  plan_.sizes[b].m / lightest};
        const Segment& s = balls_.segment(b);
        if (transitions == Transitions::kDue && has_come_to_transition(s))
            end_transition(member, s.state, balls_.radius(b));
        if (s.held) group.last = std::min(group.last, s.duration);
        group.balls.push_back(member);
    }
    std::sort(group.balls.begin(), group.balls.end(), [](const RestingBall& p, const RestingBall& q) {
        return before_place(planar(p.r), planar(q.r));
    });
    const auto others =
        std::stable_partition(contacts_.begin(), contacts_.end(),
                              [&](const RestingContact& c) { return !is_member(c.contact.ball); });
    group.contacts.assign(others, contacts_.end());
    contacts_.erase(others, contacts_.end());
    for (RestingContact& c : group.contacts) refresh_normal(c);
    sort_by_place(group.contacts);
    return group;
}

// Solves the group of the ball again from now.
void RestingContacts::solve(int ball, Transitions transitions) {
    log_.note_long_round();
    RestingGroup group = group_of(ball, transitions);
    bool any_released = release_past_ends(group);
    solve_resting(group,
                  {plan_.geometry, plan_.balls, plan_.gravity,
                   std::clamp(plan_.impact.tolerance / kDefaultTolerance, 1e-4, 1.0)},
                  balls_.now());
    if (transitions == Transitions::kDue) log_transitions(group);
    for (const RestingContact& c : group.contacts) {
        if (c.released) {
            end(c);
            any_released = true;
        } else {
            contacts_.push_back(c);
        }
    }
    for (const RestingBall& member : group.balls) log_.begin(member.ball, member.segment);
    if (!any_released) return;
    // After a release, a ball without resting contacts is free; the others form smaller groups.
    for (const RestingBall& m : group.balls)
        if (!in_contact(m.ball)) log_.begin(m.ball, balls_.after_impact(m.ball, m.r, {m.v, m.w}));
}

// Logs only transitions that really happened: a ball that the group drives on at once has not stopped, and a
// ball that keeps sliding has no event.
void RestingContacts::log_transitions(const RestingGroup& group) {
    for (const RestingBall& member : group.balls) {
        const Segment& s = balls_.segment(member.ball);
        if (!has_come_to_transition(s)) continue;
        const bool goes_on = member.segment.state == s.state ||
                             (s.state == MotionState::kRolling && translates(member.segment.state));
        if (!goes_on) log_.event(transition_type(s, member.segment), member.ball);
    }
}

// A ball moving past the end of its cushion leaves it once the remaining time is below the clock's
// resolution.
bool RestingContacts::release_past_ends(RestingGroup& group) {
    return std::erase_if(group.contacts, [this](const RestingContact& c) {
               const int ball = c.contact.ball;
               const double left =
                   time_past_end(plan_.geometry, c.contact,
                                 {planar(balls_.position(ball)), planar(balls_.velocity(ball)),
                                  balls_.segment(ball).a, kNever, false, true});
               if (balls_.now() + left > balls_.now()) return false;
               end(c);
               return true;
           }) > 0;
}

// Sorts contacts by position on the table, independent of ids and of the order in which they began.
void RestingContacts::sort_by_place(std::vector<RestingContact>& contacts) const {
    const auto place_of = [this](const RestingContact& c) {
        return Vec2(planar(balls_.position(c.contact.ball)) + balls_.radius(c.contact.ball) * c.n);
    };
    std::sort(contacts.begin(), contacts.end(), [&](const RestingContact& p, const RestingContact& q) {
        return before_place(place_of(p), place_of(q));
    });
}

void RestingContacts::refresh_normal(RestingContact& c) const {
    c.n = planar(balls_.meet(c.contact).touch.n);
}

}  // namespace carom
