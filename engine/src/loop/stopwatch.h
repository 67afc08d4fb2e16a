// The measurements of a profiled run.
#pragma once

#include <chrono>

#include "carom/engine/record.h"

namespace carom {

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

}  // namespace carom
