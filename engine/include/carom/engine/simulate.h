// The event loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "carom/engine/plan.h"
#include "carom/engine/record.h"

namespace carom {

struct SimulateOptions {
    bool profile = false;         ///< time every event (Record::costs); off costs nothing
    std::optional<double> until;  ///< stop time [s], in addition to the scene's own
    /// [s] Of the shot in the caller's clock: kept in Record::start_time, enters no computation
    double start_time = 0.0;
    /// Called with (events so far, simulated time) every so many rounds of the loop, and after a round that
    /// was long by itself (a cluster, a march of many steps, resting contacts): for a progress line, and
    /// to end the run by an exception of one's own. A round is an event or nearly so; of a run with fewer it
    /// is not called at all.
    std::function<void(std::size_t, double)> progress;
    int progress_rounds = 64;
    /// for an outcome: Outcome::hash, which takes the segments that it has no other use for
    bool hash = false;
};

/// A run that cannot go on: too many events in one simulated microsecond, or a kernel that failed. what()
/// holds a dump of the state.
class SimulationError : public std::runtime_error {
  public:
    explicit SimulationError(const std::string& dump, std::shared_ptr<const Record> so_far = nullptr)
        : std::runtime_error(dump), so_far_(std::move(so_far)) {}

    /// The record up to the failure; null where the run kept no record.
    const std::shared_ptr<const Record>& so_far() const noexcept { return so_far_; }

  private:
    std::shared_ptr<const Record> so_far_;
};

/// Runs a plan to rest, to its stop time or to its number of events; StopReason has the one other end.
/// @throws SimulationError
Record simulate(const Plan& plan, const SimulateOptions& options = {});

/// Goes on with a run of the same plan that stopped at its number of events or its stop time (which the plan
/// no longer has, or has later). The result has the bits of a run that never stopped. @throws SimulationError
Record resume(const Plan& plan, const Record& so_far, const SimulateOptions& options = {});

/// Instead of the index of a pocket: the ball has left the table (ball_out).
inline constexpr int kOffTable = -2;

/// What became of one ball.
struct BallOutcome {
    Vec3 position = Vec3::Zero();  ///< at the end [m]; of a pocketed ball the bottom of the pocket
    int pocket = -1;               ///< index of the pocket that holds it, kOffTable, or -1
    int fell = -1;                 ///< 0 for the ball that fell first, 1 for the next one, ..., or -1
    int cushions = 0;  ///< how often it met a cushion or a jaw: bounces, and contacts that began to last
    bool met = false;  ///< by the struck ball: Outcome::struck
    bool operator==(const BallOutcome&) const = default;
};

/// The ball that the cue strikes, or else the first one that moves at the start; or -1.
int struck_ball(const Scene& scene);

/// What became of a shot, without a record: final places and what the events come to.
struct Outcome {
    StopReason stopped = StopReason::kAtRest;
    double duration = 0.0;    ///< [s]
    std::int64_t events = 0;  ///< as many as the record would have
    int clusters = 0;         ///< of these events
    int struck = -1;          ///< struck_ball()
    int first_hit = -1;       ///< the ball that it meets first: in a cluster the nearest one; or -1
    int contacts = 0;         ///< balls that it meets, each of them once
    /// Its contacts with cushions and jaws before the second of them, or all; not
    /// with one that it was frozen to from the start and has not left (still_frozen)
    int approach_cushions = 0;
    std::vector<BallOutcome> balls;  ///< in the order of Scene::ball
    std::uint64_t hash = 0;          ///< Record::hash() as a number, if SimulateOptions::hash asked for it
    bool operator==(const Outcome&) const = default;
};

/// Memory that runs use one after the other, of the same plan or of
/// others. Of one thread at a time. The results do not depend on it.
class RunBuffers {
  public:
    RunBuffers();
    ~RunBuffers();
    RunBuffers(RunBuffers&& other) noexcept;
    RunBuffers& operator=(RunBuffers&& other) noexcept;

    struct Memory;
    Memory& memory() { return *memory_; }

  private:
    std::unique_ptr<Memory> memory_;
};

/// simulate() in memory that is kept: only the record itself takes new memory. @throws SimulationError
Record simulate(const Plan& plan, RunBuffers& buffers, const SimulateOptions& options = {});

/// simulate() without a record. Once the buffers and the outcome have grown to
/// what a shot needs, it takes no memory, unless balls rest against each other
/// or against a cushion. A profile is not taken. @throws SimulationError
void simulate(const Plan& plan, RunBuffers& buffers, Outcome& outcome, const SimulateOptions& options = {});

/// The outcome and the record of one run. The record is that of simulate(), in the memory that `record` has
/// from an earlier shot.
/// @throws SimulationError
void simulate(const Plan& plan, RunBuffers& buffers, Outcome& outcome, Record& record,
              const SimulateOptions& options = {});

}  // namespace carom
