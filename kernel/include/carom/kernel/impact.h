// Ball-ball impact: the types that all kernels share.
//
// Units are SI. The frame is right-handed, z up from the cloth. An impact is planar: both centres are at the
// same height, and the vertical velocities do not change.
#pragma once

#include <cstdint>

namespace carom::kernel {

/// One ball at the instant of the impact.
struct Ball {
    double r[3];  ///< centre [m]
    double v[3];  ///< velocity [m/s]
    double w[3];  ///< angular velocity [rad/s], right-hand rule
};

/// Sign of the cloth slip inside the impact (docs/reference/physics.md, "Sign of the cloth slip").
enum class ClothSlip : unsigned char {
    kConsistent,   ///< u = (v_x - R w_y, v_y + R w_x): agrees with the motion between events; the default
    kAsPublished,  ///< u = (v_x + R w_y, v_y - R w_x): the published code; adds energy; for parity only
};

struct ImpactParams {
    double R;      ///< radius of ball 1 [m], > 0
    double m;      ///< mass of ball 1 [kg], > 0
    double mu_s1;  ///< sliding friction of ball 1 on the cloth, >= 0
    double mu_s2;  ///< sliding friction of ball 2 on the cloth, >= 0
    double mu_b;   ///< friction between the balls, >= 0
    /// Coefficient of restitution, 0..1 (mathavan: energetic, W_restitution = e_b^2 W_compression)
    double e_b;
    ClothSlip cloth_slip = ClothSlip::kConsistent;
    /// Mass of ball 2 divided by that of ball 1. ToleranceFunction accepts 1/kLargestMassRatio to
    /// kLargestMassRatio (tolerance.h); for every other kernel a ratio other than 1 is kBadParameter.
    double mass_ratio = 1.0;
    double radius_ratio = 1.0;
};

enum class ImpactStatus : unsigned char {
    kOk,              ///< computed
    kNotApproaching,  ///< approach speed <= 0 (or too small to compute with): the velocities are unchanged
    kBadState,        ///< a state is not finite, or the centres coincide or differ in height: result = input
    kBadParameter,    ///< a parameter or setting is out of range: result = input
    kStepLimit,       ///< the integration reached its limit of steps (march.h): result = input
};

/// The fault, in words; "" for kOk and kNotApproaching.
const char* describe(ImpactStatus status) noexcept;

/// How an impact was solved to a tolerance (tolerance.h); kNone from every other kernel, or if nothing was
/// computed.
enum class ToleranceMethod : unsigned char {
    kNone,
    kClosedFrictionless,  ///< no friction between the balls: one formula
    kClosedGearing,       ///< no slip between the balls: as without friction
    kClosedStick,         ///< horizontal slip only, and the stick that may end it: one formula
    kCollocation4,        ///< one collocation of 4 nodes over the whole impact
    kCollocation8,        ///< one collocation of 8 nodes over the whole impact
    kAdaptive,            ///< divided into intervals, near stick or if the cloth slip comes close to zero
};

/// Velocities after the impact, or before it if the status is not kOk.
struct ImpactResult {
    double v1[3], w1[3];  ///< ball 1 [m/s], [rad/s]
    double v2[3], w2[3];  ///< ball 2
    std::int64_t steps;   ///< steps of the integration, 1 for a closed form, 0 if nothing was computed
    ImpactStatus status;
    ToleranceMethod method;
};

}  // namespace carom::kernel
