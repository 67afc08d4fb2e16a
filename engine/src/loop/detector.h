// Which contact or transition comes next. Every ball has three candidates: its own transition, its first contact
// with the table and its first contact with another ball. Boxes leave out what a ball cannot meet before its own
// next event (the broad phase), closed forms find the times of the rest (contact/detect.h), and a tournament keeps
// the order of all balls. Split over detector.cpp (the order), pair_search.cpp and table_search.cpp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "contact/contact.h"
#include "contact/detect.h"
#include "loop/balls.h"
#include "loop/box_search.h"
#include "loop/event_queue.h"
#include "loop/resting_contacts.h"
#include "loop/stopwatch.h"
#include "physics/motion.h"

namespace carom {

/// Something that will happen unless an earlier event changes it.
struct Candidate {
    double time = kNever;
    Contact contact;          ///< With::kNothing: the ball's own transition
    std::uint32_t stamp = 0;  ///< of a pair: the partner's motion when this was found
};

class Detector {
  public:
    /// @param costs  of a profiled run, else nullptr
    Detector(const Plan& plan, const Balls& balls, const RestingContacts& resting, Costs* costs);

    /// Looks for the contacts of balls whose motion has changed, and empties the list. All balls come first.
    void update(std::vector<int>& touched);
    /// The next candidate; its time is kNever if nothing is to come.
    Candidate next();

    /// Calls found(ball) for every ball whose box overlaps this one; a ball is always inside its box.
    template <class Found>
    void balls_near(const Box& box, Found found) const {
        ball_boxes_.overlapping(box, found);
    }
    /// [m/s] No ball has been faster (where clusters = "compliant" asks for it, else 0).
    double fastest() const { return fastest_; }

  private:
    /// What is kept for a ball beside its segment: two cache lines.
    struct alignas(64) Mover {
        double until =
            kNever;            ///< the box is valid until this time; contacts after it have not been searched
        double own = kNever;   ///< time of the ball's transition
        double surface = 0.0;  ///< R |w| at the start of the segment [m/s]
        std::uint32_t stamp = 0;  ///< changes with the segment
        std::uint32_t round = 0;  ///< last search in which the ball was new
        /// First contact with another ball. It is kept until it comes up, even if the partner's motion has
        /// changed meanwhile: it is then not later than the true one.
        Candidate pair;
        Candidate table;  ///< first contact with the table
        /// Expiry of the box; kNever where an event of the ball's own comes first
        double refresh = kNever;
        double travel = 0.0;  ///< [m] the way that the next box is to cover
        bool straight = false, queued = false;
    };

    // detector.cpp
    bool before(const Candidate& x, const Candidate& y) const {
        return x.time != y.time ? x.time < y.time : x.time != kNever && before_at_once(x, y);
    }
    void take_first(const Candidate& c, Candidate& first) const {
        if (before(c, first)) first = c;
    }
    bool before_at_once(const Candidate& x, const Candidate& y) const;
    double closing(const Candidate& c) const;
    Vec2 place(const Candidate& c) const;
    Candidate first_of(int ball) const;
    void mark_changed(int ball);
    void requeue();
    void renew(int ball);

    // pair_search.cpp
    Box swept(int ball, double from, double duration) const;
    Path path(int ball, double from) const;
    void bound(int ball, double from);
    void bound_speed(const Segment& segment);
    void search_pairs(int ball);
    Candidate pair(int a, const Path& mine, int b, double latest) const;
    void offer(int ball, int partner, Candidate c);
    void search_again(int ball);

    // table_search.cpp
    void set_up_table();
    void find_parts(int ball);
    void search_table(int ball);
    double time_to(const Contact& contact, const Path& path, double window) const;

    /// From one time to another, on the long side of its rounding.
    static double span(double from, double to) { return (to - from) + 0x1p-50 * to; }

    const Plan& plan_;
    const Balls& balls_;
    const RestingContacts& resting_;
    double *detect_ns_, *search_ns_;  // sums of a profiled run, else nullptr
    std::vector<Mover> mover_;
    std::vector<double> key_;   // per ball: when the loop has to look at it
    std::vector<int> changed_;  // balls whose place in the queue is to be found anew
    EventQueue queue_;
    BoxSearch ball_boxes_,
        table_boxes_;             // of balls until their own next event, and of the parts of the table
    std::vector<Contact> parts_;  // cushions, then noses, then pockets; without a ball
    std::vector<int> near_;       // parts that a ball can come to
    std::uint32_t round_ = 0;
    double fastest_ = 0.0;
};

// Motion of a ball from the time `from` on. Contacts are sought from the start of the segments concerned, not
// from now: the answer is then a function of the segments alone, whenever it is computed.
inline Path Detector::path(int ball, double from) const {
    const Segment& s = balls_.segment(ball);
    const Mover& mover = mover_[ball];
    const double tau = from - s.start;
    const Vec3 r = position_at(s, tau), v = velocity_at(s, tau);
    return {Vec2(r.x(), r.y()), Vec2(v.x(), v.y()),  s.a,          std::max(0.0, s.duration - tau),
            mover.straight,     translates(s.state), mover.surface};
}

}  // namespace carom
