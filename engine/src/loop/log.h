// What has happened so far, and who is told of it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "carom/engine/simulate.h"
#include "carom/engine/tolerances.h"
#include "contact/contact.h"
#include "loop/balls.h"
#include "loop/stopwatch.h"
#include "physics/cluster.h"

namespace carom {

class Log {
    /// [-] Most rounds of the loop in a row without an event: more is reported as a run that has stalled.
    static constexpr int kQuietCap = 1000000;

  public:
    Log(const Plan& plan, const SimulateOptions& options, Balls& balls);

    /// Goes on after this record; the balls take the last motions in it.
    void resume(const Record& so_far);

    /// The ball moves like this from now on.
    void begin(int ball, const Segment& segment) {
        balls_.set(ball, segment);
        segments_.push_back({segment, ball});
        touched_.push_back(ball);
    }
    void event(EventType type, int ball, int partner = -1, int detail = -1) {
        record_.events.push_back({balls_.now(), type, ball, partner, detail});
        quiet_rounds_ = 0;
    }
    /// Of a ball and a part of the table, or of two balls.
    void event(EventType type, const Contact& contact) {
        event(type, contact.ball, event_partner(contact, geometry_), event_detail(contact));
    }
    /// An impact of many balls at once, where a and b met; `balls` in the order of their places.
    void cluster(int a, int b, const std::vector<ClusterBall>& balls);
    void pocketed(int ball, int pocket);

    const std::vector<Event>& events() const { return record_.events; }
    /// Balls whose motion has changed; whoever looks for contacts empties it.
    std::vector<int>& touched() { return touched_; }
    const std::string& id(int ball) const { return record_.tracks[ball].id; }

    /// Stopwatches of a profiled run, else nullptr.
    Costs* costs() { return costs_ ? &*costs_ : nullptr; }
    /// Around everything before the first round.
    void end_set_up(double set_up_ns);
    void begin_round() {
        events_before_ = record_.events.size();
        ++quiet_rounds_;
    }
    /// Books the costs, tells SimulateOptions::progress. @throws SimulationError where events or rounds without
    /// one pile up
    void end_round() {
        if (is_crowded() || quiet_rounds_ > kQuietCap) fail_crowded();
        if (costs_) book_costs();
        if (options_.progress) tell_progress();
    }
    /// The present round took long by itself, so that progress is told at once.
    void note_long_round() { long_round_ = true; }

    /// @throws SimulationError with the state of all balls that move
    [[noreturn]] void fail(const std::string& why) const;

    /// The record; the log is empty afterwards.
    Record finish(StopReason why);

  private:
    struct BallSegment {
        Segment segment;
        int ball;
    };
    void reserve();
    bool is_crowded() const {
        const std::vector<Event>& e = record_.events;
        return e.size() > kEventCap && balls_.now() - e[e.size() - 1 - kEventCap].time < kEventCapSpan;
    }
    [[noreturn]] void fail_crowded() const;
    void book_costs();
    void tell_progress();

    const SimulateOptions& options_;
    Balls& balls_;
    const Geometry& geometry_;
    bool has_clusters_;
    Record record_;
    // Segments and clusters of this run, in the order in which they came; finish() deals them out.
    std::vector<BallSegment> segments_;
    std::vector<int> cluster_ball_;
    std::vector<std::size_t> cluster_end_;
    std::vector<int> touched_;
    std::optional<Costs> costs_;
    std::size_t events_before_ = 0;  // this round
    int quiet_rounds_ = 0;           // in a row, without an event
    int rounds_untold_ = 0;          // since the last call of options_.progress
    bool long_round_ = false;        // one of them took long by itself
};

}  // namespace carom
