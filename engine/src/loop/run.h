// One run of the simulation: its parts and the loop that uses them (simulate.cpp).
#pragma once

#include "loop/balls.h"
#include "loop/detector.h"
#include "loop/log.h"
#include "loop/resolver.h"
#include "loop/resting_contacts.h"

namespace carom {

class Run {
  public:
    Run(const Plan& plan, const SimulateOptions& options);

    /// @param so_far  the record to continue from, or nullptr
    Record simulate(const Record* so_far);

    const Clusters& clusters() const { return resolver_.clusters(); }

  private:
    void start_balls();
    bool is_full() const;
    Record finish(double next);

    const Plan& plan_;
    double stop_;  // [s] end of the simulated time
    Balls balls_;
    Log log_;
    RestingContacts resting_;
    Detector detector_;
    Resolver resolver_;
};

}  // namespace carom
