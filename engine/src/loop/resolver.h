// The effect of an event on the balls: impacts and state transitions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "carom/engine/airborne.h"
#include "loop/clusters.h"
#include "loop/detector.h"
#include "loop/log.h"
#include "loop/resting_contacts.h"

namespace carom {

class Resolver {
  public:
    Resolver(const Plan& plan, const Balls& balls, Log& log, RestingContacts& resting,
             const Detector& detector, ClustersMemory& memory);

    /// Starts the motion after the cue's stroke.
    void strike(int ball, const Velocities& struck) { go_on(ball, balls_.segment(ball).r, struck); }
    /// Resolves the event at Balls::now(). @throws SimulationError if a model finds no solution
    void resolve(const Contact& contact);

    const Clusters& clusters() const { return clusters_; }

  private:
    void ball_ball(const Contact& contact);
    bool stop_at_once(const Meeting& met);
    /// @param pair  also if no third ball is near: balls that graze each other
    bool cluster(int a, int b, double v_n, bool pair = false);
    void begin_cluster(int a, int b);
    void end_cluster(int ball);
    bool leave_cluster(const Contact& contact);
    /// Whether the accelerations before or after the impact decide if balls are pressed together.
    enum class Pressed : std::uint8_t { kBefore, kAfter };
    bool hold_in_cluster(Pressed when);
    void cushion(const Meeting& met);
    /// The noses that a ball hits at one instant. A fifth one is dropped: the ball hits it next, at the same
    /// instant.
    struct Noses {
        std::array<Meeting, 4> met;
        std::size_t count = 0;
        Meeting* begin() { return met.data(); }
        Meeting* end() { return met.data() + count; }
        void add(const Meeting& another) {
            if (count < met.size()) met[count++] = another;
        }
    };
    Noses noses_with(const Meeting& met) const;
    void pocket(const Contact& contact);
    void leave_pocket(const Contact& contact);
    bool is_barred(int ball, const Vec3& place) const;
    void transition(int ball);
    // resolver_air.cpp
    bool is_free(int a, int b) const;
    void free_balls(int one, int two);
    void cushion_in_air(const Meeting& met);
    void pocket_in_air(const Contact& contact);
    void land(int ball);
    void leave_table(int ball);
    void go_on(int ball, const Vec3& r, Velocities after);
    void fall_on(int ball, const Vec3& r, const Velocities& after);

    const Plan& plan_;
    const bool flights_;  // balls may leave the cloth
    const Balls& balls_;
    Log& log_;
    RestingContacts& resting_;
    const Detector& detector_;
    Clusters clusters_;
    EventCost* cost_;  // of a profiled run; otherwise nullptr
    double *resolve_ns_, *kernel_ns_;
};

}  // namespace carom
