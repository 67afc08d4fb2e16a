// The reference solution for the ball-ball kernels: the impact of the 2014 model (physics.md section 3) by
// power series in extended precision. Shares no code with the kernels.
#pragma once

#include "carom/kernel/impact.h"

namespace carom::reference {

struct TruthSettings {
    int order = 22;                  ///< of the Taylor series, 4..kTruthMaxOrder
    long double tolerance = 1e-17L;  ///< of one step, relative to the approach speed
    long double vanished = 1e-19L;   ///< slip below this share of the approach speed is zero
};

inline constexpr int kTruthMaxOrder = 30;

struct ImpactTruth {
    bool ok = false;           ///< false: no impact (bad or separating input), or the step limit was reached
    bool stuck = false;        ///< the slip between the balls ended during the impact
    long double v1[3], w1[3];  ///< after the impact
    long double v2[3], w2[3];
    long double approach;          ///< approach speed [m/s]
    long double compression_work;  ///< W_c per unit mass [m^2/s^2]
    long double friction_loss;     ///< energy lost to both frictions per unit mass [m^2/s^2]
    int steps = 0;
};

/// Solves one impact. Written for mu_s, mu_b <= 1 and an approach speed above 1e-9 of the other speeds.
ImpactTruth reference_impact(const kernel::Ball& ball1, const kernel::Ball& ball2,
                             const kernel::ImpactParams& params, const TruthSettings& settings = {});

/// Largest difference of any component of v and R w, relative to the approach speed of the reference.
double error_of(const kernel::ImpactResult& result, const ImpactTruth& truth, double R);

}  // namespace carom::reference
