// Planar impacts of two balls: one function per model behind one interface, and the law that applies them to
// balls of any size.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "carom/engine/motion.h"
#include "carom/engine/scene.h"
#include "carom/kernel/march.h"
#include "carom/kernel/tolerance.h"

namespace carom {

/// Settings of a run: how accurately a model is integrated, and by which kernel.
struct BallBallSettings {
    kernel::MarchFunction march = nullptr;             ///< set if the scene has substeps
    kernel::ToleranceFunction by_tolerance = nullptr;  ///< set otherwise
    int substeps = 0;
    double tolerance = 0.0;  ///< relative to the approach speed
    kernel::ClothSlip cloth_slip = kernel::ClothSlip::kConsistent;
};

/// Velocities after the impact of two balls of equal radius with centres at the same height. Their masses are
/// equal too, unless the model reads the tolerance. v_z does not change. If `result.status` is an error, the
/// velocities are unchanged.
using BallBallFunction = void (*)(const BallBallSettings& settings, const kernel::Ball& ball1,
                                  const kernel::Ball& ball2, const kernel::ImpactParams& params,
                                  kernel::ImpactResult& result);

/// One model: its function, its inputs and outputs, and the balls it accepts. Every model reads and writes
/// the velocities.
struct BallBallModelInfo {
    const char* name;
    const char* source;
    BallBallFunction collide;
    bool reads_friction = false;     ///< mu_b and the spins matter, and the spins change
    bool reads_restitution = false;  ///< e_b matters
    bool reads_cloth = false;        ///< mu_s and the sign of the cloth slip matter
    bool reads_tolerance = false;    ///< the settings matter: the model integrates, it has no closed form
    /// Balls on the cloth collide as free balls, then hit the cloth, so they may leave it.
    bool free = false;

    /// e_b and the friction between two balls, as the model reads them.
    double restitution(const BallParams& balls) const { return reads_restitution ? balls.e_b : 1.0; }
    Falling friction(const BallParams& balls) const {
        return reads_friction ? balls.ball_friction() : Falling{0.0};
    }
};

/// All models; equations and sources in docs/reference/physics.md, "Ball-ball impact".
std::span<const BallBallModelInfo* const> all_of(const BallBallModelInfo*);
/// The model of this name, or null.
const BallBallModelInfo* ball_ball_model(std::string_view name);

/// Two balls of different size. The planar model keeps both on the cloth: the horizontal velocities along the
/// line of centres separate at e_b times the approach speed, whatever the tilt of that line. Friction is
/// modelled for equal radii only: mu_b must be 0 if the radii differ. Equations: docs/reference/physics.md,
/// "Balls of different size".
///
/// @param params  R and m are not read
void collide_unequal(const BallSize& size1, const BallSize& size2, const kernel::Ball& ball1,
                     const kernel::Ball& ball2, const kernel::ImpactParams& params,
                     kernel::ImpactResult& result);

/// Horizontal distance between the centres of two touching balls on the cloth: 2 sqrt(R1 R2); R1 + R2 for
/// discs.
double contact_distance(double R1, double R2, bool discs);

/// The laws of a scene's planar impacts. A friction without effect in this scene may be 0 in `balls`.
struct PairLaw {
    const BallBallModelInfo& model;
    const BallBallSettings& settings;
    const BallParams& balls;
    /// The impact lasts for the time of a Hertz contact, in which the balls move past each other, so it acts
    /// along the line of centres in the middle of that time: docs/reference/physics.md, "Ball-ball impact".
    bool contact_time = false;

    /// The parameters of an impact with the friction mu_b between the balls.
    kernel::ImpactParams params(const BallSize& size1, const BallSize& size2, double mu_b) const;
};

struct PairImpact {
    kernel::ImpactStatus status;
    std::int64_t steps;
    const char* method;  ///< for people: the model, or how the kernel integrated it
    /// They still close where they met: they only graze each other, and separate by moving past each other.
    /// Without contact_time never.
    bool grazes = false;
};

/// Whether `q` is ball 1 of an impact, so that the ids do not affect the result, to the last bit: the ball
/// with the smaller x, then y. From the other ball, a march with a set number of steps has another error.
inline bool comes_first(const Vec3& q, const Vec3& p) {
    if (q.x() != p.x()) return q.x() < p.x();
    return q.y() != p.y() ? q.y() < p.y() : q.z() < p.z();
}

/// Replaces the velocities of two colliding balls on the cloth, unless the status is an error. The friction
/// between them is that of their slip before the impact.
/// @param r1, r2  centres; their heights differ by the difference of the radii
PairImpact collide(const PairLaw& law, const BallSize& size1, const BallSize& size2, const Vec3& r1,
                   const Vec3& r2, Velocities& ball1, Velocities& ball2);

}  // namespace carom
