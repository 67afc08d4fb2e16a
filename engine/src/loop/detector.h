// Finds the next contact or state transition. Every ball has three predicted events: its state transition,
// its first contact with the table and its first contact with another ball. Boxes exclude everything that a
// ball cannot reach before its own next event (broad phase), closed forms give the times of the remaining
// contacts (contact/detect.h), and a queue orders the earliest times of all balls. Implemented in
// detector.cpp (the order), pair_search.cpp and table_search.cpp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "contact/contact.h"
#include "contact/detect.h"
#include "loop/balls.h"
#include "loop/box_search.h"
#include "loop/event_queue.h"
#include "loop/resting_contacts.h"
#include "physics/motion.h"

namespace carom {

/// An event that will happen unless an earlier one prevents it.
struct PredictedEvent {
    double time = kNever;
    Contact contact;          ///< With::kNothing: the state transition of the ball
    std::uint32_t stamp = 0;  ///< for a pair: Mover::stamp of the partner when this was found
};

/// The data of a ball besides its segment, in two cache lines.
struct alignas(64) Mover {
    double until = kNever;    ///< the box is valid until this time; later contacts are not searched yet
    double own = kNever;      ///< time of the ball's transition
    double surface = 0.0;     ///< R |w| at the start of the segment [m/s]
    std::uint32_t stamp = 0;  ///< incremented with every new segment
    std::uint32_t round = 0;  ///< last search for which this ball's motion was new
    /// First contact with another ball. Kept until it is the next event, even if the partner's motion has
    /// changed; it is then no later than the true first contact.
    PredictedEvent pair;
    PredictedEvent table;  ///< first contact with the table
    /// When the box expires; kNever if an event of the ball itself comes first.
    double refresh = kNever;
    double travel = 0.0;  ///< [m] distance that the next box covers
    bool straight = false;
    bool asks_table = false;  ///< the table is not searched yet: no box so far has reached it
};

struct DetectorMemory {
    std::vector<Mover> mover_;
    std::vector<int> tied_;  // balls whose next events are simultaneous
    EventQueue queue_;       // of balls: time of the first predicted event or of the box's expiry
    // boxes of balls until their own next event, and boxes of the parts of the table
    BoxSearch ball_boxes_, table_boxes_;
    std::vector<Contact> parts_;  // cushions, then noses, then pockets; without a ball
    Geometry table_;              // the table of parts_ and table_boxes_
    std::optional<Search> table_search_;
    std::vector<int> near_;  // parts that a ball can reach
};

class Detector : private Borrowed<DetectorMemory> {
  public:
    /// @param costs  receives the costs of a profiled run; otherwise nullptr
    Detector(const Plan& plan, const Balls& balls, const RestingContacts& resting, Costs* costs,
             DetectorMemory& memory);

    /// Searches the contacts of the balls whose motion has changed, and clears the list. The first call must
    /// list all balls.
    void update(std::vector<int>& touched);
    /// The next predicted event; its time is kNever if there is none.
    PredictedEvent next();

    /// Calls found(ball) for every ball whose box overlaps this box; a ball is always inside its box.
    template <class Found>
    void balls_near(const Box& box, Found found) const {
        ball_boxes_.overlapping(box, found);
    }
    /// Calls found(contact) for every part of the table whose box overlaps this box; the contacts contain no
    /// ball.
    template <class Found>
    void parts_near(const Box& box, Found found) const {
        table_boxes_.overlapping(box, [&](int part) { found(parts_[part]); });
    }
    /// [m/s] Upper bound of the speeds of all balls so far (0 unless clusters = "compliant", its only user).
    double fastest() const { return fastest_; }

  private:
    // detector.cpp
    bool before(const PredictedEvent& x, const PredictedEvent& y) const {
        return x.time != y.time ? x.time < y.time : x.time != kNever && before_at_once(x, y);
    }
    void take_first(const PredictedEvent& c, PredictedEvent& first) const {
        if (before(c, first)) first = c;
    }
    bool before_at_once(const PredictedEvent& x, const PredictedEvent& y) const;
    double closing(const PredictedEvent& c) const;
    Vec2 place(const PredictedEvent& c) const;
    PredictedEvent first_of(int ball) const;
    bool must_search_again(int ball) const;
    void requeue(int ball);
    void renew(int ball);

    // pair_search.cpp
    Box swept(int ball, double from, double duration) const;
    Path path(int ball, double from) const;
    void bound(int ball, double from, const RoundedBox* whole = nullptr);
    bool may_wait(int ball) const;
    void bound_speed(const Segment& segment);
    void search_pairs(int ball);
    PredictedEvent pair(int a, const Path& mine, int b, double latest) const;
    void offer(int ball, int partner, PredictedEvent c);
    void search_again(int ball);

    // table_search.cpp
    void set_up_table();
    void find_parts(const RoundedBox& box);
    void search_table(int ball, const RoundedBox& whole);

    // table_search.cpp, in the air
    Flight flight(int ball, double from) const;
    double time_to_flight(int a, int b, double from) const;
    void search_table_in_air(int ball);
    double time_over_pocket(int pocket, const Path& path, double R) const;

    /// The duration from one time to another, rounded up.
    static double span(double from, double to) { return (to - from) + 0x1p-50 * to; }

    const Plan& plan_;
    const bool flights_;  // balls may leave the cloth
    const Balls& balls_;
    const RestingContacts& resting_;
    double *detect_ns_, *search_ns_;  // sums of a profiled run; otherwise nullptr
    std::uint32_t round_ = 0;
    double fastest_ = 0.0;
};

// Motion of a ball from the time `from`. Contacts are searched from the starts of the segments, not from the
// present time, so that the result depends only on the segments.
inline Path Detector::path(int ball, double from) const {
    const Segment& s = balls_.segment(ball);
    const Mover& mover = mover_[ball];
    const double tau = from - s.start;
    const Vec3 r = position_at(s, tau), v = velocity_at(s, tau);
    return {Vec2(r.x(), r.y()), Vec2(v.x(), v.y()),  s.a,          std::max(0.0, s.duration - tau),
            mover.straight,     translates(s.state), mover.surface};
}

}  // namespace carom
