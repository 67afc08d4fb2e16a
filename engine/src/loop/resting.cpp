// Sustained contacts of a run: entry, groups, end.
#include <algorithm>
#include <vector>

#include "carom/engine/tolerances.h"
#include "loop/shot.h"

namespace carom {

namespace {

// [-] A contact that has bounced this often within one such span is held. A row of 15 elastic balls taken
// pair by pair needs 30, the last bounces before a ball is held, about 100.
constexpr int kRattle = 200;

}  // namespace

bool Shot::held_together(int a, int b) const {
    if (held_.empty() || !is_held(a) || !is_held(b)) return false;
    return std::any_of(held_.begin(), held_.end(), [&](const HeldContact& c) {
        return c.j >= 0 && ((c.i == a && c.j == b) || (c.i == b && c.j == a));
    });
}

bool Shot::held_to(int ball, int cushion, int nose) const {
    if (held_.empty() || !is_held(ball)) return false;
    return std::any_of(held_.begin(), held_.end(), [&](const HeldContact& c) {
        return c.j < 0 && c.i == ball && c.cushion == cushion && c.nose == nose;
    });
}

// Captures the contact if a bounce would be over before the contact itself is; if a held ball closes by no
// more than the rounding of the velocities that hold; or if the same contact has bounced again and again in no
// time, as in a wedge whose sides take the speed out of each other: the limit of such a row is the capture.
bool Shot::hold_instead(const HeldContact& contact, double v_n, double a_c, double restitution) {
    const bool rounding =
        (is_held(contact.i) || (contact.j >= 0 && is_held(contact.j))) && v_n <= rounding_of_held(contact);
    if (!rounding && !holds(v_n, a_c, restitution) && !rattles(contact)) return false;
    if (contact.j >= 0 && !plan_.alike)
        fail(
            "two balls meet so slowly that they stay in contact, and there are balls of different size: that "
            "contact is not modelled; make the balls alike");
    held_.push_back(contact);
    record_event(contact.hold_type(), contact.i, contact.partner, contact.nose);
    solve_group(contact.i, Transitions::kNotYet);
    return true;
}

// Read from the record, so that a run that is taken up decides alike.
bool Shot::rattles(const HeldContact& contact) const {
    int hits = 0;
    for (std::size_t k = record_.events.size(); k-- > 0;) {
        const Event& e = record_.events[k];
        if (e.time < now_ - kEventCapSpan) break;
        const bool balls = e.type == EventType::kBallBall || e.type == EventType::kBallCluster ||
                           e.type == EventType::kBallBallHold;
        const bool table = e.type == EventType::kBallCushion || e.type == EventType::kBallJaw ||
                           e.type == EventType::kBallCushionHold || e.type == EventType::kBallJawHold;
        const bool same =
            contact.j >= 0
                ? balls && ((e.a == contact.i && e.b == contact.j) || (e.a == contact.j && e.b == contact.i))
                : table && e.a == contact.i && e.b == contact.partner && e.detail == contact.nose;
        if (same && ++hits >= kRattle) return true;
    }
    return false;
}

double Shot::rounding_of_held(const HeldContact& contact) const {
    const auto of = [this](int ball) {
        return held_noise(velocity_now(ball), spin_now(ball), motion_of(ball));
    };
    double noise = of(contact.i);
    if (contact.j >= 0) noise = std::max(noise, of(contact.j));
    for (const HeldContact& c : held_) {
        noise = std::max(noise, of(c.i));
        if (c.j >= 0) noise = std::max(noise, of(c.j));
    }
    return noise;
}

// Ends all sustained contacts of a ball that something else happens to; its partners go on without it.
void Shot::free_ball(int ball) {
    if (!is_held(ball)) return;
    std::vector<HeldContact> ended;
    for (const HeldContact& c : held_) {
        if (c.i == ball || c.j == ball) ended.push_back(c);
    }
    std::erase_if(held_, [ball](const HeldContact& c) { return c.i == ball || c.j == ball; });
    sort_by_place(ended);
    std::vector<int> partners;
    for (const HeldContact& c : ended) {
        record_event(c.release_type(), c.i, c.partner, c.nose);
        if (c.j >= 0) partners.push_back(c.i == ball ? c.j : c.i);
    }
    // From here the ball's own segment counts as free; the caller replaces it.
    begin(ball, start_segment(now_, position_now(ball), velocity_now(ball), spin_now(ball), motion_of(ball)));
    for (const int partner : partners) {
        if (is_held(partner)) solve_group(partner, Transitions::kNotYet);
    }
}

// The group of a held ball, advanced to now and solved anew.
void Shot::solve_group(int ball, Transitions transitions) {
    long_round_ = true;
    HeldGroup group;
    std::vector<int> members{ball};
    for (std::size_t k = 0; k < members.size(); ++k) {
        for (const HeldContact& c : held_) {
            const int other = c.i == members[k] ? c.j : (c.j == members[k] ? c.i : -1);
            if (other >= 0 && std::find(members.begin(), members.end(), other) == members.end())
                members.push_back(other);
        }
    }
    const auto is_member = [&](int b) {
        return std::find(members.begin(), members.end(), b) != members.end();
    };
    for (const int b : members) {
        HeldBall member;
        member.ball = b;
        member.r = position_now(b);
        member.v = velocity_now(b);
        member.w = spin_now(b);
        const Segment& s = now_of(b);
        if (transitions == Transitions::kDue && s.held && s.ends && s.start + s.duration <= now_)
            end_transition(member, s.state, radius(b));
        group.balls.push_back(member);
    }
    const auto left_of = [](const Vec3& p, const Vec3& q) {
        return p.x() < q.x() || (p.x() == q.x() && p.y() < q.y());
    };
    std::sort(group.balls.begin(), group.balls.end(),
              [&](const HeldBall& p, const HeldBall& q) { return left_of(p.r, q.r); });
    for (HeldContact& c : held_) {
        if (!is_member(c.i)) continue;
        refresh_normal(c);
        group.contacts.push_back(c);
    }
    std::erase_if(held_, [&](const HeldContact& c) { return is_member(c.i); });
    sort_by_place(group.contacts);
    bool any_released = release_past_ends(group);
    solve_held(group, {plan_.geometry, plan_.balls, plan_.gravity}, motion_of(ball), now_);
    if (transitions == Transitions::kDue) record_transitions(group);
    for (const HeldContact& c : group.contacts) {
        if (c.released) {
            record_event(c.release_type(), c.i, c.partner, c.nose);
            any_released = true;
        } else {
            held_.push_back(c);
        }
    }
    for (const HeldBall& member : group.balls) begin(member.ball, member.segment);
    // What a release leaves alone is free, or a smaller group of its own.
    if (any_released) {
        for (const HeldBall& member : group.balls) {
            const bool still = std::any_of(held_.begin(), held_.end(), [&](const HeldContact& c) {
                return c.i == member.ball || c.j == member.ball;
            });
            if (!still)
                begin(member.ball, start_segment(now_, member.r, member.v, member.w, motion_of(member.ball)));
        }
    }
}

// What ended, if it did: a ball that the group drives on at once has not stopped, and slips on without an event.
void Shot::record_transitions(const HeldGroup& group) {
    for (const HeldBall& member : group.balls) {
        const Segment& s = now_of(member.ball);
        if (!(s.held && s.ends && s.start + s.duration <= now_)) continue;
        const bool goes_on = member.segment.state == s.state ||
                             (s.state == MotionState::kRolling && translates(member.segment.state));
        if (goes_on) continue;
        record_event(transition_type(s, member.segment), member.ball, -1);
    }
}

// A ball that runs off the end of its cushion lets go of it: when the clock can no longer tell the time to
// the end from 0.
bool Shot::release_past_ends(HeldGroup& group) {
    const std::size_t before = group.contacts.size();
    std::erase_if(group.contacts, [this](const HeldContact& c) {
        if (c.cushion < 0) return false;
        Segment s;
        s.r = position_now(c.i);
        s.v = velocity_now(c.i);
        s.a = now_of(c.i).a;
        if (now_ + time_to_line_end(plan_.geometry.cushions[c.cushion], s) > now_) return false;
        record_event(c.release_type(), c.i, c.partner, c.nose);
        return true;
    });
    return group.contacts.size() < before;
}

// Contacts in the order of their places on the table: never by id, never by when they began.
void Shot::sort_by_place(std::vector<HeldContact>& contacts) const {
    const auto place_of = [this](const HeldContact& c) {
        const Vec3 r = position_now(c.i);
        return Vec2(r.x() + radius(c.i) * c.n.x(), r.y() + radius(c.i) * c.n.y());
    };
    std::sort(contacts.begin(), contacts.end(), [&](const HeldContact& p, const HeldContact& q) {
        const Vec2 a = place_of(p), b = place_of(q);
        return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
    });
}

void Shot::refresh_normal(HeldContact& c) const {
    const Vec3 r = position_now(c.i);
    const Vec2 here(r.x(), r.y());
    Vec2 toward;
    if (c.cushion >= 0) {
        const CushionLine& line = plan_.geometry.cushions[c.cushion];
        c.n = Vec2(-line.direction.y(), line.direction.x());
        if (c.n.dot(here - line.from) > 0.0) c.n = -c.n;
        return;
    }
    if (c.j >= 0) {
        const Vec3 q = position_now(c.j);
        toward = Vec2(q.x(), q.y()) - here;
    } else {
        toward = plan_.geometry.noses[c.nose].center - here;
    }
    c.n = toward / length(toward);
}

// Sustained contacts of a record that stopped: held and not released since.
void Shot::restore_held() {
    for (const Event& e : record_.events) {
        HeldContact c;
        c.i = e.a;
        c.partner = e.b;
        c.nose = e.detail;
        switch (e.type) {
            case EventType::kBallBallHold:
            case EventType::kBallBallRelease:
                c.j = e.b;
                break;
            case EventType::kBallCushionHold:
            case EventType::kBallCushionRelease:
                c.cushion = e.detail >= 0 ? -1 : e.b;
                break;
            case EventType::kBallJawHold:
            case EventType::kBallJawRelease:
                c.jaw = true;
                break;
            default:
                continue;
        }
        if (e.type == c.hold_type())
            held_.push_back(c);
        else
            std::erase_if(held_, [&c](const HeldContact& h) {
                return h.i == c.i && h.j == c.j && h.cushion == c.cushion && h.nose == c.nose;
            });
    }
    for (HeldContact& c : held_) refresh_normal(c);
}

}  // namespace carom
