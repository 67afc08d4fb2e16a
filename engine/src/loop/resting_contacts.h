// The contacts that last: when a contact becomes a resting one, what moves its balls meanwhile, when it ends.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact/resting.h"
#include "loop/approach.h"
#include "loop/balls.h"
#include "loop/log.h"

namespace carom {

class RestingContacts {
  public:
    RestingContacts(const Plan& plan, const Balls& balls, Log& log);

    /// The contacts that these events have begun and not ended.
    void restore(std::span<const Event> events);

    bool has(const Contact& contact) const {
        return !contacts_.empty() && balls_.segment(contact.ball).held && find(contact);
    }
    /// Makes it a resting contact instead of a bounce, if it is one (docs/hard_cases.md, H5 and H7).
    /// @param restitution  of the bounce
    /// @throws SimulationError where two balls of different size would have to rest on each other
    bool try_hold(const Approach& approach, double restitution);
    /// Ends all resting contacts of a ball that something else happens to; its partners go on without it.
    void release(int ball);
    /// At the end of an interval of the ball's group: its transitions, then the next interval.
    void advance(int ball);

  private:
    /// Whether members whose interval ended with their own transition make it first.
    enum class Transitions : std::uint8_t { kNotYet, kDue };

    bool find(const Contact& contact) const;
    bool chatters(const Contact& contact) const;
    double rounding_with(const Contact& contact) const;
    void end(const RestingContact& contact);
    void solve(int ball, Transitions transitions);
    RestingGroup group_of(int ball, Transitions transitions);
    bool has_come_to_transition(const Segment& segment) const;
    void log_transitions(const RestingGroup& group);
    bool release_past_ends(RestingGroup& group);
    Segment free_segment(int ball) const;
    void refresh_normal(RestingContact& contact) const;
    void sort_by_place(std::vector<RestingContact>& contacts) const;

    const Plan& plan_;
    const Balls& balls_;
    Log& log_;
    std::vector<RestingContact> contacts_;
};

}  // namespace carom
