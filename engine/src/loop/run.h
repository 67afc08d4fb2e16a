// One run of the simulation: its parts and the loop that uses them (simulate.cpp).
#pragma once

#include <cstdint>

#include "loop/balls.h"
#include "loop/detector.h"
#include "loop/log.h"
#include "loop/resolver.h"
#include "loop/resting_contacts.h"

namespace carom {

struct RunBuffers::Memory {
    BallsMemory balls;
    LogMemory log;
    RestingMemory resting;
    DetectorMemory detector;
    ClustersMemory clusters;
};

class Run {
  public:
    /// @param keep  what the log must store for the requested result
    Run(const Plan& plan, const SimulateOptions& options, RunBuffers::Memory& memory,
        Keep keep = Keep::kRecord);

    Record simulate();
    void simulate(Outcome& outcome);
    /// Both, with the record in its existing memory.
    void simulate(Outcome& outcome, Record& record);

    const Clusters& clusters() const { return resolver_.clusters(); }

  private:
    StopReason run();
    void start_balls();
    bool goes_round();
    void check_digits(int ball, double time);
    void check_creeping(double time);
    [[noreturn]] void lose(int ball, double when);
    /// Whether the run has reached its number of events. @throws SimulationError if [stop] does not set that
    /// number
    bool is_full();
    StopReason stop(double next);

    const Plan& plan_;
    double stop_;        // [s] end of the simulated time
    std::int64_t most_;  // number of events after which the run ends
    Balls balls_;
    Log log_;
    RestingContacts resting_;
    Detector detector_;
    Resolver resolver_;
    double lap_speed_ = -1.0;  // [m/s] of the last moving ball when goes_round() last looked
};

}  // namespace carom
