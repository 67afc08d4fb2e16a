// Ball-ball impact models: one function each, behind one interface.
#pragma once

#include <span>
#include <string_view>

#include "carom/engine/scene.h"
#include "carom/kernel/march.h"
#include "carom/kernel/tolerance.h"

namespace carom {

/// What is set once for a run: how accurate an integrated model is, and which kernel integrates it.
struct BallBallSettings {
    kernel::MarchFunction march = nullptr;             ///< set where the scene asks for substeps
    kernel::ToleranceFunction by_tolerance = nullptr;  ///< set otherwise
    int substeps = 0;
    double tolerance = 0.0;  ///< relative to the approach speed
};

/// Velocities after the impact of two balls of one radius, and of one mass but for a model
/// that reads the tolerance; both centres are at one height, and v_z stays as it is.
/// `result.status` says where nothing was computed (the velocities are then as they came).
using BallBallFunction = void (*)(const BallBallSettings& settings, const kernel::Ball& ball1,
                                  const kernel::Ball& ball2, const kernel::ImpactParams& params,
                                  kernel::ImpactResult& result);

/// One model: its function, the state that it reads and writes, and which balls it takes. Every model reads
/// and writes the velocities.
struct BallBallModelInfo {
    const char* name;
    const char* source;
    BallBallFunction collide;
    bool reads_friction = false;     ///< mu_b and the spins matter, and the spins change
    bool reads_restitution = false;  ///< e_b matters
    bool reads_cloth = false;        ///< mu_s and the sign of the cloth slip matter
    bool reads_tolerance = false;    ///< the settings matter: an integration, no closed form
    /// balls on the cloth meet as free ones, and the cloth answers next: they may leave it
    bool free = false;
};

/// All models; equations and sources in docs/reference/physics.md, "Ball-ball impact".
std::span<const BallBallModelInfo* const> all_of(const BallBallModelInfo*);
/// The model of this name, or null.
const BallBallModelInfo* ball_ball_model(std::string_view name);

/// Two balls of different size. The planar model holds both to the cloth: the horizontal velocities along the
/// line of centres part at e_b times the approach, whatever the tilt of that line. Friction is known for
/// equal radii only: mu_b must be 0 where the radii differ. Equations: docs/reference/physics.md, "Balls of
/// different size".
///
/// @param params  R and m are not read
void collide_unequal(const BallSize& size1, const BallSize& size2, const kernel::Ball& ball1,
                     const kernel::Ball& ball2, const kernel::ImpactParams& params,
                     kernel::ImpactResult& result);

/// Horizontal distance of the centres of two balls that touch while both lie on the cloth: 2 sqrt(R1 R2).
double contact_distance(double R1, double R2);

}  // namespace carom
