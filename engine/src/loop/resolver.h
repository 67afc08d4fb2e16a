// What happens to the balls when a candidate comes: impacts and transitions.
#pragma once

#include <cstdint>

#include "loop/clusters.h"
#include "loop/detector.h"
#include "loop/log.h"
#include "loop/resting_contacts.h"

namespace carom {

class Resolver {
  public:
    Resolver(const Plan& plan, const Balls& balls, Log& log, RestingContacts& resting,
             const Detector& detector);

    /// At Balls::now(). @throws SimulationError where a model finds no solution
    void resolve(const Contact& contact);

    const Clusters& clusters() const { return clusters_; }

  private:
    void ball_ball(int a, int b);
    bool cluster(int a, int b, double v_n);
    /// By what the balls do before the impact, or after it.
    enum class Pressed : std::uint8_t { kBefore, kAfter };
    bool hold_in_cluster(Pressed when);
    kernel::ImpactResult collide(int one, int two, const kernel::Ball& b1, const kernel::Ball& b2);
    void cushion(const Contact& contact);
    void pocket(const Contact& contact);
    void transition(int ball);
    void begin(int ball, const Vec3& r, const Vec3& v, const Vec3& w);

    const Plan& plan_;
    const Balls& balls_;
    Log& log_;
    RestingContacts& resting_;
    Clusters clusters_;
    EventCost* cost_;  // of a profiled run, else nullptr
    double *resolve_ns_, *kernel_ns_;
};

}  // namespace carom
