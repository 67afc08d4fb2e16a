// Ball-ball impacts with a third ball within reach: which balls belong to one, and what it does to them.
#pragma once

#include <cstdint>
#include <vector>

#include "loop/balls.h"
#include "loop/detector.h"
#include "physics/cluster.h"

namespace carom {

class Clusters {
  public:
    Clusters(const Plan& plan, const Balls& balls, const Detector& detector);

    /// Finds the cluster of two balls that meet at v_n [m/s]. @return the fastest approach in it [m/s]
    double collect(int a, int b, double v_n);
    /// Of the last collect(); two balls and no contacts where there is no third one.
    const std::vector<ClusterBall>& balls() const { return members_; }
    const std::vector<ClusterContact>& contacts() const { return contacts_; }

    /// Replaces the velocities and spins of balls() by those after the impact.
    /// @param v_n   [m/s] the fastest approach
    /// @param mu_b  friction between the balls
    /// @return steps of the map
    long resolve(double v_n, double mu_b);

    /// How many balls collect() has looked at beside the two that met; tests count them.
    std::int64_t looks() const { return looks_; }

  private:
    void collect_at(int a, int b, double v_n);
    Box near_box(const ClusterBall& ball, double gap) const;
    ClusterBall member(int ball) const;

    const Plan& plan_;
    const Balls& balls_;
    const Detector& detector_;
    ClusterMap map_;
    std::vector<ClusterBall> members_;
    std::vector<ClusterContact> contacts_;
    std::int64_t looks_ = 0;
};

}  // namespace carom
