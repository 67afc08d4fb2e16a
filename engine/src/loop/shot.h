// The state of one run, and the steps of its loop. Split over queue.cpp (what comes next), search.cpp (contacts
// of balls), table.cpp (contacts with the table), resolve.cpp (what an event does), cluster.cpp and resting.cpp
// (resting contacts); the loop itself is simulate.cpp.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "carom/engine/simulate.h"
#include "contact/detect.h"
#include "contact/resting.h"
#include "contact/roots.h"
#include "loop/box_search.h"
#include "loop/event_queue.h"
#include "physics/cluster.h"
#include "physics/motion.h"

namespace carom {

/// Something that will happen unless an earlier event changes it.
struct Candidate {
    double time = kNever;
    EventType type = EventType::kCueStrike;
    int a = -1, b = -1;
    int nose = -1;            ///< kBallCushion, kBallJaw: index into Plan::noses, or -1 for the straight part
    std::uint32_t stamp = 0;  ///< of a pair: Mover::stamp of the partner when this was found
};

/// What detection keeps for a ball beside its segment: two cache lines.
struct alignas(64) Mover {
    double until = kNever;    ///< its box holds until then; later contacts are not looked for yet
    double own = kNever;      ///< time of its transition
    double surface = 0.0;     ///< R |w| at the start of the segment [m/s]
    std::uint32_t stamp = 0;  ///< changes with the segment
    std::uint32_t round = 0;  ///< last search in which the ball was new
    /// First contact with another ball. It is kept until it comes up, even if the partner has changed
    /// meanwhile: it is then not later than the true one.
    Candidate pair;
    Candidate feature;  ///< first contact with the table
    /// Then the box is renewed; kNever where an event of the ball's own comes first
    double refresh = kNever;
    double travel = 0.0;  ///< [m] the way that the next box is to cover
    bool straight = false, queued = false;
};

class Shot {
  public:
    using Clock = std::chrono::steady_clock;

    Shot(const Plan& plan, const SimulateOptions& options);

    /// Balls, cue strike, first candidates.
    void set_up(bool profile);
    /// Moves the segments of this run into the record.
    void finish();
    /// Goes on from where a record stopped; its bits are those of a run that did not stop.
    void take_up(const Record& record);
    /// The loop. kProfile = false has no clock in it.
    template <bool kProfile>
    Record run(const Record* so_far);
    /// How many balls the impacts of this run have looked at beside their own two; tests count them.
    std::int64_t cluster_looks() const { return cluster_looks_; }

  private:
    void reserve_log();
    void tell_progress();
    void first_candidates();
    void end(double next, double stop);

    // queue.cpp
    template <bool kProfile>
    Candidate next();
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
    void changed(int ball);
    void requeue();

    // search.cpp
    void redetect();
    void renew(int ball);
    Box swept(int ball, double from, double duration) const;
    Path path(int ball, double from) const;
    void bound(int ball, double from);
    void search_pairs(int ball);
    Candidate pair(int a, const Path& mine, int b, double latest) const;
    void offer(int ball, int partner, Candidate c);
    void look_again(int ball);

    // table.cpp
    void set_up_table();
    void find_parts(int ball);
    void detect_features(int ball);
    void offer_rest(int ball, int pocket, Candidate& first) const;
    void offer_line(int ball, const Path& p, int line, Candidate& first) const;
    void offer_nose(int ball, const Path& p, int nose, Candidate& first) const;
    void offer_pocket(int ball, const Path& p, int pocket, Candidate& first) const;

    // resolve.cpp
    template <bool kProfile>
    void apply(const Candidate& c);
    template <bool kProfile>
    void resolve_ball_ball(const Candidate& c);
    template <bool kProfile>
    void resolve_nose(const Candidate& c);
    struct Nearing {
        HeldContact contact;
        double v_n = 0.0, a_c = 0.0;  // closing speed and acceleration, positive together
    };
    Nearing nearing(int one, int two) const;
    bool is_slow(double v_n) const;
    static double pressing(const Vec2& n, const Segment& one, const Segment& two);
    double pair_friction(int one, int two) const;
    void resolve_pocket(const Candidate& c);
    void resolve_transition(const Candidate& c);
    void record_event(EventType type, int a, int b, int detail = -1);
    void begin(int ball, const Segment& segment) {
        current_[ball] = segment;
        log_.push_back(segment);
        log_ball_.push_back(ball);
        touched_.push_back(ball);
    }
    void guard_cap() const;
    [[noreturn]] void fail(const std::string& why) const;

    // cluster.cpp
    template <bool kProfile>
    bool resolve_cluster(const Candidate& c, double v_n);
    /// By what the balls do before the impact, or after it.
    enum class Pressed : std::uint8_t { kBefore, kAfter };
    bool hold_in_cluster(Pressed when);
    void end_cluster(const Candidate& c);
    double collect_cluster(int a, int b, double v_n);
    void collect_cluster_at(int a, int b, double v_n);
    Box near_box(const ClusterBall& ball, double gap) const;
    void bound_speed(const Segment& segment);

    // resting.cpp
    bool is_held(int ball) const { return now_of(ball).held; }
    bool held_together(int a, int b) const;
    bool held_to(int ball, int cushion, int nose) const;
    bool hold_instead(const HeldContact& contact, double v_n, double a_c, double restitution);
    bool rattles(const HeldContact& contact) const;
    double rounding_of_held(const HeldContact& contact) const;
    void free_ball(int ball);
    /// Whether members whose interval ended with their own transition make it first.
    enum class Transitions : std::uint8_t { kNotYet, kDue };
    void solve_group(int ball, Transitions transitions);
    void record_transitions(const HeldGroup& group);
    bool release_past_ends(HeldGroup& group);
    void refresh_normal(HeldContact& contact) const;
    void sort_by_place(std::vector<HeldContact>& contacts) const;
    void restore_held();

    const Segment& now_of(int ball) const { return current_[ball]; }
    Vec3 position_now(int ball) const { return position_at(now_of(ball), now_ - now_of(ball).start); }
    Vec3 velocity_now(int ball) const { return velocity_at(now_of(ball), now_ - now_of(ball).start); }
    Vec3 spin_now(int ball) const { return spin_at(now_of(ball), now_ - now_of(ball).start, radius(ball)); }
    double radius(int ball) const { return plan_.sizes[ball].R; }
    const MotionParams& motion_of(int ball) const { return plan_.motion[ball]; }
    /// From one time to another, on the long side of its rounding.
    static double span(double from, double to) { return (to - from) + 0x1p-50 * to; }
    static double nanoseconds(Clock::time_point from, Clock::time_point to) {
        return std::chrono::duration<double, std::nano>(to - from).count();
    }

    const Plan& plan_;
    const SimulateOptions& options_;
    Record record_;
    double now_ = 0.0;
    int balls_ = 0;
    int quiet_ = 0;            // rounds of the loop in a row without an event
    int rounds_untold_ = 0;    // since the last call of options_.progress
    bool long_round_ = false;  // a round took long by itself since then
    EventCost cost_;
    std::vector<Segment> current_;  // per ball
    std::vector<Segment> log_;      // every segment begun in this run, in order; the record's at the end
    std::vector<int> log_ball_;
    std::vector<int> log_member_;           // balls of every cluster of this run
    std::vector<std::size_t> log_cluster_;  // where each cluster's balls end
    std::vector<int> touched_;              // balls whose motion the present event changed
    std::vector<HeldContact> held_;
    ClusterMap cluster_map_;
    std::vector<ClusterBall> cluster_balls_;
    std::vector<ClusterContact> cluster_contacts_;
    double fastest_ = 0.0;  // [m/s] no ball has been faster
    std::int64_t cluster_looks_ = 0;
    std::vector<double> key_;  // per ball: when the loop has to look at it
    std::vector<Mover> mover_;
    std::vector<int> changed_;  // balls whose place in the queue is to be found anew
    EventQueue queue_;
    BoxSearch ball_boxes_, table_boxes_;  // where balls can be until their own next event; parts of the table
    std::vector<int> parts_;              // of the table: cushions, then noses, then pockets
    std::uint32_t round_ = 0;
    double search_ns_ = 0.0;  // profiled: of look_again()
};

// Motion of a ball from the time `from` on. Contacts are sought from the start of the segments concerned, not
// from now: the answer is then a function of the segments alone, whenever it is computed.
inline Path Shot::path(int ball, double from) const {
    const Segment& s = now_of(ball);
    const Mover& mover = mover_[ball];
    const double tau = from - s.start;
    const Vec3 r = position_at(s, tau), v = velocity_at(s, tau);
    return {Vec2(r.x(), r.y()), Vec2(v.x(), v.y()),  s.a,          std::max(0.0, s.duration - tau),
            mover.straight,     translates(s.state), mover.surface};
}

}  // namespace carom
