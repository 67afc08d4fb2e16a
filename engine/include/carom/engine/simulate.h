// The event loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
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
    /// [s] Start of the shot on the caller's clock; only copied to Record::start_time.
    double start_time = 0.0;
    /// Called with (events so far, simulated time) every `progress_rounds` rounds of the loop (about one
    /// event each), and after a slow round (a cluster, an integration with many steps, resting contacts);
    /// never for shorter runs. Use it for a progress line, or throw from it to end the run.
    std::function<void(std::size_t, double)> progress;
    int progress_rounds = 64;
    /// Compute Outcome::hash, which needs segments that an outcome alone does not.
    bool hash = false;
};

/// A failed run: too many events in one simulated microsecond, or a kernel without a solution. what()
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

/// Runs a plan until all balls rest, its stop time, or its number of events; see also StopReason::kEndless.
/// @throws SimulationError
Record simulate(const Plan& plan, const SimulateOptions& options = {});

/// Replaces the index of a pocket if the ball has left the table (ball_out).
inline constexpr int kOffTable = -2;

struct BallOutcome {
    /// At the end [m]; for a pocketed ball, the bottom of the pocket.
    Vec3 position = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    int pocket = -1;   ///< index of its pocket, kOffTable, or -1
    int fell = -1;     ///< 0 for the first ball to fall, 1 for the next, ..., or -1
    int cushions = 0;  ///< cushion and jaw hits: bounces, and starts of resting contacts
    bool met = false;  ///< hit by the struck ball (Outcome::struck)
    bool operator==(const BallOutcome&) const = default;
};

/// The ball that the cue strikes, otherwise the first ball that moves at the start; or -1.
int struck_ball(const Scene& scene);

/// The result of a shot without a record: final positions and event counts.
struct Outcome {
    StopReason stopped = StopReason::kAtRest;
    /// [s]
    double duration = std::numeric_limits<double>::quiet_NaN();
    std::int64_t events = 0;  ///< as in the record
    int clusters = 0;         ///< ball_cluster events
    int struck = -1;          ///< struck_ball()
    int first_hit = -1;       ///< the first ball it hits; or -1
    int contacts = 0;         ///< balls it hits, each counted once
    /// Its contacts with cushions and jaws before the second ball, or in all, except with one to which it has
    /// been frozen since the start (still_frozen).
    int approach_cushions = 0;
    std::vector<BallOutcome> balls;  ///< in the order of Scene::ball
    std::uint64_t hash = 0;          ///< Record::hash() as a number; only with SimulateOptions::hash
    bool operator==(const Outcome&) const = default;
};

/// Memory for successive runs of the same or different plans. For one thread at a time. Does not affect the
/// results.
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

/// simulate() without a record. Once the buffers and the outcome have grown, it allocates no memory unless
/// there are resting contacts. Does not profile. @throws SimulationError
void simulate(const Plan& plan, RunBuffers& buffers, Outcome& outcome, const SimulateOptions& options = {});

/// Both the outcome and the record of one run. The record is that of simulate(), in the memory of the record
/// passed in.
/// @throws SimulationError
void simulate(const Plan& plan, RunBuffers& buffers, Outcome& outcome, Record& record,
              const SimulateOptions& options = {});

}  // namespace carom
