// The record so far, and the reports of progress and errors.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carom/engine/simulate.h"
#include "carom/engine/tolerances.h"
#include "contact/contact.h"
#include "loop/balls.h"
#include "physics/cluster.h"

namespace carom {

/// The result of a run: a record with every segment, an outcome, or an outcome with the hash of the record.
enum class Keep : std::uint8_t { kRecord, kOutcome, kHash };

/// Costs since the last event; iterations without an event count towards the next one.
struct Costs {
    EventCost event;         ///< queue_ns is computed at the end
    double search_ns = 0.0;  ///< part of event.detect_ns: the search for contacts
};

/// Adds its lifetime [ns] to `sum`. If `sum` is nullptr (no profile), it does not read the clock.
class Stopwatch {
  public:
    explicit Stopwatch(double* sum) : sum_(sum) {
        if (sum_ != nullptr) start_ = Clock::now();
    }
    ~Stopwatch() {
        if (sum_ != nullptr) *sum_ += std::chrono::duration<double, std::nano>(Clock::now() - start_).count();
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

  private:
    using Clock = std::chrono::steady_clock;
    double* sum_;
    Clock::time_point start_;
};

struct LogMemory {
    struct BallSegment {
        Segment segment;
        int ball;
    };
    std::vector<Event> events_;
    // Segments and clusters in chronological order.
    std::vector<BallSegment> segments_;
    std::vector<ClusterBall> cluster_ball_;
    std::vector<Hit> hits_;
    /// Where a cluster ends in cluster_ball_ and in hits_.
    struct End {
        std::size_t ball, hit;
    };
    std::vector<End> cluster_end_;
    std::vector<int> touched_;
    /// For a ball in the air: where it has stayed, apart from trembling, and since when [s].
    struct Stay {
        double since;
        Vec3 place;
    };
    std::vector<Stay> stays_;
    std::vector<Segment> of_struck_;  // by outcome()
};

class Log : private Borrowed<LogMemory> {
    /// [-] Most consecutive iterations without an event; more mean that the simulation is stalled.
    static constexpr int kQuietCap = 1000000;

  public:
    Log(const Plan& plan, const SimulateOptions& options, Balls& balls, LogMemory& memory, Keep keep);

    /// Starts a new motion of the ball now.
    void begin(int ball, const Segment& segment) {
        balls_.set(ball, segment);
        if (keep_ != Keep::kOutcome || ball == struck_) segments_.push_back({segment, ball});
        touched_.push_back(ball);
    }
    /// Starts the motion of a ball in a cluster that takes time, together with `other`.
    void begin_colliding(int ball, const Segment& segment, const Segment& afterwards, int other) {
        begin(ball, segment);
        balls_.set_afterwards(ball, afterwards, other);
    }
    void event(EventType type, int ball, int partner = -1, int detail = -1) {
        events_.push_back({balls_.now(), type, ball, partner, detail});
        quiet_rounds_ = 0;
    }
    /// Call when a ball that may fly has begun a motion after an impact. @throws SimulationError if it
    /// trembles forever on top of another body
    void watch(int ball);
    /// The last event was a slow contact.
    void mark_slow() { events_.back().slow = true; }
    /// An event of a ball and a part of the table, or of two balls.
    void event(EventPhase phase, const Contact& contact) {
        event(event_type(phase, partner_of(contact, geometry_)), contact.ball,
              event_partner(contact, geometry_, planar(balls_.position(contact.ball))),
              event_detail(contact));
    }
    /// A simultaneous impact of several balls, started by a and b; `balls` are ordered by position.
    void cluster(int a, int b, const std::vector<ClusterBall>& balls, const std::vector<Hit>& hits);
    /// The ball falls into the pocket now.
    void fall(int ball, int pocket);

    const std::vector<Event>& events() const { return events_; }
    /// Balls whose motion has changed; Detector::update() clears the list.
    std::vector<int>& touched() { return touched_; }
    const std::string& id(int ball) const { return plan_.scene.ball[ball].id; }

    /// Costs of a profiled run; otherwise nullptr.
    Costs* costs() { return costs_ ? &*costs_ : nullptr; }
    /// Ends the preparation before the first iteration, which took set_up_ns [ns].
    void end_set_up(double set_up_ns);
    void begin_round() {
        events_before_ = events_.size();
        ++quiet_rounds_;
    }
    /// Records the costs and calls SimulateOptions::progress. @throws SimulationError if there are too many
    /// events in a short time, or too many iterations without an event
    void end_round() {
        if (is_crowded() || quiet_rounds_ > kQuietCap) fail_crowded();
        if (costs_) book_costs();
        if (options_.progress) report_progress();
    }
    /// Number of iterations since the last event.
    int quiet_rounds() const { return quiet_rounds_; }
    /// Marks this iteration as slow, so that it ends with a progress report.
    void note_long_round() { long_round_ = true; }

    /// @throws SimulationError with the state of all moving balls, and the record if one is kept. Empties the
    /// log.
    [[noreturn]] void fail(const std::string& why);

    /// The record; empties the log.
    Record record(StopReason why);
    /// The same in the memory of `record`.
    void record(StopReason why, Record& record);
    void outcome(StopReason why, Outcome& outcome);

  private:
    void reserve();
    void begin_record(Record& record) const;
    bool is_driven(const Hit& hit);
    std::span<const Hit> hits(const Event& event) const;
    std::uint64_t hash() const;
    bool is_crowded() const {
        const std::vector<Event>& e = events_;
        return e.size() > kEventCap && balls_.now() - e[e.size() - 1 - kEventCap].time < kEventCapSpan;
    }
    [[noreturn]] void fail_crowded();
    void book_costs();
    void report_progress();

    const Plan& plan_;
    const SimulateOptions& options_;
    Balls& balls_;
    const Geometry& geometry_;
    Keep keep_;
    const int struck_;
    std::optional<Costs> costs_;
    std::vector<EventCost> event_costs_;
    double setup_detect_ns_ = 0.0;
    std::size_t events_before_ = 0;  // number of events before this iteration
    int quiet_rounds_ = 0;           // consecutive iterations without an event
    int rounds_unreported_ = 0;      // iterations since the last call of options_.progress
    bool long_round_ = false;        // whether one of these called note_long_round()
};

}  // namespace carom
