// Many contacts at once: the compliant model (Hertz contacts of the whole cluster, during which the balls
// move) and the instantaneous, rigid symmetric projection. Equations: docs/reference/physics.md; limits of
// such models: docs/design/hard_cases.md.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/engine/cushion.h"
#include "carom/engine/scene.h"
#include "carom/engine/tolerances.h"
#include "carom/engine/vec.h"
#include "carom/kernel/contact_phase.h"
#include "physics/motion.h"

namespace carom {

/// [V] A contact of a cluster that closes faster than this, times its nearness, sets the scale V itself,
/// because the step length suits approaches near V. The excess over 1 is the possible jump of the reach if
/// another contact sets it.
inline constexpr double kClusterFaster = 1.05;
/// [share of R] Smaller gaps are rounding of the positions: the balls touch.
inline constexpr double kTouchUlp = 64.0 * kEpsilon;

/// [V] Regularisation of the friction in the compliant model. Against Coulomb's law it errs by 1.4e-3 V in
/// breaks, in proportion to its size (docs/reference/physics.md, several contacts at once).
inline constexpr double kClusterEpsilon = 1.3e-3;
/// [L/V] A cluster that has not separated after this many contact times of its heaviest balls is solved as
/// rigid; the slowest of 16 balls needs a few dozen.
inline constexpr double kClusterTimeLimit = 200.0;
/// [-] Most evaluations of the forces for a cluster that lasts, at the tolerance 1e-6; more at a smaller one,
/// as a method of order 4 needs them. The note lab/notes/2026-11-clusters_by_tolerance.md says how many need
/// more.
inline constexpr double kClusterEvaluations = 2e4;

struct ClusterBall {
    int ball = -1;      ///< engine index
    Vec3 r, v, w;       ///< v and w are replaced by the map
    double R = 0.0;     ///< [m] read only if the balls of the cluster differ (ClusterSettings::unlike)
    double mass = 1.0;  ///< relative to the balls that ClusterSettings describes
};

struct ClusterContact {
    int i, j;    ///< into the list of balls
    Vec3 n;      ///< unit, from i to j; level if both lie on the cloth
    double gap;  ///< [m], >= 0; 0 if the balls touch
    /// Weight of this contact's approach in the scale of the cluster: 0 at the edge of reach.
    double nearness = 1.0;
};

/// When the balls of a contact touched for the first time [s after the start; negative: never], and their
/// impulse along the normal [m/s times the mass that ClusterSettings describes].
struct ClusterPush {
    double first = -1.0, impulse = 0.0;
};

/// The cushions and, under balls in space, the cloth near a cluster: SI units, and k is the index in the list
/// of balls. See kernel::ContactSurfaces.
class ClusterSurfaces {
  public:
    virtual ~ClusterSurfaces() = default;
    virtual double next(std::size_t k, const Placed& at, const Vec3& spin) const = 0;
    virtual void hit(std::size_t k, double time, const Vec3& r, Velocities& ball) = 0;
    virtual double out(std::size_t k, const Placed& at) const = 0;
};

struct ClusterSettings {
    double R;  ///< [m]
    double mu_s = 0.0, mu_b = 0.0, e_b = 1.0;
    bool published_cloth_slip = false;
    double epsilon = kClusterEpsilon;  ///< regularisation of the friction directions, in units of V
    double tolerance = 1e-6;           ///< [V] error of the velocities by a step of the integration
    kernel::ContactPhaseFunction integrate = nullptr;
    /// At a slip of u m/s the friction between balls is mu_b + mu_b_more exp(-mu_b_fall u).
    double mu_b_more = 0.0, mu_b_fall = 0.0;
    double slide = 0.0;   ///< [m/s^2] deceleration of a ball that slips on the cloth
    bool turns = true;    ///< false: all normals remain as in the contacts
    bool unlike = false;  ///< the balls differ in size; R is that of balls with mass 1
    /// [s] A solution that lasts longer, or needs more than kClusterEvaluations, is not wanted; 0: all are.
    double longest = 0.0;
    ClusterSurfaces* surfaces = nullptr;
    double gravity = 0.0;  ///< [m/s^2] of balls in space
    double hop = 0.0;      ///< [m/s] a slower rise does not leave the cloth
};

/// Duration of a Hertz contact at the approach speed V: t_c = 2.6 L / V [s], L = (V^2 m / k)^0.4 (equation
/// 5).
double contact_time(double V);

/// L = (V^2 m / k)^0.4 [m] with kContactStiffness.
double contact_length(double V);

/// The duration of the contact of two balls over that of two balls of this size: proportional to (mass /
/// stiffness)^0.4.
double pair_softness(const BallSize& one, const BallSize& two, const BallSize& usual);

/// x^(1/5) for x > 0, from + - * / only, correct to about 1 ulp.
double fifth_root(double x);

/// The two models. Keeps scratch memory between calls.
class ClusterMap {
  public:
    /// Compliant: integrates the contact phase in its own time, scaled by the approach speed V [m/s] of the
    /// triggering pair or of the fastest one. Replaces velocities and spins. Returns the number of
    /// evaluations of the forces, or -1 if the contacts did not separate within `longest`,
    /// kClusterTimeLimit or kClusterEvaluations. The positions of the balls are unchanged; see duration() and
    /// moved(). `held`: all balls stay on the cloth. Otherwise a ball flies or may leave the cloth, which is
    /// one of the surfaces: its friction with balls that are pressed down is ignored.
    std::int64_t compliant(std::vector<ClusterBall>& balls, const std::vector<ClusterContact>& contacts,
                           const ClusterSettings& settings, double V, bool held);

    /// Rigid: v := (1 + e) P(v) - e v with P the nearest velocities that close no contact (equations 7, 8)
    /// and press no ball on the cloth (r_z not above its R) into it; frictionless. Reads only R, e_b and
    /// `unlike` of the settings. Returns the number of sweeps.
    std::int64_t rigid(std::vector<ClusterBall>& balls, const std::vector<ClusterContact>& contacts,
                       const ClusterSettings& settings);

    /// Of the last compliant map: its duration [s], and ball k's displacement in it [m].
    double duration() const { return duration_; }
    /// Of the last map, the course of every contact.
    const std::vector<ClusterPush>& pushes() const { return pushes_; }
    Vec3 moved(std::size_t k) const { return {moved_[3 * k], moved_[3 * k + 1], moved_[3 * k + 2]}; }

  private:
    /// The owner of the kernel's surfaces.
    struct Reached {
        const std::vector<ClusterBall>* balls;
        const ClusterSettings* settings;
        double V, L;
        Placed placed(int ball, const double* state) const;
        Vec3 spin(int ball, const double* state) const;
    };
    void load(const std::vector<ClusterBall>& balls, const ClusterSettings& settings, double V);
    void unload(const ClusterSettings& settings, double V, std::vector<ClusterBall>& balls);
    void keep_energy(double before);
    double energy() const;

    // Per ball, v and R w, in units of V.
    std::vector<double> motion_;
    // Per ball its displacement [L], and the duration [L/V]; in SI units after the map.
    std::vector<double> moved_;
    double duration_ = 0.0;
    std::vector<double> mass_, inverse_mass_;  // per ball
    std::vector<kernel::HertzContact> contacts_;
    std::vector<kernel::HertzHistory> history_;
    std::vector<ClusterPush> pushes_;
    std::vector<double> lies_;  // per ball [L]
    std::vector<double> numbers_;
    std::vector<int> places_;
    // For rigid(): per ball [m/s], and per contact.
    std::vector<Vec3> velocity_;
    std::vector<double> impulse_;
};

}  // namespace carom
