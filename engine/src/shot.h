// The state of one run, and the steps of its loop. Split over shot_detect.cpp (what comes next),
// shot_resolve.cpp (what an event does) and shot_held.cpp (sustained contacts); the loop itself is
// simulate.cpp.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "carom/engine/simulate.h"
#include "cluster.h"
#include "detect.h"
#include "motion.h"
#include "roots.h"
#include "sustained.h"

namespace carom {

/// Something that will happen unless an earlier event changes it.
struct Candidate {
    double time = kNever;
    EventType type = EventType::kCueStrike;
    int a = -1, b = -1;
    int nose = -1;  ///< kBallCushion, kBallJaw: index into Plan::noses, or -1 for the straight part
};

/// A rectangle on the table.
struct Box {
    double low_x, low_y, high_x, high_y;
};

class Shot {
  public:
    using Clock = std::chrono::steady_clock;

    Shot(const Plan& plan, const SimulateOptions& options);

    /// Balls, cue strike, first candidates.
    void set_up(bool profile);
    /// Goes on from where a record stopped; its bits are those of a run that did not stop.
    void take_up(const Record& record);
    /// The loop. kProfile = false has no clock in it.
    template <bool kProfile>
    Record run(const Record* so_far);

  private:
    void first_candidates();

    // shot_detect.cpp
    Candidate next() const;
    bool before(const Candidate& x, const Candidate& y) const;
    double closing(const Candidate& c) const;
    Vec2 place(const Candidate& c) const;
    Candidate pair(int a, int b) const;
    void rescan(int ball);
    void detect_features(int ball);
    void bound(int ball);
    void redetect();
    Box swept(int ball, double duration) const;
    Path path(int ball, double from) const;

    // shot_resolve.cpp
    template <bool kProfile>
    void apply(const Candidate& c);
    template <bool kProfile>
    void resolve_ball_ball(const Candidate& c);
    template <bool kProfile>
    void resolve_nose(const Candidate& c);
    double pair_friction(int one, int two) const;
    void resolve_pocket(const Candidate& c);
    void resolve_transition(const Candidate& c);
    void record_event(EventType type, int a, int b, int detail = -1);
    void begin(int ball, const Segment& segment);
    void guard_cap() const;
    [[noreturn]] void fail(const std::string& why) const;

    // shot_cluster.cpp
    template <bool kProfile>
    bool resolve_cluster(const Candidate& c, double v_n);
    double collect_cluster(int a, int b, double v_n);
    void collect_cluster_at(int a, int b, double v_n);

    // shot_held.cpp
    bool is_held(int ball) const { return now_of(ball).held; }
    bool held_together(int a, int b) const;
    bool held_to(int ball, int cushion, int nose) const;
    bool hold_instead(const HeldContact& contact, double v_n, double a_c, double restitution);
    bool rattles(const HeldContact& contact) const;
    double rounding_of_held(const HeldContact& contact) const;
    void free_ball(int ball);
    void solve_group(int ball, bool transitions);
    void record_transitions(const HeldGroup& group);
    bool release_past_ends(HeldGroup& group);
    void refresh_normal(HeldContact& contact) const;
    void sort_by_place(std::vector<HeldContact>& contacts) const;
    void restore_held();

    const Segment& now_of(int ball) const {
        return record_.tracks[static_cast<std::size_t>(ball)].segments.back();
    }
    Vec3 position_now(int ball) const { return position_at(now_of(ball), now_ - now_of(ball).start); }
    Vec3 velocity_now(int ball) const { return velocity_at(now_of(ball), now_ - now_of(ball).start); }
    Vec3 spin_now(int ball) const { return spin_at(now_of(ball), now_ - now_of(ball).start, plan_.balls.R); }
    static double nanoseconds(Clock::time_point from, Clock::time_point to) {
        return std::chrono::duration<double, std::nano>(to - from).count();
    }

    const Plan& plan_;
    const SimulateOptions& options_;
    MotionParams motion_;
    Record record_;
    double now_ = 0.0;
    int balls_ = 0;
    int quiet_ = 0;  // rounds of the loop in a row without an event
    EventCost cost_;
    std::vector<int> touched_;  // balls whose motion the present event changed
    std::vector<HeldContact> held_;
    ClusterMap cluster_map_;
    std::vector<ClusterBall> cluster_balls_;
    std::vector<ClusterContact> cluster_contacts_;
    // Per ball: its transition, its first contact with the table, its first contact with another ball.
    std::vector<Candidate> own_, feature_, pair_;
    std::vector<Box> box_;         // per ball: where it can be until its own next event
    std::vector<Box> line_boxes_;  // per straight cushion
};

}  // namespace carom
