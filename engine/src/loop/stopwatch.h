// What a profiled run measures.
#pragma once

#include <chrono>

#include "carom/engine/record.h"

namespace carom {

/// Times since the last event; rounds of the loop without an event count towards the next one.
struct Costs {
    EventCost event;         ///< queue_ns is worked out at the end
    double search_ns = 0.0;  ///< part of event.detect_ns: looking for contacts
};

/// Adds the time between its construction and its end to `sum`. Without a sum (a run that is not profiled) it
/// reads no clock.
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
