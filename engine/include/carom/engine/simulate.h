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
    /// [s] Start of the shot on the caller's clock: copied to Record::start_time, and not used otherwise
    double start_time = 0.0;
    /// Called with (events so far, simulated time) every `progress_rounds` rounds of the loop (about one
    /// event each), and after a slow round (a cluster, an integration with many steps, resting contacts). Use
    /// it for a progress line, or throw from it to end the run. Runs with fewer rounds never call it.
    std::function<void(std::size_t, double)> progress;
    int progress_rounds = 64;
    /// for an outcome: compute Outcome::hash, which needs segments that an outcome does not
    bool hash = false;
};

/// A run that failed: too many events in one simulated microsecond, or a kernel without a solution. what()
/// contains a dump of the state.
class SimulationError : public std::runtime_error {
  public:
    explicit SimulationError(const std::string& dump, std::shared_ptr<const Record> so_far = nullptr)
        : std::runtime_error(dump), so_far_(std::move(so_far)) {}

    /// The record up to the failure; null if the run kept no record.
    const std::shared_ptr<const Record>& so_far() const noexcept { return so_far_; }

  private:
    std::shared_ptr<const Record> so_far_;
};

/// Runs a plan until all balls rest, its stop time, or its number of events; StopReason has one more end.
/// @throws SimulationError
Record simulate(const Plan& plan, const SimulateOptions& options = {});

/// In place of the index of a pocket: the ball has left the table (ball_out).
inline constexpr int kOffTable = -2;

/// The result of a shot for one ball.
struct BallOutcome {
    Vec3 position = Vec3::Zero();  ///< at the end [m]; for a pocketed ball, the bottom of the pocket
    int pocket = -1;               ///< index of the pocket that holds it, kOffTable, or -1
    int fell = -1;                 ///< 0 for the ball that fell first, 1 for the next one, ..., or -1
    int cushions = 0;  ///< how often it met a cushion or a jaw: bounces, and starts of resting contacts
    bool met = false;  ///< by the struck ball (Outcome::struck)
    bool operator==(const BallOutcome&) const = default;
};

/// The ball that the cue strikes, otherwise the first one that moves at the start; or -1.
int struck_ball(const Scene& scene);

/// The result of a shot without a record: final positions and counts of events.
struct Outcome {
    StopReason stopped = StopReason::kAtRest;
    double duration = 0.0;    ///< [s]
    std::int64_t events = 0;  ///< as many as in the record
    int clusters = 0;         ///< of these events
    int struck = -1;          ///< struck_ball()
    int first_hit = -1;       ///< the ball that it meets first (the nearest one of a cluster); or -1
    int contacts = 0;         ///< balls that it meets, each counted once
    /// Its contacts with cushions and jaws before the second ball, or in all, except with one that it has
    /// been frozen to since the start (still_frozen)
    int approach_cushions = 0;
    std::vector<BallOutcome> balls;  ///< in the order of Scene::ball
    std::uint64_t hash = 0;          ///< Record::hash() as a number, if SimulateOptions::hash asked for it
    bool operator==(const Outcome&) const = default;
};

/// Memory for runs, one after another, of the same plan or of different ones. For one thread at a time. The
/// results do not depend on it.
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

/// simulate() in reused memory: allocates only the record. @throws SimulationError
Record simulate(const Plan& plan, RunBuffers& buffers, const SimulateOptions& options = {});

/// simulate() without a record. Once the buffers and the outcome have grown enough, it allocates no memory,
/// unless there are resting contacts. Does not profile. @throws SimulationError
void simulate(const Plan& plan, RunBuffers& buffers, Outcome& outcome, const SimulateOptions& options = {});

/// The outcome and the record of one run. The record is that of simulate(), in the memory of the record
/// passed in.
/// @throws SimulationError
void simulate(const Plan& plan, RunBuffers& buffers, Outcome& outcome, Record& record,
              const SimulateOptions& options = {});

}  // namespace carom
