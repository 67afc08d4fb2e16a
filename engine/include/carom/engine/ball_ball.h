// Ball-ball impact models: one function each, behind one interface.
#pragma once

#include <span>
#include <string_view>

#include "carom/engine/scene.h"
#include "carom/kernel/march.h"
#include "carom/kernel/tolerance.h"

namespace carom {

/// Settings of a run: how accurately a model is integrated, and by which kernel.
struct BallBallSettings {
    kernel::MarchFunction march = nullptr;             ///< set if the scene asks for substeps
    kernel::ToleranceFunction by_tolerance = nullptr;  ///< set otherwise
    int substeps = 0;
    double tolerance = 0.0;  ///< relative to the approach speed
};

/// Velocities after the impact of two balls of equal radius, whose centres are at the same height. Their
/// masses are equal too, unless the model reads the tolerance. v_z does not change. `result.status` says
/// whether the impact was solved; if not, the velocities are unchanged.
using BallBallFunction = void (*)(const BallBallSettings& settings, const kernel::Ball& ball1,
                                  const kernel::Ball& ball2, const kernel::ImpactParams& params,
                                  kernel::ImpactResult& result);

/// One model: its function, the state that it reads and writes, and which balls it accepts. Every model reads
/// and writes the velocities.
struct BallBallModelInfo {
    const char* name;
    const char* source;
    BallBallFunction collide;
    bool reads_friction = false;     ///< mu_b and the spins matter, and the spins change
    bool reads_restitution = false;  ///< e_b matters
    bool reads_cloth = false;        ///< mu_s and the sign of the cloth slip matter
    bool reads_tolerance = false;    ///< the settings matter: the model integrates, it has no closed form
    /// balls on the cloth collide as free balls, then the cloth reacts: they may leave it
    bool free = false;
};

/// All models; equations and sources in docs/reference/physics.md, "Ball-ball impact".
std::span<const BallBallModelInfo* const> all_of(const BallBallModelInfo*);
/// The model of this name, or null.
const BallBallModelInfo* ball_ball_model(std::string_view name);

/// Two balls of different size. The planar model keeps both on the cloth: the horizontal velocities along the
/// line of centres separate at e_b times the approach speed, whatever the tilt of that line. Friction is
/// known for equal radii only: mu_b must be 0 if the radii differ. Equations: docs/reference/physics.md,
/// "Balls of different size".
///
/// @param params  R and m are not read
void collide_unequal(const BallSize& size1, const BallSize& size2, const kernel::Ball& ball1,
                     const kernel::Ball& ball2, const kernel::ImpactParams& params,
                     kernel::ImpactResult& result);

/// Horizontal distance of the centres of two balls that touch while both lie on the cloth: 2 sqrt(R1 R2), and
/// R1 + R2 for discs.
double contact_distance(double R1, double R2, bool discs);

}  // namespace carom
