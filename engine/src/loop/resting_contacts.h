// Resting contacts: when they begin, how their balls move, and when they end.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact/contact.h"
#include "contact/resting.h"
#include "loop/balls.h"
#include "loop/log.h"

namespace carom {

struct RestingMemory {
    struct Struck {
        int ball;
        Segment segment;
    };
    /// A bounce, or a contact that began to rest.
    struct Bounce {
        double time;
        Contact contact;
        double v_n;  ///< [m/s] closing speed
    };
    std::vector<RestingContact> contacts_;
    std::vector<Struck> struck_;
    std::vector<Bounce> bounces_;  ///< the latest ones, the oldest at next_bounce_
    std::size_t next_bounce_ = 0;
};

class RestingContacts : private Borrowed<RestingMemory> {
  public:
    RestingContacts(const Plan& plan, const Balls& balls, Log& log, RestingMemory& memory);

    bool has(const Contact& contact) const {
        return !contacts_.empty() && balls_.segment(contact.ball).held && find(contact);
    }
    /// Begins a resting contact instead of a bounce if the conditions hold (tests/README.md, H5 and H7).
    /// @param restitution  of the bounce
    /// @return whether it is a resting contact now
    bool try_hold(const Meeting& met, double restitution) {
        if (!try_begin(met, restitution)) return false;
        start(met.contact.ball);
        return true;
    }
    /// try_hold() in two parts, for contacts of one ball that begin together: call start() after the last
    /// one.
    bool try_begin(const Meeting& met, double restitution);
    void start(int ball);
    /// Ends all resting contacts of a ball before another event changes its motion; its partners continue
    /// without it.
    void release(int ball);
    /// Stores the motion of a ball after an impact; go_on() begins all stored motions together. A resting
    /// contact of these balls continues if it closes or opens so slowly that friction alone could press or
    /// close it (holds()); otherwise it ends.
    void strike(int ball, const Segment& after) { struck_.push_back({ball, after}); }
    void go_on();
    /// Ends an interval of the ball's group: applies the state transitions, then starts the next interval.
    void advance(int ball);

  private:
    /// Whether to apply the due state transitions first.
    enum class Transitions : std::uint8_t { kNotYet, kDue };

    bool find(const Contact& contact) const;
    bool in_contact(int ball) const;
    const Struck* find_struck(int ball) const;
    bool goes_on(RestingContact& contact) const;
    bool chatters(const Contact& contact, double v_n) const;
    bool may_lose(const Meeting& met) const;
    void note(const Bounce& bounce);
    bool has_fallen(const Event& from, const Contact& contact, double v_n) const;
    void end(const RestingContact& contact);
    void solve(int ball, Transitions transitions);
    RestingGroup group_of(int ball, Transitions transitions);
    bool has_come_to_transition(const Segment& segment) const;
    void log_transitions(const RestingGroup& group);
    bool release_past_ends(RestingGroup& group);
    void begin_free(int ball);
    void refresh_normal(RestingContact& contact) const;
    void sort_by_place(std::vector<RestingContact>& contacts) const;

    const Plan& plan_;
    const Balls& balls_;
    Log& log_;
    const bool lossless_;  // nothing dissipates energy, so bounces never end
};

}  // namespace carom
