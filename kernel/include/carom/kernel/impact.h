// Ball-ball impact: the types that every kernel shares.
//
// Units are SI. The frame is right-handed, z up from the cloth. An impact is planar: both centres are at one
// height and the vertical velocities are left as they are. If the radii differ, the larger ball stands
// higher.
#pragma once

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
    kAsPublished,  ///< u = (v_x + R w_y, v_y - R w_x): the published code; feeds energy in; for parity only
};

/// Parameters of one impact.
struct ImpactParams {
    double R;      ///< radius of ball 1 [m], > 0
    double m;      ///< mass of ball 1 [kg], > 0
    double mu_s1;  ///< sliding friction of ball 1 on the cloth, >= 0
    double mu_s2;  ///< sliding friction of ball 2 on the cloth, >= 0
    double mu_b;   ///< friction between the balls, >= 0
    /// Coefficient of restitution, 0..1 (mathavan: energetic, W_restitution = e_b^2 W_compression)
    double e_b;
    ClothSlip cloth_slip = ClothSlip::kConsistent;
    /// Mass and radius of ball 2 over those of ball 1. The impacts by tolerance and the marches take them up
    /// to kLargestMassRatio and kLargestRadiusRatio (tolerance.h), or over those; to the closed forms one
    /// that is not 1 is kBadParameter. Of two radii the larger ball's centre is as much higher as it is
    /// larger.
    double mass_ratio = 1.0;
    double radius_ratio = 1.0;
};

enum class ImpactStatus : unsigned char {
    kOk,              ///< computed
    kNotApproaching,  ///< approach speed <= 0 (or too small to be a number): the balls leave as they came
    kBadState,      ///< a state is not finite, the centres coincide or are not at one height: result = input
    kBadParameter,  ///< a parameter or setting is out of range: result = input
    kStepLimit,     ///< the march reached its bound on steps (see march.h): result = input
};

/// What is wrong, in words; "" for kOk and kNotApproaching.
const char* describe(ImpactStatus status) noexcept;

/// How an impact by tolerance was solved (tolerance.h); kNone
/// from every other kernel and where nothing was computed.
enum class ToleranceMethod : unsigned char {
    kNone,
    kClosedFrictionless,  ///< no friction between the balls: one formula
    kClosedGearing,       ///< no slip between the balls: as without friction
    kClosedStick,         ///< horizontal slip only, with the stick that may end it: one formula
    kCollocation4,        ///< one collocation of 4 nodes over the whole impact
    kCollocation8,        ///< one collocation of 8 nodes over the whole impact
    kAdaptive,            ///< cut into intervals, towards stick or where the cloth slip comes close to zero
};

/// Velocities after the impact. Where the status is not kOk they are those before it.
struct ImpactResult {
    double v1[3], w1[3];  ///< ball 1 [m/s], [rad/s]
    double v2[3], w2[3];  ///< ball 2
    long steps;           ///< steps of the march, 1 for a closed form, 0 where nothing was computed
    ImpactStatus status;
    ToleranceMethod method;
};

}  // namespace carom::kernel
